"""`ulna report`: what it writes and refuses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tests.cli_runs import assert_bad_input, run, write_lengths
from tests.documents.test_html import Page, figures
from tests.reports import calibrated

from ulna.exchange.importers.mukca import import_mukca


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return calibrated(write_lengths(tmp_path_factory.mktemp("report")))


def test_a_file_and_a_folder(result, tmp_path):
    file = tmp_path / "made" / "r.html"
    done = run("report", result, "--html", "-o", file)
    assert done.returncode == 0, done.stderr
    assert done.stderr == f"Written: {file}\n"
    assert file.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")
    done = run("report", result.parent, "-o", tmp_path / "folder")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "folder" / "report.html").read_bytes() == file.read_bytes()


def test_it_overwrites_only_by_force_and_never_an_input(result, tmp_path):
    file = tmp_path / "r.html"
    file.write_text("kept")
    assert_bad_input(run("report", result, "-o", file), f"{file}: exists already", "--force")
    assert file.read_text() == "kept"
    assert run("report", result, "-o", file, "--force").returncode == 0
    disguised = tmp_path / "result.html"
    disguised.write_bytes(result.read_bytes())
    done = run("report", disguised, "-o", disguised, "--force")
    assert_bad_input(done, "is an input of this run and is never overwritten")
    assert disguised.read_bytes() == result.read_bytes()


def test_what_it_refuses(result, tmp_path):
    assert_bad_input(run("report", result, "-o", tmp_path / "r.html", "--language", "fr"), "got 'fr'", "en, de or zh")
    assert_bad_input(run("report", tmp_path / "none.json", "-o", tmp_path / "r.html"), "no such file")
    assert_bad_input(run("report", result, "-o", tmp_path / "r.html", "--study", result), "TOML")
    assert run("report", result).returncode == 2
    assert not (tmp_path / "r.html").exists()


def test_a_study_that_changed_is_told(tmp_path):
    result = calibrated(write_lengths(tmp_path / "s"))
    start = tmp_path / "s" / "start.toml"
    start.write_text(start.read_text(encoding="utf-8") + "# later\n", encoding="utf-8")
    done = run("report", result, "-o", tmp_path / "r.html", "--language", "zh")
    assert done.returncode == 0, done.stderr
    assert "The study has changed since the calibration" in done.stderr
    assert "start.toml" in done.stderr


def test_the_machine_form_says_what_is_missing(result, tmp_path):
    done = run("report", result, "-o", tmp_path / "r.html", "--json")
    found = json.loads(done.stdout)
    assert found["files"] == {"html": str(tmp_path / "r.html")}
    assert found["missing"]["held-out"] == "held-out.none"
    assert "study" not in found["missing"]


def test_a_report_of_real_readings(shared_data, tmp_path):
    """497 touches of a robot in eight places, published by others: only what they lack is missing."""
    import_mukca(shared_data / "mukca" / "panda_2_clean", tmp_path / "panda")
    done = run("report", calibrated(tmp_path / "panda" / "study.toml"), "-o", tmp_path / "r.html", "--json")
    assert done.returncode == 0, done.stderr
    missing = json.loads(done.stdout)["missing"]
    assert set(missing) == {"held-out", "temperature", "verification", "laboratory"}
    page = Page((tmp_path / "r.html").read_text(encoding="utf-8"))
    names = [figure["name"] for figure in figures(page)]
    assert {f"joint-{k}" for k in range(1, 8)} | {"space", "correlation", "lengths"} <= set(names)
    words = " ".join("".join(page.words).split())
    assert "Readings: 497" in words
    assert "determine 25 of 27 free parameters" in words
