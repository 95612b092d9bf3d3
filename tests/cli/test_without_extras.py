"""The program as somebody has it who installed no extra: what everybody needs works, and gives the same; what needs
more says so in one sentence before it begins."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.cli_runs import assert_bad_input, platinum, run, write_lengths

from ulna.ground.extras import EXTRAS, PACKAGES, lacking, need

LACKING = [package for packages in EXTRAS.values() for package in packages]
#: Python without those packages: None in sys.modules is what the import system knows as "not there"
WITHOUT = f"import sys; sys.modules.update(dict.fromkeys({LACKING!r}))\n"
EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "platinum"


def bare(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """A run of the program without any of them."""
    return subprocess.run(
        [sys.executable, "-c", WITHOUT + "from ulna.__main__ import main; main()", *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=120,
        env=os.environ | {"COLUMNS": "80", "TERM": "dumb"},
        check=False,
    )


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example, calibrated without extras."""
    folder = tmp_path_factory.mktemp("bare") / "result"
    done = bare("calibrate", EXAMPLES / "study.toml", "-o", folder)
    assert done.returncode == 0, done.stderr
    return folder / "result.json"


def test_what_everybody_needs_is_there(result: Path, tmp_path: Path) -> None:
    for arguments in (
        ["identify", EXAMPLES / "study.toml"],
        ["evaluate", result, EXAMPLES / "check.toml", "-o", tmp_path / "evaluated"],
        ["cross-validate", EXAMPLES / "study.toml", "--by", "3"],
        ["report", result, "--html", "-o", tmp_path / "report.html"],
        ["certificate", result, EXAMPLES / "laboratory.toml", "--dcc", "-o", tmp_path / "certificate.xml"],
        ["uncertainty", result, EXAMPLES / "length.toml", "--trials", "2000"],
        ["uncertainty", result, EXAMPLES / "volume.toml"],
        ["verify", "--make-plan", "iso-10360-12", "--play", EXAMPLES / "truth.toml", "-o", tmp_path / "test"],
        ["verify", result, tmp_path / "test" / "plan.toml"],
        ["export", "dh", result, "-o", tmp_path / "dh.csv"],
        ["reproduce"],
    ):
        done = bare(*arguments)
        assert done.returncode in (0, 1), f"{arguments}: {done.stderr}"
        assert "not installed" not in done.stderr


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_points_are_the_same_with_and_without(result: Path, tmp_path: Path, ending: str) -> None:
    readings = tmp_path / f"q.{ending}"
    q = np.random.default_rng(0).uniform(-2, 2, (30_000, 7))
    frame = pl.DataFrame({f"q{k + 1}": q[:, k] for k in range(7)} | {"id": [f"Nr {k}" for k in range(len(q))]})
    frame.write_csv(readings) if ending == "csv" else frame.write_parquet(readings)
    for program, name in ((run, "with.csv"), (bare, "without.csv")):
        done = program("measure", result, readings, "-o", tmp_path / name)
        assert done.returncode == 0, done.stderr
    assert (tmp_path / "with.csv").read_bytes() == (tmp_path / "without.csv").read_bytes()


def test_a_bad_cell_of_a_long_table_is_named_the_same(result: Path, tmp_path: Path) -> None:
    rows = ["q1,q2,q3,q4,q5,q6,q7", *["0.1,0.2,0.3,0.4,0.5,0.6,0.7"] * 3000]
    for at, row in ((1500, "0.1,0.2,x,0.4,0.5,0.6,0.7"), (2500, "0.1,0.2")):
        (tmp_path / "q.csv").write_text("\n".join([*rows[:at], row, *rows[at:]]) + "\n")
        done, expected = (program("measure", result, tmp_path / "q.csv") for program in (bare, run))
        assert_bad_input(done, f"row {at}")
        assert done.stderr == expected.stderr


