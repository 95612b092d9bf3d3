"""Values that nobody thought of: what stands in place of a number, a text, a table."""

from __future__ import annotations

import datetime
from collections.abc import Callable
from random import Random
from typing import Any


class Raw(str):
    """Written as it stands, whatever the language: numbers that no parser gives back."""


NUMBERS: tuple[Any, ...] = (
    0,
    -0.0,
    1,
    -1,
    2,
    3,
    0.5,
    -0.5,
    1e-9,
    1e9,
    1e15,
    1e16,
    -1e15,
    1e-300,
    5e-324,
    1e200,
    1.7e308,
    2**31,
    2**53 + 1,
    2**63,
    -(2**63) - 1,
    2**64,
    10**30,
    293.15,
    360,
    1e6,
    float("nan"),
    float("inf"),
    -float("inf"),
    Raw("1e999"),
    Raw("-1e999"),
    Raw("1" * 400),
    Raw("9" * 5000),
    Raw("1e-999"),
    Raw("00"),
    Raw("0x10"),
    Raw("1_000"),
    Raw("+1"),
    Raw(".5"),
    Raw("1."),
)
TEXTS: tuple[str, ...] = (
    "",
    " ",
    "0",
    "1",
    "-1",
    "1,5",
    "nan",
    "NaN",
    "inf",
    "1e999",
    "true",
    "null",
    "None",
    "*",
    "**",
    "[",
    "]",
    "joint.*",
    "joint.1.a",
    "joint.99.a",
    "joint.-1.a",
    "probe.*",
    "A",
    "B",
    "seat",
    "bar",
    "dh",
    "hayati",
    "mm",
    "µm",
    "in",
    "deg",
    "rad",
    "counts",
    "en",
    "zh",
    "\x00",
    "a\x00b",
    "\x1b[31mred\x1b[0m",
    "\x07",
    "\r\n",
    "two\nlines",
    "\t",
    "‮abc",
    "\ud800",
    "\udfff",
    "é",
    "e\u0301",
    "Größe",
    "左",
    "🦾",
    "\ufeff",
    "\u2028",
    "\u00a0",
    "a" * 300,
    "=1+1",
    '=HYPERLINK("x")',
    "'",
    '"',
    '"""',
    "`",
    "\\",
    "../..",
    "/",
    ".",
    "..",
    "/dev/null",
    "nowhere/at/all",
    "con",
    "%s%n",
    "{0}",
    "${x}",
    "<b>",
    "&amp;",
    "]]>",
    "--",
    "2026-13-45",
    "2026-01-01",
    "1970-01-01T00:00:00Z",
    "fossil",
    "bent",
    "a.b",
    "a b",
    "arm.toml",
    "study.toml",
    "bars.csv",
    "file:///x",
)
DATES = (Raw("2026-01-01"), Raw("07:32:00"), Raw("1979-05-27T07:32:00Z"), Raw("9999-12-31"), Raw("0001-01-01"))


def number(source: Random) -> Any:
    return source.choice(NUMBERS)


def text(source: Random) -> str:
    return source.choice(TEXTS)


def deep(source: Random) -> Any:
    """Lists or tables within each other."""
    value: Any = source.choice([0, "x", {}, []])
    tables = source.random() < 0.5
    for _ in range(source.choice([2, 5, 40, 150])):
        value = {"a": value} if tables else [value]
    return value


def any_value(source: Random, dates: bool = False) -> Any:
    """Anything."""
    kinds: list[Callable[[Random], Any]] = [
        number,
        number,
        text,
        text,
        deep,
        _container,
        _flag,
        *([_date] if dates else []),
    ]
    return source.choice(kinds)(source)


def _flag(source: Random) -> Any:
    return source.choice([True, False, None])


def _date(source: Random) -> Any:
    return source.choice(DATES)


def _container(source: Random) -> Any:
    count = source.choice([0, 1, 2, 3, 4, 7, 60])
    if source.random() < 0.3:
        return {text(source): number(source) for _ in range(count)}
    makers: list[Callable[[Random], Any]] = [number, text, lambda s: [number(s) for _ in range(3)], lambda s: {}]
    maker = source.choice(makers)
    return [maker(source) for _ in range(count)]


def as_date(shown: str) -> Any:
    """What stands in a cell for one of DATES, where cells have types."""
    for kind in (datetime.date, datetime.datetime, datetime.time):
        try:
            return kind.fromisoformat(shown)
        except ValueError:
            continue
    raise ValueError(shown)
