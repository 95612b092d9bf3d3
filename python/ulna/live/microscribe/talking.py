"""The talk with a MicroScribe before it is polled: greeting, who it is, what its numbers mean.

From the published protocol (the maker's SDK manual, chapter 4); untested on a device. The rate of the line is found by
the device from the greeting, which is said again and again. A command is one byte; its answer begins with that byte.
Letters are commands as well once the session is open, and BEGIN would set the encoders to the home position: it is said
once, after the device gave the greeting back.
"""

from __future__ import annotations

import struct
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Protocol

from ulna.ground.errors import UlnaInputError

GREETING, BEGIN, END = b"IMMC", b"BEGIN", b"\xc5"
NAME = "MSCR"
"""How a MicroScribe answers BEGIN; its maker's other devices say other names."""
BAUDS = (9600, 14400, 19200, 28800, 38400, 57600, 115200)
"""Rates that the device finds by itself."""
MAXIMA, PARAMETERS, MORE_PARAMETERS = 0xC6, 0xC0, 0xD3
_MAXIMA = struct.Struct(">BH8BB6H")
"""Buttons there are, last tick of the timer, eight analog inputs and their lowest bits, last count of six encoders."""
_MOST_COUNTS = 1 << 14
"""An angle is sent in 14 bits."""
_ANSWER_S, _QUIET_S = 2.0, 0.05
_LONGEST_TEXT = 64


class Line(Protocol):
    """A line in both directions."""

    device: str

    def send(self, data: bytes) -> None:
        """Raises SourceEnded where it is gone."""

    def receive(self) -> Iterable[bytes]:
        """What came; waits for a moment. Raises SourceEnded where it is gone."""


@dataclass(frozen=True)
class Told:
    """What a device says of itself."""

    product: str
    model: str
    serial: str
    comment: str
    """"Standard+Beta" where one of its axes is tilted by a beta."""
    form: str
    """In which form it gives its geometry: "Format DH0.5"."""
    firmware: str
    buttons: int
    """A bit for each button there is: 1 the right or single pedal, 2 the left one."""
    counts_per_turn: tuple[int, ...]
    """Of each encoder, from the base."""

    @property
    def name(self) -> str:
        """For people."""
        return " ".join(each for each in (self.product, self.model, self.serial) if each)


class Talk:
    """A session that is open. Numbers come without a checksum, so they are asked for twice and must be the same."""

    def __init__(self, line: Line, wait_s: float) -> None:
        """Greets. Raises UlnaInputError where no MicroScribe answers so long, SourceEnded where the line is gone."""
        self._line = line
        self._device = line.device
        self._greet(wait_s)
        self._quiet()
        line.send(BEGIN)
        said = self._text(self._heard("BEGIN", _size_of_text, None))
        while said.startswith(GREETING.decode()):
            said = said.removeprefix(GREETING.decode())
        if said != NAME:
            raise UlnaInputError(
                f"{self._device}: says that it is '{said}'; expected '{NAME}', a MicroScribe. Check the port: "
                "ulna live ports"
            )

    def _greet(self, wait_s: float) -> None:
        until, heard = time.monotonic() + wait_s, bytearray()
        while GREETING not in heard:
            if time.monotonic() > until:
                shown = bytes(heard[:20]).decode("ascii", "backslashreplace").encode("unicode_escape").decode()
                came = f"; {len(heard)} bytes came that are none: '{shown}'" if heard else ""
                raise UlnaInputError(
                    f"{self._device}: no MicroScribe answered the greeting in {wait_s:g} s{came}. Expected one that is "
                    "switched on. Check port and cable, or try another rate, such as ?baud=19200"
                )
            self._line.send(END + GREETING)  # END: a session may have been left open
            for piece in self._line.receive():
                heard += piece

    def _quiet(self) -> None:
        """Until nothing more comes: the greeting is given back as often as it was said."""
        last = time.monotonic()
        until = last + _ANSWER_S
        while time.monotonic() < min(last + _QUIET_S, until):
            if any(self._line.receive()):
                last = time.monotonic()

    def told(self) -> Told:
        """Who it is. Raises UlnaInputError for an answer that is none, SourceEnded where the line is gone."""
        texts = {
            name: self._text(self._answer(f"its {name}", command, _size_of_text))
            for name, command in (
                ("product", 0xC8), ("model", 0xCA), ("serial", 0xCB), ("comment", 0xCC), ("form", 0xCD),
                ("firmware", 0xCE),
            )
        }  # fmt: skip
        buttons, *_ = numbers = _MAXIMA.unpack(self._twice("its greatest counts", MAXIMA, lambda _: _MAXIMA.size))
        greatest = list(numbers[-6:])
        while greatest and not greatest[-1]:
            greatest.pop()
        counts = tuple(each + 1 for each in greatest)
        if not counts or any(each == 1 or _MOST_COUNTS % each for each in counts):
            raise UlnaInputError(
                f"{self._device}: says that its encoders count to {', '.join(map(str, numbers[-6:]))}; expected a "
                f"power of two less one of each, {_MOST_COUNTS - 1} at most, 0 of those it lacks. Switch it off "
                "and on, and try again."
            )
        return Told(buttons=buttons, counts_per_turn=counts, **texts)

    def block(self, what: str, command: int, size: int) -> bytes:
        """A block of numbers that begins with its size. Raises UlnaInputError where that is another."""
        block = self._twice(what, command, lambda body: 1 + body[0] if body else None)
        if len(block) != 1 + size:
            raise UlnaInputError(
                f"{self._device}: {what} are {len(block) - 1} bytes; expected {size}. This firmware is not known."
            )
        return block[1:]

    def _twice(self, what: str, command: int, size_of: Callable[[bytes], int | None]) -> bytes:
        first, second = (self._answer(what, command, size_of) for _ in range(2))
        if first != second:
            raise UlnaInputError(
                f"{self._device}: {what} came as {first.hex()} and, asked again, as {second.hex()}; expected the same. "
                "Something disturbs the line: check the cable, or try a lower rate, such as ?baud=19200"
            )
        return first

    def _answer(self, what: str, command: int, size_of: Callable[[bytes], int | None]) -> bytes:
        self._line.send(bytes([command]))
        return self._heard(what, size_of, command)

    def _heard(self, what: str, size_of: Callable[[bytes], int | None], echo: int | None) -> bytes:
        """What came after the echo, as soon as it is whole. size_of: how long that is, None as long as it is not
        known."""
        heard, until = bytearray(), time.monotonic() + _ANSWER_S
        while time.monotonic() < until:
            for piece in self._line.receive():
                heard += piece
            begin = 0 if echo is None else heard.find(echo) + 1
            if echo is None or begin:
                body = bytes(heard[begin:])
                size = size_of(body)
                if size is not None and len(body) >= size:
                    return body[:size]
        shown = f"{len(heard)} bytes came: {heard[:20].hex()}" if heard else "nothing came"
        raise UlnaInputError(
            f"{self._device}: no whole answer when asked for {what} in {_ANSWER_S:g} s ({shown}); expected one as a "
            "MicroScribe gives it. Switch it off and on with the stylus in its holder, and try again."
        )

    def _text(self, body: bytes) -> str:
        text = body[:-1].decode("latin-1").strip()
        if len(text) > _LONGEST_TEXT or not (text.isascii() and (text.isprintable() or not text)):
            raise UlnaInputError(
                f"{self._device}: said {body[:20].hex()} of itself; expected a word. Something disturbs the line: "
                "check the cable, or try a lower rate, such as ?baud=19200"
            )
        return text


def _size_of_text(body: bytes) -> int | None:
    return body.find(0) + 1 or None
