"""Tables of very many rows in Parquet beside a small JSON file that names each with its SHA-256 and rows."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import polars as pl

from ulna.calibration.result_file import TableBeside
from ulna.formats.table import file_sha256
from ulna.ground.errors import UlnaInputError


def write_beside(table: pl.DataFrame, path: Path) -> TableBeside:
    """Write the table, and say what the JSON file says of it."""
    table.write_parquet(path, compression="zstd")
    return TableBeside(file=path.name, sha256=file_sha256(path), rows=table.height)


def read_beside(entry: TableBeside, of: Path, schema: dict[str, Any]) -> pl.DataFrame:
    """The table that a JSON file `of` names; later versions may have more columns than `schema`.

    Raises UlnaInputError where it is missing, or not the one that was written with the file.
    """
    if Path(entry.file).name != entry.file:
        raise UlnaInputError(f"{of}: the table {entry.file!r} lies in another folder; expected a plain file name.")
    path = of.parent / entry.file
    if not path.is_file():
        raise UlnaInputError(
            f"{path}: no such file, but {of} keeps {entry.rows} rows there; expected it beside that file, as it was "
            "written. Copy it there, or calibrate again."
        )
    if file_sha256(path) != entry.sha256:
        raise UlnaInputError(
            f"{path}: is not the file that was written with {of} (its SHA-256 is another). It was changed, or belongs "
            "to another run: copy the right one there, or calibrate again."
        )
    try:
        table = pl.read_parquet(path.absolute())
        table = table.select(pl.col(name).cast(dtype) for name, dtype in schema.items())
    except (pl.exceptions.PolarsError, OSError) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise UlnaInputError(f"{path}: cannot be read ({reason}). Calibrate again.") from None
    if table.height != entry.rows:
        raise UlnaInputError(f"{path}: has {table.height} rows, expected {entry.rows}, as {of} says. Calibrate again.")
    return table
