"""What a door is: how inputs for it are made."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from random import Random

from fuzzing.room import Room
from fuzzing.trial import Trial, source


@dataclass(frozen=True)
class Door:
    """A way into Ulna."""

    name: str
    make: Callable[[Room, Random], Trial]
    seconds: float = 10.0
    """What an input may take; more where answers take long by right."""
    short: int = 40
    """Inputs of the short run, which is a test, and share in a long one; fewer where each takes long."""

    def trial(self, room: Room, seed: int, number: int) -> Trial:
        """Input `number` of a seed."""
        return self.make(room, source(self.name, seed, number))
