"""Batches of PyArrow, of CSV and Parquet alike, as checked pieces.

PyArrow and not Polars: Polars takes a Parquet row group whole, so that a file of 10⁷ rows written as one group costs
680 MB; PyArrow reads page by page and stays near 120 MB (measured with Polars 2.1, PyArrow 26).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import polars as pl
import pyarrow as pa
import pyarrow.compute

from ulna.formats.cells import labels_of, no_numbers
from ulna.formats.header import Header, Piece
from ulna.ground.errors import UlnaInputError


def array_piece(header: Header, batch: Any, numbers: Sequence[str], texts: Sequence[str], before: int) -> Piece:
    """One batch whose columns are called as in the header. Raises UlnaInputError naming the first bad cell."""
    columns = []
    for name in numbers:
        column = batch.column(name)
        if not (pa.types.is_floating(column.type) or pa.types.is_integer(column.type)):
            raise UlnaInputError(no_numbers(header, before + 1, name, _first(column), str(column.type)))
        if column.type != pa.float64():
            column = pyarrow.compute.cast(column, pa.float64(), safe=False)
        columns.append(pl.Series(name, column))
    columns += [labels_of(header, name, _series(header, name, batch)) for name in texts]
    frame = header.checked(pl.DataFrame(columns), lambda column: column in numbers, before=before)
    return header.piece(frame, numbers, texts, before)


def _first(column: Any) -> Any:
    """Its first value, or that there is none that Python knows."""
    try:
        return column[0].as_py()
    except (ValueError, OverflowError, KeyError, pa.ArrowException):  # KeyError: of a time zone that nobody knows
        return "a value beyond its type"


def _series(header: Header, name: str, batch: Any) -> pl.Series:
    try:
        if _wide(batch.column(name).type):
            raise ValueError
        return pl.Series(name, batch.column(name))
    except (pl.exceptions.PolarsError, pl.exceptions.PanicException, pa.ArrowException, ValueError, TypeError):
        raise UlnaInputError(
            f"{header.path}: {header.named(name)} is of type {batch.column(name).type}; expected texts or whole "
            "numbers as labels. Write it as texts."
        ) from None


def _wide(kind: Any) -> bool:
    """Whether there are numbers of 256 bits in it, at which Polars prints the whole of its stack."""
    if pa.types.is_dictionary(kind):
        return _wide(kind.value_type)
    return pa.types.is_decimal256(kind) or any(_wide(kind.field(k).type) for k in range(kind.num_fields))
