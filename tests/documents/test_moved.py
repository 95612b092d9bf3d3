"""A report says what has moved since an earlier calibration, with the numbers of `ulna compare`, in each language."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from tests.cli_runs import run
from tests.pdf_reading import Pdf, holds
from tests.records.benches import ROOT

from ulna.comparison.compare import Compared, compare
from ulna.documents.gather import gather
from ulna.documents.html.page import render
from ulna.documents.languages.words import Words
from ulna.documents.pdf.render import render as on_paper
from ulna.ground.digits import figure_mm

EXAMPLES = ROOT / "examples" / "platinum"


@pytest.fixture(scope="module")
def years(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """The example, and the same arm after joint 4 was knocked."""
    folder = tmp_path_factory.mktemp("moved")
    for arguments in (
        ["calibrate", EXAMPLES / "study.toml", "-o", folder / "one"],
        ["simulate", EXAMPLES / "next-year.toml", "-o", folder / "next"],
        ["calibrate", folder / "next" / "study.toml", "-o", folder / "other"],
    ):
        assert run(*arguments).returncode == 0
    return folder / "one", folder / "other"


def step_of(years: tuple[Path, Path]) -> Compared:
    return compare(*years).steps[0]


@pytest.mark.parametrize("language", ["en", "de", "zh"])
def test_it_says_what_compare_says(years: tuple[Path, Path], language: str) -> None:
    words, step = Words(language), step_of(years)
    page = render(gather(years[1], earlier=years[0]), language)
    text = re.sub(r"<[^>]+>", "", page)
    assert "".join(words("moved.yes")) in text
    assert "".join(words("moved.no")) not in text
    assert step.largest is not None
    for number in (f"{step.chi2:.1f}", figure_mm(step.largest.largest_mm), step.parameters[0].name):
        shown = number.replace(".", ",") if language == "de" and number[0] in "-0123456789" else number
        assert shown in text or number in text, number


def test_nothing_is_said_where_nobody_asked(years: tuple[Path, Path]) -> None:
    assert "".join(Words("en")("moved.no")) not in render(gather(years[1]), "en")
    assert gather(years[1]).moved is None


def test_of_the_same_calibration_nothing_has_moved(years: tuple[Path, Path]) -> None:
    page = render(gather(years[0], earlier=years[0]), "en")
    assert "".join(Words("en")("moved.no")) in page


def test_on_paper_it_stands_in_the_annex(years: tuple[Path, Path]) -> None:
    pdf = Pdf(on_paper(gather(years[1], earlier=years[0]), "en", None, True))
    holds(pdf, "moved by more than both uncertainties explain", step_of(years).parameters[0].name)


def test_the_command_takes_it(years: tuple[Path, Path], tmp_path: Path) -> None:
    done = run("report", years[1], "--earlier", years[0], "-o", tmp_path / "report.html")
    assert done.returncode == 0, done.stderr
    assert "What has moved" in (tmp_path / "report.html").read_text(encoding="utf-8")
    done = run("report", years[1], "--earlier", tmp_path / "none.json", "-o", tmp_path / "other.html")
    assert done.returncode == 2
    assert not (tmp_path / "other.html").exists()
