"""A stream looked at for rests of the tip: its rate and limits found, the last moments kept, each rest offered once."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.worded import worded
from ulna.live.recent import Recent, Window
from ulna.live.samples import Samples
from ulna.live.still import LEAST_SAMPLES, StillLimits, Stillness, stillness
from ulna.live.stream import Stream
from ulna.live.trigger import Refused, Taken, Trigger

RATE_S = 0.5
"""From so long a stream its rate is taken, where the source does not say it."""
PARTS = (1.0, 0.5, 0.25)
"""Of the time for which the tip must rest: what is shown of a rest that is not long enough yet."""


class Rests:
    """Rests of the tip of one arm in one stream.

    tips_mm: (N, n) angles → (N, 3) places of the tip; covariance_mm2: (n,) angles → (3, 3) of one sample's tip from its
    encoders; seat_mm: noise of a touch; stops_rad: as of a `Trigger`; by_itself: whether rests are touches unasked.
    """

    def __init__(
        self,
        stream: Stream,
        tips_mm: Callable[[F64], F64],
        covariance_mm2: Callable[[F64], F64],
        seat_mm: float,
        stops_rad: F64 | None,
        by_itself: bool,
        from_the_first: bool = True,
    ) -> None:
        """from_the_first: whether a rest in which the stream begins is a touch too."""
        self._stream, self._tips_mm, self._covariance_mm2 = stream, tips_mm, covariance_mm2
        self._seat_mm, self._stops_rad, self._by_itself = seat_mm, stops_rad, by_itself
        self._from_the_first = from_the_first
        self._early: list[tuple[Samples, F64]] = []
        """What came before the rate was known."""
        self._recent: Recent | None = None
        self._trigger: Trigger | None = None

    @property
    def limits(self) -> StillLimits | None:
        """How long, and how still, a touch is; None as long as the stream's rate is not known."""
        return None if self._trigger is None else self._trigger.limits

    def windows(self, samples: Samples, q_rad: F64) -> Iterator[Window]:
        """What came, and the windows that end in it: the same, however the samples came in."""
        if self._recent is not None:
            yield from self._recent.push(samples, q_rad)
            return
        self._early.append((samples, q_rad))
        rate_hz = self._rate_hz()
        if rate_hz is None:
            return
        recent = self._recent = self._begun(rate_hz)
        early, self._early = self._early, []
        for some, angles in early:
            yield from recent.push(some, angles)

    def newest(self) -> Window | None:
        """The window that ends now; None where nothing came yet, or the rate is not known."""
        return None if self._recent is None else self._recent.newest()

    def look(self, window: Window) -> Taken | Refused | None:
        """A rest that was not there before: see `Trigger.look`."""
        return None if self._trigger is None else self._trigger.look(*self._places(window))

    def ask(self, window: Window | None = None) -> Taken | Refused:
        """A touch, asked for: at the end of a window, as by the arm's button, or now."""
        window = window or self.newest()
        if window is None or self._trigger is None:
            return Refused(worded("too little came yet: hold still and try again"))
        return self._trigger.ask(*self._places(window))

    def stillness(self, window: Window, part: float = 1.0) -> Stillness | None:
        """Over the last `part` of the time for which the tip must rest; None where less than that came."""
        limits = self.limits
        t_s, q_rad = window.t_s, window.q_rad
        if limits is None or t_s[-1] - t_s[0] < part * limits.window_s * (1.0 - 1e-9):
            return None
        first = int(np.searchsorted(t_s, t_s[-1] - part * limits.window_s))
        if len(t_s) - first < 4:
            return None
        t_s, q_rad, p_mm, covariance = self._places(Window(t_s[first:], q_rad[first:], False))
        return stillness(t_s, p_mm, covariance, limits)

    def share(self) -> float:
        """For how much of the time for which it must the tip has been resting, of `PARTS`; 0 while it moves."""
        window = self.newest()
        if window is None:
            return 0.0
        found = ((part, self.stillness(window, part)) for part in PARTS)
        return next((part for part, rest in found if rest is not None and rest.still), 0.0)

    def forget(self) -> None:
        """What came so far is of no use: the angles are in doubt."""
        self._early = []
        if self._recent is not None:
            self._recent.forget()

    def _rate_hz(self) -> float | None:
        """As the source says, or as the samples' own times show."""
        stated = self._stream.source.hello.rate_hz
        if stated:
            return stated
        t_s = np.concatenate([samples.t_s for samples, _ in self._early])
        enough = np.flatnonzero(t_s - t_s[0] >= RATE_S)
        enough = enough[enough >= LEAST_SAMPLES]
        return None if not len(enough) else float(enough[0] / (t_s[enough[0]] - t_s[0]))

    def _begun(self, rate_hz: float) -> Recent:
        q_rad = self._early[0][1][0]
        noise_mm = math.sqrt(max(float(np.trace(self._covariance_mm2(q_rad))) / 3.0, 0.0))
        limits = StillLimits.of(noise_mm, rate_hz, self._seat_mm)
        limits = limits.stated_by(self._stream.stated.file.still, rate_hz)
        self._trigger = Trigger(limits, self._stops_rad, self._by_itself, armed=self._from_the_first)
        return Recent(len(q_rad), limits.window_s + 2.0 / rate_hz)

    def _places(self, window: Window) -> tuple[F64, F64, F64, F64]:
        """Times, angles, places of the tip, and the covariance of one sample of it."""
        q_rad = np.ascontiguousarray(window.q_rad)
        return window.t_s, q_rad, self._tips_mm(q_rad), self._covariance_mm2(q_rad[-1])
