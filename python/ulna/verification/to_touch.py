"""What is to be touched next by a profile or a protocol: its steps by the artefacts of a file, and whether a touch can
be of a step at all. Lengths mm."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import groupby
from typing import Any

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import Worded, worded
from ulna.verification.certified import OFF_MM
from ulna.verification.file import VerifyPlan
from ulna.verification.kinds.registry import kind_of
from ulna.verification.kinds.steps import Step
from ulna.verification.kinds.wanted import Wanted
from ulna.verification.profile_tables import ProfileFile
from ulna.verification.steps import steps_of
from ulna.verification.tables import State
from ulna.verification.touches import LABELS, Touches
from ulna.verification.verify import evaluated

APART_MM = 1000.0
"""Between places of a list that is tried before anything is touched."""


@dataclass(frozen=True)
class Listed:
    """One step of a list, and what is touched in it."""

    step: Step
    wanted: Wanted
    true_mm: float
    """Length or diameter of the artefact as it is certified, at the temperature of the test; 0 where it has none."""
    off_mm: float
    """By how much a touch may be elsewhere than that says, before it is asked about."""
    moved: bool
    """Whether it is to be touched in another posture than the touches of the same measurement."""

    @property
    def measurement(self) -> tuple[str, ...]:
        """Labels of what is measured at once: touches with the same ones belong together."""
        step = self.step
        return step.test, step.artefact, step.position, step.orientation, step.repeat

    @property
    def standing(self) -> tuple[str, ...]:
        """Labels of what stands still meanwhile."""
        step = self.step
        return step.test, step.artefact, step.position, step.repeat


@dataclass(frozen=True)
class WorkList:
    """All steps of an acceptance test or a check, in order."""

    plan: VerifyPlan
    """The file; whatever touches it names are not looked at."""
    listed: list[Listed]
    tip_mm: float
    """Diameter of the probe's ball; 0 where it is not known."""
    parts: list[tuple[int, ...]] = field(init=False)
    """Indices of the steps of each measurement, in order."""

    def __post_init__(self) -> None:
        numbers = range(len(self.listed))
        runs = groupby(numbers, key=lambda k: self.listed[k].measurement)
        object.__setattr__(self, "parts", [tuple(run) for _, run in runs])

    @property
    def steps(self) -> list[Step]:
        """Without what is touched."""
        return [each.step for each in self.listed]

    def unlikely(self, number: int, at_mm: F64, earlier_mm: Mapping[int, F64]) -> str | None:
        """Why a touch at (3,) can hardly be step `number`, by earlier touches of the same artefact in the same place;
        None where nothing says so. earlier_mm: (3,) by their steps."""
        own = self.listed[number]
        for other, there_mm in earlier_mm.items():
            its = self.listed[other]
            if other == number or its.standing != own.standing:
                continue
            least, most = own.wanted.apart(own.step, its.step, own.true_mm, self.tip_mm)
            away = float(np.linalg.norm(at_mm - there_mm))
            if least - own.off_mm <= away <= most + own.off_mm:
                continue
            end = worded(" at {feature}", feature=its.step.feature) if its.step.feature else ""
            length = f"{most:.1f} mm"
            return worded(
                "it is {away} mm from what was touched{end} in this place, where {expected} is expected",
                away=f"{away:.1f}",
                end=end,
                expected=length if least == most else worded("{length} at the most", length=length),
            )
        return None

    def check(self, state: State) -> None:
        """Tries the list with touches of a state that are all in place, so that what lacks in the file is said before
        anybody touches anything. Raises UlnaInputError."""
        parts = []
        for number, (_, run) in enumerate(groupby(self.listed, key=lambda each: each.standing)):
            own = list(run)
            first = own[0]
            parts.append(
                first.wanted.touched([each.step for each in own], first.true_mm, self.tip_mm)
                + np.array([APART_MM * (number + 1), 0.0, 0.0])
            )
        given = self.plan.touches[state][0]
        ball_mm = np.full(len(self.listed), float(given.ball_mm[0]))
        row = np.arange(1, len(self.listed) + 1)
        touches = Touches(
            given.path, given.sha256, given.source, labels_of(self.steps), np.concatenate(parts), ball_mm, row
        )
        evaluated(replace(self.plan, touches={state: [touches]}))


