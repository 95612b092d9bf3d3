"""Certificates of an accredited laboratory: two digits of U, none below its CMC, what decisions risk, and what was not
tested."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from tests import dcc_reading as reading
from tests.certificates import EXAMPLE, RESULT, document
from tests.cli_runs import run
from tests.documents.test_html import Page
from tests.documents.test_verified import figure, state, verification

from ulna.documents.dcc.document import dcc_certificate
from ulna.documents.gather import gather
from ulna.documents.html.page import render
from ulna.ground.digits import rounded

ACCREDITED = 'accreditation = { body = "Body", number = "K-1", standard = "ISO/IEC 17025:2017" }\n'
CMC = '\n[cmc]\nunit = "mm"\n[cmc.figure]\nE_Uni = 0.00405\n'
RISK = {
    "sides": "two-sided",
    "conformity": 0.999,
    "specific": 0.001,
    "consumer_at_most": 0.0495,
    "producer_at_most": 0.0495,
    "of_all": {
        "process": {"mean": 0.001, "deviation": 0.01, "distribution": "normal"},
        "consumer": 0.002,
        "producer": 0.003,
        "withheld": 0.04,
        "undecided": 0.05,
    },
}


def laboratory(folder: Path, accredited: bool = True, more: str = "", scanner: str | None = None) -> Path:
    text = EXAMPLE.read_text(encoding="utf-8")
    assert "accreditation" not in text
    if accredited:
        text = text.replace("[[person]]", ACCREDITED + "[[person]]", 1)
    if scanner is not None:
        text = text.replace('serial = "P07-0815"', f'serial = "P07-0815"\nscanner = "{scanner}"')
    (folder / "lab.toml").write_text(text + more, encoding="utf-8")
    return folder / "lab.toml"


def verified(folder: Path, **more: Any) -> Path:
    values = figure("E_Uni", 0.01234567, "pass", risk=RISK, **more)
    values["individual"][0]["conformity"] = values["individual"][1]["conformity"] = 0.999
    (folder / "verification.json").write_text(json.dumps(verification(state("as-left", values))), encoding="utf-8")
    return folder / "verification.json"


def made(folder: Path, lab: Path) -> bytes:
    return dcc_certificate(RESULT, lab, [verified(folder)]).content


def digits(text: str) -> int:
    """Significant digits of a decimal number."""
    return len(text.lower().partition("e")[0].replace(".", "").lstrip("-0"))


def texts(content: bytes, tag: str) -> list[str]:
    found = reading.tree(content).iter(f"{{{reading.NS['si']}}}{tag}")
    return [word for each in found for word in (each.text or "").split()]


def test_an_accredited_laboratory_states_two_digits_of_u(tmp_path: Path) -> None:
    content = made(tmp_path, laboratory(tmp_path))
    every = texts(content, "valueExpandedMU") + texts(content, "valueExpandedMUXMLList")
    assert len(every) > 15
    assert [text for text in every if digits(text) != 2] == []
    read = reading.named(content, "Fitted parameters")
    rows = {row["name"]: row for row in document()["parameters"] if row["status"] == "fitted"}
    for name, value, u, place in zip(read.labels, read.values, read.expanded, read.places, strict=True):
        row = rows[name]
        shown, u_shown = rounded(row["value"], read.k * row["u"], row["unit"])
        assert (value, u) == (float(shown), float(u_shown)), name
        assert abs(value - row["value"]) <= 0.5000001 * 10.0**place
    assert reading.named(content, "E_Uni").values == [0.0123], "to the place of U = 0.0020"
    told = reading.statements(content)
    assert "ILAC-P14:09/2020" in told["Rounding"][0]
    assert "states no CMC of E_Uni" in told["Calibration and measurement capability"][1]


def test_others_state_all_digits(tmp_path: Path) -> None:
    content = made(tmp_path, laboratory(tmp_path, accredited=False))
    assert reading.named(content, "E_Uni").values == [0.01234567]
    assert max(digits(text) for text in texts(content, "valueExpandedMUXMLList")) > 10
    told = reading.statements(content)
    assert "in full, for machines" in told["Rounding"][0]
    assert "Calibration and measurement capability" not in told


@pytest.mark.parametrize("accredited", [True, False])
def test_u_below_the_capability_is_lifted_and_said(tmp_path: Path, accredited: bool) -> None:
    """U = 2 µm, CMC = 4.05 µm: stated are 4.1 µm, the guard band is 1.65 · 2.05 µm."""
    content = made(tmp_path, laboratory(tmp_path, accredited, CMC))
    read = reading.named(content, "E_Uni")
    assert read.expanded == [0.0041]
    assert reading.named(content, "E_Uni, each value").expanded == [0.0041, 0.0041]
    guards = [float(text) for text in texts(content, "value")]
    assert (0.0034 if accredited else 1.65 * 0.00205) in guards
    (said,) = [
        text for text in reading.statements(content)["Calibration and measurement capability"] if "E_Uni" in text
    ]
    assert "Of the worst value U was computed as 0.0020 mm and is stated as 0.0041 mm." in said


def test_the_command_says_what_was_lifted(tmp_path: Path) -> None:
    lab, path = laboratory(tmp_path, more=CMC), verified(tmp_path)
    done = run("certificate", RESULT, lab, "--verification", path, "-o", tmp_path / "c.xml")
    assert done.returncode == 0, done.stderr
    assert "U lifted to the laboratory's CMC, and decided anew: E_Uni" in done.stdout
    done = run("certificate", RESULT, laboratory(tmp_path), "--verification", path, "-o", tmp_path / "d.xml")
    assert "the laboratory file states no CMC of E_Uni" in done.stdout


def test_what_decisions_risk_stands_beside_conformity(tmp_path: Path) -> None:
    content = made(tmp_path, laboratory(tmp_path))
    names = {
        "Probability of conformity (JCGM 106:2012)": 0.999,
        "Specific risk: this verdict is wrong": 0.001,
        "Largest specific consumer's risk of the rule": 0.0495,
        "Global consumer's risk: passes and does not conform": 0.002,
        "Global producer's risk of a binary rule: conforms and does not pass": 0.04,
        "Share that stays undecided": 0.05,
    }
    elements = [reading.quantity(each) for each in reading.tree(content).iter(f"{{{reading.NS['dcc']}}}quantity")]
    for name, value in names.items():
        found = [each for each in elements if name in each.names.values()]
        assert found[0].values[0] == value, name
        assert set(found[0].units) == {"\\one"}, name
    (singles,) = [each for each in elements if "Probability of conformity (JCGM 106:2012)" in each.names.values()][1:]
    assert singles.values == [0.999, 0.999], "of each single value too"


@pytest.mark.shared_data
@pytest.mark.parametrize("more", ["", CMC])
def test_it_is_valid(tmp_path: Path, shared_data: Path, more: str) -> None:
    from lxml import etree

    folder = shared_data / "dcc-xsd"
    if not folder.is_dir():
        pytest.skip(f"PTB's schema is not at hand: {folder} is not there")
    content = made(tmp_path, laboratory(tmp_path, more=more, scanner="LS-1"))
    schema = reading.schema(folder)
    assert schema.validate(etree.fromstring(content)), schema.error_log


def test_a_scanner_is_said_to_be_untested(tmp_path: Path) -> None:
    named = reading.statements(made(tmp_path, laboratory(tmp_path, scanner="LS-1")))
    assert "the scanner (LS-1)" in named["Not covered"][0]
    assert "ISO 10360-8" in named["Not covered"][0]
    unnamed = reading.statements(made(tmp_path, laboratory(tmp_path)))
    assert "of a scanner on the arm (ISO 10360-8) nothing is said" in unnamed["Not covered"][0]


WORDS = {
    "en": ("was lifted to it", "0.0041 mm", "Risk of the decisions", "the scanner", "LS-1", "normal distribution"),
    "de": ("auf diese angehoben", "0.0041 mm", "Risiko der Entscheidungen", "der Scanner", "LS-1", "Normalverteilung"),
    "zh": ("已提高至该能力值", "0.0041 mm", "判定的风险", "扫描头", "LS-1", "正态分布"),
}


@pytest.mark.parametrize("language", WORDS)
def test_the_report_says_the_same(tmp_path: Path, language: str) -> None:
    text = laboratory(tmp_path, more=CMC, scanner="LS-1")
    if language == "zh":  # the example's texts are in two languages; a page in another needs them in it
        lab = text.read_text(encoding="utf-8").replace('languages = ["en", "de"]', 'languages = ["en", "zh"]')
        lab = re.sub(r"(?<=[{,.] )de = |(?<=statement\.)de", lambda found: found[0].replace("de", "zh"), lab)
        text.write_text(lab, encoding="utf-8")
    found = gather(RESULT, laboratory=text, verified=verified(tmp_path))
    page = "".join(Page(render(found, language)).words)
    for part in WORDS[language]:
        assert part in page, part
    assert "0.2" in page, "the global consumer's risk, in percent"


def test_without_a_process_the_words_say_why(tmp_path: Path) -> None:
    risk = RISK | {"of_all": None}
    values = figure("E_Uni", 0.01, "pass", risk=risk)
    path = tmp_path / "verification.json"
    path.write_text(json.dumps(verification(state("as-left", values))), encoding="utf-8")
    page = "".join(Page(render(gather(RESULT, verified=path))).words)
    assert "Global risks, of all arms of this kind, are not given" in page
