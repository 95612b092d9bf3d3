"""A study in the compiled core: its arm, its readings, what is free and what is known beforehand."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ulna.errors import UlnaInputError
from ulna.model import Arm
from ulna.parameters import hold_mask, priors, start_arm
from ulna.study import SURFACES, Artefact, Noise, Readings, Study

if TYPE_CHECKING:
    from ulna import _core

F64 = NDArray[np.float64]


@dataclass(frozen=True)
class Assembled:
    """What the core works on: group k is ``study.readings[k]``."""

    problem: _core.Problem
    arm: Arm
    """The arm at the start, with the blocks beyond geometry that the study asks for."""
    names: list[str]
    """Of the parameters: the arm's, then the dimensions of artefacts that are fitted."""
    units: list[str]
    hold: NDArray[np.bool_]
    """(parameters,) true where not fitted."""


def assemble(study: Study, hold: Callable[[list[str]], NDArray[np.bool_]] | None = None) -> Assembled:
    """The study in the core. hold: what is held, by names, in place of what the study says. Raises UlnaInputError."""
    from ulna import _core

    arm = start_arm(study)
    noise = study.noise or Noise()
    try:
        problem = _core.Problem(arm.core, noise.encoder_rad, noise.seat_mm)
        for group in study.readings:
            _ADD[group.artefact.kind](problem, study, arm, group)
        names, units = problem.parameter_names, problem.parameter_units
        mask = hold_mask(study, names) if hold is None else hold(names)
        for parameter, (value, u) in priors(study, names, units, problem.parameters.tolist(), mask).items():
            problem.add_prior(parameter, value, u)
        problem.set_loss(study.fit.loss)
    except _core.UlnaError as error:
        raise UlnaInputError(f"{study.label}: {error}") from None
    return Assembled(problem, arm, names, units, mask)


def warmth_k(study: Study, arm: Arm, group: Readings) -> F64 | None:
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


def _add_lengths(problem: _core.Problem, study: Study, arm: Arm, group: Readings) -> None:
    assert group.p_rad is not None
    assert group.length_mm is not None
    artefact = group.artefact
    uncertain = artefact.u_mm > 0.0 and len(group) > 0
    problem.add(
        "length",
        artefact.name,
        q_rad=np.ascontiguousarray(group.q_rad),
        p_rad=np.ascontiguousarray(group.p_rad),
        probe=group.probe,
        measured_mm=group.length_mm,
        dimensions=[("length", group.length_mm[0], artefact.u_mm, artefact.fitted)] if uncertain else [],
        warmth_k=warmth_k(study, arm, group),
    )


def _add_points(problem: _core.Problem, study: Study, arm: Arm, group: Readings) -> None:
    artefact = group.artefact
    features_mm = np.array(list(artefact.features.values()), dtype=np.float64).reshape(-1, 3)
    # of a bar the length is uncertain, of other artefacts every feature by itself
    bar = artefact.kind == "bar"
    each = artefact.feature_u_mm or [artefact.u_mm] * len(artefact.features)
    length_mm = float(np.linalg.norm(features_mm[1] - features_mm[0])) if bar else 0.0
    problem.add(
        "points",
        artefact.name,
        features_mm=features_mm,
        frame=artefact.frame,
        q_rad=np.ascontiguousarray(group.q_rad),
        probe=group.probe,
        feature=group.feature,
        placement=group.placement_code,
        dimensions=[("length", length_mm, artefact.u_mm, artefact.fitted)] if bar and artefact.u_mm > 0.0 else [],
        feature_u_mm=None if bar else np.array(each),
        features_fitted=artefact.fitted and not bar,
        labels=list(artefact.features),
        warmth_k=warmth_k(study, arm, group),
    )


def _add_sphere(problem: _core.Problem, study: Study, arm: Arm, group: Readings) -> None:
    artefact = group.artefact
    assert artefact.diameter_mm is not None
    problem.add(
        "sphere",
        artefact.name,
        dimensions=[("diameter", artefact.diameter_mm, artefact.u_mm, artefact.fitted)],
        balls_mm=balls_mm(study, arm, group),
        q_rad=np.ascontiguousarray(group.q_rad),
        probe=group.probe,
        placement=group.placement_code,
        inside=artefact.inside,
        warmth_k=warmth_k(study, arm, group),
    )


def _add_plane(problem: _core.Problem, study: Study, arm: Arm, group: Readings) -> None:
    problem.add(
        "plane",
        group.artefact.name,
        balls_mm=balls_mm(study, arm, group),
        q_rad=np.ascontiguousarray(group.q_rad),
        probe=group.probe,
        placement=group.placement_code,
        warmth_k=warmth_k(study, arm, group),
    )


_ADD: dict[str, Callable[..., Any]] = {
    "bar": _add_points,
    "seat": _add_points,
    "points": _add_points,
    "length": _add_lengths,
    "sphere": _add_sphere,
    "plane": _add_plane,
}


def balls_mm(study: Study, arm: Arm, group: Readings) -> F64:
    """(P,) diameters of the probes' balls, 0 where not needed.

    Raises UlnaInputError where one is needed and not known, or too large for a hollow.

    A plane touched with one probe does not need its ball: the plane lies by half of it farther in, that is all.
    """
    assert group.artefact.kind in SURFACES
    check_balls(group.artefact, arm, np.unique(group.probe).tolist(), study.label)
    return np.array([probe.ball_mm or 0.0 for probe in arm.probes.values()])


def check_balls(artefact: Artefact, arm: Arm, used: Sequence[int], label: str) -> None:
    """Whether the balls of the probes that are used can touch the surface, and are known where they matter.

    label: what messages call the file. Raises UlnaInputError.
    """
    names, balls = list(arm.probes), [probe.ball_mm for probe in arm.probes.values()]
    unknown = [k for k in used if balls[k] is None]
    if unknown and (artefact.kind == "sphere" or (artefact.kind == "plane" and len(used) > 1)):
        name = names[unknown[0]]
        raise UlnaInputError(
            f"{label}: artefact '{artefact.name}' is touched on its surface with probe '{name}', whose ball has no "
            f"diameter in arm '{arm.name}'; expected probe.{name}.ball, in the arm file's length unit. Add it."
        )
    wide = [k for k in used if artefact.inside and (balls[k] or 0.0) >= (artefact.diameter_mm or 0.0)]
    if wide:
        raise UlnaInputError(
            f"{label}: artefact '{artefact.name}' is a hollow of {artefact.diameter_mm:g} mm, but the ball of probe "
            f"'{names[wide[0]]}' has {balls[wide[0]]:g} mm; expected a smaller ball. Correct the diameters, or remove "
            "inside."
        )
