"""Journals: bytes changed, lost, doubled, cut."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from random import Random

from fuzzing.bites import spoilt_bytes
from fuzzing.room import Room
from fuzzing.trial import Trial


@dataclass(frozen=True)
class JournalDoor:
    """As `TomlDoor`."""

    documents: Sequence[str]
    commands: Sequence[str]

    def __call__(self, room: Room, source: Random) -> Trial:
        name = source.choice(self.documents)
        content = room.read(name)
        if source.random() < 0.3:
            content = content[: source.randrange(len(content) + 1)]
        else:
            content = spoilt_bytes(content, source)
        return Trial.of(source.choice(self.commands), name, {name: content})
