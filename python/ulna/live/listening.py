"""Bytes of a source as they come, for a time."""

from __future__ import annotations

import time
from dataclasses import dataclass

from ulna.live.registry import open_wire
from ulna.live.source import SourceEnded
from ulna.live.source_file import StatedSource

MOST_BYTES = 4 << 20
"""Enough to guess from."""


@dataclass(frozen=True)
class Heard:
    """What came."""

    device: str
    messages: bool
    pieces: list[tuple[float, bytes]]
    """time.monotonic() and bytes of each piece."""
    seconds: float
    why: str | None
    """Why it ended before its time."""

    @property
    def bytes(self) -> int:
        """How many came."""
        return sum(len(piece) for _, piece in self.pieces)


def listened(stated: StatedSource, seconds: float) -> Heard:
    """Listens so long, or until it ends. Raises UlnaInputError where it cannot be opened."""
    wire = open_wire(stated)
    pieces: list[tuple[float, bytes]] = []
    begin, many, why = time.monotonic(), 0, None
    try:
        while time.monotonic() - begin < seconds and many < MOST_BYTES:
            for piece in wire.receive():
                pieces.append((time.monotonic(), piece))
                many += len(piece)
    except SourceEnded as ended:
        why = str(ended)
    finally:
        wire.close()
    return Heard(wire.device, wire.messages, pieces, time.monotonic() - begin, why)
