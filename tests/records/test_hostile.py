"""What is refused leaves nothing behind; what is taken can be made anew; nothing outside is opened."""

from __future__ import annotations

import json
import os
import random
import sqlite3
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from fuzzing.structure import spoilt
from fuzzing.written import json_text
from tests.records.benches import CROSS_VALIDATION, EVALUATION, RESULT, VERIFICATION, evaluation
from tests.records.serving import Server

from ulna import UlnaInputError
from ulna.records.entry import FORMAT, Entry
from ulna.records.filed.kind import in_utc
from ulna.records.projection import stated_rows
from ulna.records.records import Records
from ulna.records.tables import CALIBRATION, FIGURE, PARAMETER

CHECK = RESULT.with_name("check-1.json")


@pytest.fixture
def plain(tmp_path: Path) -> Records:
    records = Records.init(tmp_path / "plain", by="Jan")
    records.register("P7")
    return records


def kept(records: Records) -> tuple[int, set[str]]:
    """Entries, and names of all files."""
    return records.verify().entries, set(records.bench.files.names())


def test_what_is_taken_can_be_made_anew(plain: Records, tmp_path: Path) -> None:
    """Whatever a reader takes of a spoilt file: rows follow from it, the same each time."""
    taken = 0
    for number in range(300):
        source = random.Random(number)
        path = source.choice([RESULT, EVALUATION, CROSS_VALIDATION, VERIFICATION, CHECK])
        document: Any = json.loads(path.read_text())
        key = source.choice(sorted(document))
        found = spoilt({key: document.pop(key)}, source)
        document = document | found if isinstance(found, dict) else found
        given, text = tmp_path / path.name, json_text(document)
        given.write_bytes(text if isinstance(text, bytes) else text.encode())
        before = kept(plain)[0] if number % 50 == 0 else None
        try:
            taken += len(plain.add(given, arm="P7", at=source.choice([None, "2026-01-01"])))
        except UlnaInputError:
            assert before is None or kept(plain)[0] == before
    found_good = plain.verify()
    assert found_good.good, found_good.wrong
    assert 50 < taken < 290
    assert plain.rebuild() == found_good.entries
    assert plain.verify() == found_good


@pytest.mark.parametrize(
    ("column", "value"),
    [
        (FIGURE.c.value, float("nan")),
        (FIGURE.c.value, 10**400),
        (FIGURE.c.value, None),
        (FIGURE.c.value, True),
        (FIGURE.c.u, "0.1"),
        (FIGURE.c.artefact, "a\0b"),
        (FIGURE.c.artefact, "\ud800"),
        (FIGURE.c.verdict, {"a": 1}),
        (PARAMETER.c.unit, None),
        (CALIBRATION.c.converged, 1),
    ],
)
def test_a_value_that_a_database_cannot_hold_is_refused(column: Any, value: object) -> None:
    with pytest.raises(UlnaInputError, match=f"x.json: {column.table.name} .*{column.name}: got"):
        stated_rows([(column.table, {column.name: value})], "x.json")


def test_what_cannot_be_read_out_of_a_file_is_said(tmp_path: Path) -> None:
    def rows() -> Any:
        yield FIGURE, {"value": 1.0}
        raise KeyError("fit")

    with pytest.raises(UlnaInputError, match=r"x.json: its figures cannot be read out of it \(KeyError: 'fit'\)"):
        stated_rows(rows(), "x.json")


NUMBERS = [5e-324, 2.2250738585072014e-308, -0.0, 1e308, 0.1, 1 / 3, 123456789.123456789]


def test_both_databases_hold_equal_numbers(records: Records, tmp_path: Path) -> None:
    for k, value in enumerate(NUMBERS):
        records.add(evaluation(tmp_path / f"{k}.json", value), arm="P7", at=f"2026-01-0{k + 1}")
    points = records.figures("P7", "length_error_rms_mm", "as-found")
    assert [point.value.hex() for point in points] == [(value or 0.0).hex() for value in NUMBERS]
    assert records.verify().good


def test_letters_are_kept_as_they_are_said(records: Records) -> None:
    composed, decomposed = "M\u00fcller", "Mu\u0308ller"
    records.register(composed)
    records.register(decomposed, remark="another")
    assert {composed, decomposed} <= {row["name"] for row in records.equipment()}
    assert records.equipment() == sorted(records.equipment(), key=lambda row: str(row["name"]))
    assert records.verify().good


