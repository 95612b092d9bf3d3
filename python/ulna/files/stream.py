"""Reading tables of any size piece by piece, in bounded memory whatever the file's layout.

PyArrow and not Polars: Polars takes a Parquet row group whole, so that a file of 10⁷ rows written as one group costs
680 MB; PyArrow reads page by page and stays near 120 MB (measured with Polars 2.1, PyArrow 26).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import polars as pl
import pyarrow as pa
import pyarrow.compute
import pyarrow.csv
import pyarrow.parquet
from numpy.typing import NDArray

from ulna.errors import UlnaInputError
from ulna.files.cells import WHAT, Header, bad_cell, name_bad_cell
from ulna.files.table import iter_tables

_CSV_BLOCK_BYTES = 1 << 20
_PAGE_BUFFER_BYTES = 1 << 20


@dataclass(frozen=True)
class Piece:
    """Some consecutive data rows of a table."""

    before: int
    """Number of data rows before the first of these."""
    numbers: NDArray[np.float64]
    """(N, k), finite, C order."""
    texts: dict[str, pl.Series]
    """(N,) each, no empty cell."""

    def __len__(self) -> int:
        return len(self.numbers)


def count_rows(header: Header) -> int:
    """Data rows of a Parquet file, 0 for a CSV file, where nobody knows without reading it."""
    return 0 if header.is_csv else int(pyarrow.parquet.read_metadata(header.path).num_rows)


def stream(header: Header, numbers: Sequence[str], texts: Sequence[str], rows: int = 1 << 16) -> Iterator[Piece]:
    """The named columns in pieces of about `rows` rows. Raises UlnaInputError naming the first bad cell."""
    before = 0
    try:
        for batch in (
            _csv_batches(header, numbers, texts)
            if header.is_csv
            else _parquet_batches(header, [*numbers, *texts], rows)
        ):
            if batch.num_rows:
                yield _piece(header, batch, numbers, texts, before)
                before += batch.num_rows
    except (pa.ArrowException, OSError) as error:
        if not header.is_csv:
            first_line = (str(error) or type(error).__name__).splitlines()[0]
            raise UlnaInputError(f"{header.path}: cannot be read ({first_line}); expected {WHAT}.") from None
        _name_bad_cell(header, numbers)
        yield from _forgiving(header, numbers, texts, before)


def _parquet_batches(header: Header, columns: list[str], rows: int) -> Iterator[Any]:
    with pyarrow.parquet.ParquetFile(header.path, pre_buffer=False, buffer_size=_PAGE_BUFFER_BYTES) as file:
        yield from file.iter_batches(rows, columns=columns)


def _csv_batches(header: Header, numbers: Sequence[str], texts: Sequence[str]) -> Iterator[Any]:
    types = {name: pa.float64() for name in numbers} | {name: pa.string() for name in texts}
    with pyarrow.csv.open_csv(
        header.path,
        read_options=pyarrow.csv.ReadOptions(block_size=_CSV_BLOCK_BYTES, skip_rows=1, column_names=header.columns),
        parse_options=pyarrow.csv.ParseOptions(ignore_empty_lines=False),
        convert_options=pyarrow.csv.ConvertOptions(
            column_types={name: types.get(name, pa.string()) for name in header.columns},
            include_columns=[*numbers, *texts],
            null_values=[],
            strings_can_be_null=False,
        ),
    ) as reader:
        yield from reader


def _piece(header: Header, batch: Any, numbers: Sequence[str], texts: Sequence[str], before: int) -> Piece:
    values = np.empty((batch.num_rows, len(numbers)))
    for k, name in enumerate(numbers):
        column = batch.column(name)
        if not (pa.types.is_floating(column.type) or pa.types.is_integer(column.type)):
            raise UlnaInputError(
                f"{header.path}: {header.where(before + 1)}, column '{name}': got {column[0].as_py()!r} "
                f"({column.type}), expected a number. Write the column as floating-point numbers."
            )
        if column.type != pa.float64():
            column = pyarrow.compute.cast(column, pa.float64(), safe=False)
        values[:, k] = column.to_numpy(zero_copy_only=False)  # a gap becomes NaN
    strings = {name: pl.Series(name, batch.column(name).cast(pa.string())) for name in texts}
    piece = Piece(before, values, strings)
    _refuse_bad_cells(header, piece, numbers)
    return piece


def _refuse_bad_cells(header: Header, piece: Piece, numbers: Sequence[str]) -> None:
    bad = [(int(np.argmin(finite)), k) for k, finite in enumerate(np.isfinite(piece.numbers).T) if not finite.all()]
    empty = [
        (int((column.is_null() | (column == "")).arg_true()[0]), len(numbers) + k)
        for k, column in enumerate(piece.texts.values())
        if column.null_count() or (column == "").any()
    ]
    if not bad and not empty:
        return
    if header.is_csv:
        _name_bad_cell(header, numbers)  # it knows how the cell was written
    row, k = min(bad + empty)
    name = [*numbers, *piece.texts][k]
    cell = str(piece.numbers[row, k]) if k < len(numbers) else ""
    cell = "" if cell == "nan" else cell
    raise UlnaInputError(bad_cell(header, piece.before + row + 1, name, cell, lambda column: column in numbers))


def _name_bad_cell(header: Header, numbers: Sequence[str]) -> None:
    name_bad_cell(header, lambda column: column in numbers)


def _forgiving(header: Header, numbers: Sequence[str], texts: Sequence[str], skip: int) -> Iterator[Piece]:
    """Every cell is fine, only written in a way that PyArrow refuses (blank lines at the end, spaces around numbers):
    Polars reads the rest."""
    before = 0
    for frame in iter_tables(header, lambda column: column in numbers):
        rest = frame.slice(max(0, skip - before))
        if len(rest):
            first = before + len(frame) - len(rest)
            values = np.ascontiguousarray(rest.select(numbers).to_numpy(), dtype=np.float64)
            yield Piece(first, values, {name: rest[name] for name in texts})
        before += len(frame)
