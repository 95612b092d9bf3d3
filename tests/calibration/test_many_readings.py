"""Results of very many readings: a small result.json, and Parquet tables beside it that it names."""

from __future__ import annotations

import json
import warnings
from pathlib import Path

import polars as pl
import pytest
from tests.cli_runs import write_lengths

import ulna
from ulna import Result, UlnaInputError
from ulna.calibration import result as result_module
from ulna.calibration.result_file import ResultFile

FOSSIL = Path(__file__).parents[1] / "data" / "fossils" / "result-1.json"
MANY = Path(__file__).parents[1] / "data" / "fossils" / "result-1-many"
BESIDE = {"residuals.parquet", "artefacts.parquet"}


@pytest.fixture
def few_are_many(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(result_module, "MANY_ROWS", 5)


@pytest.fixture
def saved(tmp_path: Path, few_are_many: None) -> Path:
    Result.load(FOSSIL).save(tmp_path / "out")
    return tmp_path / "out"


def test_nothing_is_lost_in_tables_beside(saved: Path) -> None:
    old, new = Result.load(FOSSIL), Result.load(saved)
    assert {path.name for path in saved.iterdir()} == {"result.json", "arm.toml", *BESIDE}
    ResultFile.model_validate_json((saved / "result.json").read_text())
    document = json.loads((saved / "result.json").read_text())
    assert "residuals" not in document
    assert document["residuals_file"]["rows"] == 78
    assert new.residuals.equals(old.residuals)
    assert list(new.artefacts) == list(old.artefacts)
    assert (new.parameters, new.fit, new.before, new.after) == (old.parameters, old.fit, old.before, old.after)


def test_one_more_than_few_is_many(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    old = Result.load(FOSSIL)
    for most, name in ((78, "residuals.csv"), (77, "residuals.parquet")):
        monkeypatch.setattr(result_module, "MANY_ROWS", most)
        old.save(tmp_path, force=True)
        # the table of the run before is gone: it would be another's
        assert {path.name for path in tmp_path.iterdir()} == {"result.json", "arm.toml", name}


def test_a_table_of_an_earlier_run_is_not_left_without_force(saved: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = {path: path.read_bytes() for path in saved.iterdir()}
    for name in ("result.json", "arm.toml"):
        (saved / name).rename(saved.parent / name)
    monkeypatch.setattr(result_module, "MANY_ROWS", 1000)
    with pytest.raises(UlnaInputError, match=r"residuals\.parquet: exists already"):
        Result.load(FOSSIL).save(saved)
    assert {path.name: path.read_bytes() for path in saved.iterdir()} == {
        path.name: content for path, content in before.items() if path.name in BESIDE
    }


def test_tables_are_read_when_they_are_asked_for(saved: Path) -> None:
    (saved / "residuals.parquet").unlink()
    found = Result.load(saved)
    assert found.fit.readings == 78
    assert len(found.artefacts) == len(Result.load(FOSSIL).artefacts)
    with pytest.raises(UlnaInputError, match=r"residuals\.parquet: no such file, but .*\.json keeps 78 rows"):
        _ = found.residuals


@pytest.mark.parametrize("name", sorted(BESIDE))
def test_a_table_of_another_run_is_told(saved: Path, name: str) -> None:
    table = pl.read_parquet(saved / name)
    table.reverse().write_parquet(saved / name)
    found = Result.load(saved)
    with pytest.raises(UlnaInputError, match=f"{name}: is not the file that was written with .*result.json"):
        _ = (found.residuals, found.artefacts)


def test_a_table_in_another_folder_is_refused(saved: Path) -> None:
    document = json.loads((saved / "result.json").read_text())
    document["residuals_file"]["file"] = "../residuals.parquet"
    (saved / "result.json").write_text(json.dumps(document))
    with pytest.raises(UlnaInputError, match="another folder"):
        _ = Result.load(saved).residuals


def test_the_fossil_with_tables_beside_is_read() -> None:
    old, found = Result.load(FOSSIL), Result.load(MANY)
    assert found.residuals.equals(old.residuals)
    assert list(found.artefacts) == list(old.artefacts)


def test_a_calibration_is_the_same_however_late_it_is_read(tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        study = ulna.Study.load(write_lengths(tmp_path))
    late, early = ulna.calibrate(study), ulna.calibrate(study)
    assert early.residuals.height == 101
    early.save(tmp_path / "early")
    late.save(tmp_path / "late")

    def document(name: str) -> dict[str, object]:
        found = json.loads((tmp_path / name / "result.json").read_text())
        return found | {"provenance": found["provenance"] | {"time": None, "duration_s": None}}

    assert document("early") == document("late")
    with pytest.raises(AttributeError, match="no attribute 'residual'"):
        _ = late.residual  # type: ignore[attr-defined]
