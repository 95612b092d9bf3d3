"""Names that are not UTF-8, streams that are closed or know few letters, terminals that know nothing."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from tests.cli_runs import assert_bad_input, run, write_lengths

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="names of any bytes, as Linux has them")

NAME = os.fsdecode(b"st\xfcdy")


def under(words: str, **environment: str) -> subprocess.CompletedProcess[bytes]:
    """Of a shell's line; $U is the command."""
    return subprocess.run(
        ["sh", "-c", words],
        capture_output=True,
        timeout=60,
        env=os.environ | {"U": f"{sys.executable} -m ulna", "COLUMNS": "80", "TERM": "dumb"} | environment,
        check=False,
    )


def test_a_name_that_is_not_utf8_is_refused_by_name(tmp_path: Path) -> None:
    study = write_lengths(tmp_path)
    (tmp_path / NAME).mkdir()
    for file in ("study.toml", "start.toml", "rows.csv"):
        (tmp_path / NAME / file).write_bytes((tmp_path / file).read_bytes())
    for done in (
        run("calibrate", tmp_path / NAME / "study.toml"),
        run("measure", tmp_path / "start.toml", tmp_path / NAME / "rows.csv"),
        run("calibrate", study, "-o", tmp_path / NAME / "out"),
        run("measure", tmp_path / "start.toml", tmp_path / "rows.csv", "-o", tmp_path / f"{NAME}.csv"),
    ):
        assert_bad_input(done, "st\\xfcdy", "is not UTF-8", "Rename it.")
    assert not (tmp_path / NAME / "out").exists()


def test_in_a_batch_it_stops_no_other(tmp_path: Path) -> None:
    write_lengths(tmp_path / "arms" / "good")
    shutil.copytree(tmp_path / "arms" / "good", tmp_path / "arms" / NAME)
    done = run("batch", tmp_path / "arms", "-o", tmp_path / "out")
    assert done.returncode == 1, done.stderr
    said = json.loads((tmp_path / "out" / "batch.json").read_text())
    assert "st\\xfcdy" in json.dumps(said, ensure_ascii=False).replace("\\\\", "\\")
    assert (tmp_path / "out" / "good" / "study" / "result.json").exists()


@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&-", ">&- 2>&- <&-"])
def test_a_stream_that_is_closed_is_nobody_who_reads(tmp_path: Path, closed: str) -> None:
    """And no file of results takes its number: what is printed goes into none."""
    study = write_lengths(tmp_path)
    done = under(f"exec $U calibrate {study} -o {tmp_path / 'out'} {closed}")
    assert done.returncode == 0, done.stderr
    plain = under(f"exec $U calibrate {study} -o {tmp_path / 'plain'}")
    assert plain.returncode == 0
    for name in ("arm.toml", "residuals.csv"):
        assert (tmp_path / "out" / name).read_bytes() == (tmp_path / "plain" / name).read_bytes()


@pytest.mark.parametrize("encoding", ["ascii", "latin-1", "cp1252"])
def test_a_stream_of_few_letters_gets_what_it_knows(tmp_path: Path, encoding: str) -> None:
    study = write_lengths(tmp_path)
    (tmp_path / "start.toml").write_text((tmp_path / "start.toml").read_text().replace("virtual Platinum", "Ärmel 臂"))
    done = under(f"exec $U calibrate {study}", PYTHONIOENCODING=encoding)
    assert done.returncode == 0, done.stderr
    assert "Converged" in done.stdout.decode(encoding)
    machine = under(f"exec $U calibrate {study} --json", PYTHONIOENCODING=encoding)
    assert machine.returncode == 0, machine.stderr
    assert json.loads(machine.stdout.decode(encoding))["arm"]["name"] == "Ärmel 臂"
