"""Calibrations of a record, compared: called by their days, and as found and as left where that is known."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.cli_runs import run, strict_json
from tests.records.benches import ROOT

from ulna import UlnaInputError
from ulna.records.records import Records


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example, calibrated."""
    out = tmp_path_factory.mktemp("compare") / "out"
    assert run("calibrate", ROOT / "examples" / "platinum" / "study.toml", "-o", out).returncode == 0
    return out / "result.json"


@pytest.fixture
def years(records: Records, result: Path, tmp_path: Path) -> Records:
    """Three calibrations of P8, which are the same; an adjustment between the last two, on the day of the last."""
    records.register("P8")
    for n, day in enumerate(("2026-01-10", "2026-06-10", "2026-12-10")):
        (tmp_path / str(n)).mkdir()
        for path in result.parent.iterdir():
            (tmp_path / str(n) / path.name).write_bytes(path.read_bytes() + b"\n" * n * (path.name == result.name))
        records.add(tmp_path / str(n) / result.name, arm="P8", at=f"{day}T12:00+00:00")
    records.event("P8", "knock", "fell", at="2026-03-01")
    records.event("P7", "repair", "of another arm", at="2026-11-01")
    records.event("P8", "adjustment", "zeros set anew", at="2026-12-10T11:00+00:00")
    return records


def test_what_was_done_between_them_is_said(years: Records) -> None:
    first, second = years.compare("P8", 3).steps
    assert (first.between, "as found" in first.before, "as left" in first.after) == ([], False, False)
    assert second.before.startswith("2026-06-10, as found (")
    assert second.after.startswith("2026-12-10, as left (")
    assert second.between == ["adjustment on 2026-12-10, zeros set anew"]
    assert not second.moved
    with pytest.raises(UlnaInputError, match="has 1 calibration that converged; expected two"):
        years.compare("P7")


def test_it_is_said_in_words_numbers_and_pictures(years: Records, tmp_path: Path) -> None:
    picture = tmp_path / "moved.svg"
    words = ["record", "compare", "P8", "--records", years.bench.folder]
    done = run(*words, "--picture", picture)
    assert done.returncode == 0, done.stderr
    said = " ".join(done.stdout.split())
    assert "Between them: adjustment on 2026-12-10, zeros set anew." in said
    assert "2026-06-10, as found (" in said
    drawn = picture.read_text()
    assert "as found" in drawn
    assert "as left" in drawn
    (step,) = strict_json(run(*words, "--json").stdout)["steps"]
    assert step["between"] == ["adjustment on 2026-12-10, zeros set anew"]
    assert "changes" not in step
    assert run(*words, "--picture", picture).returncode == 2, "it is there already"
