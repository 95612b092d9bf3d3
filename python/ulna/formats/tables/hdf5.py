"""HDF5 files, and MATLAB's MAT files of version 7.3, which are HDF5 with every array stored the other way round."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ulna.formats.layout import Layout
from ulna.formats.tables.arrays import NUMBERS, TEXTS, ArrayTable, NoTextError, Variable, no_such_part, unreadable
from ulna.ground.arrays import Texts
from ulna.ground.errors import UlnaInputError
from ulna.ground.extras import need

_MATLAB_NUMBERS = ("double", "single", "logical", "int", "uint")
_MOST_LISTED = 1000


def _h5py() -> Any:
    """The library, loaded when there is such a file: that takes longer than to read a study of CSV files."""
    import h5py

    return h5py


def open_hdf5(path: Path, start: bytes, what: str, layout: Layout) -> ArrayTable:
    """The data sets of one group, or one data set. Raises UlnaInputError for a damaged file."""
    need(f"{path}: an HDF5 or MAT 7.3 file", "h5py")
    try:
        with _h5py().File(path) as file:
            place = _place(file, layout.dataset)
            if place is None:
                raise no_such_part(path, layout, _paths(file))
            variables, inner = _variables(path, place)
    except (OSError, RuntimeError, KeyError, ValueError, TypeError, AttributeError) as error:
        if "unable to lock" in str(error) or "already open" in str(error):
            raise UlnaInputError(
                f"{path}: another program has this file open to write; expected one that is finished. Close it there."
            ) from None
        raise unreadable(path, "this looks like an HDF5 file, but", error, what) from None
    return ArrayTable.of(variables, path, layout, inner, what)


def _place(file: Any, dataset: str | None) -> Any:
    return file if dataset is None else file.get(dataset) if dataset.strip("/") else file


def _paths(file: Any) -> list[str]:
    found: list[str] = []

    def look(name: str) -> bool | None:
        found.append(name)
        return True if len(found) >= _MOST_LISTED else None  # anything but None ends the visit

    file.visit(look)
    return [name for name in found if not name.startswith("#")]


def _variables(path: Path, place: Any) -> tuple[list[Variable], list[str]]:
    """The variables at a place, and the paths of groups further in."""
    if isinstance(place, _h5py().Dataset):
        return _of_dataset(path, place), []
    found: list[Variable] = []
    inner: list[str] = []
    for name in place:
        member = place.get(name)
        if isinstance(member, _h5py().Dataset):
            found += _of_dataset(path, member)
        elif isinstance(member, _h5py().Group) and not name.startswith("#"):  # MATLAB keeps the insides of cells there
            inner.append(member.name)
    return found, inner


def _of_dataset(path: Path, data: Any) -> list[Variable]:
    place, name = data.name, data.name.split("/")[-1]
    kind = data.attrs.get("MATLAB_class")
    if kind is not None:
        return [_of_matlab(path, data, name, kind.decode() if isinstance(kind, bytes) else str(kind))]
    if data.dtype.names:
        return [
            Variable(
                field, data.shape + data.dtype[field].shape, _kind(data.dtype[field].base), _field(path, place, field)
            )
            for field in data.dtype.names
        ]
    return [Variable(name, data.shape or (), _kind(data.dtype), _whole(path, place))]


def _kind(dtype: Any) -> str:
    if _h5py().check_string_dtype(dtype) is not None:
        return TEXTS
    if dtype.kind in "fiub":
        return NUMBERS
    kinds = {"c": "an array of complex numbers", "O": "an array of references or arrays", "V": "a compound"}
    return kinds.get(dtype.kind, f"an array of {dtype}")


def _whole(path: Path, place: str) -> Callable[[], NDArray[Any]]:
    def read() -> NDArray[Any]:
        with _h5py().File(path) as file:
            return _plain(_written(path, file[place])[()])

    return read


def _field(path: Path, place: str, field: str) -> Callable[[], NDArray[Any]]:
    def read() -> NDArray[Any]:
        with _h5py().File(path) as file:
            return _plain(_written(path, file[place])[field])

    return read


def _written(path: Path, data: Any) -> Any:
    """The data set, where all of its values stand in this file: of others HDF5 makes zeros without a word, and the hash
    of the file does not vouch for them. Raises UlnaInputError."""
    name = data.name.lstrip("/")
    elsewhere = [source.file_name for source in data.virtual_sources()] if data.is_virtual else []
    elsewhere += [str(name) for name, *_ in data.external or ()]
    others = list(dict.fromkeys(file for file in elsewhere if file != "."))
    if others:
        raise UlnaInputError(
            f"{path}: the values of '{name}' stand in other files ({', '.join(others)[:80]}); expected all of them in "
            "this one. Copy it with its values (h5repack), and name the copy."
        )
    missing = 0
    if data.size and not data.is_virtual and data.external is None:
        if data.chunks is not None:
            blocks = math.prod(-(-size // chunk) for size, chunk in zip(data.shape, data.chunks, strict=True))
            missing = blocks - data.id.get_num_chunks()
        elif data.id.get_storage_size() == 0:
            blocks = missing = 1
    if missing > 0:
        raise UlnaInputError(
            f"{path}: {missing} of {blocks} blocks of '{name}' were never written; expected a number in every row. The "
            "program that made the file did not finish: write it again."
        )
    return data


def _plain(values: Any) -> NDArray[Any]:
    """Bytes as texts. Raises UnicodeDecodeError for what is not UTF-8."""
    array = np.asarray(values)
    if array.dtype.kind not in "SO":
        return array
    return np.array([v.decode() if isinstance(v, bytes) else v for v in array.reshape(-1)], object).reshape(array.shape)


def _of_matlab(path: Path, data: Any, name: str, kind: str) -> Variable:
    place = data.name
    shape = tuple(int(size) for size in (data[()] if "MATLAB_empty" in data.attrs else data.shape[::-1]))
    if 0 in shape:
        return Variable(name, shape, NUMBERS, lambda: np.empty(shape))
    if kind.startswith(_MATLAB_NUMBERS):
        return Variable(name, shape, NUMBERS, lambda: _whole(path, place)().T)
    if kind == "char":
        return Variable(name, shape[:1], TEXTS, lambda: _chars(_whole(path, place)()))
    if kind == "cell":
        return Variable(name, shape, TEXTS, _cell(path, place))
    return Variable(name, shape, f"a MATLAB {kind}", lambda: None)


def _chars(codes: NDArray[Any]) -> Texts:
    """(length, N) UTF-16 codes → (N,) texts."""
    return np.array([row.astype("<u2").tobytes().decode("utf-16-le") for row in codes.T], dtype=object)


def _cell(path: Path, place: str) -> Callable[[], NDArray[Any]]:
    def read() -> NDArray[Any]:
        with _h5py().File(path) as file:
            references = _written(path, file[place])[()].T
            texts = np.empty(references.shape, dtype=object)
            for at, reference in np.ndenumerate(references):
                texts[at] = _cell_text(file[reference])
            return texts

    return read


def _cell_text(data: Any) -> str:
    """One cell of a cell array. Raises NoTextError where it is no text and no single number."""
    kind = data.attrs.get("MATLAB_class", b"").decode()
    if "MATLAB_empty" in data.attrs:
        return ""
    values = data[()]
    if kind == "char" and values.ndim == 2 and values.shape[1] == 1:
        return str(_chars(values)[0])
    if kind.startswith(_MATLAB_NUMBERS) and values.size == 1:
        value = float(values.reshape(-1)[0])
        return str(int(value)) if value.is_integer() else str(value)
    raise NoTextError("a cell holds something else than a text or a number")
