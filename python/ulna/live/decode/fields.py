"""Lines of fields: `POS,1042,12.5,-3.25`."""

from __future__ import annotations

import math
import re

from ulna.ground.worded import kept, worded
from ulna.live.decode.decoder import Row, Skipped, TooLong
from ulna.live.decode.lines import Lines
from ulna.live.samples import MOST_CHANNELS

ANY = re.compile(r"[,;\t ]\s*")
SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
"""Unit of a device's clock → seconds."""
_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?")


class Fields:
    """Numbers with a separator between them, as many in every line.

    separator: None is any of comma, semicolon, tab and blanks; prefix: the first field of the lines that are read,
    others are no readings; names: of all fields after it, "-" is not read; time, button: which of the names these are.
    """

    def __init__(
        self,
        separator: str | None = None,
        prefix: str | None = None,
        names: tuple[str, ...] | None = None,
        time: str | None = None,
        time_unit: str = "ms",
        button: str | None = None,
        midway: bool = False,
    ) -> None:
        self.skipped = Skipped()
        self._lines = Lines(self.skipped, midway)
        self._separator, self._prefix = separator, prefix
        self._time, self._button, self._scale = time, button, SECONDS[time_unit]
        self._names: tuple[str, ...] | None = None
        self.channels: tuple[str, ...] | None = None
        if names is not None:
            self._name(names)

    def _name(self, names: tuple[str, ...]) -> None:
        self._names = names
        self._at = [k for k, name in enumerate(names) if name not in ("-", self._time, self._button)]
        self._at_time = names.index(self._time) if self._time in names else None
        self._at_button = names.index(self._button) if self._button in names else None
        self.channels = tuple(names[k] for k in self._at)

    def feed(self, data: bytes, t_host_s: float, whole: bool = False) -> list[Row]:
        """As `Decoder`."""
        rows: list[Row] = []
        for line in self._lines.feed(data, t_host_s, whole):
            try:
                row = self._row(line, t_host_s)
            except TooLong as error:
                raise TooLong(kept(error), rows) from None
            if row is not None:
                self.skipped.good()
                rows.append(row)
        if self._lines.too_long is not None:
            raise TooLong(self._lines.too_long, rows)
        return rows

    def _row(self, line: bytes, t_host_s: float) -> Row | None:
        try:
            text = line.decode("ascii").strip()
        except UnicodeDecodeError:
            self.skipped.skip(line, worded("no text"), t_host_s)
            return None
        fields = ANY.split(text) if self._separator is None else text.split(self._separator)
        if self._prefix is not None:
            if fields[0].strip() != self._prefix:
                self.skipped.skip(line, worded("not a line of '{prefix}'", prefix=self._prefix), t_host_s)
                return None
            del fields[0]
        if self._names is None:
            if not all(_NUMBER.fullmatch(field.strip()) for field in fields):
                self.skipped.skip(line, worded("no line of numbers"), t_host_s)
                return None
            if len(fields) > MOST_CHANNELS:
                raise TooLong(
                    f"a line has {len(fields)} fields, beginning with {line[:40]!r}; expected {MOST_CHANNELS} at most. "
                    "Name those that are read in [decode] names."
                )
            self._name(tuple(f"c{k}" for k in range(1, len(fields) + 1)))
        return self._of(fields, line, t_host_s)

    def _of(self, fields: list[str], line: bytes, t_host_s: float) -> Row | None:
        assert self._names is not None
        if len(fields) != len(self._names):
            self.skipped.skip(line, worded("not {count} fields", count=len(self._names)), t_host_s)
            return None
        try:
            values = tuple(_number(fields[k]) for k in self._at)
            t_device_s = None if self._at_time is None else _number(fields[self._at_time]) * self._scale
            button = None if self._at_button is None else _number(fields[self._at_button]) != 0.0
        except ValueError:
            self.skipped.skip(line, worded("not {count} numbers", count=len(self._names)), t_host_s)
            return None
        return Row(t_host_s, t_device_s, values, button)


def _number(field: str) -> float:
    """Raises ValueError. Not what Python takes besides: 1_000, nan, infinity."""
    if "_" in field:
        raise ValueError
    value = float(field)
    if not math.isfinite(value):
        raise ValueError
    return value
