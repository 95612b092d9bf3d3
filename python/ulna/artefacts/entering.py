"""How readings enter the core that several kinds give it alike."""

from __future__ import annotations

import numpy as np

import ulna._core as _core
from ulna.arm.conditions import Conditions
from ulna.artefacts.kind import features_mm
from ulna.artefacts.readings import Readings
from ulna.ground.arrays import F64


def enter_points(problem: _core.Problem, group: Readings, u_mm: float | F64, conditions: Conditions) -> None:
    """Touches of features. u_mm: of a bar one number, its length's; else (F,) of each feature."""
    artefact = group.artefact
    problem.add_points(
        artefact.name,
        features_mm(artefact),
        artefact.frame,
        np.ascontiguousarray(group.q_rad),
        group.probe,
        group.feature,
        group.placement_code,
        u_mm,
        list(artefact.features),
        artefact.fitted,
        **conditions,
    )
