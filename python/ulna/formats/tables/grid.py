"""A table that lies in memory as rows of cells, with the place of each row in its file: sheets, and texts as people
keep them.

Blank rows, comments and a last line of words are passed over and told; cells that repeat the one above are filled where
the study says so.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ulna.formats.header import Header
from ulna.formats.layout import Layout
from ulna.formats.tables.heads import COMMENTS, Grid, Head, find_head, is_blank, is_number, text_of
from ulna.ground.errors import UlnaInputError, nearest
from ulna.ground.worded import worded

DITTO = ('"', "''", "〃", "״", '-"-', "dito", "ditto", "do.", "″", "”", "“", "同上")
"""What means "as above" in a cell."""
_SHOWN = 8


@dataclass(frozen=True)
class GridTable(Header):
    """A table in memory."""

    lines: Sequence[int]
    """(rows,) where each data row stands in the file, from 1."""
    grid: Grid = field(repr=False)
    """Cells of each data row, from the first column on; "" where empty. Rows may be short."""
    places: list[int] = field(repr=False)
    """Where each column stands in `grid`: columns that are all blank are passed over."""
    header_line: int | None
    """Where the columns' names stand; None where the file has none."""

    @property
    def rows(self) -> int:
        return len(self.grid)

    def value(self, row: int, column: str) -> Any:
        """The cell of a data row, "" where it is empty."""
        k = self.places[self.columns.index(column)]
        cells = self.grid[row - 1]
        return cells[k] if k < len(cells) else ""

    def values(self, column: str) -> list[Any]:
        """The same of all rows."""
        k = self.places[self.columns.index(column)]
        return [row[k] if k < len(row) else "" for row in self.grid]


@dataclass
class Laid:
    """What a grid holds: columns, readings, and what is said of the rest."""

    names: list[str]
    places: list[int]
    grid: Grid
    lines: list[int]
    header_line: int | None
    units: dict[str, str]
    remarks: list[str]


def lay_out(
    path: Path,
    grid: Grid,
    lines: list[int],
    layout: Layout,
    line_name: Callable[[int], str],
    cell_name: Callable[[int, int], str],
    ragged: bool = True,
) -> Laid:
    """Header, columns and readings of a grid.

    line_name: how messages call a line of the file; cell_name: a cell, by its line and its column from 0.
    ragged: whether cells may stand beyond the last name, where nobody uses them. Raises
    UlnaInputError for columns of numbers without a name, and keys that name nothing.
    """
    remarks: list[str] = []
    if layout.comment is not None:
        kept = [k for k, row in enumerate(grid) if not (row and text_of(row[0]).startswith(layout.comment))]
        grid, lines = [grid[k] for k in kept], [lines[k] for k in kept]
    head = find_head(path, grid, lines, layout, line_name)
    remarks += head.remarks
    signs = _comment_signs(grid, head)
    used: list[int] = []
    blank: list[int] = []
    comments: list[int] = []
    for k in range(head.first, len(grid)):
        filled = [cell for cell in grid[k] if not is_blank(cell)]
        if not filled:
            blank.append(lines[k])
        elif signs and isinstance(filled[0], str) and filled[0].startswith(signs) and not is_number(filled[0]):
            comments.append(lines[k])
        else:
            used.append(k)
    last = _words_at_the_end(grid, used)
    for k in last:
        said = {"line": line_name(lines[k]), "text": _only(grid[k])[:60]}
        remarks.append(worded("{line} is no reading and not read: '{text}'.", **said))
    used = used[: len(used) - len(last)]
    blank = [line for line in blank if used and line < lines[used[-1]]]
    if blank:
        remarks.append(worded("blank rows are passed over: {lines}.", lines=_named(blank, line_name)))
    if comments:
        remarks.append(
            worded("comments among the readings are passed over: {lines}.", lines=_named(comments, line_name))
        )
    data, places = [grid[k] for k in used], [lines[k] for k in used]
    names, columns = _columns(path, data, places, head, cell_name, remarks, ragged)
    laid = Laid(
        names,
        columns,
        data,
        places,
        None if head.row is None else lines[head.row],
        {name: head.units[k] for name, k in zip(names, columns, strict=True) if k < len(head.units) and head.units[k]},
        remarks,
    )
    _fill_down(path, laid, layout)
    return laid


