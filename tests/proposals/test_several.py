"""Several artefacts make one study: a file for each, several files of one, or one file that names them row by row."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from tests.cli_runs import assert_bad_input, run
from tests.home_built import true_arm
from tests.small_study import says

from ulna import Study
from ulna.cli.asking import proposed
from ulna.ground.errors import UlnaInputError
from ulna.proposals.answers import Answers, UnansweredError
from ulna.proposals.several import Touched, parts_of, propose_all, touched
from ulna.proposals.write import write_proposal
from ulna.simulation.simulate import simulate

SPEC = """format = "ulna-simulation/1"
arm = "true.toml"
units = { length = "mm", angle = "rad" }
noise = { encoder = 2e-5, seat = 0.01 }
travel = { limits = [[-2.5, 2.5]] }
[artefact.stab]
kind = "bar"
placements = 20
length = 443.172
[artefact.platte]
kind = "points"
placements = 6
features = { s1 = [0.0, 0.0, 0.0], s2 = [100.0, 0.0, 0.0], s3 = [0.0, 200.0, 7.0], s4 = [100.0, 200.0, 0.0] }
[artefact.kugel]
kind = "sphere"
diameter = 25.4
placements = 6
"""
NAMES = ("stab", "platte", "kugel")


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A simulation's files, and one table of all of them that names the artefact of each row."""
    folder = tmp_path_factory.mktemp("several")
    arm = true_arm(3)
    replace(arm, probes={"tip": replace(arm.probes["tip"], ball_mm=6.0)}).save(folder / "true.toml")
    (folder / "spec.toml").write_text(SPEC)
    simulate(folder / "spec.toml").save(folder / "made")
    rows = []
    for name in NAMES:
        frame = pl.read_csv(folder / "made" / f"{name}.csv")
        point = frame["feature"] if "feature" in frame.columns else pl.Series([""] * len(frame))
        angles = {f"Achse {k}": frame[f"q{k}"] for k in range(1, 7)}
        labels = [name.capitalize(), *[""] * (len(frame) - 1)]  # as merged cells are written
        rows.append(
            pl.DataFrame(
                {"Prüfkörper": labels, "Aufstellung": frame["placement"].cast(pl.String), **angles, "Punkt": point}
            )
        )
    pl.concat(rows).write_csv(folder / "all.csv")
    return folder


def said(made: Path) -> list[Touched]:
    features = made / "made" / "platte-features.csv"
    return [touched(text) for text in ("stab=bar:443.172:0.001", f"platte=points:{features}", "kugel=sphere:25,4")]


def of_arm(**more: Any) -> Answers:
    return Answers(reach=1000.0, parallel=("none",), ball=6.0, length_unit="mm", **more)


def loaded(parts: list[Answers], folder: Path) -> Study:
    write_proposal(propose_all(parts), folder)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return Study.load(folder / "study.toml")


def assert_the_same_readings(ours: Study, made: Path) -> None:
    theirs = Study.load(made / "made" / "study.toml")
    assert len(ours.readings) == len(theirs.readings) == 3
    for own in ours.readings:
        name = own.artefact.name.casefold()
        other = next(group for group in theirs.readings if group.artefact.name == name)
        assert own.artefact.kind == other.artefact.kind
        np.testing.assert_array_equal(own.q_rad, other.q_rad)
        np.testing.assert_array_equal(own.feature, other.feature)
        assert own.placement.tolist() == [str(each) for each in other.placement.tolist()]
        assert own.artefact.features == other.artefact.features


def test_a_file_for_each_artefact(tmp_path: Path, made: Path) -> None:
    files = [made / "made" / f"{name}.csv" for name in NAMES]
    study = loaded(parts_of(of_arm(), files, said(made)), tmp_path / "study")
    assert_the_same_readings(study, made)
    assert study.readings[0].artefact.u_mm == 0.001


def test_one_file_that_names_the_artefact_of_each_row(tmp_path: Path, made: Path) -> None:
    named = [replace(each, name=str(each.name).capitalize()) for each in said(made)]
    assert_the_same_readings(loaded(parts_of(of_arm(), [made / "all.csv"], named), tmp_path / "study"), made)


def test_several_files_of_one_artefact(tmp_path: Path, made: Path) -> None:
    frame = pl.read_csv(made / "made" / "stab.csv")
    files = [tmp_path / "a.csv", tmp_path / "b.csv"]
    for path, part in zip(files, (frame[:20], frame[20:]), strict=True):
        part.write_csv(path)
    study = loaded(parts_of(of_arm(), files, [touched("bar:443.172")]), tmp_path / "study")
    (group,) = study.readings
    np.testing.assert_array_equal(group.q_rad, frame.select([f"q{k}" for k in range(1, 7)]).to_numpy())