def labels_of(steps: list[Step]) -> dict[str, Any]:
    """Of touches that are these steps: each of LABELS, (N,) str."""
    return {name: np.array([getattr(step, name) for step in steps], dtype=object) for name in LABELS}


def work_list(plan: VerifyPlan, tip_mm: float | None) -> WorkList:
    """The steps of the plan's profile with the artefacts of its file. tip_mm: diameter of the probe's ball, where it is
    known. Raises UlnaInputError where an artefact lacks."""
    names = _named(plan)
    listed = []
    for step in steps_of(plan.profile.file):
        wanted = _wanted(plan.profile.file, step)
        name = names.get(wanted.name, "")
        listed.append(_listed(plan, replace(step, artefact=name, what=_what(step, name)), wanted))
    return WorkList(plan, listed, tip_mm or 0.0)


def _what(step: Step, name: str) -> str:
    """In the words of the list, by the artefact's own name."""
    what = step.what
    if not isinstance(what, Worded):
        return what.replace(step.artefact, name) if step.artefact else what
    return Worded(what.template, {key: name if key == "artefact" else value for key, value in what.values.items()})


def _wanted(profile: ProfileFile, step: Step) -> Wanted:
    table = profile.test[step.test]
    return next(each for each in kind_of(table.kind).artefacts(table) if each.name == step.artefact)


def _listed(plan: VerifyPlan, step: Step, wanted: Wanted) -> Listed:
    off_mm = plan.file.artefact[step.artefact].off_mm if step.artefact else OFF_MM
    moved = kind_of(plan.profile.file.test[step.test].kind).moved
    return Listed(step, wanted, wanted.true_mm(plan.bench, step.artefact, step.test), off_mm, moved)


def _named(plan: VerifyPlan) -> dict[str, str]:
    """What the profile's lists call an artefact → what the file does: the same, or by kind and size. Raises
    UlnaInputError."""
    wanted: dict[str, Wanted] = {}
    for table in plan.profile.file.test.values():
        wanted |= {each.name: each for each in kind_of(table.kind).artefacts(table) if each.SIZE is not None}
    there = plan.file.artefact
    names = {name: name for name, each in wanted.items() if name in there and each.fits(there[name])}
    for name, each in wanted.items():
        if name in names:
            continue
        alike = [own for own, other in wanted.items() if other.ranks_with(each) and own not in names]
        fitting = [own for own, table in there.items() if each.fits(table) and own not in names.values()]
        if len(fitting) < len(alike):
            raise UlnaInputError(
                worded(
                    "{path}: {names}: {count} artefacts of kind '{kind}' are to be touched, and {stated} are stated; "
                    "expected [artefact.NAME] of each, as its certificate has it. Add them.",
                    path=str(plan.path),
                    names=", ".join(alike),
                    count=len(alike),
                    kind=each.KIND,
                    stated=len(fitting),
                )
            )
        if len(fitting) > len(alike):
            raise UlnaInputError(
                worded(
                    "{path}: which of {stated} is to be touched as {names} is not said; expected as many of kind "
                    "'{kind}'. Leave out what is not touched.",
                    path=str(plan.path),
                    stated=", ".join(fitting),
                    names=", ".join(alike),
                    kind=each.KIND,
                )
            )
        alike.sort(key=lambda own: _nominal(wanted[own]))
        fitting.sort(key=lambda own: each.size_of(there[own]))
        names |= dict(zip(alike, fitting, strict=True))
    return names


def _nominal(wanted: Wanted) -> float:
    """By which those of one kind are told apart: how large they are in a list."""
    return 0.0 if wanted.SIZE is None else float(wanted.stated(APART_MM)[wanted.SIZE])
