"""What is put into a record comes out of it, in both databases; nothing that is refused leaves a trace."""

from __future__ import annotations

import json
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from tests.records.benches import CROSS_VALIDATION, RESULT, ROOT, evaluation, verification

from ulna import UlnaInputError
from ulna.records.outcomes import Recording
from ulna.records.records import Records


def test_everything_that_was_done_is_in_the_history(records: Records) -> None:
    found = records.history("P7")
    assert [(each.at[:10], each.what) for each in found][:2] == [("2026-03-31", "calibration"), ("2026-05-04", "knock")]
    assert {each.by for each in found} == {"Jan"}
    assert "result-1.json, on KB-443" in found[0].text
    assert [each.what for each in records.history("KB-443")] == ["registered", "certified"]
    assert records.history("P07-0815") == found  # by its serial number


def test_a_file_is_kept_as_it_is(records: Records) -> None:
    (row,) = records.calibrations("P7")
    assert records.content(row["sha256"]) == RESULT.read_bytes()
    place = records.bench.files.place(row["sha256"])
    assert place.stat().st_mode & 0o222 == 0


def test_figures_are_those_of_the_file(records: Records) -> None:
    overall = json.loads(RESULT.read_text())["overall"]
    names = {(each.name, each.state) for each in records.series("P7")}
    for state in ("before", "after"):
        said = {name: value for name, value in overall[state].items() if value is not None}
        assert {name for name, of in names if of == state} == set(said)
        for name, value in said.items():
            assert [point.value for point in records.figures("P7", name, state)] == [value]


def test_a_file_that_is_there_stays_as_it_is(records: Records) -> None:
    (first,) = records.add(RESULT, arm="P7")
    assert not first.new
    assert len(records.calibrations("P7")) == 1


def test_several_files_are_filed_together_or_not_at_all(records: Records, tmp_path: Path) -> None:
    broken = tmp_path / "result.json"
    broken.write_text('{"format": "ulna-result/1", "arm": {}}')
    before = records.history("P7")
    with pytest.raises(UlnaInputError, match=r"result\.json"):
        records.add(evaluation(tmp_path / "good.json", 0.02), broken, arm="P7")
    assert records.history("P7") == before
    assert records.verify().good


@pytest.mark.parametrize("path", [RESULT, CROSS_VALIDATION, ROOT / "tests/data/fossils/arm-1.toml", ROOT / "README.md"])
def test_what_a_file_is_is_found_out(records: Records, path: Path) -> None:
    kinds = {
        "result-1.json": "calibration",
        "cross-validation-1.json": "cross-validation",
        "arm-1.toml": "arm",
        "README.md": "file",
    }
    (filed,) = records.add(path, arm="P7")
    assert filed.kind == kinds[path.name]


def test_a_file_of_nobody_s_arm_is_refused(records: Records, tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError, match="is not registered"):
        records.add(evaluation(tmp_path / "e.json", 0.02))
    with pytest.raises(UlnaInputError, match="--arm NAME"):
        records.add(CROSS_VALIDATION)
    with pytest.raises(UlnaInputError, match="registered as artefact; expected arm or robot"):
        records.add(CROSS_VALIDATION, arm="KB-443")


def test_what_was_withdrawn_is_kept_and_counts_no_longer(records: Records, tmp_path: Path) -> None:
    for day, rms in (("2026-01-01", 0.02), ("2026-02-01", 0.9), ("2026-03-01", 0.03)):
        records.add(evaluation(tmp_path / f"{day}.json", rms, f"{day}T12:00:00+00:00"), arm="P7")
    points = records.figures("P7", "length_error_rms_mm", "as-found")
    assert [point.value for point in points] == [0.02, 0.9, 0.03]
    records.withdraw(points[1].sha256[:12], "the wrong probe was on")
    assert [point.value for point in records.figures("P7", "length_error_rms_mm", "as-found")] == [0.02, 0.03]
    assert records.content(points[1].sha256)
    with pytest.raises(UlnaInputError, match="withdrawn already: the wrong probe was on"):
        records.withdraw(points[1].sha256, "again")


