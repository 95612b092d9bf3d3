"""A plan on disk: the list for the operator, the machine form, the pictures."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from ulna.formats.output import output_folder
from ulna.planning.plan import Plan
from ulna.planning.scene import Figures
from ulna.planning.touchable import touchable, turned

FORMAT = "ulna-plan-result/1"
FILES = ["plan.csv", "plan.json", "places.svg", "places.png", "curve.svg", "curve.png"]


def save(plan: Plan, folder: Path, force: bool = False) -> None:
    """Write FILES, whole or not at all. Raises UlnaInputError."""
    from ulna.planning.plots import draw_curve, draw_places

    with output_folder(folder, FILES, force) as staging:
        steps(plan).write_csv(staging / "plan.csv")
        text = json.dumps(as_dict(plan), indent=1, ensure_ascii=False, allow_nan=False)
        (staging / "plan.json").write_text(text + "\n", encoding="utf-8")
        draw_places(plan, staging)
        draw_curve(plan, staging)


def steps(plan: Plan) -> pl.DataFrame:
    """One row a touch, in order of work: mm, base frame; angles in rad and in degrees.

    direction: from the first feature to the last; on a surface its outward normal at the touch. `stand`: equal while
    the artefact stays where it is. `placement`: one for each measurement, as a study wants it.
    """
    q_rad = plan.q_rad
    count, features, touches, n = q_rad.shape
    per = features * touches
    what = touchable(plan.spec, plan.arm, plan.arm.probe_index(plan.spec.probe))
    stands = np.concatenate([[0], np.cumsum(np.diff(plan.chosen.place) != 0)])
    points = plan.chosen.features_mm[plan.chosen.place]
    if what.outward is None:
        away = points[:, -1] - points[:, 0]
        length = np.linalg.norm(away, axis=1, keepdims=True)
        direction = np.divide(away, length, out=np.zeros_like(away), where=length > 0).repeat(per, axis=0)
    else:
        direction = turned(what.at_mm, points, what.outward).reshape(-1, 3)
    each = np.repeat(points, touches, axis=1).reshape(-1, 3).round(2)
    columns: dict[str, Any] = {
        "step": np.arange(1, count * per + 1),
        "stand": np.repeat(stands + 1, per),
        "placement": np.repeat(np.arange(1, count + 1), per),
        "artefact": [plan.spec.artefact.name] * (count * per),
        ("feature" if what.outward is None else "touch"): [name for name in what.names for _ in range(touches)] * count,
        "probe": [plan.spec.probe or next(iter(plan.arm.probes))] * (count * per),
    }
    columns |= {axis: each[:, k] for k, axis in enumerate("xyz")}
    columns |= {f"direction_{axis}": direction[:, k].round(4) for k, axis in enumerate("xyz")}
    flat = q_rad.reshape(-1, n)
    columns |= {f"q{k + 1}": flat[:, k].round(6) for k in range(n)}
    columns |= {f"q{k + 1}_deg": np.degrees(flat[:, k]).round(2) for k in range(n)}
    return pl.DataFrame(columns)


def as_dict(plan: Plan) -> dict[str, Any]:
    """`plan.json`: JSON types only, no NaN."""
    spec = plan.spec

    def of(figures: Figures | None) -> dict[str, Any] | None:
        return None if figures is None else dataclasses.asdict(figures)

    trial = None if plan.trial is None else dataclasses.asdict(plan.trial) | {"gain": plan.trial.gain}
    return {
        "format": FORMAT,
        "arm": plan.arm.name,
        "artefact": spec.artefact.name,
        "criterion": spec.criterion,
        "choose": spec.choose,
        "touches": spec.touches,
        "stands": len(np.unique(plan.chosen.place)),
        "candidates": plan.candidates,
        "seed": spec.seed,
        "parameters": plan.free,
        "determined": plan.determined,
        "planned": of(plan.planned),
        "random": of(plan.random),
        "paper": of(plan.paper),
        "gain": plan.gain,
        "trial": trial,
        "observability": plan.observability,
        "random_observability": plan.random_observability,
        "curve": [
            {"measurements": count, "u_length_mm": own, "random_u_length_mm": by_chance}
            for count, own, by_chance in plan.curve
        ],
        "seconds": plan.seconds,
        "steps": steps(plan).to_dicts(),
    }
