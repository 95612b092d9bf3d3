"""One joint turned to its stops, then once in a direction that somebody says: its channel, its travel, its sign."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.worded import worded
from ulna.live.commission.counting import Known, Wrap, step_of, without_spikes, wraps_of
from ulna.live.mapping import TURN

MOVED_TURNS = 3.0 / 360.0
"""What turned by less was not turned."""
ALONG = 0.1
"""Of the joint's travel: a channel that moved by less was only touched."""
BOUND = 0.05
"""Of its own travel: what follows the joint's channel with no more left over hangs on it."""
ALIKE = 0.8
"""A channel that follows by so much of the other's turn may as well be the joint's own."""
ONE_WAY = 0.6
"""Of the travel: so much must be left between beginning and end of a turn in one direction."""


@dataclass(frozen=True)
class Along:
    """A channel that moves when another joint is turned."""

    name: str
    ratio: float
    """Its turns for one of the joint's channel."""


@dataclass(frozen=True)
class Turned:
    """What was found while one joint was turned."""

    joint: int
    """From 0, at the base."""
    channel: int | None = None
    name: str = ""
    low: float = 0.0
    """The lowest and highest that it went to, turns counted."""
    high: float = 0.0
    turns: float = 0.0
    """Between them."""
    step: float | None = None
    """In which its readings come; None where none is seen."""
    wraps: tuple[Wrap, ...] = ()
    counts_why: str = ""
    along: tuple[Along, ...] = ()
    """What hangs on it."""
    touched: tuple[tuple[str, float], ...] = ()
    """What moved a little besides, by name, with the degrees."""
    why_not: str | None = None
    """Why no channel is taken for the joint's."""

    @property
    def said(self) -> list[str]:
        """What it came to, a sentence each."""
        if self.why_not is not None:
            return [self.why_not]
        lines = [
            worded(
                "Joint {joint} is channel {name}: it went from {low} to {high}, {degrees}°.",
                joint=self.joint + 1,
                name=self.name,
                low=f"{self.low:.6g}",
                high=f"{self.high:.6g}",
                degrees=f"{360.0 * self.turns:.1f}",
            )
        ]
        if self.wraps:
            again, why = str(self.wraps[0]), self.counts_why
            lines.append(worded("Its encoder begins again ({again}): {why}.", again=again, why=why))
        lines += [
            worded(
                "{other} hangs on it: it turns by {ratio} of a turn with each of {name} (a coupling).",
                other=each.name,
                ratio=f"{each.ratio:.3g}",
                name=self.name,
            )
            for each in self.along
        ]
        lines += [
            worded("{name} moved by {degrees}° meanwhile: it is not this joint.", name=name, degrees=f"{degrees:.1f}")
            for name, degrees in self.touched
        ]
        return lines


@dataclass(frozen=True)
class Way:
    """What was found while a joint was turned in the direction that counts as positive."""

    joint: int
    sign: int = 0
    name: str = ""
    degrees: float = 0.0
    why_not: str | None = None

    @property
    def said(self) -> list[str]:
        """What it came to, a sentence each."""
        if self.why_not is not None:
            return [self.why_not]
        said = {"name": self.name, "degrees": f"{self.degrees:.1f}", "joint": str(self.joint + 1)}
        if self.sign > 0:
            return [worded("{name} rose by {degrees}°: sign = 1 of joint {joint}.", **said)]
        return [worded("{name} fell by {degrees}°: sign = -1 of joint {joint}.", **said)]


def travels(raw: F64, known: Known) -> tuple[F64, F64]:
    """(N, C) readings, turns counted, and (C,) by how many turns each channel moved that may be a joint's."""
    gone = known.unwrapped(raw)
    return gone, np.where(known.joints, np.ptp(without_spikes(gone), axis=0) / known.turn, 0.0)


