"""Readings that a fit has not seen, judged by what it states of them.

Points: with tips p at features x of one standing, the rigid motion that fits them best takes a part of their errors
with it; what is left, r = P p, has the covariance P (J C Jᵀ + D) Pᵀ, C of the parameters, D of the readings' own noise,
each point's own. Inside is a point whose r lies in the ellipsoid of its covariance that holds p of a normal (of few
degrees of freedom, a t) vector. Lengths: between touches of two features of one standing, no touch in two of them, u
from the same C and D.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.covariance import root_of
from ulna.arm.lost import lost_steps
from ulna.arm.reading_noise import ReadingNoise
from ulna.artefacts.artefact import features_mm
from ulna.artefacts.readings import Readings
from ulna.calibration.coverage import Judged, P
from ulna.calibration.touched import touched
from ulna.geometry.rigid import fitted_motion
from ulna.ground.arrays import F64, I64
from ulna.ground.quantiles import chi_squared, fisher, student
from ulna.study.study import Study

TOGETHER = 300
"""Touches of one standing whose motion is taken off together: their covariance is a matrix of 900 × 900."""
NEAR = 1e-6
"""Variances below this part of the largest of a point are what its motion took off."""
SEED = 13
MANY = 1000.0
"""Degrees of freedom beyond which a t vector is a normal one."""


def judged(arm: Arm, noise: ReadingNoise, study: Study) -> Judged:
    """The study's readings by an arm that was not fitted to them, and by what is known of it; those that depend on what
    was not determined are left out. Nothing where no uncertainty is known of the arm, or nothing of its readings."""
    if arm.uncertainty is None or arm.uncertainty.why_none is not None or not noise.known:
        return Judged(np.zeros(0), np.zeros(0))
    parts = [
        part
        for group in study.readings
        if len(group.artefact.features) or group.p_rad is not None
        for part in _of_group(_Scene(arm, noise, study, group))
    ]
    return Judged.together(parts)


@dataclass(frozen=True)
class _Scene:
    """Readings of one artefact, and what is known of the arm."""

    arm: Arm
    noise: ReadingNoise
    study: Study
    group: Readings

    def read(self, second: bool, rows: I64) -> tuple[F64, F64, F64]:
        """Tips (N, 3) mm, the root of their common covariance (N, 3, P), their own (N, 3, 3) mm², NaN where a tip
        depends on what was not determined."""
        found = touched(self.arm, self.study, self.group.select(rows), self.noise.encoder_rad, second)
        own = found.by_encoders_mm2 + self.noise.variance_mm2 * np.eye(3)
        moved = np.linalg.norm(found.by_parameter @ self._lost.T, axis=1)
        own[(moved > self.noise.moves_mm).any(axis=1)] = np.nan
        return found.tips_mm, found.by_parameter @ self._root, own

    @cached_property
    def _lost(self) -> F64:
        return lost_steps(self.arm)

    @cached_property
    def _root(self) -> F64:
        known = self.arm.uncertainty
        assert known is not None
        return root_of(known.over(self.arm.parameter_names))

    def freedom(self, of_parameters: F64, total: F64, coordinates: float) -> F64:
        """(N,) effective degrees of freedom of variances `total`, `of_parameters` of them from the parameters, over so
        many coordinates of touches (GUM G.4.1)."""
        shown = of_parameters + self.noise.estimated_mm2 * coordinates
        with np.errstate(divide="ignore"):
            return np.asarray(self.noise.degrees_of_freedom * (total / shown) ** 2)


def _of_group(scene: _Scene) -> Iterator[Judged]:
    group = scene.group
    if group.p_rad is not None:
        rows = np.arange(len(group))
        (a, root_a, own_a), (b, root_b, own_b) = (scene.read(second, rows) for second in (False, True))
        assert group.length_mm is not None
        yield Judged(np.zeros(0), *_lengths(scene, b - a, group.length_mm, root_b - root_a, own_a + own_b))
        return
    features = features_mm(group.artefact)
    code, _ = group.labels.as_they_appear()
    rng = np.random.default_rng(SEED)
    for standing in range(int(code.max()) + 1):
        rows = rng.permutation(np.flatnonzero(code == standing))
        for start in range(0, len(rows), TOGETHER):
            some = rows[start : start + TOGETHER]
            tips, root, own = scene.read(False, some)
            known = np.isfinite(own[:, 0, 0])
            some, tips, root, own = some[known], tips[known], root[known], own[known]
            at, u_mm = features[group.feature[some]], _u_features(group)[group.feature[some]]
            own = own + (u_mm**2)[:, None, None] * np.eye(3)
            yield Judged(
                _points(scene, tips, at, root, own), *_between(scene, group.feature[some], tips, at, root, own)
            )


def _u_features(group: Readings) -> F64:
    """(F,) what is not known of each feature: of a bar, its length's u shared by both ends."""
    artefact = group.artefact
    if artefact.feature_u_mm is not None:
        return np.array(artefact.feature_u_mm, dtype=np.float64)
    share = np.sqrt(0.5) if artefact.length_mm is not None else 1.0
    return np.full(len(artefact.features), share * artefact.u_mm)


