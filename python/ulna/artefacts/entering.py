"""How readings enter the core that several kinds give it alike."""

from __future__ import annotations

from typing import Any

import numpy as np

import ulna._core as _core
from ulna.arm.conditions import Conditions
from ulna.artefacts.artefact import features_mm
from ulna.artefacts.readings import Readings
from ulna.ground.arrays import F64


def enter_rows(problem: _core.Problem, kind: str, group: Readings, conditions: Conditions, **stated: Any) -> None:
    """Rows as the core's `kind`; stated: what the artefact says of itself, see `_core.Problem.add`."""
    q_rad = np.ascontiguousarray(group.q_rad)
    problem.add(kind, group.artefact.name, q_rad=q_rad, probe=group.probe, **stated, **conditions)


def enter_points(problem: _core.Problem, group: Readings, conditions: Conditions, **stated: Any) -> None:
    """Touches of features."""
    artefact = group.artefact
    enter_rows(
        problem,
        "points",
        group,
        conditions,
        features_mm=features_mm(artefact),
        labels=list(artefact.features),
        frame=artefact.frame,
        feature=group.feature,
        placement=group.placement_code,
        **stated,
    )


def enter_surface(
    problem: _core.Problem, kind: str, group: Readings, balls_mm: F64, conditions: Conditions, **stated: Any
) -> None:
    """Touches of something that stands somewhere, with balls (P,) of the arm's probes, as the core's `kind`."""
    enter_rows(problem, kind, group, conditions, balls_mm=balls_mm, placement=group.placement_code, **stated)
