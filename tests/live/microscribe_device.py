"""A MicroScribe on a pseudo-terminal, written from the facts of its published protocol."""

from __future__ import annotations

import math
import os
import random
import select
import struct
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager

from tests.live.parts import Pty

COUNTS = (16384, 16384, 8192, 4096, 4096)
"""Of a 3DX, and below its table: alpha, a, d of six rows and beta, as its owner published what it sends."""
ALPHA = (0, 0x3FF5, -7, 0x3FE5, 0xC002 - 65536, 0xC00C - 65536)
A = (0, 0x03C0, 0x2810, 0x0215, 0xFE6F - 65536, 0x018F)
D = (0x206C, 0xFC92 - 65536, -3, 0x241C, 0x0140, 0xEB66 - 65536)
BETA = 3


class Device:
    """What it does with what it hears. Angles are those of a list, the next one at each poll, the last one again."""

    def __init__(
        self,
        polls: Sequence[Sequence[int]] = ((0,) * 5,),
        buttons: Sequence[int] = (0,),
        texts: dict[int, bytes] | None = None,
        maxima: Sequence[int] = (*(each - 1 for each in COUNTS), 0),
        pedals: int = 3,
        block: bytes = struct.pack(">18h", *ALPHA, *A, *D),
        beta: int = BETA,
        begun: bool = False,
        spoil: Callable[[int, bytes], bytes] = lambda _, reply: reply,
        answers: Callable[[bytes], bytes | None] = lambda _: None,
        seed: int = 1,
    ) -> None:
        """texts: by command; begun: a session was left open; spoil: what becomes of the reply to poll k; answers:
        what is said in place of what should be."""
        self.polls, self.buttons, self.spoil, self.answers = polls, buttons, spoil, answers
        self.texts = {
            0: b"MSCR", 0xC8: b"MicroScribe3D", 0xC9: b"MSCR", 0xCA: b"DX", 0xCB: b"12345", 0xCC: b"Standard+Beta",
            0xCD: b"Format DH0.5", 0xCE: b"HCI 2.0",
        } | (texts or {})  # fmt: skip
        self.maxima = struct.pack(">BH8xx6H", pedals, 0x3FFF, *maxima)
        self.block, self.beta = block, beta
        self.state = "open" if begun else "off"
        self.heard = bytearray()
        self.polled = 0
        self.homed = self.ended = self.begun = 0
        self._waiting = bytearray()
        self._random = random.Random(seed)

    def hears(self, data: bytes) -> bytes:
        """What it answers."""
        self.heard += data
        self._waiting += data
        said = b""
        while True:
            if self.state == "off":  # looks for the rate until it reads the greeting
                at = self._waiting.find(b"IMMC")
                if at < 0:
                    del self._waiting[:-3]
                    return said
                del self._waiting[: at + 4]
                said += self._or(b"IMMC", b"IMMC")
                self.state = "greeted"
            elif self.state == "greeted":
                if self._waiting[:1] == b"\xc5":
                    del self._waiting[:1]
                elif self._waiting.startswith(b"IMMC"):
                    del self._waiting[:4]
                    said += self._or(b"IMMC", b"IMMC")
                elif self._waiting.startswith(b"BEGIN"):
                    del self._waiting[:5]
                    self.begun += 1
                    self.state = "open"
                    said += self._or(b"BEGIN", self.texts[0] + b"\x00")
                else:
                    return said
            elif not self._waiting:
                return said
            else:
                command = self._waiting.pop(0) | 0x80
                said += self._or(bytes([command]), self._answered(command))

    def _or(self, asked: bytes, answer: bytes) -> bytes:
        other = self.answers(asked)
        return answer if other is None else other

    def _answered(self, command: int) -> bytes:
        echo = bytes([command])
        if not command & 0x40:
            return self._report(command)
        if command in self.texts:
            return echo + self.texts[command] + b"\x00"
        match command:
            case 0xC0:
                return echo + bytes([len(self.block)]) + self.block
            case 0xC2:
                self.homed += 1
            case 0xC5:
                self.ended += 1
                self.state = "off"
            case 0xC6:
                return echo + self.maxima
            case 0xD3:
                return echo + b"\x02" + struct.pack(">h", self.beta) if b"Beta" in self.texts[0xCC] else b""
        return echo

    def _report(self, command: int) -> bytes:
        angles = {0: 0, 1: 5, 2: 7, 3: 6}[command & 3]
        counts = [*self.polls[min(self.polled, len(self.polls) - 1)], 0, 0][:angles]
        pressed = self.buttons[min(self.polled, len(self.buttons) - 1)]
        reply = bytes([command, pressed, *(half for each in counts for half in divmod(each % 16384, 128))])
        self.polled += 1
        return self.spoil(self.polled - 1, reply)

    def pieces(self, data: bytes) -> Iterator[bytes]:
        """Cut at will."""
        while data:
            n = self._random.randrange(1, 9)
            yield data[:n]
            data = data[n:]


class Plugged(Pty):
    """The device at the end of a line."""

    def __init__(self, device: Device) -> None:
        super().__init__()
        self.device = device
        self.silent = False
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._serve, daemon=True)
        self._thread.start()

    def _serve(self) -> None:
        while not self._over.is_set():
            if not select.select([self._ours], [], [], 0.02)[0]:
                continue
            data = os.read(self._ours, 4096)
            if not self.silent:
                for piece in self.device.pieces(self.device.hears(data)):
                    self.send(piece)

    def pull(self) -> None:
        self._over.set()
        self._thread.join(timeout=10)
        super().pull()


@contextmanager
def plugged(device: Device) -> Iterator[Plugged]:
    line = Plugged(device)
    try:
        yield line
    finally:
        line.pull()


def tip_mm(counts: Sequence[float], alpha=ALPHA, a=A, d=D, beta=BETA, turns=COUNTS) -> tuple[float, float, float]:  # type: ignore[no-untyped-def]
    """The tip by its own table, from the last row to the first: a point is put through one elementary motion after the
    other, without a matrix."""
    x = y = z = 0.0
    theta = [2 * math.pi * count / turn for count, turn in zip(counts, turns, strict=True)]
    theta += [0.0] * (6 - len(theta))
    for i in reversed(range(6)):
        z += d[i] * 0.0254
        c, s = math.cos(theta[i]), math.sin(theta[i])
        x, y = c * x - s * y, s * x + c * y
        if i == 2:
            c, s = math.cos(beta * math.pi / 32768), math.sin(beta * math.pi / 32768)
            z, x = c * z - s * x, s * z + c * x
        x += a[i] * 0.0254
        c, s = math.cos(alpha[i] * math.pi / 32768), math.sin(alpha[i] * math.pi / 32768)
        y, z = c * y - s * z, s * y + c * z
    return x, y, z
