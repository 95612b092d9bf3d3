"""The door to tables of every format: recognised by what is in them, not by how they are called."""

from __future__ import annotations

import hashlib
import stat
from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path

import polars as pl

from ulna.formats.cells import number_of
from ulna.formats.header import Header, Numeric, Piece
from ulna.formats.layout import AS_EXPECTED, AnyHeader, Layout
from ulna.formats.no_table import is_prose, prose, refuse_foreign, refuse_zeros
from ulna.formats.tables.registry import WHAT, open_table, taken_for_text
from ulna.formats.toml import read_bytes
from ulna.ground.errors import UlnaInputError


def file_sha256(path: Path) -> str:
    """Hexadecimal SHA-256 of a file of any size."""
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def read_header(
    path: Path, what: str = WHAT, layout: Layout = AS_EXPECTED, known: Sequence[str] | None = None
) -> Header:
    """Which columns a table has, called as `layout` says; `known`: the names that it may give them.

    Raises UlnaInputError for a file that is no table, or none that is written like this.
    """
    _check_is_file(path, what)
    start = read_bytes(path, what, limit=1 << 16)
    if not start.strip():
        raise UlnaInputError(f"{path}: the file is empty; expected {what}.")
    refuse_foreign(path, start, what)
    if taken_for_text(start):
        refuse_zeros(path, start, what)
    names = {*(known or ()), *layout.columns.values()}
    words = layout.header is True and taken_for_text(start) and is_prose(start, names)
    try:
        header = open_table(path, start, what, layout)
    except UlnaInputError:
        if words:
            raise prose(path, what) from None
        raise
    if words:
        raise prose(path, what)
    return named_header(header, layout, known or [])


def _check_is_file(path: Path, what: str) -> None:
    """A table is read more than once. Raises UlnaInputError for what gives its content only once, or without end."""
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError):
        return  # told where it is opened
    if stat.S_ISREG(mode) or stat.S_ISDIR(mode):
        return
    kind = "a pipe" if stat.S_ISFIFO(mode) else "a device" if not stat.S_ISSOCK(mode) else "a socket"
    raise UlnaInputError(
        f"{path}: this is {kind}, which cannot be read twice; expected a file: {what}. Save it to a file first; "
        "ulna measure takes CSV from stdin where - is its name."
    )


def named_header(header: AnyHeader, layout: Layout, known: Sequence[str]) -> AnyHeader:
    """An open table with its columns checked, and called as `layout` says. Raises UlnaInputError."""
    _check_names(header, layout)
    return layout.mapped(header, known)


def _check_names(header: Header, layout: Layout) -> None:
    for k, name in enumerate(header.columns, start=1):
        if not name:
            raise UlnaInputError(
                f"{header.path}: column {k} has no name; expected a header of names. Name or remove it."
            )
    if all(number_of(name) is not None for name in header.columns):
        raise UlnaInputError(
            f"{header.path}: {header.head} holds numbers ({', '.join(header.columns[:3])}, …); expected a header such "
            f"as q1,q2,…. Add one as the first line, or say {layout.say('header', False)} and name the columns."
        )
    for left, right in pairwise(sorted(header.columns)):
        if left == right:
            raise UlnaInputError(f"{header.path}: the column '{left}' appears twice; expected each once. Remove one.")


def read_table(
    header: Header, numeric: Numeric, columns: Sequence[str] | None = None, blank: Sequence[str] = ()
) -> pl.DataFrame:
    """Some columns, or all: Float64 where `numeric` says so, else String; every cell filled but those of `blank`, every
    number finite.

    Raises UlnaInputError naming row, column and value of the first cell that is not.
    """
    return header.frame(numeric, header.columns if columns is None else columns, blank)


def count_rows(header: Header) -> int:
    """Data rows, 0 where nobody knows without reading them."""
    return header.rows or 0


def stream(header: Header, numbers: Sequence[str], texts: Sequence[str], rows: int = 1 << 16) -> Iterator[Piece]:
    """The named columns in pieces of about `rows` rows, of CSV and Parquet files in bounded memory whatever their size
    and layout. Raises UlnaInputError naming the first bad cell."""
    return header.pieces(numbers, texts, rows)
