"""What came out of planning, in memory: the measurements to take, the list for the operator, the machine form."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import Any

import numpy as np
import polars as pl

from ulna.arm.arm import Arm
from ulna.geometry.rigid import turned
from ulna.ground.arrays import F64
from ulna.planning.candidates import Candidates
from ulna.planning.result_file import FORMAT, asked_of, stand_entry
from ulna.planning.scene import Figures
from ulna.planning.spec import PlanSpec
from ulna.planning.stands import Stand, stands_of
from ulna.planning.touchable import touchable
from ulna.planning.trial import Trial


@dataclass(frozen=True)
class PlanData:
    """Measurements to take, in their order: see `ulna.planning.outcome.Plan`."""

    arm: Arm
    spec: PlanSpec
    chosen: Candidates
    """In order of work."""
    planned: Figures
    random: Figures
    """The mean of random sets of the same size."""
    paper: Figures | None
    """The mean of 101 random measurements; None where they do not determine what is free."""
    observability: dict[str, float]
    """O1 to O5."""
    random_observability: dict[str, float]
    curve: list[tuple[int, float, float]]
    """Number, then the root mean square length uncertainty (mm) of the best choice of so many and of random ones."""
    trial: Trial | None
    """The same by simulation; None where none was asked for, or where readings were taken already."""
    determined: int
    """Directions of the parameters that the candidates determine, of `free`."""
    free: int
    candidates: int
    seconds: dict[str, float]
    """Of drawing candidates with their rows, of what they are judged by, and of choosing."""

    @property
    def q_rad(self) -> F64:
        """(choose, K, touches, n) encoder angles."""
        return self.chosen.poses(np.arange(len(self.chosen)))

    @property
    def gain(self) -> float:
        """By which part the expected length uncertainty is smaller than that of random measurements."""
        return 1.0 - self.planned.u_length_mm / self.random.u_length_mm

    @property
    def stands(self) -> list[Stand]:
        """Where the artefact stands, in order of work."""
        return stands_of(self.chosen.place, self.chosen.features_mm)

    def as_dict(self) -> dict[str, Any]:
        """`plan.json`: JSON types only."""
        return as_dict(self)


def steps(plan: PlanData) -> pl.DataFrame:
    """One row a touch, in order of work: mm, base frame; angles in rad and in degrees.

    direction: from the first feature to the last; on a surface its outward normal at the touch. `stand`: equal while
    the artefact stays where it is. `placement`: one for each measurement, as a study wants it.
    """
    q_rad = plan.q_rad
    count, features, touches, n = q_rad.shape
    per = features * touches
    what = touchable(plan.spec, plan.arm, plan.arm.probe_index(plan.spec.probe))
    stands = np.repeat([stand.number for stand in plan.stands], [len(stand.measurements) for stand in plan.stands])
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
        "stand": np.repeat(stands, per),
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


def as_dict(plan: PlanData) -> dict[str, Any]:
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
        "stands": len(plan.stands),
        "asked": asked_of(spec),
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
        "places": [stand_entry(stand) for stand in plan.stands],
        "steps": steps(plan).to_dicts(),
    }
