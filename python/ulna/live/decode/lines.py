"""Bytes cut into lines, wherever they were cut before."""

from __future__ import annotations

import re

from ulna.ground.worded import worded
from ulna.live.decode.decoder import LONGEST_LINE, Skipped

_END = re.compile(rb"[\r\n]+")


class Lines:
    """Lines end with \\n, \\r or both; empty ones are none."""

    def __init__(self, skipped: Skipped, midway: bool) -> None:
        self._left = b""
        self._skipped = skipped
        self._midway = midway
        self.too_long: str | None = None
        """Of the line after those that `feed` gave, where it is."""

    def feed(self, data: bytes, t_host_s: float, whole: bool) -> list[bytes]:
        """The lines that end in these bytes."""
        parts = _END.split(self._left + data + (b"\n" if whole else b""))
        self._left = parts.pop()
        if self._midway and parts:
            # a number that lost its first digits is a number still: what began before we listened is not read
            self._skipped.skip(parts.pop(0), worded("the line had begun before"), t_host_s)
            self._midway = False
        for k, line in enumerate((*parts, self._left)):
            if len(line) > LONGEST_LINE:
                self.too_long = worded(
                    "a line of more than {most} bytes, beginning with {first}; expected lines of readings. Check the "
                    "speed (baud) and what the device sends.",
                    most=LONGEST_LINE,
                    first=repr(line[:40]),
                )
                del parts[k:]
                break
        return [part for part in parts if part.strip()]
