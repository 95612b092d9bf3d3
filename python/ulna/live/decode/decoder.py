"""What decoders share: rows, and what was skipped, said once for each run of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Protocol

from ulna.ground.worded import worded
from ulna.live.faults import GARBAGE, Fault

LONGEST_LINE = 4096
"""Bytes of a line; of a device that sends longer ones nobody knows what they are."""


class Row(NamedTuple):
    """One sample as decoded."""

    t_host_s: float
    t_device_s: float | None
    values: tuple[float, ...]
    button: bool | None


class TooLong(Exception):  # noqa: N818 (it ends a source, it is no mistake)
    """A line of more than 4 kB, or more than 32 channels; ``str(error)`` is the sentence with which a source ends."""

    def __init__(self, why: str, rows: Sequence[Row] = ()) -> None:
        super().__init__(why)
        self.rows = rows
        """What was read before, of the same bytes."""


class Decoder(Protocol):
    """From bytes to rows. However the bytes are cut, the rows are the same."""

    skipped: Skipped

    @property
    def channels(self) -> tuple[str, ...] | None:
        """Names of the values; None until the first row, where nobody gave them."""

    def feed(self, data: bytes, t_host_s: float, whole: bool = False) -> list[Row]:
        """The rows that end in these bytes; whole: they are a message of their own (a datagram, a frame).

        Raises TooLong.
        """


class Skipped:
    """Counts what was no reading; a run of it, until the next good row, is one fault."""

    def __init__(self) -> None:
        self.bytes = 0
        """Of all that was skipped."""
        self.runs = 0
        self._why = ""
        self._first = b""
        self._run = 0
        self._began_s = 0.0
        self._faults: list[Fault] = []

    def skip(self, data: bytes, why: str, t_host_s: float) -> None:
        """Some bytes; why they are no reading: "not 7 numbers"."""
        if not data:
            return
        if not self._run:
            self._why, self._first, self._began_s = why, data[:40], t_host_s
            self.runs += 1
        self._run += len(data)
        self.bytes += len(data)

    def good(self) -> None:
        """A row: the run is over."""
        if self._run:
            self._faults.append(self._said())
            self._run = 0

    def _said(self) -> Fault:
        shown = self._first.decode("ascii", "backslashreplace").encode("unicode_escape").decode()
        more = "…" if self._run > len(self._first) else ""
        first = f"{shown}{more}"
        if self._run == 1:
            said = worded("1 byte skipped, {why}: '{first}'.", why=self._why, first=first)
        else:
            said = worded("{count} bytes skipped, {why}: '{first}'.", count=self._run, why=self._why, first=first)
        return Fault(GARBAGE, self._began_s, said)

    def taken(self, end: bool = False) -> list[Fault]:
        """Faults since the last call; end: of the run that is not over, too."""
        if end:
            self.good()
        found, self._faults = self._faults, []
        return found
