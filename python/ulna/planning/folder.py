"""The folder of a plan: the list to follow, the machine form, an arm and a study for the readings, pictures."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ulna.arm.file import arm_toml
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.formats.output import output_folder
from ulna.ground.extras import need
from ulna.planning.data import PlanData, as_dict, steps
from ulna.planning.measurements import readings_of
from ulna.planning.planned import ARM, PLAN
from ulna.simulation.study_files import features_file, features_table, study_toml
from ulna.study.data import FitOptions, Noise
from ulna.study.study import Study

NEEDS_PICTURES = "the pictures of a plan"
STUDY, TABLE, WORK_SHEET = "study.toml", "plan.csv", "work-sheet.pdf"
PICTURES = ("places.svg", "places.png", "curve.svg", "curve.png", "arm.svg")


def files_of(artefact: Artefact) -> list[str]:
    """Names of all files that a plan of it writes."""
    own = [features_file(artefact)] if kind_of(artefact).features_file else []
    return [TABLE, PLAN, ARM, STUDY, *own, *PICTURES]


def save(plan: PlanData, folder: Path, force: bool = False, more: Mapping[str, bytes] | None = None) -> None:
    """Write all of `files_of` and some more, whole or not at all. Raises UlnaInputError."""
    need(NEEDS_PICTURES, "matplotlib")
    from ulna.planning import standing_arm
    from ulna.planning.plots import draw_curve, draw_places

    others = more or {}
    with output_folder(folder, [*files_of(plan.spec.artefact), *others], force) as staging:
        steps(plan).write_csv(staging / TABLE)
        text = json.dumps(as_dict(plan), indent=1, ensure_ascii=False, allow_nan=False)
        (staging / PLAN).write_text(text + "\n", encoding="utf-8")
        (staging / ARM).write_text(arm_toml(plan.arm), encoding="utf-8")
        (staging / STUDY).write_text(_study(plan), encoding="utf-8")
        if kind_of(plan.spec.artefact).features_file:
            features_table(plan.spec.artefact).write_csv(staging / features_file(plan.spec.artefact))
        draw_places(plan.stands, staging)
        picture = standing_arm.svg(plan.arm, plan.spec.probe, plan.stands, plan.q_rad[0, 0, 0])
        (staging / "arm.svg").write_text(picture, encoding="utf-8")
        paper = None if plan.paper is None else (plan.paper.measurements, plan.paper.u_length_mm)
        draw_curve(plan.curve, paper, staging)
        for name, content in others.items():
            (staging / name).write_bytes(content)


def _study(plan: PlanData) -> str:
    """A study of the readings to come: nothing that the plan knows is typed again."""
    spec = plan.spec
    encoder_rad = spec.encoder_rad if np.any(spec.encoder_rad) else None
    noise = None if encoder_rad is None and not spec.seat_mm else Noise(encoder_rad, spec.seat_mm or None)
    readings = readings_of(plan.arm, spec, plan.arm.probe_index(spec.probe), plan.q_rad)
    study = Study(None, plan.arm, [readings], noise, FitOptions(hold=list(spec.hold)))
    name = f"{spec.artefact.name}.csv"
    head = (
        f"# The readings go into {name} beside this file: placement and, where there are several, feature as in\n"
        f"# {TABLE}, and q1, q2, … as they were read.\n"
    )
    return head + study_toml(study, counts=False)
