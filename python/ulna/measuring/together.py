"""How measured points err together: the arm's parameters are the same for all of them, readings' noise is not.

GUM 5.2.2 with the parameters' covariance C: the covariance of points a and b is J_a C J_bᵀ, and
J_q Σ_q J_qᵀ + s² 1 more where they are one point.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.conditions import Conditions, some_of
from ulna.arm.lost import lost_steps
from ulna.arm.reading_noise import ReadingNoise
from ulna.ground.arrays import F64, I64, Bool


@dataclass(frozen=True)
class Together:
    """Some poses of an arm whose `uncertainty` is set."""

    arm: Arm
    q_rad: F64
    """(K, n)"""
    probe: I64
    """(K,)"""
    noise: ReadingNoise
    all_conditions: Conditions
    """Of all points."""
    rows: I64
    """(K,) which of them these are."""

    def covariance_mm2(self, lost: Bool) -> F64:
        """(3K, 3K); NaN in rows and columns of the points (K,) that depend on what was not determined."""
        flat = self._by_parameter.reshape(-1, self._by_parameter.shape[2])
        found: F64 = flat @ self._parameters @ flat.T
        for k, own in enumerate(self._of_readings):
            # one point named twice has the same noise both times
            for other in np.flatnonzero(self.rows == self.rows[k]).tolist():
                found[3 * k : 3 * k + 3, 3 * other : 3 * other + 3] += own
        gaps = np.repeat(lost, 3)
        found[gaps, :] = np.nan
        found[:, gaps] = np.nan
        return found

    def lengths_u_mm(self, direction: F64) -> F64:
        """(K/2,) of the lengths between the first half of the poses and the second; direction (K/2, 3) from one to the
        other."""
        half = len(direction)
        apart = np.einsum("ki,kip->kp", direction, self._by_parameter[half:] - self._by_parameter[:half])
        variance = ((apart @ self._parameters) * apart).sum(axis=1)
        own = self._of_readings
        variance += np.einsum("ki,kij,kj->k", direction, own[half:] + own[:half], direction)
        u_mm: F64 = np.sqrt(np.maximum(variance, 0.0))
        u_mm[self._moved(apart)] = np.nan
        return u_mm

    @cached_property
    def _by_parameter(self) -> F64:
        """(K, 3, parameters)"""
        found = np.empty((len(self.q_rad), 3, len(self.arm.parameter_names)))
        for index in np.unique(self.probe).tolist():
            own = np.flatnonzero(self.probe == index)
            at = some_of(self.all_conditions, self.rows[own])
            found[own] = self.arm.core.jacobian(np.ascontiguousarray(self.q_rad[own]), index, **at)
        return found

    @cached_property
    def _of_readings(self) -> F64:
        """(K, 3, 3) mm²"""
        found = np.tile(self.noise.variance_mm2 * np.eye(3), (len(self.q_rad), 1, 1))
        if self.noise.encoder_rad is None:
            return found
        for index in np.unique(self.probe).tolist():
            own = np.flatnonzero(self.probe == index)
            at = some_of(self.all_conditions, self.rows[own])
            by_angle = self.arm.core.encoder_jacobian(np.ascontiguousarray(self.q_rad[own]), index, **at)
            found[own] += np.einsum("kij,j,klj->kil", by_angle, self.noise.encoder_rad**2, by_angle)
        return found

    @cached_property
    def _parameters(self) -> F64:
        known = self.arm.uncertainty
        assert known is not None
        return known.over(self.arm.parameter_names)

    def _moved(self, by_parameter: F64) -> Bool:
        """(m,) which of m values move by more than is nothing where a direction that was not determined goes as far as
        a drawing leaves open; those of the base frame do not count. by_parameter (m, parameters): derivatives, mm."""
        moved = np.abs(by_parameter @ lost_steps(self.arm).T)
        return np.asarray((moved > self.noise.moves_mm).any(axis=1))
