"""HDF5 files, and MATLAB's MAT files of version 7.3, which are HDF5 with every array stored the other way round.

A damaged file makes the library crash, or never return (15 of 6 000 files with some bytes changed, HDF5 2.0), and a
small one may declare any size. So it is read by a process of its own (hdf5_apart.py), which takes a quarter of a second
once; values come as they lie in memory, band by band, so that a file of any size is read in bounded memory.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ulna.formats.asking import Answer, Apart, EndedError, NotStartedError, ToldError
from ulna.formats.layout import Layout
from ulna.formats.tables.arrays import TEXTS, ArrayTable, NoTextError, Variable, no_such_part, unreadable
from ulna.ground.arrays import Texts
from ulna.ground.errors import UlnaInputError
from ulna.ground.extras import need

READER = Apart("ulna.formats.tables.hdf5_apart")
_FILE = "an HDF5 or MAT 7.3 file"


def open_hdf5(path: Path, start: bytes, what: str, layout: Layout) -> ArrayTable:
    """The data sets of one group, or one data set. Raises UlnaInputError for a damaged file."""
    need(f"{path}: {_FILE}", "h5py")
    try:
        (contents,) = _ask(path, what, do="contents", place=layout.dataset)
    except ToldError as error:
        if "unable to lock" in str(error) or "already open" in str(error):
            raise UlnaInputError(
                f"{path}: another program has this file open to write; expected one that is finished. Close it there."
            ) from None
        raise unreadable(path, "this looks like an HDF5 file, but", error, what) from None
    if "paths" in contents.said:
        raise no_such_part(path, layout, contents.said["paths"])
    variables = [_variable(path, each) for each in contents.said["variables"]]
    return ArrayTable.of(variables, path, layout, contents.said["inner"], what, lambda: _held(path))


def _ask(path: Path, what: str, **question: Any) -> Iterator[Answer]:
    """Raises ToldError for what the library says; UlnaInputError where it ended, or the file is refused."""
    try:
        yield from READER.ask(path=str(path.absolute()), **question)
    except NotStartedError as error:
        raise UlnaInputError(
            f"{path}: the process that reads HDF5 {error}; expected one of {sys.executable}, with h5py. Try there: "
            "import h5py."
        ) from None
    except EndedError as error:
        raise UlnaInputError(
            f"{path}: damaged: its reader {error}; expected {what}. Check the copy, or write the file again."
        ) from None
    except ToldError as error:
        if error.kind == "RefusedError":
            raise UlnaInputError(f"{path}: {error}") from None
        if error.kind == "MemoryError" or "unable to allocate" in str(error).lower():
            raise UlnaInputError(
                f"{path}: its reader needs far more memory than such a file should; expected {what}. It is damaged: "
                "check the copy, or write the file again."
            ) from None
        if error.kind == "NoText":
            raise NoTextError(str(error)) from None
        raise


@contextmanager
def _held(path: Path) -> Iterator[None]:
    """The file stays open meanwhile."""
    list(_ask(path, _FILE, do="hold"))
    try:
        yield
    finally:
        list(_ask(path, _FILE, do="let_go"))


def _variable(path: Path, said: Mapping[str, Any]) -> Variable:
    shape = tuple(said["shape"])
    if 0 in shape:
        return Variable(said["name"], shape, said["kind"], lambda: np.empty(shape))
    rows = partial(_read, path, said)
    some: Callable[[int, int], NDArray[Any]] | None = rows if said["band"] else None
    return Variable(said["name"], shape, said["kind"], rows, some)


def _read(path: Path, said: Mapping[str, Any], first: int = 0, last: int | None = None) -> NDArray[Any]:
    """The values of a variable, or some of its rows. Raises ToldError, NoTextError, UlnaInputError."""
    shape = tuple(said["shape"]) or (1,)
    length = math.prod(shape) if 1 in shape else shape[0]
    rows = length if last is None else last - first
    question = {key: said[key] for key in ("place", "way", "field") if key in said}
    found: NDArray[Any] | None = None
    at = 0
    for answer in _ask(path, _FILE, do="values", rows=None if last is None else [first, last], **question):
        band = _texts(answer) if said["kind"] == TEXTS else answer.arrays[0]
        band = band.reshape(-1) if length == math.prod(shape) else band
        if found is None and len(band) == rows:
            found, at = band, rows
            continue
        if found is None:
            found = np.empty((rows, *band.shape[1:]), dtype=band.dtype)
        found[at : at + len(band)] = band
        at += len(band)
    assert found is not None
    return found[:at]


def _texts(answer: Answer) -> Texts:
    lengths, letters = answer.arrays
    text = letters.tobytes().decode("utf-8", "surrogatepass")
    found = np.empty(len(lengths), dtype=object)
    ends = np.cumsum(lengths)
    found[:] = [text[end - length : end] for end, length in zip(ends.tolist(), lengths.tolist(), strict=True)]
    return found.reshape(answer.said["shape"])
