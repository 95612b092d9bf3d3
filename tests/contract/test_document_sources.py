"""What every source of documents owes: read with its SHA-256, of this arm or said not to be, refused in words.

A new source is held to all of this by its row and an example here of a file of this arm and of one of another.
"""

from __future__ import annotations

import hashlib
import inspect
import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from tests.cli_runs import write_lengths
from tests.documents.test_acceptance import document as verification_document
from tests.reports import calibrated

import ulna
from ulna import UlnaInputError
from ulna.arm.arm import Arm
from ulna.cli.report import report
from ulna.documents.content.content import Content
from ulna.documents.gather import gather
from ulna.documents.languages.words import dictionary
from ulna.documents.sources.result import read_calibration, result_file
from ulna.documents.sources.source import Calibration, take
from ulna.documents.sources.sources import SOURCES

#: what another arm's file leads to: a key of what is said, or the words of the refusal; None: nothing can tell
STRANGE = {
    "study": r"was not made from it",
    "laboratory": None,
    "verification": "verification.other-arm",
    "cross-validation": "held-out.other-study",
    "evaluation": r"is an evaluation of another arm",
}


@pytest.fixture(scope="module")
def calibration(tmp_path_factory: pytest.TempPathFactory) -> Calibration:
    return read_calibration(calibrated(write_lengths(tmp_path_factory.mktemp("own"))))


def written(name: str, result: Path, folder: Path, root: Path) -> Path:
    """A file of this source, of the arm of that result."""
    study = result.parent.parent / "study.toml"

    def fresh() -> ulna.Study:
        """Readings that were not fitted."""
        return ulna.Study.load(write_lengths(folder / "fresh", rows=30))

    makers: dict[str, Callable[[], Path]] = {
        "study": lambda: study,
        "laboratory": lambda: root / "examples" / "platinum" / "laboratory.toml",
        "verification": lambda: _json(folder / "verification.json", verification_document(result)),
        "cross-validation": lambda: _saved(ulna.cross_validate(ulna.Study.load(study), by=4), folder, name),
        "evaluation": lambda: _saved(ulna.evaluate(Arm.load(result), fresh()), folder, name),
    }
    return makers[name]()


def _json(path: Path, content: object) -> Path:
    path.write_text(json.dumps(content), encoding="utf-8")
    return path


def _saved(made: object, folder: Path, name: str) -> Path:
    made.save(folder / name)
    return folder / name / f"{name}.json"


@pytest.fixture(scope="module")
def own(calibration: Calibration, tmp_path_factory: pytest.TempPathFactory, root: Path) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("sources")
    return {name: written(name, calibration.file.path, folder, root) for name in SOURCES}


@pytest.fixture(scope="module")
def foreign(tmp_path_factory: pytest.TempPathFactory, root: Path) -> dict[str, Path]:
    """The same of another calibration."""
    folder = tmp_path_factory.mktemp("foreign")
    other = calibrated(write_lengths(folder / "study", rows=90))
    return {name: written(name, other, folder, root) for name in SOURCES}


every_source = pytest.mark.parametrize("name", SOURCES)


def test_every_source_has_an_example() -> None:
    assert set(STRANGE) == set(SOURCES)


@every_source
def test_a_row_is_called_as_the_command_and_gather_call_it(name: str) -> None:
    assert SOURCES[name].name == name
    option = name.replace("-", "_")
    assert option in inspect.signature(report).parameters
    assert option in inspect.signature(gather).parameters or option == "verification"  # there it is `verified`


@every_source
def test_it_is_read_and_named_with_its_hash(name: str, own: dict[str, Path], calibration: Calibration) -> None:
    taken = take(SOURCES[name], own[name], calibration)
    assert taken.remarks == []
    assert taken.file.name == own[name].name
    assert taken.file.sha256 == hashlib.sha256(own[name].read_bytes()).hexdigest()
    again = take(SOURCES[name], own[name], calibration)
    assert again.file == taken.file


@every_source
def test_one_of_another_arm_is_refused_or_said(name: str, foreign: dict[str, Path], calibration: Calibration) -> None:
    expected = STRANGE[name]
    if expected is None:
        assert take(SOURCES[name], foreign[name], calibration).remarks == []
    elif expected in dictionary("en"):
        said = take(SOURCES[name], foreign[name], calibration).remarks
        assert [each.key for each in said] == [expected]
        assert foreign[name].name in said[0].values.values()
    else:
        with pytest.raises(UlnaInputError, match=expected) as caught:
            take(SOURCES[name], foreign[name], calibration)
        assert str(foreign[name]) in str(caught.value)


@every_source
def test_another_kind_of_file_is_refused_with_what_was_expected(
    name: str, own: dict[str, Path], calibration: Calibration, tmp_path: Path
) -> None:
    source = SOURCES[name]
    wrong = tmp_path / own[name].name
    text = own[name].read_text(encoding="utf-8")
    wrong.write_text(re.sub(rf"{source.format}/\d", "ulna-other/1", text, count=1), encoding="utf-8")
    with pytest.raises(UlnaInputError, match=rf"{re.escape(str(wrong))}.*{source.format}"):
        take(source, wrong, calibration)


@every_source
def test_a_file_that_is_not_there_is_told(name: str, calibration: Calibration, tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError, match="no such file"):
        take(SOURCES[name], tmp_path / "none", calibration)


def test_all_of_them_in_one_document(own: dict[str, Path], calibration: Calibration) -> None:
    """Each by its name and SHA-256, the study among the files of the result, the others beside it."""
    content: Content = gather(
        calibration.file.path,
        study=own["study"],
        cross_validation=own["cross-validation"],
        evaluation=own["evaluation"],
        laboratory=own["laboratory"],
        verified=own["verification"],
    )
    digests = {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in own.items()}
    beside = {file.name: file.sha256 for file in content.provenance.beside}
    assert beside == {own[name].name: digest for name, digest in digests.items() if name != "study"}
    assert digests["study"] in {file.sha256 for file in content.provenance.files}
    assert content.provenance.result_sha256 == calibration.file.sha256


def test_a_folder_stands_for_its_result(calibration: Calibration) -> None:
    assert result_file(calibration.file.path.parent) == calibration.file.path
    assert read_calibration(calibration.file.path.parent).file.sha256 == calibration.file.sha256