def test_what_is_no_plain_file_is_refused(plain: Records, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    large = tmp_path / "large"
    with large.open("wb") as file:
        file.truncate(256 * 2**20 + 1)
    before = kept(plain)
    for path, said in ((tmp_path / "pipe", "a pipe or a device"), (large, "more than 256 MB"), (tmp_path, "a folder")):
        with pytest.raises(UlnaInputError, match=said):
            plain.add(path, arm="P7")
        with pytest.raises(UlnaInputError, match=said):
            plain.event("P7", "note", "x", file=path)
    for path in (Path("/dev/null"), Path("/dev/zero")):
        with pytest.raises(UlnaInputError, match="a pipe or a device"):
            plain.add(evaluation(tmp_path / "e.json", 0.1), arm="P7", with_it={"study": path})
    assert kept(plain) == before


@pytest.mark.parametrize("name", ["a\nb.txt", "a\u202etxt.exe", "a\x1b[2J"])
def test_a_file_whose_name_cannot_be_shown_is_refused(plain: Records, tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("x")
    before = kept(plain)
    with pytest.raises(UlnaInputError, match="cannot be printed"):
        plain.add(tmp_path / name, arm="P7")
    with pytest.raises(UlnaInputError, match="cannot be printed"):
        plain.event("P7", "note", "x", file=tmp_path / name)
    assert kept(plain) == before


@pytest.mark.parametrize("outside", ["../secret", "{folder}/secret", "link"])
def test_nothing_beside_a_result_is_opened_outside_its_folder(plain: Records, tmp_path: Path, outside: str) -> None:
    secret = tmp_path / "secret"
    secret.write_text("secret")
    inner = tmp_path / "inner"
    inner.mkdir()
    document = json.loads(RESULT.read_text())
    name = outside.format(folder=tmp_path)
    document["residuals_file"] = {"file": name, "sha256": "0" * 64, "rows": 1}
    (inner / "result.json").write_text(json.dumps(document))
    (inner / "link").symlink_to(secret)
    before = kept(plain)
    with pytest.raises(UlnaInputError, match=r"lies in another folder|is not the file that was written with"):
        plain.add(inner, arm="P7")
    assert kept(plain) == before


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("files", {"file": "../../etc/passwd"}),
        ("files", {"file": 3}),
        ("files", []),
        ("stated", []),
        ("seq", "1"),
        ("seq", True),
        ("seq", 0),
        ("actor", None),
        ("previous", 1),
    ],
)
def test_an_entry_is_none_whose_parts_are_not(key: str, value: object) -> None:
    document = json.loads(Entry(1, "2026-01-01T00:00:00+00:00", "Jan", "person", "Jan", {"roles": []}).text)
    assert document["format"] == FORMAT
    with pytest.raises(ValueError, match=f"its {key} is none"):
        Entry.of_text(json.dumps({**document, key: value}))


def test_a_text_that_is_deeper_than_anybody_writes_is_no_entry() -> None:
    with pytest.raises(ValueError, match="recursion"):
        Entry.of_text("[" * 100_000)


@pytest.mark.parametrize(
    "said", ["", "x", "20260101", "2026-W01-1", "2026-13-01", "0001-01-01T00:00+14:00", "9999-12-31T23:59-12:00"]
)
def test_what_is_no_day_is_refused(plain: Records, said: str) -> None:
    before = kept(plain)
    with pytest.raises(UlnaInputError, match="expected a day or a time"):
        plain.event("P7", "note", "x", at=said)
    for asked in (plain.due, lambda day: plain.impact("P7", until=day)):
        with pytest.raises(UlnaInputError, match="expected a day or a time"):
            asked(said)
    with pytest.raises(UlnaInputError, match="expected a day or a time"):
        plain.add(RESULT, arm="P7", at=said)
    assert kept(plain)[0] == before[0]


def test_times_as_text_are_in_the_order_of_time() -> None:
    """By digits alone: databases differ in where they put "." and "+"."""
    times = ["2026-01-01T12:00:00.5Z", "2026-01-01T12:00:01Z", "2026-01-01T12:00:00Z", "2026-01-01"]
    found = sorted(in_utc(each, "x") for each in times)
    assert [len(each) for each in found] == [len(found[0])] * 4
    assert found[0] == found[1] == in_utc("2026-01-01", "x")
    assert found[2:] == [in_utc(each, "x") for each in times[:2]]


@pytest.mark.parametrize("more", [{"temperature_c": float("nan")}, {"expansion_per_k": float("inf")}])
def test_an_artefact_and_its_certificate_are_entered_together(plain: Records, more: dict[str, Any]) -> None:
    before = kept(plain)
    with pytest.raises(UlnaInputError, match="expected a number"):
        plain.certify("KB", {"length": (443.172, 0.001)}, anew={}, **more)
    with pytest.raises(UlnaInputError, match="size above 0"):
        plain.certify("KB", {"length": (0.0, 0.001)}, anew={})
    assert kept(plain) == before


@pytest.mark.parametrize("value", ["{year:99999999}{n}", "{n:>9999999}", "{n.__class__}", "{n!r}", "{", "{{n}}", "x"])
def test_a_pattern_of_numbers_has_no_other_braces(plain: Records, value: str) -> None:
    with pytest.raises(UlnaInputError, match="expected a pattern"):
        plain.set("numbers", value)


