"""Touches of a check as the table that its protocol says, and places named as before."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from tests.cli_runs import platinum

import ulna
from ulna.checking.protocol import load_protocol, plan_of
from ulna.checking.result_file import CheckedTable, load_check
from ulna.checking.to_touch import check_written, named_as_before, readings_text
from ulna.ground.errors import UlnaInputError
from ulna.verification.to_touch import WorkList, work_list

PLATINUM = Path(__file__).parents[2] / "examples" / "platinum"


def protocol(folder: Path, readings: str = "", units: str = 'length = "mm", angle = "rad"', arm: bool = True) -> Path:
    text = (PLATINUM / "protocol.toml").read_text().replace('length = "mm", angle = "rad"', units)
    if not arm:
        text = text.replace('arm = "truth.toml" ', "ball = 0.0\n")
    if 'length = "in"' in units:
        text = text.replace("length = 443.172", f"length = {443.172 / 25.4!r}")
    platinum().save(folder / "truth.toml", force=True)
    path = folder / "p.toml"
    path.write_text(f"{text}\n[readings]\n{readings}" if readings else text)
    return path


def listed(path: Path) -> WorkList:
    made = load_protocol(path)
    names = ["x", "y", "z"] if made.file.arm is None else [f"q{k + 1}" for k in range(7)]
    table = path.parent / "one.csv"
    table.write_text(f"test,{','.join(names)}\nseat,{','.join(['0.1'] * len(names))}\n")
    return work_list(plan_of(made, table), None)


@pytest.mark.parametrize(
    ("readings", "units", "arm"),
    [
        ("", 'length = "mm", angle = "rad"', True),
        ('angle = "deg"\nseparator = ";"\ndecimal = ","\n', 'length = "mm", angle = "rad"', True),
        ('separator = "tab"\ncolumns = { q1 = "J1", test = "what" }\n', 'length = "mm", angle = "deg"', True),
        ("", 'length = "in", angle = "rad"', False),
        ('columns = { x = "X" }\nseparator = "|"\n', 'length = "m", angle = "rad"', False),
    ],
)
def test_touches_come_back_as_they_were_taken(tmp_path: Path, readings: str, units: str, arm: bool) -> None:
    made = load_protocol(protocol(tmp_path, readings, units, arm))
    check_written(made)
    plain = listed(protocol(tmp_path, arm=arm))
    rng = np.random.default_rng(5)
    q_rad = rng.uniform(-1.5, 1.5, (len(plain.listed), 7))
    true = platinum()
    at_mm = true.core.tip(q_rad, 0)
    text = readings_text(made, true, tmp_path / "truth.toml", list(enumerate(plain.steps)), q_rad, at_mm, "bent")
    (tmp_path / "t.csv").write_text(text)
    (found,) = plan_of(made, tmp_path / "t.csv").touches["as-found"]
    assert found.source == ("encoders" if arm else "xyz")
    assert np.abs(found.p_mm - at_mm).max() < 1e-9
    assert found.labels["test"].tolist() == [step.test for step in plain.steps]
    assert found.labels["feature"].tolist() == [step.feature for step in plain.steps]


@pytest.mark.parametrize("key", ['sheet = "S"', "header = false", 'names = { test = { seat = "cone" } }'])
def test_a_table_of_another_program_is_not_written(tmp_path: Path, key: str) -> None:
    with pytest.raises(UlnaInputError, match=rf"p\.toml: key 'readings\.{key.split()[0]}': says how a table"):
        check_written(load_protocol(protocol(tmp_path, key + "\n")))


def test_places_are_named_as_in_an_earlier_check(tmp_path: Path) -> None:
    found = ulna.check(PLATINUM / "protocol.toml", PLATINUM / "morning-11-02.csv", date="2026-11-02")
    found.save(tmp_path / "before.json")
    figures = load_check(tmp_path / "before.json")[0].figures
    work = listed(protocol(tmp_path))
    named = named_as_before(work, figures)
    assert [step.position for step in named.steps] == [""] * 8 + ["front"] * 2 + ["left"] * 2 + ["upright"] * 2
    assert {step.repeat for step in named.steps} == {""}
    assert [each.true_mm for each in named.listed] == [each.true_mm for each in work.listed]
    two = [each for each in figures if each.of.get("position") != "front"]
    assert [step.position for step in named_as_before(work, two).steps[8:]] == ["1", "1", "2", "2", "3", "3"]
    assert named_as_before(work, []).steps == work.steps


def test_a_history_goes_on_with_steps_that_are_named_as_before(tmp_path: Path) -> None:
    """Values of today are judged by those of a table that somebody wrote by hand."""
    for day in ("02", "04"):
        ulna.check(PLATINUM / "protocol.toml", PLATINUM / f"morning-11-{day}.csv", date=f"2026-11-{day}").save(
            tmp_path / f"{day}.json"
        )
    named = named_as_before(listed(protocol(tmp_path)), _figures(tmp_path / "04.json"))
    (touches,) = plan_of(load_protocol(PLATINUM / "protocol.toml"), PLATINUM / "morning-11-06.csv").touches["as-found"]
    assert [(step.test, step.position, step.feature) for step in named.steps] == list(
        zip(*(touches.labels[name].tolist() for name in ("test", "position", "feature")), strict=True)
    )


def _figures(path: Path) -> list[CheckedTable]:
    assert json.loads(path.read_text())["format"] == "ulna-check/1"
    return load_check(path)[0].figures
