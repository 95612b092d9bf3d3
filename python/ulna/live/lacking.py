"""What is lost and what is weak after a touch: the core's directions, with why and what to do, told apart by whether
more touches of this artefact can help.

What no touch can determine is asked once, of many touches that the guide could suggest; what is lost now and lies in
that span is lost for good.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field
from operator import itemgetter
from typing import Any

import numpy as np

from ulna.arm.directions import drawn, steps
from ulna.calibration.identify import Identification
from ulna.ground.arrays import F64
from ulna.live.guide import Guide
from ulna.live.running import RunningFit
from ulna.planning.measurements import readings_of

ASKED = 200
"""Measurements in new places by which it is judged what touches can determine at all."""
SAME = 0.05
"""A direction of which less than this part lies outside a span is in it."""

Direction = dict[str, Any]


@dataclass(frozen=True)
class Lacking:
    """Directions as of `Identification`."""

    never: list[Direction] = field(default_factory=list)
    """That no touch of this artefact can determine."""
    not_yet: list[Direction] = field(default_factory=list)
    """That the touches so far do not determine: those first of which the cause is no mere lack of touches."""
    weak: list[Direction] = field(default_factory=list)
    """Determined, but worse than a drawing knows them: the worst first."""

    @property
    def told(self) -> tuple[tuple[str, ...], ...]:
        """Equal where the same is to be said."""
        return tuple(
            (str(direction["because"]), *sorted(direction["combination"]))
            for direction in (*self.never, *self.not_yet, *self.weak)
        )

    def as_dict(self) -> dict[str, Any]:
        """JSON types only."""
        return asdict(self)


def never(fit: RunningFit, guide: Guide) -> list[Direction]:
    """What no touch of the guide's artefact can determine of the arm. Raises UlnaInputError."""
    spec, candidates = guide.spec, guide.candidates
    some = np.unique(np.linspace(0, len(candidates) - 1, ASKED).astype(np.int64))
    arm = fit.arm
    return fit.could_tell(readings_of(arm, spec, arm.probe_index(spec.probe), candidates.poses(some))).lost


def lacking(found: Identification, never: Sequence[Direction]) -> Lacking:
    """found: of the touches so far."""
    ever = _span(found.names, never)
    not_yet = [each for each in found.lost if not _inside(_scaled(found.names, each["combination"]), ever)]
    # sorted() keeps the core's order among equals
    not_yet = sorted(not_yet, key=lambda each: each.get("cause") == "coverage")
    weak = sorted(found.weak, key=_worst)
    return Lacking(list(never), not_yet, weak)


def _worst(direction: Direction) -> float:
    """The smaller, the worse it is known beside what may be of its largest parameter."""
    return -float(direction["u"]) / drawn(max(steps(direction["combination"]).items(), key=itemgetter(1))[0])


def _scaled(names: Sequence[str], combination: Mapping[str, float]) -> F64:
    """(F,) of length 1, in what a drawing may be off."""
    direction: F64 = np.array([combination.get(name, 0.0) / drawn(name) for name in names])
    direction /= np.linalg.norm(direction)
    return direction


def _span(names: Sequence[str], directions: Sequence[Direction]) -> F64:
    """(F, k) orthonormal."""
    if not directions:
        return np.zeros((len(names), 0))
    columns = np.array([_scaled(names, each["combination"]) for each in directions]).T
    return np.asarray(np.linalg.qr(columns)[0])


def _inside(direction: F64, span: F64) -> bool:
    return bool(np.linalg.norm(direction - span @ (span.T @ direction)) < SAME)
