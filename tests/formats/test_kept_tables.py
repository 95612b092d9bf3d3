"""Tables as people keep them: random titles, units, blank rows, encodings and spellings of numbers, written by the csv
module and openpyxl, and read back equal; what was passed over is told, and bad cells are found in the file."""

from __future__ import annotations

import csv
import io
import random
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import openpyxl
import pytest

from ulna.formats.header import Header
from ulna.formats.layout import Layout, TableKeys
from ulna.formats.table import read_header, read_table, stream
from ulna.ground.errors import UlnaInputError

NUMBERS = ("q1", "q2", "q3")
COLUMNS = ["id", *NUMBERS, "feature"]
WORDS = {
    "utf-8": "größe 左 °",
    "cp1252": "Größe °C µ",
    "gbk": "关节 距离 测量",
    "utf-16": "größe 左",
    "utf-16-le": "abc",
}


@dataclass
class Kept:
    """A table as somebody keeps it, and what is true of it."""

    rows: list[list[Any]]
    records: list[list[Any]] = field(default_factory=list)
    """What is written, line by line."""
    lines: list[int] = field(default_factory=list)
    """Where each reading stands, from 1."""
    told: list[str] = field(default_factory=list)
    """Parts of what must be remarked upon."""


def kept(seed: int, word: str = "x") -> Kept:
    draw = random.Random(seed)
    rows = [[f"n{k} {word}", *(round(draw.uniform(-3, 3), 6) for _ in NUMBERS), draw.choice("AB")] for k in range(30)]
    table = Kept(rows)
    title = draw.choice([0, 1, 3])
    for k in range(title):
        table.records.append([draw.choice(["Messung", "Protokoll", f"{word}"]), *(["von Hand"] if k == 1 else [])])
        if draw.random() < 0.5:
            table.records.append([])
    table.records.append(COLUMNS)
    if title:
        table.told.append(f"the columns are named in {{}}{len(table.records)}")
    if draw.random() < 0.5:
        table.records.append(["", *[draw.choice(["rad", "[rad]", "(rad)"])] * 3, ""])
        table.told.append("holds units (rad")
    for k, row in enumerate(rows):
        if k in (7, 8, 21) and seed % 2:
            table.records.append([""] * draw.choice([0, 5]))
        table.records.append(row)
        table.lines.append(len(table.records))
    if seed % 2:
        table.told.append("blank rows are passed over")
    if draw.random() < 0.5:
        table.records.append(["End of file"])
        table.told.append("is no reading and not read: 'End of file'")
    return table


def spelled(value: Any, decimal: str) -> Any:
    return value if isinstance(value, str) else f"{value:.6f}".replace(".", decimal)


def written(table: Kept, path: Path, encoding: str, separator: str, decimal: str, end: str) -> None:
    stream_ = io.StringIO(newline="")
    writer = csv.writer(stream_, delimiter=separator, lineterminator=end)
    for record in table.records:
        writer.writerow([spelled(cell, decimal) for cell in record])
    path.write_bytes(stream_.getvalue().encode(encoding))


def opened(path: Path, **keys: Any) -> Header:
    return read_header(path, layout=Layout.of(TableKeys(**keys), ("key '", "'"), "[[readings]]"), known=COLUMNS)


def assert_read(header: Header, table: Kept) -> None:
    frame = read_table(header, NUMBERS.__contains__, COLUMNS)
    assert [list(row) for row in frame.rows()] == table.rows
    pieces = list(stream(header, NUMBERS, ["id", "feature"], rows=7))
    assert [list(row) for piece in pieces for row in piece.numbers] == [row[1:4] for row in table.rows]


@pytest.mark.parametrize("seed", range(24))
def test_a_text_reads_back_equal(tmp_path: Path, seed: int) -> None:
    draw = random.Random(1000 + seed)
    encoding = draw.choice(list(WORDS))
    separator, decimal = draw.choice([(",", "."), (";", ","), ("\t", ","), (";", "."), ("|", ".")])
    table = kept(seed, WORDS[encoding])
    written(table, tmp_path / "t.csv", encoding, separator, decimal, draw.choice(["\n", "\r\n", "\r"]))
    header = opened(tmp_path / "t.csv", separator="tab" if separator == "\t" else separator, decimal=decimal)
    assert_read(header, table)
    assert [header.row_places.of(k + 1) for k in range(30)] == [f"line {line}" for line in table.lines]
    said = " ".join(header.remarks)
    for part in table.told:
        assert part.format("line ") in said, (part, said)
    assert (encoding == "utf-8") == ("read as" not in said)
    stated = opened(
        tmp_path / "t.csv", separator="tab" if separator == "\t" else separator, decimal=decimal, encoding=encoding
    )
    assert_read(stated, table)
    assert "read as" not in " ".join(stated.remarks)


