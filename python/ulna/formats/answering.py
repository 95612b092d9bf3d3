"""The other end of asking.py: a process that reads files for another, with a limit on its memory.

It ends when nobody can ask any more; where it cannot notice that, because a library never returns, the system ends it.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import struct
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

MEMORY_BYTES = 768 << 20
"""More than the process has when it is ready."""
_LONELY_S = 60
_SIGN_S = 0.5


class RefusedError(Exception):
    """A file that is in order, but cannot be used. ``str(error)`` is the whole message, without the file's name."""


class Alive:
    """Signs that the work goes on, and its results."""

    def __init__(self, to: BinaryIO) -> None:
        self._to = to
        self._last = time.monotonic()

    def sign(self) -> None:
        """To be called at least every few MB."""
        if time.monotonic() - self._last > _SIGN_S:
            self.say("alive")

    def say(self, kind: str, arrays: Sequence[NDArray[Any]] = (), **more: Any) -> None:
        """A message with arrays behind it."""
        plain = [np.ascontiguousarray(array) for array in arrays]
        said = {"kind": kind, "arrays": [[array.dtype.str, array.shape] for array in plain], **more}
        text = json.dumps(said).encode()
        self._to.write(struct.pack("<I", len(text)) + text)
        for array in plain:
            self._to.write(array.reshape(-1).view(np.uint8).data)
        self._to.flush()
        self._last = time.monotonic()
        _alarm(_LONELY_S)


def serve(answer: Callable[[dict[str, Any], Alive], Iterator[None]]) -> None:
    """Answer questions until nobody asks: `answer` takes one, and says what there is."""
    alive = Alive(os.fdopen(os.dup(1), "wb"))
    os.dup2(2, 1)  # what libraries print is no answer
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # whoever asked is interrupted, and then asks no more
    _limit_memory()
    alive.say("ready")
    for line in sys.stdin.buffer:
        _alarm(_LONELY_S)
        try:
            for _ in answer(json.loads(line), alive):
                alive.sign()
            alive.say("done")
        except BrokenPipeError:
            break
        except Exception as error:
            alive.say("error", error=type(error).__name__, reason=str(error)[:2000])
        _alarm(0)
    os._exit(0)


def _alarm(seconds: int) -> None:
    if hasattr(signal, "alarm"):
        signal.alarm(seconds)


def _limit_memory() -> None:
    """Where the system has such a limit: Linux and most others; not Windows, and macOS may ignore it."""
    with contextlib.suppress(ImportError, ValueError, OSError):
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        with open("/proc/self/statm", encoding="ascii") as stream:  # noqa: PTH123  # a child loads no more than it must
            has = int(stream.read().split()[0]) * resource.getpagesize()
        hard = resource.getrlimit(resource.RLIMIT_AS)[1]
        most = has + MEMORY_BYTES
        resource.setrlimit(resource.RLIMIT_AS, (most if hard < 0 else min(most, hard), hard))