def _comment_signs(grid: Grid, head: Head) -> tuple[str, ...]:
    """Signs with which rows of the beginning are comments, header included."""
    top = [] if head.row is None else [text_of(row[0]) for row in grid[: head.row + 1] if row]
    return tuple(sign for sign in COMMENTS if any(text.startswith(sign) for text in top))


def _only(row: list[Any]) -> str:
    return next(text_of(cell) for cell in row if not is_blank(cell))


def _words_at_the_end(grid: Grid, kept: list[int]) -> list[int]:
    """Rows at the end with a single cell of words, where readings have several: "End of file", a signature."""
    width = max((sum(not is_blank(cell) for cell in grid[k]) for k in kept[:100]), default=0)
    found: list[int] = []
    while width > 2 and len(found) < len(kept):
        filled = [cell for cell in grid[kept[-1 - len(found)]] if not is_blank(cell)]
        if len(filled) != 1 or not isinstance(filled[0], str) or any(map(str.isdigit, filled[0])):
            break
        found.insert(0, kept[-1 - len(found)])
    return found


def _named(lines: Sequence[int], line_name: Callable[[int], str]) -> str:
    shown = ", ".join(line_name(line) for line in lines[:_SHOWN])
    return shown + (f", … ({len(lines)} in all)" if len(lines) > _SHOWN else "")


def _columns(
    path: Path,
    data: Grid,
    lines: list[int],
    head: Head,
    cell_name: Callable[[int, int], str],
    remarks: list[str],
    ragged: bool,
) -> tuple[list[str], list[int]]:
    """Names and places of the columns that hold anything. Raises UlnaInputError for numbers without a name."""
    width = len(head.names) if head.row is not None else max(map(len, data[:1]), default=0)
    width = max([width, *map(len, data)]) if ragged else width
    names = [*head.names, *[""] * (width - len(head.names))][:width]
    places = []
    for k, name in enumerate(names):
        at = next((row for row, cells in enumerate(data) if k < len(cells) and not is_blank(cells[k])), None)
        if at is None and (not name or head.row is None):
            continue
        if name or at is None:
            places.append(k)
            continue
        where = cell_name(lines[at], k)
        if any(k < len(cells) and is_number(cells[k]) for cells in data):
            raise UlnaInputError(
                f"{path}: {where}: got '{str(data[at][k])[:40]}' in a column without a name; expected a name in the "
                "header for every column of numbers. Name the column, clear the cell, or say with the key 'header' in "
                "which row the names are."
            )
        remarks.append(
            worded(
                "the column of {cell} has no name; what stands in it is not read: '{text}'.",
                cell=where,
                text=text_of(data[at][k])[:40],
            )
        )
    return [names[k] for k in places], places


def _fill_down(path: Path, laid: Laid, layout: Layout) -> None:
    """Cells of the columns that the key names, from the one above. Raises UlnaInputError for a name of nothing."""
    for column in layout.fill_down:
        name = layout.columns.get(column, column)
        if name not in laid.names:
            raise UlnaInputError(
                f"{layout.key('fill_down')}: there is no column '{name}' in {path}.{nearest(name, laid.names)} "
                "Correct it."
            )
        k, above, count = laid.places[laid.names.index(name)], "", 0
        for row in laid.grid:
            cell = row[k] if k < len(row) else ""
            if not is_blank(cell) and not (isinstance(cell, str) and cell.strip().casefold() in DITTO):
                above = cell
            elif not is_blank(above):
                row += [""] * (k + 1 - len(row))
                row[k] = above
                count += 1
        laid.remarks.append(
            f"column '{name}': {count} cell{'s' * (count != 1)} filled from the one above "
            f"({layout.key('fill_down').rpartition(': ')[2]})."
        )
