"""What points are written to: one row for each ending. Pieces come one after the other, memory stays bounded."""

from __future__ import annotations

import errno
import re
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import Any

import polars as pl

from ulna.formats.for_sheets import for_sheets
from ulna.formats.output import UNDER_WAY
from ulna.ground.errors import UlnaInputError
from ulna.ground.extras import need

MOST_SHEET_ROWS = 1_048_576
"""Of a sheet of a workbook, the names of the columns among them (ECMA-376, as Excel has it)."""


class TooManyRowsError(Exception):
    """More than a format can hold; the message says what to do."""

    def __init__(self, there: str = "there are more") -> None:
        super().__init__(
            f"a sheet of a workbook holds {MOST_SHEET_ROWS - 1} points, and {there}; expected another format. Name a "
            ".parquet or .csv file."
        )


Write = Callable[[Iterator[pl.DataFrame], Path], None]


def write_csv(frames: Iterator[pl.DataFrame], path: Path) -> None:
    """Numbers in the shortest form that reads back the same."""
    _write_text(frames, path, ",")


def write_tsv(frames: Iterator[pl.DataFrame], path: Path) -> None:
    """The same with tabs."""
    _write_text(frames, path, "\t")


def _write_text(frames: Iterator[pl.DataFrame], path: Path, separator: str) -> None:
    with path.open("wb") as file:
        for number, frame in enumerate(frames):
            for_sheets(frame).write_csv(file, include_header=number == 0, separator=separator)


def write_json_lines(frames: Iterator[pl.DataFrame], path: Path) -> None:
    """One object a line."""
    with path.open("wb") as file:
        for frame in frames:
            frame.write_ndjson(file)


def write_parquet(frames: Iterator[pl.DataFrame], path: Path) -> None:
    """Row groups as they come. Raises UlnaInputError where what writes them is not installed."""
    need(str(path), "pyarrow")
    import pyarrow.parquet

    with ExitStack() as stack:
        writer: Any = None
        for frame in frames:
            table = frame.to_arrow()
            if writer is None:
                writer = stack.enter_context(pyarrow.parquet.ParquetWriter(path, table.schema, compression="zstd"))
            writer.write_table(table)


def write_workbook(frames: Iterator[pl.DataFrame], path: Path) -> None:
    """One sheet "points", numbers as numbers (with 16 digits), names as text. Raises TooManyRowsError for more than a
    sheet has."""
    import openpyxl

    book = openpyxl.Workbook(write_only=True)
    sheet = book.create_sheet("points")
    sheet.freeze_panes = "A2"
    sheet._get_writer()  # opens the file in which the library keeps rows until the book is whole
    kept = Path(sheet._writer.out)
    UNDER_WAY.add(kept)
    try:
        _fill(sheet, frames)
        book.save(path)
    except BaseException as error:
        with suppress(Exception):
            sheet.close()
        kept.unlink(missing_ok=True)
        if found := re.fullmatch(r"IO_(E[A-Z]+)", str(error)):  # as lxml says that the disk is full
            raise OSError(getattr(errno, found[1], errno.EIO), found[1]) from None
        raise
    finally:
        UNDER_WAY.discard(kept)


def _fill(sheet: Any, frames: Iterator[pl.DataFrame]) -> None:
    from openpyxl.cell import WriteOnlyCell

    rows = 0
    for frame in frames:
        if not rows:
            sheet.append(frame.columns)
            rows = 1
        rows += len(frame)
        if rows > MOST_SHEET_ROWS:
            raise TooManyRowsError
        texts = [dtype == pl.String for dtype in frame.dtypes]
        for row in frame.iter_rows():
            cells = zip(row, texts, strict=True)
            sheet.append([_text(WriteOnlyCell(sheet, cell)) if text else cell for cell, text in cells])


def _text(cell: Any) -> Any:
    """A name that begins with = is no formula."""
    cell.data_type = "s"
    return cell


ENDINGS: dict[str, Write] = {
    ".csv": write_csv,
    ".txt": write_csv,
    ".dat": write_csv,
    ".tsv": write_tsv,
    ".parquet": write_parquet,
    ".xlsx": write_workbook,
    ".jsonl": write_json_lines,
}
"""Small letters → who writes it."""


def writer_of(path: Path) -> Write:
    """By the ending. Raises UlnaInputError for one that cannot be written."""
    ending = path.suffix.lower()
    if ending not in ENDINGS:
        known = ", ".join(ENDINGS)
        what = f"got the ending '{ending}', which points cannot be written to" if ending else "it has no ending"
        raise UlnaInputError(f"{path}: {what}; expected one of {known}. Name such a file.")
    return ENDINGS[ending]


def check_room(path: Path, count: Callable[[], int | None]) -> None:
    """Whether as many points go into such a file; `count` is asked only where that matters, and may not know. Raises
    UlnaInputError."""
    if ENDINGS.get(path.suffix.lower()) is not write_workbook:
        return
    rows = count()
    if rows is not None and rows >= MOST_SHEET_ROWS:
        raise UlnaInputError(f"{path}: {TooManyRowsError(f'there are {rows}')}")
