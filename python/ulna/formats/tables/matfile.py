"""MATLAB's MAT files up to version 7 (Octave and SciPy write them too); version 7.3 is HDF5, see hdf5.py."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ulna.formats.layout import Layout
from ulna.formats.tables.arrays import NUMBERS, TEXTS, ArrayTable, NoTextError, Variable, no_such_part, unreadable
from ulna.formats.tables.mat5 import DamagedError, Entry, Strange, Struct, entries, value
from ulna.ground.arrays import Texts


def open_mat(path: Path, start: bytes, what: str, layout: Layout) -> ArrayTable:
    """The variables of a file, or the fields of a struct in it. Raises UlnaInputError for a damaged file."""
    try:
        listed = entries(path)
        steps = [step for step in (layout.dataset or "").split("/") if step]
        if steps:
            found = _inside(path, listed, steps)
            if isinstance(found, list):
                raise no_such_part(path, layout, found)
            variables = {name: _held(name, held) for name, held in found.items()}
        else:
            variables = {entry.name: _listed(path, entry) for entry in listed}
    except (DamagedError, RecursionError) as error:
        raise unreadable(path, "this looks like a MAT file, but", error, what) from None
    plain = [each for each in variables.values() if each is not None]
    structs = ["/".join([*steps, name]) for name, variable in variables.items() if variable is None]
    return ArrayTable.of(plain, path, layout, structs, what)


def _listed(path: Path, entry: Entry) -> Variable | None:
    """A variable as the list of contents tells of it, its values read when they are needed; None for a struct."""

    def read() -> Any:
        found = value(path, entry)
        return texts_of(found) if entry.kind == "cell" else found

    if entry.kind == "struct":
        return None
    if entry.kind in ("char", "cell"):
        rows = entry.shape[:1] if 0 not in entry.shape else (0,)
        return Variable(entry.name, rows if entry.kind == "char" else entry.shape, TEXTS, read)
    return Variable(entry.name, entry.shape, NUMBERS if entry.kind == "numbers" else entry.kind, read)


def _held(name: str, held: Any) -> Variable | None:
    """A variable whose value is in memory already; None for a struct."""
    if isinstance(held, Struct):
        return None
    if isinstance(held, Strange):
        return Variable(name, (), held.kind, _constantly(held))
    if held.dtype != object:
        return Variable(name, held.shape, NUMBERS, _constantly(held))
    return Variable(name, held.shape, TEXTS, lambda: texts_of(held))


def _constantly(held: Any) -> Callable[[], Any]:
    return lambda: held


def _inside(path: Path, listed: list[Entry], steps: list[str]) -> dict[str, Any] | list[str]:
    """What is at the key `dataset`, by name: the fields of a struct, or one variable. Where nothing is: the names that
    there are."""
    entry = next((entry for entry in listed if entry.name == steps[0]), None)
    if entry is None:
        return [entry.name for entry in listed]
    held = value(path, entry)
    for k, step in enumerate(steps[1:], start=1):
        fields = _fields(held)
        if step not in fields:
            return ["/".join([*steps[:k], name]) for name in fields] or [entry.name for entry in listed]
        held = fields[step]
    return _fields(held) or {steps[-1]: held}


def _fields(held: Any) -> dict[str, Any]:
    """Of a struct; of a struct array each field has one row for every element."""
    if not isinstance(held, Struct):
        return {}
    return {name: values[0] if len(values) == 1 else _rows(values) for name, values in held.fields.items()}


def _rows(values: list[Any]) -> NDArray[Any]:
    """One field of a struct array: numbers of one length under each other, else a cell array."""
    numbers = all(isinstance(each, np.ndarray) and each.dtype != object for each in values)
    if numbers and len({each.size for each in values}) == 1:
        return np.array([each.reshape(-1) for each in values])
    cells = np.empty(len(values), dtype=object)
    for k, each in enumerate(values):
        cells[k] = each
    return cells


def texts_of(cells: NDArray[Any]) -> Texts:
    """A cell array, or rows of text, as texts; a single number is one too. Raises NoTextError for anything else."""
    texts = np.empty(cells.size, dtype=object)
    for k, cell in enumerate(cells.reshape(-1)):
        if isinstance(cell, np.ndarray) and cell.size <= 1:
            cell = cell.reshape(-1)[0] if cell.size else ""
        if isinstance(cell, np.number):
            cell = str(int(cell)) if float(cell).is_integer() else str(float(cell))
        if not isinstance(cell, str):
            raise NoTextError("a cell holds something else than a text or a number")
        texts[k] = cell
    return texts.reshape(cells.shape)