@pytest.mark.parametrize("seed", range(12))
def test_a_sheet_reads_back_equal_and_names_its_cells(tmp_path: Path, seed: int) -> None:
    table = kept(seed)
    book = openpyxl.Workbook()
    book.active.title = "Messung"
    for k, record in enumerate(table.records, start=1):
        for column, cell in enumerate(record, start=1):
            if cell != "":
                book.active.cell(k, column, cell)
    book.save(tmp_path / "t.xlsx")
    header = opened(tmp_path / "t.xlsx")
    assert_read(header, table)
    assert [header.row_places.of(k + 1) for k in range(30)] == [f"Messung!A{line}" for line in table.lines]
    said = " ".join(header.remarks)
    for part in table.told:
        assert part.format("row ") in said
    bad = sorted(random.Random(seed).sample(range(30), 3))
    for k in bad:
        book.active.cell(table.lines[k], 3, "n/a")
    book.save(tmp_path / "t.xlsx")
    with pytest.raises(UlnaInputError) as caught:
        read_table(opened(tmp_path / "t.xlsx"), NUMBERS.__contains__, COLUMNS)
    assert re.findall(r"Messung!([A-Z]+\d+)", str(caught.value)) == [f"C{table.lines[k]}" for k in bad]


@pytest.mark.parametrize("seed", range(12))
def test_thousands_are_read_as_stated_and_never_guessed(tmp_path: Path, seed: int) -> None:
    draw = random.Random(seed)
    sign, decimal = draw.choice([(",", "."), (".", ","), ("'", "."), (" ", ","), ("\u00a0", ".")])
    values = [round(draw.uniform(-1, 1) * 10 ** draw.randint(1, 8), 2) for _ in range(40)]
    shown = [f"{value:,.2f}".replace(",", "T").replace(".", decimal).replace("T", sign) for value in values]
    written(Kept([], [["q1", "id"], *([text, "n"] for text in shown)]), tmp_path / "t.csv", "utf-8", ";", ".", "\n")
    thousands = " " if sign == "\u00a0" else sign
    header = opened(tmp_path / "t.csv", separator=";", decimal=decimal, thousands=thousands)
    assert read_table(header, "q1".__eq__, ["q1"])["q1"].to_list() == values
    with pytest.raises(UlnaInputError, match="thousands"):
        read_table(opened(tmp_path / "t.csv", separator=";", decimal=decimal), "q1".__eq__, ["q1"])
    (tmp_path / "t.csv").write_text(f"q1;id\n1{sign}23;n\n")
    with pytest.raises(UlnaInputError, match="expected a number"):
        read_table(opened(tmp_path / "t.csv", separator=";", decimal=decimal, thousands=thousands), "q1".__eq__, ["q1"])


def test_cells_that_repeat_the_one_above(tmp_path: Path) -> None:
    """Ditto marks and gaps where the key says so, merged cells where the workbook does; a name mapped after it."""
    above = ["links", "", '"', "rechts", "dito", "〃", "", "links"]
    meant = ["A", "A", "A", "B", "B", "B", "B", "A"]
    with (tmp_path / "t.csv").open("w", newline="") as stream_:
        csv.writer(stream_).writerows([["q1", "Ende"], *([k, cell] for k, cell in enumerate(above))])
    keys: dict[str, Any] = {"columns": {"feature": "Ende"}, "names": {"feature": {"A": "links", "B": ["rechts", "r"]}}}
    header = opened(tmp_path / "t.csv", fill_down=["feature"], **keys)
    assert read_table(header, "q1".__eq__)["feature"].to_list() == meant
    assert "column 'Ende': 5 cells filled from the one above" in " ".join(header.remarks)
    with pytest.raises(UlnaInputError, match=r"row 2 .*column 'Ende' .feature.: the cell is empty"):
        read_table(opened(tmp_path / "t.csv", **keys), "q1".__eq__)
    with pytest.raises(UlnaInputError, match=r"'fill_down': there is no column 'Ende2'.*Did you mean 'Ende'"):
        opened(tmp_path / "t.csv", fill_down=["Ende2"], **keys)
    book = openpyxl.Workbook()
    for k, (number, cell) in enumerate(zip(["q1", *range(8)], ["Ende", *above], strict=True), start=1):
        book.active.cell(k, 1, number)
        book.active.cell(k, 2, cell if cell in ("Ende", "links", "rechts") else None)
    for area in ("B2:B4", "B5:B8"):
        book.active.merge_cells(area)
    book.save(tmp_path / "t.xlsx")
    header = opened(tmp_path / "t.xlsx", **keys)
    assert read_table(header, "q1".__eq__)["feature"].to_list() == meant
    assert "merged cells counts for each of their rows: B2:B4, B5:B8" in " ".join(header.remarks)


def test_names_in_capitals_and_with_units_are_taken_and_told(tmp_path: Path) -> None:
    known = ["id", "q1", "q2", "p1", "feature"]
    for line, taken, units in (
        ("Q1,q2 [rad],P1", ["q1", "q2", "P1"], {"q2 [rad]": "rad"}),
        ("q1 (deg),Q2,p1 (deg)", ["q1", "q2", "p1"], {"q1 (deg)": "deg", "p1 (deg)": "deg"}),
        ("q1,q2,Q1", ["q1", "q2", "Q1"], {}),
        ("q1,q2,p1 [rad]", ["q1", "q2", "p1 [rad]"], {}),
    ):
        (tmp_path / "t.csv").write_text(f"{line}\n1.5,2.5,3.5\n")
        header = read_header(tmp_path / "t.csv", known=known)
        assert header.columns == taken
        assert header.units == units
        changed = [name for name, new in zip(line.split(","), taken, strict=True) if name != new]
        assert all(f"'{name}' as " in " ".join(header.remarks) for name in changed)
        assert bool(header.remarks) == bool(changed)
