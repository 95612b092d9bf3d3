"""Reading tables, CSV or Parquet, as columns: fast where all is well, exact about the cell where it is not.

Polars reads the columns. Only when it refuses a file, or leaves a gap or a number that is none, is the file gone
through again cell by cell (cells.py) to find the first bad one.
"""

from __future__ import annotations

import csv
import hashlib
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import polars as pl
import polars.exceptions

from ulna.errors import UlnaInputError
from ulna.files.cells import WHAT, Header, Numeric, bad_cell, name_bad_cell, number_of
from ulna.files.toml import read_bytes


def file_sha256(path: Path) -> str:
    """Hexadecimal SHA-256 of a file of any size."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def read_header(path: Path, what: str = WHAT) -> Header:
    """Which columns a table has. Raises UlnaInputError for a file that is none."""
    start = read_bytes(path, what, limit=1 << 16)
    if not start.strip():
        raise UlnaInputError(f"{path}: the file is empty; expected {what}.")
    if start.startswith(b"PAR1"):
        try:
            columns = pl.read_parquet_schema(path)
        except (polars.exceptions.PolarsError, OSError) as error:
            raise UlnaInputError(
                f"{path}: not a readable Parquet file ({_first_line(error)}); expected {what}."
            ) from None
        return _checked(Header(path, list(columns), is_csv=False))
    if start.startswith(b"PK\x03\x04"):
        raise UlnaInputError(f"{path}: this looks like an Excel workbook; expected {what}. Export the sheet as CSV.")
    if start.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise UlnaInputError(f"{path}: the file is UTF-16; expected {what} in UTF-8. Save it as UTF-8.")
    if b"\x00" in start:
        raise UlnaInputError(f"{path}: the file is binary; expected {what}.")
    try:
        line = start.split(b"\n", 1)[0].decode("utf-8-sig").rstrip("\r")
    except UnicodeDecodeError:
        raise UlnaInputError(f"{path}: line 1 is not UTF-8 text; expected {what}. Save it as UTF-8.") from None
    if "\r" in line:
        raise UlnaInputError(
            f"{path}: the lines end with a lone carriage return; expected a line feed (or both). "
            "Save the table again with Unix or Windows line ends."
        )
    for separator, name in ((";", "semicolons"), ("\t", "tabs")):
        if separator in line and "," not in line:
            raise UlnaInputError(
                f"{path}: line 1: the columns are separated by {name}; expected commas, and numbers with a decimal "
                "point. Export the table again with commas between columns and points in numbers."
            )
    return _checked(Header(path, [name.strip() for name in next(csv.reader([line]))], is_csv=True))


def _checked(header: Header) -> Header:
    for k, name in enumerate(header.columns, start=1):
        if not name:
            raise UlnaInputError(
                f"{header.path}: column {k} has no name; expected a header of names. Name or remove it."
            )
    if all(number_of(name) is not None for name in header.columns):
        raise UlnaInputError(
            f"{header.path}: line 1 holds numbers ({', '.join(header.columns[:3])}, …); expected a header such as "
            "q1,q2,…. Add one as the first line."
        )
    for left, right in pairwise(sorted(header.columns)):
        if left == right:
            raise UlnaInputError(f"{header.path}: the column '{left}' appears twice; expected each once. Remove one.")
    return header


def read_table(header: Header, numeric: Numeric) -> pl.DataFrame:
    """All columns: Float64 where `numeric` says so, else String; every cell filled, every number finite.

    Raises UlnaInputError naming row, column and value of the first cell that is not.
    """
    try:
        frame = _scan_csv(header, numeric).collect() if header.is_csv else pl.read_parquet(header.path)
    except (polars.exceptions.PolarsError, OSError) as error:
        _explain(header, numeric, error)
        frame = _stripped(_scan_csv(header, lambda _: False).collect(), numeric)
    if not header.is_csv:
        frame = _typed(header, frame, numeric)
    return _whole(header, frame, numeric)


def iter_tables(header: Header, numeric: Numeric, rows: int = 1 << 18) -> Iterator[pl.DataFrame]:
    """The same in pieces of about `rows` rows and bounded memory, for files of any size."""
    done = 0
    try:
        for piece in _pieces(header, numeric, rows):
            yield piece
            done += len(piece)
    except (polars.exceptions.PolarsError, OSError) as error:
        _explain(header, numeric, error)
        skip = done
        for text in _pieces(header, lambda _: False, rows):  # numbers with spaces around them: as in `read_table`
            if len(text) > skip:
                yield _stripped(text.slice(skip), numeric)
            skip = max(0, skip - len(text))


def _pieces(header: Header, numeric: Numeric, rows: int) -> Iterator[pl.DataFrame]:
    scan = _scan_csv(header, numeric) if header.is_csv else pl.scan_parquet(header.path)
    before, blank = 0, False
    for piece in scan.collect_batches(chunk_size=rows, maintain_order=True):
        frame = piece if header.is_csv else _typed(header, piece, numeric, before)
        frame = _whole(header, frame, numeric, before)
        if blank and len(frame):
            name_bad_cell(header, numeric)  # the blank lines were not at the end of the file
        blank = len(frame) < len(piece)
        before += len(frame)
        yield frame


def _scan_csv(header: Header, numeric: Numeric) -> pl.LazyFrame:
    # The names come from our own reading of the header, which forgives spaces and a byte-order mark.
    schema = {name: pl.Float64 if numeric(name) else pl.String for name in header.columns}
    return pl.scan_csv(
        header.path,
        has_header=False,
        skip_rows=header.lines,
        schema=schema,
        glob=False,
        separator=header.separator,
        decimal_comma=header.decimal_comma,
    )


def _explain(header: Header, numeric: Numeric, error: Exception) -> None:
    """Name the bad cell; return where there is none, because numbers have harmless spaces around them."""
    if not header.is_csv:
        raise UlnaInputError(f"{header.path}: cannot be read ({_first_line(error)}); expected {WHAT}.") from None
    name_bad_cell(header, numeric)


def _stripped(text: pl.DataFrame, numeric: Numeric) -> pl.DataFrame:
    return text.with_columns(pl.col(c).str.strip_chars().cast(pl.Float64) for c in text.columns if numeric(c))


def _typed(header: Header, frame: pl.DataFrame, numeric: Numeric, before: int = 0) -> pl.DataFrame:
    """Parquet columns as Float64 or String."""
    columns = []
    for name, column in zip(header.columns, frame, strict=True):
        if not numeric(name):
            columns.append(column.cast(pl.String))
        elif column.dtype.is_numeric():
            columns.append(column.cast(pl.Float64))
        else:
            raise UlnaInputError(
                f"{header.path}: {header.where(before + 1)}, column '{name}': got {column[0]!r} ({column.dtype}), "
                "expected a number. Write the column as floating-point numbers."
            )
    return pl.DataFrame(columns)


def _whole(header: Header, frame: pl.DataFrame, numeric: Numeric, before: int = 0) -> pl.DataFrame:
    """The frame, if every cell is filled and every number finite; strings without spaces around them."""
    first: tuple[int, str] | None = None
    for column in frame:
        bad = column.is_null()
        if numeric(column.name):
            bad = bad | ~column.is_finite().fill_null(False)
        if bad.any():
            row = int(bad.arg_true()[0])
            first = min(first, (row, column.name), key=lambda at: at[0]) if first else (row, column.name)
    if first is None:
        spaced = [c.name for c in frame if not numeric(c.name) and bool(c.str.contains(r"^\s|\s$").any())]
        return frame.with_columns(pl.col(spaced).str.strip_chars()) if spaced else frame
    if header.is_csv:
        rest = frame.slice(first[0])
        if rest.null_count().sum_horizontal().item() == rest.height * rest.width:  # blank lines at the end are harmless
            return _whole(header, frame.head(first[0]), numeric, before)
        name_bad_cell(header, numeric)
    value = frame[first[1]][first[0]]
    raise UlnaInputError(
        bad_cell(header, before + first[0] + 1, first[1], "" if value is None else str(value), numeric)
    )


def _first_line(error: Exception) -> str:
    return str(error).splitlines()[0] if str(error) else type(error).__name__
