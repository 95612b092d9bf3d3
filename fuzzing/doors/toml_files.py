"""Hand-written documents, each with the commands that read it."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from random import Random

from fuzzing.bites import spoilt_bytes, spoilt_text
from fuzzing.room import Room
from fuzzing.structure import spoilt
from fuzzing.trial import Trial
from fuzzing.written import toml_text


@dataclass(frozen=True)
class TomlDoor:
    """Documents of one format (names in the room), and commands with {file} where they name it."""

    documents: Sequence[str]
    commands: Sequence[str]

    def __call__(self, room: Room, source: Random) -> Trial:
        name = source.choice(self.documents)
        content = room.read(name)
        way = source.random()
        if way < 0.7:
            content = toml_text(spoilt(tomllib.loads(content.decode()), source, dates=True))
        elif way < 0.9:
            content = spoilt_text(content, source)
        else:
            content = spoilt_bytes(content, source)
        return Trial.of(source.choice(self.commands), name, {name: content})
