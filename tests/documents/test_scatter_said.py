"""How readings scatter, whether what is stated holds, and why there is no uncertainty: in each language, on paper as on
the screen, and in the digital certificate."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from tests.certificates import EXAMPLE
from tests.cli_runs import write_lengths
from tests.reports import calibrated

import ulna
from ulna import Study, UlnaInputError
from ulna.arm.unknown import Unknown
from ulna.calibration.coverage import Coverage, Share
from ulna.calibration.likely import CAUSES
from ulna.calibration.summary import ReadingScatter
from ulna.documents.content.content import Content
from ulna.documents.content.coverage import JudgedReadings
from ulna.documents.dcc.document import dcc_certificate
from ulna.documents.gather import gather
from ulna.documents.html.page import render
from ulna.documents.languages.languages import LANGUAGES
from ulna.documents.languages.text import plain
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Listed, Paragraph, Table
from ulna.documents.sections.parameters import parameters
from ulna.documents.sections.quality import quality
from ulna.documents.sections.scatter import scatter
from ulna.documents.sections.uncertainty import uncertainty_statement

every_language = pytest.mark.parametrize("language", LANGUAGES)
SMALL = Share(1000, 600, 0.6, 0.569, 0.630, 2.13)
LARGE = Share(400, 400, 1.0, 0.99, 1.0, 0.31)


@pytest.fixture(scope="module")
def unstated(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return calibrated(write_lengths(tmp_path_factory.mktemp("unstated")))


@pytest.fixture(scope="module")
def content(unstated: Path) -> Content:
    return gather(unstated)


def half_stated(folder: Path) -> Path:
    return calibrated(write_lengths(folder, noise="[noise]\nencoder = 1e-9\nseat = 0.0035\n"))


def flat(blocks: list[Block]) -> str:
    """All that paragraphs, lists and cells say."""
    found = []
    for block in blocks:
        if isinstance(block, Paragraph):
            found.append(plain(block.text))
        elif isinstance(block, Listed):
            found += [plain(item) for item in block.items]
        elif isinstance(block, Table):
            found += [" ".join(plain(cell) for cell in row) for row in block.rows]
    return "\n".join(found)


def test_k_is_that_of_what_the_uncertainties_rest_on(unstated: Path, tmp_path: Path) -> None:
    """Student's also where noise was stated and the residuals contradict it."""
    for result in (unstated, half_stated(tmp_path)):
        found = gather(result)
        assert found.parameters.degrees_of_freedom == pytest.approx(found.fit.degrees_of_freedom)
        assert found.parameters.k == pytest.approx(1.992, abs=2e-3)  # t of 76 degrees of freedom


@every_language
def test_what_residuals_say_is_said(content: Content, language: str) -> None:
    words = Words(language)
    (said,) = map(plain, scatter(content, words))
    assert "0.007" in said
    assert "76" in said
    more = ReadingScatter(
        factor=1.93, unexplained_mm=0.0123, degrees_of_freedom=3.0, places=3, place_factor=4.9,
    )  # fmt: skip
    changed = replace(content, fit=replace(content.fit, reading_scatter=more, chi2_per_dof=3.7))
    scaled, unexplained, places, few = map(plain, scatter(changed, words))
    assert "1.93" in scaled
    assert "0.012 mm" in unexplained
    assert "4.9" in places
    assert "3" in few
    for section in (flat(uncertainty_statement(changed, words)), flat(parameters(changed, words))):
        assert "1.93" in section


@every_language
def test_what_held_is_in_the_table_and_what_did_not_is_a_caution(content: Content, language: str) -> None:
    words = Words(language)
    judged = [
        JudgedReadings("left-out", Coverage(SMALL, LARGE, list(CAUSES))),
        JudgedReadings("evaluated", Coverage(None, LARGE)),
    ]
    said = flat(quality(replace(content, coverage=judged), words))
    assert "1000 600 60.0 56.9 … 63.0" in said
    assert said.count("400 400 100.0 99.0 … 100.0") == 2
    assert plain(words("coverage.factor", factor=("2.1",), quantity=words("coverage.points"))) in said
    assert "0.31" in said
    for cause in CAUSES:
        assert plain(words(f"coverage.likely-{cause}")) in said
    assert "600" in render(replace(content, coverage=judged), language)


@every_language
@pytest.mark.parametrize("why", [Unknown("freedom"), Unknown("loss", "huber", 1.61), Unknown("earlier")])
def test_why_there_is_no_uncertainty(content: Content, language: str, why: Unknown) -> None:
    words = Words(language)
    changed = replace(content, parameters=replace(content.parameters, unknown=why))
    for section in (parameters(changed, words), uncertainty_statement(changed, words)):
        said = flat(section)
        assert plain(words(f"parameters.no-u-{why.kind}", loss=why.loss, each=("1.6",))) in said


def test_a_report_takes_it_from_the_files_and_checks_them(unstated: Path, tmp_path: Path) -> None:
    study = Study.load(unstated.parent.parent / "study.toml")
    cross = ulna.cross_validate(study, 4)
    evaluated = ulna.evaluate(unstated, Study.load(write_lengths(tmp_path / "fresh", rows=40)))
    cross.save(tmp_path / "cross")
    evaluated.save(tmp_path / "evaluated")
    files = {
        "cross_validation": tmp_path / "cross" / "cross-validation.json",
        "evaluation": tmp_path / "evaluated" / "evaluation.json",
    }
    found = {each.readings: each.coverage for each in gather(unstated, **files).coverage}
    assert found == {"left-out": cross.coverage, "evaluated": evaluated.coverage}

    def damaged(change: Callable[[dict[str, Any]], None]) -> str:
        document = json.loads(files["evaluation"].read_text())
        change(document["coverage"])
        (tmp_path / "damaged.json").write_text(json.dumps(document))
        with pytest.raises(UlnaInputError) as caught:
            gather(unstated, evaluation=tmp_path / "damaged.json")
        return str(caught.value)

    assert "key 'coverage.lengths.inside': " in damaged(lambda entry: entry["lengths"].update(inside="many"))
    assert "key 'coverage.lengths.low' is missing. The file was changed" in damaged(
        lambda entry: entry["lengths"].pop("low")
    )


def test_an_older_file_without_it_has_no_such_table(unstated: Path, tmp_path: Path) -> None:
    study = Study.load(unstated.parent.parent / "study.toml")
    document = ulna.cross_validate(study, 4).as_dict()
    del document["coverage"]
    (tmp_path / "cross-validation.json").write_text(json.dumps(document))
    assert gather(unstated, cross_validation=tmp_path / "cross-validation.json").coverage == []


def test_the_digital_certificate_has_the_scatter(unstated: Path, tmp_path: Path) -> None:
    plain_xml = dcc_certificate(unstated, EXAMPLE).content.decode()
    assert "Scatter of a touch per coordinate, as the residuals show it" in plain_xml
    assert "estimated from the residuals" in plain_xml
    scaled = dcc_certificate(half_stated(tmp_path), EXAMPLE).content.decode()
    assert "Scatter of the readings over the stated noise" in scaled
    assert "does not explain, beside the stated noise" in scaled
    assert "stated by the study, and multiplied by 2" in scaled
    assert "Student's t with 76 degrees of freedom" in scaled
