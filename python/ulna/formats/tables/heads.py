"""Where the table begins in a file that people keep: below titles and remarks, with a row of units under its names.

Rows and columns are counted from 0 here; `lines` says where each row stands in the file. What is passed over is told.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ulna.formats.layout import Layout
from ulna.formats.spelling import looks_numeric
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded

Grid = list[list[Any]]

_ANGLES = ("rad", "deg", "°", "grad", "degree", "degrees", "count", "counts", "cnt", "inc", "pulses", "弧度", "度")
_LENGTHS = ("mm", "m", "in", "inch", "cm", "µm", "μm", "um", "毫米", "米")
_OTHERS = ("°c", "℃", "c", "k", "s", "ms", "-", "--", "–", "text", "name", "string", "")
UNITS = frozenset((*_ANGLES, *_LENGTHS, *_OTHERS))
"""What stands in a row of units."""
COMMENTS = ("#", "%", ";", "//", "!")
"""What programs begin a line with that is no reading."""
_LOOKED_AT = 2000
_SHOWN = 60


@dataclass
class Head:
    """What a table's beginning says."""

    row: int | None
    """Of the header in the grid; None where the file has none."""
    first: int
    """The first row below it that may be a reading."""
    names: list[str]
    """Of each column from the first on; "" where it has none."""
    units: list[str] = field(default_factory=list)
    """Of each column, where there is a row of them."""
    remarks: list[str] = field(default_factory=list)


def text_of(cell: Any) -> str:
    """A cell as a text, in one line."""
    if isinstance(cell, float) and cell.is_integer():
        cell = int(cell)
    return " ".join(str(cell).split())


def is_blank(cell: Any) -> bool:
    """Whether a cell holds nothing."""
    return isinstance(cell, str) and not cell.strip()


def is_number(cell: Any) -> bool:
    """Whether a cell holds a number, in anybody's spelling."""
    return looks_numeric(cell) if isinstance(cell, str) else type(cell) in (int, float)


def find_head(path: Path, grid: Grid, lines: Sequence[int], layout: Layout, place: Callable[[int], str]) -> Head:
    """The header of a table. place: how messages call a line of the file. Raises UlnaInputError for one that is not
    where it is said to be."""
    if layout.header is False:
        width = max(map(len, grid), default=0)
        return Head(None, 0, [f"c{k + 1}" for k in range(width)])
    if layout.header is not True:
        if layout.header not in lines or all(map(is_blank, grid[lines.index(layout.header)])):
            raise UlnaInputError(
                f"{layout.key('header')}: got {layout.header}, but {place(layout.header)} of {path} is blank or beyond "
                "its end; expected the row with the columns' names. Correct it."
            )
        return _below(grid, lines, layout, place, lines.index(layout.header), told=True)
    return _below(grid, lines, layout, place, _row_of_names(grid), told=False)


def _numbers(row: list[Any]) -> set[int]:
    return {k for k, cell in enumerate(row) if is_number(cell)}


def _filled(row: list[Any]) -> set[int]:
    return {k for k, cell in enumerate(row) if not is_blank(cell)}


def _row_of_names(grid: Grid) -> int:
    """The first row, where it names every column with numbers; else the last such row above the numbers."""
    top = next((k for k, row in enumerate(grid) if _filled(row)), 0)
    counts = [len(_numbers(row)) for row in grid[:_LOOKED_AT]]
    most = max(counts, default=0)
    data = next((k for k, count in enumerate(counts) if most and 2 * count >= most), None)
    if data is None or data <= top:
        return top
    columns = _numbers(grid[data])

    def names(k: int) -> bool:
        return not _numbers(_uncommented(grid[k])) and columns <= _filled(grid[k])

    if names(top):
        return top
    rows = [k for k in range(data - 1, top, -1) if _filled(grid[k])]
    for at, k in enumerate(rows):
        above = rows[at + 1] if at + 1 < len(rows) else None
        if names(k) and not (_is_units(grid[k], columns) and above is not None and names(above)):
            return k
    return top


def _is_units(row: list[Any], columns: set[int]) -> bool:
    """Whether a row says in which units the numbers below it are."""
    said = [text_of(row[k]).strip("[]()").casefold() for k in sorted(columns) if k < len(row) and not is_blank(row[k])]
    return bool(said) and all(each in UNITS for each in said)


def _uncommented(row: list[Any]) -> list[Any]:
    """A row without a comment sign before its first cell: `# q1,q2`, as NumPy writes headers."""
    if row and isinstance(row[0], str):
        return [row[0].lstrip().lstrip("#%").strip(), *row[1:]]
    return row


def _below(grid: Grid, lines: Sequence[int], layout: Layout, place: Callable[[int], str], row: int, told: bool) -> Head:
    bare = _uncommented(grid[row])
    commented = bool(grid[row]) and is_number(grid[row][0]) is False and text_of(grid[row][0])[:1] in ("#", "%")
    head = Head(row, row + 1, [text_of(cell) for cell in bare])
    above = [text_of(next(cell for cell in each if not is_blank(cell))) for each in grid[:row] if _filled(each)]
    if above and not told:
        shown = "; ".join(f"'{text[:_SHOWN]}'" for text in above[:3]) + ("; …" if len(above) > 3 else "")
        head.remarks.append(
            worded(
                "the columns are named in {line}; what stands above is not read: {text}.",
                line=place(lines[row]),
                text=shown,
            )
        )
    if commented:
        head.remarks.append(
            worded("{line} is read as the header, without the comment sign before it.", line=place(lines[row]))
        )
    after = next((k for k in range(row + 1, len(grid)) if _filled(grid[k])), None)
    if after is None or layout.units_row is False:
        return head
    data = next((k for k in range(after + 1, len(grid)) if _numbers(grid[k])), None)
    columns = _numbers(grid[data]) if data is not None else set()
    if layout.units_row or (not _numbers(grid[after]) and _is_units(grid[after], columns)):
        head.first = after + 1
        head.units = [text_of(cell).strip("[]()") for cell in grid[after]]
        if layout.units_row is None:
            shown = ", ".join(dict.fromkeys(unit for unit in head.units if unit))
            head.remarks.append(
                worded("{line} holds units ({units}), and no reading.", line=place(lines[after]), units=shown[:_SHOWN])
            )
    return head
