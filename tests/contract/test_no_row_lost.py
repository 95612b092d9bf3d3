"""Rows in = rows used + rows refused: of every table format and of every kind of readings, however rows are spoilt.

Each row has angles of its own. A study that loads has every row as a reading; one that is refused names every row that
is spoilt, by its number or its place in the file.
"""

from __future__ import annotations

import csv
import io
import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import openpyxl
import polars as pl
import pytest
from tests.foreign_tables import WRITERS

from ulna import Arm, InputWarning, Study, UlnaInputError
from ulna.formats.tables.registry import FORMATS
from ulna.measuring.measure import measure

ARM = """\
format = "ulna-arm/1"
name = "two joints"
units = { length = "mm", angle = "rad" }
joint = [{ theta0 = 0.1, alpha = -1.5, a = 40.0, d = 250.0 }, { theta0 = 0.0, d = 0.0 }]
probe = { bent = { tip = { x = 1.0, y = 2.0, z = 200.0 } } }
"""
STUDY = 'format = "ulna-study/1"\narm = "arm.toml"\nunits = { length = "mm", angle = "rad" }\n'
#: kind of readings → its artefact, its features
KINDS = {
    "bar ends": ('artefact = { a = { kind = "bar", length = 100.0 } }', ("A", "B")),
    "points": (
        'artefact = { a = { kind = "points", features = { s1 = [0, 0, 0], s2 = [90, 0, 0], s3 = [0, 80, 0] } } }',
        ("s1", "s2", "s3"),
    ),
    "seats": ('artefact = { a = { kind = "seat" } }', ("seat",)),
}
NAMES = ("q1", "q2", "placement", "feature")
BAD = (None, float("nan"), float("inf"), -float("inf"), "x", "1,5", "--", " ")
"""In place of a number."""


@dataclass
class Rows:
    """A table, and what was done to it."""

    rows: list[list[Any]]
    before: dict[int, list[str]] = field(default_factory=dict)
    """Lines of a text that are no readings, by the row that they stand before."""
    raw: dict[int, str] = field(default_factory=dict)
    """Lines of a text as they stand in place of a row."""
    broken: set[int] = field(default_factory=set)
    """Those of them that are no rows."""

    def of(self, left: list[int]) -> Rows:
        """Only these rows."""
        before = {k: self.before[old] for k, old in enumerate(left) if old in self.before}
        raw = {k: self.raw[old] for k, old in enumerate(left) if old in self.raw}
        return Rows([self.rows[k] for k in left], before, raw)

    def spoilt(self, labels: bool) -> set[int]:
        """Indices of rows that must be refused. labels: whether those without a label must be."""
        bad = set(self.broken)
        for k, (q1, q2, *names) in enumerate(self.rows):
            if not (finite(q1) and finite(q2)) or (labels and None in names):
                bad.add(k)
        return bad


