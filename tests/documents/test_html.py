"""The HTML report: safe with any names, self-contained, complete in three languages, small for many readings."""

from __future__ import annotations

import base64
import dataclasses
import hashlib
import json
import re
from html.parser import HTMLParser

import numpy as np
import pytest
from tests.cli_runs import write_lengths
from tests.reports import HOSTILE, calibrated, seats_study

from ulna.calibration.placements import PlacementFigures
from ulna.documents.content.clouds import Quiver
from ulna.documents.content.content import Content
from ulna.documents.content.distribution import _sample
from ulna.documents.content.readings import ReadingRows
from ulna.documents.gather import gather
from ulna.documents.html.markup import inline, json_in_script, label
from ulna.documents.html.page import render
from ulna.documents.languages.languages import LANGUAGES
from ulna.documents.languages.said import Said
from ulna.documents.languages.text import Command, Name, number
from ulna.documents.languages.words import dictionary

MEGABYTES_10 = 10_000_000


class Page(HTMLParser):
    """Elements with their attributes, scripts and styles with their text, and all other text."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.raw: dict[str, list[str]] = {"script": [], "style": []}
        self.words: list[str] = []
        self._in: str | None = None
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag in self.raw:
            self._in = tag
            self.raw[tag].append("")

    def handle_endtag(self, tag):
        if tag == self._in:
            self._in = None

    def handle_data(self, data):
        if self._in is not None:
            self.raw[self._in][-1] += data
        else:
            self.words.append(data)

    def attributes(self, name):
        return [attrs[name] for _, attrs in self.elements if name in attrs]


@pytest.fixture(scope="module")
def hostile(tmp_path_factory: pytest.TempPathFactory) -> Content:
    """A calibration whose every name is an attack or runs from right to left."""
    study = seats_study(tmp_path_factory.mktemp("hostile"), HOSTILE, arm=HOSTILE[1], more='loss = "huber"\n')
    return gather(calibrated(study))


@pytest.fixture(scope="module")
def page(hostile: Content) -> Page:
    return Page(render(hostile))


def figures(page: Page) -> list[dict]:
    return json.loads(page.raw["script"][0])


def test_names_from_files_are_text_and_nothing_else(hostile, page):
    assert hostile.arm == HOSTILE[1]
    assert len(page.raw["script"]) == 3
    assert not {tag for tag, _ in page.elements} & {"img", "iframe", "object", "embed", "link", "form", "base"}
    assert not [name for _, attrs in page.elements for name in attrs if name.startswith("on")]
    text = "".join(page.words)
    for name in HOSTILE:
        assert name in text
    isolated = [k for k, (tag, _) in enumerate(page.elements) if tag == "bdi"]
    assert isolated
    assert all(page.elements[k][1] == {"dir": "auto"} for k in isolated)


def test_names_in_figures_are_no_markup(page):
    texts = [text for figure in figures(page) for trace in figure["data"] for text in trace.get("text", [])]
    assert any("&lt;script&gt;" in text for text in texts)
    for text in texts:
        assert not re.search(r"<(?!br>)", text), text
    assert "<" not in page.raw["script"][0]
    assert "&" not in page.raw["script"][0]


def test_json_in_a_script_ends_nothing():
    value = {"a": "</script><!-- ]]> & \u2028\u2029", "b": [1.5, None, "é"]}
    text = json_in_script(value)
    assert not re.search("[<>&\u2028\u2029]", text)
    assert json.loads(text) == value
    with pytest.raises(ValueError, match="not JSON compliant"):
        json_in_script(float("nan"))
    assert label((Name("<b>\u202e"),)) == "\u2068&lt;b&gt;\u202e\u2069"
    assert inline(("run ", Command("ulna <x>"))) == "run <code>ulna &lt;x&gt;</code>"


def test_numbers_in_sentences():
    shown = [number(value) for value in (0.0, 1.0, 0.0123456, -12345.678, 1.5e-7, 3e9, float("nan"))]
    assert shown == ["0", "1.000", "0.01235", "-12346", "1.50e-7", "3.00e9", "–"]


def test_nothing_comes_from_a_network(page):
    for attribute in ("src", "href", "srcset", "action", "data", "poster"):
        assert all(value.startswith("#") for value in page.attributes(attribute))
    style = page.raw["style"][0]
    assert "@import" not in style
    assert "url(" not in style
    own = page.raw["script"][2]
    assert "http" not in own
    assert "fetch(" not in own
    # Plotly has a button that sends the data to its maker
    assert 'plotlyServerURL: ""' in own
    assert "modeBarButtons: [" in own
    assert "Cloud" not in own


def test_the_policy_forbids_all_but_this_page_and_knows_its_scripts(page):
    (policy,) = [a["content"] for _, a in page.elements if a.get("http-equiv") == "Content-Security-Policy"]
    rules = {name: values for name, *values in (part.split() for part in policy.split(";"))}
    assert rules["default-src"] == ["'none'"]
    assert rules["connect-src"] == ["'none'"]
    assert rules["img-src"] == ["data:", "blob:"]
    assert "http" not in policy
    assert "unsafe-eval" not in policy
    digests = [base64.b64encode(hashlib.sha256(s.encode()).digest()).decode() for s in page.raw["script"][1:]]
    assert rules["script-src"] == [f"'sha256-{digest}'" for digest in digests]


def test_axes_have_titles_with_units(page):
    unitless = {"standard normal quantile", "readings per bin", "number", "singular value", ""}
    unitless |= {"reading, in the order of the study"}
    found = figures(page)
    assert {figure["name"] for figure in found} >= {
        "histogram-0",
        "quantiles-0",
        "joint-7",
        "reach-0",
        "poses",
        "space",
    }
    for figure in found:
        shape = figure["layout"]
        axes = [shape["scene"][f"{k}axis"] for k in "xyz"] if figure["solid"] else [shape["xaxis"], shape["yaxis"]]
        for each in axes:
            title = each["title"]["text"]
            assert title in unitless or re.search(r" / (mm|°|°C)$", title), figure["name"]
    places = {attrs["id"] for tag, attrs in page.elements if tag == "div" and "id" in attrs}
    assert {f"plot-{figure['name']}" for figure in found} == places


def test_outliers_are_marked_and_listed(hostile, page):
    (entry,) = hostile.outliers
    assert (entry["row"], entry["placement"]) == (8, HOSTILE[0])
    joint = next(figure for figure in figures(page) if figure["name"] == "joint-1")
    marked = [trace for trace in joint["data"] if trace["name"] == "outliers"]
    assert [len(trace["x"]) for trace in marked] == [1]
    assert marked[0]["marker"]["symbol"] in ("x", "triangle-up", "triangle-down")


SECTIONS = [
    "summary",
    "method",
    "quality",
    "distribution",
    "joints",
    "reach",
    "poses",
    "space",
    "arm",
    "parameters",
    "determined",
    "correlation",
    "observability",
    "lengths",
    "artefacts",
    "environment",
    "decision",
    "traceability",
    "outliers",
    "placements",
    "provenance",
]


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_section_is_there_in_every_language(hostile, language):
    page = Page(render(hostile, language))
    sections = [attrs["id"] for tag, attrs in page.elements if tag == "section"]
    assert sections == SECTIONS
    (lang,) = [attrs["lang"] for tag, attrs in page.elements if tag == "html"]
    assert lang.startswith(language)
    text = "".join(page.words)
    assert dictionary(language)["section.observability"] in text
    if language != "en":
        assert dictionary("en")["held-out.none"].split(":")[0] not in text


def test_what_is_missing_is_said(tmp_path):
    result = calibrated(write_lengths(tmp_path))
    (tmp_path / "study.toml").unlink()
    text = " ".join("".join(Page(render(gather(result))).words).split())
    for part in (
        "There are no held-out readings",
        "Run ulna cross-validate",
        "was not found",
        "--study",
        "No acceptance test was given",
        "ulna verify",
        "No statement of conformity is made",
        "no laboratory file was given",
        "The temperature was not recorded",
        "No noise of the readings was stated",
    ):
        assert part in text, part


def test_the_laboratory_is_named(root, tmp_path):
    result = calibrated(write_lengths(tmp_path))
    lab = root / "examples" / "platinum" / "laboratory.toml"
    text = "".join(Page(render(gather(result, laboratory=lab), "de")).words)
    for part in (
        "Beispiellabor für Längen",
        "EX-2026-0042",
        "Erika Muster",
        "EX-2025-0911",
        "auf das Meter rückgeführt",
    ):
        assert part in text
    assert "Nicht angegeben" not in text


def test_the_same_content_gives_the_same_bytes(hostile):
    assert render(hostile) == render(hostile)


def many(content: Content, count: int) -> Content:
    """The same report as if of so many readings, in half as many placements."""
    rng = np.random.default_rng(1)
    size = np.abs(rng.normal(0, 0.01, count))
    outlier = rng.random(count) < 1e-3
    pick = np.arange(count)
    readings = ReadingRows(
        pick + 1, ["bars.csv"] * count, ["bar"] * count, [f"placement {k // 2}" for k in pick], size, outlier
    )
    clouds = [
        dataclasses.replace(cloud, x=rng.uniform(-180, 180, count), residual_mm=size, reading=pick)
        for cloud in content.clouds
    ]
    figure = {"length_error_mean_mm": 0.0123456789}
    return dataclasses.replace(
        content,
        readings=readings,
        clouds=clouds,
        quiver=Quiver(rng.normal(0, 500, (count, 3)), rng.normal(0, 0.01, (count, 3)), pick),
        samples=[_sample("bar", "component", rng.normal(0, 0.01, 3 * count))],
        placements=[PlacementFigures("bar", f"placement {k}", "bar", 2, figure) for k in range(count // 2)],
        outliers=[dict(content.outliers[0], row=int(k)) for k in np.flatnonzero(outlier)] * 30,
    )


def test_a_report_of_100_000_readings_is_small_and_says_what_it_shows(hostile):
    content = many(hostile, 100_000)
    text = render(content)
    assert len(text.encode()) < MEGABYTES_10
    page = Page(text)
    words = " ".join("".join(page.words).split())
    assert "Shown: every 67th of 100000 points and all outliers" in words
    assert "Each pair of bars stands for 167 readings in a row" in words
    assert "The 500 placements with the largest errors of 50000" in words
    assert f"{len(content.outliers) - 2000} more are in the result" in words
    joint = next(figure for figure in figures(page) if figure["name"] == "joint-1")
    marked = sum(len(trace["x"]) for trace in joint["data"] if trace["name"] == "outliers")
    assert marked == int(content.readings.outlier.sum())


def test_statements_of_the_content_have_words(hostile):
    for said in (*hostile.held_out, *hostile.missing.values(), Said("study.in-memory")):
        assert said.key in dictionary("en")
