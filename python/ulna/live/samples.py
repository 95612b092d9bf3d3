"""Samples: what a source gives, as arrays."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64, Bool

MOST_CHANNELS = 32
"""More is no arm: the source ends."""


@dataclass(frozen=True)
class Hello:
    """What a source says of itself once it is open."""

    channels: tuple[str, ...]
    """What its numbers are called, in the order of `Samples.raw`."""
    unit: str | None
    """deg, rad or counts, where the source knows."""
    device: str
    """What it is, for people."""
    rate_hz: float | None = None
    """Samples a second, where the source knows."""
    counts_per_turn: tuple[float, ...] | None = None
    """Of each channel, where the device tells it."""

    def counts_of(self, names: Sequence[str]) -> list[float] | None:
        """Counts per turn of some of its channels; None where the device does not tell them."""
        if self.counts_per_turn is None:
            return None
        return [self.counts_per_turn[self.channels.index(name)] for name in names]


@dataclass(frozen=True)
class Samples:
    """N samples of C channels, in the order in which they came."""

    t_host_s: F64
    """(N,) time.monotonic() when each arrived."""
    t_device_s: F64 | None
    """(N,) by the device's clock, where it sends one."""
    raw: F64
    """(N, C) as sent: deg, rad or counts."""
    button: Bool | None = None
    """(N,) whether the arm's button was down, where it has one."""

    def __len__(self) -> int:
        return len(self.t_host_s)

    @property
    def t_s(self) -> F64:
        """(N,) by the device's clock where it sends one, else by ours."""
        return self.t_host_s if self.t_device_s is None else self.t_device_s

    @classmethod
    def none(cls, channels: int) -> Samples:
        """No sample."""
        return cls(np.empty(0), None, np.empty((0, channels)), None)

    @classmethod
    def joined(cls, parts: Sequence[Samples]) -> Samples:
        """One after another. What not all parts have (a device's time, a button) the whole has not."""
        times = [part.t_device_s for part in parts if part.t_device_s is not None]
        buttons = [part.button for part in parts if part.button is not None]
        return cls(
            np.concatenate([part.t_host_s for part in parts]),
            np.concatenate(times) if len(times) == len(parts) else None,
            np.concatenate([part.raw for part in parts]),
            np.concatenate(buttons) if len(buttons) == len(parts) else None,
        )

    def __getitem__(self, which: slice) -> Samples:
        return Samples(
            self.t_host_s[which],
            None if self.t_device_s is None else self.t_device_s[which],
            self.raw[which],
            None if self.button is None else self.button[which],
        )
