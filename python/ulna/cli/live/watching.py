"""How `ulna live watch`, `record` and `replay` go round: read, show the newest, until it ends or somebody ends it."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from ulna.cli.interrupting import asked_to_end
from ulna.live.rounds import Round
from ulna.live.source import SourceEnded
from ulna.live.stream import Frames, Stream, streaming

FRAMES_HZ = 60.0
"""A screen shows no more; what is not shown is not lost."""
LINES_HZ = 1.0


def go_round(
    source: str,
    seconds: float | None,
    each: Callable[[Round, Frames], None],
    tick: Callable[[Round], None],
    hz: float,
    *,
    angles: bool = False,
    ended: Callable[[], bool] = lambda: False,
) -> Round:
    """Reads a source until it ends, the time is over, `ended`, or Ctrl-C; `tick` is called hz times a second. angles:
    whether they are needed, or what was sent is enough."""
    with streaming(source, angles) as stream:
        return read_on(stream, seconds, each, tick, hz, ended)


def read_on(
    stream: Stream,
    seconds: float | None,
    each: Callable[[Round, Frames], None],
    tick: Callable[[Round], None],
    hz: float,
    ended: Callable[[], bool] = lambda: False,
) -> Round:
    """The same with a stream that is open. Raises UlnaInputError where it ends without a reading."""
    known = Round(stream)
    begin = shown = time.monotonic()
    with asked_to_end() as asked:  # Ctrl-C is the one way to end it, and a good one
        while not (asked.is_set() or ended()) and (seconds is None or time.monotonic() - begin < seconds):
            try:
                frames = stream.read(1.0 / FRAMES_HZ)
            except SourceEnded as end:
                known.why = str(end)
                break
            known.take(frames)
            each(known, frames)
            if time.monotonic() - shown >= 1.0 / hz:
                tick(known)
                shown = time.monotonic()
        last = stream.ended(known.why)
        known.take(last)
        known.check_came()
        each(known, last)
        tick(known)
        return known


def watch(source: str, seconds: float | None, as_json: bool) -> None:
    """`ulna live watch`."""
    if as_json:
        known = go_round(source, seconds, json_lines, lambda _: None, LINES_HZ)
        print(json.dumps({"end": known.as_dict()}, allow_nan=False), flush=True)
        return
    show(source, seconds, lambda known, frames: None)


def show(source: str, seconds: float | None, each: Callable[[Round, Frames], None]) -> Round:
    """In place on a terminal, a line a second elsewhere; what it came to at the end."""
    from ulna.cli.printed.live import ended_line

    if sys.stdout.isatty():
        with _screen() as tick:
            known = go_round(source, seconds, each, tick, FRAMES_HZ)
    else:
        known = go_round(source, seconds, _say_faults(each), _line, LINES_HZ)
    print(ended_line(known), flush=True)
    return known


def json_lines(known: Round, frames: Frames) -> None:
    """A sample an object, a fault an object."""
    samples, names = frames.samples, known.stream.source.hello.channels
    lines = [json.dumps({"fault": fault.as_dict()}, ensure_ascii=False) for fault in frames.told]
    for k in range(len(samples)):
        sample: dict[str, Any] = {"t_host_s": float(samples.t_host_s[k])}
        if samples.t_device_s is not None:
            sample["t_device_s"] = float(samples.t_device_s[k])
        sample["raw"] = dict(zip(names, samples.raw[k].tolist(), strict=True))
        if frames.q_rad.shape[1]:
            sample["q_rad"] = frames.q_rad[k].tolist()
        if samples.button is not None:
            sample["button"] = bool(samples.button[k])
        lines.append(json.dumps(sample, ensure_ascii=False, allow_nan=False))
    if lines:
        sys.stdout.write("\n".join(lines) + "\n")
        sys.stdout.flush()


def _say_faults(each: Callable[[Round, Frames], None]) -> Callable[[Round, Frames], None]:
    from ulna.cli.output import say

    def both(known: Round, frames: Frames) -> None:
        for fault in frames.told:
            say(f"{fault.kind}: {fault.text}")
        each(known, frames)

    return both


def _line(known: Round) -> None:
    from ulna.cli.printed.live import one_line

    if known.newest is not None:
        print(one_line(known), flush=True)


@contextmanager
def _screen() -> Iterator[Callable[[Round], None]]:
    from rich.console import Console
    from rich.live import Live

    from ulna.cli.printed.live import watched

    with Live(console=Console(highlight=False), auto_refresh=False, transient=True) as live:
        yield lambda known: live.update(watched(known), refresh=True)
