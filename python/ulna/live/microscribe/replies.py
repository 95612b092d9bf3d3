"""From the bytes of a MicroScribe that is polled to rows.

A reply is the byte that asked for it, with bit 7 set; a bit for each button; two bytes for each angle, 7 bits in each,
the high ones first. No other byte has bit 7, so a reply is whole where so many bytes stand between two that have it. It
is taken when the next one begins: only then nothing more stands in it. Counts go on past a turn; here they begin again
with it, as the maker's software has it.
"""

from __future__ import annotations

from collections.abc import Sequence

from ulna.live.decode.decoder import Row, Skipped

MARK = 0x80
"""The bit that the first byte of a reply alone has."""
FIVE, SIX = 0x01, 0x03
"""Commands that ask for five angles, and for six."""
_MOST = 64


class Replies:
    """A decoder."""

    def __init__(self, counts_per_turn: Sequence[int], buttons: int) -> None:
        """buttons: bits of those that count; 0: there is none."""
        self._counts = tuple(counts_per_turn)
        self.command = FIVE if len(self._counts) <= 5 else SIX
        self.size = 2 + 2 * (5 if self.command == FIVE else 6)
        """Bytes of a reply."""
        self.channels: tuple[str, ...] | None = tuple(f"q{k + 1}" for k in range(len(self._counts)))
        self.skipped = Skipped()
        self._buttons = buttons
        self._reply = bytearray()
        self._t_host_s = 0.0

    def feed(self, data: bytes, t_host_s: float, whole: bool = False) -> list[Row]:
        """As `Decoder`."""
        rows: list[Row] = []
        for byte in data:
            if byte & MARK or len(self._reply) == _MOST:
                rows += self._taken()
            self._reply.append(byte)
            if len(self._reply) <= self.size:
                self._t_host_s = t_host_s
        return rows

    def _taken(self) -> list[Row]:
        """The reply that is over, if it is one."""
        reply, self._reply = bytes(self._reply), bytearray()
        if not reply:
            return []
        if len(reply) != self.size or reply[0] != self.command | MARK:
            self.skipped.skip(reply, f"not a reply of {self.size} bytes", self._t_host_s)
            return []
        self.skipped.good()
        pairs = zip(reply[2::2], reply[3::2], self._counts, strict=False)
        values = tuple(float(((high << 7) | low) % counts) for high, low, counts in pairs)
        button = bool(reply[1] & self._buttons) if self._buttons else None
        return [Row(self._t_host_s, None, values, button)]
