"""A folder of studies: each is calibrated by itself, what cannot be is told, what is done is kept."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from tests.cli_runs import assert_bad_input, run, strict_json

import ulna
from ulna.calibration.batch import studies_in
from ulna.formats.claimed import NAME, claimed


@pytest.fixture
def arms(tmp_path: Path, root: Path) -> Path:
    """Two good studies, a spoilt one, and files that are no studies."""
    folder = tmp_path / "arms"
    for name in ("press", "weld", "spoilt"):
        (folder / name).mkdir(parents=True)
        for file in ("study.toml", "platinum.toml", "bars.csv"):
            shutil.copy(root / "examples" / "platinum" / file, folder / name / file)
    study = folder / "spoilt" / "study.toml"
    study.write_text(study.read_text().replace("length =", "lenght ="))
    return folder


def test_a_spoilt_study_stops_no_other(arms: Path, tmp_path: Path) -> None:
    done = run("batch", arms, "-o", tmp_path / "out")
    assert done.returncode == 1
    lines = done.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    assert sum("converged" in line for line in lines) == 2
    assert "spoilt/study" in done.stdout
    assert "lenght" in done.stdout
    assert not (tmp_path / "out" / "spoilt").exists()
    found = json.loads((tmp_path / "out" / "batch.json").read_text("utf-8"))
    assert found["format"] == "ulna-batch/1"
    assert [(entry["name"], entry["status"]) for entry in found["studies"]] == [
        ("press/study", "converged"),
        ("spoilt/study", "refused"),
        ("weld/study", "converged"),
    ]
    alone = ulna.calibrate(ulna.Study.load(arms / "weld" / "study.toml"))
    result = ulna.Result.load(tmp_path / "out" / "weld" / "study")
    assert result.arm == alone.arm
    assert found["studies"][2]["rms_mm"] == pytest.approx(alone.fit.rms_mm, rel=1e-12)


@pytest.mark.parametrize("earlier", [False, True], ids=["none before", "an earlier list"])
def test_a_list_that_appears_meanwhile_stays(
    arms: Path, tmp_path: Path, earlier: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Another batch into one folder, which was done first."""
    out = tmp_path / "out"
    theirs = '{"format": "ulna-batch/1", "studies": []}'
    if earlier:
        ulna.batch(arms, out, only="press/*")

    def late(study: ulna.Study) -> ulna.Result:
        (out / "batch.json").parent.mkdir(exist_ok=True)
        (out / "batch.json").write_text(theirs)
        return ulna.calibrate(study)

    monkeypatch.setattr("ulna.calibration.batch.calibrate", late)
    with pytest.raises(ulna.UlnaInputError, match=r"batch\.json: exists already and is not overwritten"):
        ulna.batch(arms, out, only="weld/*")
    assert (out / "batch.json").read_text() == theirs
    assert (out / "weld" / "study" / "result.json").is_file()
    ulna.batch(arms, out, only="weld/*", force=True)
    assert "weld/study" in (out / "batch.json").read_text()


