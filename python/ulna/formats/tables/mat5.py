"""Reading MATLAB's MAT files of versions 5 to 7, after MathWorks' "MAT-File Format" (level 5).

SciPy has a reader too, but one wrong byte in a file that is not compressed can end the whole process there (a
segmentation fault for 5 of 250 such files with SciPy 1.17), where a message is due. Here every length is compared
with what is left before anything is made of it, and what a compressed variable declares with the size of the file
before it is unpacked; so it needs no process of its own. The tests compare the two readers.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from ulna.formats.unpacked import check_unpacked

_HEADER_BYTES = 128
_LOOK_BYTES = 1 << 12
_MANY_CELLS, _EMPTY_CELL_BYTES = 1_000_000, 48
_COMPRESSED, _MATRIX = 15, 14
_NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
_TEXTS = {1: "latin-1", 2: "latin-1", 4: "utf-16", 16: "utf-8", 17: "utf-16", 18: "utf-32"}
_CELL, _STRUCT, _OBJECT, _CHAR, _SPARSE, _OPAQUE = 1, 2, 3, 4, 5, 17
_NUMERIC = range(6, 16)
_IN_WORDS = {_OBJECT: "a MATLAB object", _SPARSE: "a sparse matrix", 16: "a MATLAB function"}


class DamagedError(Exception):
    """The file is not built as the format says. ``str(error)`` says where."""


@dataclass(frozen=True)
class Struct:
    """A struct or a struct array."""

    shape: tuple[int, ...]
    fields: dict[str, list[Any]]
    """Of each field its value in every element, in MATLAB's order (columns first)."""


@dataclass(frozen=True)
class Strange:
    """What is neither numbers nor texts, cells or a struct."""

    kind: str
    """In words: "a sparse matrix"."""


@dataclass(frozen=True)
class Entry:
    """One variable of the list of contents."""

    name: str
    shape: tuple[int, ...]
    kind: str
    """numbers, char, cell, struct, or in words what it is instead."""
    start: int
    """Where its element begins in the file."""


def entries(path: Path) -> list[Entry]:
    """The variables of a file. Raises DamagedError."""
    with path.open("rb") as stream:
        order = _order(stream)
        found = []
        size = stream.seek(0, 2)
        start = _HEADER_BYTES
        while start < size:
            stream.seek(start)
            kind, length, _ = _tag(_View(memoryview(stream.read(8)), order))
            if start + 8 + length > size:
                raise DamagedError(f"it ends within the variable that begins at byte {start}")
            head = stream.read(min(length, _LOOK_BYTES))
            if kind == _COMPRESSED:
                head = _View(memoryview(_inflated(head, _LOOK_BYTES)), order).skipped(8)
            elif kind != _MATRIX:
                raise DamagedError(f"there is no variable at byte {start}")
            entry = _entry(_View(memoryview(head), order), start)
            if entry.name:  # what has none is MATLAB's own
                found.append(entry)
            start += 8 + length
    return found


def value(path: Path, entry: Entry) -> Any:
    """The value of a variable: an array of numbers (its shape), of str for char (rows,), of object for a cell array; a
    Struct or Strange. Raises DamagedError."""
    with path.open("rb") as stream:
        order = _order(stream)
        stream.seek(entry.start)
        kind, length, _ = _tag(_View(memoryview(stream.read(8)), order))
        content = stream.read(length)
    if kind == _COMPRESSED:
        _, size, _ = _tag(_View(memoryview(_inflated(content, 8)), order))
        check_unpacked(path, size, f"'{entry.name}'")
        content = _View(memoryview(_inflated(content, size + 8)), order).skipped(8)
    return _matrix(_View(memoryview(content), order))


@dataclass
class _View:
    """Bytes that are used up from the left."""

    data: memoryview
    order: str
    """"<" or ">"."""

    def take(self, count: int) -> memoryview:
        if count > len(self.data):
            raise DamagedError("a length in it is larger than what is left")
        taken, self.data = self.data[:count], self.data[count:]
        return taken

    def skipped(self, count: int) -> bytes:
        """What is left after the first `count` bytes."""
        self.take(count)
        return bytes(self.data)


def _order(stream: BinaryIO) -> str:
    return "<" if stream.read(_HEADER_BYTES)[126:128] == b"IM" else ">"


def _inflated(content: bytes, most: int) -> bytes:
    try:
        return zlib.decompressobj().decompress(content, most)
    except zlib.error as error:
        raise DamagedError(f"a variable cannot be decompressed: {error}") from None


def _tag(view: _View) -> tuple[int, int, bool]:
    """Type and length of the next element, and whether it is in the short form, whose data follow in four bytes."""
    kind = int(np.frombuffer(view.take(4), f"{view.order}u4")[0])
    if kind >> 16:
        return kind & 0xFFFF, kind >> 16, True
    return kind, int(np.frombuffer(view.take(4), f"{view.order}u4")[0]), False