def made(features: tuple[str, ...], source: Random) -> Rows:
    count = source.choice([4, 9, 30])
    placements = ["p1" if k < count // 2 else "p2" for k in range(count)]
    return Rows([[k / 64 + 0.25, -k / 128, placements[k], features[k % len(features)]] for k in range(count)])


def some(rows: Rows, source: Random) -> list[int]:
    return source.sample(range(len(rows.rows)), source.choice([0, 1, 1, 2, 4]))


def no_number(rows: Rows, source: Random, bad: tuple[Any, ...] = BAD) -> None:
    for k in some(rows, source):
        rows.rows[k][source.randrange(2)] = source.choice(bad)


def no_label(rows: Rows, source: Random) -> None:
    for k in some(rows, source):
        rows.rows[k][source.choice([2, 3])] = None


def twice(rows: Rows, source: Random) -> None:
    for k in some(rows, source):
        rows.rows.append(list(rows.rows[k]))


def line(cells: list[Any]) -> str:
    stream = io.StringIO()
    csv.writer(stream, lineterminator="").writerow(["" if cell is None else cell for cell in cells])
    return stream.getvalue()


def spoil_text(rows: Rows, source: Random) -> None:
    """Short and long rows, quotes, blank lines, comments."""
    for k in some(rows, source):
        cells = [str(cell) for cell in rows.rows[k]]
        rows.raw[k], bad = source.choice(
            [
                (",".join(cells[:-1]), True),
                (",".join(cells[:1]), True),
                (",".join([*cells, "7"]), True),
                (",".join([cells[0] + '"', *cells[1:]]), True),
                (",".join(['"' + cells[0], *cells[1:]]), True),
                (",".join([*cells[:3], '"' + cells[3]]), True),
                (",".join(f'"{cell}"' for cell in cells), False),
                (",".join(f" {cell} " for cell in cells), False),
                (",".join(['""', *cells[1:]]), True),
            ]
        )
        if bad:
            rows.broken.add(k)
    for k in some(rows, source):
        rows.before[k] = [source.choice(["", "", "  ", ",,,"])]


def write_text(rows: Rows, path: Path, _source: Random) -> dict[int, int]:
    """Line of each row."""
    lines = [",".join(NAMES)]
    places = {}
    for k, cells in enumerate(rows.rows):
        lines += rows.before.get(k, [])
        lines.append(rows.raw.get(k, line(cells)))
        places[k] = len(lines)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return places


def write_book(rows: Rows, path: Path, source: Random) -> dict[int, int]:
    """With blank rows between."""
    book = openpyxl.Workbook()
    book.active.append(NAMES)
    places, at = {}, 1
    for k, cells in enumerate(rows.rows):
        at += 1 + (source.random() < 0.05)
        for column, cell in enumerate(cells, start=1):
            book.active.cell(at, column).value = str(cell) if cell in (float("inf"), -float("inf")) else cell
        places[k] = at
    book.save(path)
    return places


def foreign(name: str) -> Callable[[Rows, Path, Random], dict[int, int]]:
    def write(rows: Rows, path: Path, _source: Random) -> dict[int, int]:
        columns = {name: [row[k] for row in rows.rows] for k, name in enumerate(NAMES)}
        WRITERS[name](pl.DataFrame(columns), path)
        return {}

    return write


Spoil = Callable[[Rows, Random], None]


def floats(rows: Rows, source: Random) -> None:
    no_number(rows, source, (float("nan"), float("inf"), -float("inf")))


def floats_or_none(rows: Rows, source: Random) -> None:
    no_number(rows, source, (float("nan"), float("inf"), -float("inf"), None))


#: format → what a row of it can be spoilt by, how it is written, what such a file is called
WAYS: dict[str, tuple[list[Spoil], Callable[[Rows, Path, Random], dict[int, int]], str]] = {
    "CSV": ([no_number, no_label, twice, spoil_text], write_text, "t.csv"),
    "Excel": ([no_number, no_label, twice], write_book, "t.xlsx"),
    "Parquet": ([floats_or_none, no_label, twice], foreign("table.parquet"), "t.parquet"),
    "HDF5": ([floats, twice], foreign("columns.hdf5"), "t.h5"),
    "MAT": ([floats, twice], foreign("plain.mat"), "t.mat"),
}


def test_every_format_is_spoilt() -> None:
    assert set(WAYS) == {each.name for each in FORMATS}


def named(message: str, k: int, places: dict[int, int]) -> bool:
    """Whether a message says of a row that it is refused."""
    listed = [number for found in re.findall(r"\brows ((?:\d+, )*\d+)", message) for number in found.split(", ")]
    if str(k + 1) in listed or re.search(rf"\brow {k + 1}\b(?! of sheet)", message):
        return True
    return k in places and re.search(rf"\bline {places[k]}\b|![A-D]{places[k]}\b", message) is not None


@dataclass
class Ending:
    """What became of the rows."""

    used: int
    refused: set[int]
    spoilt: set[int]
    """Those of the refused ones with which something was wrong by themselves."""


Load = Callable[[], list[float]]
Write = Callable[[Rows], dict[int, int]]


def settled(rows: Rows, load: Load, write: Write) -> Ending:
    """As a person would: the rows that a refusal names are taken out, until the rest is read.

    Raises AssertionError for a refusal that names no row, and for a row that is neither read nor named.
    """
    left = list(range(len(rows.rows)))
    refused: set[int] = set()
    spoilt: set[int] = set()
    while True:
        now = rows.of(left)
        places = write(now)
        try:
            read = load()
        except UlnaInputError as error:
            message = str(error)
        else:
            assert sorted(read) == sorted(rows.rows[k][0] for k in left)
            return Ending(len(left), refused, spoilt)
        named_now = {left[k] for k in range(len(left)) if named(message, k, places)}
        assert named_now, message
        refused |= named_now
        if "never touched" not in message:  # of good rows too: their fellows were taken out
            spoilt |= named_now
        left = [k for k in left if k not in named_now]
        if len(left) < 2:
            return Ending(0, refused | set(left), spoilt)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("name", WAYS)
def test_every_row_is_a_reading_or_named(name: str, kind: str, tmp_path: Path) -> None:
    ways, write, file = WAYS[name]
    artefact, features = KINDS[kind]
    (tmp_path / "arm.toml").write_text(ARM)
    (tmp_path / "study.toml").write_text(f'{STUDY}{artefact}\nreadings = [{{ file = "{file}", artefact = "a" }}]\n')
    arm = Arm.load(tmp_path / "arm.toml")
    out = tmp_path / "points.csv"

    def readings() -> list[float]:
        (group,) = Study.load(tmp_path / "study.toml").readings
        return group.q_rad[:, 0].tolist()

    def points() -> list[float]:
        measure(arm, tmp_path / file, probe="bent", out=out, force=True)
        tips = arm.tip(np.array([row[:2] for row in now.rows], dtype=float), "bent")
        assert pl.read_csv(out).select("x", "y", "z").to_numpy() == pytest.approx(tips)
        return [row[0] for row in now.rows]

    def written(some_rows: Rows) -> dict[int, int]:
        nonlocal now
        now = some_rows
        return write(some_rows, tmp_path / file, Random(len(some_rows.rows)))

    kinds = {"used": 0, "refused": 0}
    for seed in range(15):
        source = Random(f"{name} {kind} {seed}")
        rows = made(features, source)
        for spoil in source.sample(ways, source.choice([0, 1, 1, 2])):
            spoil(rows, source)
        now = rows
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", InputWarning)
            for load, labels in ((readings, True), (points, False)):
                ending = settled(rows, load, written)
                assert ending.used + len(ending.refused) == len(rows.rows), seed
                # nothing is refused for nothing, nor used that is none
                if ending.used:
                    assert rows.spoilt(labels=False) <= ending.refused, seed
                assert ending.spoilt <= rows.spoilt(labels), (seed, load.__name__)
                kinds["used"] += ending.used
                kinds["refused"] += len(ending.refused)
    assert min(kinds.values()) > 10, kinds


def finite(cell: Any) -> bool:
    return isinstance(cell, float) and cell - cell == 0.0
