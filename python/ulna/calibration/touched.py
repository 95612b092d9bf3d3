"""Where touches of an artefact put the tip, and what moves it there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.conditions import some_of
from ulna.artefacts.readings import Readings
from ulna.ground.arrays import F64
from ulna.study.assembly import conditions_of
from ulna.study.data import StudyData


@dataclass(frozen=True)
class Touched:
    """N readings of one artefact."""

    tips_mm: F64
    """(N, 3)"""
    by_parameter: F64
    """(N, 3, P) derivatives of the tip by the arm's parameters, mm per rad or mm."""
    by_encoders_mm2: F64
    """(N, 3, 3) covariance of the tip for the encoders' noise; zero where none was given."""


def touched(arm: Arm, study: StudyData, group: Readings, encoder_rad: F64 | None, second: bool = False) -> Touched:
    """encoder_rad (n,): standard deviation of each encoder; second: the other pose of rows that have two."""
    angles = group.p_rad if second else group.q_rad
    assert angles is not None
    said, core, rows = conditions_of(study, arm, group)[int(second)], arm.core, len(group)
    tips_mm, by_parameter = np.empty((rows, 3)), np.empty((rows, 3, len(arm.parameter_names)))
    by_encoders_mm2 = np.zeros((rows, 3, 3))
    for probe in np.unique(group.probe).tolist():
        own = np.flatnonzero(group.probe == probe)
        q_rad, there = np.ascontiguousarray(angles[own]), some_of(said, own)
        tips_mm[own] = core.tip(q_rad, probe, **there)
        by_parameter[own] = core.jacobian(q_rad, probe, **there)
        if encoder_rad is not None:
            moved = core.encoder_jacobian(q_rad, probe, **there) * encoder_rad
            by_encoders_mm2[own] = moved @ moved.transpose(0, 2, 1)
    return Touched(tips_mm, by_parameter, by_encoders_mm2)
