"""A hand that moves a virtual arm: from posture to posture as people do, with rests, and what goes wrong meanwhile.

A move has the least jerk for its time (Flash and Hogan, J. Neurosci. 5, 1985, 1688, eq. 5): of its way the part
``10 τ³ - 15 τ⁴ + 6 τ⁵`` is done after the part τ of its time, and its greatest speed is 15/8 of the mean.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64, Bool

FASTEST = 15.0 / 8.0
"""The greatest speed of a move over its mean."""
KNOCK_S, KNOCK_RAD = 0.04, 2e-3
"""How long a knock is felt, and how far it turns one joint at the most."""
GAP_S = 0.5
"""How long nothing comes."""
IDLE_S = 0.02
"""How long a hand that was told nothing waits before it looks again."""

Next = Callable[[], F64 | None]
"""Where to go: (n,) rad. None: nobody has said, the hand waits. Raises StopIteration where there is no more."""


@dataclass(frozen=True)
class Chances:
    """Of each rest, from 0 to 1."""

    knock: float = 0.0
    gap: float = 0.0
    reset: float = 0.0


ALL_WELL = Chances()


@dataclass
class _Leg:
    begin_s: float
    move_s: float
    end_s: float
    a_rad: F64
    b_rad: F64
    knock: tuple[float, int, float] | None = None
    """When, which joint, how far."""
    gap_s: float | None = None
    """From when on nothing comes."""
    reset_s: float | None = None


class Hand:
    """Moves an arm; its time is asked for in order."""

    def __init__(
        self, first_rad: F64, next_posture: Next, speed_rad_s: float, rest_s: float, chances: Chances, seed: int
    ) -> None:
        """Begins with a rest at the first posture. speed_rad_s: the fastest that a joint is turned."""
        self._next, self._speed, self._rest_s, self._chances = next_posture, speed_rad_s, rest_s, chances
        self._rng = np.random.default_rng([seed, 1])
        self._zero_rad = np.zeros_like(first_rad)
        self._leg = self._upset(_Leg(0.0, 0.0, rest_s, first_rad, first_rad))

    def at(self, t_s: F64) -> tuple[F64, F64, Bool]:
        """(N, n) where the joints are, (N, n) from where the device counts, and (N,) whether a sample comes, at (N,)
        rising times. Raises StopIteration where the first of them is after the last posture; times after it come no
        more."""
        q_rad = np.zeros((len(t_s), len(self._zero_rad)))
        zero_rad, comes = np.zeros_like(q_rad), np.zeros(len(t_s), dtype=bool)
        done = 0
        while done < len(t_s):
            upto = int(np.searchsorted(t_s, self._leg.end_s))
            if upto > done:
                own = slice(done, upto)
                q_rad[own], zero_rad[own], comes[own] = self._along(t_s[own])
                done = upto
            if done < len(t_s):
                try:
                    self._leg = self._following()
                except StopIteration:
                    if not done:
                        raise
                    return q_rad, zero_rad, comes
        return q_rad, zero_rad, comes

    def hurry(self, now_s: float) -> None:
        """Rests no longer."""
        leg = self._leg
        leg.end_s = min(leg.end_s, max(now_s, leg.begin_s + leg.move_s))

    def _along(self, t_s: F64) -> tuple[F64, F64, Bool]:
        leg = self._leg
        part = np.clip((t_s - leg.begin_s) / leg.move_s, 0.0, 1.0) if leg.move_s else np.ones_like(t_s)
        way = part**3 * (10.0 - 15.0 * part + 6.0 * part**2)
        q_rad = leg.a_rad + way[:, None] * (leg.b_rad - leg.a_rad)
        if leg.knock is not None:
            at_s, joint, far_rad = leg.knock
            felt = np.clip((t_s - at_s) / KNOCK_S, 0.0, 1.0)
            q_rad[:, joint] += far_rad * np.sin(np.pi * felt)
        zero_rad = np.broadcast_to(self._zero_rad, q_rad.shape).copy()
        if leg.reset_s is not None and (t_s >= leg.reset_s).any():
            self._zero_rad = leg.b_rad
            zero_rad[t_s >= leg.reset_s] = leg.b_rad
        comes = np.ones(len(t_s), dtype=bool)
        if leg.gap_s is not None:
            comes = (t_s < leg.gap_s) | (t_s >= leg.gap_s + GAP_S)
        return q_rad, zero_rad, comes

    def _following(self) -> _Leg:
        begin_s, here_rad = self._leg.end_s, self._leg.b_rad
        there_rad = self._next()
        if there_rad is None:
            return _Leg(begin_s, 0.0, begin_s + IDLE_S, here_rad, here_rad)
        far_rad = float(np.abs(there_rad - here_rad).max())
        move_s = FASTEST * far_rad / self._speed
        return self._upset(_Leg(begin_s, move_s, begin_s + move_s + self._rest_s, here_rad, there_rad))

    def _upset(self, leg: _Leg) -> _Leg:
        """With what goes wrong at its rest. As many numbers are drawn whatever the chances are: the moves of a seed are
        the same with and without."""
        upset, when, far = self._rng.random(3), self._rng.random(3), float(self._rng.uniform(-1.0, 1.0))
        joint = int(self._rng.integers(len(self._zero_rad)))
        rest_s = leg.end_s - leg.begin_s - leg.move_s
        knock_s, gap_s, reset_s = leg.end_s - rest_s + when * max(rest_s - KNOCK_S, 0.0)
        if upset[0] < self._chances.knock:
            leg.knock = (float(knock_s), joint, KNOCK_RAD * far)
        if upset[1] < self._chances.gap:
            leg.gap_s = float(gap_s)
        if upset[2] < self._chances.reset:
            leg.reset_s = float(reset_s)
        return leg
