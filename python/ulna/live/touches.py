"""Touches as they are taken one by one, and the same as readings of a study. Angles rad, lengths mm, times s."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.labels import Labels
from ulna.artefacts.readings import Readings
from ulna.ground.arrays import F64


@dataclass(frozen=True)
class Touch:
    """The ball in one place: the mean of a dwell, and how still it was."""

    number: int
    """From 1, in the order in which they were taken; never given twice."""
    artefact: str
    standing: str
    """Equal means the artefact was not moved in between."""
    feature: int
    """Index into the artefact's features, 0 where it has none."""
    probe: int
    """Index into the arm's probes."""
    q_rad: F64
    """(n,) mean encoder angles."""
    begun_s: float = 0.0
    """Of the dwell, as the source's host counts."""
    ended_s: float = 0.0
    samples: int = 1
    spread_mm: float = 0.0
    """Standard deviation of the tip about its mean, the largest of the three directions."""
    drift_mm: float = 0.0
    """How far the tip moved along a straight line over the dwell."""
    withdrawn: str | None = None
    """Why it does not count; None: it counts."""
    held_out: bool = False
    """Whether it is not fitted: kept to judge the fit by."""


def present(touches: Sequence[Touch]) -> list[Touch]:
    """Those that were not withdrawn, fitted or held out."""
    return [touch for touch in touches if touch.withdrawn is None]


def counting(touches: Sequence[Touch]) -> list[Touch]:
    """Those that are fitted."""
    return [touch for touch in present(touches) if not touch.held_out]


def held_out(touches: Sequence[Touch]) -> list[Touch]:
    """Those that are not, and judge the fit."""
    return [touch for touch in present(touches) if touch.held_out]


def leaf_of(touch: Touch, artefact: Artefact) -> tuple[str, str]:
    """What shares one unknown place with it: its artefact's standing; where nothing has to be placed, itself alone."""
    alone = not kind_of(artefact).placed(artefact)
    return touch.artefact, f"#{touch.number}" if alone else touch.standing


def readings_of(touches: Sequence[Touch], artefact: Artefact) -> Readings:
    """Touches of one artefact, in the order given, as a study has them."""
    count = len(touches)
    return Readings(
        artefact=artefact,
        q_rad=np.array([touch.q_rad for touch in touches], dtype=np.float64),
        p_rad=None,
        length_mm=None,
        probe=np.array([touch.probe for touch in touches], dtype=np.int64),
        feature=np.array([touch.feature for touch in touches], dtype=np.int64),
        placement=Labels.of(touch.standing for touch in touches),
        row=np.arange(1, count + 1),
        file=np.zeros(count, dtype=np.int64),
        id=np.array([str(touch.number) for touch in touches], dtype=object),
    )


def tips(arm: Arm, touches: Sequence[Touch]) -> F64:
    """(N, 3) where the tip was, mm, base frame."""
    q_rad = np.array([touch.q_rad for touch in touches])
    probe = np.array([touch.probe for touch in touches], dtype=np.int64)
    return arm.core.tip(q_rad, probe)


def as_dict(touch: Touch) -> dict[str, Any]:
    """As a journal has it: JSON types, every digit."""
    return asdict(touch) | {"q_rad": touch.q_rad.tolist()}


def from_dict(record: dict[str, Any]) -> Touch:
    """What `as_dict` made."""
    return Touch(**{**record, "q_rad": np.array(record["q_rad"], dtype=np.float64)})
