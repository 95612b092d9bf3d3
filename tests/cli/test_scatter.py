"""How readings scatter and whether what is stated holds, as commands print it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from rich.console import Console
from tests.cli_runs import run, write_lengths

import ulna
from ulna import Result, Study
from ulna.calibration.coverage import Coverage, Share
from ulna.calibration.likely import CAUSES
from ulna.calibration.summary import ReadingScatter
from ulna.cli.printed.coverage import coverage_report
from ulna.cli.printed.scatter import scatter

NOISE = "[noise]\nencoder = 1e-9\nseat = {}\n"
#: of a touch, in write_lengths: 0.01 mm of each length
SEAT_MM = 0.00707


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_lengths(tmp_path_factory.mktemp("study"), noise=NOISE.format(SEAT_MM))


def calibrated(study: Path, seat_mm: float | None, **fit: Any) -> Result:
    loaded = Study.load(study)
    assert loaded.noise is not None
    noise = None if seat_mm is None else replace(loaded.noise, seat_mm=seat_mm)
    return ulna.calibrate(replace(loaded, noise=noise, fit=replace(loaded.fit, **fit)))


def said(result: Result) -> str:
    return " ".join(scatter(result).split())


def shown_by(result: Result) -> ReadingScatter:
    found = result.fit.reading_scatter
    assert found is not None
    return found


def test_noise_that_holds_needs_no_word(study: Path) -> None:
    assert said(calibrated(study, SEAT_MM)) == ""


def test_what_was_not_stated_is_said(study: Path) -> None:
    result = calibrated(study, None)
    text = said(result)
    assert shown_by(result).touch_mm == pytest.approx(SEAT_MM, rel=0.25)
    assert text.startswith(f"Noise is not stated: the residuals say {shown_by(result).touch_mm:.4f} mm")
    assert "in every uncertainty" in text


@pytest.mark.parametrize(("part", "words"), [(0.5, "the readings scatter"), (2.0, "of it is seen")])
def test_noise_that_does_not_hold_is_said_and_scaled(study: Path, part: float, words: str) -> None:
    """Half: the rest is what the model does not explain. Twice: nothing is."""
    result = calibrated(study, part * SEAT_MM)
    found, text = shown_by(result), said(result)
    assert found.factor == pytest.approx(1.0 / part, rel=0.25)
    assert "The stated noise is contradicted" in text
    assert words in text
    assert ("does not explain" in text) == (part < 1.0)
    if part < 1.0:
        assert found.unexplained_mm == pytest.approx(SEAT_MM * (1.0 - part**2) ** 0.5, rel=0.25)
    right = {row.name: row.u for row in calibrated(study, SEAT_MM).parameters if row.u}
    u = {row.name: row.u for row in result.parameters if row.u}
    assert u["joint.3.a"] == pytest.approx(right["joint.3.a"], rel=0.25)


def test_a_loss_with_too_few_readings_says_so(tmp_path: Path) -> None:
    result = calibrated(write_lengths(tmp_path, rows=45, noise=NOISE.format(SEAT_MM)), None, loss="huber")
    text = said(result)
    assert "No uncertainties can be given: with loss 'huber'" in text
    assert "1.8 equations for each parameter" in text
    assert "fit fewer parameters" in text
    assert all(row.u is None for row in result.parameters)


def printed(found: Coverage | None, width: int) -> str:
    console = Console(width=width, force_terminal=False)
    with console.capture() as captured:
        for part in coverage_report(found):
            console.print(part)
    return captured.get()


SMALL = Share(1000, 600, 0.6, 0.569, 0.630, 2.13)
RIGHT = Share(500, 475, 0.95, 0.927, 0.966, 1.0)
LARGE = Share(400, 400, 1.0, 0.99, 1.0, 0.31)


@pytest.mark.parametrize("width", [60, 80])
def test_uncertainties_that_are_too_small_are_called_so(width: int) -> None:
    text = printed(Coverage(SMALL, RIGHT, list(CAUSES)), width)
    assert all(len(line.rstrip()) <= width for line in text.splitlines())
    flat = " ".join(text.split())
    assert "points 1000 600 60.0 56.9 … 63.0" in flat
    assert "lengths 500 475 95.0 92.7 … 96.6" in flat
    assert "The stated uncertainties are too small by a factor of 2.1 (points) here. Likely: poses or places" in flat
    for cause in ("no extras", "held", "u is not stated", "few places"):
        assert cause in flat


def test_what_holds_is_counted_and_no_more() -> None:
    assert "uncertainties are" not in printed(Coverage(RIGHT, None), 80)
    assert "lengths" not in printed(Coverage(RIGHT, None), 80)
    assert coverage_report(None) == coverage_report(Coverage(None, None)) == []


def test_uncertainties_that_are_far_too_large_are_called_so_too() -> None:
    assert "0.31 of them would do" in " ".join(printed(Coverage(LARGE, LARGE), 80).split())
    assert "would do" not in printed(Coverage(LARGE, RIGHT), 80)


def test_readings_that_were_fitted_are_told_to_flatter(study: Path, tmp_path: Path) -> None:
    """Of a result, by its files; fresh readings, and an arm file, are judged without a word."""
    out = tmp_path / "out"
    ulna.calibrate(Study.load(study)).save(out)
    fresh = write_lengths(tmp_path / "fresh", rows=40)

    def printed_of(arm: Path, judged: Path) -> str:
        done = run("evaluate", arm, judged)
        assert done.returncode == 0
        return " ".join(done.stdout.split())

    assert "calibrated by these readings: they flatter" in printed_of(out, study)
    assert "intervals" not in printed_of(out, study)
    assert "flatter" not in printed_of(out, fresh)
    assert "lengths 40 " in printed_of(out / "result.json", fresh)
    assert "flatter" not in printed_of(out / "arm.toml", study)
    assert "intervals" not in printed_of(out / "arm.toml", study)
