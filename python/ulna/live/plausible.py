"""What no arm does between two samples, and what no clock does: each is named once."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ulna.ground.arrays import F64, Bool
from ulna.ground.worded import listed, worded
from ulna.live.faults import CLOCK_JUMP, DOUBTFUL, GAP, JUMP, REPEAT, RESET, SWAP, WRAP, Fault
from ulna.live.mapping import Mapping
from ulna.live.samples import Samples
from ulna.live.tables import LimitsTable

_PERIODS_OF_A_GAP = 5.0
_LEAST_GAP_S = 0.05
_GAP_S, _PERIOD_S = 2.0, 0.02
"""Until the period is known."""
_NEAR_ZERO = 0.005
"""Of a turn: a device that was reset does not start exactly at 0 when somebody holds the arm."""
_TICKS_S = (2.0**32 * 1e-6, 2.0**32 * 1e-3)
"""When a device's clock of 32 bits begins again: µs after 71.6 min, ms after 49.7 days."""
_CLOCK_S = 1.0
"""So much a device's clock may be ahead of ours from one sample to the next: packets wait on their way."""


class _Row(NamedTuple):
    t_host_s: float
    t_device_s: float | None
    raw: F64


class Plausible:
    """Looks at samples of one stream, in order."""

    def __init__(self, mapping: Mapping, limits: LimitsTable, rate_hz: float | None = None) -> None:
        self._mapping = mapping
        self._speed = limits.speed / (2 * np.pi)  # turns a second
        self._gap_s = limits.gap
        self.period_s: float | None = None if not rate_hz else 1.0 / rate_hz
        """Between two samples, as measured over the last second or two; None until it is known."""
        self._since: tuple[float, int] | None = None
        self._before: _Row | None = None
        self._repeating = False
        self._lost_s: float | None = None
        self.doubtful = False
        """Since a reset, a swap or a jump, until `trust`."""

    def trust(self) -> None:
        """Somebody looked and says that the angles are right."""
        self.doubtful = False

    def look(self, samples: Samples) -> tuple[list[Fault], tuple[int, ...]]:
        """What is wrong with these samples, and the rows at which the device was reset."""
        if not len(samples):
            return [], ()
        raw = samples.raw[:, self._mapping.columns]
        faults: list[Fault] = []
        resets: list[int] = []
        for k in self._suspects(samples, raw):
            before = self._row(samples, raw, k - 1) if k else self._before
            if before is not None:
                found = self._named(before, self._row(samples, raw, k))
                faults += found
                resets += [k] if any(fault.kind == RESET for fault in found) else []
        self._before = self._row(samples, raw, len(samples) - 1)
        self._measure(samples, any(fault.kind == GAP for fault in faults))
        self.doubtful |= any(fault.kind in DOUBTFUL for fault in faults)
        return faults, tuple(resets)

    def _row(self, samples: Samples, raw: F64, k: int) -> _Row:
        clock = None if samples.t_device_s is None else float(samples.t_device_s[k])
        return _Row(float(samples.t_host_s[k]), clock, raw[k])

    def _suspects(self, samples: Samples, raw: F64) -> list[int]:
        """Rows that differ from the one before by more than a fast arm at twice the period; the rest is well."""
        if self._before is None:
            before, host = raw[:1], samples.t_host_s[:1]
        else:
            before, host = self._before.raw[None, :], np.array([self._before.t_host_s])
        step = self._turned(raw - np.vstack([before, raw[:-1]]))
        wrong = (np.abs(step) > self._limit(0.0)).any(axis=1)
        wrong |= np.diff(samples.t_host_s, prepend=host) > self._gap_limit()
        if samples.t_device_s is not None:
            first = samples.t_device_s[0] if self._before is None else self._before.t_device_s
            clock = np.diff(samples.t_device_s, prepend=samples.t_device_s[0] if first is None else first)
            wrong |= (clock <= 0.0) | (clock > self._gap_limit())
            wrong[0] &= self._before is not None
        return [int(k) for k in np.flatnonzero(wrong | self._resumed(len(raw)))]

    def _resumed(self, n: int) -> Bool:
        first = np.zeros(n, dtype=bool)
        first[0] = self._repeating
        return first

    def _turned(self, step: F64) -> F64:
        """Steps in turns, a wrap taken out where encoders have them."""
        turns = step / self._mapping.turn
        if self._mapping.wraps:
            once = np.abs(turns) <= 1.5
            turns = np.where(once, turns - np.round(turns), turns)
        return turns

    def _limit(self, dt_s: float) -> float:
        """Turns that a joint may move: three periods of the fastest hand, and some noise."""
        return float(self._speed * max(3.0 * (self.period_s or _PERIOD_S), dt_s) + 0.002)

    def _gap_limit(self) -> float:
        if self._gap_s is not None:
            return self._gap_s
        return _GAP_S if self.period_s is None else max(_LEAST_GAP_S, _PERIODS_OF_A_GAP * self.period_s)

    def _named(self, before: _Row, row: _Row) -> list[Fault]:
        t = row.t_host_s
        dt_host = t - before.t_host_s
        dt, faults = dt_host, list[Fault]()
        steps = self._turned(row.raw - before.raw)
        if before.t_device_s is not None and row.t_device_s is not None:
            dt_device = row.t_device_s - before.t_device_s
            if dt_device == 0.0 and np.array_equal(row.raw, before.raw):
                if not self._repeating:
                    self._repeating = True
                    faults.append(
                        Fault(REPEAT, t, worded("the reading of {time} s came again.", time=f"{row.t_device_s:.3f}"))
                    )
                return faults
            clock = self._clock(dt_device, dt_host, before.t_device_s, row.t_device_s)
            faults += [Fault(kind, t, text) for kind, text in clock]
            if not clock:
                # readings that waited on their way and came together have no gap between them
                dt = dt_device if dt_host < _CLOCK_S else max(dt_host, dt_device)
        self._repeating = False
        if dt > self._gap_limit():
            faults.append(Fault(GAP, t, worded("a gap of {time} in the stream.", time=_milliseconds(dt))))
        moved = np.abs(steps) > self._limit(dt)
        if self._reset(before.raw, row.raw):
            # its clock began again with it: one thing happened
            faults = [fault for fault in faults if fault.kind not in (CLOCK_JUMP, WRAP)]
            return [*faults, Fault(RESET, t, worded("the device counts from zero again: zeros and turns are lost."))]
        if moved.any():
            faults.append(self._moved(before.raw, row.raw, moved, steps, t))
        return faults

    def _clock(self, dt_device: float, dt_host: float, before: float, now: float) -> list[tuple[str, str]]:
        """What a device's clock did that time does not do."""
        for tick in _TICKS_S:
            if dt_device < 0.0 and abs(dt_device + tick - dt_host) < _CLOCK_S:
                said = worded("the device's clock began again after {time} s. Its time goes on.", time=f"{tick:.0f}")
                return [(WRAP, said)]
        if dt_device < 0.0 or dt_device > dt_host + _CLOCK_S:
            times = {"before": f"{before:.3f}", "now": f"{now:.3f}"}
            if dt_device < 0.0:
                return [(CLOCK_JUMP, worded("the device's clock went back: {before} s → {now} s.", **times))]
            return [(CLOCK_JUMP, worded("the device's clock went ahead: {before} s → {now} s.", **times))]
        return []

    def _reset(self, before: F64, now: F64) -> bool:
        """All near zero now, and two (of one encoder: that one) well away from it before, by the encoder's own
        counts."""
        turn = self._mapping.turn
        at_zero = np.abs(now) <= _NEAR_ZERO * turn
        away = np.abs(before) > _NEAR_ZERO * turn
        if self._mapping.wraps:  # 4095 of 4096 is near 0 too: it may simply have gone on
            away &= np.abs(np.abs(before) - turn) > _NEAR_ZERO * turn
        far = away & (np.abs(now - before) > self._limit(0.0) * turn)
        return bool(at_zero.all() and far.sum() >= min(2, len(turn)))

    def _moved(self, before: F64, now: F64, moved: Bool, steps: F64, t: float) -> Fault:
        names, turn = self._mapping.names, self._mapping.turn
        where = np.flatnonzero(moved)
        if len(where) == 2:
            a, b = where
            swapped = np.abs([now[a] - before[b], now[b] - before[a]]) <= self._limit(0.0) * turn[[a, b]]
            if swapped.all():
                return Fault(SWAP, t, worded("{one} and {other} changed places.", one=names[a], other=names[b]))
        said = listed(
            [worded("{name} by {degrees}°", name=names[k], degrees=f"{360.0 * steps[k]:.3g}") for k in where[:3]]
        )
        if len(where) > 3:
            said = worded("{some} and {count} more", some=said, count=len(where) - 3)
        text = worded("{which} from one reading to the next, faster than an arm is turned.", which=said)
        return Fault(JUMP, t, text)

    def _measure(self, samples: Samples, interrupted: bool) -> None:
        """The period, by our clock: a device's may be wrong."""
        newest = float(samples.t_host_s[-1])
        if self._since is None or interrupted:
            self._since = (newest, 0)
            return
        since, count = self._since[0], self._since[1] + len(samples)
        if newest - since >= 1.0 and count >= 10:
            self.period_s = (newest - since) / count
            self._since = (newest, 0)
        else:
            self._since = (since, count)


def _milliseconds(seconds: float) -> str:
    return f"{1000.0 * seconds:.0f} ms" if seconds < 10.0 else f"{seconds:.1f} s"
