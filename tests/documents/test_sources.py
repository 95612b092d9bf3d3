"""Where a report's content comes from: the study by path and SHA-256, held-out readings, and what is missing."""

from __future__ import annotations

import hashlib
import json
import shutil
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.cli_runs import platinum, write_lengths
from tests.documents.test_html import Page
from tests.pdf_reading import Pdf, holds
from tests.reports import calibrated, seats_study

import ulna
from ulna import UlnaInputError
from ulna.documents.gather import gather
from ulna.documents.html.page import render
from ulna.documents.pdf.render import render as render_pdf

FOSSILS = Path(__file__).resolve().parents[1] / "data" / "fossils"


@pytest.fixture
def result(tmp_path: Path) -> Path:
    return calibrated(write_lengths(tmp_path / "study"))


def test_a_study_that_is_gone_is_said_to_be_missing(result):
    shutil.rmtree(result.parent.parent.parent / "gone", ignore_errors=True)
    (result.parent.parent / "study.toml").unlink()
    content = gather(result)
    assert content.clouds == []
    assert content.quiver is None
    assert content.missing["study"].key == "study.absent"
    assert content.missing["study"].values["study"].endswith("study.toml")
    assert {file.state for file in content.provenance.files} == {"not-compared"}
    assert content.artefacts[0].u_mm is None
    assert content.parameters.rows  # what the result says by itself is there
    assert content.samples


def test_a_study_that_changed_is_not_used(result):
    rows = result.parent.parent / "rows.csv"
    rows.write_text(rows.read_text() + "\n", encoding="utf-8")
    content = gather(result)
    assert content.missing["study"].key == "study.changed"
    assert content.missing["study"].values["files"].endswith("rows.csv")
    assert content.clouds == []
    states = {Path(file.path).name: file.state for file in content.provenance.files}
    assert states == {"study.toml": "same", "start.toml": "same", "rows.csv": "changed"}


def test_another_study_by_name_is_refused(result, tmp_path):
    other = write_lengths(tmp_path / "other", rows=60)
    with pytest.raises(UlnaInputError, match="was not made from it, or its files have changed since"):
        gather(result, study=other)


def test_a_study_that_moved_is_found_by_name(result, tmp_path):
    moved = tmp_path / "moved"
    shutil.move(result.parent.parent, moved)
    assert gather(moved / "out").missing["study"].key == "study.absent"
    content = gather(moved / "out", study=moved / "study.toml")
    assert "study" not in content.missing
    assert content.clouds


def test_paths_are_looked_for_beside_the_result_too(tmp_path, monkeypatch):
    seats_study(tmp_path / "a")
    monkeypatch.chdir(tmp_path / "a")
    ulna.calibrate(ulna.Study.load("study.toml")).save(".")
    monkeypatch.chdir(tmp_path)
    content = gather(tmp_path / "a" / "result.json")
    assert "study" not in content.missing
    assert {file.state for file in content.provenance.files} == {"same"}


def test_no_held_out_readings_and_no_test_are_said(result):
    content = gather(result)
    assert [said.key for said in content.held_out] == ["held-out.none"]
    assert {"held-out", "verification", "laboratory", "temperature"} <= set(content.missing)
    assert {row.readings for row in content.quality} == {"fitted"}


def test_rows_that_the_study_keeps_are_held_out(tmp_path):
    study = write_lengths(tmp_path)
    rows = pl.read_csv(tmp_path / "rows.csv")
    marked = pl.Series(["train"] * 60 + ["test"] * 41)
    rows.with_columns(marked.alias("set")).write_csv(tmp_path / "rows.csv")
    text = study.read_text(encoding="utf-8")
    split = 'split = { column = "set", fit = "train", check = "test" }\n'
    study.write_text(text.replace("[artefact", split + "[artefact", 1), encoding="utf-8")
    result = calibrated(study)
    content = gather(result)
    row = next(row for row in content.quality if (row.quantity, row.readings) == ("length_error", "check"))
    arm = ulna.Arm.load(result)
    q, p = (rows.select([f"{letter}{k}" for k in range(1, 8)]).to_numpy()[60:] for letter in "qp")
    error = np.linalg.norm(arm.tip(q) - arm.tip(p), axis=1) - rows["length"].to_numpy()[60:]
    assert row.after.rms_mm == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-9)
    start = ulna.Arm.load(tmp_path / "start.toml")
    old = np.linalg.norm(start.tip(q) - start.tip(p), axis=1) - rows["length"].to_numpy()[60:]
    assert row.before.max_mm == pytest.approx(np.abs(old).max(), rel=1e-9)
    assert [(said.key, said.values["readings"]) for said in content.held_out] == [("held-out.check", 41)]
    assert "held-out" not in content.missing
    assert len(content.readings.row) == 60


