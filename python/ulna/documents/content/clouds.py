"""Residuals over what may cause them: each joint's angle, the reach, the temperature; and in space."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import polars as pl

from ulna.arm.arm import Arm
from ulna.arm.conditions import Conditions, some_of
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.readings import Readings
from ulna.ground.arrays import F64, I64
from ulna.study.assembly import conditions_of
from ulna.study.study import Study

RANGES = 24
"""Equal ranges of an abscissa in which means are taken."""
TURN_RAD = 2.0 * np.pi
FEWEST = 3
"""Readings in a range that give a mean with an uncertainty."""
ARROW = 0.08
"""Of the extent of all tips: how long the longest but a twentieth of the vectors are drawn."""


@dataclass(frozen=True)
class Trend:
    """Means over equal ranges of an abscissa: what a cloud hides."""

    x: F64
    """(B,) middle of each range; ranges with fewer than three readings are left out."""
    mean_mm: F64
    u_mm: F64
    """(B,) standard uncertainty of each mean."""


@dataclass(frozen=True)
class Cloud:
    """Residuals over something."""

    over: str
    """"joint", "reach" or "temperature"."""
    joint: int
    """From 1; 0 where it is no joint (or one temperature for all)."""
    x: F64
    """(N,) degrees, mm or °C."""
    residual_mm: F64
    """(N,) over a joint: along the motion of the tip (or the change of the length) that this joint causes, signed;
    else the residual's size."""
    reading: I64
    """(N,) index into `Readings`; length rows appear twice, once for each pose."""
    trend: Trend
    slides: bool = False
    """Of a prismatic joint: x is mm."""


@dataclass(frozen=True)
class Quiver:
    """Residual vectors in space. Touches of surfaces, whose residual has no direction of its own, are not in it."""

    at_mm: F64
    """(N, 3) the tip, in the base frame; of length rows the second pose."""
    vector_mm: F64
    """(N, 3) the residual; of length rows along the length."""
    reading: I64
    """(N,) index into `Readings`."""

    @property
    def arrow_factor(self) -> float:
        """By how much vectors are drawn longer than they are: 1, 2 or 5 times a power of ten."""
        size = float(np.quantile(np.linalg.norm(self.vector_mm, axis=1), 0.95))
        extent = float(np.linalg.norm(np.ptp(self.at_mm, axis=0)))
        if not size > 0.0 or not extent > 0.0:
            return 1.0
        wanted = ARROW * extent / size
        power = 10.0 ** math.floor(math.log10(wanted))
        return float(power * max(step for step in (1.0, 2.0, 5.0) if step * power <= wanted))


class _Poses:
    """Poses of the readings of one artefact: tips, directions of residuals, signs."""

    def __init__(self, study: Study, arm: Arm, group: Readings, rows: pl.DataFrame, first: int) -> None:
        self.kind = group.artefact.kind
        poses = [group.q_rad] if group.p_rad is None else [group.q_rad, group.p_rad]
        conditions = conditions_of(study, arm, group)
        probe = group.probe
        self.q_rad = np.concatenate(poses)
        self.reading = np.tile(np.arange(first, first + len(group)), len(poses))
        self.temperature_c = None if group.temperature_c is None else np.concatenate([group.temperature_c] * len(poses))
        self.size_mm = np.tile(rows["norm_mm"].to_numpy(), len(poses))
        tips = [arm.core.tip(np.ascontiguousarray(q), probe, **at) for q, at in zip(poses, conditions, strict=True)]
        self.tip_mm = np.concatenate(tips)
        by_joint = [_encoder_jacobian(arm, q, probe, at) for q, at in zip(poses, conditions, strict=True)]
        if group.p_rad is not None:
            along = tips[1] - tips[0]
            along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-300)
            self.vector_mm: F64 | None = along * rows["length_mm"].to_numpy()[:, None]
            # the length changes with a joint by the part of the tip's motion along it, less that of the other pose
            change = np.concatenate(
                [-np.einsum("nkj,nk->nj", by_joint[0], along), np.einsum("nkj,nk->nj", by_joint[1], along)]
            )
            self.along_joint_mm: F64 | None = np.sign(change) * np.tile(rows["length_mm"].to_numpy(), 2)[:, None]
        elif not kind_of(group.artefact).named:
            self.vector_mm = self.along_joint_mm = None
        else:
            vector_mm = rows.select("x_mm", "y_mm", "z_mm").to_numpy()
            moved = np.linalg.norm(by_joint[0], axis=1)
            along = np.einsum("nkj,nk->nj", by_joint[0], vector_mm)
            # a joint whose axis goes through the tip moves it nowhere
            self.vector_mm = vector_mm
            self.along_joint_mm = np.where(moved > 1e-9, along / np.maximum(moved, 1e-300), 0.0)


def _encoder_jacobian(arm: Arm, q_rad: F64, probe: I64, conditions: Conditions) -> F64:
    """(N, 3, n), each row with its own probe."""
    found = np.empty((len(q_rad), 3, arm.n))
    for index in np.unique(probe).tolist():
        own = probe == index
        found[own] = arm.core.encoder_jacobian(np.ascontiguousarray(q_rad[own]), index, **some_of(conditions, own))
    return found


