"""The chain of section 1 of the model, as written: 4×4 matrices, one factor after the other."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

#: A complex step has no cancellation, so it may be far below rounding: derivatives come out to the last digit.
COMPLEX_STEP = 1e-30


def _identity(count: int, dtype: np.dtype) -> NDArray:
    out = np.zeros((count, 4, 4), dtype)
    out[:, [0, 1, 2, 3], [0, 1, 2, 3]] = 1.0
    return out


def _turn_about(axis: int, angle: NDArray) -> NDArray:
    """(N,) angles, rad → (N, 4, 4) turns about x (0), y (1) or z (2)."""
    angle = np.atleast_1d(angle)
    out = _identity(angle.shape[0], angle.dtype)
    j, k = (axis + 1) % 3, (axis + 2) % 3
    out[:, j, j] = out[:, k, k] = np.cos(angle)
    out[:, j, k], out[:, k, j] = -np.sin(angle), np.sin(angle)
    return out


def _shift_along(axis: int, distance_mm: NDArray) -> NDArray:
    """One distance, mm → (1, 4, 4) shift along an axis."""
    distance_mm = np.atleast_1d(distance_mm)
    out = _identity(distance_mm.shape[0], distance_mm.dtype)
    out[:, axis, 3] = distance_mm
    return out


@dataclass(frozen=True)
class Chain:
    """An arm: (n-1,) arrays for the joints that carry a link, (n,) signs, (P, 3) tips. mm and rad.

    ``last`` is ``d`` of a Denavit–Hartenberg joint and ``beta`` of a Hayati joint, as in the order of parameters.
    """

    theta0_rad: Array
    alpha_rad: Array
    a_mm: Array
    last: Array
    tips_mm: Array
    hayati: tuple[bool, ...]
    sign: tuple[int, ...]

    @property
    def joints(self) -> int:
        return len(self.sign)

    @property
    def probes(self) -> int:
        return len(self.tips_mm)

    @property
    def parameters(self) -> Array:
        """(4(n-1) + 3P,): theta0, alpha, a, d or beta of each joint, then x, y, z of each probe."""
        links = np.stack([self.theta0_rad, self.alpha_rad, self.a_mm, self.last], axis=1)
        return np.concatenate([links.ravel(), np.asarray(self.tips_mm).ravel()])

    @property
    def angular(self) -> NDArray[np.bool_]:
        """Which of the parameters are angles."""
        links = np.array([[True, True, False, hayati] for hayati in self.hayati])
        return np.concatenate([links.ravel(), np.zeros(3 * self.probes, bool)])

    def with_parameters(self, parameters: NDArray) -> "Chain":
        links = parameters[: 4 * (self.joints - 1)].reshape(-1, 4)
        tips = parameters[4 * (self.joints - 1) :].reshape(-1, 3)
        return replace(
            self,
            theta0_rad=links[:, 0],
            alpha_rad=links[:, 1],
            a_mm=links[:, 2],
            last=links[:, 3],
            tips_mm=tips,
        )

    def tip(self, q_rad: NDArray, probe: int | NDArray = 0) -> NDArray:
        """(N, n) encoder angles → (N, 3) tips in the base frame, mm; probe one index or (N,)."""
        q_rad = np.atleast_2d(q_rad)
        count = len(q_rad)
        frame = _identity(count, np.result_type(q_rad, self.theta0_rad, self.tips_mm))
        for i in range(self.joints - 1):
            frame = frame @ _turn_about(2, self.sign[i] * q_rad[:, i] - self.theta0_rad[i])
            if not self.hayati[i]:
                frame = frame @ _shift_along(2, self.last[i])
            frame = frame @ _shift_along(0, self.a_mm[i]) @ _turn_about(0, self.alpha_rad[i])
            if self.hayati[i]:
                frame = frame @ _turn_about(1, self.last[i])
        frame = frame @ _turn_about(2, self.sign[-1] * q_rad[:, -1])
        tips = np.asarray(self.tips_mm)[np.broadcast_to(probe, (count,))]
        return np.einsum("nij,nj->ni", frame[:, :3, :3], tips) + frame[:, :3, 3]

    def jacobian(self, q_rad: Array, probe: int | NDArray = 0) -> Array:
        """(N, n) → (N, 3, parameters), by complex steps: exact to rounding, and no formula shared with the core."""
        columns = []
        for k in range(len(self.parameters)):
            moved = self.parameters.astype(complex)
            moved[k] += 1j * COMPLEX_STEP
            columns.append(self.with_parameters(moved).tip(q_rad.astype(complex), probe).imag / COMPLEX_STEP)
        return np.stack(columns, axis=2)

    def encoder_jacobian(self, q_rad: Array, probe: int | NDArray = 0) -> Array:
        """(N, n) → (N, 3, n), by complex steps, mm/rad."""
        columns = []
        for i in range(self.joints):
            moved = np.atleast_2d(q_rad).astype(complex)
            moved[:, i] += 1j * COMPLEX_STEP
            columns.append(self.tip(moved, probe).imag / COMPLEX_STEP)
        return np.stack(columns, axis=2)


def chain(
    links: Array, tips_mm: Array, hayati: tuple[bool, ...] | None = None, sign: tuple[int, ...] | None = None
) -> Chain:
    """(n-1, 4) rows theta0, alpha, a, d (or beta), and (P, 3) tips → a chain; DH and positive signs unless said."""
    links = np.asarray(links, float)
    return Chain(
        links[:, 0],
        links[:, 1],
        links[:, 2],
        links[:, 3],
        np.atleast_2d(np.asarray(tips_mm, float)),
        hayati or (False,) * len(links),
        sign or (1,) * (len(links) + 1),
    )


def cylindrical_tip(theta0_rad: float, r_mm: float, h_mm: float) -> Array:
    """The literature's three numbers of a probe → x, y, z in mm."""
    return np.array([r_mm * np.cos(theta0_rad), -r_mm * np.sin(theta0_rad), h_mm])
