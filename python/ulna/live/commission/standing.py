"""An arm that stands in a posture: what each channel reads there, in the unit in which it is sent."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.worded import listed, worded
from ulna.live.commission.counting import Known


@dataclass(frozen=True)
class Stood:
    """What was found while an arm was held in the posture."""

    at: tuple[float, ...]
    """(C,) of each channel, the middle of its readings."""
    joints: tuple[tuple[int, str, float], ...]
    """Of each joint that was found: its number from 1, its channel, what that reads."""
    why_not: str | None = None

    @property
    def said(self) -> list[str]:
        """What it came to, a sentence each."""
        if self.why_not is not None:
            return [self.why_not]
        each = [worded("{value} (joint {joint})", value=f"{value:.6g}", joint=k) for k, _, value in self.joints]
        return [worded("It reads {each}.", each=listed(each))]


def stood(raw: F64, known: Known, rest: int, channels: dict[int, str]) -> Stood:
    """(N, C) readings until the arm rested; rest: how many of the last ones are of that; channels: of joints from 0.

    The middle is taken along the shorter way round, as an encoder may begin again there.
    """
    own = raw[-rest:]
    off = own - own[-1]
    turn = known.turn
    off = off - np.where(np.isfinite(turn), np.round(off / turn) * turn, 0.0)
    at = own[-1] + np.median(off, axis=0)
    joints = tuple((k + 1, name, float(at[known.names.index(name)])) for k, name in sorted(channels.items()))
    return Stood(tuple(at.tolist()), joints)
