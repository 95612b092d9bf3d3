"""What is touched next: by the artefacts of a file, in its order; and whether a touch can be of it at all."""

from __future__ import annotations

import tomllib
from pathlib import Path

import numpy as np
import pytest

from ulna.checking.protocol import load_protocol, plan_of
from ulna.ground.errors import UlnaInputError
from ulna.verification.own_readings import begun, split
from ulna.verification.to_touch import WorkList, work_list

FOSSILS = Path(__file__).parents[1] / "data" / "fossils"
BAR_MM = 500.0 * (1.0 + 11.5e-6)
"""Of the fossil's bar, at its 21 °C."""


def fossil(folder: Path, old: str = "", new: str = "") -> WorkList:
    """The list of the fossil's protocol, changed."""
    text = (FOSSILS / "protocol-1.toml").read_text()
    assert old in text
    (folder / "p.toml").write_text(text.replace(old, new, 1) if old else text)
    return work_list(plan_of(load_protocol(folder / "p.toml"), FOSSILS / "protocol-1.csv"), 6.0)


def test_steps_are_of_the_artefacts_of_the_file(tmp_path: Path) -> None:
    work = fossil(tmp_path)
    assert [(each.test, each.artefact, each.position, each.feature) for each in work.steps] == [
        *(("seat", "", "1", "") for _ in range(5)),
        *(("bar", "stick", place, end) for place in "12" for end in "AB"),
    ]
    assert work.steps[5].what == "stick in place 1: touch seat A"
    assert [len(part) for part in work.parts] == [5, 2, 2]
    assert [each.true_mm for each in work.listed] == [0.0] * 5 + [pytest.approx(BAR_MM)] * 4


def test_a_touch_that_can_hardly_be_of_its_step_is_told(tmp_path: Path) -> None:
    work = fossil(tmp_path)
    here, there = np.array([100.0, 0.0, 0.0]), np.array([100.0 + BAR_MM, 0.0, 0.0])
    assert work.unlikely(6, there, {5: here}) is None
    assert work.unlikely(6, there + 4.0, {5: here}) is None
    said = work.unlikely(6, here + 0.01, {5: here})
    assert said == "it is 0.0 mm from what was touched at A in this place, where 500.0 mm is expected"
    assert work.unlikely(7, here, {5: here, 6: there}) is None, "in the next place the bar may stand anywhere"
    assert work.unlikely(1, here + 0.02, {0: here}) is None
    assert "where 0.0 mm is expected" in (work.unlikely(1, there, {0: here}) or "")


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("lengths = 1", "lengths = 2", r"length-1, length-2: 2 artefacts of kind 'length' are to be touched, and 1"),
        (
            "[temperature]",
            '[artefact.other]\nkind = "length"\nlength = 300.0\nu = 0.001\nends = "seats"\n[temperature]',
            r"which of stick, other is to be touched as length-1 is not said; expected as many of kind 'length'",
        ),
        ('ends = "seats"', 'ends = "opposite-faces"', r"1 artefacts of kind 'length' are to be touched, and 0"),
    ],
)
def test_artefacts_that_do_not_fit_are_told(tmp_path: Path, old: str, new: str, told: str) -> None:
    with pytest.raises(UlnaInputError, match=told):
        fossil(tmp_path, old, new)


def test_of_several_the_shorter_is_touched_first(tmp_path: Path) -> None:
    work = fossil(
        tmp_path,
        "lengths = 1\npositions = 2\nrepeats = 1\n",
        'lengths = 2\npositions = 2\nrepeats = 1\n[artefact.short]\nkind = "length"\nlength = 300.0\nu = 0.001\n'
        'ends = "balls"\n',
    )
    assert [each.artefact for each in work.steps if each.test == "bar"] == ["short"] * 4 + ["stick"] * 4
    assert [work.listed[5].off_mm, work.listed[9].off_mm] == [100.0, 5.0], "balls are touched all around"


def test_the_list_is_tried_before_it_is_touched(tmp_path: Path) -> None:
    fossil(tmp_path).check("as-found")
    with pytest.raises(UlnaInputError, match=r"key 'limit\.E_Bi': no test of profile 'morning' gives it"):
        fossil(tmp_path, "E_Uni", "E_Bi").check("as-found")


HEAD = 'format = "ulna-verify/1"\nprofile = "vdi-2617-9"\n# a remark\n[mpe]\nE_Uni = 0.03\n'
FOUND = '[[readings]]\nfile = "as-found.csv"\nstate = "as-found"\n[readings.columns]\nx = "X"\n'
LEFT = '\n[[readings]]\nfile = "touches.csv"\n'
TAIL = "[fixture]\nu = 0.001\n"


def test_readings_are_taken_out_of_a_file_and_nothing_else() -> None:
    for text in (HEAD + FOUND + LEFT + TAIL, HEAD + TAIL + LEFT + FOUND, FOUND.replace("\n[r", "\n[r") + TAIL):
        head, blocks = split(text, Path("t.toml"))
        known = tomllib.loads(text)
        readings = known.pop("readings")
        assert tomllib.loads(head) == known
        assert [tomllib.loads(block)["readings"] for _, block in blocks] == [[each] for each in readings]
    assert "# a remark" in split(HEAD + FOUND, Path("t.toml"))[0]
    with pytest.raises(UlnaInputError, match=r"t\.toml: key 'readings' is not written as tables of its own"):
        split('readings = [{ file = "a.csv" }]\n' + HEAD, Path("t.toml"))
    with pytest.raises(UlnaInputError, match="key 'readings'"):
        split("no TOML", Path("t.toml"))


def test_as_found_comes_before_as_left(tmp_path: Path) -> None:
    text = (FOSSILS / "verify-1.toml").read_text()
    for name in ("profile-1.toml", "verify-1.csv"):
        (tmp_path / name).write_bytes((FOSSILS / name).read_bytes())
    path = tmp_path / "t.toml"
    made = begun(text, path, "as-left", "arm.toml", tmp_path)
    assert [(each["file"], each["state"]) for each in tomllib.loads(made)["readings"]] == [
        ("verify-1.csv", "as-found"), ("as-left.csv", "as-left"),
    ]  # fmt: skip
    assert tomllib.loads(made)["readings"][0] == tomllib.loads(text)["readings"][0]
    again = begun(text, path, "as-found", "arm.toml", tmp_path)
    assert [each["file"] for each in tomllib.loads(again)["readings"]] == ["as-found.csv"]
    left = text.replace('state = "as-found"', 'state = "as-left"')
    with pytest.raises(UlnaInputError, match="the arm as found comes before the arm as left, which is touched already"):
        begun(left, path, "as-found", "arm.toml", tmp_path)
    (tmp_path / "verify-1.csv").unlink()
    with pytest.raises(UlnaInputError, match="the arm as found comes before the arm as left, and is not touched yet"):
        begun(text, path, "as-left", "arm.toml", tmp_path)
    lonely = begun(left, path, "as-found", "arm.toml", tmp_path)
    assert [each["file"] for each in tomllib.loads(lonely)["readings"]] == ["as-found.csv"]
    assert sorted(each.name for each in tmp_path.iterdir()) == ["profile-1.toml"]
