"""Files that are read by a process of their own, because the library that reads them may crash, never return or take
all memory where a file is damaged, or made to do that.

The process is a fresh Python (no fork: that is not safe where there are threads) that loads one module and no more; it
is started when the first such file comes, asked again for each next one, and started anew where it has ended. What it
sends are arrays as they lie in memory. How much memory it may take is its own affair (answering.py). How long is
watched here: not the whole, which grows with the file, but the time without a sign of it.
"""

from __future__ import annotations

import atexit
import contextlib
import json
import os
import signal
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, cast

import numpy as np
from numpy.typing import NDArray

QUIET_S = 7.0
"""Without a sign of a process that was asked: between two signs it reads a few MB, or says that it reads more."""
SLOWEST = 20e6
"""Bytes a second of the slowest disk: what more is read without a sign."""
START_S = 60.0
"""To load a library from a slow disk; no file is open yet."""
_POLL_S = 0.2
_PIPE_BYTES = 1 << 20
_SET_PIPE_SIZE = 1031  # Linux: F_SETPIPE_SZ


class EndedError(Exception):
    """The process ended, or had to be ended. ``str(error)`` says how: "was ended by SIGSEGV (Segmentation fault)"."""


class NotStartedError(Exception):
    """The process could not begin; no file is to blame. ``str(error)`` says why: "cannot be started (…)"."""


class ToldError(Exception):
    """What the process says of a file. ``str(error)`` is the reason."""

    def __init__(self, kind: str, reason: str) -> None:
        super().__init__(reason)
        self.kind = kind
        """The name of the exception there."""


@dataclass(frozen=True)
class Answer:
    """Some of what was asked for."""

    said: Mapping[str, Any]
    arrays: list[NDArray[Any]]


class Apart:
    """A process that answers what it is asked of files, one question after the other, from any thread."""

    def __init__(self, module: str) -> None:
        self.module = module
        """What it runs: a module that calls `ulna.formats.answering.serve`."""
        self._lock = threading.RLock()
        self._running: _Running | None = None
        self._owner = 0

    def ask(self, **question: Any) -> Iterator[Answer]:
        """The answers, as they come; take all of them. Raises ToldError, EndedError, NotStartedError."""
        with self._lock:
            running = self._there()
            finished = False
            try:
                running.send(question)
                while True:
                    answer = running.answer()
                    kind = answer.said["kind"]
                    if kind == "some":
                        yield answer
                        continue
                    finished = kind in ("done", "error")
                    if kind == "done":
                        return
                    if kind == "error":
                        raise ToldError(answer.said["error"], answer.said["reason"])
            except (EOFError, OSError):
                raise EndedError(running.ending()) from None
            finally:
                running.rest()
                if not finished:
                    self.close()

    def close(self) -> None:
        """End the process; the next question starts another."""
        with self._lock:
            if self._running is not None and self._owner == os.getpid():
                self._running.close()
            self._running = None

    def _there(self) -> _Running:
        if self._owner != os.getpid():  # a fork of this program has pipes that are another's
            self._running = None
        if self._running is None or not self._running.alive:
            self.close()
            if not self._owner:
                atexit.register(self.close)
            try:
                self._running = _Running(self.module)
            except OSError as error:
                raise NotStartedError(f"cannot be started ({error.strerror or error})") from None
            self._owner = os.getpid()
            try:
                self._running.answer()
            except (EOFError, OSError):
                why = self._running.ending()
                self.close()
                raise NotStartedError(why) from None
        return self._running


class _Running:
    """One process, and who watches it."""

    def __init__(self, module: str) -> None:
        self._process = subprocess.Popen(
            [_python(), "-P", "-m", module],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            env=_surroundings(),
            creationflags=getattr(subprocess, "CREATE_NO_WINDOW", 0),
        )
        self._to, self._of = cast(BinaryIO, self._process.stdin), cast(BinaryIO, self._process.stdout)
        if sys.platform == "linux":
            import fcntl

            with contextlib.suppress(OSError):
                fcntl.fcntl(self._of, _SET_PIPE_SIZE, _PIPE_BYTES)
        self._due: float | None = time.monotonic() + START_S
        self._quiet_s = START_S
        self._late = False
        self._asked = threading.Event()
        self._asked.set()
        threading.Thread(target=self._watch, name=f"watching {module}", daemon=True).start()

    @property
    def alive(self) -> bool:
        return self._process.poll() is None

    def send(self, question: Mapping[str, Any]) -> None:
        self._quiet_s = QUIET_S
        self._due = time.monotonic() + self._quiet_s
        self._asked.set()
        self._to.write(json.dumps(question).encode() + b"\n")
        self._to.flush()

    def answer(self) -> Answer:
        """Raises EOFError where there is none."""
        (length,) = struct.unpack("<I", self._taken(np.empty(4, np.uint8)).tobytes())
        said = json.loads(self._taken(np.empty(length, np.uint8)).tobytes())
        arrays = [self._taken(np.empty(shape, np.dtype(kind))) for kind, shape in said["arrays"]]
        if said["kind"] == "ready":
            self.rest()
        elif "reading" in said:
            self._due = time.monotonic() + self._quiet_s + said["reading"] / SLOWEST
        return Answer(said, arrays)

    def rest(self) -> None:
        """Nothing is asked for."""
        self._due = None
        self._asked.clear()

    def ending(self) -> str:
        """How it ended, which it did or now has to."""
        try:
            code = self._process.wait(timeout=1.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            code = self._process.wait()
        if self._late:
            return f"gave no sign for {self._quiet_s:g} s and was stopped"
        if code < 0:
            number = signal.Signals(-code)
            return f"was ended by {number.name} ({signal.strsignal(number)})"
        return f"ended with code {code:#x}"

    def close(self) -> None:
        self._due = None
        with contextlib.suppress(OSError):
            self._to.close()  # then it leaves
        try:
            self._process.wait(timeout=0.5 if not self._asked.is_set() else 0.0)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._of.close()
        self._asked.set()  # who watches sees that it is over

    def _taken(self, array: NDArray[Any]) -> NDArray[Any]:
        """The array, filled with what comes."""
        view = array.reshape(-1).view(np.uint8).data
        while view:
            count = self._of.readinto(view)  # type: ignore[attr-defined]  # BinaryIO lacks it
            if not count:
                raise EOFError
            view = view[count:]
            if self._due is not None:
                self._due = time.monotonic() + self._quiet_s
        return array

    def _watch(self) -> None:
        while self.alive:
            self._asked.wait()
            due = self._due
            if due is not None and time.monotonic() > due:
                self._late = True
                self._process.kill()
                return
            time.sleep(_POLL_S)


def _python() -> str:
    """Who runs Python here; a program that has Python in it says so with `multiprocessing.set_executable`."""
    from multiprocessing.spawn import get_executable

    return os.fsdecode(get_executable())


def _surroundings() -> dict[str, str]:
    """What it finds its modules by, as here; and one thread, as it computes nothing."""
    ours = str(Path(__file__).resolve().parents[2])
    places = [*dict.fromkeys([*(place for place in sys.path if place), ours])]
    one = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    return {**os.environ, **one, "PYTHONPATH": os.pathsep.join(places)}
