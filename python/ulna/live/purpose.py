"""What a session touches, and what for: as a plan file says it, or a study."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from pathlib import Path

from ulna.arm.arm import Arm
from ulna.formats.toml import read_toml
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.planning.file import load_plan_spec
from ulna.planning.from_study import spec_of_study
from ulna.planning.refusals import check, free_parameters
from ulna.planning.spec import PlanSpec
from ulna.study.data import FitOptions
from ulna.study.file import study_file
from ulna.study.study import Study

WHAT = 'a plan file or a study (TOML, format = "ulna-plan/1" or "ulna-study/1")'
TAKEN = ("hold", "free", "known_length_mm", "known_angle_rad")
"""Of what a study says of its fit: what a session does as well."""
SILENT = ("judge_extras", "seed", "auto")
"""Of the rest: what changes nothing here, or is said by another key."""


@dataclass(frozen=True)
class Purpose:
    """What is touched, how it is fitted, and what was not taken over, in words."""

    spec: PlanSpec
    fit: FitOptions
    remarks: tuple[str, ...] = ()


def purpose_of(path: Path, arm: Arm, artefact: str | None = None, length_mm: float | None = None) -> Purpose:
    """As a file says it. artefact: which, of a study with several; length_mm: of the test bars, in place of the file's.
    Raises UlnaInputError for what no session can be made of."""
    document, _ = read_toml(path, WHAT)
    named = document.get("format")
    kind = named.partition("/")[0] if isinstance(named, str) else ""
    if kind not in _FILES:
        got = " is missing" if named is None else f": got {named!r}"
        raise UlnaInputError(
            f'{path}: key \'format\'{got}; expected "ulna-plan/1" or "ulna-study/1". Name a plan file or a study, or '
            "make a plan file: ulna plan ARM --make-plan PLAN."
        )
    found = _FILES[kind](path, arm, artefact)
    if length_mm is not None:
        found = replace(found, spec=replace(found.spec, test_mm=length_mm))
    check(arm, found.spec)
    free_parameters(arm, found.spec)
    return found


def _of_plan(path: Path, arm: Arm, artefact: str | None) -> Purpose:
    spec = load_plan_spec(path, arm)
    if artefact not in (None, spec.artefact.name):
        raise UlnaInputError(
            f"option --artefact: got '{artefact}', but {path} plans for '{spec.artefact.name}'; expected that one. "
            "Leave the option out."
        )
    return Purpose(spec, options_of(spec))


def options_of(spec: PlanSpec) -> FitOptions:
    """What is fitted of touches that follow a plan."""
    return FitOptions(hold=list(spec.hold), known_length_mm=spec.known_length_mm, known_angle_rad=spec.known_angle_rad)


def _of_study(path: Path, arm: Arm, artefact: str | None) -> Purpose:
    entries = study_file(path).readings
    waiting = not any((path.parent / entry.file).exists() for entry in entries)
    study = Study.waiting(path) if waiting else Study.load(path, "all")
    probes = {entry.probe for entry in entries if entry.artefact in (None, artefact) or artefact is None}
    spec = spec_of_study(study, arm, artefact, probes.pop() if len(probes) == 1 else None)
    count = sum(len(group) for group in study.readings)
    remarks = []
    if count:
        remarks.append(
            worded(
                "{path}: its {count} readings are not taken into the session; what is known begins from ARM.",
                path=str(path),
                count=count,
            )
        )
    other = _not_taken(study.fit)
    if other:
        remarks.append(
            f"{path}: of [fit] {', '.join(other)} is not taken into the session: ulna calibrate does that with the "
            "readings afterwards."
        )
    return Purpose(spec, FitOptions(**{key: getattr(study.fit, key) for key in TAKEN}), tuple(remarks))


def _not_taken(fit: FitOptions) -> list[str]:
    """Keys of [fit] that ask for something else than a session does."""
    usual = FitOptions()
    different = [
        each.name.removesuffix("_mm").removesuffix("_rad")
        for each in fields(FitOptions)
        if each.name not in (*TAKEN, *SILENT) and getattr(fit, each.name) != getattr(usual, each.name)
    ]
    return ["extras", *different] if fit.auto else different


_FILES: dict[str, Callable[[Path, Arm, str | None], Purpose]] = {"ulna-plan": _of_plan, "ulna-study": _of_study}
"""Format → who reads it."""