def _points(scene: _Scene, tips: F64, at: F64, root: F64, own: F64) -> F64:
    """Ratios of the points of one standing; none of fewer than two touches."""
    count = len(tips)
    if scene.group.artefact.frame == "arm":
        left, kept, rest = tips - at, root, own
    else:
        if count < 2:
            return np.zeros(0)
        stood, moves = fitted_motion(tips, at)
        left = tips - stood
        flat = root.reshape(3 * count, -1)
        kept = (flat - moves @ (moves.T @ flat)).reshape(count, 3, -1)
        q = moves.reshape(count, 3, -1)
        through = np.einsum("nij,njk->nik", own, q)
        inner = np.einsum("nij,nik->jk", q, through)
        cross = np.einsum("nij,nkj->nik", through, q)
        rest = own - cross - cross.transpose(0, 2, 1) + np.einsum("nij,jk,nlk->nil", q, inner, q)
    covariance = kept @ kept.transpose(0, 2, 1) + rest
    sizes, axes = np.linalg.eigh(covariance)
    along = np.einsum("nji,nj->ni", axes, left)
    counts = sizes > NEAR * np.trace(own, axis1=1, axis2=2)[:, None]
    squared = np.where(counts, along**2 / np.where(counts, sizes, 1.0), 0.0).sum(axis=1)
    dimensions = counts.sum(axis=1)
    of_parameters, total = (kept**2).sum(axis=(1, 2)), np.trace(covariance, axis1=1, axis2=2)
    freedom = scene.freedom(of_parameters, total, 3.0)
    told = dimensions > 0
    radius = [_squared_radius(d, float(f"{v:.3g}")) for d, v in zip(dimensions[told], freedom[told], strict=True)]
    ratios: F64 = np.sqrt(squared[told] / radius)
    # of two touches the motion leaves one error: one is as far off as the other, and is no second witness
    return ratios[:1] if count == 2 and scene.group.artefact.frame != "arm" else ratios


@lru_cache(maxsize=4096)
def _squared_radius(dimensions: int, freedom: float) -> float:
    """Of the ellipsoid that holds P of a vector."""
    if freedom > MANY:
        return float(chi_squared(dimensions, P))
    return dimensions * float(fisher(dimensions, freedom, P))


def _between(scene: _Scene, feature: I64, tips: F64, at: F64, root: F64, own: F64) -> tuple[F64, F64]:
    """Ratios of lengths between touches of two features, no touch in two of them; their errors."""
    first, second = [], []
    waiting: list[int] = []
    for k in range(len(feature)):
        partner = next((j for j in waiting if feature[j] != feature[k]), None)
        if partner is None:
            waiting.append(k)
        else:
            waiting.remove(partner)
            first.append(partner)
            second.append(k)
    if not first:
        return np.zeros(0), np.zeros((0, 2))
    a, b = np.array(first), np.array(second)
    true_mm = np.linalg.norm(at[b] - at[a], axis=1)
    return _lengths(scene, tips[b] - tips[a], true_mm, root[b] - root[a], own[a] + own[b])


def _lengths(scene: _Scene, apart: F64, true_mm: F64, root: F64, own: F64) -> tuple[F64, F64]:
    length_mm = np.linalg.norm(apart, axis=1)
    told = (length_mm > 0.0) & (true_mm > 0.0) & np.isfinite(own[:, 0, 0])
    along = apart[told] / length_mm[told][:, None]
    of_parameters = (np.einsum("ni,nip->np", along, root[told]) ** 2).sum(axis=1)
    variance = of_parameters + np.einsum("ni,nij,nj->n", along, own[told], along)
    if scene.group.p_rad is not None:
        variance += scene.group.artefact.u_mm**2
    k = student(scene.freedom(of_parameters, variance, 2.0), 0.5 * (1.0 + P))
    errors_mm, u_mm = (length_mm - true_mm)[told], np.sqrt(variance)
    ratios: F64 = np.abs(errors_mm) / (k * u_mm)
    return ratios, np.column_stack([errors_mm, u_mm])
