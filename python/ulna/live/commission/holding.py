"""An arm held still: noise, step and drift of each channel, in the unit in which it is sent."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.worded import listed, worded
from ulna.live.commission.counting import Known, step_of
from ulna.live.guessing import role_of

LEAST = 50
"""Readings from which a standard deviation is known to a tenth: 1/√(2·50)."""
_BLOCK_S = 0.5
_SLOW = 0.6
"""Of the scatter that is left in means over half a second: noise, also smoothed, has less; what moved has all of it."""
_MOVED_TURNS = 0.3 / 360.0
"""Of a turn: whoever held it let go."""
ROLES = {"clock": worded("clock"), "counter": worded("counter"), "button": worded("button")}
"""What a channel may be that is no joint's."""


@dataclass(frozen=True)
class Held:
    """A channel of an arm that was held still."""

    name: str
    role: str
    """channel; or clock, counter: no joint."""
    noise: float
    """Standard deviation about its drift; of a quantised reading at least step/√12."""
    step: float | None
    """In which it comes; None where none was seen."""
    drift: float
    """From the first reading to the last."""
    constant: bool = False
    """Whether every reading was the same."""


@dataclass(frozen=True)
class Holding:
    """What was found while an arm was held still."""

    channels: tuple[Held, ...]
    seconds: float
    readings: int
    why_not: str | None = None
    """Why nothing can be said of it."""

    @property
    def said(self) -> list[str]:
        """What it came to, a sentence each."""
        if self.why_not is not None:
            return [self.why_not]
        others = [each for each in self.channels if each.role != "channel"]
        lines = [worded("{count} readings in {time} s.", count=self.readings, time=f"{self.seconds:.1f}")]
        return lines + [
            worded("{name} is a {role}, not a joint: it is left out.", name=each.name, role=ROLES[each.role])
            for each in others
        ]


def held(t_s: F64, raw: F64, known: Known) -> Holding:
    """(N,) times and (N, C) readings of an arm that was to be still."""
    n, seconds = len(raw), float(t_s[-1] - t_s[0]) if len(t_s) else 0.0
    if n < LEAST or seconds <= 0.0:
        few = worded("{count} readings in {time} s: too few to tell their noise.", count=n, time=f"{seconds:.1f}")
        return Holding((), seconds, n, few)
    known.see_wraps(raw)  # where it was held, an encoder may begin again with the noise
    turn = known.turn
    gone = known.unwrapped(raw)
    found, moving = [], []
    for k, name in enumerate(known.names):
        role = role_of(raw[:, k], t_s)[0]
        one, moved = _channel(name, "channel" if role == "button" else role, t_s - t_s[0], gone[:, k], float(turn[k]))
        found.append(one)
        if moved and one.role == "channel":
            by = f"{max(abs(one.drift), 2.0 * one.noise):.4g}"
            moving.append(worded("{name} by {much}", name=name, much=by))
    still = worded("It was not still: {which}. Hold it, or lay it down.", which=listed(moving[:4]))
    why = still if moving else None
    return Holding(tuple(found), seconds, n, why)


def _channel(name: str, role: str, t_s: F64, values: F64, turn: float) -> tuple[Held, bool]:
    """A channel, and whether it moved."""
    if not np.ptp(values):
        return Held(name, role, 0.0, None, 0.0, constant=True), False
    slope, _ = np.polyfit(t_s, values, 1)
    left = values - values.mean() - slope * (t_s - t_s.mean())
    spread = float(np.sqrt((left**2).sum() / (len(left) - 2)))
    drift = float(slope * t_s[-1])
    block = np.minimum((t_s / _BLOCK_S).astype(int), max(int(t_s[-1] / _BLOCK_S) - 1, 0))
    counts = np.bincount(block)
    means = (np.bincount(block, weights=left) / np.maximum(counts, 1))[counts > 0]
    step = step_of(values)
    least = step or 0.0
    crept = float(means.std()) > _SLOW * spread and spread > 2.0 * least
    moved = crept or abs(drift) > max(_MOVED_TURNS * turn, 3.0 * spread, 3.0 * least)
    return Held(name, role, max(spread, least / math.sqrt(12.0)), step, drift), moved
