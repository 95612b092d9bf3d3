"""Digital calibration certificates: read back by readers of their own, they say what the result says."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.stats
from tests import dcc_reading as reading
from tests.certificates import (
    EVERY_KEY,
    EXAMPLE,
    LABORATORIES,
    MINIMAL,
    NASTY,
    PROBE,
    RESULT,
    RESULTS,
    beyond_geometry,
    document,
    make,
    nasty,
    without_freedom,
    without_noise,
)

from ulna.documents.dcc.document import dcc_certificate


@pytest.fixture
def made(tmp_path: Path) -> Callable[..., bytes]:
    return functools.partial(make, tmp_path)


CASES = [(result, "minimal") for result in RESULTS] + [("as it is", laboratory) for laboratory in LABORATORIES]


@pytest.mark.shared_data
@pytest.mark.parametrize(("result", "laboratory"), CASES)
def test_it_is_valid_against_the_schema(
    made: Callable[..., bytes], shared_data: Path, result: str, laboratory: str
) -> None:
    from lxml import etree

    schema = xsd(shared_data)
    content = made(RESULTS[result], LABORATORIES[laboratory]())
    assert schema.validate(etree.fromstring(content)), schema.error_log


def xsd(shared_data: Path) -> Any:
    folder = shared_data / "dcc-xsd"
    if not folder.is_dir():
        pytest.skip(f"PTB's schema is not at hand: {folder} is not there")
    return reading.schema(folder)


@pytest.mark.shared_data
def test_every_key_of_a_laboratory_file_is_valid(shared_data: Path) -> None:
    from lxml import etree

    schema = xsd(shared_data)
    content = dcc_certificate(RESULT, EVERY_KEY).content
    assert schema.validate(etree.fromstring(content)), schema.error_log
    broken = content.replace(b"uniqueIdentifier", b"identifier")
    assert not schema.validate(etree.fromstring(broken)), "the check must be able to fail"


@pytest.mark.parametrize(("result", "laboratory"), CASES)
def test_ptbs_schematron_finds_no_error(made: Callable[..., bytes], result: str, laboratory: str) -> None:
    """The rules come with dcclib; nothing is fetched."""
    schematron = pytest.importorskip("dcclib.validation.schematron", reason="dcclib is an extra: ulna[dcc]")
    content = made(RESULTS[result], LABORATORIES[laboratory]()).decode()
    found = schematron.SchematronValidator.for_dcc().validate_str(content)
    reports = [*found.failed_assertions, *found.successful_reports]
    assert reports, "it was looked at"
    assert [report.text for report in reports if report.role == "error"] == []
    wrong = content.replace("<dcc:usedLangCodeISO639_1>", "<dcc:usedLangCodeISO639_1>q", 1)
    again = schematron.SchematronValidator.for_dcc().validate_str(wrong)
    assert any(report.role == "error" for report in [*again.failed_assertions, *again.successful_reports])


@pytest.mark.parametrize("change", ["as it is", "without noise", "beyond geometry", "nasty names"])
def test_values_uncertainties_and_covariance_are_those_of_the_result(made: Callable[..., bytes], change: str) -> None:
    content = made(RESULTS[change])
    result = document()
    RESULTS[change](result)
    fitted = {row["name"]: row for row in result["parameters"] if row["status"] == "fitted"}
    read = reading.named(content, "Fitted parameters")
    assert read.labels == list(fitted)
    assert read.values == [row["value"] for row in fitted.values()], "every double reads back the same"
    freedom = result["fit"]["degrees_of_freedom"]
    known = change != "without noise"
    k = scipy.stats.norm.ppf(0.975) if known else scipy.stats.t.ppf(0.975, freedom)
    assert (read.k, read.p) == (pytest.approx(k, rel=1e-12), 0.95)
    assert read.expanded == pytest.approx([k * row["u"] for row in fitted.values()], rel=1e-12)
    n = len(fitted)
    squared = scipy.stats.chi2.ppf(0.95, n) if known else n * scipy.stats.f.ppf(0.95, n, freedom)
    assert read.region_k == pytest.approx(math.sqrt(squared), rel=1e-9)
    at = [result["covariance"]["names"].index(name) for name in fitted]
    assert np.array_equal(read.covariance, np.array(result["covariance"]["matrix"], dtype=float)[np.ix_(at, at)].T)
    start = reading.named(content, "Their values before the calibration")
    assert start.values == [row["start"] for row in fitted.values()]


UNITS = {
    "mm": {"mm": 1},
    "rad": {"radian": 1},
    "1/K": {"kelvin": -1},
    "rad/(N m)": {"radian": 1, "newton": -1, "metre": -1},
}


def test_units_of_values_and_of_each_covariance(made: Callable[..., bytes]) -> None:
    """The unit of a covariance is the product of two units: mm², mm rad, rad², …"""
    read = reading.named(made(beyond_geometry), "Fitted parameters")
    result = document()
    beyond_geometry(result)
    units = [UNITS[row["unit"]] for row in result["parameters"] if row["status"] == "fitted"]
    assert [reading.exponents(unit) for unit in read.units] == units
    for column, own in zip(read.covariance_units, units, strict=True):
        for found, other in zip(column, units, strict=True):
            both = {name: own.get(name, 0) + other.get(name, 0) for name in own | other}
            assert reading.exponents(found) == {name: power for name, power in both.items() if power}


def test_what_bends_under_its_weight_has_its_masses(made: Callable[..., bytes]) -> None:
    read = reading.named(made(beyond_geometry), "Taken as given: signs of the encoders, balls, masses")
    given = dict(zip(read.labels, zip(read.values, read.units, strict=True), strict=True))
    assert given["joint.1.sign"] == (1.0, "\\one")
    assert given["joint.2.mass"] == (4.5, "\\kilogram")
    assert given["joint.2.centre.z"] == (30.0, "\\milli\\metre")
    assert given["gravity.z"] == (-1.0, "\\one")
    assert given["probe.bent.ball"] == (6.0, "\\milli\\metre")


def test_another_reader_finds_the_same(shared_data: Path) -> None:
    """xmlschema: schema and document as Python objects."""
    xmlschema = pytest.importorskip("xmlschema", reason="comes with dcclib, an extra: ulna[dcc]")
    folder = shared_data / "dcc-xsd"
    if not folder.is_dir():
        pytest.skip(f"PTB's schema is not at hand: {folder} is not there")
    schema = xmlschema.XMLSchema(str(folder / "v3.3.0" / "dcc.xsd"), allow="local")
    content = dcc_certificate(RESULT, EXAMPLE).content.decode()
    found = schema.to_dict(content, use_location_hints=False)
    (calibration,) = found["dcc:measurementResults"]["dcc:measurementResult"]
    parameters = calibration["dcc:results"]["dcc:result"][0]["dcc:data"]["dcc:quantity"][0]["si:realListXMLList"]
    fitted = [row for row in document()["parameters"] if row["status"] == "fitted"]
    assert parameters["si:labelXMLList"] == [row["name"] for row in fitted]
    assert [float(value) for value in parameters["si:valueXMLList"]] == [row["value"] for row in fitted]
    region = parameters["si:measurementUncertaintyMultivariateXMLList"]["si:ellipsoidalRegionMUXMLList"]
    columns = region["si:covarianceMatrixXMLList"]["si:columnXMLList"]
    variances = [float(column["si:covarianceXMLList"][0]["si:valueXMLList"][k]) for k, column in enumerate(columns)]
    assert np.sqrt(variances) == pytest.approx([row["u"] for row in fitted], rel=1e-12)
    core = found["dcc:administrativeData"]["dcc:coreData"]
    assert (core["dcc:uniqueIdentifier"], core["dcc:countryCodeISO3166_1"]) == ("EX-2026-0042", "DE")


def test_rounding_is_to_the_second_digit_of_u(made: Callable[..., bytes]) -> None:
    read = reading.named(made(), "Fitted parameters")
    for place, expanded in zip(read.places, read.expanded, strict=True):
        assert 10 <= round(expanded / 10.0**place) <= 100


def test_what_is_held_lost_or_unsure_has_no_uncertainty_and_is_told(made: Callable[..., bytes]) -> None:
    content = made()
    held, lost = (reading.named(content, name) for name in ("Held parameters", "Parameters that are not determined"))
    assert (held.labels, held.values, held.expanded) == (["joint.1.theta0"], [0.1], [])
    assert lost.labels == ["joint.1.d", "probe.straight.x", "probe.straight.y", "probe.straight.z"]
    assert lost.expanded == []
    told = reading.statements(content)
    reasons = document()["identifiability"]["lost"]
    assert len(told["Not determined"]) == len(reasons) > 0
    for text, reason in zip(told["Not determined"], reasons, strict=True):
        assert reason["because"] in text
        assert reason["remedy"] in text
    assert "joint.1.theta0" in told["Held, not fitted"][0]
    unsure = made(without_freedom)
    names = [row["name"] for row in document()["parameters"] if row["status"] == "fitted"]
    assert reading.named(unsure, "Fitted parameters without uncertainty").labels == names
    assert "no degrees of freedom" in reading.statements(unsure)["Measurement uncertainty"][0]


def test_statements_on_draft_traceability_and_noise(made: Callable[..., bytes]) -> None:
    told = reading.statements(made())
    assert "unsigned draft" in told["Unsigned draft"][0]
    assert told["Metrological traceability"] == ["The laboratory has made no statement on metrological traceability."]
    assert "95 %" in told["Measurement uncertainty"][0]
    assert "in the manner of JCGM 100:2008" in told["Measurement uncertainty"][0]
    assert "noise of the readings was stated by the study" in told["Measurement uncertainty"][0]
    told = reading.statements(made(without_noise, EXAMPLE.read_text(encoding="utf-8")))
    assert "through the standards" in told["Metrological traceability"][0]
    assert "estimated from the residuals" in told["Measurement uncertainty"][0]
    assert "Student's t with 138 degrees of freedom" in told["Measurement uncertainty"][0]
    assert told["Remark"] == ["The arm is virtual: its readings were computed."]


def test_the_laboratory_file_arrives() -> None:
    root = reading.tree(dcc_certificate(RESULT, EVERY_KEY).content)
    core = root.find("dcc:administrativeData/dcc:coreData", reading.NS)
    texts = {child.tag.split("}")[1]: child.text for child in core if child.text and child.text.strip()}
    assert texts == {
        "countryCodeISO3166_1": "CN",
        "usedLangCodeISO639_1": "en",
        "mandatoryLangCodeISO639_1": "zh",
        "uniqueIdentifier": "A/1 & <b>",
        "receiptDate": "2026-01-29",
        "beginPerformanceDate": "2026-01-30",
        "endPerformanceDate": "2026-02-02",
        "performanceLocation": "customerBranch",
        "issueDate": "2026-02-03",
    }
    everything = "\n".join(text.strip() for text in root.itertext() if text.strip())
    for text in (
        "substituted",
        "A/0",
        "77",
        "CNAS",
        "L0000",
        "张三",
        "李四",
        "S-1",
        "I-9",
        "C-3",
        "NIM",
        "备注",
        "AA-1",
    ):
        assert text in everything
    assert "ISO 10360-12:2016" in everything
    conditions = root.findall(".//dcc:influenceCondition//dcc:quantity", reading.NS)
    low, high = (reading.quantity(each) for each in conditions[:2])
    assert (low.values, high.values, low.units) == ([292.15], [294.15], ["\\kelvin"])
    humidity = conditions[2].find("si:real", reading.NS)
    assert humidity.findtext("si:value", namespaces=reading.NS) == "0.455"
    standard = humidity.find("si:measurementUncertaintyUnivariate/si:standardMU/si:valueStandardMU", reading.NS)
    assert float(standard.text) == pytest.approx(0.025)


def test_texts_are_text_and_nothing_else(made: Callable[..., bytes]) -> None:
    content = made(nasty, LABORATORIES["nasty"]())
    root = reading.tree(content)
    assert {element.tag.split("}")[0][1:] for element in root.iter()} == set(reading.NS.values())
    assert b"<script" not in content
    item = root.find("dcc:administrativeData/dcc:items/dcc:item", reading.NS)
    assert reading.said(item, "dcc:name") == {"en": NASTY}
    assert reading.said(item, "dcc:description") == {"en": f"{NASTY}\nsecond line"}
    assert item.findtext("dcc:identifications/dcc:identification/dcc:value", namespaces=reading.NS) == NASTY
    labels = reading.named(content, "Fitted parameters").labels
    assert f"probe.{PROBE}.x" in labels
    assert any(NASTY in (text or "") and "row 3" in text for text in root.itertext())


def test_the_same_files_give_the_same_bytes(made: Callable[..., bytes]) -> None:
    assert made() == made()


def test_languages(made: Callable[..., bytes]) -> None:
    """Ulna's own texts are marked where it speaks all of the certificate's languages, else English and unmarked."""

    def name_of_fitted(languages: str) -> dict[str | None, str]:
        content = made(laboratory=MINIMAL.replace('["en"]', languages))
        found: dict[str | None, str] = reading.quantities(content)[0].names
        return found

    assert name_of_fitted('["de"]') == {"de": "Ausgeglichene Parameter"}
    assert name_of_fitted('["zh", "en"]') == {"zh": "拟合参数", "en": "Fitted parameters"}
    assert name_of_fitted('["fr"]') == {None: "Fitted parameters"}
    assert name_of_fitted('["fr", "en"]') == {None: "Fitted parameters"}