def _element(view: _View) -> tuple[int, memoryview]:
    """Type and data of the next element. Raises DamagedError."""
    kind, length, short = _tag(view)
    if short and length > 4:
        raise DamagedError("a short element is longer than four bytes")
    data = view.take(length)
    view.take(min(4 - length if short else -length % 8, len(view.data)))  # padding, which the last one may lack
    return kind, data


def _numbers(view: _View) -> NDArray[Any]:
    kind, data = _element(view)
    if kind not in _NUMBERS:
        raise DamagedError(f"numbers of an unknown type {kind}")
    dtype = np.dtype(view.order + _NUMBERS[kind])
    if len(data) % dtype.itemsize:
        raise DamagedError("an array ends within a number")
    return np.frombuffer(data, dtype)


def _text(view: _View) -> str:
    kind, data = _element(view)
    if kind not in _TEXTS:
        raise DamagedError(f"a text of an unknown type {kind}")
    codec = _TEXTS[kind] + ({"<": "-le", ">": "-be"}[view.order] if _TEXTS[kind][-1] in "62" else "")
    try:
        return bytes(data).decode(codec)
    except UnicodeDecodeError as error:
        raise DamagedError(f"a text is not {codec} ({error.reason})") from None


def _head(view: _View) -> tuple[int, bool, tuple[int, ...], str]:
    """Class, whether complex, shape and name of a matrix; of an object of a class its words instead of a shape."""
    flags = _numbers(view)
    if len(flags) != 2:
        raise DamagedError("a variable without flags")
    number = int(flags[0]) & 0xFF
    if number == _OPAQUE:
        return number, False, (), _text(view)
    shape = tuple(map(int, _numbers(view)))
    if len(shape) < 2 or min(shape) < 0:
        raise DamagedError(f"a variable of shape {shape}")
    return number, bool(int(flags[0]) & 0x800), shape, _text(view)


def _entry(view: _View, start: int) -> Entry:
    number, is_complex, shape, name = _head(view)
    if number == _OPAQUE:
        _text(view)  # the system of types, MCOS
        return Entry(name, (), f"a MATLAB {_text(view)}", start)
    kinds = {_CELL: "cell", _STRUCT: "struct", _CHAR: "char", **dict.fromkeys(_NUMERIC, "numbers"), **_IN_WORDS}
    kind = "an array of complex numbers" if is_complex else kinds.get(number)
    if kind is None:
        raise DamagedError(f"a variable of an unknown class {number}")
    return Entry(name, shape, kind, start)


def _matrix(view: _View) -> Any:
    """The value of a matrix element without its tag."""
    number, is_complex, shape, _ = _head(view)
    count = math.prod(shape)
    if is_complex:
        return Strange("an array of complex numbers")
    if number in _NUMERIC:
        numbers = _numbers(view)
        if len(numbers) != count:
            raise DamagedError(f"{len(numbers)} numbers for a shape of {shape}")
        return numbers.reshape(shape, order="F")
    if number == _CHAR:
        return _rows_of_text(_text(view) if count else "", shape)
    if number == _CELL:
        _check_cells(view, count)
        cells = np.empty(count, dtype=object)
        for k, cell in enumerate(_matrices(view, count)):
            cells[k] = cell
        return cells.reshape(shape, order="F")
    if number == _STRUCT:
        return _struct(view, shape)
    return Strange(_IN_WORDS.get(number, "a MATLAB object"))


def _check_cells(view: _View, count: int) -> None:
    """A cell has a tag of eight bytes at least; where there are many, as many as MATLAB writes of an empty one. Raises
    DamagedError."""
    if count * (8 if count < _MANY_CELLS else _EMPTY_CELL_BYTES) > len(view.data):
        raise DamagedError("it has fewer cells than its shape says")


def _matrices(view: _View, count: int) -> Iterator[Any]:
    for _ in range(count):
        kind, data = _element(view)
        if kind != _MATRIX:
            raise DamagedError("a cell or field holds no variable")
        yield _matrix(_View(data, view.order)) if len(data) else np.empty((0, 0))  # left empty when it was made


def _rows_of_text(text: str, shape: tuple[int, ...]) -> NDArray[Any]:
    rows = shape[0] if math.prod(shape) else 0
    if rows <= 1:
        return np.array([text] * rows, dtype=object)
    if len(text) != math.prod(shape):
        raise DamagedError(f"{len(text)} characters for a shape of {shape}")
    return np.array([text[k::rows] for k in range(rows)], dtype=object)


def _struct(view: _View, shape: tuple[int, ...]) -> Struct:
    width = int(_numbers(view).sum())
    kind, data = _element(view)
    if kind != 1 or width < 1 or len(data) % width:
        raise DamagedError("the names of a struct's fields")
    names = [bytes(data[k : k + width]).split(b"\0")[0].decode("latin-1") for k in range(0, len(data), width)]
    fields: dict[str, list[Any]] = {name: [] for name in names}
    _check_cells(view, math.prod(shape) * len(names))
    for k, inner in enumerate(_matrices(view, math.prod(shape) * len(names))):
        fields[names[k % len(names)]].append(inner)
    return Struct(shape, fields)
