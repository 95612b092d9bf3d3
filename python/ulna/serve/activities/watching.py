"""A stream, shown: with an arm, where it is."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from ulna.arm.arm import Arm
from ulna.live.samples import Samples
from ulna.live.stream import Frames, Stream
from ulna.serve.activities.activity import Doing, unknown
from ulna.serve.activities.seen import Seen
from ulna.serve.contract.activities import WatchState
from ulna.serve.contract.live import LiveEvent
from ulna.serve.contract.words import Do, DoTrust
from ulna.serve.frames import Newest


class Watching(Doing):
    """Of one source."""

    kind = "watch"

    def __init__(self, stream: Stream, arm: Arm | None) -> None:
        self.stream = stream
        self._seen = Seen(arm)
        self._last: tuple[Samples, Frames] | None = None

    def begin(self) -> Iterator[LiveEvent]:
        """Nothing."""
        yield from ()

    def feed(self, frames: Frames) -> Iterator[LiveEvent]:
        """Kept, to be drawn."""
        if len(frames.samples):
            self._last = frames.samples, frames
        yield from ()

    def do(self, asked: Do) -> Iterator[LiveEvent]:
        """The angles may be said to be right again."""
        if not isinstance(asked, DoTrust):
            raise unknown(asked, self.kind)
        self.stream.plausible.trust()
        yield from ()

    def state(self) -> WatchState:
        """Nothing of its own."""
        return WatchState(kind="watch")

    def newest(self) -> Newest | None:
        """The arm where it is."""
        if self._last is None:
            return None
        samples, frames = self._last
        return self._seen.newest(float(samples.t_s[-1]), frames.q_rad[-1], self.stream.doubtful)

    def finish(self) -> tuple[list[tuple[str, Path]], list[str]]:
        """It leaves nothing."""
        return [], []
