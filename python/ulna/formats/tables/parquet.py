"""Parquet tables: Polars reads the columns, PyArrow the pieces of long files."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NoReturn

import polars as pl
import polars.exceptions

from ulna.formats.cells import bad_cell, first_of, labels_of, no_numbers
from ulna.formats.header import Header, Numeric, Piece
from ulna.formats.layout import Layout
from ulna.formats.unpacked import NUMBER_BYTES, TEXT_BYTES, check_unpacked
from ulna.ground.errors import UlnaInputError
from ulna.ground.extras import installed

_PAGE_BUFFER_BYTES = 1 << 20
UNREADABLE = (polars.exceptions.PolarsError, polars.exceptions.PanicException, OSError)
"""What Polars says of a damaged file, or of a type that it does not know."""
# else Polars ends, and says so on stderr, at a column of a zone that is nowhere, which nobody may have asked for
os.environ.setdefault("POLARS_IGNORE_TIMEZONE_PARSE_ERROR", "1")


@dataclass(frozen=True)
class ParquetTable(Header):
    """A table of typed columns."""

    @property
    def rows(self) -> int:
        return int(pl.scan_parquet(self.path.absolute()).select(pl.len()).collect().item())

    def _check_size(self, numbers: int, texts: int) -> None:
        """A thousand million equal values take some bytes of a file. Raises UlnaInputError."""
        try:
            rows = self.rows
        except UNREADABLE as error:
            self._unreadable(error)
        check_unpacked(self.path, rows * (numbers * NUMBER_BYTES + texts * TEXT_BYTES), f"its {rows} rows")

    def cells(self, numeric: Numeric, columns: Sequence[str]) -> pl.DataFrame:
        count = sum(map(numeric, columns))
        self._check_size(count, len(columns) - count)
        try:
            stored = pl.read_parquet(self.path.absolute(), columns=[self.own(name) for name in columns])
        except UNREADABLE as error:
            self._unreadable(error)
        found = []
        for name in columns:
            column = stored[self.own(name)].rename(name)
            if numeric(name) and not column.dtype.is_numeric():
                raise UlnaInputError(no_numbers(self, 1, name, first_of(column), str(column.dtype)))
            found.append(column.cast(pl.Float64) if numeric(name) else labels_of(self, name, column))
        return pl.DataFrame(found)

    def refusal(self, row: int, column: str, numeric: Numeric) -> str:
        value = pl.scan_parquet(self.path.absolute()).select(self.own(column)).slice(row - 1, 1).collect().item()
        return bad_cell(self, row, column, "" if value is None else str(value), numeric)

    def pieces(self, numbers: Sequence[str], texts: Sequence[str], rows: int) -> Iterator[Piece]:
        if not installed("pyarrow"):  # then all rows at once, as much memory as that takes
            yield from super().pieces(numbers, texts, rows)
            return
        import pyarrow as pa  # only for long files: it takes as long to load as a study of a hundred rows
        import pyarrow.parquet

        from ulna.formats.tables.arrow import array_piece

        self._check_size(len(numbers), len(texts))
        columns = [*numbers, *texts]
        before = 0
        try:
            with pyarrow.parquet.ParquetFile(self.path, pre_buffer=False, buffer_size=_PAGE_BUFFER_BYTES) as file:
                for batch in file.iter_batches(rows, columns=[self.own(name) for name in columns]):
                    stored = pa.table({name: batch.column(self.own(name)) for name in columns})
                    if stored.num_rows:
                        yield array_piece(self, stored, numbers, texts, before)
                        before += stored.num_rows
        except (pa.ArrowException, OSError) as error:
            self._unreadable(error)

    def _unreadable(self, error: BaseException) -> NoReturn:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise UlnaInputError(f"{self.path}: cannot be read ({reason}); expected {self.what}.") from None


def open_parquet(path: Path, start: bytes, what: str, layout: Layout) -> ParquetTable:
    """Raises UlnaInputError for a damaged file."""
    try:
        return ParquetTable(path, list(pl.read_parquet_schema(path.absolute())), what=what)
    except UNREADABLE as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise UlnaInputError(f"{path}: not a readable Parquet file ({reason}); expected {what}.") from None
