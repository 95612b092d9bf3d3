"""What a channel's numbers are: steps, wraps, counts in a turn. Everything in the unit in which it is sent."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64, Bool
from ulna.ground.worded import worded
from ulna.live.guessing import TURNS, unit_of
from ulna.live.mapping import TURN

STATED = worded("As it was stated.")
_FEW = 10
"""Small differences that are whole steps by chance: one in 10⁵ times, as each is with a chance of a fifth."""
_LEAP = 0.8
"""Of all that a channel was seen to range over: a step of so much is no movement, the encoder began again."""
_LEAST_STEPS = 100
"""Steps of the encoder in that range, below which nothing is told from it."""
_NEAR = 0.01
"""Of a turn: an encoder that is sold, if what the wraps say is no farther from it."""


@dataclass(frozen=True)
class Wrap:
    """Where an encoder began again."""

    before: float
    after: float

    def __str__(self) -> str:
        return f"{self.before:.6g} → {self.after:.6g}"


def step_of(values: F64) -> float | None:
    """The step in which numbers come; None where they come in none that is seen. Numbers that were rounded when they
    were written differ by a little more or less: the middle of the smallest differences."""
    there = np.unique(values)
    apart = np.diff(there)
    if not len(apart):
        return None
    step = float(np.median(apart[apart < 1.5 * apart.min()]))
    few = apart[apart < 10.0 * step] / step
    evidence = len(there) <= len(values) / 2 or len(few) >= _FEW
    return step if evidence and (np.abs(few - np.round(few)) < 0.1).mean() > 0.9 else None


def wraps_of(raw: F64) -> tuple[list[Wrap], float | None]:
    """Where (N,) numbers began again, and how much a turn is by that; [] and None where they never did."""
    if len(raw) < 2:
        return [], None
    span, moves = float(np.ptp(raw)), np.diff(raw)
    leaps = np.abs(moves) > _LEAP * span
    at, others = np.flatnonzero(leaps), np.abs(moves[~leaps & (moves != 0.0)])
    usual = float(np.median(others)) if len(others) else 1.0  # between two counts and no others
    if not len(at) or span < _LEAST_STEPS * usual:
        return [], None
    # what the joint moved during the leap itself is as much as before and after it
    around = np.stack([moves[np.maximum(at - 1, 0)], moves[np.minimum(at + 1, len(moves) - 1)]])
    around = np.where(np.abs(around) > _LEAP * span, 0.0, around)
    turns = np.abs(moves[at] - around.mean(axis=0))
    return [Wrap(float(raw[k]), float(raw[k + 1])) for k in at], float(np.median(turns))


def counts_of(turn: float, span: float) -> tuple[float, bool]:
    """Counts per turn from what wraps say of it and the span of all counts seen; whether encoders with so many are
    sold."""
    near = [each for each in TURNS if abs(each - turn) <= _NEAR * each and each > span]
    if near:
        return float(min(near, key=lambda each: abs(each - turn))), True
    return float(round(span + 1.0 if abs(span + 1.0 - turn) <= _NEAR * turn else turn)), False


def unwrapped(raw: F64, turn: F64) -> F64:
    """(N, C) without wraps: steps of more than half a turn went the other way round. turn: (C,), inf: never."""
    turns = -np.round(np.diff(raw, axis=0, prepend=raw[:1]) / turn)
    counted = np.cumsum(turns, axis=0)
    gone: F64 = raw + np.where(counted == 0.0, 0.0, counted * np.where(np.isfinite(turn), turn, 0.0))
    return gone


def without_spikes(values: F64) -> F64:
    """(N, C): of each and its neighbours the middle one. A line that lost a digit moved no joint."""
    if len(values) < 3:
        return values
    middle: F64 = np.median(np.stack([values[:-2], values[1:-1], values[2:]]), axis=0)
    return np.vstack([middle[:1], middle, middle[-1:]])


class Known:
    """What is known of the unit and of each channel's turn, more with all that is seen."""

    def __init__(self, names: tuple[str, ...], unit: str | None, counts: F64 | None) -> None:
        """unit: as somebody stated it; counts: (C,) per turn as stated, NaN where not."""
        self.names = names
        self.joints: Bool = np.ones(len(names), dtype=bool)
        """(C,) whether a channel may be a joint's."""
        self.stated_unit = unit
        self.stated = np.full(len(names), np.nan) if counts is None else counts
        self._least, self._most = np.full(len(names), np.inf), np.full(len(names), -np.inf)
        self._whole: Bool = np.ones(len(names), dtype=bool)
        self._seen: F64 = np.full(len(names), np.nan)

    def see(self, raw: F64) -> None:
        """(N, C) what came."""
        if len(raw):
            self._least = np.minimum(self._least, raw.min(axis=0))
            self._most = np.maximum(self._most, raw.max(axis=0))
            self._whole &= (raw == np.round(raw)).all(axis=0)

    def see_wraps(self, raw: F64) -> None:
        """(N, C) of a whole step."""
        for k in np.flatnonzero(self.joints):
            turn = wraps_of(raw[:, k])[1]
            self._seen[k] = self._seen[k] if turn is None else turn

    def unit(self) -> tuple[str | None, str, float | None]:
        """Of the channels: deg, rad or counts, why, and what all their encoders may count in a turn."""
        moved = self.joints & (self._most > self._least)
        own = moved if moved.any() else self.joints
        size = float(np.abs([self._least[own], self._most[own]]).max())
        unit, why, turn = unit_of(bool(self._whole[own].all()), size)
        return (unit, why, turn) if self.stated_unit is None else (self.stated_unit, STATED, turn)

    def counts(self, channel: int) -> tuple[float | None, str]:
        """Counts per turn of a channel, by its wraps, else as stated, and why; None where neither says it."""
        stated = float(self.stated[channel])
        if np.isfinite(self._seen[channel]):
            span = float(self._most[channel] - self._least[channel])
            counts, sold = counts_of(float(self._seen[channel]), span)
            why = (
                worded("by where it began again")
                if sold
                else worded("about, by where it began again: no usual encoder has so many")
            )
            if np.isfinite(stated) and stated != counts:
                why = worded("{why}; {stated} was stated", why=why, stated=f"{stated:g}")
            return counts, why
        if np.isfinite(stated):
            return stated, worded("as it was stated")
        return None, worded("it never began again")

    def unwrapped(self, raw: F64) -> F64:
        """(N, C) of a whole step, turns counted. A turn of counts that is not known is seen where they begin again."""
        by = self.turn
        if self.unit()[0] not in TURN:
            began_again = np.array([bool(wraps_of(each)[0]) for each in raw.T])
            by = np.where(began_again, by, np.where(np.isfinite(self.stated), self.stated, np.inf))
        return unwrapped(raw, by)

    @property
    def turn(self) -> F64:
        """(C,) a turn of each channel, in its unit, as well as it is known by now: what joints are compared by."""
        unit, _, guessed = self.unit()
        if unit in TURN:
            return np.full(len(self.names), TURN[unit])
        each = [self.counts(k)[0] for k in range(len(self.names))]
        otherwise = guessed or max(float(self._most.max()), 1.0)
        return np.array([otherwise if count is None else count for count in each])
