"""Real parts for the tests of sources: pairs of pseudo-terminals, brokers, senders in threads."""

from __future__ import annotations

import os
import threading
import time
import tty
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from ulna.live.faults import Fault
from ulna.live.samples import Samples
from ulna.live.source import Source, SourceEnded


class Pty:
    """A pair of pseudo-terminals: what is written to `send` is read from the port `path`."""

    def __init__(self) -> None:
        self._ours, theirs = os.openpty()
        tty.setraw(theirs)
        self._theirs = theirs
        self.path = os.ttyname(theirs)

    def send(self, data: bytes) -> None:
        while data:
            data = data[os.write(self._ours, data) :]

    def pull(self) -> None:
        """The cable."""
        for each in (self._theirs, self._ours):
            if each >= 0:
                os.close(each)
        self._ours = self._theirs = -1


@contextmanager
def pty() -> Iterator[Pty]:
    pair = Pty()
    try:
        yield pair
    finally:
        pair.pull()


@contextmanager
def in_thread(work: Callable[[], None]) -> Iterator[None]:
    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    yield
    thread.join(timeout=20)
    assert not thread.is_alive()


def repeated(send: Callable[[], None], while_open: threading.Event, every_s: float = 0.02) -> threading.Thread:
    """Sends again and again until the event."""

    def work() -> None:
        while not while_open.wait(every_s):
            send()

    thread = threading.Thread(target=work, daemon=True)
    thread.start()
    return thread


def collected(source: Source, n: int, seconds: float = 20.0) -> tuple[Samples, list[Fault], str | None]:
    """n samples at least, or what there is at the end; what was wrong; and why it ended."""
    parts, faults = [Samples.none(len(source.hello.channels))], list[Fault]()
    until, why = time.monotonic() + seconds, None
    while sum(map(len, parts)) < n:
        assert time.monotonic() < until, f"{sum(map(len, parts))} of {n} samples in {seconds} s: {faults}"
        try:
            parts.append(source.read(0.5))
        except SourceEnded as ended:
            why = str(ended)
        faults += source.faults()
        if why is not None:
            break
    full = [part for part in parts if len(part)]
    return (Samples.joined(full) if full else parts[0]), faults, why
