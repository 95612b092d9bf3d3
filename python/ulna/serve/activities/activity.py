"""What every kind of activity is."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from pathlib import Path
from typing import ClassVar

from ulna.ground.worded import worded
from ulna.live.stream import Frames, Stream
from ulna.serve.contract.activities import State
from ulna.serve.contract.live import LiveEvent
from ulna.serve.contract.words import Do
from ulna.serve.frames import Newest
from ulna.serve.problems import NotNowError


class Doing(ABC):
    """One activity. All of it runs in one thread: whoever reads the stream."""

    kind: ClassVar[str]
    stream: Stream

    @abstractmethod
    def begin(self) -> Iterator[LiveEvent]:
        """What is so before anything came."""

    @abstractmethod
    def feed(self, frames: Frames) -> Iterator[LiveEvent]:
        """What came, and what follows from it. Raises UlnaInputError where it cannot go on."""

    @abstractmethod
    def do(self, asked: Do) -> Iterator[LiveEvent]:
        """What somebody says. Raises UlnaInputError."""

    @abstractmethod
    def state(self) -> State:
        """All that a page needs which comes now."""

    @abstractmethod
    def newest(self) -> Newest | None:
        """What is drawn; None where nothing came yet."""

    @abstractmethod
    def finish(self) -> tuple[list[tuple[str, Path]], list[str]]:
        """It is over: files that it leaves, by their role, and sentences. Raises UlnaInputError."""


def unknown(asked: Do, kind: str) -> NotNowError:
    """Of a word that means nothing here."""
    return NotNowError(worded("'{word}': that is no word of '{kind}'. Say another.", word=asked.word, kind=kind))
