"""Labels of very many rows: each label once, and a number for each row."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from ulna.ground.arrays import I64, Bool


class Labels:
    """(N,) str, as an array of objects would hold them, without an object for each row. Immutable.

    It has the manners of such an array: ``labels[3]`` is a str, ``labels[mask]`` are Labels, ``labels == "left"`` is
    (N,) bool, ``labels.tolist()`` and ``numpy.asarray(labels)`` give the labels themselves.
    """

    __slots__ = ("codes", "names")
    __hash__ = None  # type: ignore[assignment]  # as arrays have none

    def __init__(self, codes: I64, names: Sequence[str]) -> None:
        """codes: (N,) index into `names`, of which each stands there once; some may not occur."""
        self.codes = codes
        self.names = names

    @classmethod
    def of(cls, values: Labels | Iterable[Any]) -> Labels:
        """From one label for each row."""
        if isinstance(values, Labels):
            return values
        seen: dict[str, int] = {}
        codes = np.fromiter((seen.setdefault(str(value), len(seen)) for value in values), np.int64)
        return cls(codes, list(seen))

    @classmethod
    def all_alike(cls, name: str, count: int) -> Labels:
        """One label for all rows."""
        return cls(np.zeros(count, dtype=np.int64), [name])

    @classmethod
    def joined(cls, parts: Sequence[Labels]) -> Labels:
        """One after the other; what is called alike is one label."""
        seen: dict[str, int] = {}
        codes = []
        for part in parts:
            new = np.array([seen.setdefault(name, len(seen)) for name in part.names], dtype=np.int64)
            codes.append(new[part.codes])
        return cls(np.concatenate(codes), list(seen))

    def as_they_appear(self) -> tuple[I64, list[str]]:
        """(N,) numbers counted in the order in which the labels appear, and the labels in that order."""
        first = np.full(len(self.names), len(self), dtype=np.int64)
        first[self.codes[::-1]] = np.arange(len(self))[::-1]  # of several rows the last one written stays: the first
        order = np.argsort(first, kind="stable")
        order = order[: np.count_nonzero(first < len(self))]
        number = np.zeros(len(self.names), dtype=np.int64)
        number[order] = np.arange(len(order))
        return number[self.codes], [self.names[k] for k in order.tolist()]

    def tolist(self) -> list[str]:
        """Each row's label."""
        names = self.names
        return [names[code] for code in self.codes.tolist()]

    def __len__(self) -> int:
        return len(self.codes)

    def __iter__(self) -> Iterator[str]:
        return iter(self.tolist())

    @overload
    def __getitem__(self, index: int | np.integer[Any]) -> str: ...
    @overload
    def __getitem__(self, index: slice | Bool | I64) -> Labels: ...
    def __getitem__(self, index: Any) -> str | Labels:
        found = self.codes[index]
        return Labels(found, self.names) if isinstance(found, np.ndarray) else self.names[found]

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        return np.array(self.tolist(), dtype=object if dtype is None else dtype)

    def __eq__(self, other: object) -> Any:
        if isinstance(other, str):
            return np.array([name == other for name in self.names], dtype=bool)[self.codes]
        return np.asarray(self) == np.asarray(other)

    def __ne__(self, other: object) -> Any:
        return ~(self == other)

    def __repr__(self) -> str:
        return f"Labels of {len(self)} rows: {', '.join(map(repr, self.names[:5]))}{', …' * (len(self.names) > 5)}"
