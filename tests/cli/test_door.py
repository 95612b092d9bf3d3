"""The program's manners: help, slips of the finger, pipes, full disks, Ctrl-C."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.cli_runs import assert_bad_input, platinum, run, strict_json, write_lengths


def test_reproduce_lists_studies() -> None:
    done = run("reproduce")
    assert done.returncode == 0, done.stderr
    for name in ("cheng2011", "shimojima2002", "all"):
        assert name in done.stdout
        assert name in strict_json(run("reproduce", "--json").stdout)["studies"]
    assert_bad_input(run("reproduce", "gao2010"), "Did you mean 'gao2009'?")


def test_unknown_command_and_option_name_the_nearest() -> None:
    assert_bad_input(run("calibrat", "x.toml"), "Did you mean 'calibrate'?")
    assert_bad_input(run("calibrate", "x.toml", "--froce"), "--force")


@pytest.mark.parametrize(
    "command",
    [
        "show",
        "calibrate",
        "identify",
        "evaluate",
        "measure",
        "cross-validate",
        "reproduce",
        "import mukca",
        "import urdf",
        "import dh",
        "export urdf",
        "export dh",
    ],
)
def test_each_help_has_an_example(command: str) -> None:
    done = run(*command.split(), "--help")
    assert done.returncode == 0, done.stderr
    assert f"ulna {command} " in done.stdout.split("Example", 1)[1]
    assert max(len(line) for line in done.stdout.splitlines()) <= 80


@pytest.mark.parametrize("arguments", [["--help"], ["calibrate", "--help"], ["demo", "--help"]], ids=" ".join)
def test_help_imports_nothing_heavy(arguments: list[str]) -> None:
    code = (
        f"import sys\nfrom ulna.cli import main\nsys.argv = ['ulna', *{arguments}]\n"
        "try:\n    main()\nexcept SystemExit:\n    pass\n"
        "heavy = ('numpy', 'polars', 'pyarrow', 'pydantic', 'scipy', 'matplotlib', 'rich', 'ulna._core')\n"
        "print([name for name in heavy if name in sys.modules], file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=True)
    assert done.stderr.strip() == "[]"


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX pipes")
def test_a_reader_who_has_seen_enough_is_no_error(tmp_path: Path) -> None:
    platinum().save(tmp_path / "arm.toml")
    q = np.random.default_rng(0).uniform(-3, 3, (200_000, 7))
    pl.DataFrame({f"q{k + 1}": q[:, k] for k in range(7)}).write_parquet(tmp_path / "q.parquet")
    command = f"{sys.executable} -m ulna measure {tmp_path}/arm.toml {tmp_path}/q.parquet | head -2"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=60, check=True)
    assert done.stderr == ""
    assert done.stdout.startswith("x,y,z\n")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full")
def test_a_full_disk_is_told(tmp_path: Path) -> None:
    study = write_lengths(tmp_path)
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "ulna", "calibrate", str(study)],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            timeout=60,
            check=False,
        )
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert "No space left" in done.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX limits")
@pytest.mark.parametrize(("command", "out"), [("calibrate", "out"), ("measure", "points.csv")])
def test_no_room_for_a_result_names_it(tmp_path: Path, command: str, out: str) -> None:
    import resource

    study = write_lengths(tmp_path)
    before = sorted(path.name for path in tmp_path.iterdir())
    inputs = [study] if command == "calibrate" else [tmp_path / "start.toml", tmp_path / "rows.csv"]
    done = subprocess.run(
        [sys.executable, "-B", "-m", "ulna", command, *map(str, inputs), "-o", str(tmp_path / out)],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000)),
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert_bad_input(done, f"error: {tmp_path / out}: cannot be written (File too large)")
    assert sorted(path.name for path in tmp_path.iterdir()) == before


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
def test_ctrl_c_leaves_nothing(tmp_path: Path) -> None:
    study = write_lengths(tmp_path, rows=3000, fit='start = "search"')
    # zero offsets so wrong, and lengths so noisy, that the search has work for long
    rows = pl.read_csv(tmp_path / "rows.csv")
    noise = pl.Series(np.random.default_rng(5).normal(0, 200, rows.height))
    rows.with_columns((pl.col("length") + noise).abs()).write_csv(tmp_path / "rows.csv")
    process = subprocess.Popen(
        [sys.executable, "-m", "ulna", "cross-validate", str(study), "--by", "1000", "-o", str(tmp_path / "out")],
        stderr=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    time.sleep(1.5)
    assert process.poll() is None, "the work was over before it could be interrupted"
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=20)
    assert process.returncode == 130
    assert out == ""
    assert "Interrupted" in err
    assert "Traceback" not in err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["rows.csv", "start.toml", "study.toml"]


@pytest.mark.skipif(sys.platform == "win32", reason="POSIX signals")
@pytest.mark.parametrize("out", ["points.csv", "points.parquet"])
@pytest.mark.parametrize(("sent", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_ctrl_c_while_writing_takes_the_half_written_file_away(
    tmp_path: Path, out: str, sent: signal.Signals, code: int
) -> None:
    platinum().save(tmp_path / "arm.toml")
    q = np.random.default_rng(0).uniform(-3, 3, (3_000_000, 7))
    pl.DataFrame({f"q{k + 1}": q[:, k] for k in range(7)}).write_parquet(tmp_path / "q.parquet")
    command = [sys.executable, "-m", "ulna", "measure", *(str(tmp_path / name) for name in ("arm.toml", "q.parquet"))]
    process = subprocess.Popen([*command, "-o", str(tmp_path / out)], stderr=subprocess.PIPE, text=True)
    while process.poll() is None and not list(tmp_path.glob(".points*")):
        time.sleep(0.002)
    process.send_signal(sent)
    _, err = process.communicate(timeout=20)
    assert process.returncode == code, "the work was over before it could be interrupted"
    assert "Interrupted" in err
    assert sorted(path.name for path in tmp_path.iterdir()) == ["arm.toml", "q.parquet"]


FAULTY = """import sys
from ulna.cli import main
from ulna.study.study import Study

def fail(_path):
    raise KeyError("of our own making")

Study.load = fail
sys.argv = ["ulna", "identify", "study.toml"]
main()
"""


def test_a_fault_of_ours_is_called_so(tmp_path: Path) -> None:
    """One line and an exit code of its own; where it came from on request. It is never taken for "the answer is no"."""
    done = subprocess.run([sys.executable, "-c", FAULTY], capture_output=True, text=True, cwd=tmp_path, check=False)
    assert done.returncode == 3
    assert done.stderr.count("\n") == 1
    assert "this is a fault of Ulna's" in done.stderr
    assert "KeyError: 'of our own making'" in done.stderr
    traced = subprocess.run(
        [sys.executable, "-c", FAULTY],
        capture_output=True,
        text=True,
        cwd=tmp_path,
        check=False,
        env=os.environ | {"ULNA_TRACEBACK": "1"},
    )
    assert "Traceback" in traced.stderr
    assert traced.stderr.rstrip().endswith("KeyError: 'of our own making'")
