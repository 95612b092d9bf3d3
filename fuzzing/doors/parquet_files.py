"""Parquet, and Arrow and Feather, which are read as nothing."""

from __future__ import annotations

import io
from random import Random
from typing import Any

from fuzzing.cells import Table


def parquet_bytes(table: Table, source: Random) -> bytes:
    """Columns of any type that Arrow has."""
    import pyarrow as pa
    import pyarrow.parquet

    stored = _arrow(table, source)
    stream = io.BytesIO()
    pyarrow.parquet.write_table(
        stored,
        stream,
        row_group_size=source.choice([1, 2, 1000]),
        compression=source.choice(["none", "snappy", "gzip", "zstd"]),
        use_dictionary=source.random() < 0.5,
        store_schema=source.random() < 0.7,
    )
    del pa
    return stream.getvalue()


def arrow_bytes(table: Table, source: Random) -> bytes:
    import pyarrow as pa
    import pyarrow.feather

    stored = _arrow(table, source)
    stream = io.BytesIO()
    if source.random() < 0.5:
        pyarrow.feather.write_feather(stored, stream, version=source.choice([1, 2]))
    else:
        with pa.ipc.new_stream(stream, stored.schema) as writer:
            writer.write_table(stored)
    return stream.getvalue()


def _arrow(table: Table, source: Random) -> Any:
    import pyarrow as pa

    columns = []
    for values in table.columns():
        columns.append(_column(values, source, pa))
    return pa.Table.from_arrays(columns, names=table.names)


def _column(values: list[Any], source: Random, pa: Any) -> Any:
    """As it is, or of another type where that can be."""
    if source.random() < 0.85:
        try:
            return pa.array(values)
        except (pa.ArrowException, OverflowError):
            return pa.array([None if value is None else str(value) for value in values])
    kind = source.choice(_types(pa))
    try:
        return pa.array(values).cast(kind, safe=False)
    except (pa.ArrowException, OverflowError):
        return _made(len(values), kind, source, pa)


def _made(count: int, kind: Any, source: Random, pa: Any) -> Any:
    if source.random() < 0.3:
        return pa.nulls(count, kind)
    for sample in (1, 1.5, "x", b"\xff", [1.0, 2.0], {"a": 1}, True, [("a", 1)]):
        try:
            return pa.array([sample] * count, kind)
        except (pa.ArrowException, TypeError, ValueError, OverflowError):
            continue
    return pa.nulls(count, kind)


def _types(pa: Any) -> list[Any]:
    return [
        pa.int8(),
        pa.uint8(),
        pa.int16(),
        pa.int32(),
        pa.uint64(),
        pa.float16(),
        pa.float32(),
        pa.float64(),
        pa.bool_(),
        pa.string(),
        pa.large_string(),
        pa.string_view(),
        pa.binary(),
        pa.binary(3),
        pa.null(),
        pa.date32(),
        pa.date64(),
        pa.timestamp("ns"),
        pa.timestamp("s", "Nowhere/Atall"),
        pa.timestamp("us", "UTC"),
        pa.time32("s"),
        pa.time64("ns"),
        pa.duration("ms"),
        pa.decimal128(10, 2),
        pa.decimal256(60, 5),
        pa.list_(pa.float64()),
        pa.list_(pa.float64(), 2),
        pa.struct([("a", pa.int64())]),
        pa.map_(pa.string(), pa.int64()),
        pa.dictionary(pa.int32(), pa.string()),
        pa.dictionary(pa.int8(), pa.float64()),
        pa.month_day_nano_interval(),
    ]
