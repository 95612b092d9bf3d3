"""`ulna record` as people type it: the whole way of an arm, and the ways that are none."""

from __future__ import annotations

import json
import os
import shutil
import sqlite3
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from tests.cli.faults import EXAMPLE
from tests.cli_runs import assert_bad_input, run, strict_json
from tests.real_parts import lacking

from ulna.records.records import Records

FOSSILS = EXAMPLE.parents[1] / "tests" / "data" / "fossils"
RESULT, EVALUATION = FOSSILS / "result-1.json", FOSSILS / "evaluation-1.json"
_WITHOUT = "-dac_override,-dac_read_search"
"""What lets root write where permissions say no."""


def record(folder: Path, *words: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """With the record named by the environment, and nobody's settings."""
    where = {"ULNA_RECORDS": str(folder), "ULNA_BY": "Jan", "XDG_CONFIG_HOME": str(folder.parent / "none")}
    return run("record", *words, **(where | environment))


def done(*given: str | Path, folder: Path, code: int = 0) -> str:
    """What a command says, of both streams."""
    found = record(folder, *given)
    assert found.returncode == code, found.stderr
    assert "Traceback" not in found.stderr
    return found.stdout + found.stderr


def test_the_whole_way_of_an_arm(tmp_path: Path) -> None:
    bench, out = tmp_path / "bench", tmp_path / "out"
    assert f"ULNA_RECORDS={bench}" in done("init", bench, folder=bench)
    assert "P7: arm, in use. Entry 1." in done("arm", "P7", "--serial", "P07-0815", folder=bench)
    value = ["--value", "length=443.172±0.001", "--number", "EX-1", "--valid-to", "2099-01-01"]
    assert "KB-443" in done("artefact", "KB-443", *value, folder=bench)
    made = run("calibrate", EXAMPLE / "study.toml", "-o", out, "--record", "P7", ULNA_RECORDS=str(bench))
    assert made.returncode == 0, made.stderr
    assert "calibration of P7: filed (" in made.stderr
    said = done("add", EVALUATION, "--arm", "P7", "--at", "2026-11-29", "--on", "KB-443", folder=bench)
    assert f"{EVALUATION}: evaluation of P7, filed (" in said
    assert "was there already" in done("add", EVALUATION, "--arm", "P7", folder=bench)
    listed = strict_json(record(bench, "list", "--json").stdout)["equipment"]
    assert [(each["name"], each["kind"]) for each in listed] == [("KB-443", "artefact"), ("P7", "arm")]
    history = strict_json(record(bench, "history", "P7", "--json").stdout)["history"]
    assert {each["what"] for each in history} == {"registered", "calibration", "evaluation"}
    (filed,) = strict_json(record(bench, "add", EVALUATION, "--arm", "P7", "--json").stdout)["filed"]
    assert "of P7" in done("show", filed["sha256"][:12], "-o", tmp_path / "again.json", folder=bench)
    assert (tmp_path / "again.json").read_bytes() == EVALUATION.read_bytes()
    certificate = tmp_path / "certificate.xml"
    said = done("issue", "P7", EXAMPLE / "laboratory.toml", "--number", "C-1", "-o", certificate, folder=bench)
    assert f"Certificate C-1 of P7: issued. Written: {certificate}" in said
    assert "withdrawn" in done("withdraw", "C-1", "--reason", "the wrong bar", folder=bench)
    found = strict_json(record(bench, "verify", "--json").stdout)
    assert (found["good"], found["entries"]) == (True, 7)
    assert "Head: " + found["head"] in done("export", "-o", tmp_path / "b.zip", folder=bench)
    assert found["head"] in done("backup", tmp_path / "backups", folder=bench)
    done("import", tmp_path / "b.zip", tmp_path / "there", folder=bench)
    done("verify", "--head", found["head"], folder=tmp_path / "there")
    (bench / "record.sqlite").unlink()
    assert "made anew from 7 entries" in done("rebuild", folder=bench)
    done("verify", "--head", found["head"], folder=bench)
    assert "schema already" in done("migrate", folder=bench)


@pytest.mark.parametrize(("zone", "language"), [("Asia/Kolkata", "C"), ("America/Los_Angeles", "de_DE.UTF-8")])
def test_what_is_shown_is_the_same_everywhere_and_has_room(tmp_path: Path, zone: str, language: str) -> None:
    records = Records.init(tmp_path / "bench", by="Jan")
    records.register("P7", serial="P07-0815", location="measuring room 3, the second table, by the window")
    records.register("KB-443", "artefact")
    records.certify("KB-443", {"length": (443.172, 0.001)}, valid_to="2027-01-01")
    records.event("P7", "knock", "fell against the table while it was carried", at="2026-05-04T23:30+00:00")
    records.add(EVALUATION, arm="P7", at="2026-06-01")
    records.interval("P7", 365, why="as it always was")
    head = records.verify().head
    shown: dict[str, str] = {}
    for where in ({"TZ": zone, "LC_ALL": language}, {"TZ": "UTC", "LC_ALL": "en_GB.UTF-8"}):
        for words in (["list"], ["history", "P7"], ["due", "--on", "2026-12-31"], ["verify"]):
            said = record(tmp_path / "bench", *words, COLUMNS="60", **where).stdout
            assert said == shown.setdefault(words[0], said)
    assert "2026-05-04" in shown["history"]
    assert f"Head: {head}\n" in shown["verify"], "in one piece, to be copied"
    for name in ("list", "history", "due"):
        assert max(len(line.rstrip()) for line in shown[name].splitlines()) <= 60


@pytest.fixture(scope="module")
def pattern(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A record with an arm and a calibration."""
    folder = tmp_path_factory.mktemp("record") / "bench"
    records = Records.init(folder, by="Jan")
    records.register("P7")
    records.add(RESULT, arm="P7")
    return folder


@pytest.fixture
def bench(pattern: Path, tmp_path: Path) -> Iterator[Path]:
    """A copy, to be spoilt."""
    shutil.copytree(pattern, tmp_path / "bench")
    yield tmp_path / "bench"
    for path in (tmp_path / "bench", *(tmp_path / "bench").rglob("*")):
        path.chmod(0o755)


def contents(folder: Path) -> dict[str, bytes | None]:
    """All that is below it, but what a database has beside it while it is open, and what libraries keep for people."""
    names = (path for path in sorted(folder.rglob("*")) if not path.name.endswith(("-wal", "-shm")))
    found = {str(path.relative_to(folder)): path.read_bytes() if path.is_file() else None for path in names}
    return {name: content for name, content in found.items() if not name.startswith("none")}


def refused(bench: Path, words: list[str | Path], *expected: str, **environment: str) -> None:
    """One message, exit code 2, and nothing anywhere that was not there."""
    before = contents(bench.parent)
    found = record(bench, *words, **environment)
    assert_bad_input(found, *expected)
    assert found.stderr.count("error: ") == 1
    assert contents(bench.parent) == before


def test_no_record_is_named(bench: Path) -> None:
    refused(bench, ["list"], "no record is named", "ulna record init DIR", ULNA_RECORDS="")
    refused(bench, ["add", RESULT], "no record is named", ULNA_RECORDS="")


def test_a_folder_that_is_no_record(bench: Path) -> None:
    for folder in (bench.parent, bench.parent / "nowhere", bench / "bench.toml"):
        refused(bench, ["list"], f"{folder}: no record (bench.toml is not there)", ULNA_RECORDS=str(folder))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("format = ", "settings.toml"),
        ('format = "ulna-lab/1"\n', 'expected format = "ulna-settings/1"'),
        ('format = "ulna-settings/1"\n[record]\nfolder = 3\n', "record.folder"),
        ('format = "ulna-settings/1"\n[record]\nfoldr = "x"\n', "foldr"),
        ('format = "ulna-settings/1"\n[record]\nfolder = "/nowhere"\n', "/nowhere: no record"),
        (b"\xff\xfe\x00", "settings.toml"),
    ],
)
def test_a_settings_file_that_is_damaged(bench: Path, text: str | bytes, expected: str) -> None:
    folder = bench.parent / "config" / "ulna"
    folder.mkdir(parents=True)
    (folder / "settings.toml").write_bytes(text if isinstance(text, bytes) else text.encode())
    where = {"ULNA_RECORDS": "", "ULNA_BY": "", "XDG_CONFIG_HOME": str(bench.parent / "config")}
    refused(bench, ["event", "P7", "note", "x"], expected, **where)


def test_an_arm_that_nobody_registered(bench: Path) -> None:
    said = "'P77' is not registered. Did you mean 'P7'?"
    for words in (
        ["history", "P77"],
        ["trend", "P77"],
        ["event", "P77", "note", "x"],
        ["interval", "P77", "--set", "365"],
        ["compare", "P77"],
    ):
        refused(bench, list(words), said)
    found = record(bench, "add", EVALUATION, "--arm", "P77")  # its content may be kept, no entry of it is
    assert_bad_input(found, said)
    out = bench.parent / "out"
    made = run("calibrate", EXAMPLE / "study.toml", "-o", out, "--record", "P77", ULNA_RECORDS=str(bench))
    assert_bad_input(made, said)
    assert not out.exists(), "asked before the long work"
    assert strict_json(record(bench, "verify", "--json").stdout)["entries"] == 2


def test_files_that_are_not_ulna_s(bench: Path, tmp_path: Path) -> None:
    plain, damaged = tmp_path / "table.json", tmp_path / "result.json"
    plain.write_text('{"format": "another/3"}')
    damaged.write_text('{"format": "ulna-result/1"}')
    refused(bench, ["add", plain], "table.json: does not say of which arm it is", "--arm NAME")
    refused(bench, ["add", damaged, "--arm", "P7"], "result.json: ")
    refused(bench, ["add", RESULT, damaged, "--arm", "P7"], "result.json: ")
    refused(bench, ["add", tmp_path / "none.json", "--arm", "P7"], "none.json")
    refused(bench, ["add", EVALUATION, "--arm", "P7", "--study", tmp_path / "none.toml"], "none.toml")
    refused(bench, ["import", plain, tmp_path / "there"], "no zip of a record")
    refused(bench, ["show", "00000000"], "no file or certificate")
    refused(bench, ["issue", "P7", plain], "table.json")
    assert f"{plain}: file of P7, filed" in done("add", plain, "--arm", "P7", folder=bench)


def test_a_file_that_was_withdrawn(bench: Path) -> None:
    (filed,) = strict_json(record(bench, "add", RESULT, "--arm", "P7", "--json").stdout)["filed"]
    done("withdraw", filed["sha256"], "--reason", "the wrong bar", folder=bench)
    refused(bench, ["add", RESULT, "--arm", "P7"], "was withdrawn on", "by Jan: the wrong bar")


def _directory(database: Path) -> None:
    database.unlink()
    database.mkdir()


def _of_others(database: Path) -> None:
    database.unlink()
    connection = sqlite3.connect(database)
    connection.execute("CREATE TABLE entry (name TEXT)")
    connection.close()


def _later(database: Path) -> None:
    connection = sqlite3.connect(database)
    connection.execute("UPDATE alembic_version SET version_num = 'r9999'")
    connection.commit()
    connection.close()


@pytest.mark.parametrize(
    ("spoil", "expected", "next_step"),
    [
        (_directory, "unable to open database file", "See that it is there"),
        (lambda path: path.write_text("no database at all\n" * 500), "file is not a database", "ulna record rebuild"),
        (lambda path: path.write_bytes(path.read_bytes()[:5000]), "malformed", "ulna record rebuild"),
        (lambda path: path.write_bytes(b""), "the database is empty", "ulna record rebuild"),
        (lambda path: path.unlink(), "the database is empty", "ulna record rebuild"),
        (_of_others, "the database is empty", "ulna record rebuild"),
        (_later, "schema r9999, which this Ulna does not know", "newer Ulna"),
    ],
)
def test_a_database_that_is_none(bench: Path, spoil: Callable[[Path], object], expected: str, next_step: str) -> None:
    spoil(bench / "record.sqlite")
    for words in (["list"], ["event", "P7", "note", "x"]):
        found = record(bench, *words)
        assert_bad_input(found, expected, next_step)
        assert found.stderr.count("error: ") == 1


@pytest.mark.parametrize("text", ["", 'format = "ulna-bench/9"\n', 'format = "ulna-bench/1"\ndatabase = "x"\n'])
def test_a_bench_file_that_is_none(bench: Path, text: str) -> None:
    (bench / "bench.toml").write_text(text)
    refused(bench, ["list"], "bench.toml" if "database" not in text else "database x: no URL")


def _without_rights(folder: Path, *words: str | Path) -> subprocess.CompletedProcess[str]:
    """As somebody who may only read it: root may write anywhere, unless it lets go of that."""
    found = shutil.which("setpriv")
    begin: list[str] = []
    if os.getuid() == 0:
        if found is None:
            lacking("setpriv")
        begin = [found, f"--bounding-set={_WITHOUT}", f"--inh-caps={_WITHOUT}"]
    return subprocess.run(
        [*begin, sys.executable, "-m", "ulna", "record", *map(str, words)],
        capture_output=True,
        text=True,
        timeout=60,
        env=os.environ | {"COLUMNS": "80", "TERM": "dumb", "ULNA_RECORDS": str(folder), "ULNA_BY": "Jan"},
        check=False,
    )


@pytest.mark.parametrize("words", [["add", EVALUATION, "--arm", "P7"], ["event", "P7", "note", "x"], ["history", "P7"]])
def test_a_folder_that_may_not_be_written(bench: Path, words: list[str | Path]) -> None:
    for path in (*bench.rglob("*"), bench):
        path.chmod(0o555 if path.is_dir() else 0o444)
    before = contents(bench)
    found = _without_rights(bench, *words)
    assert_bad_input(found, "may not be written by you", "ulna record import ZIP DIR")
    assert contents(bench) == before


def test_originals_that_may_not_be_written(bench: Path) -> None:
    before = json.loads(record(bench, "verify", "--json").stdout)
    for path in (bench / "objects", *(bench / "objects").rglob("*")):
        path.chmod(0o555 if path.is_dir() else 0o444)
    found = _without_rights(bench, "add", EVALUATION, "--arm", "P7")
    assert_bad_input(found, "objects", "cannot be read or written (Permission denied)")
    assert json.loads(record(bench, "verify", "--json").stdout) == before
