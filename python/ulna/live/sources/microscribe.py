"""`microscribe:/dev/ttyUSB0?baud=115200`: a MicroScribe digitizer, polled.

From the published protocol (the maker's SDK manual; D. Betancourt's program that reads a 3DX); untested on a device. It
counts from the home position in which it was switched on: with the stylus in its holder.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from ulna.ground.errors import UlnaInputError
from ulna.live.microscribe.geometry import drawn
from ulna.live.microscribe.replies import Replies
from ulna.live.microscribe.talking import BAUDS, END, Talk, Told
from ulna.live.source import SourceEnded
from ulna.live.source_file import StatedSource
from ulna.live.sources.serial import SerialWire, port_of
from ulna.live.sources.wire import WireSource
from ulna.proposals.arms import Drawn

KNOWN = ("baud", "rate", "pedal", "wait")
BAUD, RATE_HZ = 115200, 100.0
PEDALS = {"any": 0x03, "right": 0x01, "left": 0x02}
"""Which pedal is the button → its bits; a single pedal is the right one."""
SILENT_S = 3.0
"""A device that is asked and says nothing for so long is gone: of a cable pulled at its end a port knows nothing."""
_LOST_S = 0.1
"""A reply that has not come whole by then does not come."""
_TIMEOUT_S, _END_S = 0.02, 0.02


class MicroscribeWire:
    """Asks for the angles and hears what comes; again when a whole reply came, or none."""

    messages = False

    def __init__(self, line: SerialWire, told: Told, replies: Replies, rate_hz: float) -> None:
        self.device = f"{told.name} at {line.device}"
        self._line, self._request, self._size = line, bytes([replies.command]), replies.size
        self._period_s = 1.0 / rate_hz
        self._came = replies.size
        self._asked_s = self._next_s = self._last_s = time.monotonic()
        self._left = False

    def receive(self) -> list[bytes]:
        """As `Wire`."""
        now_s = time.monotonic()
        if (self._came >= self._size or now_s - self._asked_s > _LOST_S) and not self._left:
            if now_s < self._next_s:
                time.sleep(min(self._next_s - now_s, 0.1))
                return []
            self._line.send(self._request)
            self._came, self._asked_s = 0, now_s
            self._next_s = max(self._next_s + self._period_s, now_s)
        found = self._line.receive()
        self._came += sum(map(len, found))
        if found:
            self._last_s = time.monotonic()
        elif time.monotonic() - self._last_s > SILENT_S:
            raise SourceEnded(
                f"{self.device}: no answer for {SILENT_S:g} s: the cable was pulled, or the device is off."
            )
        return found

    def close(self) -> None:
        """As `Wire`. Ends the session, so that the next one can begin."""
        if not self._left:
            self._left = True
            _leave(self._line)


def _leave(line: SerialWire) -> None:
    with suppress(SourceEnded):
        line.send(END)
        time.sleep(_END_S)
    line.close()


def _line(stated: StatedSource) -> SerialWire:
    url = stated.url
    url.check(KNOWN)
    baud = int(url.word("baud", str(BAUD), [str(each) for each in BAUDS]))
    return SerialWire(port_of(url), baud, timeout_s=_TIMEOUT_S)


@contextmanager
def _talking(stated: StatedSource, line: SerialWire) -> Iterator[Talk]:
    """A session; left where it goes wrong."""
    try:
        yield Talk(line, stated.url.number("wait", 5, 0.1, 3600))
    except SourceEnded as ended:
        _leave(line)
        raise UlnaInputError(f"{ended} No reading came before. Check the device.") from None
    except BaseException:
        _leave(line)
        raise


def open_source(stated: StatedSource) -> WireSource:
    """As the registry asks. Raises UlnaInputError."""
    rate_hz = stated.url.number("rate", RATE_HZ, 0.1, 1000)
    pedal = PEDALS[stated.url.word("pedal", "any", tuple(PEDALS))]
    line = _line(stated)
    with _talking(stated, line) as talk:
        told = talk.told()
        replies = Replies(told.counts_per_turn, told.buttons & pedal)
        wire = MicroscribeWire(line, told, replies, rate_hz)
    return WireSource(wire, replies, "counts", 1.0, counts_per_turn=told.counts_per_turn)


def device_arm(stated: StatedSource) -> Drawn:
    """The arm that the device itself describes. Raises UlnaInputError."""
    line = _line(stated)
    with _talking(stated, line) as talk:
        found = drawn(talk, talk.told(), line.device)
    _leave(line)
    return found