def test_a_cross_validation_is_held_out(result, tmp_path):
    study = ulna.Study.load(result.parent.parent / "study.toml")
    found = ulna.cross_validate(study, by=4)
    found.save(tmp_path / "cv")
    content = gather(result, cross_validation=tmp_path / "cv" / "cross-validation.json")
    row = next(row for row in content.quality if row.readings == "left-out")
    assert row.after.rms_mm == found.after["length_error_rms_mm"]
    assert row.before.max_mm == abs(found.before["length_error_max_abs_mm"])
    assert [said.key for said in content.held_out] == ["held-out.left-out"]
    other = gather(
        calibrated(write_lengths(tmp_path / "b", rows=80)), cross_validation=tmp_path / "cv" / "cross-validation.json"
    )
    assert [said.key for said in other.held_out] == ["held-out.left-out", "held-out.other-study"]


def test_an_evaluation_is_held_out_unless_its_readings_were_fitted(result, tmp_path):
    other = write_lengths(tmp_path / "fresh", rows=30)
    arm = ulna.Arm.load(result)
    found = ulna.evaluate(arm, ulna.Study.load(other))
    found.save(tmp_path / "e")
    content = gather(result, evaluation=tmp_path / "e" / "evaluation.json")
    row = next(row for row in content.quality if row.readings == "evaluated")
    assert row.before is None
    assert row.after.rms_mm == found.overall["length_error_rms_mm"]
    assert [said.key for said in content.held_out] == ["held-out.evaluated"]
    ulna.evaluate(arm, ulna.Study.load(result.parent.parent / "study.toml")).save(tmp_path / "same")
    content = gather(result, evaluation=tmp_path / "same" / "evaluation.json")
    assert [said.key for said in content.held_out] == ["held-out.evaluated", "held-out.same-readings"]


def test_an_evaluation_is_of_this_arm_and_no_other(result, tmp_path):
    fresh = ulna.Study.load(write_lengths(tmp_path / "fresh", rows=30))
    ulna.evaluate(ulna.Arm.load(result.parent / "arm.toml"), fresh).save(tmp_path / "toml")
    content = gather(result, evaluation=tmp_path / "toml" / "evaluation.json")
    assert [said.key for said in content.held_out] == ["held-out.evaluated"]

    ulna.evaluate(fresh.arm, fresh).save(tmp_path / "start")
    wrong = tmp_path / "start" / "evaluation.json"
    with pytest.raises(
        UlnaInputError, match=r"is an evaluation of another arm.*parameters\.joint.*expected.*in the result"
    ):
        gather(result, evaluation=wrong)
    document = json.loads(wrong.read_text(encoding="utf-8"))
    assert document["parameters"] == dict(zip(fresh.arm.parameter_names, fresh.arm.parameters.tolist(), strict=True))

    document["parameters"] = {}
    wrong.write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(UlnaInputError, match="is missing, expected"):
        gather(result, evaluation=wrong)
    del document["parameters"]  # as earlier versions wrote it
    wrong.write_text(json.dumps(document), encoding="utf-8")
    assert [said.key for said in gather(result, evaluation=wrong).held_out] == [
        "held-out.evaluated",
        "held-out.unknown-arm",
    ]


def test_files_of_held_out_readings_have_their_hashes(result, tmp_path):
    study = ulna.Study.load(result.parent.parent / "study.toml")
    ulna.cross_validate(study, by=4).save(tmp_path / "cv")
    ulna.evaluate(ulna.Arm.load(result), study).save(tmp_path / "e")
    files = (tmp_path / "cv" / "cross-validation.json", tmp_path / "e" / "evaluation.json")
    content = gather(result, cross_validation=files[0], evaluation=files[1])
    digests = {file.name: hashlib.sha256(file.read_bytes()).hexdigest() for file in files}
    assert {file.name: file.sha256 for file in content.provenance.beside} == digests
    page = render(content)
    paper = Pdf(render_pdf(content))
    for digest in digests.values():
        assert digest in page
        holds(paper, digest)


def test_wrong_files_are_told(result, tmp_path):
    with pytest.raises(UlnaInputError, match='another kind of file; expected format = "ulna-cross-validation/1"'):
        gather(result, cross_validation=result)
    with pytest.raises(UlnaInputError, match="no such file; expected an evaluation"):
        gather(result, evaluation=tmp_path / "none.json")


