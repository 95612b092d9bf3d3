"""A folder into which one run writes result after result: while it does, another is told to wait."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from ulna.formats.output import UNDER_WAY, check_output, leave, missing, unwritable
from ulna.ground.errors import UlnaInputError

NAME = ".ulna-writes-here"
"""A file whose lock is held; the lock goes with whoever is killed, the file means nothing without it."""


@contextmanager
def claimed(folder: Path, what: str) -> Iterator[None]:
    """what: a word for the run. Raises UlnaInputError where another has the folder, or nothing can be written there.

    Where a system or a disk has no locks nobody is told here, but by each result that the other has written.
    """
    check_output(folder, [])
    made, path = missing(folder), folder / NAME
    try:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            handle = _taken(path)
        except OSError as error:
            raise unwritable(folder, error) from None
        if handle is None:
            raise UlnaInputError(
                f"{folder}: another {what} is writing here. Wait for it to end, or name another place with -o."
            )
        UNDER_WAY.add(path)
        try:
            yield
        finally:
            with suppress(OSError):
                path.unlink()
            UNDER_WAY.discard(path)
            os.close(handle)
    finally:
        leave(made)


def _taken(path: Path) -> int | None:
    """A handle to be closed; None where somebody else has the lock. Raises OSError where there can be no file."""
    while True:
        handle = os.open(path, os.O_CREAT | os.O_WRONLY | getattr(os, "O_NOFOLLOW", 0), 0o600)
        if sys.platform == "win32":
            return handle
        import fcntl

        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            os.close(handle)
            return None
        except OSError:
            return handle
        if os.fstat(handle).st_nlink:
            return handle
        os.close(handle)  # who had it has just ended and taken the file away
