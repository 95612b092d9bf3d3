"""Measuring what is in memory: arrays of encoder angles, frames."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ulna.arm.arm import Arm
from ulna.arm.conditions import Conditions, some_of
from ulna.arm.data import Loads
from ulna.arm.given import ArmLike, arm_and_noise
from ulna.arm.reading_noise import ReadingNoise
from ulna.formats.layout import Layout
from ulna.formats.tables.frame import frame_table
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError, wrong_type
from ulna.measuring.job import MeasureJob
from ulna.measuring.measured import Measured
from ulna.measuring.tip_uncertainty import WHOLE, TipUncertainty
from ulna.measuring.units import rad_per

READINGS = "readings: the path of a table, a table in memory, or an array of encoder angles"
FRAME = "frame"
"""How messages call a table in memory."""


def measure_array(
    given: ArmLike,
    angles: Any,
    probe: str | Sequence[str] | None,
    angle: str,
    encoder_u_rad: F64 | None,
    temperature_c: ArrayLike | None,
    approach: ArrayLike | None,
    payload: Loads = None,
) -> Measured:
    """Of an array (N, n), or (n,) of one pose. Raises UlnaInputError; ValueError for a wrong shape, TypeError for what
    is no array of numbers."""
    arm, noise = arm_and_noise(given)
    try:
        q = np.asarray(angles, dtype=np.float64)
    except (TypeError, ValueError):
        raise wrong_type(angles, READINGS) from None
    if q.ndim == 0:
        raise wrong_type(angles, READINGS)
    q = q[np.newaxis] if q.ndim == 1 else q
    if q.ndim != 2 or q.shape[1] != arm.n:
        raise ValueError(f"angles: expected (N, {arm.n}) encoder angles, got {np.shape(angles)}")
    if not np.isfinite(q).all():
        row, column = (int(at[0]) for at in np.nonzero(~np.isfinite(q)))
        raise UlnaInputError(
            f"angles: row {row} (counted from 0), joint {column + 1}: got {q[row, column]}, expected a finite number. "
            "Correct it or leave the row out."
        )
    q_rad = np.ascontiguousarray(q * rad_per(arm, angle))
    _check_turns(q_rad, arm, angle)
    index = _probe_indices(arm, probe, len(q))
    conditions = arm.conditions(len(q), temperature_c, approach, payload)
    return measured(arm, q_rad, index, conditions, noise.stated(encoder_u_rad))


def measure_frame(
    given: ArmLike,
    frame: Any,
    layout: Layout,
    probe: str | None,
    angle: str,
    encoder_u_rad: F64 | None,
    temperature_c: float | None,
    payload: str | None = None,
) -> Measured:
    """Of a table in memory with columns q1 … qn, perhaps id, probe, temperature, payload. Raises UlnaInputError naming
    row and column; TypeError for what is no table."""
    arm, noise = arm_and_noise(given)
    table = frame_table(frame, FRAME, layout)
    job = MeasureJob(arm, table, probe, angle, "mm", layout=layout, temperature_c=temperature_c, payload=payload)
    whole = job.whole()
    ids = whole.texts["id"].to_list() if "id" in whole.texts else None
    return measured(arm, whole.q_rad, whole.probe, whole.conditions, noise.stated(encoder_u_rad), ids)


def measured(
    arm: Arm,
    q_rad: F64,
    index: I64,
    conditions: Conditions,
    noise: ReadingNoise,
    ids: list[str] | None = None,
) -> Measured:
    """The points, and what is known of each of them. index (N,): into the arm's probes."""
    points_mm = arm.core.tip(q_rad, index, **conditions)
    covariance_mm2, notes = None, []
    if arm.uncertainty is not None:
        known = TipUncertainty(arm, noise)
        six = np.empty((len(q_rad), 6))
        for k in np.unique(index).tolist():
            own = np.flatnonzero(index == k)
            six[own] = known.covariance(np.ascontiguousarray(q_rad[own]), k, some_of(conditions, own))
        covariance_mm2, notes = six[:, WHOLE], known.notes
    names = list(arm.probes)
    probes = [names[k] for k in index.tolist()]
    return Measured(arm, q_rad, probes, points_mm, covariance_mm2, noise, notes, ids, conditions)


def _check_turns(q_rad: F64, arm: Arm, angle: str) -> None:
    """Angles beyond two turns of a joint that does not turn so far: of another unit, most likely. Raises
    UlnaInputError."""
    most = np.array([joint.most_rad for joint in arm.joints])
    beyond = np.abs(q_rad) > most
    joints = np.flatnonzero(beyond.any(axis=0))
    if not len(joints) or (len(joints) == 1 and arm.joints[int(joints[0])].goes_round):
        return
    k = int(joints[0])
    row = int(np.argmax(beyond[:, k]))
    raise UlnaInputError(
        f"angles: row {row} (counted from 0), joint {k + 1}: got {q_rad[row, k]:g} rad (angle = '{angle}'), more than "
        "two turns; expected angles within ±4π rad (720°) of a joint without limits. State the unit with angle "
        "('rad', 'deg', 'counts'); if the joint does turn that far, say so in the arm file: endless = true, or limits."
    )


def _probe_indices(arm: Arm, probe: str | Sequence[str] | None, count: int) -> I64:
    """(N,) of one probe for all, or of one name a row. Raises UlnaInputError for a name that is none."""
    if probe is None or isinstance(probe, str):
        return np.full(count, arm.probe_index(probe), dtype=np.int64)
    if len(probe) != count:
        raise ValueError(f"probe: expected one name, or {count}, got {len(probe)}")
    known = {name: arm.probe_index(name) for name in dict.fromkeys(map(str, probe))}
    return np.array([known[str(name)] for name in probe], dtype=np.int64)
