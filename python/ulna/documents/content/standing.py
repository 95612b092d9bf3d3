"""The arm as it stood: a pose in the middle of the readings, to be drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.documents.content.readings import ReadingRows
from ulna.documents.languages.said import Said
from ulna.ground.arrays import F64
from ulna.pictures.poses import start_pose, typical
from ulna.pictures.scene import Scene, scene
from ulna.study.study import Study


@dataclass(frozen=True)
class StandingArm:
    """What is drawn, in which pose."""

    scene: Scene
    q_rad: F64
    """(n,) encoder angles."""
    said: Said
    """What it is, for its caption."""


def standing_arm(arm: Arm, study: Study | None, rows: ReadingRows) -> StandingArm:
    """The calibrated arm in the pose of the reading that is nearest to the median of all; where the study is not known
    in its start pose. study: with the arm's own numbers of probes; rows: its readings, in their order."""
    if study is None or not len(rows.row):
        drawn = scene(arm)
        values: dict[str, Any] = {"probe": drawn.probe, "step": (f"{drawn.step_mm:g}",)}
        return StandingArm(drawn, start_pose(arm), Said("plot.arm-start", values))
    poses_rad = np.concatenate([group.q_rad for group in study.readings])
    k = typical(poses_rad)
    probe = int(np.concatenate([group.probe for group in study.readings])[k])
    drawn = scene(arm, list(arm.probes)[probe])
    values = {"probe": drawn.probe, "row": int(rows.row[k]), "file": rows.file[k], "step": (f"{drawn.step_mm:g}",)}
    return StandingArm(drawn, poses_rad[k], Said("plot.arm", values))
