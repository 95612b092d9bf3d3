"""Whoever guesses waits: after some tries in vain each takes twice as long as the one before."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

FREE, FREE_OF_ADDRESS = 5, 30
"""Tries in vain without waiting: for one name from one address, and from an address for all names together."""
LONGEST_S = 900.0
FORGOTTEN_S = 3600.0
_MOST = 10_000


class Throttle:
    """Of one server."""

    def __init__(self, now_s: Callable[[], float] = time.monotonic) -> None:
        self._now_s = now_s
        self._lock = threading.Lock()
        self._failed: dict[tuple[str, ...], tuple[int, float]] = {}

    def wait_s(self, name: str, address: str) -> float:
        """How long whoever tries must wait still; 0: not at all."""
        with self._lock:
            return max(
                self._rest_s((address, name), FREE),
                self._rest_s((address,), FREE_OF_ADDRESS),
            )

    def failed(self, name: str, address: str) -> None:
        """It was in vain."""
        now_s = self._now_s()
        with self._lock:
            if len(self._failed) >= _MOST:
                self._failed = {key: each for key, each in self._failed.items() if now_s - each[1] < FORGOTTEN_S}
            if len(self._failed) >= _MOST:
                self._failed.clear()
            for key in ((address, name), (address,)):
                count, last_s = self._failed.get(key, (0, now_s))
                self._failed[key] = (1 if now_s - last_s > FORGOTTEN_S else count + 1), now_s

    def good(self, name: str, address: str) -> None:
        """It was they."""
        with self._lock:
            self._failed.pop((address, name), None)
            count, last_s = self._failed.get((address,), (0, 0.0))
            if count > 0:
                self._failed[(address,)] = count - 1, last_s

    def _rest_s(self, key: tuple[str, ...], free: int) -> float:
        count, last_s = self._failed.get(key, (0, 0.0))
        if count < free:
            return 0.0
        return max(0.0, last_s + min(LONGEST_S, 2.0 ** min(count - free, 20)) - self._now_s())
