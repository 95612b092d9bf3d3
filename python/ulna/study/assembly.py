"""A study in the compiled core: its arm, its readings, what is free and what is known beforehand."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ulna.arm.arm import Arm
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
            balls, warmth = balls_mm(study, arm, group), warmth_k(study, arm, group)
            kind_of(group.artefact).enter(problem, group, balls, warmth)
        names, units = problem.parameter_names, problem.parameter_units
        mask = hold_mask(study, names) if hold is None else hold(names)
        for parameter, (value, u) in priors(study, names, units, problem.parameters.tolist(), mask).items():
            problem.add_prior(parameter, value, u)
        problem.set_loss(study.fit.loss)
    except _core.UlnaError as error:
        raise UlnaInputError(f"{study.label}: {error}") from None
    return Assembled(problem, arm, names, units, mask)


def warmth_k(study: StudyData, arm: Arm, group: Readings) -> F64 | None:
    """(N,) or (N, n): temperatures above 20 °C where the arm's links grow with them. Raises UlnaInputError where one is
    missing."""
    try:
        return arm.warmth_k(group.temperature_c, len(group))
    except UlnaInputError:
        path = study.files[int(group.file[0])].path if study.files else "in memory"
        raise UlnaInputError(
            f"{study.label}: artefact '{group.artefact.name}': the links of arm '{arm.name}' grow with temperature, "
            f"but its readings ({path}) do not all say how warm it was; expected a column temperature, °C, or one for "
            "each joint. Add it, or leave 'link-expansion' out."
        ) from None


def balls_mm(study: StudyData, arm: Arm, group: Readings) -> F64:
    """(P,) diameters of the probes' balls, 0 where not known and not needed.

    Raises UlnaInputError where one is needed and not known, or too large for a hollow.
    """
    kind_of(group.artefact).check_probes(group.artefact, arm, np.unique(group.probe).tolist(), study.label)
    return np.array([probe.ball_mm or 0.0 for probe in arm.probes.values()])
