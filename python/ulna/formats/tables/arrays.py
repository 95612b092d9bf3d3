"""Files of named arrays (MAT, HDF5) as tables.

An array of shape (N,), (N, 1) or (1, N) is one column of its name; of shape (N, k) the columns NAME1 … NAMEk. Arrays
of other lengths, or of what is no column at all, may lie beside them: they are an error only where they are needed.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import NDArray

from ulna.formats.cells import bad_cell, names_of
from ulna.formats.header import Header, Numeric, Piece
from ulna.formats.layout import Layout
from ulna.formats.unpacked import NUMBER_BYTES, TEXT_BYTES, check_unpacked
from ulna.ground.errors import UlnaInputError, nearest

NUMBERS, TEXTS = "numbers", "texts"

#: an array has at most so many elements for each byte of its file: zlib makes of 1032 bytes one at best, others of more
MOST_COMPRESSED = 8 * 1032
#: a wider array is a picture or the like, but no table
MOST_COLUMNS = 10_000
_PIECE_BYTES = 32 << 20


@dataclass(frozen=True)
class Variable:
    """One named array, its values not yet read."""

    name: str
    shape: tuple[int, ...]
    """As its writer counts: rows first, also where the file stores it otherwise."""
    kind: str
    """`NUMBERS`, `TEXTS`, or what it is instead, in words: "a struct"."""
    read: Callable[[], Any]
    """The values: an array of `shape`, of numbers or of str. Raises whatever the library raises for a damaged file."""
    rows: Callable[[int, int], Any] | None = None
    """The same from the first of two rows to before the last (counted from 0), where that costs no more than these."""


class NoTextError(Exception):
    """A cell of a cell array that is no text. ``str(error)`` says so."""


@dataclass(frozen=True)
class Column:
    """One column of a variable."""

    variable: Variable
    index: int | None
    """Which of the variable's columns; None where it has only one."""
    length: int


def columns_of(variables: Sequence[Variable], path: Path) -> list[tuple[str, Column]]:
    """The columns that variables make, by name. What can be no column keeps its name, and length 0."""
    most = MOST_COMPRESSED * path.stat().st_size
    found = []
    for variable in variables:
        shape = variable.shape or (1,)
        count = math.prod(shape)
        wide = len(shape) == 2 and shape[0] != 1 and shape[1] > MOST_COLUMNS
        if variable.kind in (NUMBERS, TEXTS) and (len(shape) > 2 or wide or count > most):
            kind = f"an array of {_shape(variable)}" + (", more than the file can hold" if count > most else "")
            variable = dataclasses.replace(variable, kind=kind)
        if variable.kind not in (NUMBERS, TEXTS):
            found.append((variable.name, Column(variable, None, 0)))
        elif len(shape) == 1 or 1 in shape:
            found.append((variable.name, Column(variable, None, count)))
        else:
            found += [(f"{variable.name}{k + 1}", Column(variable, k, shape[0])) for k in range(shape[1])]
    return found


