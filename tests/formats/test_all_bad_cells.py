"""All cells that cannot be used are told in one message, whatever the format, and how many there are."""

from __future__ import annotations

import random
import re
from pathlib import Path

import openpyxl
import pytest

from ulna.formats.header import MOST_CELLS
from ulna.formats.table import read_header, read_table, stream
from ulna.ground.errors import UlnaInputError

NUMBERS = ("q1", "q2")


def spoilt(seed: int, bad: int) -> tuple[list[list[str]], set[tuple[int, str]]]:
    """Forty rows, and the cells (row, column) in which no number stands."""
    draw = random.Random(seed)
    rows = [[f"{draw.uniform(-3, 3):.6f}", f"{draw.uniform(-3, 3):.6f}", f"n{k}"] for k in range(40)]
    cells = draw.sample([(row, k) for row in range(40) for k in range(2)], bad)
    for row, k in cells:
        rows[row][k] = draw.choice(["n/a", "--", "1.2.3"])
    return rows, {(row + 1, NUMBERS[k]) for row, k in cells}


def said(message: str) -> set[tuple[int, str]]:
    return {(int(row), name) for row, name in re.findall(r"row (\d+) \([^)]*\), column '(q\d)'", message)}


def message(path: Path, piecewise: bool) -> str:
    header = read_header(path)

    def read() -> object:
        return list(stream(header, NUMBERS, ["id"])) if piecewise else read_table(header, NUMBERS.__contains__)

    with pytest.raises(UlnaInputError) as caught:
        read()
    return str(caught.value)


@pytest.mark.parametrize("bad", [1, 2, 7, MOST_CELLS, MOST_CELLS + 1, 60])
@pytest.mark.parametrize("piecewise", [False, True])
def test_every_bad_cell_of_a_text_and_of_a_sheet(tmp_path: Path, bad: int, piecewise: bool) -> None:
    rows, cells = spoilt(bad, bad)
    (tmp_path / "t.csv").write_text("\n".join([",".join(row) for row in [[*NUMBERS, "id"], *rows]]))
    book = openpyxl.Workbook()
    book.active.append([*NUMBERS, "id"])
    for row in rows:
        book.active.append([float(cell) if re.fullmatch(r"-?\d\.\d{6}", cell) else cell for cell in row])
    book.save(tmp_path / "t.xlsx")
    for name in ("t.csv", "t.xlsx"):
        told = message(tmp_path / name, piecewise)
        assert "\n" not in told
        assert said(told) == set(sorted(cells)[:MOST_CELLS])
        assert (f"There are {bad} such places" in told) == (bad > 1)
        assert (f"and {bad - MOST_CELLS} more" in told) == (bad > MOST_CELLS)
        assert told.count(str(tmp_path)) == 1
