"""The last moments of a stream as angles: windows that do not depend on how the samples came in."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64
from ulna.live.samples import Samples

HOP_S = 0.02
"""Of the stream's own time: so often a window is looked at."""


@dataclass(frozen=True)
class Window:
    """The newest samples at some moment."""

    t_s: F64
    """(N,) when each was taken."""
    q_rad: F64
    """(N, n)"""
    button: bool
    """Whether the arm's button went down since the window before."""


class Recent:
    """Keeps `seconds` of angles, and gives a window each `HOP_S` of the stream's time.

    The moments are those of the samples' own times, so the same samples give the same windows however they are cut:
    live, or played again from a journal.
    """

    def __init__(self, joints: int, seconds: float) -> None:
        self._seconds = seconds
        self._t_s = np.zeros(0)
        self._q_rad = np.zeros((0, joints))
        self._down = np.zeros(0, dtype=bool)
        self._next_s: float | None = None
        self._was_down = False

    def push(self, samples: Samples, q_rad: F64) -> Iterator[Window]:
        """Samples newer than all that are here, and the windows that end among them."""
        if not len(samples):
            return
        t_s = samples.t_s
        down = np.zeros(len(t_s), dtype=bool) if samples.button is None else samples.button
        if len(self._t_s) and t_s[0] < self._t_s[-1]:
            # a clock that went back: what was before is of another time
            self.forget()
        known = len(self._t_s)
        self._t_s = np.concatenate([self._t_s, t_s])
        self._q_rad = np.concatenate([self._q_rad, q_rad])
        self._down = np.concatenate([self._down, down])
        if self._next_s is None:
            self._next_s = float(t_s[0]) + HOP_S
        begin = known
        while self._t_s[-1] >= self._next_s:
            end = int(np.searchsorted(self._t_s, self._next_s, side="left")) + 1
            pressed = self._pressed(begin, end)
            begin = max(begin, end)
            first = int(np.searchsorted(self._t_s[:end], self._t_s[end - 1] - self._seconds))
            yield Window(self._t_s[first:end], self._q_rad[first:end], pressed)
            # after a gap the next look is behind it
            self._next_s = float(self._next_s + HOP_S * np.ceil((self._t_s[end - 1] - self._next_s) / HOP_S + 1e-9))
            self._next_s = max(self._next_s, float(self._t_s[end - 1]) + 0.5 * HOP_S)
        self._held_back = begin
        keep = int(np.searchsorted(self._t_s, self._t_s[-1] - self._seconds - 2 * HOP_S))
        self._t_s, self._q_rad, self._down = self._t_s[keep:], self._q_rad[keep:], self._down[keep:]

    def newest(self) -> Window | None:
        """The window that ends now; None where nothing came yet."""
        if not len(self._t_s):
            return None
        first = int(np.searchsorted(self._t_s, self._t_s[-1] - self._seconds))
        return Window(self._t_s[first:], self._q_rad[first:], False)

    def forget(self) -> None:
        """What came so far is of no use: after a reset, say."""
        self._t_s, self._q_rad, self._down = self._t_s[:0], self._q_rad[:0], self._down[:0]
        self._next_s = None

    def _pressed(self, begin: int, end: int) -> bool:
        down = self._down[begin:end]
        if not len(down):
            return False
        before = np.concatenate([[self._was_down], down[:-1]])
        self._was_down = bool(down[-1])
        return bool((down & ~before).any())
