"""Texts of other programs: drawings, DH tables, the layouts that importers know."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from random import Random

from fuzzing.bites import spoilt_bytes, spoilt_text
from fuzzing.room import Room
from fuzzing.trial import Trial
from fuzzing.values import NUMBERS, TEXTS


@dataclass(frozen=True)
class TextDoor:
    """A text spoilt line by line, word by word between its `signs`."""

    documents: Sequence[str]
    commands: Sequence[str]
    signs: str
    """What stands between words."""

    def __call__(self, room: Room, source: Random) -> Trial:
        name = source.choice(self.documents)
        content = room.read(name)
        way = source.random()
        if way < 0.6:
            content = self._words(content, source)
        elif way < 0.85:
            content = spoilt_text(content, source)
        else:
            content = spoilt_bytes(content, source)
        return Trial.of(source.choice(self.commands), name, {name: content})

    def _words(self, content: bytes, source: Random) -> bytes:
        text = content.decode()
        ends = [k for k, sign in enumerate(text) if sign in self.signs]
        for _ in range(source.choice([1, 1, 2, 3])):
            at = source.randrange(len(ends) - 1)
            value = str(source.choice([*NUMBERS, *TEXTS]))
            begin, end = ends[at] + 1, ends[at + 1]
            text = text[:begin] + value + text[end:]
            ends = [k for k, sign in enumerate(text) if sign in self.signs]
            if len(ends) < 2:
                break
        return text.encode("utf-8", "surrogatepass")
