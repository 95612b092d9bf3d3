"""Pieces that another thread brings, for the one that receives; and what is said of a port that nobody may have."""

from __future__ import annotations

import threading
from collections import deque

from ulna.ground.errors import UlnaInputError

WAIT_S = 0.1
"""So long a wire waits at the most for what comes."""


class Mailbox:
    """Filled by any thread, emptied by one."""

    def __init__(self) -> None:
        self._pieces: deque[bytes] = deque()
        self._came = threading.Event()

    def put(self, piece: bytes) -> None:
        """One more."""
        self._pieces.append(piece)
        self._came.set()

    def wake(self) -> None:
        """Whoever waits need not wait longer: nothing more comes."""
        self._came.set()

    def taken(self) -> list[bytes]:
        """All that came, in order; waits for the first."""
        self._came.wait(WAIT_S)
        self._came.clear()
        found = []
        while self._pieces:
            found.append(self._pieces.popleft())
        return found


def taken_port(device: str, error: OSError) -> UlnaInputError:
    """A port of this machine that cannot be listened to."""
    return UlnaInputError(
        f"{device}: cannot be listened to ({error.strerror or error}); expected a free port. Name another, or end the "
        "program that has it."
    )
