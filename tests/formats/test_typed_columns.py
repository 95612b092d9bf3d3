"""Columns of types and places that nobody expects: each a message that names the column, or the values themselves."""

from __future__ import annotations

import subprocess
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from tests.cli_runs import assert_bad_input, run
from tests.small_study import SmallStudy

N = 40
RNG = np.random.default_rng(0)
ANGLES = {f"q{k}": RNG.uniform(0.6, 2.9, N) for k in range(1, 4)}


def same(value: object, kind: pa.DataType, by: pa.DataType | None = None) -> pa.Array:
    return pa.array([value] * N, by or pa.int64()).cast(kind)


COLUMNS: dict[str, tuple[str, pa.Array]] = {
    "a date beyond dates": ("id", same(2**31 - 1, pa.date32(), pa.int32())),
    "a duration": ("id", same(1001, pa.duration("ns"))),
    "a list": ("placement", pa.array([[1.0]] * N)),
    "a struct": ("placement", pa.array([{"a": 1.0}] * N)),
    "bytes that are no text": ("placement", pa.array([b"\xff"] * N, pa.binary())),
    "an angle that is a duration": ("q1", same(1001, pa.duration("ns"))),
    "an angle that is a long duration": ("q1", same(2**62, pa.duration("s"))),
    "an angle that is a time long ago": ("q1", same(-(2**62), pa.timestamp("us"))),
    "an angle that is a date beyond dates": ("q1", same(2**31 - 1, pa.date32(), pa.int32())),
}


@pytest.fixture
def small(tmp_path: Path) -> SmallStudy:
    return SmallStudy(tmp_path)


@pytest.mark.parametrize("name", COLUMNS)
@pytest.mark.parametrize("command", ["measure", "identify"])
def test_parquet(small: SmallStudy, tmp_path: Path, name: str, command: str) -> None:
    column, values = COLUMNS[name]
    pq.write_table(
        pa.table({key: pa.array(each) for key, each in ANGLES.items()} | {column: values}), tmp_path / "bars.csv"
    )
    said(run("measure", *files(tmp_path)) if command == "measure" else run("identify", tmp_path / "study.toml"))


def files(folder: Path, name: str = "bars.csv") -> list[str]:
    return [str(folder / "arm.toml"), str(folder / name), "--probe", "bent"]


def said(done: subprocess.CompletedProcess[str]) -> None:
    """It is used, or refused in one sentence of ours."""
    assert done.returncode in (0, 2), done.stderr
    if done.returncode == 2:
        assert done.stderr.splitlines()[-1].startswith("error: ")
        assert done.stderr.rstrip()[-1] in ".?"
    for others in ("Traceback", "panicked", "PyErr", "polars."):
        assert others not in done.stderr


def test_a_zone_that_is_nowhere(small: SmallStudy, tmp_path: Path) -> None:
    """Of a column that nobody uses."""
    columns = {key: pa.array(each) for key, each in ANGLES.items()}
    pq.write_table(pa.table({**columns, "when": same(10**9, pa.timestamp("ms", "No/X"))}), tmp_path / "q.parquet")
    said(run("measure", *files(tmp_path, "q.parquet")))


def virtual(file: h5py.File) -> None:
    layout = h5py.VirtualLayout(shape=(N,), dtype="f8")
    layout[:] = h5py.VirtualSource("moved-away.h5", "x", shape=(N,))
    file.create_virtual_dataset("q1", layout)


def external(file: h5py.File) -> None:
    file.create_dataset("q1", shape=(N,), dtype="f8", external=[("raw.bin", 0, 8 * N)])


def unwritten(file: h5py.File) -> None:
    file.create_dataset("q1", shape=(N,), dtype="f8")


def unwritten_blocks(file: h5py.File) -> None:
    file.create_dataset("q1", shape=(N,), dtype="f8", chunks=(10,))[:25] = 1.0


def unwritten_fields(file: h5py.File) -> None:
    file.create_dataset("q1", shape=(N,), dtype="f8", chunks=(7,), compression="gzip")


SOURCES: dict[Callable[[h5py.File], None], str] = {
    virtual: "stand in other files (moved-away.h5)",
    external: "stand in other files (raw.bin)",
    unwritten: "1 of 1 blocks of 'q1' were never written",
    unwritten_blocks: "1 of 4 blocks of 'q1' were never written",
    unwritten_fields: "6 of 6 blocks of 'q1' were never written",
}


@pytest.mark.parametrize("make", SOURCES)
def test_hdf5_whose_values_are_not_there(small: SmallStudy, tmp_path: Path, make: Callable[[h5py.File], None]) -> None:
    """HDF5 reads zeros for them without a word."""
    with h5py.File(tmp_path / "q.h5", "w") as file:
        for key in ("q2", "q3"):
            file[key] = ANGLES[key]
        make(file)
    assert_bad_input(run("measure", *files(tmp_path, "q.h5")), "q.h5", SOURCES[make])


def test_hdf5_that_is_written_in_blocks_is_read(small: SmallStudy, tmp_path: Path) -> None:
    with h5py.File(tmp_path / "q.h5", "w") as file:
        for key, values in ANGLES.items():
            file.create_dataset(key, data=values, chunks=(7,), compression="gzip")
    assert run("measure", *files(tmp_path, "q.h5")).returncode == 0
