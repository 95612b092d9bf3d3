"""MAT files of versions 4 and 5."""

from __future__ import annotations

import io
from collections.abc import Callable
from random import Random
from typing import Any

from fuzzing.cells import Table

_HEAD_BYTES = 116


def mat_bytes(table: Table, source: Random) -> bytes:
    """Variables of any class: cells, structs, sparse, characters, logical, complex."""
    import numpy as np
    import scipy.io

    held: dict[str, Any] = {}
    for name, values in zip(table.names, table.columns(), strict=True):
        held[name] = _variable(values, source, np)
    if source.random() < 0.2:
        held = {"run": held}
    stream = io.BytesIO()
    scipy.io.savemat(
        stream,
        held,
        format=source.choice(["5", "5", "5", "4"]),
        do_compression=source.random() < 0.4,
        long_field_names=True,
        oned_as=source.choice(["row", "column"]),
    )
    return _timeless(stream.getvalue())


def _timeless(content: bytes) -> bytes:
    """The text at the head of version 5 says when it was written."""
    head = b"MATLAB 5.0 MAT-file Platform: posix"
    return head.ljust(_HEAD_BYTES) + content[_HEAD_BYTES:] if content.startswith(head[:10]) else content


def _variable(values: list[Any], source: Random, np: Any) -> Any:
    if all(isinstance(value, int | float) for value in values):
        data = np.array(values)
    else:
        data = np.empty((len(values), 1), dtype=object)
        data[:, 0] = ["" if value is None else value for value in values]
    return _strange(data, source, np) if source.random() < 0.1 else data


def _strange(data: Any, source: Random, np: Any) -> Any:
    import scipy.sparse

    ways: list[Callable[[], Any]] = [
        lambda: data.reshape(1, -1),
        lambda: data.reshape(-1, 1, 1),
        lambda: np.zeros((2, 2, 2)),
        lambda: np.zeros((0, 0)),
        lambda: scipy.sparse.csc_array(np.eye(len(data) or 1)),
        lambda: data.astype(source.choice(["f4", "i1", "u8", "c16", "?"])),
        lambda: {"a": data, "b": {"c": data}},
        lambda: "a text",
        lambda: np.array(["ab", "c", ""]),
        lambda: np.zeros(len(data), [("a", "f8")]),
        lambda: np.full(len(data), np.nan),
        lambda: [[1, 2], [3]],
    ]
    return source.choice(ways)()
