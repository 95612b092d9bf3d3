"""The last seconds of a stream, in memory that does not grow."""

from __future__ import annotations

import numpy as np

from ulna.live.samples import Samples


class Ring:
    """Keeps the newest `size` samples of C channels; what is older is forgotten."""

    def __init__(self, channels: int, size: int = 1 << 16) -> None:
        self._t_host_s = np.zeros(size)
        self._t_device_s = np.full(size, np.nan)
        self._raw = np.zeros((size, channels))
        self._button = np.zeros(size, dtype=bool)
        self._timed = self._has_button = False
        self._size = size
        self.count = 0
        """Samples that ever came."""

    def __len__(self) -> int:
        return min(self.count, self._size)

    def push(self, samples: Samples) -> None:
        """Samples newer than all that are here."""
        new = samples[-self._size :] if len(samples) > self._size else samples
        self.count += len(samples) - len(new)
        at = (self.count + np.arange(len(new))) % self._size
        self._t_host_s[at] = new.t_host_s
        self._raw[at] = new.raw
        self._t_device_s[at] = np.nan if new.t_device_s is None else new.t_device_s
        self._button[at] = False if new.button is None else new.button
        self._timed |= new.t_device_s is not None
        self._has_button |= new.button is not None
        self.count += len(new)

    def newest(self, n: int) -> Samples:
        """The newest n samples, or as many as there are, oldest first; copies."""
        n = min(n, len(self))
        at = np.arange(self.count - n, self.count) % self._size
        return Samples(
            self._t_host_s[at],
            self._t_device_s[at] if self._timed else None,
            self._raw[at],
            self._button[at] if self._has_button else None,
        )

    def last(self, seconds: float) -> Samples:
        """The samples of the last seconds, counted back from the newest."""
        if not len(self):
            return self.newest(0)
        newest_s = self._t_host_s[(self.count - 1) % self._size]
        order = np.arange(self.count - len(self), self.count) % self._size
        n = len(self) - int(np.searchsorted(self._t_host_s[order], newest_s - seconds, side="left"))
        return self.newest(n)

    def between(self, begin_s: float, end_s: float) -> Samples:
        """The samples of a time, both ends with it, by the host's clock."""
        every = self.newest(len(self))
        first, last = np.searchsorted(every.t_host_s, begin_s), np.searchsorted(every.t_host_s, end_s, side="right")
        return every[int(first) : int(last)]
