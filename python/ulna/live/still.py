"""Whether the tip rests: spread and drift over a window, beside what the encoders' own noise explains. mm and s.

A hand that creeps spreads no more than noise does, a hand that trembles does not drift; so both are asked. Over a
window of N samples the tip's positions have a mean, a slope and what is left of both, whitened by the noise of one
sample:

- spread: the mean square of what is left, about 1 of 3 (N - 2) degrees of freedom where nothing moves;
- drift: the slope beside its own uncertainty, chi² of 3 degrees of freedom where nothing moves.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ulna.ground.arrays import F64
from ulna.live.tables import StillTable

SLOWEST_MM_S = 0.02
"""A hand that creeps no faster than this cannot be told from one that rests, in the time that a person waits."""
LEAST_TREMOR_MM = 0.01
"""Amplitude of a hand's tremor along one direction that must be noticed."""
WINDOWS_S = (0.3, 0.5, 0.8, 1.2, 2.0, 3.0)
"""How long a person may be asked to hold still: the shortest that tells is taken."""
REFUSED = 4.5
"""Standard deviations of the spread's mean square, above what noise alone gives, from which on the tip moves."""
CLEAR = 4.0
"""Standard deviations by which the slowest creep and the least tremor must be beyond the limits."""
DRIFT_CHI2 = 25.0
"""Of the slope, of 3 degrees of freedom: chance exceeds it once in 65 000 windows."""
OF_SEAT = 0.2
"""A drift of less than this part of the seat's own noise biases a touch by a tenth of it at the most: it is let pass.
"""
LEAST_SAMPLES = 12
REARM_MM = 2.0
"""The tip must have been so far from the last touch before there is another."""


@dataclass(frozen=True)
class StillLimits:
    """How long, and how still."""

    window_s: float
    samples: int
    """In a window, as the stream comes."""
    spread: float
    """Most mean square of the whitened spread, 1 where nothing moves."""
    drift_mm: float
    """A drift over the window that is let pass, whatever the noise is."""
    spread_mm: float | None = None
    """Most standard deviation of the tip, where somebody stated it: `spread` is not asked then."""
    drift_stated: bool = False
    """Whether `drift_mm` was stated: then it alone counts."""
    rearm_mm: float = REARM_MM
    """How far the tip must have been from the last touch."""
    sees: bool = True
    """Whether the slowest creep and the least tremor are told from rest: not at every rate and noise."""

    @classmethod
    def of(cls, noise_mm: float, rate_hz: float, seat_mm: float) -> StillLimits:
        """From the noise of one sample of the tip in one direction, the rate of the stream and the noise of a touch."""
        for window_s in WINDOWS_S:
            count = int(window_s * rate_hz) + 1
            if count < LEAST_SAMPLES:
                continue
            limits = cls(window_s, count, _most_spread(count), OF_SEAT * seat_mm)
            if limits._sees(noise_mm, rate_hz):
                return limits
        count = max(LEAST_SAMPLES, int(WINDOWS_S[-1] * rate_hz) + 1)
        return cls(max(WINDOWS_S[-1], count / rate_hz), count, _most_spread(count), OF_SEAT * seat_mm, sees=False)

    def lasting(self, window_s: float, rate_hz: float) -> StillLimits:
        """The same over another time."""
        count = max(LEAST_SAMPLES, int(window_s * rate_hz) + 1)
        return replace(self, window_s=window_s, samples=count, spread=_most_spread(count))

    def stated_by(self, table: StillTable, rate_hz: float) -> StillLimits:
        """What a source file says of it wins."""
        limits = self if table.seconds is None else self.lasting(table.seconds, rate_hz)
        if table.drift is not None:
            limits = replace(limits, drift_mm=table.drift, drift_stated=True)
        return replace(limits, spread_mm=table.spread, rearm_mm=table.rearm)

    def _sees(self, noise_mm: float, rate_hz: float) -> bool:
        if noise_mm <= 0.0:
            return True
        # a slope's standard deviation over the window, as the way that it goes
        slope_mm = noise_mm * np.sqrt(12.0 / self.samples)
        creep = SLOWEST_MM_S * self.window_s / slope_mm
        excess = LEAST_TREMOR_MM**2 / 2.0 / noise_mm**2 / 3.0
        scatter = np.sqrt(2.0 / (3.0 * (self.samples - 2)))
        return bool(creep > np.sqrt(DRIFT_CHI2) + CLEAR and excess > (REFUSED + CLEAR * (1.0 + excess)) * scatter)


def _most_spread(count: int) -> float:
    return 1.0 + REFUSED * float(np.sqrt(2.0 / (3.0 * (count - 2))))


@dataclass(frozen=True)
class Stillness:
    """A window of the tip's places."""

    samples: int
    seconds: float
    mean_mm: F64
    """(3,)"""
    spread_mm: float
    """Standard deviation about the mean, in the direction where it is largest."""
    drift_mm: float
    """How far the tip went over the window, along a straight line."""
    spread: float
    """Mean square of what is left beside the line, whitened: 1 where nothing moves."""
    drift_chi2: float
    """Of the slope: 3 where nothing moves."""
    still: bool


def stillness(t_s: F64, p_mm: F64, covariance_mm2: F64, limits: StillLimits) -> Stillness:
    """Of a window: (N,) times, (N, 3) places of the tip, (3, 3) covariance of one sample of it from the encoders."""
    count = len(t_s)
    mean_mm = p_mm.mean(axis=0)
    seconds = float(t_s[-1] - t_s[0])
    about_s = t_s - t_s.mean()
    square = float(about_s @ about_s)
    off_mm = p_mm - mean_mm
    slope = about_s @ off_mm / square if square > 0.0 else np.zeros(3)
    left_mm = off_mm - about_s[:, None] * slope
    # a direction in which the encoders have no noise still has that of rounding
    size = max(float(np.trace(covariance_mm2)), 1e-16)
    root = np.linalg.cholesky(covariance_mm2 + 1e-6 * size * np.eye(3))
    white = np.linalg.solve(root, left_mm.T)
    along = np.linalg.solve(root, slope)
    spread = float((white**2).sum() / max(1, 3 * (count - 2)))
    drift_chi2 = float(along @ along) * square
    drift_mm = float(np.linalg.norm(slope)) * seconds
    own = np.linalg.eigvalsh(off_mm.T @ off_mm / max(1, count - 1))
    spread_mm = float(np.sqrt(max(own[-1], 0.0)))
    return Stillness(
        samples=count,
        seconds=seconds,
        mean_mm=mean_mm,
        spread_mm=spread_mm,
        drift_mm=drift_mm,
        spread=spread,
        drift_chi2=drift_chi2,
        still=_quiet(spread, spread_mm, limits) and _in_place(drift_chi2, drift_mm, limits),
    )


def _quiet(spread: float, spread_mm: float, limits: StillLimits) -> bool:
    return spread <= limits.spread if limits.spread_mm is None else spread_mm <= limits.spread_mm


def _in_place(drift_chi2: float, drift_mm: float, limits: StillLimits) -> bool:
    return drift_mm <= limits.drift_mm or (drift_chi2 <= DRIFT_CHI2 and not limits.drift_stated)
