"""What the files do not say is asked for, in one sentence that names the options; what cannot be used is refused; and
nothing is written then."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.cli_runs import assert_bad_input, run
from tests.home_built import GERMAN, LENGTH_MM, Kept, measured, text, workbook
from tests.small_study import says

from ulna.cli.asking import proposed
from ulna.ground.errors import UlnaInputError
from ulna.proposals.answers import Answers, UnansweredError
from ulna.proposals.propose import Proposal, propose
from ulna.proposals.write import write_proposal


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Kept:
    """What was measured; the same in all tests."""
    return measured(tmp_path_factory.mktemp("kept"), seed=2)


@pytest.fixture
def complete(tmp_path: Path, kept: Kept) -> Answers:
    """All that is needed beside a text in rad."""
    text(kept, tmp_path / "out.csv", GERMAN, "utf-8", kept.q_rad, ",", ".")
    return Answers(readings=tmp_path / "out.csv", artefact="bar", length=LENGTH_MM, reach=1000.0, parallel=("none",))


def refused(answers: Answers, *fragments: str) -> str:
    """The message about what cannot be used."""
    with pytest.raises(UlnaInputError) as caught:
        propose(answers)
    says(str(caught.value), *fragments)
    return str(caught.value)


def asked(answers: Answers) -> list[str]:
    """The fields that are asked for."""
    with pytest.raises(UnansweredError) as caught:
        propose(answers)
    says(str(caught.value), *(question.flag for question in caught.value.questions))
    return [question.field for question in caught.value.questions]


def edited(path: Path, *changes: tuple[str, str]) -> None:
    """A text with some of it replaced, everywhere."""
    content = path.read_text(encoding="utf-8")
    for old, new in changes:
        assert old in content
        content = content.replace(old, new)
    path.write_text(content, encoding="utf-8")


def test_nothing_said() -> None:
    assert asked(Answers()) == ["readings"]


def test_all_that_a_workbook_does_not_say_is_one_message(tmp_path: Path, kept: Kept) -> None:
    workbook(kept, tmp_path / "book.xlsx")
    assert asked(Answers(readings=tmp_path / "book.xlsx")) == ["artefact", "drawing", "counts_per_turn"]


def test_answers_one_by_one_lead_to_the_proposal(tmp_path: Path, kept: Kept) -> None:
    """As on a terminal: the first question is answered until none is left."""
    workbook(kept, tmp_path / "book.xlsx")
    said = {
        "artefact": "bar",
        "length": "443,172",
        "drawing": "reach 1000",
        "parallel": "none",
        "counts_per_turn": "65536",
    }
    answers, order = Answers(readings=tmp_path / "book.xlsx"), []
    found: Proposal | None = None
    while found is None:
        try:
            found = propose(answers)
        except UnansweredError as error:
            question = error.questions[0]
            order.append(question.field)
            answers = question.answered(answers, said.pop(question.field))
    assert order == ["artefact", "length", "drawing", "parallel", "counts_per_turn"]
    assert found.stated.keys == {"kind": "bar", "length": LENGTH_MM}
    assert found.arm.joints[3].counts_per_turn == 65536
    assert found.arm.unknown_signs.all()


@pytest.mark.parametrize(
    ("field", "typed"),
    [("length", "long"), ("length", "-3"), ("artefact", "stick"), ("drawing", "long"), ("zeros", "maybe")],
)
def test_an_answer_that_is_none(field: str, typed: str) -> None:
    from ulna.proposals.answers import Question

    choices = {"artefact": ("bar", "seat"), "zeros": ("known", "unknown")}.get(field, ())
    with pytest.raises(UlnaInputError, match="expected"):
        Question(field, f"--{field}", "what", choices).answered(Answers(), typed)


def test_a_drawing_is_asked_for_zeros_and_signs(tmp_path: Path, complete: Answers) -> None:
    table = tmp_path / "dh.csv"
    rows = "\n".join(f"{k},0,{90 if k < 6 else 0},0,100" for k in range(1, 7))
    table.write_text(f"joint,theta0_deg,alpha_deg,a_mm,d_mm\n{rows}\n")
    drawn = replace(complete, reach=None, dh=table)
    assert asked(drawn) == ["convention"]
    assert asked(replace(drawn, convention="dh")) == ["zeros", "signs"]
    table.write_text("joint,theta0_deg,alpha_deg,a_mm,d_mm\n1,0,90,0,100\n2,0,0,0,100\n")
    refused(replace(drawn, convention="dh"), "6 columns of angles", "2 joints")


@pytest.mark.parametrize(
    ("change", "value"),
    [
        ({"readings": "no.csv"}, ("no such file", "no.csv")),
        ({"artefact": "stick"}, ("--artefact: got 'stick'", "bar, seat")),
        ({"artefact": "seat"}, ("--length", "seat")),
        ({"angle": "grad"}, ("--angle: got 'grad'", "rad or deg or counts")),
        ({"length": -1.0}, ("--length: got -1",)),
        ({"urdf": "a.urdf"}, ("--reach and --urdf", "said twice")),
        ({"parallel": ("6",)}, ("--parallel: got 6", "1 to 5")),
        ({"columns": ("q1=Achse 9",)}, ("'Achse 9'", "--column")),
        ({"columns": ("placement",)}, ("--column: got 'placement'",)),
        ({"names": ("links",)}, ("--name: got 'links'",)),
        ({"counts_per_turn": (3.0, 4.0)}, ("--counts-per-turn: got 2 numbers", "6")),
    ],
)
def test_what_is_said_and_cannot_be(tmp_path: Path, complete: Answers, change: dict[str, Any], value: tuple) -> None:
    for field in ("readings", "urdf"):
        if field in change:
            change = change | {field: tmp_path / change[field]}
    refused(replace(complete, **change), *value)


def test_files_that_hold_nothing(tmp_path: Path, complete: Answers) -> None:
    path = tmp_path / "empty.csv"
    path.write_text("")
    refused(replace(complete, readings=path), "the file is empty")
    path.write_text("Messung,Achse 1,Achse 2,Ende\n")
    refused(replace(complete, readings=path), "there are no rows")
    path.write_text("Messung,Kraft,Druck\n1,2,3\n2,3,4\n")
    refused(replace(complete, readings=path), "no columns of angles", "'Kraft'", "--column q1=NAME")


def test_small_whole_numbers_may_be_degrees_or_counts(tmp_path: Path, kept: Kept, complete: Answers) -> None:
    text(kept, tmp_path / "out.csv", GERMAN, "utf-8", np.round(np.degrees(kept.q_rad)), ",", ".")
    assert asked(complete) == ["angle"]
    assert propose(replace(complete, angle="deg")).angle == "deg"
    text(kept, tmp_path / "out.csv", GERMAN, "utf-8", kept.q_rad / 10, ",", ".")
    assert asked(complete) == ["angle"]


def test_a_unit_that_the_file_says_is_held_against_what_is_said(tmp_path: Path, kept: Kept, complete: Answers) -> None:
    text(kept, tmp_path / "out.csv", GERMAN, "utf-8", kept.q_rad, ",", ".", " [rad]")
    assert propose(complete).angle_why == "the file says 'rad'"
    refused(replace(complete, angle="deg"), "--angle says deg", "'rad'")


def test_two_sets_of_angles(tmp_path: Path, complete: Answers) -> None:
    """What was wanted is no reading; two that were read are asked about."""
    path = complete.readings
    assert path is not None
    lines = path.read_text(encoding="utf-8").splitlines()
    cells = [line.split(",") for line in lines]
    soll = [[name.replace("Achse", "Soll Achse") for name in cells[0][1:7]], *[row[1:7] for row in cells[1:]]]
    path.write_text("\n".join(",".join(row + more) for row, more in zip(cells, soll, strict=True)), encoding="utf-8")
    found = propose(complete)
    assert [taken.ours for taken in found.taken[-6:]] == [""] * 6
    edited(path, ("Soll Achse", "Geber"))
    assert asked(complete) == ["columns"]
    columns = tuple(f"q{k}=Achse {k}" for k in range(1, 7))
    assert propose(replace(complete, columns=columns)).entry["columns"]["q6"] == "Achse 6"


def test_standings_and_ends_that_no_column_says(complete: Answers) -> None:
    path = complete.readings
    assert path is not None
    edited(path, ("Messung,", "Druck,"))
    assert asked(complete) == ["standing"]
    assert propose(replace(complete, columns=("placement=Druck",))).entry["fill_down"] == ["placement"]
    assert "placement" not in propose(replace(complete, one_standing=True)).entry.get("columns", {})
    content = path.read_text(encoding="utf-8").replace("links", "oben", 20)
    path.write_text(content, encoding="utf-8")
    said = replace(complete, columns=("placement=Druck",))
    assert asked(said) == ["names"]
    both = propose(replace(said, names=("feature.A=links", "feature.A=oben", "feature.B=rechts")))
    assert both.entry["names"] == {"feature": {"A": ["links", "oben"], "B": "rechts"}}


def test_bad_cells_are_named_and_left_out_only_where_that_is_said(tmp_path: Path, complete: Answers) -> None:
    path = complete.readings
    assert path is not None
    lines = path.read_text(encoding="utf-8").splitlines()
    for row, word in ((5, "Fehler"), (9, "")):
        cells = lines[row].split(",")
        cells[3] = word
        lines[row] = ",".join(cells)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    assert asked(complete) == ["skip_bad"]
    refused(complete, "row 5 (line 6", "'Fehler'", "row 9 (line 10")
    found = propose(replace(complete, skip_bad=True))
    assert found.entry["where"] == {"q3": {"not": ["Fehler"], "empty": False}}
    write_proposal(found, tmp_path / "study")


def test_nothing_half_written_and_nothing_overwritten(tmp_path: Path, complete: Answers) -> None:
    """A study that would not load is not written: here the last standing has one end only."""
    path = complete.readings
    assert path is not None
    content = path.read_text(encoding="utf-8").splitlines()
    path.write_text("\n".join([*content[:-2], ""]), encoding="utf-8")
    one_end = propose(complete)
    with pytest.raises(UlnaInputError, match="was never touched") as caught:
        write_proposal(one_end, tmp_path / "study")
    assert ".partial" not in str(caught.value)
    assert not (tmp_path / "study").exists()
    path.write_text("\n".join([*content, ""]), encoding="utf-8")
    write_proposal(propose(complete), tmp_path / "study")
    before = (tmp_path / "study" / "study.toml").read_bytes()
    with pytest.raises(UlnaInputError, match="exists already"):
        write_proposal(propose(replace(complete, length=1.0)), tmp_path / "study")
    assert (tmp_path / "study" / "study.toml").read_bytes() == before
    assert {each.name for each in tmp_path.iterdir()} == {"out.csv", "study"}


def test_the_command_without_a_terminal_asks_in_one_message(tmp_path: Path, complete: Answers) -> None:
    done = run("new", "--readings", complete.readings, "-o", tmp_path / "study")
    assert_bad_input(done, "--artefact bar, seat", "--reach MM", "--dh TABLE")
    assert done.stderr.count("\n") == 1
    assert not (tmp_path / "study").exists()


def test_several_artefacts_in_one_table(complete: Answers) -> None:
    path = complete.readings
    assert path is not None
    edited(path, ("Bemerkung", "Normal"), ("neu aufgelegt", "Stab 1"))
    assert propose(complete).rows == 179
    path.write_text(path.read_text(encoding="utf-8").replace("Stab 1", "Stab 2", 1), encoding="utf-8")
    refused(complete, "column 'Normal' names several artefacts", "'Stab 2', 'Stab 1'")


def test_on_a_terminal_it_asks_until_nothing_is_left(
    complete: Answers, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A wrong answer is told, and asked for again."""
    typed = ["stick", "bar", "long", str(LENGTH_MM), "reach 1000", "9", "none", "perhaps", "no"]
    shown: list[str] = []

    def prompt(text: str, **_: Any) -> str:
        shown.append(text)
        return typed.pop(0)

    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    monkeypatch.setattr("typer.prompt", prompt)
    assert complete.readings is not None
    found = proposed(Answers(), [complete.readings], [])
    assert typed == []
    assert found.stated.keys == {"kind": "bar", "length": LENGTH_MM}
    told = capsys.readouterr().err
    assert "got 'stick'" in told
    assert "--parallel: got 9" in told
    assert shown[0].startswith("What was touched? [bar/")


def test_orientations_are_not_touched(complete: Answers) -> None:
    refused(replace(complete, artefact="orientation"), "--artefact: got 'orientation'", "beside places", "[artefact.")