def test_rows_of_a_file_that_is_lost_are_not_called_added(plain: Records) -> None:
    (filed,) = plain.add(RESULT, arm="P7")
    plain.bench.files.place(filed.sha256).unlink()
    wrong = plain.verify().wrong
    assert len(wrong) == 2
    assert not any("it was added" in each for each in wrong)


def test_a_damaged_database_is_said_to_be_so_and_made_anew(plain: Records) -> None:
    plain.add(RESULT, arm="P7")
    before, path = plain.verify(), plain.bench.folder / "record.sqlite"
    with sqlite3.connect(path) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    connection.close()
    whole = path.read_bytes()
    for seed in range(12):
        source, content = random.Random(seed), bytearray(whole)
        for _ in range(400):
            content[source.randrange(100, len(content))] = source.randrange(256)
        for beside in plain.bench.folder.glob("record.sqlite-*"):
            beside.unlink()
        path.write_bytes(content)
        for act in (plain.equipment, plain.verify, lambda: plain.trend("P7", "length_error_rms_mm", state="after")):
            with suppress(UlnaInputError):
                act()
        assert plain.rebuild() == before.entries
        assert plain.verify() == before


def test_a_record_without_any_entry_is_not_made_of_files_alone(plain: Records) -> None:
    import shutil

    plain.add(RESULT, arm="P7")
    shutil.rmtree(plain.bench.folder / "chain")
    for path in plain.bench.folder.glob("record.sqlite*"):
        path.unlink()
    with pytest.raises(UlnaInputError, match="has no entry"):
        plain.rebuild()


@pytest.mark.parametrize(
    "url",
    [
        "postgresql://ulna:secret@127.0.0.1:1/none",
        "postgresql://ulna:secret@127.0.0.1:1/none?secret=1",
        "sqlite:////tmp/other.sqlite",
        "mysql://ulna:secret@h/d",
        "",
    ],
)
def test_a_record_whose_database_is_not_there_is_not_made(tmp_path: Path, url: str) -> None:
    with pytest.raises(UlnaInputError) as told:
        Records.init(tmp_path / "bench", url)
    assert "secret" not in str(told.value)
    assert not (tmp_path / "bench").exists()


def test_an_entry_whose_file_cannot_be_written_counts(plain: Records, monkeypatch: pytest.MonkeyPatch) -> None:
    """It is on the disk in the database: who repeats it would have it twice."""

    def full(content: bytes) -> str:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(plain.bench.links, "put", full)
        with pytest.warns(UserWarning, match=r"entry 2 is in the database.*Do not repeat"):
            plain.event("P7", "note", "first")
    plain.event("P7", "note", "second")
    assert [each.text for each in plain.history("P7") if each.what == "note"] == ["first", "second"]
    assert plain.verify().good
    assert len(list(plain.bench.links.names())) == 3


def test_an_interval_that_ends_after_the_last_day_is_refused(plain: Records) -> None:
    plain.add(RESULT, arm="P7", at="9999-12-01")
    with pytest.raises(UlnaInputError, match="after the year 9999"):
        plain.interval("P7", 365)


def test_what_was_found_bad_before_it_was_good_is_refused(plain: Records) -> None:
    with pytest.raises(UlnaInputError, match="expected good first"):
        plain.impact("P7", since="2026-02-01", until="2026-01-01")


@pytest.mark.parametrize("baseline", [0, -3])
def test_a_chart_has_a_baseline(plain: Records, baseline: int) -> None:
    plain.add(RESULT, arm="P7")
    with pytest.raises(UlnaInputError, match="expected 1 at least"):
        plain.trend("P7", "length_error_rms_mm", state="after", baseline=baseline)


def test_a_server_without_its_tables_is_said_to_be_so(
    tmp_path: Path, postgresql: Server, database: Callable[[], Any]
) -> None:
    url = database()
    if url is None:
        return
    from sqlalchemy import text

    records = Records.init(tmp_path / "bench", url, by="Jan")
    records.register("P7")
    before = records.verify()
    with records.bench.database.writing() as connection:
        connection.execute(text("DROP TABLE figure CASCADE"))
        connection.execute(text("DROP TABLE equipment CASCADE"))
    for act in (records.equipment, lambda: records.event("P7", "note", "x")):
        with pytest.raises(UlnaInputError, match="does not exist"):
            act()
    assert not records.verify().good
    assert records.rebuild() == before.entries
    assert records.verify() == before


def test_a_password_is_kept_nowhere(tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError, match="PGPASSWORD") as caught:
        Records.init(tmp_path / "bench", "postgresql://ulna:secret@127.0.0.1/x")
    assert "secret" not in str(caught.value)
    assert not (tmp_path / "bench").exists()


def test_a_wrong_password_is_said(tmp_path: Path, postgresql: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PGPASSWORD", "another")
    with pytest.raises(UlnaInputError, match="password authentication failed") as caught:
        Records.init(tmp_path / "bench", f"{postgresql.url}/postgres")
    assert "another" not in str(caught.value)
