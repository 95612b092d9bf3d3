"""A study in the compiled core: its arm, its readings, what is free and what is known beforehand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.conditions import Conditions
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.readings import Readings
from ulna.ground.arrays import F64, Bool
from ulna.ground.errors import UlnaInputError
from ulna.study.data import Noise, StudyData
from ulna.study.parameters import hold_mask, priors, start_arm

if TYPE_CHECKING:
    import ulna._core as _core


@dataclass(frozen=True)
class Assembled:
    """What the core works on: group k is ``study.readings[k]``."""

    problem: _core.Problem
    arm: Arm
    """The arm at the start, with the blocks beyond geometry that the study asks for."""
    names: list[str]
    """Of the parameters: the arm's, then the dimensions of artefacts that are fitted."""
    units: list[str]
    hold: Bool
    """(parameters,) true where not fitted."""


def assemble(study: StudyData, hold: Callable[[list[str]], Bool] | None = None) -> Assembled:
    """The study in the core. hold: what is held, by names, in place of what the study says. Raises UlnaInputError."""
    import ulna._core as _core

    arm = start_arm(study)
    noise = study.noise or Noise()
    try:
        problem = _core.Problem(arm.core, noise.encoder_rad, noise.seat_mm)
        for group in study.readings:
            balls, conditions = balls_mm(study, arm, group), conditions_of(study, arm, group)
            kind = kind_of(group.artefact)
            if study.noise is not None:
                kind.check_noise(group, str(study.label))
            kind.enter(problem, group, balls, conditions)
        names, units = problem.parameter_names, problem.parameter_units
        mask = hold_mask(study, names) if hold is None else hold(names)
        for parameter, (value, u) in priors(study, names, units, problem.parameters.tolist(), mask).items():
            problem.add_prior(parameter, value, u)
        problem.set_loss(study.fit.loss)
    except _core.UlnaError as error:
        raise UlnaInputError(f"{study.label}: {error}") from None
    return Assembled(problem, arm, names, units, mask)


def conditions_of(study: StudyData, arm: Arm, group: Readings) -> list[Conditions]:
    """Of each pose of a row: what the arm's tip depends on beside the angles. Raises UlnaInputError where the readings
    do not say it."""
    for condition, effect in arm.needs.items():
        if not all(condition.known(said[condition.said]) for said in group.said):
            path = study.files[int(group.file[0])].path if study.files else "in memory"
            raise UlnaInputError(
                f"{study.label}: artefact '{group.artefact.name}': the {effect.whose} of arm '{arm.name}' "
                f"{effect.does}, but its readings ({path}) {condition.unsaid}; expected {condition.columns}. Add it, "
                f"or leave '{effect.name}' out."
            )
    return [arm.conditions(len(group), **said) for said in group.said]


def balls_mm(study: StudyData, arm: Arm, group: Readings) -> F64:
    """(P,) diameters of the probes' balls, 0 where not known and not needed.

    Raises UlnaInputError where one is needed and not known, or too large for a hollow.
    """
    kind_of(group.artefact).check_probes(group.artefact, arm, np.unique(group.probe).tolist(), study.label)
    return np.array([probe.ball_mm or 0.0 for probe in arm.probes.values()])
