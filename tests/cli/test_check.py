"""`ulna check`: in words, in numbers, and by its exit code."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.cli_runs import assert_bad_input, run, strict_json

ROOT = Path(__file__).resolve().parents[2]
PLATINUM = ROOT / "examples" / "platinum"
FOSSILS = ROOT / "tests" / "data" / "fossils"
PROTOCOL, READINGS = FOSSILS / "protocol-1.toml", FOSSILS / "protocol-1.csv"


def test_a_check_is_written_and_is_the_history_of_the_next(tmp_path: Path) -> None:
    checks = tmp_path / "checks"
    first = run("check", PROTOCOL, READINGS, "--date", "2026-11-02T07:45", "--operator", "K.", "-o", checks / "a.json")
    assert first.returncode == 0, first.stderr
    assert f"Written: {checks / 'a.json'}" in first.stderr
    assert "measured 2026-11-02 07:45, by K." in first.stdout
    assert "On the whole: limits: pass; no history was named." in first.stdout
    again = tmp_path / "other.csv"
    again.write_text(READINGS.read_text().replace("500.02", "500.08"))
    second = run("check", PROTOCOL, again, "--history", checks, "--json")
    assert second.returncode == 1, second.stderr
    found = strict_json(second.stdout)
    assert (found["verdict"], found["in_control"]) == ("fail", None)
    assert [each["test"] for each in found["advice"]] == ["bar"]
    assert len(found["provenance"]["history"]) == 1
    assert found["figures"][0]["history"]["said"] == "too few: 1 over 0 days, and at least 4 are needed"
    refused = run("check", PROTOCOL, READINGS, "-o", checks / "a.json")
    assert_bad_input(refused, "a.json: exists already")


def test_encoder_readings_and_what_to_try(tmp_path: Path) -> None:
    done = run("check", PLATINUM / "protocol.toml", PLATINUM / "morning-11-18.csv")
    assert done.returncode == 1, done.stderr
    said = " ".join(done.stdout.split())
    assert "seat: its limit is broken" in said
    assert "1. Touch the seat again" in said
    assert "5. Recalibrate (ulna calibrate)" in said
    assert "On the whole: limits: FAIL; no history was named." in said
    assert max(map(len, done.stdout.splitlines())) <= 80
    assert run("check", PLATINUM / "protocol.toml", PLATINUM / "morning-11-02.csv").returncode == 0


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ('kind = "single-point"', 'kind = "single"', "key 'test.seat.kind'"),
        ("SPAT_max", "SPAT_mx", "key 'limit.SPAT_mx': no test of profile 'morning' gives it"),
        ('rule = "1.65u"', 'rule = "rU"', "key 'decision.r' is missing"),
        ("baseline = 8", "baseline = 3", "control.baseline"),
        ("fewest = 4", "fewest = 9", "expected at least 'control.fewest', 9"),
        ('artefact = "stick"', 'artefact = "stik"', "got 'stik', which"),
        ('"ulna-protocol/1"', '"ulna-verify/1"', 'expected format = "ulna-protocol/1"'),
        ('separator = ","', 'angle = "rad"', "key 'readings.angle'"),
        ('rows = ["six-rising"]', 'rows = ["seven"]', "control.rows"),
        ("points = 5", "points = 900000", "more than anybody measures"),
        ('item = "arm 7"', 'itm = "arm 7"', "Did you mean 'item'"),
    ],
)
def test_what_is_wrong_with_a_protocol_is_told(tmp_path: Path, old: str, new: str, expected: str) -> None:
    text = PROTOCOL.read_text()
    assert old in text
    (tmp_path / "p.toml").write_text(text.replace(old, new, 1))
    assert_bad_input(run("check", tmp_path / "p.toml", READINGS), "p.toml", expected)


def test_what_is_wrong_with_readings_and_history_is_told(tmp_path: Path) -> None:
    encoders = run("check", PROTOCOL, PLATINUM / "morning-11-02.csv")
    assert_bad_input(encoders, "no arm is named; expected the key 'arm' in", "protocol-1.toml")
    assert_bad_input(run("check", PROTOCOL, tmp_path / "none.csv"), "none.csv: no such file")
    assert_bad_input(run("check", PROTOCOL, READINGS, "--history", tmp_path / "none"), "none: no such file")
    assert_bad_input(run("check", PROTOCOL, READINGS, "--history", PROTOCOL), "not valid JSON")
    assert_bad_input(run("check", PROTOCOL, READINGS, "--date", "32.1."), "date: got '32.1.'")
