"""Packets: sync bytes, numbers as a struct, perhaps a checksum."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable

from ulna.ground.worded import worded
from ulna.live.decode.decoder import Row, Skipped
from ulna.live.decode.fields import SECONDS

NO_PACKET = worded("no packet")


def _crc16(data: bytes, value: int, polynomial: int, reflected: bool) -> int:
    """CRC of 16 bits; reflected: the lowest bit goes first, the polynomial written so."""
    for byte in data:
        value ^= byte if reflected else byte << 8
        for _ in range(8):
            if reflected:
                value = value >> 1 ^ (polynomial if value & 1 else 0)
            else:
                value = (value << 1 ^ (polynomial if value & 0x8000 else 0)) & 0xFFFF
    return value


def _xor(data: bytes) -> int:
    value = 0
    for byte in data:
        value ^= byte
    return value


CHECKSUMS: dict[str, tuple[str, Callable[[bytes], int]]] = {
    "sum8": ("B", lambda data: sum(data) & 0xFF),
    "xor8": ("B", _xor),
    "crc16-modbus": ("<H", lambda data: _crc16(data, 0xFFFF, 0xA001, True)),
    "crc16-ccitt": (">H", lambda data: _crc16(data, 0xFFFF, 0x1021, False)),
}
"""Name → how it stands behind the numbers, and how it is made of them (the sync bytes not among them). Their checks,
of the text 123456789: crc16-modbus 0x4B37, crc16-ccitt (of 0xFFFF) 0x29B1."""


class Packets:
    """Packets of one size.

    layout: as Python's struct has it, "<I7f"; sync: the bytes before each, b"" where each message is a packet; names:
    of the numbers, "-" is not read. Without a checksum the first packet of a run is believed when another follows it.
    """

    def __init__(
        self,
        layout: str,
        sync: bytes = b"",
        checksum: str | None = None,
        names: tuple[str, ...] | None = None,
        time: str | None = None,
        time_unit: str = "ms",
        button: str | None = None,
    ) -> None:
        self.skipped = Skipped()
        self._struct = struct.Struct(layout)
        self._sync = sync
        self._sum = None if checksum is None else CHECKSUMS[checksum]
        self._scale = SECONDS[time_unit]
        self._end = len(sync) + self._struct.size
        self._whole = self._end + (0 if self._sum is None else struct.calcsize(self._sum[0]))
        count = len(self._struct.unpack(bytes(self._struct.size)))
        names = names or tuple(f"c{k}" for k in range(1, count + 1))
        self._at = [k for k, name in enumerate(names) if name not in ("-", time, button)]
        self._at_time = names.index(time) if time in names else None
        self._at_button = names.index(button) if button in names else None
        self.channels: tuple[str, ...] | None = tuple(names[k] for k in self._at)
        self._left = b""
        self._locked = False

    def feed(self, data: bytes, t_host_s: float, whole: bool = False) -> list[Row]:
        """As `Decoder`."""
        if whole:
            return self._message(data, t_host_s)
        rows: list[Row] = []
        data, at = self._left + data, 0
        needed = self._whole + (0 if self._sum is not None else len(self._sync))
        while True:
            if len(data) - at < len(self._sync) and self._sync.startswith(data[at:]):
                break
            if not data.startswith(self._sync, at):
                self._locked = False
                found = data.find(self._sync, at)
                if found < 0:  # the last bytes may be the beginning of sync bytes
                    found = max(at, len(data) - len(self._sync) + 1)
                    if at == found:
                        break
                self.skipped.skip(data[at:found], NO_PACKET, t_host_s)
                at = found
                if not data.startswith(self._sync, at):
                    break
            if len(data) - at < (self._whole if self._locked else needed):
                break
            packet = data[at : at + self._whole]
            follows = self._locked or self._sum is not None or data.startswith(self._sync, at + self._whole)
            row = self._row(packet, t_host_s) if follows else None
            if row is None:
                self._locked = False
                self.skipped.skip(data[at : at + 1], NO_PACKET, t_host_s)
                at += 1
            else:
                self._locked = True
                self.skipped.good()
                rows.append(row)
                at += self._whole
        self._left = data[at:]
        return rows

    def _message(self, data: bytes, t_host_s: float) -> list[Row]:
        """Packets of one message, which are in it from end to end."""
        rows: list[Row] = []
        for at in range(0, len(data), self._whole):
            packet = data[at : at + self._whole]
            row = self._row(packet, t_host_s) if len(packet) == self._whole else None
            if row is None:
                self.skipped.skip(packet, NO_PACKET, t_host_s)
            else:
                self.skipped.good()
                rows.append(row)
        return rows

    def _row(self, packet: bytes, t_host_s: float) -> Row | None:
        if not packet.startswith(self._sync):
            return None
        if self._sum is not None:
            layout, of = self._sum
            if struct.unpack(layout, packet[self._end :])[0] != of(packet[len(self._sync) : self._end]):
                return None
        numbers = self._struct.unpack(packet[len(self._sync) : self._end])
        values = tuple(float(numbers[k]) for k in self._at)
        t_device_s = None if self._at_time is None else float(numbers[self._at_time]) * self._scale
        if not all(map(math.isfinite, values)) or not (t_device_s is None or math.isfinite(t_device_s)):
            return None
        return Row(t_host_s, t_device_s, values, None if self._at_button is None else bool(numbers[self._at_button]))
