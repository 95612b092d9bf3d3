"""Documents that Ulna writes and reads again, each with the commands that read it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from random import Random

from fuzzing.bites import spoilt_bytes, spoilt_text
from fuzzing.room import Room
from fuzzing.structure import spoilt
from fuzzing.trial import Trial
from fuzzing.written import json_text


@dataclass(frozen=True)
class JsonDoor:
    """As `TomlDoor`. Most of the time one key of the top is gone through: long lists of it would take all."""

    documents: Sequence[str]
    commands: Sequence[str]

    def __call__(self, room: Room, source: Random) -> Trial:
        name = source.choice(self.documents)
        content = room.read(name)
        way = source.random()
        if way < 0.88:
            document = json.loads(content)
            if way < 0.7:
                key = source.choice(sorted(document))
                found = spoilt({key: document.pop(key)}, source)
                document = document | found if isinstance(found, dict) else found
            else:
                document = spoilt(document, source)
            content = json_text(document)
        elif way < 0.94:
            content = spoilt_text(content, source)
        else:
            content = spoilt_bytes(content, source)
        return Trial.of(source.choice(self.commands), name, {name: content})
