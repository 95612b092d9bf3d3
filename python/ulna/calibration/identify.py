"""Identify: what readings can and cannot determine, before or after a fit."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any

from ulna.arm.directions import combination
from ulna.ground.errors import UlnaInputError
from ulna.ground.shown import About, Shown
from ulna.study.assembly import assemble
from ulna.study.given import StudyLike, as_study

if TYPE_CHECKING:
    import ulna._core as _core


@dataclass(frozen=True, repr=False)
class Identification(Shown):
    """Which free parameters, and which combinations of them, readings determine (MODEL: rank of the Jacobian)."""

    parameters: int
    """Number of free parameters."""
    determined: int
    """Number of their combinations that the readings determine: the rank."""
    names: list[str]
    """The free parameters."""
    singular_values: list[float]
    """Of the Jacobian with columns scaled to unit norm and placements eliminated; descending."""
    condition: float
    """Smallest kept singular value over the largest."""
    not_determined: list[str]
    """Every free parameter that takes part in a lost direction."""
    lost: list[dict[str, Any]] = field(default_factory=list)
    """``{"combination": {name: weight}, "cause", "because", "remedy", "frame"}``; weights in rad and mm, the largest
    effect has weight 1; ``frame`` true: a motion of the base frame, on which no length or shape depends."""
    weak: list[dict[str, Any]] = field(default_factory=list)
    """Determined, but worse than an arm is known from its drawing; nothing that has a prior:
    ``{"combination", "u", "unit", "because", "remedy"}``."""
    from_prior: list[str] = field(default_factory=list)
    """Parameters of which the readings say next to nothing: what is known of them is their prior."""

    @classmethod
    def from_core(cls, found: _core.Identifiability) -> Identification:
        """Copy out of the core.

        Where readings determine nothing at all, as few of them as placements, the core has no measure of directions:
        those that it gives without weights are left out.
        """
        return cls(
            parameters=found.parameters,
            determined=found.determined,
            names=list(found.names),
            singular_values=[float(value) for value in found.singular_values],
            condition=float(found.condition),
            not_determined=list(found.not_determined if found.determined else found.names),
            lost=[dict(direction) for direction in found.lost if _weighed(direction["combination"])],
            # without degrees of freedom nobody knows how well: nothing can be called weak
            weak=[dict(direction) for direction in found.weak if math.isfinite(direction["u"])],
            from_prior=list(found.from_prior),
        )

    def as_dict(self) -> dict[str, Any]:
        """JSON types only."""
        return asdict(self)

    def about(self) -> About:
        """How many directions are determined, and what is not."""
        facts = {"condition": f"{self.condition:.2g} (smallest singular value over the largest)"}
        if self.from_prior:
            facts["prior alone"] = ", ".join(self.from_prior)
        weak = [f"weak: {combination(each['combination'])}: u {each['u']:.2g} {each['unit']}" for each in self.weak]
        return About(
            f"Identification: {self.determined} of {self.parameters} combinations of parameters determined",
            facts,
            notes=[*map(not_determined, self.lost), *weak],
        )


def _weighed(weights: Mapping[str, float]) -> bool:
    return bool(weights) and all(map(math.isfinite, weights.values()))


def not_determined(direction: dict[str, Any]) -> str:
    """A lost direction as a remark."""
    return f"not determined: {combination(direction['combination'])}: {direction['because']}"


def identify(study: StudyLike) -> Identification:
    """What the study's readings can determine at its arm's start values, without fitting.

    The study's `fit.free` and `fit.hold` say what is asked about. Raises UlnaInputError.
    """
    import ulna._core as _core

    study = as_study(study)
    assembled = assemble(study)
    if assembled.hold.all():
        raise UlnaInputError(
            f"{study.label}: keys 'fit.free' and 'fit.hold' hold every parameter; expected at least one to ask about."
        )
    known = study.fit.known_length_mm, study.fit.known_angle_rad
    try:
        found = _core.identify(assembled.problem, assembled.hold, *known)
    except _core.UlnaError as error:
        raise UlnaInputError(f"{study.label}: {error}") from None
    return Identification.from_core(found)
