"""Tables that others hold in memory, whatever library they are of, as one kind of frame.

pandas and Arrow are not asked for: a frame of theirs brings them along.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import polars as pl

from ulna.ground.errors import UlnaInputError, wrong_type

EXPECTED = (
    "a table: a pandas or polars DataFrame, an Arrow table, a dict of arrays, a structured array or a list of dicts"
)


def is_frame(given: object) -> bool:
    """Whether it is a table in memory, and no array of numbers, path or other thing."""
    if isinstance(given, pl.DataFrame | pl.LazyFrame | Mapping):
        return True
    if isinstance(given, np.ndarray):
        return given.dtype.names is not None
    if isinstance(given, Sequence) and not isinstance(given, str | bytes):
        return bool(given) and all(isinstance(row, Mapping) for row in given)
    return hasattr(given, "columns") or hasattr(given, "__arrow_c_stream__")


def as_frame(given: Any, label: str) -> pl.DataFrame:
    """The same as a frame of polars; an index of pandas is left out. label: how messages call it.

    Raises UlnaInputError for columns of several lengths or of one name; TypeError for what is no table.
    """
    if not is_frame(given):
        raise wrong_type(given, EXPECTED)
    if isinstance(given, pl.LazyFrame):
        return given.collect()
    if isinstance(given, pl.DataFrame):
        return given
    if isinstance(given, np.ndarray):
        return _of_columns({name: given[name] for name in given.dtype.names or ()}, label)
    if isinstance(given, Mapping):
        return _of_columns(given, label)
    if isinstance(given, Sequence):
        names = list(dict.fromkeys(name for row in given for name in row))
        return _of_columns({name: [row.get(name) for row in given] for name in names}, label)
    if type(given).__module__.partition(".")[0] == "pandas":
        return _of_pandas(given, label)
    frame = pl.from_arrow(given) if type(given).__module__.partition(".")[0] == "pyarrow" else pl.DataFrame(given)
    return frame if isinstance(frame, pl.DataFrame) else frame.to_frame()


def _of_pandas(given: Any, label: str) -> pl.DataFrame:
    names = [str(name) for name in given.columns]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise UlnaInputError(f"{label}: the column '{twice}' appears twice; expected each once. Remove one.")
    return _of_columns({name: given.iloc[:, k] for k, name in enumerate(names)}, label)


def _of_columns(columns: Mapping[Any, Any], label: str) -> pl.DataFrame:
    series = []
    for name, values in columns.items():
        series += _series(str(name), values, label)
    lengths = {len(each) for each in series}
    if len(lengths) > 1:
        said = ", ".join(f"'{each.name}' has {len(each)}" for each in series[:8])
        raise UlnaInputError(
            f"{label}: its columns have different lengths ({said}); expected one value of each for every row. Correct "
            "the columns."
        )
    return pl.DataFrame(series)


def _series(name: str, values: Any, label: str) -> list[pl.Series]:
    """One column; of an array (N, m) the columns name1 … namem. What is missing is a gap."""
    if isinstance(values, pl.Series):
        return [values.alias(name)]
    array = np.asarray(values)
    if array.ndim == 2 and array.dtype.kind in "iuf":
        return [pl.Series(f"{name}{k + 1}", np.ascontiguousarray(array[:, k])) for k in range(array.shape[1])]
    if array.ndim != 1:
        raise UlnaInputError(
            f"{label}: column '{name}': got an array of shape {array.shape}; expected one number or name for each row. "
            "Give one column after the other."
        )
    if array.dtype.kind in "biuf":
        return [pl.Series(name, np.ascontiguousarray(array))]
    cells = [None if _is_gap(cell) else cell for cell in array.tolist()]
    if all(isinstance(cell, int | float) and not isinstance(cell, bool) for cell in cells if cell is not None):
        return [pl.Series(name, cells, dtype=pl.Float64)]
    return [pl.Series(name, [None if cell is None else str(cell) for cell in cells], dtype=pl.String)]


def _is_gap(cell: Any) -> bool:
    """None, NaN, and pandas' NA and NaT, which are not equal to themselves."""
    if cell is None or type(cell).__name__ in ("NAType", "NaTType"):
        return True
    return isinstance(cell, float) and cell != cell
