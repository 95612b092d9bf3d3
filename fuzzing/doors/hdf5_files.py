"""HDF5."""

from __future__ import annotations

import io
from random import Random
from typing import Any

from fuzzing.cells import Table


def hdf5_bytes(table: Table, source: Random) -> bytes:
    """Data sets of any type and shape, in groups, with links that lead nowhere."""
    import h5py
    import numpy as np

    stream = io.BytesIO()
    with h5py.File(stream, "w") as file:
        group = file if source.random() < 0.6 else file.create_group("run")
        for name, values in zip(table.names, table.columns(), strict=True):
            data = _array(values, np)
            if source.random() < 0.1:
                data = _strange(data, source, np)
            if source.random() < 0.05:
                group[name] = h5py.SoftLink(source.choice(["/nowhere", "/", ".", f"/{name}"]))
            elif source.random() < 0.03:
                group[name] = h5py.ExternalLink("nowhere.h5", "/x")
            elif source.random() < 0.03:
                group.create_dataset(name, shape=(len(values),), dtype=source.choice(["f8", "i4", "f2"]), chunks=(2,))
            else:
                group.create_dataset(
                    name, data=data, **source.choice([{}, {}, {"compression": "gzip"} if data.ndim else {}])
                )
    return stream.getvalue()


def _array(values: list[Any], np: Any) -> Any:
    if all(isinstance(value, int | float) for value in values):
        return np.array(values)
    import h5py

    return np.array(["" if value is None else str(value) for value in values], dtype=h5py.string_dtype())


def _strange(data: Any, source: Random, np: Any) -> Any:
    ways = [
        lambda: data.reshape(-1, 1),
        lambda: data.reshape(1, -1),
        lambda: data.reshape(1, -1, 1),
        lambda: data[:1].reshape(()),
        lambda: data[:0],
        lambda: np.concatenate([data, data]),
        lambda: np.stack([data, data], axis=1),
        lambda: data.astype(source.choice(["f2", "f4", ">f8", "i1", "u8", "c16", "?", "S3", "g"])),
        lambda: np.zeros(len(data), [("a", "f8"), ("b", "i4")]),
        lambda: np.array([b"\xff\xfe"] * len(data)),
        lambda: np.zeros((len(data), 40)),
        lambda: np.full(len(data), np.nan),
    ]
    return source.choice(ways)()
