"""`ulna measure` on other people's tables: the same points from every format, and bounded memory where it streams."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import polars as pl
import pyarrow as pa
import pytest
from tests.cli_runs import assert_bad_input, platinum, run
from tests.foreign_tables import WRITERS, dialect, sheet

import ulna
from ulna import InputWarning, UlnaInputError
from ulna.formats.layout import Layout
from ulna.formats.table import read_header, stream
from ulna.measuring.job import MeasureJob
from ulna.measuring.measure import measure_to_stream

Q = np.random.default_rng(5).uniform(-3, 3, (60, 7)).round(9)
TABLE = pl.DataFrame({f"q{k + 1}": Q[:, k] for k in range(7)}).with_columns(id=pl.Series([f"n{k}" for k in range(60)]))
HEADERLESS = {f"q{k}": f"c{k}" for k in range(1, 8)} | {"id": "c8"}

#: file → how it is written, as keywords and as options
LAYOUTS: dict[str, dict[str, object]] = {
    "commas.csv": {},
    "semicolons.csv": {"separator": ";", "decimal": ","},
    "tabs.txt": {"separator": "tab"},
    "bars.dat": {"separator": "|", "decimal": ",", "header": False, "columns": HEADERLESS},
    "table.parquet": {},
    "book.xlsx": {},
    "sheets.xlsx": {"sheet": "run 1"},
    "compressed.mat": {},
    "struct.mat": {"dataset": "setup/run"},
    "new.mat": {},
    "group.h5": {"dataset": "/run1"},
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    made = tmp_path_factory.mktemp("measure")
    platinum().save(made / "arm.toml")
    for name in LAYOUTS:
        WRITERS[name](TABLE, made / name)
    return made


def options(layout: dict[str, object]) -> list[str]:
    out = []
    for name, value in layout.items():
        if isinstance(value, dict):
            out += [word for ours, theirs in value.items() for word in ("--column", f"{ours}={theirs}")]
        else:
            out += ["--no-header"] if value is False else [f"--{name}", str(value)]
    return out


@pytest.mark.filterwarnings("ignore:.*not used")
@pytest.mark.parametrize("name", LAYOUTS)
def test_the_same_points_from_every_format(folder: Path, tmp_path: Path, name: str) -> None:
    arm = platinum()
    found = ulna.measure(arm, folder / name, **LAYOUTS[name])  # type: ignore[arg-type]
    assert found.table is not None
    assert found.table.columns == ["id", "x", "y", "z"]
    assert found.table["id"].to_list() == TABLE["id"].to_list()
    np.testing.assert_array_equal(found.table.select("x", "y", "z").to_numpy(), arm.tip(Q))
    ulna.measure(arm, folder / name, out=tmp_path / "p.parquet", **LAYOUTS[name])  # type: ignore[arg-type]
    assert pl.read_parquet(tmp_path / "p.parquet").equals(found.table)


@pytest.mark.parametrize("name", ["bars.dat", "sheets.xlsx", "struct.mat"])
def test_the_options_of_the_command(folder: Path, name: str) -> None:
    done = run("measure", folder / "arm.toml", folder / name, *options(LAYOUTS[name]))
    assert done.returncode == 0, done.stderr
    points = pl.read_csv(io.BytesIO(done.stdout.encode()))
    np.testing.assert_allclose(points.select("x", "y", "z").to_numpy(), platinum().tip(Q), rtol=0, atol=1e-9)


def test_what_the_command_is_told(folder: Path, tmp_path: Path) -> None:
    def told(name: str, *more: str) -> str:
        done = run("measure", folder / "arm.toml", folder / name, "-o", tmp_path / "out.csv", *more)
        assert_bad_input(done)
        assert list(tmp_path.iterdir()) == []
        return " ".join(done.stderr.split())

    assert 'Say --separator ";" (and --decimal "," where numbers have decimal commas)' in told("semicolons.csv")
    assert 'Say --decimal ",", or export' in told("semicolons.csv", "--separator", ";")
    assert 'Say --sheet "Sheet", or whichever' in told("sheets.xlsx")
    assert "--sheet: got 'run1', but" in told("sheets.xlsx", "--sheet", "run1")
    assert 'Say --dataset "/run1", or whichever' in told("group.h5")
    assert "--separator: " in told("book.xlsx", "--separator", ";")
    assert "--column: 'q8' is no column that Ulna knows" in told("commas.csv", "--column", "q8=id")
    assert "--column: got 'q1'; expected Ulna's name = the file's name" in told("commas.csv", "--column", "q1")
    assert "--no-header: says that the file does not name its columns" in told("commas.csv", "--no-header")
    assert "--decimal: got 'comma'; expected '.' or ','" in told("commas.csv", "--decimal", "comma")


def test_one_bad_cell_is_named_and_nothing_goes_out(tmp_path: Path) -> None:
    arm = platinum()
    arm.save(tmp_path / "arm.toml")
    sheet(TABLE, tmp_path / "b.xlsx", edit=lambda page: page.__setitem__("C41", None))
    out = io.BytesIO()
    with pytest.raises(UlnaInputError, match=r"row 40 \(Sheet1!C41\), column 'q3': the cell is empty"):
        measure_to_stream(MeasureJob(tmp_path / "arm.toml", tmp_path / "b.xlsx"), out)
    assert out.getvalue() == b""
    dialect(";", ",")(
        TABLE.with_columns(q3=pl.when(pl.int_range(60) == 39).then(99.5).otherwise("q3")), tmp_path / "b.csv"
    )
    with pytest.raises(UlnaInputError, match=r"row 40 \(line 41 of the file\), column 'q3': got 99.5 rad"):
        ulna.measure(arm, tmp_path / "b.csv", separator=";", decimal=",", out=tmp_path / "points.csv")
    assert not (tmp_path / "points.csv").exists()


def test_columns_by_other_names_are_told_by_theirs(tmp_path: Path) -> None:
    renamed = TABLE.rename({"q1": "base", "id": "note"}).with_columns(base=pl.lit("x"))
    renamed.write_csv(tmp_path / "r.csv")
    with (
        pytest.raises(UlnaInputError, match=r"row 1 \(line 2 of the file\), column 'base' \(q1\): got 'x'"),
        pytest.warns(InputWarning, match="not used: the column note"),
    ):
        ulna.measure(platinum(), tmp_path / "r.csv", columns={"q1": "base"})


def test_a_long_dialect_is_read_in_bounded_memory(tmp_path: Path) -> None:
    line = ";".join(f"{k / 7:.15f}".replace(".", ",") for k in range(3)) + ";remark\n"
    path = tmp_path / "long.csv"
    with path.open("w") as file:
        file.write("q1;q2;q3;remark\n")
        for _ in range(200):
            file.write(line * 10_000)
    header = read_header(path, layout=Layout.of_options(None, separator=";", decimal=","))
    pool = pa.default_memory_pool()
    before, most, rows = pool.bytes_allocated(), 0, 0
    for piece in stream(header, ["q1", "q2", "q3"], []):
        most = max(most, pool.bytes_allocated() - before)
        rows += len(piece)
    assert rows == 2_000_000
    assert path.stat().st_size > 100e6
    assert most < 50e6  # 37 MB, also for three times as many rows
