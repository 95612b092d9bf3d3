"""Which formats of tables there are: one row each.

What reads a format is loaded when there is such a file: all of them together take as long as a fit of a hundred bars.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from ulna.formats.header import Header
from ulna.formats.layout import Layout
from ulna.formats.tables.format import TableFormat
from ulna.formats.tables.marks import OLD_OFFICE, PARQUET, ZIP, is_hdf5, is_mat, is_text
from ulna.ground.errors import UlnaInputError


def distinct(formats: Sequence[TableFormat]) -> tuple[TableFormat, ...]:
    """The same. Raises TypeError where two are called alike."""
    for word in ("name", "listed", "kind"):
        words = [getattr(each, word) for each in formats]
        twice = [each for each in words if words.count(each) > 1]
        if twice:
            raise TypeError(f"two table formats have '{word}' {twice[0]!r}; give one another")
    return tuple(formats)


def _parquet(path: Path, start: bytes, what: str, layout: Layout) -> Header:
    from ulna.formats.tables.parquet import open_parquet

    return open_parquet(path, start, what, layout)


def _excel(path: Path, start: bytes, what: str, layout: Layout) -> Header:
    from ulna.formats.tables.workbook import open_workbook

    return open_workbook(path, start, what, layout)


def _mat(path: Path, start: bytes, what: str, layout: Layout) -> Header:
    from ulna.formats.tables.matfile import open_mat

    return open_mat(path, start, what, layout)


def _hdf5(path: Path, start: bytes, what: str, layout: Layout) -> Header:
    from ulna.formats.tables.hdf5 import open_hdf5

    return open_hdf5(path, start, what, layout)


def _text(path: Path, start: bytes, what: str, layout: Layout) -> Header:
    from ulna.formats.tables.text import open_text

    return open_text(path, start, what, layout)


FORMATS = distinct(
    [
        TableFormat(
            name="Parquet",
            listed="Parquet",
            kind="a Parquet file",
            endings=(".parquet",),
            keys=(),
            recognised=lambda start: start.startswith(PARQUET),
            open=_parquet,
        ),
        TableFormat(
            name="Excel",
            listed=".xlsx",
            kind="an Excel workbook",
            endings=(".xlsx", ".xlsm"),
            keys=("sheet", "comment", "header", "units_row", "fill_down"),
            recognised=lambda start: start.startswith((ZIP, OLD_OFFICE)),
            open=_excel,
        ),
        TableFormat(
            name="MAT",
            listed=".mat",
            kind="a MAT file",
            endings=(".mat",),
            keys=("dataset",),
            recognised=is_mat,
            open=_mat,
        ),
        TableFormat(
            name="HDF5",
            listed="HDF5",
            kind="an HDF5 or MAT 7.3 file",
            endings=(".h5", ".hdf5", ".mat"),
            keys=("dataset",),
            recognised=is_hdf5,
            open=_hdf5,
        ),
        TableFormat(
            name="CSV",
            listed="CSV with a header",
            kind="a CSV file",
            endings=(".csv", ".txt", ".tsv", ".dat"),
            keys=("separator", "decimal", "thousands", "encoding", "comment", "header", "units_row", "fill_down"),
            recognised=is_text,
            open=_text,
        ),
    ]
)
"""In the order in which they are asked; text is what has no mark of its own, and comes last."""
LISTED = (FORMATS[-1], *FORMATS[:-1])
"""In the order in which messages list them."""


def _names(names: Sequence[str], joined: str) -> str:
    return f" {joined} ".join([", ".join(names[:-1]), names[-1]] if len(names) > 1 else names)


WHAT = f"a table ({_names([each.listed for each in LISTED], 'or')})"


def taken_for_text(start: bytes) -> bool:
    """Whether a file that begins so is read as text: no other format has its mark."""
    return next((each for each in FORMATS if each.recognised(start)), None) is FORMATS[-1]


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