def test_artefacts_that_a_file_names_are_asked_for(made: Path) -> None:
    with pytest.raises(UnansweredError) as asked:
        parts_of(of_arm(), [made / "all.csv"], [touched("Stab=bar:443.172")])
    assert [question.about for question in asked.value.questions] == ["Platte", "Kugel"]
    says(str(asked.value), "what is 'Kugel' in column 'Prüfkörper'", "--artefact 'Kugel=KIND:VALUE'")


def test_what_is_missing_of_several_is_one_message_and_each_thing_once(made: Path) -> None:
    files = [made / "made" / f"{name}.csv" for name in ("stab", "kugel")]
    with pytest.raises(UnansweredError) as asked:
        propose_all(parts_of(Answers(), files, [touched("bar"), touched("ball=sphere")]))
    flags = [question.flag for question in asked.value.questions]
    assert flags[0] == "--artefact bar:MM"
    assert "--artefact ball=sphere:MM" in flags
    assert len(flags) == len(set(flags))


def test_lengths_of_a_study_have_one_unit(tmp_path: Path, made: Path) -> None:
    """The size of a bar is written in the unit of the plate's coordinates; two files in two units are refused."""
    metres = tmp_path / "plate.csv"
    table = pl.read_csv(made / "made" / "platte-features.csv")
    table.select("feature", *(pl.col(axis).truediv(1000).alias(f"{axis} [m]") for axis in "xyz")).write_csv(metres)
    files = [made / "made" / f"{name}.csv" for name in ("stab", "platte")]
    artefacts = [touched("bar:443.172"), touched(f"points:{metres}")]
    study = loaded(parts_of(replace(of_arm(), length_unit=None), files, artefacts), tmp_path / "study")
    assert study.readings[0].artefact.length_mm == pytest.approx(443.172, rel=1e-12)
    millimetres = tmp_path / "other.csv"
    table.rename({axis: f"{axis} [mm]" for axis in "xyz"}).write_csv(millimetres)
    both = [touched(f"a=points:{metres}"), touched(f"b=points:{millimetres}")]
    with pytest.raises(UlnaInputError, match=r"several units: .*plate\.csv in m and .*other\.csv in mm"):
        propose_all(parts_of(replace(of_arm(), length_unit=None), [files[1], files[1]], both))


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["--artefact", "stick:3"], "expected a kind of artefact"),
        (["--artefact", "seat:3"], "has no dimension"),
        (["--artefact", "bar:long"], "expected its length in mm"),
        (["--artefact", "bar:-3"], "expected its length in mm"),
        (["--artefact", "bar:3", "--artefact", "sphere:4"], "got 1 file and 2 artefacts"),
        (["--artefact", "bar", "--artefact", "sphere:4", "--length", "3"], "of which of the 2 artefacts"),
    ],
)
def test_what_cannot_be_is_said(tmp_path: Path, made: Path, arguments: list[str], expected: str) -> None:
    readings = ["--readings", made / "made" / "stab.csv"]
    done = run("new", *readings, *arguments, "--reach", "1000", "--parallel", "none", "-o", tmp_path / "study")
    assert_bad_input(done, expected)
    assert not (tmp_path / "study").exists()


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("bar", Touched("bar")),
        ("bar:443,2", Touched("bar", None, "443,2")),
        ("long=bar:443.2:0.001", Touched("bar", "long", "443.2", 0.001)),
        ("points:C:\\plates\\a.csv", Touched("points", None, "C:\\plates\\a.csv")),
        ("points:a.csv:0.002", Touched("points", None, "a.csv", 0.002)),
    ],
)
def test_an_artefact_in_one_word(text: str, expected: Touched) -> None:
    assert touched(text) == expected


def test_on_a_terminal_more_artefacts_are_asked_for(made: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What was said of the arm is not asked again."""
    ball = made / "made" / "kugel.csv"
    typed = ["bar", "443.172", "reach 1000", "none", f"sphere:25.4 {ball}", "6", "no"]
    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    monkeypatch.setattr("typer.prompt", lambda *_, **__: typed.pop(0))
    found = proposed(Answers(), [made / "made" / "stab.csv"], [])
    assert typed == []
    assert [(each.stated.artefact.name, each.readings.name) for each in found.every] == [
        ("bar", "stab.csv"),
        ("sphere", "kugel.csv"),
    ]
    assert all(probe.ball_mm == 6.0 for probe in found.arm.probes.values())
