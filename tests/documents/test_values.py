"""Test values in a certificate: with their uncertainties, and every word on conformity."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests import dcc_reading as reading

from ulna.documents.certified.test_values import SingleValue, StatedTest, StatedTests
from ulna.documents.dcc.document import dcc_certificate
from ulna.verification.decision import DecisionRule

HERE = Path(__file__).resolve().parents[1]
RESULT = HERE / "data" / "fossils" / "result-1.json"
LABORATORY = HERE.parent / "examples" / "platinum" / "laboratory.toml"

RULE = "g = 1.65 u (95 %)"
PASS = StatedTest("P_Size", "probing", "D_fit - D_cal", -0.010, "mm", 0.004, 2.0, 0.95, 0.020, 0.0033, "pass")
#: name, |value| against a limit of 0.020 mm and a guard band of 0.0033 mm, decision, word
WORDS = [
    ("pass", -0.010, "pass", "pass"),
    ("within", 0.018, "undecided", "conditionalPass"),
    ("on the limit", 0.020, "undecided", "conditionalPass"),
    ("beyond", -0.022, "undecided", "conditionalFail"),
    ("fail", -0.030, "fail", "fail"),
]
VALUES = [replace(PASS, name=name, value=value, decision=said) for name, value, said, _ in WORDS]  # type: ignore[arg-type]


def stated_of(*values: StatedTest) -> StatedTests:
    return StatedTests(
        "iso",
        "as-left",
        "ISO 10360-12:2016",
        "From secondary sources.",
        DecisionRule("1.65u", 2.0, 0.95),
        "0.1.0",
        values,
        files=[("v.json", "0")],
    )


def certificate(*tested: StatedTests) -> bytes:
    return dcc_certificate(RESULT, LABORATORY, tested=tested).content


@pytest.mark.parametrize(("name", "value", "decision", "word"), WORDS)
def test_every_word_on_conformity(name: str, value: float, decision: str, word: str) -> None:
    test = next(each for each in VALUES if each.name == name)
    assert test.conformity == word
    read = reading.named(certificate(stated_of(test)), name)
    assert (read.values, read.units, read.conformity) == ([value], ["\\milli\\metre"], word)
    assert (read.expanded, read.k, read.p, read.places) == ([0.004], 2.0, 0.95, [-4])
    assert RULE in read.declared
    assert ("Neither conformity nor non-conformity is shown" in read.declared) == (decision == "undecided")


@given(value=st.floats(-1, 1), limit=st.floats(0.001, 1), guard=st.floats(0, 0.5))
def test_the_words_follow_from_the_numbers(value: float, limit: float, guard: float) -> None:
    """Whatever ISO 14253-1 says, the word is of the same zone."""
    size = abs(value)
    decision = "pass" if size <= limit - guard else "fail" if size > limit + guard else "undecided"
    test = replace(PASS, value=value, limit=limit, guard=guard, decision=decision)  # type: ignore[arg-type]
    zone = (size > limit - guard) + (size > limit) + (size > limit + guard)
    assert test.conformity == ("pass", "conditionalPass", "conditionalFail", "fail")[zone]


@pytest.mark.parametrize(
    ("names", "word"),
    [
        (["pass"], "pass"),
        (["pass", "within"], "conditionalPass"),
        (["within", "beyond", "pass"], "conditionalFail"),
        (["fail", "pass", "beyond"], "fail"),
        (["pass", "unknown"], "noPass"),
        (["within", "unknown"], "noPass"),
        (["beyond", "unknown"], "conditionalFail"),
        (["free"], None),
        (["free", "pass"], "pass"),
    ],
)
def test_the_whole_is_as_good_as_its_worst(names: list[str], word: str | None) -> None:
    known = {test.name: test for test in VALUES}
    known["unknown"] = replace(PASS, name="unknown", expanded=None, guard=None, decision=None)
    known["free"] = replace(PASS, name="free", limit=None, guard=None, decision=None)
    tests = stated_of(*(known[name] for name in names))
    assert tests.conformity == word
    content = certificate(tests)
    found = reading.tree(content).findall(
        "dcc:administrativeData/dcc:statements/dcc:statement[@refType='basic_conformity']", reading.NS
    )
    assert [each.findtext("dcc:conformity", namespaces=reading.NS) for each in found] == ([word] if word else [])
    if word:
        assert RULE in "".join(found[0].itertext())


def test_what_cannot_be_decided_says_so() -> None:
    unknown = replace(PASS, name="unknown", expanded=None, guard=None, decision=None)
    free = replace(PASS, name="free", limit=None, guard=None, decision=None)
    content = certificate(stated_of(unknown, free))
    read = reading.named(content, "unknown")
    assert (read.conformity, read.expanded) == (None, [])
    root = reading.tree(content)
    texts = "\n".join(text for text in root.itertext() if text.strip())
    assert "needs an uncertainty of this value, and none is known" in texts
    assert "No limit is specified" in texts


SINGLES = [
    SingleValue("bar/left/1", -0.010, 0.004, 0.020, "pass"),
    SingleValue("bar/left/2", 0.021, 0.005, 0.020, "undecided"),
]
FULL = replace(
    PASS,
    name="E_Uni",
    test="uni",
    budget=[("calibration", 0.002), ("expansion", 1e-5)],
    left_out=["the form"],
    singles=SINGLES,
)


def test_single_values_and_the_budget_are_there() -> None:
    tests = replace(stated_of(PASS, FULL), departures=["4 lengths, the profile counts 5"])
    content = certificate(tests)
    read = reading.named(content, "E_Uni, each value")
    assert (read.labels, read.values, read.expanded) == (["bar/left/1", "bar/left/2"], [-0.010, 0.021], [0.004, 0.005])
    root = reading.tree(content)
    (words,) = root.findall(".//dcc:conformityXMLList", reading.NS)
    assert words.text == "pass conditionalFail"
    budget = reading.named(content, "Contributors, standard uncertainties")
    assert (budget.labels, budget.values) == (["calibration", "expansion"], [0.002, 1e-5])
    texts = "\n".join(root.itertext())
    assert "Not included: the form" in texts
    assert "4 lengths, the profile counts 5" in texts
    names = [reading.said(each, "dcc:name") for each in root.findall(".//dcc:result", reading.NS)]
    assert [name.get(None) for name in names][-2:] == ["probing", "uni"]
    status = {each.text for each in root.findall(".//dcc:influenceCondition/dcc:status", reading.NS)}
    assert status == {"afterAdjustment"}


@pytest.mark.shared_data
def test_it_is_valid(shared_data: Path) -> None:
    from lxml import etree

    folder = shared_data / "dcc-xsd"
    if not folder.is_dir():
        pytest.skip(f"PTB's schema is not at hand: {folder} is not there")
    unknown = replace(PASS, name="unknown", expanded=None, guard=None, decision=None)
    free = replace(PASS, name="<free> & easy", limit=None, guard=None, decision=None)
    found = replace(stated_of(free, FULL), profile="<b>As found</b>", state="as-found", departures=["a", "b"])
    content = certificate(stated_of(*VALUES, unknown, free), found)
    schema = reading.schema(folder)
    assert schema.validate(etree.fromstring(content)), schema.error_log


def test_ptbs_schematron_finds_no_error() -> None:
    schematron = pytest.importorskip("dcclib.validation.schematron", reason="dcclib is an extra: ulna[dcc]")
    found = schematron.SchematronValidator.for_dcc().validate_str(certificate(stated_of(*VALUES, FULL)).decode())
    reports = [*found.failed_assertions, *found.successful_reports]
    assert [report.text for report in reports if report.role == "error"] == []
