"""Faults as they are told and kept: a fault that comes again and again is counted, so that it drowns nothing else."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

from ulna.ground.worded import worded
from ulna.live.faults import Fault

WHOLE = 3
"""Faults of one kind that are told whole, one after another."""
EVERY_S = 10.0
"""So long the others are counted, by their own times or by ours, whichever is over first."""


@dataclass
class _Run:
    """Faults of one kind that follow each other."""

    since_s: float
    """By the faults' own times."""
    opened_s: float
    """By our clock."""
    whole: int = WHOLE
    """That may still be told whole."""
    more: int = 0
    last: Fault | None = None


class Floods:
    """What is told of the faults of one stream."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._runs: dict[str, _Run] = {}

    def told(self, faults: Iterable[Fault]) -> list[Fault]:
        """Of these and of those before: what is told now. Of each kind the first few whole; then, each `EVERY_S`, one
        fault that says how many more there were."""
        now_s, told = self._clock(), list[Fault]()
        for kind in list(self._runs):
            if now_s - self._runs[kind].opened_s >= EVERY_S:
                told += self._counted(kind, now_s)
        for fault in faults:
            run = self._runs.get(fault.kind)
            if run is not None and not 0.0 <= fault.t_host_s - run.since_s < EVERY_S:
                told += self._counted(fault.kind, now_s)
                run = self._runs.get(fault.kind)
            if run is None:
                run = self._runs[fault.kind] = _Run(fault.t_host_s, now_s)
            if run.whole:
                run.whole -= 1
                told.append(fault)
            else:
                run.more, run.last = run.more + 1, fault
        return told

    def rest(self) -> list[Fault]:
        """What was only counted so far, at the end."""
        now_s = self._clock()
        return [each for kind in list(self._runs) for each in self._counted(kind, now_s)]

    def _counted(self, kind: str, now_s: float) -> list[Fault]:
        """What a run came to; it goes on as long as there is something to count."""
        run = self._runs.pop(kind)
        last = run.last
        if last is None:
            return []
        self._runs[kind] = _Run(last.t_host_s, now_s, whole=0)
        if run.more == 1:
            return [last]
        seconds = max(last.t_host_s - run.since_s, 0.1)
        said = worded(
            "{count} more in {time} s, the last: {last}", count=run.more, time=f"{seconds:.1f}", last=last.text
        )
        return [replace(last, text=said, more=run.more)]