def test_an_old_result_has_a_report_too():
    content = gather(
        FOSSILS / "result-1.json",
        cross_validation=FOSSILS / "cross-validation-1.json",
        evaluation=FOSSILS / "evaluation-1.json",
    )
    assert content.missing["study"].key in ("study.absent", "study.changed", "study.in-memory")
    assert content.quality
    assert content.parameters.rows


def test_surfaces_have_no_vectors(tmp_path):
    arm = platinum()
    rng = np.random.default_rng(3)
    directions = rng.normal(size=(60, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    at = np.array([300.0, 100.0, 300.0]) + (12.5 + 3.0) * directions + rng.normal(0, 0.01, (60, 3))
    q, reached = arm.core.pose_for_points(at, np.tile([-3.0, 3.0], (7, 1)), 3)
    pl.DataFrame({f"q{k + 1}": q[reached][:, k] for k in range(7)}).write_csv(tmp_path / "ball.csv")
    arm.save(tmp_path / "arm.toml")
    text = (tmp_path / "arm.toml").read_text(encoding="utf-8")
    (tmp_path / "arm.toml").write_text(text.replace("[probe.bent]", "[probe.bent]\nball = 6.0"), encoding="utf-8")
    study = tmp_path / "study.toml"
    study.write_text(
        'format = "ulna-study/1"\narm = "arm.toml"\nunits = { length = "mm", angle = "rad" }\n'
        '[[readings]]\nfile = "ball.csv"\nartefact = "ball"\nangle = "rad"\n'
        '[artefact.ball]\nkind = "sphere"\ndiameter = 25.0\nu = 0.0005\n[fit]\nfree = ["joint.3.theta0"]\n',
        encoding="utf-8",
    )
    content = gather(calibrated(study))
    assert content.quiver is None
    assert {cloud.over for cloud in content.clouds} == {"reach"}
    assert {"joint", "quiver", "lengths"} <= set(content.missing)
    assert [sample.kind for sample in content.samples] == ["distance"]
    assert (content.artefacts[0].dimension, content.artefacts[0].value_mm, content.artefacts[0].u_mm) == (
        "diameter",
        25.0,
        0.0005,
    )
    worst = next(row for row in content.quality if row.quantity == "diameter_error")
    assert np.isnan(worst.after.two_sigma_mm)


def test_as_many_readings_as_parameters(tmp_path):
    """No degrees of freedom: no uncertainty can be estimated, and the result and its report say so."""
    study = write_lengths(tmp_path, rows=25, fit='hold = ["joint.1.theta0", "joint.1.d"]')
    content = gather(calibrated(study))
    assert content.fit.degrees_of_freedom == 0
    assert np.isnan(content.parameters.k)
    assert all(row.u is None and row.expanded is None for row in content.parameters.rows)
    assert content.parameters.correlation_names == []
    assert content.missing["correlation"].key == "missing.correlation"
    assert content.identification.weak == []
    words = " ".join("".join(Page(render(content)).words).split())
    assert "There are no degrees of freedom, so no uncertainty can be estimated." in words


def test_nothing_fitted(tmp_path):
    study = write_lengths(tmp_path, fit='hold = ["*"]')
    platinum().save(tmp_path / "start.toml", force=True)  # the arm that the readings are of
    content = gather(calibrated(study))
    assert {"correlation", "observability"} <= set(content.missing)
    words = " ".join("".join(Page(render(content)).words).split())
    assert "Nothing was fitted: every parameter is held." in words
    assert "there are no observability indices" in words


def test_a_result_in_memory_says_what_its_files_say(tmp_path: Path) -> None:
    """Its study goes along; from its files that is found by its path, or given in memory."""
    study = write_lengths(tmp_path)
    result = ulna.calibrate(study)
    result.save(tmp_path / "out")
    in_memory = gather(result)
    assert in_memory.provenance.result == "result in memory"
    assert in_memory.clouds
    for other in (gather(tmp_path / "out"), gather(tmp_path / "out", ulna.Study.load(study))):
        assert other.parameters.rows == in_memory.parameters.rows
        assert [each.x.tolist() for each in other.clouds] == [each.x.tolist() for each in in_memory.clouds]
        assert [file.state for file in other.provenance.files] == [file.state for file in in_memory.provenance.files]
    other_study = write_lengths(tmp_path / "other", rows=90)
    with pytest.raises(UlnaInputError, match="was not made from it"):
        gather(result, ulna.Study.load(other_study))
    with pytest.raises(TypeError, match="got a Study, expected a result"):
        gather(result.study)  # type: ignore[arg-type]
