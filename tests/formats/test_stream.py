"""Streaming tables: the same numbers as read at once, the bad cell named, and memory that does not follow the file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from ulna.formats.table import count_rows, read_header, stream
from ulna.ground.errors import UlnaInputError

Q = ["q1", "q2", "q3"]


def table(rows: int, seed: int = 0) -> pl.DataFrame:
    rng = np.random.default_rng(seed)
    return pl.DataFrame({name: rng.uniform(-3, 3, rows) for name in Q} | {"id": [f"n{k}" for k in range(rows)]})


def collect(path: Path, texts: list[str] | None = None, rows: int = 1 << 16) -> tuple[np.ndarray, list[str]]:
    pieces = list(stream(read_header(path), Q, ["id"] if texts is None else texts, rows))
    assert [piece.before for piece in pieces] == np.cumsum([0, *(len(piece) for piece in pieces[:-1])]).tolist()
    ids = [cell for piece in pieces for column in piece.texts.values() for cell in column]
    return np.concatenate([piece.numbers for piece in pieces]), ids


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_all_rows_in_order(tmp_path: Path, suffix: str) -> None:
    frame = table(70_000)
    path = tmp_path / f"readings.{suffix}"
    frame.write_csv(path) if suffix == "csv" else frame.write_parquet(path, row_group_size=9_999)
    numbers, ids = collect(path, rows=4_096)
    assert (numbers == frame.select(Q).to_numpy()).all()
    assert ids == frame["id"].to_list()
    assert count_rows(read_header(path)) == (0 if suffix == "csv" else 70_000)


def test_parquet_of_other_number_types(tmp_path: Path) -> None:
    path = tmp_path / "readings.parquet"
    pl.DataFrame({"q1": [1, 2], "q2": pl.Series([0.5, 1.5], dtype=pl.Float32), "q3": [0.0, 1.0]}).write_parquet(path)
    numbers, _ = collect(path, texts=[])
    assert numbers.tolist() == [[1.0, 0.5, 0.0], [2.0, 1.5, 1.0]]


def test_one_huge_row_group_is_read_in_bounded_memory(tmp_path: Path) -> None:
    rows = 3_000_000
    rng = np.random.default_rng(1)
    path = tmp_path / "huge.parquet"
    pq.write_table(pa.table({name: rng.uniform(-3, 3, rows) for name in Q}), path, row_group_size=rows)
    assert pq.read_metadata(path).num_row_groups == 1
    pool = pa.default_memory_pool()
    before = pool.bytes_allocated()
    most = 0
    for _ in stream(read_header(path), Q, []):
        most = max(most, pool.bytes_allocated() - before)
    assert path.stat().st_size > 70e6
    assert most < 20e6


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
@pytest.mark.parametrize(
    ("value", "expected"), [(float("nan"), "finite number|empty"), (float("inf"), "finite number")]
)
def test_one_bad_cell_far_in_is_named(tmp_path: Path, suffix: str, value: float, expected: str) -> None:
    frame = table(60_000)
    bad = frame.with_columns(q2=pl.when(pl.int_range(pl.len()) == 54_320).then(value).otherwise("q2"))
    path = tmp_path / f"readings.{suffix}"
    bad.write_csv(path) if suffix == "csv" else bad.write_parquet(path)
    with pytest.raises(UlnaInputError, match=rf"readings\.{suffix}: row 54321\b.*column 'q2'.*({expected})"):
        collect(path)


@pytest.mark.parametrize(
    ("cell", "expected"),
    [
        ("abc", "got 'abc', expected a number"),
        ("", "cell is empty"),
        ('"1,5"', "decimal comma"),
        ("1,5", "has 5 cells"),
    ],
)
def test_one_bad_cell_of_a_csv_is_named_as_written(tmp_path: Path, cell: str, expected: str) -> None:
    lines = table(60_000).write_csv().splitlines()
    cells = lines[50_000].split(",")
    lines[50_000] = ",".join([cells[0], cell, *cells[2:]])
    path = tmp_path / "readings.csv"
    path.write_text("\n".join(lines) + "\n")
    with pytest.raises(UlnaInputError, match=rf"row 50000 \(line 50001 of the file\).*{expected}"):
        collect(path)


def test_gap_in_a_parquet_name(tmp_path: Path) -> None:
    frame = table(100).with_columns(id=pl.when(pl.int_range(pl.len()) == 41).then(None).otherwise("id"))
    path = tmp_path / "readings.parquet"
    frame.write_parquet(path)
    with pytest.raises(UlnaInputError, match="row 42, column 'id': the cell is empty"):
        collect(path)


def test_text_where_numbers_belong(tmp_path: Path) -> None:
    path = tmp_path / "readings.parquet"
    pl.DataFrame({"q1": ["1"], "q2": [1.0], "q3": [1.0]}).write_parquet(path)
    with pytest.raises(UlnaInputError, match=r"row 1, column 'q1'.*expected a number"):
        collect(path, texts=[])


def test_harmless_spellings_are_read(tmp_path: Path) -> None:
    frame = table(30_000)
    lines = frame.write_csv().splitlines()
    lines[20_000] = "  ".join(["", *lines[20_000].split(",")[:1]]) + " ," + lines[20_000].split(",", 1)[1]
    path = tmp_path / "readings.csv"
    path.write_bytes(b"\xef\xbb\xbf" + ("\r\n".join(lines) + "\r\n\r\n").encode())
    numbers, ids = collect(path)
    assert (numbers == frame.select(Q).to_numpy()).all()
    assert ids == frame["id"].to_list()
