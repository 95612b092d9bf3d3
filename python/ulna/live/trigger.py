"""When a touch is taken: by itself where the tip rests, or where somebody asks for it and it rests. mm and s."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.worded import worded
from ulna.live.still import StillLimits, Stillness, stillness

NEAR_STOP_RAD = np.radians(0.5)
"""A joint so near to its stop leans on it."""
SAME_RAD = 2e-3
"""Poses whose joints differ by less are one: another touch there tells next to nothing."""


@dataclass(frozen=True)
class Refused:
    """Why there is no touch."""

    reason: str
    """A sentence for who holds the arm."""


@dataclass(frozen=True)
class Taken:
    """A dwell that is a touch."""

    q_rad: F64
    """(n,) mean encoder angles."""
    stillness: Stillness
    begun_s: float
    ended_s: float


@dataclass
class Trigger:
    """Watches windows of a stream; each rest of the tip is taken once."""

    limits: StillLimits
    stops_rad: F64 | None = None
    """(n, 2) where the joints' stops are; NaN where there is none, or nobody knows."""
    by_itself: bool = True
    """Whether a rest is a touch without being asked for."""
    last_mm: F64 | None = None
    """(3,) where the tip was at the last touch, or when the stream began: there is none before it has been away."""
    armed: bool = field(default=True)
    """Whether the next rest is taken. False at the beginning: an arm that lies there when somebody begins touches
    nothing."""

    def look(self, t_s: F64, q_rad: F64, p_mm: F64, covariance_mm2: F64) -> Taken | Refused | None:
        """The newest samples of a stream, (N,), (N, n), (N, 3): a touch, why there is none though the tip rests, or
        nothing yet. covariance_mm2: (3, 3) of one sample's tip."""
        if not self.armed:
            if self.last_mm is None:
                self.last_mm = p_mm[0]
            self.armed = bool(np.linalg.norm(p_mm[-1] - self.last_mm) > self.limits.rearm_mm)
        if not (self.by_itself and self.armed):
            return None
        window = self._window(t_s)
        if window is None:
            return None
        found = stillness(t_s[window], p_mm[window], covariance_mm2, self.limits)
        return self._taken(t_s[window], q_rad[window], p_mm[window], found) if found.still else None

    def ask(self, t_s: F64, q_rad: F64, p_mm: F64, covariance_mm2: F64) -> Taken | Refused:
        """The same, asked for by a key, a pedal or the arm's button."""
        window = self._window(t_s)
        if window is None:
            return Refused(
                worded(
                    "the stream is younger than {seconds} s, or has a gap: hold still and try again",
                    seconds=f"{self.limits.window_s:g}",
                )
            )
        found = stillness(t_s[window], p_mm[window], covariance_mm2, self.limits)
        if not found.still:
            moved = f"{max(found.drift_mm, 2.0 * found.spread_mm):.3f}"
            return Refused(worded("moved {moved} mm while touching: hold still", moved=moved))
        return self._taken(t_s[window], q_rad[window], p_mm[window], found)

    def _window(self, t_s: F64) -> slice | None:
        """The last samples, as many as a window has; None where they are fewer, or one is missing among them."""
        if len(t_s) < 2 or t_s[-1] - t_s[0] < self.limits.window_s * (1.0 - 1e-9):
            return None
        first = int(np.searchsorted(t_s, t_s[-1] - self.limits.window_s))
        gaps = np.diff(t_s[first:])
        # a stream that comes in bursts has its gaps; one of a fifth of the window hides what happened
        if len(gaps) < 2 or gaps.max() > 0.2 * self.limits.window_s:
            return None
        return slice(first, None)

    def _taken(self, t_s: F64, q_rad: F64, p_mm: F64, found: Stillness) -> Taken | Refused:
        self.armed, self.last_mm = False, p_mm[-1]
        mean_rad = q_rad.mean(axis=0)
        stop = self._at_stop(mean_rad)
        if stop is not None:
            return Refused(
                worded("joint {joint} is at its stop, where readings are wrong: take another posture", joint=stop)
            )
        return Taken(mean_rad, found, float(t_s[0]), float(t_s[-1]))

    def _at_stop(self, q_rad: F64) -> int | None:
        if self.stops_rad is None:
            return None
        low, high = self.stops_rad.T
        near = (q_rad < low + NEAR_STOP_RAD) | (q_rad > high - NEAR_STOP_RAD)
        return int(np.flatnonzero(near)[0]) + 1 if near.any() else None


def same_pose(q_rad: F64, others_rad: F64) -> int | None:
    """Which of (N, n) poses a pose is, within `SAME_RAD` in every joint; None where it is another."""
    if not len(others_rad):
        return None
    off = np.abs(np.remainder(others_rad - q_rad + np.pi, 2.0 * np.pi) - np.pi).max(axis=1)
    nearest = int(off.argmin())
    return nearest if off[nearest] < SAME_RAD else None
