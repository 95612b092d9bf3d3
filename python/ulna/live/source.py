"""Sources: something that is opened, read by one thread, and closed."""

from __future__ import annotations

from typing import Protocol

from ulna.live.faults import Fault
from ulna.live.samples import Hello, Samples


class SourceEnded(Exception):  # noqa: N818 (an end is no error)
    """A source gives no more. ``str(error)`` is one sentence that says why: end of file, cable pulled, broker gone."""


class Source(Protocol):
    """One way in which readings come. It is read by one thread."""

    @property
    def hello(self) -> Hello:
        """What it says of itself."""

    def read(self, timeout_s: float) -> Samples:
        """What came since the last call; waits for the first sample so long, and may be empty.

        Raises SourceEnded when all was given.
        """

    def faults(self) -> list[Fault]:
        """What was wrong since the last call."""

    def close(self) -> None:
        """Leaves it. May be called twice."""
