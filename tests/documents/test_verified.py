"""A verification.json in a certificate: what it says arrives, and tests of another arm are refused."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import pytest
from tests import dcc_reading as reading
from tests.certificates import EXAMPLE, RESULT
from tests.cli_runs import assert_bad_input, run

from ulna.documents.dcc.document import dcc_certificate
from ulna.ground.errors import UlnaInputError

SHA256 = hashlib.sha256(RESULT.read_bytes()).hexdigest()
START = next(
    entry["sha256"]
    for entry in json.loads(RESULT.read_text(encoding="utf-8"))["provenance"]["files"]
    if entry["path"].endswith(".toml") and "study" not in entry["path"]
)
GUARD = 1.65 * 0.001


def figure(name: str, value: float, verdict: str | None, limit: float | None = 0.02, **more: Any) -> dict[str, Any]:
    own = {"position": "left", "repeat": "1", "value": value, "limit": limit, "u": 0.001, "guard": GUARD}
    return {
        "name": name,
        "key": name,
        "formula": f"{name} as its source says, <in mm>",
        "standard": "ISO 10360-12:2016",
        "unit": "mm",
        "value": value,
        "of": {"position": "left"},
        "limit": limit,
        "limit_formula": None,
        "limit_terms": None,
        "u": 0.001,
        "k": 2.0,
        "p": 0.95,
        "expanded": 0.002,
        "guard": GUARD,
        "verdict": verdict,
        "why": None,
        "budget": [{"name": "calibration", "u": 0.001, "formula": "u"}],
        "left_out": ["the form of the ball: not stated"],
        "individual": [own | {"verdict": verdict}, own | {"repeat": "2", "value": 0.0, "verdict": verdict and "pass"}],
    } | more


def state(name: str, *figures: dict[str, Any]) -> dict[str, Any]:
    test = {"name": "uni", "kind": "length", "readings": 12, "verdict": "pass", "departures": ["4, not 5, lengths"]}
    return {
        "state": name,
        "verdict": "pass",
        "departures": ["test 'bi' (E_Bi) was not measured."],
        "tests": [test | {"figures": list(figures)}],
    }


def verification(
    *states: dict[str, Any], arm: str = "Arms P07-0815", arms: Sequence[str] = (SHA256,)
) -> dict[str, Any]:
    points = "encoders" if arms else "xyz"
    return {
        "format": "ulna-verification/1",
        "arm": arm,
        "verdict": "pass",
        "profile": {
            "name": "iso-10360-12",
            "standard": "ISO 10360-12:2016",
            "statement": "Evaluated in the manner of ISO 10360-12:2016, from secondary sources.",
            "path": "iso-10360-12.toml",
            "sha256": "0",
        },
        "decision": {"rule": "1.65u", "text": "in words", "k": 2.0, "p": 0.95},
        "environment": {"temperature": {"value": 20.5, "u": 0.3}, "fixture": None, "range": None},
        "artefacts": [],
        "states": list(states)
        or [state("as-left", figure("E_Uni", 0.015, "pass"), figure("E_Bi", 0.019, "undecided"))],
        "provenance": {
            "program": "ulna",
            "version": "0.1.0",
            "plan": {"path": "/somewhere/verify.toml", "sha256": "1"},
            "arms": [{"path": f"/somewhere/{each}.json", "sha256": each} for each in arms],
            "files": [
                {"state": "as-found", "path": "/somewhere/found.csv", "sha256": "2", "rows": 1, "points": points},
                {"state": "as-left", "path": "/somewhere/left.csv", "sha256": "3", "rows": 1, "points": points},
            ],
            "warnings": [],
            "time": "2026-03-31T12:00:00+02:00",
        },
    }


Made = Callable[..., bytes]


@pytest.fixture
def made(tmp_path: Path) -> Made:
    def make(*documents: dict[str, Any]) -> bytes:
        paths = []
        for number, document in enumerate(documents):
            path = tmp_path / f"verification-{number}.json"
            path.write_text(json.dumps(document), encoding="utf-8")
            paths.append(path)
        return dcc_certificate(RESULT, EXAMPLE, paths).content

    return make


def test_what_it_says_arrives(made: Made) -> None:
    content = made(verification())
    read = reading.named(content, "E_Uni")
    assert (read.values, read.expanded, read.k, read.p, read.conformity) == ([0.015], [0.002], 2.0, 0.95, "pass")
    assert reading.named(content, "E_Bi").conformity == "conditionalPass"
    singles = reading.named(content, "E_Uni, each value")
    assert (singles.labels, singles.values, singles.expanded) == (["left/1", "left/2"], [0.015, 0.0], [0.002, 0.002])
    told = reading.statements(content)
    assert told["Test iso-10360-12, as left"] == [
        "Evaluated in the manner of ISO 10360-12:2016, from secondary sources."
    ]
    (whole,) = told["Statement of conformity"]
    assert whole.startswith("Test iso-10360-12, as left: undecided; no value is above its limit")
    assert "g = 1.65 u (95 %)" in whole
    root = reading.tree(content)
    texts = "\n".join(text for text in root.itertext() if text.strip())
    for text in ("4, not 5, lengths", "'bi' (E_Bi) was not measured", "Not included: the form", "E_Uni as its source"):
        assert text in texts
    assert "left.csv, SHA-256 3" in texts
    assert "found.csv" not in texts, "of the other state"
    assert "/somewhere" not in texts
    temperature = root.findall(".//dcc:influenceCondition[dcc:name]", reading.NS)[-1]
    assert reading.said(temperature, "dcc:name")["en"] == "Temperature of the artefacts"
    assert temperature.findtext(".//si:value", namespaces=reading.NS) == "20.5"
    assert temperature.findtext(".//si:valueStandardMU", namespaces=reading.NS) == "0.3"


def test_both_states_from_one_file_or_two(made: Made) -> None:
    found, left = state("as-found", figure("E_Uni", 0.2, "fail")), state("as-left", figure("E_Uni", 0.01, "pass"))
    for documents in ([verification(found, left)], [verification(found, arms=[START]), verification(left)]):
        root = reading.tree(made(*documents))
        words = root.findall("dcc:administrativeData/dcc:statements/dcc:statement/dcc:conformity", reading.NS)
        assert [word.text for word in words] == ["fail", "pass"]
        results = root.findall("dcc:measurementResults/dcc:measurementResult", reading.NS)
        names = [reading.said(each, "dcc:name")["en"] for each in results]
        assert names == ["Kinematic calibration", "Test iso-10360-12, as found", "Test iso-10360-12, as left"]
        status = [{each.text for each in result.findall(".//dcc:status", reading.NS)} for result in results]
        assert status == [set(), {"beforeAdjustment"}, {"afterAdjustment"}]


def test_coordinates_of_an_arm_are_known_by_its_serial_number(made: Made) -> None:
    assert made(verification(arm="Example Arms Platinum, No. P07-0815", arms=[]))
    assert made(verification(arm=json.loads(RESULT.read_text(encoding="utf-8"))["arm"]["name"], arms=[]))
    for other in ("Example Arms Platinum, No. P07-08151", "XP07-0815", "not named"):
        with pytest.raises(
            UlnaInputError, match=r"tests are of '.*', the certificate is about serial number 'P07-0815'"
        ):
            made(verification(arm=other, arms=[]))


FOUND, LEFT = state("as-found", figure("E_Uni", 0.01, "pass")), state("as-left", figure("E_Uni", 0.01, "pass"))


@pytest.mark.parametrize(
    ("states", "arms"),
    [
        ([LEFT], [START]),
        ([LEFT], [SHA256, START]),
        ([LEFT], ["9"]),
        ([FOUND], ["9"]),
        ([FOUND], [START, "9"]),
        ([FOUND, LEFT], [START]),
        ([FOUND, LEFT], [SHA256, "9"]),
    ],
)
def test_tests_with_another_arm_are_refused(made: Made, states: list[dict[str, Any]], arms: list[str]) -> None:
    with pytest.raises(UlnaInputError, match=r"'provenance\.arms': values were computed with /somewhere/.*another arm"):
        made(verification(*states, arms=arms))


@pytest.mark.parametrize(
    ("states", "arms"),
    [([FOUND], [START]), ([FOUND], [SHA256]), ([FOUND, LEFT], [START, SHA256]), ([FOUND, LEFT], [SHA256])],
)
def test_tests_with_this_arm_are_taken(made: Made, states: list[dict[str, Any]], arms: list[str]) -> None:
    assert made(verification(*states, arms=arms))


def test_coordinates_beside_encoder_readings_are_looked_at_too(made: Made) -> None:
    document = verification(arm="another")
    assert made(document)
    document["provenance"]["files"][0]["points"] = "xyz"
    with pytest.raises(UlnaInputError, match=r"tests are of 'another'"):
        made(document)


def test_the_arm_file_beside_the_result_is_the_same_arm(tmp_path: Path) -> None:
    (tmp_path / "result.json").write_bytes(RESULT.read_bytes())
    (tmp_path / "arm.toml").write_text("whatever stands in it")
    digest = hashlib.sha256(b"whatever stands in it").hexdigest()
    (tmp_path / "verification.json").write_text(json.dumps(verification(arms=[digest])))
    assert dcc_certificate(tmp_path, EXAMPLE, [tmp_path / "verification.json"]).tested[0].state == "as-left"


DAMAGED: dict[str, tuple[dict[str, Any], str]] = {
    "a fail called pass": (figure("E_Uni", 0.03, "pass"), "figure E_Uni: the verdict is pass, but 0.03 mm"),
    "a pass called fail": (figure("E_Uni", 0.01, "fail"), "the verdict is fail"),
    "a pass called undecided": (figure("E_Uni", 0.01, "undecided"), "the verdict is undecided"),
    "a verdict without limit": (figure("E_Uni", 0.01, "pass", limit=None), "no limit or no guard band"),
    "another U": (figure("E_Uni", 0.01, "pass", expanded=0.001), "figure E_Uni: expanded is not k times u"),
    "U of nothing": (figure("E_Uni", 0.01, "pass", u=None), "expanded is not k times u"),
    "a negative uncertainty": (
        figure("E_Uni", 0.01, None, limit=None, u=-0.001, expanded=-0.002),
        "the uncertainty is -0.001 mm with k = 2",
    ),
    "no probability": (figure("E_Uni", 0.01, "pass", p=1.5), "k = 2 and p = 1.5 are no coverage factor"),
    "a text": (figure("E_Uni", 0.01, "pass") | {"value": "0.01"}, "'states.1.tests.1.figures.1.value'"),
}


@pytest.mark.parametrize("case", DAMAGED)
def test_no_verdict_that_the_numbers_do_not_bear_out(made: Made, case: str) -> None:
    figures, expected = DAMAGED[case]
    with pytest.raises(UlnaInputError) as caught:
        made(verification(state("as-left", figures)))
    assert "verification-0.json" in str(caught.value)
    assert expected in str(caught.value)


def test_a_state_without_figures(made: Made) -> None:
    with pytest.raises(UlnaInputError, match=r"state 'as-left' has no figure"):
        made(verification(state("as-left")))


def test_a_temperature_that_is_none(made: Made) -> None:
    document = verification()
    document["environment"]["temperature"] = {"value": "warm", "u": 0.1}
    with pytest.raises(
        UlnaInputError, match=r"verification-0\.json: key 'environment\.temperature\.value': got 'warm'"
    ):
        made(document)


def test_it_is_valid(made: Made, shared_data: Path) -> None:
    from lxml import etree

    folder = shared_data / "dcc-xsd"
    if not folder.is_dir():
        pytest.skip(f"PTB's schema is not at hand: {folder} is not there")
    free = figure("E_Bi", 0.01, None, limit=None, u=None, expanded=None, guard=None, budget=[], individual=[])
    content = made(verification(state("as-found", figure("E_Uni", 0.2, "fail"), free), state("as-left", free)))
    schema = reading.schema(folder)
    assert schema.validate(etree.fromstring(content)), schema.error_log


def test_the_command(tmp_path: Path) -> None:
    path, out = tmp_path / "verification.json", tmp_path / "c.xml"
    path.write_text(json.dumps(verification()), encoding="utf-8")
    done = run("certificate", RESULT, EXAMPLE, "--dcc", "--verification", path, "-o", out)
    assert done.returncode == 0, done.stderr
    assert "2 test values, iso-10360-12, as left: conditionalPass" in done.stdout
    before = path.read_bytes()
    again = run("certificate", RESULT, EXAMPLE, "--dcc", "--verification", path, "-o", path, "--force")
    assert_bad_input(again, f"{path}: is an input of this run")
    assert path.read_bytes() == before
    other = run("certificate", RESULT, EXAMPLE, "--dcc", "--verification", EXAMPLE, "-o", tmp_path / "d.xml")
    assert_bad_input(other, f"{EXAMPLE}: not valid JSON", "a verification.json")
