"""One meaning for each colour: the same in pictures of a report on a page, on paper, of a test, and in tables."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import ulna
from ulna.documents.html import plots as page
from ulna.documents.html.tested_plots import MARKS as ON_PAGE
from ulna.documents.pdf.parameter_plots import VERDICTS as ON_PAPER
from ulna.ground.style import BLUE, GREEN, GREY, OF_VERDICT, ORANGE, VERMILION
from ulna.verification.plots import MARKS as OF_TEST

PACKAGE = Path(ulna.__file__).parent / "documents" / "html"


def light(name: str) -> str:
    """A colour of the page's light theme, in capitals, as the script has it; the sheet of styles says the same."""
    script, styles = ((PACKAGE / file).read_text(encoding="utf-8") for file in ("plots.js", "style.css"))
    found = re.search(rf"\b{name}: \"(#[0-9a-f]{{6}})\"", script)
    assert found
    for said in re.findall(rf"--{name}: (#[0-9a-f]{{6}})", styles)[:1]:
        assert said == found[1]
    return found[1].upper()


@pytest.mark.parametrize("verdict", ["pass", "undecided", "fail", None])
def test_a_verdict_has_one_colour_everywhere(verdict: str | None) -> None:
    assert ON_PAPER[verdict][1] == OF_VERDICT[verdict]
    colour, _ = ON_PAGE[verdict]
    if verdict is not None:
        assert light(colour.removeprefix("@")) == OF_VERDICT[verdict].upper()
        assert OF_TEST[verdict][1] == OF_VERDICT[verdict]


def test_each_colour_has_a_meaning_of_its_own() -> None:
    assert len({BLUE, VERMILION, GREEN, ORANGE, GREY}) == 5
    assert len({OF_VERDICT[each] for each in ("pass", "undecided", "fail", None)}) == 4
    assert BLUE not in OF_VERDICT.values(), "blue are readings, whatever is said of them"
    assert [light(each) for each in ("main", "outlier", "second", "undecided")] == [BLUE, VERMILION, GREEN, ORANGE]
    assert (page.MAIN, page.OUTLIER, page.GOOD, page.UNDECIDED) == ("@main", "@outlier", "@second", "@undecided")


def test_verdicts_differ_in_shape_too() -> None:
    assert len({shape for shape, _ in ON_PAPER.values()}) >= 3
    assert len({shape for _, shape in ON_PAGE.values()}) == 4


def test_tables_have_the_colours_of_the_marks() -> None:
    styles = (PACKAGE / "style.css").read_text(encoding="utf-8")
    assert ".verdict.pass { color: var(--second); }" in styles
    assert ".verdict.undecided { color: var(--undecided); }" in styles


@pytest.mark.parametrize("name", ["undecided", "second", "main"])
def test_every_theme_has_every_colour(name: str) -> None:
    styles = (PACKAGE / "style.css").read_text(encoding="utf-8")
    assert styles.count(f"--{name}:") == styles.count("--outlier:") == 4
    assert (PACKAGE / "plots.js").read_text(encoding="utf-8").count(f'{name}: "#') == 2
