"""The form of a file by its ending; an ending that cannot be written is told in one sentence."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.cli_runs import assert_bad_input, platinum, run

from ulna.cli.endings import by_ending
from ulna.ground.errors import UlnaInputError

FORMS = {".html": "html", ".pdf": "pdf"}


@pytest.mark.parametrize(
    ("name", "asked", "expected"),
    [
        ("a.html", [], ["html"]),
        ("a.PDF", [], ["pdf"]),
        ("a.pdf", ["pdf"], ["pdf"]),
        ("folder", [], []),
        ("folder", ["pdf", "html"], ["pdf", "html"]),
        ("arm-1.0", [], []),
        ("v1.2.3", [], []),
    ],
)
def test_the_ending_says_it(tmp_path: Path, name: str, asked: list[str], expected: list[str]) -> None:
    assert by_ending(tmp_path / name, FORMS, asked, folder=True) == expected


@pytest.mark.parametrize("name", ["a.docx", "a.htm", "a.xml", "report.PNG"])
def test_what_cannot_be_written_is_one_sentence(tmp_path: Path, name: str) -> None:
    with pytest.raises(UlnaInputError) as told:
        by_ending(tmp_path / name, FORMS, [], folder=True)
    message = str(told.value)
    assert message == f"option -o: {tmp_path / name} ends in {Path(name).suffix.lower()}, which cannot be written; " + (
        "expected .html or .pdf. Correct it."
    )


def test_a_folder_that_is_there_may_be_called_anything(tmp_path: Path) -> None:
    (tmp_path / "all.docs").mkdir()
    assert by_ending(tmp_path / "all.docs", FORMS, [], folder=True) == []


def test_a_file_needs_an_ending_where_no_folder_is_meant(tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError, match=r"has no ending, which cannot be written; expected \.html or \.pdf\."):
        by_ending(tmp_path / "page", FORMS, [], folder=False)


def test_commands_ask_it(tmp_path: Path, root: Path) -> None:
    fossils = root / "tests" / "data" / "fossils"
    platinum().save(tmp_path / "arm.toml")
    result, lab = fossils / "result-1.json", fossils / "lab-1.toml"
    for arguments, said in (
        (["report", result, "-o", tmp_path / "a.docx"], "expected .html or .pdf"),
        (["certificate", result, lab, "-o", tmp_path / "a.txt"], "expected .pdf or .xml"),
        (["show", tmp_path / "arm.toml", "-o", tmp_path / "a.png"], "expected .html or .htm"),
        (["measure", tmp_path / "arm.toml", "none.csv", "-o", tmp_path / "a.docx"], ".parquet"),
    ):
        assert_bad_input(run(*arguments), said)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["arm.toml"]


@pytest.mark.parametrize(("name", "begin"), [("a.html", b"<!doctype html>"), ("a.pdf", b"%PDF")])
def test_a_report_is_what_its_file_is_called(tmp_path: Path, root: Path, name: str, begin: bytes) -> None:
    done = run("report", root / "tests" / "data" / "fossils" / "result-1.json", "-o", tmp_path / name)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / name).read_bytes().lower().startswith(begin.lower())


def test_a_certificate_that_ends_in_xml_needs_no_option(tmp_path: Path, root: Path) -> None:
    fossils = root / "tests" / "data" / "fossils"
    done = run("certificate", fossils / "result-1.json", fossils / "lab-1.toml", "-o", tmp_path / "a.xml")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "a.xml").read_bytes().startswith(b"<?xml")
