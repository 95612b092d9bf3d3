"""SciPy fits of an arm to readings, the covariance of what came out, and numerical ranks."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import least_squares

from .chain import Array, Chain
from .observed import Lengths, Points, stack
from .surfaces import Surface

Groups = Sequence[Lengths | Points | Surface]


@dataclass(frozen=True)
class Noise:
    """Standard deviations: (n,) rad per encoder, mm per coordinate of a touch."""

    encoder_rad: Array
    seat_mm: float


@dataclass(frozen=True)
class Found:
    arm: Chain
    cost: float  # sum of squares of the weighted residuals
    jacobian: Array  # weighted, at the end: free parameters, then placements
    residuals: Array  # weighted
    free: NDArray[np.bool_]

    def covariance(self, stated: bool) -> Array:
        """(k, k) of the free parameters, placements accounted for; lost directions held."""
        reduced = eliminate(self.jacobian, int(self.free.sum()))
        kept = rank_of(reduced)
        scale = column_norms(reduced)
        _, s, vt = np.linalg.svd(reduced / scale, full_matrices=False)
        half = (vt[:kept].T / s[:kept]) / scale[:, None]
        unit = half @ half.T
        if stated:
            return unit
        placement = np.linalg.matrix_rank(self.jacobian[:, int(self.free.sum()) :]) if self.jacobian.shape[1] else 0
        return unit * self.cost / (len(self.residuals) - placement - kept)


def whitener(groups: Groups, arm: Chain, noise: Noise | None) -> list[Array]:
    """Per group (N, c, c): inverse Cholesky factors of each reading's covariance; identity without noise."""
    out = []
    for group in groups:
        size = 3 if isinstance(group, Points) else 1
        if noise is None:
            out.append(np.tile(np.eye(size), (len(group.q_rad), 1, 1)))
        else:
            out.append(np.linalg.inv(np.linalg.cholesky(group.covariance(arm, noise.encoder_rad, noise.seat_mm))))
    return out


def _apply(white: Array, rows: Array) -> Array:
    """Whiten (N*c,) residuals or (N*c, k) rows."""
    count, size, _ = white.shape
    shaped = rows.reshape(count, size, -1)
    return (white @ shaped).reshape(rows.shape)


def assemble(groups: Groups, arm: Chain, unknowns: Array, white: list[Array]) -> tuple[Array, Array, Array]:
    """Weighted residuals (M,), derivatives by arm parameters (M, P) and by placements (M, K)."""
    _, parts = stack(groups, arm)
    residuals, of_arm, of_placements = [], [], []
    for group, part, w in zip(groups, parts, white, strict=True):
        ja, jp = group.jacobian(arm, unknowns[part])
        wide = np.zeros((len(ja), len(unknowns)))
        wide[:, part] = jp
        residuals.append(_apply(w, group.residuals(arm, unknowns[part])))
        of_arm.append(_apply(w, ja))
        of_placements.append(_apply(w, wide))
    return np.concatenate(residuals), np.concatenate(of_arm), np.concatenate(of_placements)


def fit(
    groups: Groups,
    start: Chain,
    free: NDArray[np.bool_] | None = None,
    noise: Noise | None = None,
    white_at: Chain | None = None,
) -> Found:
    """scipy.optimize.least_squares over free parameters and placements together, from the start arm.

    Weights are those of ``white_at`` (default: the start) and stay fixed during the fit.
    """
    free = np.ones(len(start.parameters), bool) if free is None else free
    count = int(free.sum())
    unknowns, parts = stack(groups, start)
    white = whitener(groups, white_at or start, noise)

    def arm_at(x: Array) -> Chain:
        parameters = start.parameters.copy()
        parameters[free] = x[:count]
        return start.with_parameters(parameters)

    def residuals(x: Array) -> Array:
        arm = arm_at(x)
        each = zip(groups, parts, white, strict=True)
        return np.concatenate([_apply(w, group.residuals(arm, x[count:][part])) for group, part, w in each])

    def jacobian(x: Array) -> Array:
        _, of_arm, of_placements = assemble(groups, arm_at(x), x[count:], white)
        return np.hstack([of_arm[:, free], of_placements])

    x0 = np.concatenate([start.parameters[free], unknowns])
    # MINPACK's LM wants no fewer equations than unknowns; a bar's turn about itself may be one too many.
    method = "lm" if len(residuals(x0)) >= len(x0) else "trf"
    found = least_squares(
        residuals, x0, jacobian, method=method, x_scale="jac", xtol=1e-13, ftol=1e-15, gtol=1e-15, max_nfev=200
    )
    return Found(arm_at(found.x), 2 * found.cost, jacobian(found.x), residuals(found.x), free)


def column_norms(jacobian: Array) -> Array:
    """Norms to scale columns with; a column that is zero up to rounding keeps its size: it is no direction."""
    norms = np.linalg.norm(jacobian, axis=0)
    floor = 1e-12 * norms.max(initial=0.0)
    return np.where(norms > floor, norms, np.inf)


def singular_values(jacobian: Array) -> Array:
    """Descending, of the Jacobian with columns scaled to one."""
    return np.linalg.svd(jacobian / column_norms(jacobian), compute_uv=False)


def rank_of(jacobian: Array, threshold: float = 1e-9) -> int:
    values = singular_values(jacobian)
    return int((values > threshold * values.max(initial=0.0)).sum())


def eliminate(jacobian: Array, arm_columns: int) -> Array:
    """Arm columns with what the placements can absorb taken out (projection); wholly absorbed columns become zeros."""
    of_arm, of_placements = jacobian[:, :arm_columns], jacobian[:, arm_columns:]
    if not of_placements.shape[1]:
        return of_arm
    norms = np.linalg.norm(of_placements, axis=0)
    u, s, _ = np.linalg.svd(of_placements / np.where(norms > 0, norms, 1.0), full_matrices=False)
    u = u[:, s > 1e-10 * s[0]]
    left = of_arm - u @ (u.T @ of_arm)
    gone = np.linalg.norm(left, axis=0) < 1e-11 * np.linalg.norm(of_arm, axis=0)
    return np.where(gone, 0.0, left)


def reduced_jacobian(groups: Groups, arm: Chain, free: NDArray[np.bool_] | None = None) -> Array:
    """Unweighted (M, k) derivatives by the free parameters, placements eliminated at where the arm sees them."""
    free = np.ones(len(arm.parameters), bool) if free is None else free
    unknowns, _ = stack(groups, arm)
    _, of_arm, of_placements = assemble(groups, arm, unknowns, whitener(groups, arm, None))
    return eliminate(np.hstack([of_arm[:, free], of_placements]), int(free.sum()))
