"""How uncertain a measured point is: from the calibration's covariance, and from how readings
scatter.

GUM's law of propagation: C_tip = J C Jᵀ + J_q Σ_q J_qᵀ + s² 1, s the scatter of a touch as the calibration's readings
had it, and what its model did not explain. Where the tip depends on something that the calibration could
not determine, no uncertainty is quoted and the reason is told.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.conditions import NOTHING, Conditions, some_of
from ulna.arm.directions import worth_naming
from ulna.arm.lost import lost_steps
from ulna.arm.reading_noise import UNKNOWN, ReadingNoise
from ulna.ground.arrays import F64
from ulna.work.cores import available_cores

COVARIANCE = ("c_xx", "c_xy", "c_xz", "c_yy", "c_yz", "c_zz")
"""Columns of a point's covariance matrix, its upper triangle row by row."""
DIAGONAL = [0, 3, 5]
"""Of them."""
WHOLE = [[0, 1, 2], [1, 3, 4], [2, 4, 5]]
"""Where the elements of the matrix stand among them."""

_BLOCK_ROWS = 16384
"""Rows that one thread takes at a time."""

WITHOUT_NOISE = (
    "How its readings scatter is not in the uncertainties: nothing is known of it. An arm alone does not bring it: "
    "give the result of its calibration, or state encoder_u_rad."
)


class TipUncertainty:
    """Standard uncertainties of tip coordinates of a calibrated arm; collects notes on what it cannot say."""

    def __init__(self, arm: Arm, noise: ReadingNoise = UNKNOWN) -> None:
        """`arm.uncertainty` must be set."""
        assert arm.uncertainty is not None
        self._core = arm.core
        self._probe_names = list(arm.probes)
        self._covariances = [_covariance(arm, name, noise.encoder_rad) for name in arm.probes]
        self._own_mm2, self._moves_mm, self._noise_known = noise.variance_mm2, noise.moves_mm, noise.known
        self._unknown = arm.uncertainty.why_none
        self._lost = [direction for direction in arm.uncertainty.lost if not direction.get("frame", False)]
        directions = lost_steps(arm)
        self._lost_columns = np.flatnonzero(directions.any(axis=0))
        self._directions = np.ascontiguousarray(directions[:, self._lost_columns])
        self._told: dict[tuple[int, int], None] = {}
        self._pool = ThreadPoolExecutor(available_cores())

    def of(self, q_rad: F64, probe: int, conditions: Conditions = NOTHING) -> F64:
        """(N, n) → (N, 3) standard uncertainties, mm; NaN as for `covariance`."""
        u_mm: F64 = np.sqrt(np.maximum(self.covariance(q_rad, probe, conditions)[:, DIAGONAL], 0.0))
        return u_mm

    def covariance(self, q_rad: F64, probe: int, conditions: Conditions = NOTHING) -> F64:
        """(N, n) → (N, 6) mm²: xx, xy, xz, yy, yz, zz of the tip's covariance matrix.

        NaN where the tip depends on what was not determined. conditions: as `Arm.conditions`.
        """
        if self._unknown is not None:
            return np.full((len(q_rad), 6), np.nan)

        def block(start: int) -> F64:
            rows = slice(start, start + _BLOCK_ROWS)
            return self._block(q_rad[rows], probe, some_of(conditions, rows))

        found = np.concatenate([np.empty((0, 6)), *self._pool.map(block, range(0, len(q_rad), _BLOCK_ROWS))])
        if self._lost:
            moved = self._effect_mm(q_rad, probe, conditions, self._directions) > self._moves_mm
            if moved.any():
                found[moved] = np.nan
                self._tell_which(q_rad[moved], probe, some_of(conditions, moved))
        return found

    def _block(self, q_rad: F64, probe: int, conditions: Conditions) -> F64:
        parameters = np.arange(len(self._covariances[probe]), dtype=np.int64)
        found = self._core.tip_covariance(q_rad, probe, parameters, self._covariances[probe], **conditions)
        found[:, DIAGONAL] += self._own_mm2
        return found

    def _effect_mm(self, q_rad: F64, probe: int, conditions: Conditions, directions: F64) -> F64:
        return self._core.direction_effect(q_rad, probe, self._lost_columns, directions, **conditions)

    def _tell_which(self, q_rad: F64, probe: int, conditions: Conditions) -> None:
        for row in range(len(self._lost)):
            if (row, probe) in self._told:
                continue
            if (self._effect_mm(q_rad, probe, conditions, self._directions[row : row + 1]) > self._moves_mm).any():
                self._told[row, probe] = None

    @property
    def notes(self) -> list[str]:
        """What was left empty, why, and what to do about it."""
        if self._unknown is not None:
            return [f"u_x, u_y, u_z are left empty: {self._unknown.because}. {self._unknown.remedy}"]
        lost = [_note(self._lost[row], self._probe_names[probe]) for row, probe in self._told]
        return lost if self._noise_known else [WITHOUT_NOISE, *lost]


def _covariance(arm: Arm, probe: str, encoder_u_rad: F64 | None) -> F64:
    """(parameters, parameters), standing for the calibration and, for this probe, the encoders; zero where held.

    An encoder's noise acts as noise of its joint's zero offset (turn = sign q - theta0); of a last joint that has none,
    as noise of the tip across its axis: the tip turns with it.
    """
    known = arm.uncertainty
    assert known is not None
    names = arm.parameter_names
    whole = known.over(names)
    if encoder_u_rad is not None:
        linked = arm.n if arm.full_last_link else arm.n - 1
        offsets = [names.index(f"joint.{k}.theta0") for k in range(1, linked + 1)]
        whole[offsets, offsets] += encoder_u_rad[:linked] ** 2
        if arm.full_last_link:
            return whole
        tip = [names.index(f"probe.{probe}.{axis}") for axis in "xyz"]
        x_mm, y_mm, _ = arm.probes[probe].tip_mm
        across = np.array([-y_mm, x_mm, 0.0])
        whole[np.ix_(tip, tip)] += encoder_u_rad[-1] ** 2 * np.outer(across, across)
    return whole


def _note(direction: dict[str, Any], probe: str) -> str:
    names = ", ".join(worth_naming(direction["combination"]))
    because, remedy = (direction[key].rstrip(".") for key in ("because", "remedy"))
    return (
        f"u_x, u_y, u_z are left empty where points of probe '{probe}' depend on a combination of {names} that the "
        f"calibration could not determine. Why: {because}. Remedy: {remedy}."
    )
