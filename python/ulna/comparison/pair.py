"""Two calibrations that can be compared: the same joints and effects, each with its covariance."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.directions import drawn, unit_of
from ulna.arm.given import ArmLike, arm_and_noise
from ulna.arm.reading_noise import ReadingNoise
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError


@dataclass(frozen=True)
class Calibrated:
    """One of them."""

    label: str
    """How messages call it."""
    arm: Arm
    noise: ReadingNoise


@dataclass(frozen=True)
class Pair:
    """An earlier and a later one, over the parameters that both have."""

    before: Calibrated
    after: Calibrated
    names: list[str]
    """Of the joints, and of the probe."""
    probe: str
    """With which lengths are compared; both have it."""
    shared_u: float = 0.0
    """Relative standard uncertainty of the length of the artefact that both calibrations rest on, as both studies state
    it; 0: they share none, or state none."""

    @cached_property
    def scale(self) -> F64:
        """(P,) what a drawing leaves open of each parameter: what is not of one unit is compared in these."""
        return np.array([drawn(name) for name in self.names])

    @property
    def covariances(self) -> tuple[F64, F64]:
        """(P, P) of each, the earlier first."""
        return self._covariance(self.before.arm), self._covariance(self.after.arm)

    @property
    def lengths_mm(self) -> tuple[F64, F64]:
        """(P,) of each its lengths, 0 for angles: how the parameters grow with the unit of length."""
        return self._grown(self.before.arm), self._grown(self.after.arm)

    @property
    def degrees_of_freedom(self) -> float:
        """Of what both covariances rest on: those of the one that rests on less."""
        return min(self.before.noise.degrees_of_freedom, self.after.noise.degrees_of_freedom)

    @cached_property
    def lost(self) -> F64:
        """(L, P) directions of length 1, in what a drawing leaves open, that one of them did not determine; moves of
        the base apart, which move no shape."""
        rows = []
        for each in (self.before, self.after):
            assert each.arm.uncertainty is not None
            for direction in each.arm.uncertainty.lost:
                if not direction.get("frame", False):
                    weights = direction["combination"]
                    rows.append([weights.get(name, 0.0) for name in self.names])
        steps = np.array(rows).reshape(-1, len(self.names)) / self.scale
        sizes = np.linalg.norm(steps, axis=1, keepdims=True)
        return np.asarray(steps[sizes[:, 0] > 0.0] / sizes[sizes[:, 0] > 0.0])

    def of(self, arm: Arm, values: F64) -> F64:
        """(..., all parameters of an arm) → (..., P)."""
        return np.take(values, [arm.parameter_names.index(name) for name in self.names], axis=-1)

    def _grown(self, arm: Arm) -> F64:
        units = np.array([unit_of(name) for name in self.names])
        return np.where(units == "mm", self.of(arm, arm.parameters), 0.0)

    def _covariance(self, arm: Arm) -> F64:
        assert arm.uncertainty is not None
        whole = arm.uncertainty.over(arm.parameter_names)
        return self.of(arm, self.of(arm, whole).T)


def calibrated(given: ArmLike, label: str) -> Calibrated:
    """Raises UlnaInputError for an arm of which no calibration, or no uncertainty, is known."""
    arm, noise = arm_and_noise(given)
    if arm.uncertainty is None:
        raise UlnaInputError(
            f"{label}: an arm without its calibration, so that nobody can say whether a difference is one; expected a "
            "result.json or its folder. Name that."
        )
    if arm.uncertainty.why_none is not None:
        raise UlnaInputError(
            f"{label}: {arm.uncertainty.why_none.because}; expected a calibration that has uncertainties. "
            f"{arm.uncertainty.why_none.remedy}"
        )
    return Calibrated(label, arm, noise)


def pair(before: Calibrated, after: Calibrated, probe: str | None = None, shared_u: float = 0.0) -> Pair:
    """Raises UlnaInputError where they are not the same arm."""
    one, other = before.arm, after.arm
    if (one.n, one.signs.tolist(), one.slides.tolist()) != (other.n, other.signs.tolist(), other.slides.tolist()):
        raise UlnaInputError(
            f"{after.label}: its joints are not those of {before.label} ({other.n} and {one.n}, or other signs); "
            "expected two calibrations of one arm. Name those."
        )
    one.check_turns(before.label, "comparisons")
    common = [name for name in one.probes if name in other.probes]
    if not common:
        raise UlnaInputError(
            f"{after.label}: none of its probes ({', '.join(other.probes)}) is one of {before.label} "
            f"({', '.join(one.probes)}); expected the same name for the same probe. Rename one."
        )
    if probe is not None and probe not in common:
        raise UlnaInputError(f"--probe: got '{probe}', expected one that both have: {', '.join(common)}. Correct it.")
    mine, theirs = ([n for n in arm.parameter_names if not n.startswith("probe.")] for arm in (one, other))
    if mine != theirs:
        odd = sorted(set(mine) ^ set(theirs))
        raise UlnaInputError(
            f"{after.label}: it is another model than {before.label}: only one of them has {', '.join(odd[:4])}; "
            "expected the same effects in both. Calibrate both with the same [fit] extras."
        )
    chosen = probe or common[0]
    return Pair(before, after, [*mine, *(f"probe.{chosen}.{axis}" for axis in "xyz")], chosen, shared_u)
