"""Who listens to what happens: each gets every event, and of frames the newest only."""

from __future__ import annotations

import asyncio
import threading
from collections import deque

from ulna.serve.contract.live import LiveEvent

MOST_WAITING = 1000
"""Events that a client may be behind; one that is further is let go, and comes back."""


class Listener:
    """One client."""

    def __init__(self, loop: asyncio.AbstractEventLoop, activity: str | None) -> None:
        """activity: of which it gets the frames; None: of none."""
        self.activity = activity
        self.too_slow = False
        self._loop = loop
        self._texts: deque[str] = deque()
        self._frame: bytes | None = None
        self._wake = asyncio.Event()

    async def next(self) -> str | bytes:
        """The next event, or when there is none the newest frame."""
        while not (self._texts or self._frame):
            self._wake.clear()
            await self._wake.wait()
        if self._texts:
            return self._texts.popleft()
        frame, self._frame = self._frame, None
        assert frame is not None
        return frame

    def tell(self, text: str) -> None:
        """From any thread."""
        self._soon(lambda: self._take(text))

    def show(self, frame: bytes) -> None:
        """From any thread."""
        self._soon(lambda: self._take_frame(frame))

    def _soon(self, work: object) -> None:
        try:
            self._loop.call_soon_threadsafe(work)  # type: ignore[arg-type]
        except RuntimeError:  # the loop is closed: nobody listens any more
            self.too_slow = True

    def _take(self, text: str) -> None:
        if len(self._texts) >= MOST_WAITING:
            self.too_slow = True
        else:
            self._texts.append(text)
        self._wake.set()

    def _take_frame(self, frame: bytes) -> None:
        self._frame = frame
        self._wake.set()


class Hub:
    """All of them."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._listeners: list[Listener] = []

    def join(self, listener: Listener) -> None:
        with self._lock:
            self._listeners.append(listener)

    def leave(self, listener: Listener) -> None:
        with self._lock:
            self._listeners.remove(listener)

    def tell(self, event: LiveEvent, activity: str | None = None) -> None:
        """Everybody; activity: those who look at it."""
        text = event.model_dump_json()
        for listener in self._those(activity):
            listener.tell(text)

    def show(self, activity: str, frame: bytes) -> None:
        """The newest frame of an activity."""
        for listener in self._those(activity):
            listener.show(frame)

    def looked_at(self, activity: str) -> bool:
        """Whether anybody looks at it."""
        return bool(self._those(activity))

    def _those(self, activity: str | None) -> list[Listener]:
        with self._lock:
            return [each for each in self._listeners if activity is None or each.activity == activity]
