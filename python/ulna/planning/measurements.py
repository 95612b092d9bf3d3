"""Measurements of a plan as readings in the core."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.labels import Labels
from ulna.artefacts.readings import Readings
from ulna.ground.arrays import F64
from ulna.planning.spec import PlanSpec
from ulna.planning.touchable import spread_of

if TYPE_CHECKING:
    import ulna._core as _core


def as_certified(readings: Readings) -> Readings:
    """The readings of an artefact that is as its certificate has it: what is uncertain of it is not what a plan can
    mend."""
    return replace(readings, artefact=kind_of(readings.artefact).certain(readings.artefact))


def problem_of(arm: Arm, spec: PlanSpec, probe: int, q_rad: F64) -> _core.Problem:
    """The core's problem of measurements (count, K, t, n), each a placement of its own, readings exact."""
    import ulna._core as _core

    problem = _core.Problem(arm.core, spec.encoder_rad, spec.seat_mm)
    readings = readings_of(arm, spec, probe, q_rad)
    balls_mm = np.array([each.ball_mm or 0.0 for each in arm.probes.values()])
    kind_of(spec.artefact).enter(problem, as_certified(readings), balls_mm, [arm.conditions(len(readings))])
    return problem


def readings_of(arm: Arm, spec: PlanSpec, probe: int, q_rad: F64) -> Readings:
    """The same measurements as readings, placements numbered from 1."""
    count, features, touches, n = q_rad.shape
    per = features * touches
    kind = kind_of(spec.artefact)
    each = np.tile(np.repeat(np.arange(features), touches), count)
    return Readings(
        artefact=spec.artefact,
        q_rad=np.ascontiguousarray(q_rad.reshape(-1, n)),
        p_rad=None,
        length_mm=_measured_mm(spec, arm, probe, count),
        probe=np.full(count * per, probe, dtype=np.int64),
        feature=each if kind.named else np.zeros_like(each),
        placement=Labels(np.repeat(np.arange(count), per), [str(number + 1) for number in range(count)]),
        row=np.arange(1, count * per + 1),
        file=np.zeros(count * per, dtype=np.int64),
    )


def _measured_mm(spec: PlanSpec, arm: Arm, probe: int, count: int) -> F64 | None:
    """What is measured along with each row of so many measurements, exactly; None where nothing is."""
    kind, artefact = kind_of(spec.artefact), spec.artefact
    if kind.measured_column is None or not kind.scattered:
        return None
    return kind.measured_mm(artefact, artefact, spread_of(spec, arm, probe), count, np.random.default_rng(0))
