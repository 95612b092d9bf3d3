"""How uncertain a measured point is: from the calibration's covariance and, where stated, the encoders' noise.

GUM's law of propagation: C_tip = J C Jᵀ + J_q Σ_q J_qᵀ. Where the tip depends on something that the calibration could
not determine, no uncertainty is quoted and the reason is told.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ulna.model import Arm

F64 = NDArray[np.float64]

MOVES_MM = 1e-6
"""A lost direction matters at a pose where a step of one unit along it moves the tip by more than this, mm."""


class TipUncertainty:
    """Standard uncertainties of tip coordinates of a calibrated arm; collects notes on what it cannot say."""

    def __init__(self, arm: Arm, encoder_u_rad: F64 | None = None) -> None:
        """`arm.uncertainty` must be set; `encoder_u_rad` (n,): standard deviation of each encoder reading."""
        assert arm.uncertainty is not None
        self._core = arm.core
        self._probe_names = list(arm.probes)
        index = {name: k for k, name in enumerate(arm.parameter_names)}
        known = [k for k, name in enumerate(arm.uncertainty.names) if name in index]
        self._columns = np.array([index[arm.uncertainty.names[k]] for k in known], dtype=np.int64)
        self._covariance = np.ascontiguousarray(arm.uncertainty.matrix[np.ix_(known, known)])
        self._estimated = bool(np.isfinite(self._covariance).all())
        self._lost = [direction for direction in arm.uncertainty.lost if not direction.get("frame", False)]
        self._lost_columns = np.array(sorted({index[n] for d in self._lost for n in d["combination"]}), dtype=np.int64)
        self._directions = np.zeros((len(self._lost), len(self._lost_columns)))
        for row, direction in enumerate(self._lost):
            for name, weight in direction["combination"].items():
                self._directions[row, np.searchsorted(self._lost_columns, index[name])] = weight
        self._encoder_variance = None if encoder_u_rad is None else np.asarray(encoder_u_rad, dtype=np.float64) ** 2
        self._told: dict[tuple[int, int], None] = {}

    def of(self, q_rad: F64, probe: int) -> F64:
        """(N, n) → (N, 3) mm; NaN where the tip depends on what was not determined."""
        if not self._estimated:
            return np.full((len(q_rad), 3), np.nan)
        variance = np.zeros((len(q_rad), 3))
        if len(self._columns):
            variance += self._core.tip_covariance(q_rad, probe, self._columns, self._covariance)[:, (0, 3, 5)]
        if self._encoder_variance is not None:
            jacobian = self._core.encoder_jacobian(q_rad, probe)
            variance += np.einsum("nij,nij,j->ni", jacobian, jacobian, self._encoder_variance)
        u_mm: F64 = np.sqrt(np.maximum(variance, 0.0))
        if self._lost:
            moved = self._core.direction_effect(q_rad, probe, self._lost_columns, self._directions) > MOVES_MM
            if moved.any():
                u_mm[moved] = np.nan
                self._tell_which(q_rad[moved], probe)
        return u_mm

    def _tell_which(self, q_rad: F64, probe: int) -> None:
        for row in range(len(self._lost)):
            if (row, probe) in self._told:
                continue
            effect_mm = self._core.direction_effect(q_rad, probe, self._lost_columns, self._directions[row : row + 1])
            if (effect_mm > MOVES_MM).any():
                self._told[row, probe] = None

    @property
    def notes(self) -> list[str]:
        """What was left empty, why, and what to do about it."""
        if not self._estimated:
            return [
                "u_x, u_y, u_z are left empty: the calibration had no degrees of freedom to estimate uncertainties "
                "from. Calibrate with more readings, or state the noise in the study."
            ]
        return [_note(self._lost[row], self._probe_names[probe]) for row, probe in self._told]


def _note(direction: dict[str, Any], probe: str) -> str:
    names = ", ".join(direction["combination"])
    return (
        f"u_x, u_y, u_z are left empty where points of probe '{probe}' depend on a combination of {names} that the "
        f"calibration could not determine: {direction['because']} {direction['remedy']}"
    )
