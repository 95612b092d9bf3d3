"""A certificate is issued whole: numbered once, by as many eyes as are asked for, with the head that it follows."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from typing import Any

import pytest
from tests.cli_runs import run
from tests.pdf_reading import Pdf, holds
from tests.records.benches import ROOT

from ulna import UlnaInputError
from ulna.records import chain, issuing
from ulna.records.bench import Bench
from ulna.records.issuing import Asked
from ulna.records.records import Records

LABORATORY = ROOT / "examples" / "platinum" / "laboratory.toml"


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example, calibrated."""
    out = tmp_path_factory.mktemp("issue") / "out"
    assert run("calibrate", ROOT / "examples" / "platinum" / "study.toml", "-o", out).returncode == 0
    return out / "result.json"


@pytest.fixture
def bench(tmp_path: Path, result: Path) -> Records:
    records = Records.init(tmp_path / "bench", by="Jan")
    records.register("P7")
    records.add(result, arm="P7")
    return records


def sha(records: Records) -> str:
    return str(records.calibrations("P7")[0]["sha256"])


def test_it_says_number_and_head_and_is_no_draft(bench: Records) -> None:
    head = bench.verify().head.split(":")[1]
    made = bench.issue(sha(bench)[:12], LABORATORY)
    holds(Pdf(made.content), made.number, head)
    assert "DRAFT" not in Pdf(made.content).all_text.upper()
    assert bench.content(made.sha256) == made.content
    assert bench.verify().good


def test_numbers_are_given_once(bench: Records) -> None:
    bench.set("numbers", "AB-{n:03}")
    numbers = [bench.issue(sha(bench), LABORATORY, form="dcc").number for _ in range(2)]
    assert numbers == ["AB-001", "AB-002"]
    with pytest.raises(UlnaInputError, match="AB-001 was issued already"):
        bench.issue(sha(bench), LABORATORY, number="AB-001", form="dcc")


@pytest.mark.parametrize("pattern", ["AB", "{year}", "{n", "{0}", "{n.real.__class__}", "a\nb{n}"])
def test_a_pattern_that_counts_nothing_is_refused(bench: Records, pattern: str) -> None:
    with pytest.raises(UlnaInputError, match="setting numbers"):
        bench.set("numbers", pattern)


def test_four_eyes(bench: Records) -> None:
    bench.set("four-eyes", "yes")
    for approved_by in (None, "Jan"):
        with pytest.raises(UlnaInputError, match="four eyes"):
            bench.issue(sha(bench), LABORATORY, approved_by=approved_by)
    with pytest.raises(UlnaInputError, match="'Erika' is no reviewer"):
        bench.issue(sha(bench), LABORATORY, approved_by="Erika")
    bench.person("Erika", ["reviewer"])
    holds(Pdf(bench.issue(sha(bench), LABORATORY, approved_by="Erika").content), "Erika", "Jan")


def test_superseded_and_withdrawn(bench: Records) -> None:
    first = bench.issue(sha(bench), LABORATORY, form="dcc").number
    with pytest.raises(UlnaInputError, match=r"why .* is superseded"):
        bench.issue(sha(bench), LABORATORY, form="dcc", supersedes=first)
    second = bench.issue(sha(bench), LABORATORY, form="dcc", supersedes=first, reason="the customer's name").number
    with pytest.raises(UlnaInputError, match="is superseded: superseded by"):
        bench.issue(sha(bench), LABORATORY, form="dcc", supersedes=first, reason="again")
    bench.withdraw(second, "the wrong bar")
    said = " ".join(each.text for each in bench.history("P7"))
    assert f"supersedes {first}" in said
    assert f"certificate {second} withdrawn: the wrong bar" in said


def test_nothing_is_issued_of_what_was_withdrawn_or_of_a_quarantined_arm(bench: Records) -> None:
    bench.event("P7", "quarantine", "knock")
    with pytest.raises(UlnaInputError, match="is quarantined"):
        bench.issue(sha(bench), LABORATORY, form="dcc")
    bench.event("P7", "release", "checked")
    name = sha(bench)
    bench.withdraw(name, "the wrong study")
    with pytest.raises(UlnaInputError, match="was withdrawn: the wrong study"):
        bench.issue(name, LABORATORY, form="dcc")
    assert bench.verify().good


def test_a_laboratory_file_that_cannot_be_used_leaves_nothing(bench: Records, tmp_path: Path) -> None:
    before = bench.verify().entries
    (tmp_path / "lab.toml").write_text('format = "ulna-lab/1"\n')
    with pytest.raises(UlnaInputError):
        bench.issue(sha(bench), tmp_path / "lab.toml")
    assert bench.verify().entries == before


def test_recall_names_the_certificates(bench: Records) -> None:
    number = bench.issue(sha(bench), LABORATORY, form="dcc").number
    found = bench.impact("P7", since="2020-01-01", until="2099-01-01")
    assert found.certificates == [number]


@pytest.mark.parametrize("often", [1, 2, 5])
def test_others_write_while_it_is_made(bench: Records, monkeypatch: pytest.MonkeyPatch, often: int) -> None:
    """It then names the head that it follows all the same, and the number that is free."""
    other = Records.open(bench.bench.folder, by="Erika")
    made, heads = issuing._made, []

    def meanwhile(of: Bench, wanted: Asked, planned: Any, now: datetime) -> bytes:
        heads.append(planned.head)
        if len(heads) <= min(often, issuing._TIMES):
            other.event("P7", "note", f"event {len(heads)}")
        return made(of, wanted, planned, now)

    monkeypatch.setattr(issuing, "_made", meanwhile)
    found = bench.issue(sha(bench), LABORATORY, form="dcc")
    assert len(heads) == min(often, issuing._TIMES) + 1
    assert found.head == heads[-1]
    assert found.head.encode() in found.content
    with bench.bench.reading() as connection:
        (*_, last) = chain.walk(connection)
    assert (last.act, last.previous) == ("issued", found.head)
    assert bench.verify().good


def test_a_number_that_was_given_meanwhile_is_another(bench: Records, monkeypatch: pytest.MonkeyPatch) -> None:
    other = Records.open(bench.bench.folder, by="Erika")
    made, numbers = issuing._made, []

    def meanwhile(of: Bench, wanted: Asked, planned: Any, now: datetime) -> bytes:
        numbers.append(planned.number)
        if len(numbers) == 1:
            numbers.append(other.issue(sha(bench), LABORATORY, form="dcc").number)
        return made(of, wanted, planned, now)

    bench.set("numbers", "AB-{n}")
    monkeypatch.setattr(issuing, "_made", meanwhile)
    found = bench.issue(sha(bench), LABORATORY, form="dcc").number
    assert (numbers[0], found) == ("AB-1", "AB-2")
    assert bench.verify().good