def clouds(study: Study, arm: Arm, residuals: pl.DataFrame) -> tuple[list[Cloud], Quiver | None]:
    """Of the fitted readings. arm: the calibrated arm, with the study's probes in the study's order."""
    parts: list[_Poses] = []
    first = 0
    for group in study.readings:
        parts.append(_Poses(study, arm, group, residuals[first : first + len(group)], first))
        first += len(group)
    found: list[Cloud] = []
    pointed = [part for part in parts if part.along_joint_mm is not None]
    for joint in range(arm.n if pointed else 0):
        x, slides = np.concatenate([part.q_rad[:, joint] for part in pointed]), arm.joints[joint].slides
        x = x if slides else np.degrees(folded_rad(x))
        y = np.concatenate([part.along_joint_mm[:, joint] for part in pointed if part.along_joint_mm is not None])
        reading = np.concatenate([part.reading for part in pointed])
        found.append(_cloud("joint", joint + 1, x, y, reading, slides))
    reach = np.linalg.norm(np.concatenate([part.tip_mm for part in parts]), axis=1)
    size = np.concatenate([part.size_mm for part in parts])
    found.append(_cloud("reach", 0, reach, size, np.concatenate([part.reading for part in parts])))
    found += _over_temperature(parts)
    return found, _quiver(parts)


def folded_rad(angle_rad: F64) -> F64:
    """(N,) encoder angles as they are, where they are within one turn; else folded into the turn that begins in the
    middle of the widest gap.

    What depends on a joint's angle comes again after a turn, so that a joint that turned several times is one turn
    wide; and a cloud that lies about the encoder's zero, or is a turn off, is not torn apart.
    """
    if not len(angle_rad) or float(np.ptp(angle_rad)) <= TURN_RAD:
        return angle_rad
    turned = np.sort(angle_rad % TURN_RAD)
    gaps = np.diff(np.append(turned, turned[0] + TURN_RAD))
    widest = int(np.argmax(gaps))
    begin = (turned[widest] + 0.5 * gaps[widest]) % TURN_RAD
    # as near to zero as a turn can be
    begin -= TURN_RAD if begin >= np.pi else 0.0
    found: F64 = begin + (angle_rad - begin) % TURN_RAD
    return found


def _over_temperature(parts: list[_Poses]) -> list[Cloud]:
    warm = [part for part in parts if part.temperature_c is not None and np.isfinite(part.temperature_c).any()]
    if not warm:
        return []
    wide = max(
        1 if part.temperature_c is None or part.temperature_c.ndim == 1 else part.q_rad.shape[1] for part in warm
    )
    found = []
    for column in range(wide):
        x = np.concatenate([_column(part.temperature_c, column) for part in warm])
        known = np.isfinite(x)
        size = np.concatenate([part.size_mm for part in warm])[known]
        reading = np.concatenate([part.reading for part in warm])[known]
        found.append(_cloud("temperature", 0 if wide == 1 else column + 1, x[known], size, reading))
    return found


def _column(temperature_c: F64 | None, column: int) -> F64:
    assert temperature_c is not None
    return temperature_c if temperature_c.ndim == 1 else temperature_c[:, column]


def _cloud(over: str, joint: int, x: F64, residual_mm: F64, reading: I64, slides: bool = False) -> Cloud:
    return Cloud(over, joint, x, residual_mm, reading, trend(x, residual_mm), slides)


def trend(x: F64, value_mm: F64) -> Trend:
    """Means in `RANGES` equal ranges of x, with their standard uncertainties s/√n."""
    low, high = float(x.min()), float(x.max())
    if not high > low:
        return Trend(np.zeros(0), np.zeros(0), np.zeros(0))
    edges = np.linspace(low, high, RANGES + 1)
    bin_of = np.clip(np.searchsorted(edges, x, side="right") - 1, 0, RANGES - 1)
    count = np.bincount(bin_of, minlength=RANGES)
    kept = count >= FEWEST
    n = np.maximum(count, 1)
    mean = np.bincount(bin_of, value_mm, RANGES) / n
    spread = np.bincount(bin_of, (value_mm - mean[bin_of]) ** 2, RANGES) / np.maximum(count - 1, 1)
    middle = 0.5 * (edges[1:] + edges[:-1])
    return Trend(middle[kept], mean[kept], np.sqrt(spread / n)[kept])


def _quiver(parts: list[_Poses]) -> Quiver | None:
    at, vector, reading = [], [], []
    for part in parts:
        if part.vector_mm is None:
            continue
        at.append(part.tip_mm[-len(part.vector_mm) :])
        vector.append(part.vector_mm)
        reading.append(part.reading[-len(part.vector_mm) :])
    if not at:
        return None
    return Quiver(np.concatenate(at), np.concatenate(vector), np.concatenate(reading))
