"""JSON: an object a line, or a message."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any

from ulna.ground.worded import kept, worded
from ulna.live.decode.decoder import Row, Skipped, TooLong
from ulna.live.decode.fields import SECONDS
from ulna.live.decode.lines import Lines
from ulna.live.samples import MOST_CHANNELS


class JsonValues:
    """Numbers at paths of an object: `msg.position` (a list of them, or one), `axes.0.angle`.

    values: the paths; joints: path of a list that names them, which may be in any order; names: which are read, in this
    order, else all of the first message; time: path of the device's clock, a number in `time_unit` or an object of
    seconds and nanoseconds; button: path of a number or of true and false; loose: joints, time and button may be
    absent.
    """

    def __init__(
        self,
        values: Sequence[str],
        joints: str | None = None,
        names: tuple[str, ...] | None = None,
        time: str | None = None,
        time_unit: str = "s",
        button: str | None = None,
        midway: bool = False,
        loose: bool = False,
    ) -> None:
        self.skipped = Skipped()
        self._lines = Lines(self.skipped, midway)
        self._values = list(values)
        self._joints, self._time, self._button = joints, time, button
        self._scale = SECONDS[time_unit]
        self._loose = loose
        self.channels = names

    def feed(self, data: bytes, t_host_s: float, whole: bool = False) -> list[Row]:
        """As `Decoder`."""
        rows: list[Row] = []
        # a message may have line ends in it; a stream has them between objects
        lines = [data] if whole else self._lines.feed(data, t_host_s, whole)
        for line in lines:
            try:
                row = self._row(json.loads(line), t_host_s)
            except TooLong as error:
                raise TooLong(kept(error), rows) from None
            except (ValueError, KeyError, IndexError, TypeError, RecursionError, OverflowError) as error:
                self.skipped.skip(line, _why(error), t_host_s)
                continue
            self.skipped.good()
            rows.append(row)
        if self._lines.too_long is not None:
            raise TooLong(self._lines.too_long, rows)
        return rows

    def _row(self, document: Any, t_host_s: float) -> Row:
        numbers: list[float] = []
        for path in self._values:
            found = at(document, path)
            numbers += [_finite(each) for each in found] if isinstance(found, list) else [_finite(found)]
        if len(numbers) > MOST_CHANNELS:
            raise TooLong(f"a message has {len(numbers)} numbers; expected {MOST_CHANNELS} at most. Name fewer paths.")
        said = self._beside(document, self._joints)
        if said is not None and (not isinstance(said, list) or len(said) != len(numbers)):
            raise ValueError(worded("not as many names as numbers ({count})", count=len(numbers)))
        if self.channels is None:
            if not numbers:
                raise ValueError("no number in it")
            self.channels = tuple(map(str, said)) if said else tuple(f"c{k + 1}" for k in range(len(numbers)))
        if said is not None:
            by_name = dict(zip(map(str, said), numbers, strict=True))
            numbers = [by_name[name] for name in self.channels]
        elif len(numbers) != len(self.channels):
            raise ValueError(worded("not {count} numbers", count=len(self.channels)))
        return Row(t_host_s, self._seconds(document), tuple(numbers), self._down(document))

    def _seconds(self, document: Any) -> float | None:
        found = self._beside(document, self._time)
        if found is None:
            return None
        if isinstance(found, dict):  # ROS 2 has sec and nanosec, ROS 1 secs and nsecs
            seconds = found["sec"] if "sec" in found else found["secs"]
            return _finite(seconds) + 1e-9 * _finite(found["nanosec"] if "nanosec" in found else found["nsecs"])
        return _finite(found) * self._scale

    def _down(self, document: Any) -> bool | None:
        found = self._beside(document, self._button)
        return None if found is None else bool(_finite(found))

    def _beside(self, document: Any, path: str | None) -> Any:
        if path is None or (self._loose and not (isinstance(document, dict) and path in document)):
            return None
        return at(document, path)


def at(document: Any, path: str) -> Any:
    """What stands at a path of names and, in lists, places from 0. Raises KeyError, IndexError, TypeError,
    ValueError."""
    for step in path.split("."):
        document = document[int(step)] if isinstance(document, list) else document[step]
    return document


def _finite(value: Any) -> float:
    if isinstance(value, bool):
        return float(value)
    if not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError(worded("not a number where one should be"))
    return float(value)


def _why(error: Exception) -> str:
    if isinstance(error, json.JSONDecodeError | UnicodeDecodeError | RecursionError):
        return worded("no JSON")
    if isinstance(error, KeyError | IndexError | TypeError):
        return (
            worded("nothing at {path}", path=str(error))
            if isinstance(error, KeyError)
            else worded("no such path in it")
        )
    return kept(error)
