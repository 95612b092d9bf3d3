"""What can be planned, and what cannot: each refusal says why and what to do."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.kinds import kind_of
from ulna.ground.arrays import I64
from ulna.ground.errors import UlnaInputError
from ulna.planning.candidates import EACH
from ulna.planning.spec import PlanSpec
from ulna.study.data import FitOptions
from ulna.study.parameters import hold_mask
from ulna.study.study import Study

MOST_TOUCHES = 1_000_000
"""Of surfaces, of all candidates together: a row each."""
LEAST_CANDIDATES = 1000
"""Fewer stand in fewer than ten places, which do not show everything that the arm can be asked."""


def free_parameters(arm: Arm, spec: PlanSpec) -> I64:
    """Indices of the parameters that will be fitted. Raises UlnaInputError for a vain pattern."""
    path = Path(spec.label) if spec.files else None
    study = Study(path, arm, [], fit=FitOptions(hold=list(spec.hold)))
    free = np.flatnonzero(~hold_mask(study, arm.parameter_names))
    if not len(free):
        raise UlnaInputError(f"{spec.label}: every parameter is held; expected some to plan for. Hold fewer.")
    return free


def check(arm: Arm, spec: PlanSpec) -> None:
    """Raises UlnaInputError for what no plan can be made of."""
    kind = kind_of(spec.artefact)
    kind.check_planned(spec.artefact, spec.touches, spec.label)
    if spec.artefact.fitted:
        raise UlnaInputError(
            f"{spec.label}: artefact '{spec.artefact.name}' has fit = true; expected it as its certificate has it, "
            "which a plan takes as known. Remove fit."
        )
    kind.check_probes(spec.artefact, arm, [arm.probe_index(spec.probe)], spec.label)
    if kind.scattered:
        if spec.candidates * spec.touches > MOST_TOUCHES:
            raise UlnaInputError(
                f"{spec.label}: {spec.candidates} candidates of {spec.touches} touches each; expected at most "
                f"{MOST_TOUCHES} touches in all. Lower candidates or touches."
            )
    elif len(spec.artefact.features) * spec.touches < 2 and spec.artefact.frame == "free":
        raise UlnaInputError(
            f"{spec.label}: one touch of one feature tells nothing, for its place is unknown; expected touches of 2 or "
            "more. Raise touches."
        )
    arm.check_covered(spec.label, "plans")
    arm.check_turns(spec.label, "plans")
    if spec.candidates < LEAST_CANDIDATES:
        raise UlnaInputError(
            f"{spec.label}: {spec.candidates} candidates; expected {LEAST_CANDIDATES} or more: of few places nobody "
            "sees what the arm's volume would tell. Raise candidates."
        )
    places = spec.candidates // EACH
    if spec.artefact.frame == "free" and places < (spec.placements or 0) < spec.choose:
        raise UlnaInputError(
            f"{spec.label}: {spec.placements} placements, but {spec.candidates} candidates stand in "
            f"{places} places; expected as many or more. Raise candidates."
        )
    if spec.choose > spec.candidates:
        raise UlnaInputError(
            f"{spec.label}: {spec.choose} measurements to choose of {spec.candidates} candidates; expected more "
            "candidates. Raise candidates."
        )
    if spec.taken is not None:
        if spec.taken.arm.parameter_names != arm.parameter_names:
            raise UlnaInputError(
                f"{spec.label}: the study of the readings taken is of arm '{spec.taken.arm.name}', with other "
                f"parameters than '{arm.name}'; expected the same joints and probes. Name another study."
            )
        for group in spec.taken.readings:
            if kind_of(group.artefact).scattered:
                raise UlnaInputError(
                    f"{spec.label}: readings taken of artefact '{group.artefact.name}' are of a {group.artefact.kind}; "
                    "expected bar, seat, points or length. Leave them out of the study."
                )