@dataclass(frozen=True)
class ArrayTable(Header):
    """Columns out of named arrays."""

    parts: Mapping[str, Column] = field(repr=False)
    """By the file's name of the column."""
    further: str = field(default="", kw_only=True)
    held: Callable[[], AbstractContextManager[Any]] = field(default=nullcontext, kw_only=True, repr=False)
    """Within it the file stays open."""

    @classmethod
    def of(
        cls,
        variables: Sequence[Variable],
        path: Path,
        layout: Layout,
        inner: Sequence[str],
        what: str,
        held: Callable[[], AbstractContextManager[Any]] = nullcontext,
    ) -> ArrayTable:
        """The columns that variables make; inner: paths of what lies further in. Raises UlnaInputError where there are
        none."""
        columns = columns_of(variables, path)
        if not columns:
            raise no_arrays(path, layout, inner)
        names = [name for name, _ in columns]
        inner = [name for name in inner if not name.startswith(("#", "_"))]  # what libraries put there for themselves
        if not inner:
            return cls(path, names, parts=dict(columns), what=what, held=held)
        told = f"{_some(inner)}: {layout.say('dataset', inner[0])} reads that"
        remark = f"{path}: not read: what is in {told}."
        further = f" There is more in {told}."
        return cls(path, names, parts=dict(columns), what=what, remarks=[remark], further=further, held=held)

    def counted(self) -> int | None:
        lengths = {self.parts[self.own(name)].length for name in self.columns if name.startswith("q")}
        return lengths.pop() if len(lengths) == 1 else None

    def cells(self, numeric: Numeric, columns: Sequence[str]) -> pl.DataFrame:
        parts = self._checked(numeric, columns)
        values: dict[int, NDArray[Any]] = {}
        with self.held():
            for part in parts.values():
                if id(part.variable) not in values:
                    values[id(part.variable)] = self._values(part.variable)
        return self._columns(parts, values, numeric)

    def pieces(self, numbers: Sequence[str], texts: Sequence[str], rows: int) -> Iterator[Piece]:
        def numeric(column: str) -> bool:
            return column in numbers

        columns = [*numbers, *texts]
        parts = self._checked(numeric, columns)
        variables = {id(part.variable): part.variable for part in parts.values()}
        if not all(variable.rows for variable in variables.values()) or not parts:
            yield from super().pieces(numbers, texts, rows)
            return
        length = next(iter(parts.values())).length
        widest = max(math.prod(variable.shape) // length for variable in variables.values()) if length else 1
        step = max(1, min(rows, _PIECE_BYTES // (8 * widest)))
        with self.held():
            for before in range(0, length, step):
                band = (before, min(length, before + step))
                values = {key: self._values(variable, band) for key, variable in variables.items()}
                frame = self.checked(self._columns(parts, values, numeric), numeric, before=before)
                yield self.piece(frame, numbers, texts, before)

    def _checked(self, numeric: Numeric, columns: Sequence[str]) -> dict[str, Column]:
        """Where some columns are. Raises UlnaInputError where they cannot be read, or not together."""
        parts = {name: self.parts[self.own(name)] for name in columns}
        for name, part in parts.items():
            if part.variable.kind not in (NUMBERS, TEXTS):
                raise UlnaInputError(
                    f"{self.path}: {self.named(name)}: is {part.variable.kind}; expected a column of numbers or names. "
                    "Write it as a plain array with one row for each reading."
                )
            if part.variable.kind == TEXTS and numeric(name):
                raise UlnaInputError(
                    f"{self.path}: {self.named(name)}: holds texts; expected numbers. Write it as an array of numbers."
                )
        self._check_lengths(parts)
        each = {id(part.variable): part.variable for part in parts.values()}
        size = sum(
            math.prod(variable.shape) * (TEXT_BYTES if variable.kind == TEXTS else NUMBER_BYTES)
            for variable in each.values()
        )
        check_unpacked(self.path, size, f"the values of {_some([variable.name for variable in each.values()])}")
        return parts

    def _columns(
        self, parts: Mapping[str, Column], values: Mapping[int, NDArray[Any]], numeric: Numeric
    ) -> pl.DataFrame:
        """Columns of the values of their variables."""
        found = []
        for name, part in parts.items():
            array = values[id(part.variable)]
            column = array.reshape(-1) if part.index is None else array[:, part.index]
            if part.variable.kind == NUMBERS:
                exact = column.dtype.kind in "iub" and not numeric(name)
                series = pl.Series(name, np.array(column, dtype=np.int64 if exact else np.float64))
                found.append(series if numeric(name) else names_of(series))
            else:
                found.append(pl.Series(name, column.tolist(), dtype=pl.String))
        return pl.DataFrame(found)

    def _check_lengths(self, parts: Mapping[str, Column]) -> None:
        lengths: dict[int, list[str]] = {}
        for name, part in parts.items():
            lengths.setdefault(part.length, []).append(self.own(name))
        if len(lengths) > 1:
            most = max(lengths, key=lambda length: len(lengths[length]))
            other = next(length for length in lengths if length != most)
            raise UlnaInputError(
                f"{self.path}: {_some(lengths[other])} {'have' if len(lengths[other]) > 1 else 'has'} {other} "
                f"row{'s' * (other != 1)} and {_some(lengths[most])} {'have' if len(lengths[most]) > 1 else 'has'} "
                f"{most}; expected one value of each for every reading. Correct the arrays, or give another name to "
                "what does not belong to the readings."
            )

    def _values(self, variable: Variable, rows: tuple[int, int] | None = None) -> NDArray[Any]:
        """All of them, or some rows."""
        shape = variable.shape or (1,)
        if rows is not None:
            shape = (rows[1] - rows[0],) if 1 in shape or len(shape) == 1 else (rows[1] - rows[0], *shape[1:])
        try:
            if rows is None or variable.rows is None:
                values = np.asarray(variable.read())
            else:
                values = np.asarray(variable.rows(*rows))
        except (MemoryError, UlnaInputError):
            raise
        except (NoTextError, UnicodeDecodeError) as error:
            why = "texts that are not UTF-8" if isinstance(error, UnicodeDecodeError) else str(error)
            raise UlnaInputError(
                f"{self.path}: '{variable.name}': {why}; expected one name for each reading. Write it as UTF-8 texts."
            ) from None
        except Exception as error:  # a damaged file: the libraries raise whatever they stumble over
            raise unreadable(self.path, f"'{variable.name}'", error) from None
        if values.size != math.prod(shape) or np.iscomplexobj(values):
            what = "complex numbers" if np.iscomplexobj(values) else f"{values.size} values of {_shape(variable)}"
            raise UlnaInputError(
                f"{self.path}: '{variable.name}': {what}; expected plain numbers or names. Write it again."
            )
        return values.reshape(shape)

    def refusal(self, row: int, column: str, numeric: Numeric) -> str:
        part = self.parts[self.own(column)]
        band = (row - 1, row) if part.variable.rows is not None else None
        array, at = self._values(part.variable, band), 0 if band else row - 1
        value = array.reshape(-1)[at] if part.index is None else array[at, part.index]
        return bad_cell(self, row, column, str(value), numeric)

    def origin(self, column: str) -> str:
        part = self.parts.get(self.own(column))
        if part is None:
            return ""
        plain = part.variable.kind in (NUMBERS, TEXTS)
        return f"'{part.variable.name}' is {_shape(part.variable) if plain else part.variable.kind}"


def _shape(variable: Variable) -> str:
    return " × ".join(map(str, variable.shape if len(variable.shape) > 1 else (*variable.shape, 1)))


def _some(names: Sequence[str]) -> str:
    return ", ".join(names[:4]) + (", …" if len(names) > 4 else "")


def unreadable(path: Path, what: str, error: Exception, expected: str = "a column") -> UlnaInputError:
    """The message about a damaged file."""
    reason = " ".join(str(error).split())[:160] or type(error).__name__
    return UlnaInputError(
        f"{path}: {what} cannot be read ({reason}); expected {expected}. The file is damaged: write it again."
    )


def no_such_part(path: Path, layout: Layout, known: Sequence[str]) -> UlnaInputError:
    """The message about a key `dataset` that names nothing."""
    return UlnaInputError(
        f"{layout.key('dataset')}: got '{layout.dataset}', which {path} does not have."
        f"{nearest((layout.dataset or '').strip('/'), known)} Correct it."
    )


def no_arrays(path: Path, layout: Layout, inner: Sequence[str]) -> UlnaInputError:
    """The message where nothing can be a column, but what is further in may be."""
    at = f"at '{layout.dataset}'" if layout.dataset else "at the top of the file"
    if inner:
        return UlnaInputError(
            f"{path}: there are no arrays {at}, only {_some(inner)}; expected to be told where the columns are. Say "
            f"{layout.say('dataset', inner[0])}, or whichever it is."
        )
    return UlnaInputError(f"{path}: there are no arrays {at}; expected columns. Name another file or place.")
