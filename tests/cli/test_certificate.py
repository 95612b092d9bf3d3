"""`ulna certificate`: what it prints, writes and refuses."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest
from tests import dcc_reading as reading
from tests.cli_runs import assert_bad_input, run
from tests.pdf_reading import Pdf, holds

HERE = Path(__file__).resolve().parents[1]
RESULT = HERE / "data" / "fossils" / "result-1.json"
LABORATORY = HERE.parent / "examples" / "platinum" / "laboratory.toml"


def test_it_writes_a_certificate_and_says_what_is_in_it(tmp_path: Path) -> None:
    out = tmp_path / "made" / "certificate.xml"
    done = run("certificate", RESULT, LABORATORY, "--dcc", "-o", out)
    assert done.returncode == 0, done.stderr
    for text in ("EX-2026-0042", "DCC 3.3.0, not signed", "17 parameters", "k = 1.96", "1 held, 4 not determined"):
        assert text in done.stdout
    assert max(map(len, done.stdout.splitlines())) <= 80
    assert "unsigned draft" in done.stderr
    assert "The laboratory checks it and signs it" in done.stderr
    assert len(reading.named(out.read_bytes(), "Fitted parameters").values) == 17
    again = run("certificate", RESULT, LABORATORY, "--dcc", "-o", out)
    assert_bad_input(again, f"{out}: exists already", "--force")
    before = out.read_bytes()
    assert run("certificate", RESULT, LABORATORY, "--dcc", "-o", out, "--force").returncode == 0
    assert out.read_bytes() == before


def test_the_machine_form(tmp_path: Path) -> None:
    out = tmp_path / "c.xml"
    done = run("certificate", RESULT, LABORATORY, "--dcc", "-o", out, "--json")
    found = json.loads(done.stdout)
    assert (found["file"], found["signed"], found["bytes"]) == (str(out), False, out.stat().st_size)
    assert found["parameters"]["fitted"] == 17
    assert found["missing"] == []


def test_what_the_laboratory_left_out_is_told(tmp_path: Path) -> None:
    text = LABORATORY.read_text(encoding="utf-8")
    start, end = text.index("[traceability]"), text.index("[[method]]")
    (tmp_path / "lab.toml").write_text(text[:start] + text[end:], encoding="utf-8")
    done = run("certificate", RESULT, tmp_path / "lab.toml", "--dcc", "-o", tmp_path / "c.xml")
    assert done.returncode == 0, done.stderr
    assert "no statement on traceability ([traceability])" in done.stdout


def test_a_folder_of_results_will_do(tmp_path: Path) -> None:
    shutil.copy(RESULT, tmp_path / "result.json")
    assert run("certificate", tmp_path, LABORATORY, "--dcc", "-o", tmp_path / "c.xml").returncode == 0


def test_on_paper_it_is_short_and_the_annex_is_asked_for(tmp_path: Path) -> None:
    short, long = tmp_path / "short.pdf", tmp_path / "long.pdf"
    done = run("certificate", RESULT, LABORATORY, "-o", short)
    assert done.returncode == 0, done.stderr
    assert "unsigned draft" in done.stderr
    found = json.loads(
        run("certificate", RESULT, LABORATORY, "--annex", "--language", "de", "-o", long, "--json").stdout
    )
    assert found == {"file": str(long), "format": "PDF", "issued": False, "signed": False, "annex": True}
    pages = [len(Pdf(path.read_bytes()).texts) for path in (short, long)]
    assert pages[0] <= 3 < pages[1]
    holds(Pdf(long.read_bytes()), "Anhang: Diagnose der Kalibrierung", "Der Anhang ist Teil dieses Kalibrierscheins.")
    assert_bad_input(run("certificate", RESULT, LABORATORY, "-o", short), f"{short}: exists already", "--force")


def test_make_lab_writes_a_file_to_fill_in(tmp_path: Path) -> None:
    out = tmp_path / "lab.toml"
    done = run("certificate", "--make-lab", "-o", out)
    assert done.returncode == 0, done.stderr
    assert "fill it in" in done.stderr
    before = out.read_bytes()
    assert_bad_input(run("certificate", "--make-lab", "-o", out), f"{out}: exists already")
    assert_bad_input(run("certificate", "--make-lab", "-o", out, "--force"), "--make-lab", "--force")
    assert out.read_bytes() == before
    unfilled = run("certificate", RESULT, out, "--dcc", "-o", tmp_path / "c.xml")
    assert_bad_input(unfilled, f"{out}: ", "problems:\n- ", "- key 'certificate.identifier'", "fill it in")
    assert not (tmp_path / "c.xml").exists()


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        ([RESULT, LABORATORY, "-o", "c.odt"], ("ends in .odt", "expected .pdf or .xml")),
        ([RESULT, LABORATORY, "--dcc", "--pdf", "-o", "c.pdf"], ("--dcc and --pdf", "one file cannot be both")),
        ([RESULT, LABORATORY, "--annex", "-o", "c.xml"], ("option --annex", "is of a PDF", "ending in .pdf")),
        ([RESULT, LABORATORY, "--dcc", "-o", "c.pdf"], ("option --dcc", "c.pdf ends in .pdf")),
        ([RESULT, LABORATORY, "--language", "fr", "-o", "c.pdf"], ("--language", "en, de or zh")),
        ([RESULT, LABORATORY, "--dcc"], ("option -o is missing", "Add -o FILE")),
        ([RESULT, "--dcc", "-o", "c.xml"], ("argument LAB is missing", "--make-lab")),
        (["--dcc", "-o", "c.xml"], ("argument RESULT is missing",)),
        ([RESULT, "--make-lab", "-o", "c.xml"], ("--make-lab", "takes no RESULT")),
        ([RESULT, RESULT, "--dcc", "-o", "c.xml"], ("not valid TOML", "a laboratory file")),
        ([LABORATORY, LABORATORY, "--dcc", "-o", "c.xml"], ("not valid JSON", "a result.json")),
        ([RESULT, "none.toml", "--dcc", "-o", "c.xml"], ("none.toml: no such file", "a laboratory file")),
    ],
)
def test_what_is_wrong_is_told(arguments: list[str | Path], expected: tuple[str, ...]) -> None:
    assert_bad_input(run("certificate", *arguments), *expected)
    assert not Path("c.xml").exists()


def test_inputs_are_never_overwritten(tmp_path: Path) -> None:
    for path in (RESULT, LABORATORY):
        copy = tmp_path / path.name
        shutil.copy(path, copy)
    result, laboratory = tmp_path / RESULT.name, tmp_path / LABORATORY.name
    for target in (result, laboratory):
        before = target.read_bytes()
        done = run("certificate", result, laboratory, "--dcc", "-o", target, "--force")
        assert_bad_input(done, f"{target}: is an input of this run")
        assert target.read_bytes() == before
