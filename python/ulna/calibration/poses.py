"""Where each standing of an artefact was found, in the arm's base frame, and how well that is known.

A touch p and its residual r say where the feature was found, g = p - r; the g of a standing are its features moved as
one body. Of a least-squares fit with parameters x (covariance C) and a standing y, whose rows are `J δx - B δy` with
weights W, H = Bᵀ W B and S = H⁻¹ Bᵀ W J, the covariance of y is H⁻¹ + S C Sᵀ: the inverse of the whole normal matrix,
by blocks.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.covariance import ParameterCovariance
from ulna.artefacts.artefact import features_mm
from ulna.artefacts.readings import Readings
from ulna.calibration.touched import touched
from ulna.geometry.rigid import rotations
from ulna.geometry.rotation import cross_matrices
from ulna.ground.arrays import F64, I64
from ulna.study.data import Noise, StudyData

#: features nearer to a line, or to each other, than this part of their spread are on it
_FLAT = 1e-6


@dataclass(frozen=True)
class PlacementPose:
    """One standing of an artefact with features: where its own frame is in the arm's base frame."""

    artefact: str
    placement: str
    origin_mm: list[float]
    """Of the artefact's frame: of a bar its end A, of a seat its centre."""
    u_origin_mm: list[float] | None
    """Standard uncertainty of each coordinate; None where there was nothing to estimate it from."""
    axes: list[list[float]] | None = None
    """x, y and z of the artefact's frame as unit vectors; None where the features touched are on a line."""
    direction: list[float] | None = None
    """Of such a line, from its first feature to its last: of a bar from A to B."""
    u_turn_rad: float | None = None
    """Standard uncertainty of how it is turned, the largest about any axis (across a line)."""


def placement_poses(
    arm: Arm,
    study: StudyData,
    residuals_mm: list[F64],
    covariance: ParameterCovariance,
    variance: float,
) -> list[PlacementPose]:
    """Of all standings of all artefacts that have features and stand freely, as far as their features say it.

    residuals_mm: of each artefact's readings, (N, 3), tip minus feature; covariance: of the arm's parameters;
    variance: of a coordinate of a touch, where no noise is stated. What is not known of an artefact itself (the u
    of its length or of its features) is not in the uncertainties.
    """
    found: list[PlacementPose] = []
    for group, residuals in zip(study.readings, residuals_mm, strict=True):
        features = features_mm(group.artefact)
        if group.artefact.frame == "free" and len(features) and group.p_rad is None:
            scene = _Scene(arm, study, group, residuals, features, covariance, variance)
            found += scene.poses()
    return found


