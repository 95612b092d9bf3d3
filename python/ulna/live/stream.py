"""A source, mapped and looked at: what commands read."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.live.faults import Fault
from ulna.live.floods import Floods
from ulna.live.mapping import Mapping
from ulna.live.plausible import Plausible
from ulna.live.registry import open_source
from ulna.live.samples import Samples
from ulna.live.source import Source
from ulna.live.source_file import StatedSource, read_source


@dataclass(frozen=True)
class Frames:
    """What came at once."""

    samples: Samples
    q_rad: F64
    """(N, n) encoder angles, turns counted."""
    faults: list[Fault]
    """All of them."""
    told: list[Fault]
    """What is shown and kept of them, and of those before: see `Floods`."""


class Stream:
    """A source with its mapping and what watches over it."""

    def __init__(self, source: Source, stated: StatedSource, angles: bool = True) -> None:
        """angles: whether they are needed, or what was sent is enough where nobody says its unit. Raises UlnaInputError
        where the channels are not those of the mapping."""
        self.source = source
        self.stated = stated
        self.mapping = Mapping(stated.file.map, source.hello, stated.path, angles)
        self.plausible = Plausible(self.mapping, stated.file.limits, source.hello.rate_hz)
        self._floods = Floods()
        self.sample_rad = self._sample_rad()
        """(n,) standard deviation of one sample of each encoder, where the source file says it."""

    def _sample_rad(self) -> F64 | None:
        noise, turn = self.stated.file.still.noise, self.mapping.turn
        if noise is None:
            return None
        if isinstance(noise, list) and len(noise) != len(turn):
            raise UlnaInputError(
                f"{self.stated.path}: key 'still.noise': {len(noise)} numbers for {len(turn)} channels; expected one "
                "for each, or one for all. Correct it."
            )
        found: F64 = np.broadcast_to(np.asarray(noise, dtype=np.float64), turn.shape) * (2.0 * np.pi / turn)
        return found

    def read(self, timeout_s: float) -> Frames:
        """As `Source.read`. Raises SourceEnded; what was wrong at the end `ended` has."""
        samples = self.source.read(timeout_s)
        found, resets = self.plausible.look(samples)
        q_rad = self.mapping.q_rad(samples, resets)
        faults = [*self.source.faults(), *found, *self.mapping.faults()]
        return Frames(samples, q_rad, faults, self._floods.told(faults))

    def ended(self, why: str | None = None) -> Frames:
        """When no more is read: what was wrong at the end, and what was only counted so far; no sample. why: the end
        itself, which is not told as a fault again."""
        faults = self.source.faults()
        told = self._floods.told(fault for fault in faults if fault.text != why) + self._floods.rest()
        none = Samples.none(len(self.source.hello.channels))
        return Frames(none, self.mapping.q_rad(none, ()), faults, told)

    @property
    def doubtful(self) -> bool:
        """Whether a reset, a swap or a jump came and nobody has said since that the angles are right."""
        return self.plausible.doubtful


@contextmanager
def streaming(source: str | Path, angles: bool = True) -> Iterator[Stream]:
    """A stream by the url of its source, its file, or a recording by its path. Raises UlnaInputError."""
    stated = read_source(source)
    found = open_source(stated)
    try:
        yield Stream(found, stated, angles)
    finally:
        found.close()
