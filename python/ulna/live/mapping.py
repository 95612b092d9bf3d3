"""From channels to encoder angles q, rad: order and unit. Turns are counted; signs and zeros stay in the arm file."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError, nearest
from ulna.ground.worded import worded
from ulna.live.faults import WRAP, Fault
from ulna.live.samples import Hello, Samples
from ulna.live.tables import MapTable

TURN = {"deg": 360.0, "rad": 2 * math.pi}
"""Unit → a turn in it; of counts it is their number."""
AT_STOP_RAD = math.radians(2.0)
"""A joint at its stop may read so much beyond it."""


class Mapping:
    """Maps samples of one stream, in order: it remembers turns."""

    def __init__(self, table: MapTable, hello: Hello, path: Path = Path("source"), needed: bool = True) -> None:
        """Raises UlnaInputError where a channel is not there, or nobody says the unit though it is needed."""
        unit = table.unit or hello.unit
        names = list(hello.channels) if table.channels is None else table.channels
        for name in names:
            if name not in hello.channels:
                raise UlnaInputError(
                    f"{path}: key 'map.channels': got '{name}', which {hello.device} does not send."
                    f"{nearest(name, hello.channels)}"
                )
        if unit is None and needed:
            raise UlnaInputError(
                f'{path}: key \'map.unit\' is missing, and {hello.device} does not say it; expected "deg", "rad" or '
                '"counts". Add it.'
            )
        told = hello.counts_of(names)
        if told is not None and unit != "counts":
            raise UlnaInputError(
                f"{path}: key 'map.unit': got '{unit}', but {hello.device} sends counts. Leave it out, or correct it."
            )
        counts = told if table.counts_per_turn is None else table.counts_per_turn
        if unit == "counts" and counts is None:
            raise UlnaInputError(f"{path}: key 'map.counts_per_turn' is missing; expected it with counts. Add it.")
        turn = counts if unit == "counts" else math.inf if unit is None else TURN[unit]
        if isinstance(turn, list) and len(turn) != len(names):
            raise UlnaInputError(
                f"{path}: key 'map.counts_per_turn': {len(turn)} numbers for {len(names)} channels; expected one for "
                f"each."
            )
        if told is not None and counts is not None and not np.array_equal(np.broadcast_to(counts, len(names)), told):
            said = ", ".join(f"{each:g}" for each in told)
            raise UlnaInputError(
                f"{path}: key 'map.counts_per_turn': got {counts}, but {hello.device} says {said}; expected what the "
                "device says. Leave it out."
            )
        self.names = tuple(names)
        """Channels of q1, q2, …"""
        self.unit = unit
        """None: nobody says it, and there are no angles."""
        self.columns = [hello.channels.index(name) for name in names]
        """Their places in `Samples.raw`."""
        self.turn: F64 = np.broadcast_to(np.asarray(turn, dtype=float), (len(names),)).copy()
        """(n,) a turn, in the unit of the channels."""
        self.wraps = table.wraps
        self._travel_rad: F64 | None = None
        self._last: F64 | None = None
        self._turns = np.zeros(len(names))
        self._faults: list[Fault] = []

    def begin_within(self, travel_rad: F64 | None) -> None:
        """(n, 2) how far the joints turn, NaN where nobody says it: a stream that begins a turn or more outside begins
        inside, where there is such a turn. An encoder that begins again within a joint's travel cannot say it itself.
        """
        self._travel_rad = travel_rad

    def _first_turns(self, raw: F64) -> F64:
        """(n,) whole turns to begin with at (n,) readings."""
        none = np.zeros(len(self.columns))
        if self._travel_rad is None or not self.wraps:
            return none
        low, high = self._travel_rad.T
        sent = raw * (2 * math.pi / self.turn)
        turns = np.round(((low + high) / 2 - sent) / (2 * math.pi))
        outside = (sent < low - AT_STOP_RAD) | (sent > high + AT_STOP_RAD)
        moved = sent + 2 * math.pi * turns
        inside = (moved >= low - AT_STOP_RAD) & (moved <= high + AT_STOP_RAD)
        found: F64 = np.where(outside & inside, turns, none)
        return found

    def q_rad(self, samples: Samples, anew: tuple[int, ...] = ()) -> F64:
        """(N, n) encoder angles; anew: rows from which turns are counted from none (the device was reset). (N, 0) where
        nobody says the unit."""
        raw = samples.raw[:, self.columns]
        if not len(raw) or self.unit is None:
            return np.empty((len(raw), 0 if self.unit is None else len(self.columns)))
        q = np.empty_like(raw)
        begins = [0, *(at for at in anew if at > 0), len(raw)]
        for begin, end in pairwise(begins):
            if begin in anew:
                self._last, self._turns = None, np.zeros(len(self.columns))
            q[begin:end] = self._run(raw[begin:end], samples.t_host_s[begin:end])
        return q

    def _run(self, raw: F64, t_host_s: F64) -> F64:
        if self._last is None:
            self._turns = self._first_turns(raw[0])
        turns = np.broadcast_to(self._turns, raw.shape)
        if self.wraps:
            before = np.vstack([raw[:1] if self._last is None else self._last, raw[:-1]])
            turns = -np.round((raw - before) / self.turn)
            for row, column in zip(*np.nonzero(turns), strict=True):
                self._faults.append(
                    Fault(
                        WRAP,
                        float(t_host_s[row]),
                        worded(
                            "{name} began again: {before} → {now}. The turn is counted.",
                            name=self.names[column],
                            before=f"{before[row, column]:.6g}",
                            now=f"{raw[row, column]:.6g}",
                        ),
                    )
                )
            turns = self._turns + np.cumsum(turns, axis=0)
        self._last, self._turns = raw[-1], turns[-1]
        return (raw + turns * self.turn) * (2 * math.pi / self.turn)

    def faults(self) -> list[Fault]:
        """Wraps since the last call."""
        found, self._faults = self._faults, []
        return found
