"""What is known of a stream while it is read."""

from __future__ import annotations

import time
from collections import deque
from typing import Any

from ulna.ground.errors import UlnaInputError
from ulna.live.faults import ENDED, Fault
from ulna.live.stream import Frames, Stream

_FAULTS = 5


class Round:
    """What is known of a stream while it is read."""

    def __init__(self, stream: Stream) -> None:
        self.stream = stream
        self.count = 0
        self.counted: dict[str, int] = {}
        """Faults by kind."""
        self.last: deque[Fault] = deque(maxlen=_FAULTS)
        """The newest that were told."""
        self.newest: Frames | None = None
        self.why: str | None = None
        """Why it ended."""
        self._arrivals: deque[tuple[float, int]] = deque(maxlen=4096)

    def take(self, frames: Frames) -> None:
        self.count += len(frames.samples)
        if len(frames.samples):
            self.newest = frames
            self._arrivals.append((time.monotonic(), self.count))
        for each in frames.faults:
            self.counted[each.kind] = self.counted.get(each.kind, 0) + 1
        self.last.extend(frames.told)

    def check_came(self) -> None:
        """Raises UlnaInputError where the source ended and no reading came."""
        if self.why is None or self.count:
            return
        said = [f"{each.text.rstrip('.')}. " for each in self.last if each.kind != ENDED]
        remedy = "Say how it is written, in [decode] of a source file" if said else "Check the device, or the recording"
        raise UlnaInputError(
            f"source '{self.stream.stated.url.text}': it ended without a reading ({self.why.rstrip('.')}); expected "
            f"one at the least. {''.join(said)}{remedy}."
        )

    @property
    def rate_hz(self) -> float:
        """Samples a second over the last two."""
        now = time.monotonic()
        while len(self._arrivals) > 2 and now - self._arrivals[0][0] > 2.0:
            self._arrivals.popleft()
        if len(self._arrivals) < 2:
            return 0.0
        (begin, few), (_, many) = self._arrivals[0], self._arrivals[-1]
        return (many - few) / max(now - begin, 1e-9)

    @property
    def silent_s(self) -> float:
        """Since the newest sample came."""
        return time.monotonic() - self._arrivals[-1][0] if self._arrivals else 0.0

    def as_dict(self) -> dict[str, Any]:
        return {"samples": self.count, "faults": self.counted, "doubtful": self.stream.doubtful, "ended": self.why}
