"""Ctrl-C and SIGTERM take effect at once, also while the main thread is inside compiled code that looks for no signals.

Python raises KeyboardInterrupt only between two of its own instructions; a large table being read or written can hold
that up for seconds. So a second thread hears of the signal from the operating system. Where the main thread has not
answered after a grace period, it takes away what is half written and ends the process.
"""

from __future__ import annotations

import os
import shutil
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import NoReturn

INTERRUPTED, TERMINATED = 130, 143
ENDING = {signal.SIGINT: INTERRUPTED, signal.SIGTERM: TERMINATED}
"""What ends a command, and with which exit code: 128 and the signal's number."""
_GRACE_S = 0.06
SHOWN = 4
"""Places that the answer names."""
_code = INTERRUPTED


@contextmanager
def prompt_interrupts() -> Iterator[None]:
    """While this lasts, SIGINT or SIGTERM ends the process after the grace period, whatever its main thread does."""
    if threading.current_thread() is not threading.main_thread():
        yield  # a caller's thread: signals are the main thread's affair
        return
    hear, tell = os.pipe()
    os.set_blocking(tell, False)
    answered = threading.Event()
    before = signal.set_wakeup_fd(tell, warn_on_full_buffer=False)
    told_to_end = signal.signal(signal.SIGTERM, _end)
    threading.Thread(target=_watch, args=(hear, answered), daemon=True).start()
    try:
        yield
    finally:
        answered.set()
        signal.signal(signal.SIGTERM, told_to_end)
        signal.set_wakeup_fd(before)
        os.close(tell)  # the watching thread reads the end and returns


@contextmanager
def asked_to_end() -> Iterator[threading.Event]:
    """While this lasts, SIGINT and SIGTERM end nothing: they set the event, and what goes on until somebody ends it
    ends itself, with all that it has."""
    asked = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield asked
        return
    heard_by = signal.set_wakeup_fd(-1)
    before = {number: signal.signal(number, lambda _number, _frame: asked.set()) for number in ENDING}
    try:
        yield asked
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        signal.set_wakeup_fd(heard_by, warn_on_full_buffer=False)


def _watch(hear: int, answered: threading.Event) -> None:
    while heard := os.read(hear, 1):
        if heard[0] in ENDING and not answered.wait(_GRACE_S):
            _end_at_once(ENDING[signal.Signals(heard[0])])
    os.close(hear)


def _end(number: int, frame: object) -> NoReturn:
    """As Ctrl-C, but that it is another's wish."""
    global _code
    _code = ENDING[signal.Signals(number)]
    raise KeyboardInterrupt


def ended() -> int:
    """The exit code of what interrupted the command."""
    return _code


def _end_at_once(code: int) -> None:
    output = sys.modules.get("ulna.formats.output")
    if output is not None:
        output.MOVING.acquire()  # a result on its way to its place arrives; none leaves after this
    say_interrupted()
    leave_interrupted(code)


def leave_interrupted(code: int | None = None) -> NoReturn:
    """Take away what is half written and end with an exit code, that of what interrupted if none is given.

    Left to itself Python would now and then end by the signal, code -2: it does so where the interrupt came while a
    string was being executed, as dataclasses do, even if somebody caught it (CPython 3.11). And an interrupt that
    comes just as a `with` is entered leaves the clean-up to the garbage collector.
    """
    output = sys.modules.get("ulna.formats.output")
    for staged in list(output.UNDER_WAY) if output is not None else ():
        if staged.is_dir():
            shutil.rmtree(staged, ignore_errors=True)
        else:
            with suppress(OSError):
                staged.unlink()
    for made in list(output.MADE) if output is not None else ():
        with suppress(OSError):
            made.rmdir()  # only where nothing came into it
    sys.stderr.flush()
    os._exit(ended() if code is None else code)


def say_interrupted() -> None:
    """What Ctrl-C is answered with: nothing is half written, and what was finished before stays."""
    output = sys.modules.get("ulna.formats.output")
    there = [str(path) for path in output.FINISHED] if output is not None else []
    if not there:
        print("\nInterrupted. Nothing was written.", file=sys.stderr)
        return
    shown = ", ".join(there[:SHOWN]) + (f" and {len(there) - SHOWN} more" if len(there) > SHOWN else "")
    print(f"\nInterrupted. What was finished stays: {shown}; nothing is half written.", file=sys.stderr)