def test_what_was_withdrawn_is_not_filed_again(records: Records, tmp_path: Path) -> None:
    records.register("P8")
    path, other = evaluation(tmp_path / "e.json", 0.9), evaluation(tmp_path / "f.json", 0.02)
    (filed,) = records.add(path, arm="P7")
    day = records.withdraw(filed.sha256, "the wrong probe was on").at[:10]
    before = records.verify().entries
    said = rf"e\.json: this file was filed and was withdrawn on {day} by Jan: the wrong probe was on.*write it anew"
    for arm in ("P7", "P8"):  # under another arm it would count as little
        with pytest.raises(UlnaInputError, match=said):
            records.add(other, path, arm=arm)
    assert records.verify().entries == before


def test_due_is_by_the_certificate_of_an_artefact(records: Records) -> None:
    records.certify("KB-443", {"length": (443.1721, 0.001)}, number="EX-2", valid_to="2027-06-30")
    by_name = {each.name: each for each in records.due("2027-07-02")}
    assert (by_name["KB-443"].due, by_name["KB-443"].days) == ("2027-06-30", -2)
    assert by_name["P7"].due is None


def test_impact_is_between_the_last_good_and_the_first_bad(records: Records, tmp_path: Path) -> None:
    for day, value, verdict in (
        ("01-01", 1.0, "pass"),
        ("02-01", 1.1, "pass"),
        ("04-01", 9.0, "fail"),
        ("05-01", 9.1, "fail"),
    ):
        path = verification(tmp_path / f"{day}.json", value, verdict)
        records.add(path, arm="P7", at=f"2026-{day}")
    found = records.impact("P7")
    assert found.good is not None
    assert (found.good[:10], found.bad[:10]) == ("2026-02-01", "2026-04-01")
    assert [each.what for each in found.touched] == ["calibration", "verification"]
    # what an adjustment left says nothing of what was measured before
    records.add(verification(tmp_path / "left.json", 0.5, "pass", "as-left"), arm="P7", at="2026-03-01")
    assert records.impact("P7").good == found.good


def test_what_rests_on_an_artefact(records: Records) -> None:
    found = records.impact("KB-443", since="2026-01-01", until="2026-12-31")
    assert [each.text.split(":")[0] for each in found.touched] == ["P7"]
    assert records.impact("KB-443", since="2026-04-01", until="2026-12-31").touched == []
    with pytest.raises(UlnaInputError, match="--until DAY"):
        records.impact("KB-443")


def test_equipment_keeps_what_is_not_said_anew(records: Records) -> None:
    records.register("P7", location="room 3")
    records.event("P7", "quarantine", "after the knock")
    (arm,) = records.equipment("arm")
    assert (arm["serial"], arm["location"], arm["state"]) == ("P07-0815", "room 3", "quarantined")
    records.event("P7", "release", "checked")
    assert records.equipment("arm")[0]["state"] == "in use"


NAMES = ['O\'Brien "x"; DROP TABLE entry; --', "<script>alert(1)</script>", "ذراع", "臂 7", "%s{0}%(a)s\\"]


@pytest.mark.parametrize("name", NAMES)
def test_names_are_only_names(records: Records, tmp_path: Path, name: str) -> None:
    records.register(name, maker=name, remark=name)
    records.event(name, "note", name)
    path = evaluation(tmp_path / "e.json", 0.02)
    records.add(path, arm=name)
    assert [each.text for each in records.history(name) if each.what == "note"] == [name]
    assert records.figures(name, "length_error_rms_mm")[0].value == 0.02
    assert records.verify().good


@pytest.mark.parametrize("name", ["", " ", "a\nb", "a\x1b[2J", "x" * 201, "\ud800"])
def test_names_that_nobody_can_read_are_refused(records: Records, name: str) -> None:
    with pytest.raises(UlnaInputError, match=r"expected 1 to 200 letters|no UTF-8"):
        records.register(name)


