"""What is put to a door: files that are not as they were, and the words of a command."""

from __future__ import annotations

import base64
import json
from dataclasses import dataclass, field
from pathlib import Path
from random import Random


@dataclass(frozen=True)
class Trial:
    """One input. The files lie over those of the room (`fuzzing/room.py`), where the command runs."""

    arguments: list[str]
    files: dict[str, bytes] = field(default_factory=dict)

    @classmethod
    def of(cls, command: str, name: str, files: dict[str, bytes]) -> Trial:
        """By the words of a command; {file} in them is the name."""
        return cls([word.replace("{file}", name) for word in command.split()], files)

    def to_json(self, door: str, found: str) -> str:
        """As a fossil: text stays readable."""
        files = {name: _shown(content) for name, content in self.files.items()}
        document = {"door": door, "found": found, "arguments": self.arguments, "files": files}
        return json.dumps(document, indent=1, ensure_ascii=True) + "\n"

    @classmethod
    def from_json(cls, path: Path) -> Trial:
        document = json.loads(path.read_text(encoding="utf-8"))
        files = {name: _content(shown) for name, shown in document["files"].items()}
        return cls(document["arguments"], files)


def _shown(content: bytes) -> str | dict[str, str]:
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError:
        return {"base64": base64.b64encode(content).decode("ascii")}


def _content(shown: str | dict[str, str]) -> bytes:
    return shown.encode("utf-8") if isinstance(shown, str) else base64.b64decode(shown["base64"])


def source(door: str, seed: int, number: int) -> Random:
    """Where all that is random about an input comes from: input `number` of a door is the same for a seed, always."""
    return Random(f"{seed} {door} {number}")
