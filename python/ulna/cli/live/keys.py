"""Keys of a terminal as they are pressed, without waiting for any."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def pressed() -> Iterator[Callable[[], str]]:
    """While this lasts, each call gives the keys since the one before, in their order; none where there is no terminal.
    Ctrl-C stays what it is."""
    if not sys.stdin.isatty():
        yield lambda: ""
    elif sys.platform == "win32":
        import msvcrt

        def of_console() -> str:
            found = ""
            while msvcrt.kbhit():
                found += msvcrt.getwch()
            return found

        yield of_console
    else:
        import select
        import termios
        import tty

        file = sys.stdin.fileno()
        before = termios.tcgetattr(file)

        def of_terminal() -> str:
            found = b""
            while select.select([file], [], [], 0.0)[0]:
                piece = os.read(file, 64)
                if not piece:  # the terminal is gone
                    return "q"
                found += piece
            return found.decode("utf-8", "replace")

        tty.setcbreak(file)
        try:
            yield of_terminal
        finally:
            termios.tcsetattr(file, termios.TCSADRAIN, before)
