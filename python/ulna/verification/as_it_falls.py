"""Figures of an acceptance test, or of a check, while it is touched: of what is touched whole, as `verify` has them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import kept
from ulna.verification.figures.figure import Definition
from ulna.verification.file import VerifyPlan
from ulna.verification.kinds.registry import kind_of
from ulna.verification.outcome import Judged
from ulna.verification.tables import State
from ulna.verification.to_touch import WorkList
from ulna.verification.touches import joined
from ulna.verification.verify import evaluated


@dataclass(frozen=True)
class Fallen:
    """One value of a figure, decided."""

    test: str
    kind: str
    definition: Definition
    judged: Judged
    k: float
    """U = k u."""


@dataclass(frozen=True)
class SoFar:
    """What is known of a list that is being touched."""

    values: list[Fallen] = field(default_factory=list)
    not_yet: dict[str, str] = field(default_factory=dict)
    """Test → why what was touched of it gives no figure yet, in words."""


def so_far(plan: VerifyPlan, state: State, work: WorkList, touched: Sequence[int]) -> SoFar:
    """Of the touches of a state, row by row the steps `touched`: of measurements of which all is touched, and of those
    that grow touch by touch."""
    found = SoFar()
    touches = joined(plan.touches[state])
    enough = _enough(work, touched, plan)
    for name in plan.profile.file.test:
        rows = [row for row, k in enumerate(touched) if k in enough and work.listed[k].step.test == name]
        if not rows:
            continue
        own = touches.where(np.array(rows, dtype=np.int64))
        try:
            (one,) = evaluated(replace(plan, touches={state: [own]})).states
        except UlnaInputError as error:
            found.not_yet[name] = kept(error)
            continue
        for test in one.tests:
            found.values.extend(
                Fallen(test.name, test.kind, figure.definition, judged, figure.k)
                for figure in test.figures
                for judged in figure.values
            )
    return found


def _enough(work: WorkList, touched: Sequence[int], plan: VerifyPlan) -> set[int]:
    """The steps that count."""
    there, found = set(touched), set()
    for part in work.parts:
        own = there.intersection(part)
        growing = kind_of(plan.profile.file.test[work.listed[part[0]].step.test].kind).growing
        if len(own) == len(part) or (growing is not None and len(own) >= growing):
            found |= own
    return found