@dataclass(frozen=True)
class _Scene:
    """All touches of one artefact."""

    arm: Arm
    study: StudyData
    group: Readings
    residuals_mm: F64
    features_mm: F64
    covariance: ParameterCovariance
    variance: float

    def poses(self) -> list[PlacementPose]:
        """Standings whose touches are of the same features in the same order go together."""
        code, labels = self.group.labels.as_they_appear()
        order = np.argsort(code, kind="stable")
        alike: dict[bytes, list[int]] = {}
        rows = np.split(order, np.flatnonzero(np.diff(code[order])) + 1)
        for standing, own in enumerate(rows):
            alike.setdefault(self.group.feature[own].tobytes(), []).append(standing)
        touches = self._touches()
        found: list[tuple[int, PlacementPose]] = []
        for standings in alike.values():
            together = np.stack([rows[k] for k in standings])
            poses = self._alike([labels[k] for k in standings], together, *(values[together] for values in touches))
            found += zip(standings, poses, strict=False)
        return [pose for _, pose in sorted(found, key=lambda numbered: numbered[0])]

    def _alike(
        self, placements: list[str], rows: I64, tips: F64, by_parameters: F64, weights: F64
    ) -> list[PlacementPose]:
        """Of M standings with n touches each, of the same features: rows (M, n), tips (M, n, 3) and so on; none where
        what was touched does not say where the artefact's origin is."""
        features = self.features_mm[self.group.feature[rows[0]]]
        stood = tips - self.residuals_mm[rows]
        centre, spread = features.mean(axis=0), features - features.mean(axis=0)
        size = max(float(np.abs(features).max()), 1.0)
        known = int(np.sum(np.linalg.svd(spread, compute_uv=False) > _FLAT * size))
        if np.linalg.norm(centre if known == 0 else _beside(centre, spread, known)) > _FLAT * size:
            return []  # the origin turns about what was touched
        middle = stood.mean(axis=1)
        rotation = _rotations(spread, stood - middle[:, None, :], known)
        origin = middle - rotation @ centre
        lever = features @ rotation.transpose(0, 2, 1)
        shift = np.broadcast_to(np.eye(3), (*rows.shape, 3, 3))
        columns = np.concatenate([shift, -cross_matrices(lever) @ _turns(rotation, spread, known)[:, None]], axis=3)
        u = self._u(columns, by_parameters, weights)
        turned = None if u is None or not known else np.sqrt(np.linalg.eigvalsh(u[:, 3:, 3:])[:, -1])
        line = rotation @ _along(features) if known == 1 else None
        return [
            PlacementPose(
                self.group.artefact.name,
                placement,
                origin[k].tolist(),
                None if u is None else np.sqrt(np.diag(u[k])[:3]).tolist(),
                axes=rotation[k].T.tolist() if known > 1 else None,
                direction=None if line is None else line[k].tolist(),
                u_turn_rad=None if turned is None else float(turned[k]),
            )
            for k, placement in enumerate(placements)
        ]

    def _touches(self) -> tuple[F64, F64, F64]:
        """Tips (N, 3), their derivatives by the parameters of the covariance (N, 3, P), weights (N, 3, 3)."""
        noise = self.study.noise or Noise()
        names = self.arm.parameter_names
        columns = [names.index(name) for name in self.covariance.names if name in names]
        found = touched(self.arm, self.study, self.group, noise.encoder_rad)
        covariance = found.by_encoders_mm2
        stated = noise.encoder_rad is not None or noise.seat_mm is not None
        covariance *= self.variance
        variance = self.variance * ((noise.seat_mm or 0.0) ** 2 if stated else 1.0)
        # a direction without any noise gets a millionth of the others', as in the fit
        floor = 1e-6 * (np.trace(covariance, axis1=1, axis2=2) / 3.0 + variance)
        covariance += (variance + floor)[:, None, None] * np.eye(3)
        if np.isfinite(covariance).all():
            covariance[:] = np.linalg.inv(covariance)
        return found.tips_mm, found.by_parameter[:, :, columns], covariance

    def _u(self, columns: F64, by_parameters: F64, weights: F64) -> F64 | None:
        """Covariances of origin and turns; None where nothing is known of the noise."""
        names = [k for k, name in enumerate(self.covariance.names) if name in self.arm.parameter_names]
        of_parameters = self.covariance.matrix[np.ix_(names, names)]
        if not np.isfinite(weights).all() or not np.isfinite(of_parameters).all():
            return None
        weighted = columns.transpose(0, 1, 3, 2) @ weights
        inverse = np.linalg.inv((weighted @ columns).sum(axis=1))
        follow = inverse @ (weighted @ by_parameters).sum(axis=1)
        found: F64 = inverse + follow @ of_parameters @ follow.transpose(0, 2, 1)
        return found


def _rotations(features: F64, stood: F64, known: int) -> F64:
    """(M, 3, 3): the rotations that take centred features (n, 3) to where they stood (M, n, 3); of features on a line,
    the smallest such."""
    if known == 0:
        return np.broadcast_to(np.eye(3), (len(stood), 3, 3))
    cross = stood.transpose(0, 2, 1) @ features
    if known > 1:
        return rotations(cross)
    u, _, vt = np.linalg.svd(cross)
    return _smallest(vt[:, 0], u[:, :, 0])


def _smallest(a: F64, b: F64) -> F64:
    """(M, 3, 3): the smallest rotation that takes a unit vector (M, 3) to another; a half turn about any axis across
    it where they are opposite."""
    skew = cross_matrices(np.cross(a, b))
    cosine = np.einsum("mi,mi->m", a, b)[:, None, None]
    opposite = cosine < -1.0 + 1e-12
    found = np.eye(3) + skew + skew @ skew / np.where(opposite, 1.0, 1.0 + cosine)
    across = np.cross(a, np.eye(3)[np.argmin(np.abs(a), axis=1)])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    half_turn = 2.0 * across[:, :, None] * across[:, None, :] - np.eye(3)
    return np.where(opposite, half_turn, found)


def _beside(centre: F64, spread: F64, known: int) -> F64:
    """What of the centre is beside the line or the plane of the features; beside a plane nothing is lost."""
    if known > 1:
        return np.zeros(3)
    along = np.linalg.svd(spread)[2][0]
    return np.asarray(centre - along * (along @ centre))


def _turns(rotation: F64, spread: F64, known: int) -> F64:
    """(M, 3, 0), (M, 3, 2) or (M, 3, 3): axes, base frame, about which a turn shows."""
    if known == 0:
        return np.zeros((len(rotation), 3, 0))
    if known == 1:
        return np.asarray(rotation @ np.linalg.svd(spread)[2][1:].T)
    return np.broadcast_to(np.eye(3), rotation.shape)


def _along(features: F64) -> F64:
    """Unit vector from the feature nearest to the origin to the farthest."""
    far = features[np.argsort(np.linalg.norm(features, axis=1))[[0, -1]]]
    return np.asarray((far[1] - far[0]) / np.linalg.norm(far[1] - far[0]))
