"""CSV and its dialects: fast where all is well, exact about the cell where it is not.

Polars reads the columns, PyArrow the pieces of long files (where it is not installed Polars, after a look at every
cell). Only when they refuse a file, or leave a gap or a number
that is none, is the file gone through again cell by cell to find the first bad one.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import Any, NoReturn

import polars as pl
import polars.exceptions

from ulna.formats.cells import number_of, text_cell, wrong_count
from ulna.formats.header import MOST_CELLS, Header, Numeric, Piece, refused
from ulna.formats.layout import AS_EXPECTED, Layout
from ulna.formats.places import Places
from ulna.formats.spelling import usable
from ulna.formats.tables.lines import LineTable, open_lines, untidy
from ulna.ground.errors import UlnaInputError
from ulna.ground.extras import installed

_BLOCK_BYTES = 1 << 20
_NAMES = {";": "semicolons", "\t": "tabs"}


@dataclass(frozen=True)
class TextTable(Header):
    """A table of lines."""

    lines: int = 1
    """Lines of the header; 0 where the file has none."""
    separator: str = ","
    decimal: str = "."
    layout: Layout = AS_EXPECTED

    @property
    def head(self) -> str:
        return "line 1"

    def where(self, row: int) -> str:
        return f"row {row} (line {row + self.lines} of the file)"

    @property
    def row_places(self) -> Places:
        return Places("line {}", self.lines)

    def counted(self) -> int | None:
        filled = ~pl.all_horizontal(pl.all().is_null())  # blank lines end the file
        try:
            return int(self._scan({}).filter(filled).select(pl.len()).collect().item())
        except polars.exceptions.PolarsError:
            return None

    # ------------------------------------------------------------ all rows at once

    def frame(self, numeric: Numeric, columns: Sequence[str], blank: Sequence[str] = ()) -> pl.DataFrame:
        if self.decimal == ",":  # Polars would also take a decimal point, or one between thousands
            return super().frame(numeric, columns, blank)
        filled = [column for column in columns if column not in blank]
        try:
            frame = self._scan({c: pl.Float64 for c in columns if numeric(c)}).collect()
            if frame[self.columns[-1]].null_count():  # an empty cell, a short row or a blank line
                frame = frame.head(self._walk(numeric, filled))
            return self.checked(frame.select(columns), numeric, blank=blank)
        except polars.exceptions.PolarsError:
            self._walk(numeric, filled)
            return super().frame(
                numeric, columns, blank
            )  # every cell is fine, only written in a way that Polars refuses

    def cells(self, numeric: Numeric, columns: Sequence[str]) -> pl.DataFrame:
        try:
            frame = self._scan({}).collect()
        except polars.exceptions.PolarsError as error:
            self._walk(numeric, ())
            self._unreadable(error)
        if frame[self.columns[-1]].null_count():
            frame = frame.head(self._walk(numeric, ()))
        return self._converted(frame.select(columns), numeric)

    def _scan(self, types: dict[str, type[pl.Float64]]) -> pl.LazyFrame:
        # All columns: where some are left out Polars does not count the cells of a row. The names come from our own
        # reading of the header, which forgives spaces and a byte-order mark.
        return pl.scan_csv(
            self.path.absolute(),
            has_header=False,
            skip_rows=self.lines,
            schema={name: types.get(name, pl.String) for name in self.columns},
            glob=False,
            separator=self.separator,
        )

    def _converted(self, text: pl.DataFrame, numeric: Numeric) -> pl.DataFrame:
        return text.with_columns(self.numbers(column) for column in text if numeric(column.name))

    def numbers(self, texts: pl.Series) -> pl.Series:
        texts = texts.str.strip_chars()
        if self.decimal == ",":
            pointed = texts.str.contains(".", literal=True).fill_null(False)
            texts = texts.set(pointed, None).str.replace(",", ".", literal=True)
        texts = texts.str.replace("\u2212", "-", literal=True).str.replace(r"([0-9.])[dD]([+-]?[0-9]+)$", "${1}e$2")
        return texts.cast(pl.Float64, strict=False)

    # ------------------------------------------------------------ piece by piece

    def pieces(self, numbers: Sequence[str], texts: Sequence[str], rows: int) -> Iterator[Piece]:
        if not installed("pyarrow"):
            self._walk(lambda column: column in numbers, [*numbers, *texts])
            yield from self._forgiving(numbers, texts, 0, rows)
            return
        import pyarrow as pa  # only for long files: it takes as long to load as a study of a hundred rows

        from ulna.formats.tables.arrow import array_piece

        before = 0
        try:
            for batch in self._batches(numbers, texts):
                if batch.num_rows:
                    yield array_piece(self, batch, numbers, texts, before)
                    before += batch.num_rows
        except pa.ArrowException:
            self._walk(lambda column: column in numbers, [*numbers, *texts])
            yield from self._forgiving(numbers, texts, before, rows)

    def _batches(self, numbers: Sequence[str], texts: Sequence[str]) -> Iterator[Any]:
        import pyarrow as pa
        import pyarrow.csv

        types = dict.fromkeys(numbers, pa.float64())
        with pyarrow.csv.open_csv(
            self.path,
            read_options=pyarrow.csv.ReadOptions(
                block_size=_BLOCK_BYTES, skip_rows=self.lines, column_names=self.columns
            ),
            parse_options=pyarrow.csv.ParseOptions(delimiter=self.separator, ignore_empty_lines=False),
            convert_options=pyarrow.csv.ConvertOptions(
                column_types={name: types.get(name, pa.string()) for name in self.columns},
                include_columns=[*numbers, *texts],
                null_values=[],
                strings_can_be_null=False,
                decimal_point=self.decimal,
            ),
        ) as reader:
            yield from reader

    def _forgiving(self, numbers: Sequence[str], texts: Sequence[str], skip: int, rows: int) -> Iterator[Piece]:
        """Every cell is fine, only written in a way that PyArrow refuses (blank lines at the end, spaces around
        numbers): the rows after the first `skip`, read as texts."""
        columns = [*numbers, *texts]
        before = 0
        try:
            for frame in self._scan({}).collect_batches(chunk_size=rows, maintain_order=True):
                rest = frame.slice(max(0, skip - before))
                first = before + len(frame) - len(rest)
                before += len(frame)
                filled = rest.filter(~pl.all_horizontal(pl.all().is_null()))  # blank lines, which end the file
                if len(filled):
                    converted = self._converted(filled.select(columns), lambda column: column in numbers)
                    checked = self.checked(converted, lambda column: column in numbers, before=first)
                    yield self.piece(checked, numbers, texts, first)
        except polars.exceptions.PolarsError as error:
            self._unreadable(error)

    # ------------------------------------------------------------ cell by cell

    def refusal(self, row: int, column: str, numeric: Numeric) -> str:
        with self.path.open(encoding="utf-8-sig", newline="") as stream:
            try:
                cells = next(islice(csv.reader(stream, delimiter=self.separator), row + self.lines - 1, None))
            except csv.Error:
                return (
                    f"{self.path}: {self.where(row)}: a cell has more than {csv.field_size_limit()} signs; expected "
                    f"{self.what}. Correct it."
                )
        return self._refusal(row, column, cells[self.columns.index(column)], numeric)

    def _refusal(self, row: int, column: str, cell: str, numeric: Numeric) -> str:
        return text_cell(self, row, column, cell, numeric, self.layout, not self.lines and row == 1)

    def _walk(self, numeric: Numeric, columns: Sequence[str]) -> int:
        """Go through the file cell by cell; the number of data rows, blank lines at the end not counted. Raises
        UlnaInputError for lines that are no row, and bad cells of `columns`."""
        checked = [(k, name, numeric(name)) for k, name in enumerate(self.columns) if name in columns]
        row, last, count = 0, 0, 0
        told: list[str] = []
        try:
            with self.path.open(encoding="utf-8-sig", newline="") as stream:
                reader = csv.reader(stream, delimiter=self.separator)
                for row, cells in enumerate(islice(reader, self.lines, None), start=1):
                    if not cells:
                        continue
                    found: list[str] = []
                    if last != row - 1:
                        found.append(
                            f"{self.path}: {self.where(last + 1)} is blank; expected a reading. Remove the line."
                        )
                    last = row
                    if len(cells) != len(self.columns):
                        found.append(wrong_count(self, row, cells, len(self.columns), self.separator, bool(self.lines)))
                    else:
                        bad = [
                            (name, cells[k])
                            for k, name, is_number in checked
                            if _is_bad(cells[k], number_of(cells[k], self.decimal) if is_number else 0.0)
                        ]
                        count += len(bad)
                        bad = bad[: MOST_CELLS - len(told)]
                        told += [self._refusal(row, name, cell, numeric) for name, cell in bad]
                    count += len(found)
                    told += found[: MOST_CELLS - len(told)]
        except UnicodeDecodeError as error:
            raise UlnaInputError(
                f"{self.path}: the file is not UTF-8 text (byte 0x{error.object[error.start]:02x}); expected "
                f"{self.what}. Save it as UTF-8."
            ) from None
        except csv.Error as error:
            # A cell of 131072 characters is what follows a quotation mark that nobody closes.
            what = "a quotation mark is not closed" if "field limit" in str(error) else str(error)
            raise UlnaInputError(
                f"{self.path}: {self.where(row + 1)}: {what}; expected {self.what}. Correct it."
            ) from None
        if told:
            raise refused(self, told, count)
        return last

    def _unreadable(self, error: Exception) -> NoReturn:
        """What Polars does not take, though every cell can be told apart: quotation marks within cells."""
        row, line = 0, ""
        with self.path.open(encoding="utf-8-sig", newline="") as stream:
            reader = csv.reader(stream, delimiter=self.separator, strict=True)
            try:
                for cells in islice(reader, self.lines, None):
                    row += 1
                    line = self.separator.join(cells)
            except csv.Error:
                raise UlnaInputError(
                    f"{self.path}: {self.where(row + 1)}: a quotation mark is closed before the end of its cell; "
                    f'expected quotation marks around whole cells, and "" for one within. Remove or double it.'
                ) from None
        raise UlnaInputError(
            f"{self.path}: its cells cannot be told apart, up to '{line[:40]}'; expected {self.what}. Save it again "
            "with another program."
        ) from error


def _is_bad(cell: str, value: float | None) -> bool:
    return not usable(value) or not cell.strip()


def open_text(path: Path, start: bytes, what: str, layout: Layout) -> Header:
    """A CSV file by its first bytes. Raises UlnaInputError for what is no text, or not written as the layout says."""
    if untidy(path, start, layout):
        return _looked_at(open_lines(path, what, layout))
    line = start.split(b"\n", 1)[0].decode("utf-8-sig").rstrip("\r")
    separator = layout.separator or ","
    check_separator(path, line, separator, layout)
    names = [name.strip() for name in next(csv.reader([line], delimiter=separator), [""])]
    if not layout.header:
        names = [f"c{k}" for k in range(1, len(names) + 1)]
    return TextTable(
        path,
        names,
        what=what,
        lines=int(layout.header),
        separator=separator,
        decimal=layout.decimal or ".",
        layout=layout,
    )


def _looked_at(table: LineTable) -> LineTable:
    """The same. Raises UlnaInputError where its header shows another separator than it was read with."""
    if len(table.columns) == 1 and table.header_line:
        check_separator(table.path, table.columns[0], table.separator, table.layout, table.head)
    return table


def check_separator(path: Path, line: str, separator: str, layout: Layout, at: str = "line 1") -> None:
    """Another separator in the first line, and none of the expected ones, is told with the key that would say so."""
    if separator in line:
        return
    if separator != ",":
        there = next((words for other, words in {",": "commas", **_NAMES}.items() if other in line), None)
        raise UlnaInputError(
            f"{layout.key('separator')}: got {separator!r}, but {at} of {path} has none"
            f"{f', it has {there}' if there else ''}; expected the sign between its columns. Correct it."
        )
    for other, words in _NAMES.items():
        if other in line:
            decimal = layout.say("decimal", ",").removesuffix(f" in {layout.table}")
            comma = f" (and {decimal} where numbers have decimal commas)" if other == ";" else ""
            key = layout.say("separator", "tab" if other == "\t" else other)
            raise UlnaInputError(
                f"{path}: {at}: the columns are separated by {words}; expected commas, and numbers with a decimal "
                f"point. Say {key}{comma}, or export the table again with commas between columns and points in numbers."
            )