def turned(joint: int, raw: F64, known: Known, taken: Mapping[int, int]) -> Turned:
    """(N, C) readings while one joint was turned to and fro, up to its stops. taken: channel → the joint (from 0) that
    it is already."""
    known.see_wraps(raw)
    gone, moved = travels(raw, known)
    turn = known.turn
    main = int(moved.argmax())
    name = known.names[main]
    if moved[main] < MOVED_TURNS:
        nothing = worded("Nothing moved: joint {joint} was not turned, or its encoder says nothing.", joint=joint + 1)
        return Turned(joint, why_not=nothing)
    along, touched, apart = list[Along](), list[tuple[str, float]](), list[int]()
    turns = without_spikes(gone) / turn
    for k in np.flatnonzero(moved >= MOVED_TURNS):
        if k == main:
            continue
        ratio, left = _follows(turns[:, main], turns[:, k])
        if left <= BOUND * moved[k]:
            along.append(Along(known.names[k], ratio))
        elif moved[k] < ALONG * moved[main]:
            touched.append((known.names[k], 360.0 * float(moved[k])))
        else:
            apart.append(int(k))
    if apart:
        also, *more = (
            worded("{name} by {degrees}°", name=known.names[k], degrees=f"{360.0 * moved[k]:.1f}") for k in apart[:3]
        )
        for each in more:
            also = worded("{one} and {other}", one=also, other=each)
        why = worded(
            "More than one joint was turned: {name} moved by {degrees}°, {also}. Turn one alone.",
            name=name,
            degrees=f"{360.0 * moved[main]:.1f}",
            also=also,
        )
        return Turned(joint, why_not=why)
    alike = [each.name for each in along if abs(each.ratio) > ALIKE]
    if alike:
        why = worded(
            "{name} and {other} moved alike: which of them is joint {joint} cannot be told. Name the channels of "
            "joints alone in [map] channels of a source file.",
            name=name,
            other=alike[0],
            joint=joint + 1,
        )
        return Turned(joint, why_not=why)
    if main in taken:
        why = worded(
            "{name} moved, which is joint {other} already. Turn joint {joint} alone.",
            name=name,
            other=taken[main] + 1,
            joint=joint + 1,
        )
        return Turned(joint, why_not=why)
    wraps = tuple(wraps_of(raw[:, main])[0])
    low, high = _ends(gone[:, main], raw[:, main], float(turn[main]), bool(wraps))
    counts, because = known.counts(main)
    counted = known.unit()[0] not in TURN and counts is not None
    return Turned(
        joint,
        main,
        name,
        low,
        high,
        float(moved[main]),
        step_of(raw[:, main]),
        wraps,
        worded("{counts} counts a turn, {why}", counts=f"{counts:g}", why=because)
        if counted
        else worded("turns are counted"),
        tuple(along),
        tuple(touched),
    )


def way(found: Turned, raw: F64, known: Known) -> Way:
    """(N, C) readings while the joint was turned once in the direction that counts as positive."""
    joint, main = found.joint, found.channel
    assert main is not None
    known.see_wraps(raw)
    gone, moved = travels(raw, known)
    if moved[main] < MOVED_TURNS:
        most = int(moved.argmax())
        other = {"name": known.names[most], "own": found.name}
        what = worded("{name} moved, not {own}", **other) if moved[most] >= MOVED_TURNS else worded("Nothing moved")
        return Way(joint, why_not=worded("{what}: joint {joint} was not turned.", what=what, joint=joint + 1))
    hanging = {each.name for each in found.along}
    others = [k for k, name in enumerate(known.names) if k != main and name not in hanging and moved[k] > moved[main]]
    if others:
        why = worded(
            "{name} moved more than {own}. Turn joint {joint} alone.",
            name=known.names[others[0]],
            own=found.name,
            joint=joint + 1,
        )
        return Way(joint, why_not=why)
    values = without_spikes(gone)[:, main]
    net = float(values[-1] - values[0])
    if abs(net) < ONE_WAY * np.ptp(values):
        why = worded(
            "{name} went both ways. Turn joint {joint} in one direction, and leave it.",
            name=found.name,
            joint=joint + 1,
        )
        return Way(joint, why_not=why)
    return Way(joint, 1 if net > 0 else -1, found.name, 360.0 * abs(net) / float(known.turn[main]))


def _follows(main: F64, other: F64) -> tuple[float, float]:
    """By how much another channel follows, and what is left of its movement, root mean square times two; in turns."""
    x, y = main - main.mean(), other - other.mean()
    ratio = float((x * y).sum() / (x * x).sum())
    return ratio, 2.0 * float(np.sqrt(np.mean((y - ratio * x) ** 2)))


def _ends(gone: F64, raw: F64, turn: float, wrapped: bool) -> tuple[float, float]:
    """Lowest and highest; where it went over the place where it begins again, with the middle among what is sent."""
    values = without_spikes(gone[:, None])[:, 0]
    low, high = float(values.min()), float(values.max())
    if wrapped:
        middle, seen = (low + high) / 2.0, (float(raw.min()) + float(raw.max())) / 2.0
        shift = -round((middle - seen) / turn) * turn
        low, high = low + shift, high + shift
    return low, high
