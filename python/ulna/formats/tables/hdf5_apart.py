"""HDF5 and MAT 7.3 as they are read in a process of their own (`ulna.formats.asking`): h5py, and nothing of tables.

Questions: `contents` of a place; `values` of a variable, all of them or some rows; `hold` and `let_go`, between which a
file stays open. Values come in bands of rows of a few MB, in the order of the rows whichever way the file stores them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from ulna.formats.answering import Alive, RefusedError, serve

NUMBERS, TEXTS = "numbers", "texts"
NO_TEXT = "NoText"
"""The error of texts that are none."""
_MATLAB_NUMBERS = ("double", "single", "logical", "int", "uint")
_MOST_LISTED = 1000
_MOST_DIMENSIONS = 64
"""HDF5 has 32 at most."""
_BAND_BYTES = 4 << 20
_TEXT_BYTES = 256
"""Of a text of any length, in a band."""
_CACHE_BYTES = 32 << 20
"""Of decompressed blocks of a data set, so that those that several bands need are decompressed once."""
_MOST_OPEN = 16
"""Data sets that are kept open, each with its blocks."""
_BLOCK_BYTES = 256 << 20
"""Of one block at most: HDF5 decompresses a block as a whole."""
_LINK = "a link to another file"

_held: dict[str, Any] = {}
_open: dict[tuple[str, str], Any] = {}
"""Data sets of the file at hand that were checked."""


def answer(question: dict[str, Any], alive: Alive) -> Iterator[None]:
    """One question. Raises whatever the library does."""
    path = question["path"]
    if question["do"] == "hold":
        _held[path] = _opened(path)
    elif question["do"] == "let_go":
        _open.clear()
        if path in _held:
            _held.pop(path).close()
    elif path in _held:
        yield from _of(_held[path], question, alive)
    else:
        with _opened(path) as file:
            try:
                yield from _of(file, question, alive)
            finally:
                _open.clear()


def _opened(path: str) -> Any:
    return h5py.File(path, rdcc_nbytes=_CACHE_BYTES, rdcc_nslots=10_007)


def _of(file: Any, question: dict[str, Any], alive: Alive) -> Iterator[None]:
    if question["do"] == "contents":
        yield from _contents(file, question["place"], alive)
    else:
        yield from _values(file, question, alive)


# ---------------------------------------------------------------- what there is


def _contents(file: Any, place: str | None, alive: Alive) -> Iterator[None]:
    at = _at(file, place)
    if at is None:
        alive.say("some", paths=_paths(file))
        return
    found: list[dict[str, Any]] = []
    inner: list[str] = []
    if isinstance(at, h5py.Dataset):
        found += _of_dataset(at)
    else:
        for name in at:
            yield
            if isinstance(at.get(name, getlink=True), h5py.ExternalLink):
                found.append(_variable(name, at.name, (), _LINK))
                continue
            member = at.get(name)
            if isinstance(member, h5py.Dataset):
                found += _of_dataset(member)
            elif isinstance(member, h5py.Group) and not name.startswith("#"):  # MATLAB keeps the insides of cells there
                inner.append(member.name)
    alive.say("some", variables=found, inner=inner)


def _at(file: Any, place: str | None) -> Any:
    """The group or data set at a place; None where there is none. Raises RefusedError for what is in another file."""
    at = file
    for step in (place or "").split("/"):
        if not step:
            continue
        if not isinstance(at, h5py.Group):
            return None
        if isinstance(at.get(step, getlink=True), h5py.ExternalLink):
            raise RefusedError(
                f"'{place}' is {_LINK}; expected the readings in this one. Name the other file, or copy what is there."
            )
        at = at.get(step)
    return at


def _paths(file: Any) -> list[str]:
    found: list[str] = []

    def look(name: str) -> bool | None:
        found.append(name)
        return True if len(found) >= _MOST_LISTED else None  # anything but None ends the visit

    file.visit(look)
    return [name for name in found if not name.startswith("#")]


def _variable(name: str, place: str, shape: tuple[int, ...], kind: str, **more: Any) -> dict[str, Any]:
    return {"name": name, "place": place, "shape": [int(size) for size in shape], "kind": kind, "band": 0, **more}


def _of_dataset(data: Any) -> list[dict[str, Any]]:
    place, name = data.name, data.name.split("/")[-1]
    kind = data.attrs.get("MATLAB_class")
    if kind is not None:
        return [_of_matlab(data, name, kind.decode() if isinstance(kind, bytes) else str(kind))]
    if data.dtype.names:
        return [
            _variable(
                field,
                place,
                data.shape + data.dtype[field].shape,
                _kind(data.dtype[field].base),
                field=field,
                **_way(data, "plain"),
            )
            for field in data.dtype.names
        ]
    return [_variable(name, place, data.shape or (), _kind(data.dtype), **_way(data, "plain"))]


def _of_matlab(data: Any, name: str, kind: str) -> dict[str, Any]:
    """MATLAB stores every array the other way round; of one that is empty its sizes in place of values."""
    empty = "MATLAB_empty" in data.attrs
    if empty and data.size > _MOST_DIMENSIONS:
        raise RefusedError(
            f"'{name}' is an empty array of {data.size} dimensions, as the file says; expected {_MOST_DIMENSIONS} at "
            "most. The file is damaged: write it again."
        )
    shape = tuple(int(size) for size in (data[()] if empty else data.shape[::-1]))
    if 0 in shape:
        return _variable(name, data.name, shape, NUMBERS)
    if kind.startswith(_MATLAB_NUMBERS):
        return _variable(name, data.name, shape, NUMBERS, **_way(data, "turned"))
    if kind == "char":
        return _variable(name, data.name, shape[:1], TEXTS, **_way(data, "chars"))
    if kind == "cell":
        return _variable(name, data.name, shape, TEXTS, **_way(data, "cells"))
    return _variable(name, data.name, shape, f"a MATLAB {kind}")


def _kind(dtype: Any) -> str:
    if h5py.check_string_dtype(dtype) is not None:
        return TEXTS
    if dtype.kind in "fiub":
        return NUMBERS
    kinds = {"c": "an array of complex numbers", "O": "an array of references or arrays", "V": "a compound"}
    return kinds.get(dtype.kind, f"an array of {dtype}")


def _way(data: Any, way: str) -> dict[str, Any]:
    """How its values are read, and how many rows at once; band 0: not by rows, as too much would be read twice."""
    if not data.shape or not data.size:
        return {"way": way}
    axis = _axis(data, way)
    row = _row_bytes(data, axis)
    band = max(1, _BAND_BYTES // row)
    if data.chunks is not None:
        across = -(-data.size // data.shape[axis]) * data.chunks[axis] * data.dtype.itemsize
        if across > _CACHE_BYTES:
            return {"way": way}
        band = max(band, data.chunks[axis]) // data.chunks[axis] * data.chunks[axis]
    return {"way": way, "band": band}


def _axis(data: Any, way: str) -> int:
    """Along which of the stored axes the rows are."""
    if 1 in data.shape or len(data.shape) == 1:
        return int(np.argmax(data.shape)) if way != "chars" else len(data.shape) - 1
    return 0 if way == "plain" else len(data.shape) - 1


def _row_bytes(data: Any, axis: int) -> int:
    item: int = data.dtype.itemsize if data.dtype.kind != "O" else _TEXT_BYTES
    width: int = math.prod(data.shape) // data.shape[axis]
    return max(1, width * item)


# ---------------------------------------------------------------- values


def _values(file: Any, question: dict[str, Any], alive: Alive) -> Iterator[None]:
    key = file.filename, question["place"]
    data = _open.get(key)
    if data is None:
        data = file[question["place"]]
        _check_written(data)
        _check_blocks(data)
        if len(_open) == _MOST_OPEN:
            del _open[next(iter(_open))]
        _open[key] = data
    way, field = question["way"], question.get("field")
    convert = _CONVERT[way]
    source = data if field is None else data.fields(field)
    if not data.shape:
        _say(alive, convert(file, np.asarray(source[()]), alive).reshape(-1))
        return
    axis = _axis(data, way)
    length = data.shape[axis]
    first, last = question.get("rows") or (0, length)
    step = max(1, _BAND_BYTES // _row_bytes(data, axis))
    if data.chunks is not None:  # whole blocks, so that none is decompressed twice
        step = max(step, data.chunks[axis]) // data.chunks[axis] * data.chunks[axis]
    at = first
    while at < last:
        until = min(last, (at // step + 1) * step)
        reading = (until - at) * _row_bytes(data, axis)
        if reading > _BAND_BYTES:  # a large block, as a whole
            alive.say("alive", reading=min(reading, file.id.get_filesize()))
        some = [slice(None)] * len(data.shape)
        some[axis] = slice(at, until)
        values = convert(file, np.asarray(source[tuple(some)]), alive)
        _say(alive, values)
        at = until
        yield


def _say(alive: Alive, values: NDArray[Any]) -> None:
    if values.dtype != object:
        alive.say("some", [values])
        return
    texts = values.reshape(-1).tolist()
    lengths = np.array([len(text) for text in texts], dtype=np.int64)
    letters = np.frombuffer("".join(texts).encode("utf-8", "surrogatepass"), dtype=np.uint8)
    alive.say("some", [lengths, letters], shape=values.shape)


def _plain(_file: Any, values: NDArray[Any], _alive: Alive) -> NDArray[Any]:
    """Bytes as texts. Raises NoText for what is not UTF-8."""
    if values.dtype.kind not in "SO":
        return values
    found = np.empty(values.size, dtype=object)
    try:
        found[:] = [value.decode() if isinstance(value, bytes) else value for value in values.reshape(-1)]
    except UnicodeDecodeError:
        raise NoText("texts that are not UTF-8") from None
    return found.reshape(values.shape)


def _turned(_file: Any, values: NDArray[Any], _alive: Alive) -> NDArray[Any]:
    return values.T


def _chars(_file: Any, codes: NDArray[Any], _alive: Alive) -> NDArray[Any]:
    """(length, N) UTF-16 codes → (N,) texts."""
    return _text(codes)


def _text(codes: NDArray[Any]) -> NDArray[Any]:
    try:
        texts = [row.astype("<u2").tobytes().decode("utf-16-le") for row in codes.T]
    except UnicodeDecodeError:
        raise NoText("texts that are not UTF-8") from None
    found = np.empty(len(texts), dtype=object)
    found[:] = texts
    return found


def _cells(file: Any, references: NDArray[Any], alive: Alive) -> NDArray[Any]:
    texts = np.empty(references.T.shape, dtype=object)
    for at, reference in np.ndenumerate(references.T):
        texts[at] = _cell_text(file[reference])
        alive.sign()
    return texts


def _cell_text(data: Any) -> str:
    """One cell of a cell array. Raises NoText where it is no text and no single number."""
    kind = data.attrs.get("MATLAB_class", b"").decode()
    if "MATLAB_empty" in data.attrs:
        return ""
    numbers = kind.startswith(_MATLAB_NUMBERS) and data.size == 1
    if not numbers and not (kind == "char" and len(data.shape) == 2 and data.shape[1] == 1):
        raise NoText("a cell holds something else than a text or a number")
    if data.size * data.dtype.itemsize > _BAND_BYTES:
        raise NoText(f"a cell holds a text of {data.size} letters")
    values = data[()]
    if kind == "char":
        return str(_text(values)[0])
    value = float(values.reshape(-1)[0])
    return str(int(value)) if value.is_integer() else str(value)


class NoText(Exception):  # noqa: N818  # its name is what is told
    """A cell that is no text. ``str(error)`` says so."""


_CONVERT: dict[str, Callable[[Any, NDArray[Any], Alive], NDArray[Any]]] = {
    "plain": _plain,
    "turned": _turned,
    "chars": _chars,
    "cells": _cells,
}


def _check_written(data: Any) -> None:
    """All of its values stand in this file: of others HDF5 makes zeros without a word, and the hash of the file does
    not vouch for them. Raises RefusedError."""
    name = data.name.lstrip("/")
    elsewhere = [source.file_name for source in data.virtual_sources()] if data.is_virtual else []
    elsewhere += [str(name) for name, *_ in data.external or ()]
    others = list(dict.fromkeys(file for file in elsewhere if file != "."))
    if others:
        raise RefusedError(
            f"the values of '{name}' stand in other files ({', '.join(others)[:80]}); expected all of them in "
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
        raise RefusedError(
            f"{missing} of {blocks} blocks of '{name}' were never written; expected a number in every row. The "
            "program that made the file did not finish: write it again."
        )


def _check_blocks(data: Any) -> None:
    """No block is larger than what may be decompressed at once. Raises RefusedError."""
    size = 0 if data.chunks is None else math.prod(data.chunks) * data.dtype.itemsize
    if size > _BLOCK_BYTES:
        raise RefusedError(
            f"'{data.name.lstrip('/')}' is stored in blocks of {size >> 20} MB; "
            f"expected blocks of {_BLOCK_BYTES >> 20} MB at most. Store it in smaller ones (h5repack -l CHUNK=…)."
        )


if __name__ == "__main__":
    serve(answer)