def test_only_one_and_the_same_chain_comes_out_of_an_export(
    records: Records, tmp_path: Path, database: Callable[[], str | None]
) -> None:
    copied = records.export(tmp_path / "bench.zip")
    again = Records.from_export(tmp_path / "bench.zip", tmp_path / "again", database())
    assert again.verify().head == records.verify().head == copied.head
    assert again.verify().good
    assert again.history("P7") == records.history("P7")


def test_the_database_is_made_anew_from_the_files(records: Records) -> None:
    before = records.verify()
    assert records.rebuild() == before.entries
    assert records.verify() == before


def test_a_bench_can_be_moved_whole(tmp_path: Path) -> None:
    Records.init(tmp_path / "here", by="Jan").register("P7")
    (tmp_path / "here").rename(tmp_path / "there")
    records = Records.open(tmp_path / "there")
    assert records.verify().good
    assert [row["name"] for row in records.equipment()] == ["P7"]


def test_a_database_that_was_lost_is_made_anew(tmp_path: Path) -> None:
    records = Records.init(tmp_path / "bench", by="Jan")
    records.register("P7")
    before = records.verify()
    for lost in (b"", b"no database at all" * 500):
        for path in (tmp_path / "bench").glob("record.sqlite*"):
            path.unlink()
        (tmp_path / "bench" / "record.sqlite").write_bytes(lost)
        with pytest.raises(UlnaInputError):
            Records.open(tmp_path / "bench")
        assert records.rebuild() == 1
        assert records.verify() == before


def test_a_database_made_anew_loses_nothing_that_came_in_between(
    tmp_path: Path, database: Callable[[], str | None]
) -> None:
    records = Records.init(tmp_path / "bench", database(), by="Jan")
    records.register("P7")
    with ThreadPoolExecutor(2) as pool:
        writing = pool.submit(lambda: [records.event("P7", "note", f"event {k}") for k in range(12)])
        while not writing.done():
            records.rebuild()
        writing.result()
    assert [each.text for each in records.history("P7") if each.what == "note"] == [f"event {k}" for k in range(12)]
    found = records.verify()
    assert (found.wrong, found.entries) == ([], 13)


def test_a_database_is_put_aside_only_where_it_is_damaged(tmp_path: Path) -> None:
    records = Records.init(tmp_path / "bench", by="Jan")
    records.register("P7")
    records.register("P8")
    (first, *_) = [path for path in (tmp_path / "bench" / "chain").rglob("*") if len(path.name) == 64]
    first.chmod(0o644)
    first.write_text("no entry")
    with pytest.raises(UlnaInputError):
        records.rebuild()
    assert [path.name for path in (tmp_path / "bench").glob("*damaged*")] == []
    assert {row["name"] for row in records.equipment()} == {"P7", "P8"}


def test_impact_since_a_day_looks_at_what_came_after_it(records: Records, tmp_path: Path) -> None:
    for day, verdict in (("01-01", "fail"), ("02-01", "pass"), ("03-01", "pass")):
        records.add(verification(tmp_path / f"{day}.json", 1.0, verdict), arm="P7", at=f"2026-{day}")
    assert records.impact("P7").bad.startswith("2026-01-01")
    with pytest.raises(UlnaInputError, match="no figure of 'P7' failed"):
        records.impact("P7", since="2026-02-15")


def test_checks_of_the_record_are_those_of_one_protocol(records: Records, tmp_path: Path) -> None:
    text = (ROOT / "tests/data/fossils/check-1.json").read_text()
    document = json.loads(text)
    name = document["protocol"]["name"]
    document["protocol"]["name"] = "another"
    for number, each in enumerate((text, json.dumps(document))):
        path = tmp_path / f"{number}.json"
        path.write_text(each)
        records.add(path, arm="P7")
    kept = Recording(records.bench, "P7")
    assert [path.read_text() for path in kept.checks(name)] == [text]
    assert len(kept.checks("another")) == 1
    assert kept.checks("none") == []