def test_what_needs_more_says_which_extra(result: Path, tmp_path: Path) -> None:
    search = tmp_path / "search"
    study = write_lengths(search, noise="[noise]\nencoder = 5e-6", fit='method = "annealing"')
    (tmp_path / "q.h5").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(100))
    platinum().save(tmp_path / "arm.toml")
    out = tmp_path / "out"
    for extra, arguments in (
        ("reports", ["report", result, "--pdf", "-o", out]),
        ("reports", ["plan", EXAMPLES / "platinum.toml", EXAMPLES / "plan.toml", "-o", out]),
        ("reports", ["uncertainty", result, EXAMPLES / "volume.toml", "-o", out]),
        ("reports", ["reproduce", "cheng2011", "-o", out]),
        ("reports", ["reproduce", "all", "-o", out]),
        ("search", ["calibrate", study, "-o", out]),
        ("tables", ["measure", tmp_path / "arm.toml", tmp_path / "q.h5"]),
        ("tables", ["measure", tmp_path / "arm.toml", EXAMPLES / "bars.csv", "-o", tmp_path / "out.parquet"]),
        ("records", ["record", "init", out]),
        ("records", ["calibrate", EXAMPLES / "study.toml", "-o", out, "--record", "P7"]),
        ("workbench", ["workbench", out, "--no-open"]),
        ("mqtt", ["live", "watch", "mqtt://host/topic"]),
        ("ros", ["live", "watch", "bag:run.mcap"]),
        ("opcua", ["live", "watch", "opc.tcp://host:4840"]),
        ("dask", ["batch", EXAMPLES, "--dask", "tcp://127.0.0.1:1", "-o", out]),
    ):
        done = bare(*arguments)
        assert_bad_input(done, f"ulna[{extra}]")
        assert "not installed" in done.stderr
        assert len(done.stderr.strip().splitlines()) == 1
        assert not out.exists()
        assert not (tmp_path / "out.parquet").exists()


def test_pictures_of_a_test_need_reports_and_leave_nothing(result: Path, tmp_path: Path) -> None:
    made = bare("verify", "--make-plan", "iso-10360-12", "--play", EXAMPLES / "truth.toml", "-o", tmp_path / "test")
    assert made.returncode == 0, made.stderr
    assert_bad_input(bare("verify", result, tmp_path / "test" / "plan.toml", "-o", tmp_path / "out"), "ulna[reports]")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["test"]


def test_no_module_but_those_that_draw_or_keep_records_needs_an_extra() -> None:
    code = WITHOUT + (
        "import importlib, pkgutil, ulna\n"
        "for each in pkgutil.walk_packages(ulna.__path__, 'ulna.'):\n"
        "    if each.name not in ('ulna.__main__',):\n"
        "        try:\n            importlib.import_module(each.name)\n"
        "        except ModuleNotFoundError as error:\n            print(each.name, error.name)\n"
    )
    done = subprocess.run([sys.executable, "-W", "ignore", "-c", code], capture_output=True, text=True, check=True)
    needy = dict(line.split() for line in done.stdout.splitlines())
    draws = re.compile(
        r"ulna\.ground\.style|ulna\.[\w.]+\.plots?|ulna\.documents\.(pdf|drawn|work_sheet)(\.\w+)?|ulna\.documents\.plotted|"
        r"ulna\.formats\.tables\.(arrow|hdf5_apart)|ulna\.(records|serve)(\.\w+)*|ulna\.cli\.printed\.(records|trends)"
    )
    assert [name for name in needy if not draws.fullmatch(name)] == []
    assert {package.split(".")[0] for package in needy.values()} <= {
        "matplotlib",
        "pyarrow",
        "h5py",
        "sqlalchemy",
        "alembic",
        "fastapi",
        "uvicorn",
        "authlib",
        "httpx2",
    }


def test_the_extras_are_those_of_the_project(root: Path) -> None:
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    for extra, packages in EXTRAS.items():
        named = {re.split(r"[^\w-]", each)[0].lower() for each in project["optional-dependencies"][extra]}
        named.discard("ulna")  # what it brings of another extra
        assert named == {PACKAGES.get(package, package).lower() for package in packages}
    base = {re.split(r"[^\w-]", each)[0].lower().replace("-", "_") for each in project["dependencies"]}
    assert base.isdisjoint({package.lower() for package in LACKING})


def test_the_sentence() -> None:
    assert lacking("numpy") is None
    assert 'pip install "ulna[search]"' in str(lacking("scipy.optimize"))
    need("anything", "json")