def test_what_is_done_is_kept_and_the_rest_is_done(arms: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    ulna.batch(arms, out)
    before = (out / "press" / "study" / "result.json").read_bytes()
    study = arms / "spoilt" / "study.toml"
    study.write_text(study.read_text().replace("lenght =", "length ="))
    told: list[tuple[str, int, int]] = []
    again = ulna.batch(arms, out, progress=lambda *report: told.append(report))
    assert again.converged
    assert [entry.done_before for entry in again.studies] == [True, False, True]
    assert told == [("studies", done, 3) for done in range(4)]
    assert (out / "press" / "study" / "result.json").read_bytes() == before


def test_another_result_is_not_overwritten(arms: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    ulna.batch(arms, out, only="press/*")
    study = arms / "press" / "study.toml"
    study.write_text(study.read_text() + "\n# changed\n")
    (entry,) = ulna.batch(arms, out, only="press/*").studies
    assert entry.status == "refused"
    assert "other files, options or another version" in (entry.message or "")
    (entry,) = ulna.batch(arms, out, only="press/*", force=True).studies
    assert (entry.status, entry.done_before) == ("converged", False)


def file_in_place_of_a_folder(arms: Path, out: Path) -> None:
    (out / "weld").mkdir(parents=True)
    (out / "weld" / "study").write_text("x")


def damaged_earlier_result(arms: Path, out: Path) -> None:
    (out / "weld" / "study").mkdir(parents=True)
    (out / "weld" / "study" / "result.json").write_text('{"provenance": []}')


def earlier_result_without_its_arm(arms: Path, out: Path) -> None:
    ulna.batch(arms, out, only="weld/*")
    (out / "weld" / "study" / "arm.toml").unlink()


def no_text(arms: Path, out: Path) -> None:
    (arms / "weld" / "study.toml").write_bytes(b'format = "ulna-study/1"\n\xff\xfe\x00')


def folder_in_place_of_readings(arms: Path, out: Path) -> None:
    (arms / "weld" / "bars.csv").unlink()
    (arms / "weld" / "bars.csv").mkdir()


def a_loop_of_links(arms: Path, out: Path) -> None:
    (arms / "weld" / "bars.csv").unlink()
    (arms / "weld" / "bars.csv").symlink_to("bars.csv")


WRONG = [
    file_in_place_of_a_folder,
    damaged_earlier_result,
    earlier_result_without_its_arm,
    no_text,
    folder_in_place_of_readings,
    a_loop_of_links,
]


@pytest.mark.parametrize("spoil", WRONG)
def test_whatever_is_wrong_with_one_stops_no_other(spoil, arms: Path, tmp_path: Path) -> None:
    shutil.rmtree(arms / "spoilt")
    out = tmp_path / "out"
    spoil(arms, out)
    found = {entry.name: entry for entry in ulna.batch(arms, out).studies}
    assert found["press/study"].status == "converged"
    assert found["weld/study"].status == "refused"
    assert found["weld/study"].message
    assert "fault of Ulna's" not in found["weld/study"].message
    assert (out / "press" / "study" / "result.json").is_file()
    assert json.loads((out / "batch.json").read_text("utf-8"))["studies"][0]["name"] == "press/study"


def test_the_list_takes_no_others_place(arms: Path, tmp_path: Path) -> None:
    """Neither that of somebody's file, nor, through a link, of an input; an earlier list is replaced."""
    out = tmp_path / "out"
    out.mkdir()
    (out / "batch.json").write_text("precious")
    with pytest.raises(ulna.UlnaInputError, match=r"batch\.json: is no list of an earlier batch.*--force"):
        ulna.batch(arms, out, only="press/*")
    assert (out / "batch.json").read_text() == "precious"
    ulna.batch(arms, out, only="press/*", force=True)
    ulna.batch(arms, out, only="weld/*")
    assert [each["name"] for each in json.loads((out / "batch.json").read_text())["studies"]] == ["weld/study"]
    (out / "batch.json").unlink()
    (out / "batch.json").symlink_to(arms / "press" / "study.toml")
    for force in (False, True):
        with pytest.raises(ulna.UlnaInputError, match="remove the link"):
            ulna.batch(arms, out, force=force)
    assert "ulna-study/1" in (arms / "press" / "study.toml").read_text()


def test_which_studies(arms: Path, tmp_path: Path) -> None:
    assert list(studies_in(arms)) == ["press/study", "spoilt/study", "weld/study"]
    assert list(studies_in(arms, "*e*/study")) == ["press/study", "weld/study"]
    assert_bad_input(run("batch", arms, "-o", tmp_path / "o", "--only", "pres/*"), "no study's name matches 'pres/*'")
    assert_bad_input(run("batch", tmp_path / "none", "-o", tmp_path / "o"), "is no folder")
    (tmp_path / "empty").mkdir()
    assert_bad_input(run("batch", tmp_path / "empty", "-o", tmp_path / "o"), "has no study in it")
    assert not (tmp_path / "o").exists()


def test_json_is_what_is_written(arms: Path, tmp_path: Path) -> None:
    done = run("batch", arms, "-o", tmp_path / "out", "--only", "weld/*", "--json")
    assert done.returncode == 0
    assert strict_json(done.stdout) == json.loads((tmp_path / "out" / "batch.json").read_text("utf-8"))


def test_two_batches_take_turns(arms: Path, tmp_path: Path) -> None:
    """A folder is one batch's until it ends, however it ends."""
    out = tmp_path / "out"
    with claimed(out, "batch"):
        for force in (False, True):
            with pytest.raises(ulna.UlnaInputError, match=r"out: another batch is writing here\. Wait for it"):
                ulna.batch(arms, out, force=force)
    assert not out.exists()
    out.mkdir()
    (out / NAME).write_text("")  # of one that was killed
    assert ulna.batch(arms, out, only="press/*").converged
    assert sorted(path.name for path in out.iterdir()) == ["batch.json", "press"]
