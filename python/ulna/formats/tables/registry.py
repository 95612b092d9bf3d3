"""Which formats of tables there are: one row each."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ulna.formats.header import Header
from ulna.formats.layout import Layout
from ulna.formats.tables.format import TableFormat
from ulna.formats.tables.hdf5 import HDF5
from ulna.formats.tables.matfile import MAT
from ulna.formats.tables.parquet import PARQUET
from ulna.formats.tables.text import TEXT
from ulna.formats.tables.workbook import EXCEL
from ulna.ground.errors import UlnaInputError


def distinct(formats: Sequence[TableFormat]) -> tuple[TableFormat, ...]:
    """The same. Raises TypeError where two are called alike."""
    for word in ("name", "listed", "kind"):
        words = [getattr(each, word) for each in formats]
        twice = [each for each in words if words.count(each) > 1]
        if twice:
            raise TypeError(f"two table formats have '{word}' {twice[0]!r}; give one another")
    return tuple(formats)


FORMATS = distinct(
    [
        PARQUET,
        EXCEL,
        MAT,
        HDF5,
        TEXT,
    ]
)
"""In the order in which they are asked; text is what has no mark of its own, and comes last."""
LISTED = (FORMATS[-1], *FORMATS[:-1])
"""In the order in which messages list them."""


def _names(names: Sequence[str], joined: str) -> str:
    return f" {joined} ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


WHAT = f"a table ({_names([each.listed for each in LISTED], 'or')})"


def open_table(path: Path, start: bytes, what: str, layout: Layout) -> Header:
    """A file by its first bytes, opened by the format that recognises it.

    Raises UlnaInputError where none does, and where `layout` says what files of this format do not have.
    """
    for each in FORMATS:
        if each.recognised(start):
            _check_keys(path, each, layout)
            return each.open(path, start, what, layout)
    raise UlnaInputError(f"{path}: the file is binary; expected {what}.")


def _check_keys(path: Path, found: TableFormat, layout: Layout) -> None:
    """Every key must have a meaning for the file's format. Raises UlnaInputError."""
    for key in layout.given:
        if key not in found.keys:
            meant = _names([each.name for each in LISTED if key in each.keys], "and")
            raise UlnaInputError(
                f"{layout.key(key)}: {path} is {found.kind}; expected with {meant} files only. Remove it, or name "
                "another file."
            )
