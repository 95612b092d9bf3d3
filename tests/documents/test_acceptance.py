"""The acceptance test in a report: limits, guard bands, verdicts, and whether it is of this arm."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.cli_runs import write_lengths
from tests.documents.test_html import Page, figures
from tests.reports import calibrated

from ulna import UlnaInputError
from ulna.documents.content.acceptance import wholes
from ulna.documents.gather import gather
from ulna.documents.html.page import render

#: length, error, guard → verdict, with MPE = 0.02 + L / 50000 by hand: 0.022 at 100 mm, 0.04 at 1000 mm
VALUES = [
    (100.0, 0.0100, 0.003, "pass"),
    (100.0, -0.0210, 0.003, "undecided"),
    (100.0, 0.0260, 0.003, "fail"),
    (1000.0, -0.0360, 0.003, "pass"),
]


def document(result: Path, state: str = "as-left", points: bool = False) -> dict[str, Any]:
    """A verification.json, written by hand."""
    single = [
        {
            "artefact": "<b>block</b>",
            "position": str(k),
            "calibrated": length,
            "measured": length + error,
            "value": error,
            "limit": 0.02 + length / 50000,
            "u": guard / 1.65,
            "guard": guard,
            "verdict": verdict,
        }
        for k, (length, error, guard, verdict) in enumerate(VALUES)
    ]
    figure = {
        "name": "E_Uni:Tact.AArm",
        "key": "E_Uni",
        "formula": "L - L_cal",
        "standard": "ISO 10360-12",
        "unit": "mm",
        "value": 0.026,
        "of": {"artefact": "<b>block</b>"},
        "limit": 0.022,
        "limit_formula": "0.02 mm + L / 50000",
        "limit_terms": {"a": 0.02, "b": 50000.0},
        "u": 0.003 / 1.65,
        "k": 2.0,
        "p": 0.95,
        "expanded": 0.006 / 1.65,
        "guard": 0.003,
        "verdict": "fail",
        "why": None,
        "budget": [],
        "left_out": ["the fixture: nothing is stated of it"],
        "individual": single,
    }
    ball = figure | {"name": "P_Size", "key": "P_Size", "limit_terms": None, "verdict": None, "why": "no limit stated"}
    tests = [
        {"name": "uni", "kind": "length", "readings": 8, "verdict": "fail", "departures": [], "figures": [figure]},
        {"name": "ball", "kind": "sphere", "readings": 25, "verdict": None, "departures": [], "figures": [ball]},
    ]
    arm = {"path": "result.json", "sha256": hashlib.sha256(result.read_bytes()).hexdigest()}
    return {
        "format": "ulna-verification/1",
        "arm": "some arm",
        "verdict": "fail",
        "profile": {"name": "iso", "standard": "ISO", "statement": "In the manner of.", "path": "p", "sha256": "0"},
        "decision": {"rule": "1.65u", "text": "…", "k": 2.0, "p": 0.95},
        "environment": {"temperature": None, "fixture": None, "range": None},
        "artefacts": [],
        "states": [{"state": state, "verdict": "fail", "departures": ["test 'bi' was not measured."], "tests": tests}],
        "provenance": {
            "program": "ulna",
            "version": "0",
            "plan": {"path": "plan.toml", "sha256": "0"},
            "arms": [] if points else [arm],
            "files": [],
            "warnings": [],
            "time": "2026-03-31T12:00:00+02:00",
        },
    }


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return calibrated(write_lengths(tmp_path_factory.mktemp("tested")))


def verified(result: Path, folder: Path, **more: Any) -> Path:
    path = folder / "verification.json"
    path.write_text(json.dumps(document(result, **more)), encoding="utf-8")
    return path


def test_lengths_come_with_limits_and_guard_bands(result, tmp_path):
    content = gather(result, verified=verified(result, tmp_path))
    assert "verification" not in content.missing
    assert content.verification.remarks == []
    (found,) = content.verification.lengths  # a ball has a calibrated diameter, but no length
    assert (found.state, found.test, found.a_mm, found.b) == ("as-left", "uni", 0.02, 50000.0)
    assert found.length_mm.tolist() == [100.0, 100.0, 100.0, 1000.0]
    assert found.limit_mm == pytest.approx([0.022, 0.022, 0.022, 0.04])
    assert found.verdict == [verdict for *_, verdict in VALUES]


def test_the_figure_shows_them(result, tmp_path):
    page = Page(render(gather(result, verified=verified(result, tmp_path))))
    (plot,) = [figure for figure in figures(page) if figure["name"].startswith("tested-")]
    by_name: dict[str, list[dict[str, Any]]] = {}
    for trace in plot["data"]:
        by_name.setdefault(trace["name"], []).append(trace)
    upper, lower = by_name["± MPE"]
    assert np.allclose(upper["y"], 0.02 + np.array(upper["x"]) / 50000, atol=1e-6)
    assert np.allclose(lower["y"], -np.array(upper["y"]))
    assert len(upper["y"]) == len(upper["x"]) == 4
    band = np.array(by_name["guard band"][0]["y"])
    assert np.allclose(band[:4] - band[:3:-1], 2 * 0.003, atol=1e-5)
    assert [by_name[word][0]["y"] for word in ("pass", "undecided", "FAIL")] == [[0.01, -0.036], [-0.021], [0.026]]
    shapes = {by_name[word][0]["marker"]["symbol"] for word in ("pass", "undecided", "FAIL")}
    assert len(shapes) == 3
    assert {each["title"]["text"] for each in (plot["layout"]["xaxis"], plot["layout"]["yaxis"])} == {
        "length / mm",
        "length error / mm",
    }


@pytest.mark.parametrize(
    ("language", "words"),
    [
        ("en", ("FAIL", "g = 1.65 u", "as left", "On the whole: FAIL")),
        ("de", ("NICHT bestanden",)),
        ("zh", ("不合格",)),
    ],
)
def test_the_page_says_what_was_decided_and_how(result, tmp_path, language, words):
    text = "".join(Page(render(gather(result, verified=verified(result, tmp_path)), language)).words)
    for part in (*words, "E_Uni:Tact.AArm", "L - L_cal", "test 'bi' was not measured.", "<b>block</b>", "the fixture"):
        assert part in text, part
    assert "No statement of conformity" not in text


def test_the_whole_is_said_of_each_state_and_of_what_was_measured(result, tmp_path):
    """An arm that failed as found and passes as left: neither word stands for the other; tests that were not measured
    and figures without a verdict are counted beside it."""
    path = verified(result, tmp_path)
    made = json.loads(path.read_text(encoding="utf-8"))
    left = json.loads(json.dumps(made["states"][0]))
    made["states"][0]["state"], left["state"] = "as-found", "as-left"
    left["verdict"] = left["tests"][0]["verdict"] = "pass"
    made["states"].append(left)
    path.write_text(json.dumps(made), encoding="utf-8")
    content = gather(result, verified=path)
    assert content.verification is not None
    found = [(each.state, each.verdict) for each in wholes(content.verification.file)]
    assert found == [("as-found", "fail"), ("as-left", "pass")]
    text = "".join(Page(render(content)).words)
    name = content.verification.file.profile.name
    for language, states in (
        ("en", (("as found", "FAIL"), ("as left", "pass"))),
        ("de", (("vor der Kalibrierung", "NICHT bestanden"), ("nach der Kalibrierung", "bestanden"))),
    ):
        said = "".join(Page(render(content, language)).words)
        for state, verdict in states:
            assert f"({name}, {state}): {verdict}." in said, (language, state)
    chinese = "".join(Page(render(content, "zh")).words)
    assert f"（{name}，校准前状态）：不合格。" in chinese
    assert "On the whole: FAIL (as found)." in text
    assert "On the whole: pass (as left)." in text
    assert "not measured (1)" in text


def test_a_limit_without_a_slope_is_a_line_too(result, tmp_path):
    path = verified(result, tmp_path)
    made = json.loads(path.read_text(encoding="utf-8"))
    made["states"][0]["tests"][0]["figures"][0]["limit_terms"]["b"] = None
    path.write_text(json.dumps(made), encoding="utf-8")
    page = Page(render(gather(result, verified=path)))
    (plot,) = [figure for figure in figures(page) if figure["name"].startswith("tested-")]
    (upper, _) = [trace for trace in plot["data"] if trace["name"] == "± MPE"]
    assert upper["y"] == [0.02] * len(upper["x"])


def test_a_test_of_another_arm_is_told(result, tmp_path):
    path = verified(result, tmp_path)
    made = json.loads(path.read_text(encoding="utf-8"))
    made["provenance"]["arms"][0]["sha256"] = "0" * 64
    path.write_text(json.dumps(made), encoding="utf-8")
    assert [said.key for said in gather(result, verified=path).verification.remarks] == ["verification.other-arm"]
    beside = hashlib.sha256((result.parent / "arm.toml").read_bytes()).hexdigest()
    made["provenance"]["arms"][0]["sha256"] = beside
    path.write_text(json.dumps(made), encoding="utf-8")
    assert gather(result, verified=path).verification.remarks == []
    start = hashlib.sha256((result.parent.parent / "start.toml").read_bytes()).hexdigest()
    made["provenance"]["arms"][0]["sha256"] = start
    path.write_text(json.dumps(made), encoding="utf-8")
    assert [said.key for said in gather(result, verified=path).verification.remarks] == ["verification.other-arm"]
    made["states"][0]["state"] = "as-found"
    path.write_text(json.dumps(made), encoding="utf-8")
    assert gather(result, verified=path).verification.remarks == []
    by_points = verified(result, tmp_path, points=True)
    (said,) = gather(result, verified=by_points).verification.remarks
    assert (said.key, said.values["arm"]) == ("verification.by-name", "some arm")


def test_another_kind_of_file_is_refused(result):
    with pytest.raises(UlnaInputError, match='expected format = "ulna-verification/1"'):
        gather(result, verified=result)
