"""`ulna show`: a page from whatever an arm is in; what is wrong is one sentence, and nothing is written then."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from tests.cli_runs import assert_bad_input, platinum, run, write_lengths
from tests.reports import calibrated
from tests.urdf_texts import Made, urdf

from ulna.arm.arm import Arm
from ulna.arm.effects.effects import Effects
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe

POSE = "10,-20,30,40,-50,60,5"


def here(folder: Path, *arguments: str | Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """`ulna show ARGUMENTS` in a folder."""
    command = [sys.executable, "-m", "ulna", "show", *map(str, arguments)]
    return subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=60, check=False, env=os.environ | environment
    )


def tip_in(page: str) -> list[float]:
    """x, y, z as the page has them before its scripts run."""
    return [float(each) for each in re.findall(r'<output id="tip-[xyz]">([^<]+)</output>', page)]


def same(page: Path, tip_mm: np.ndarray) -> bool:
    return bool(np.abs(np.array(tip_in(page.read_text(encoding="utf-8"))) - tip_mm).max() <= 0.0005 + 1e-9)


def test_an_arm_file_makes_a_page_of_its_name_in_the_present_folder(tmp_path: Path) -> None:
    arm = platinum()
    (tmp_path / "arms").mkdir()
    arm.save(tmp_path / "arms" / "bent one.toml")
    done = here(tmp_path, "arms/bent one.toml", "--pose", POSE)
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""
    expected_mm = arm.tip(np.radians([float(each) for each in POSE.split(",")]))
    x, y, z = (f"{value:.3f}" for value in expected_mm)
    assert done.stderr.startswith("Written: bent one.html ('virtual Platinum', 7 joints, probe 'bent')\n")
    assert f"x = {x}, y = {y}, z = {z} mm" in done.stderr
    assert "alpha of joint k" in done.stderr
    assert same(tmp_path / "bent one.html", expected_mm)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["arms", "bent one.html"]


def test_results_descriptions_and_tables_are_shown_too(tmp_path: Path) -> None:
    q_rad = np.radians([10.0, -20.0, 30.0])
    chain = [Made((0.1, 0.0, 0.2), (0.1, 0.2, 0.3), (0.0, 0.0, 1.0)) for _ in range(3)]
    (tmp_path / "drawn.urdf").write_text(urdf(chain))
    assert run("import", "urdf", tmp_path / "drawn.urdf", "-o", tmp_path / "drawn.toml").returncode == 0
    table = "offset_deg,alpha_deg,a_mm,d_mm\n10,-90,0,100\n20,0,200,0\n30,90,50,60\n"
    (tmp_path / "table.csv").write_text(table)
    options = ["--convention", "dh", "--tip", "1", "2", "3"]
    done = run("import", "dh", tmp_path / "table.csv", "-o", tmp_path / "table.toml", *options)
    assert done.returncode == 0, done.stderr
    for source, more in (("drawn.urdf", []), ("table.csv", options)):
        done = here(tmp_path, source, "--pose", "10,-20,30", *more)
        assert done.returncode == 0, done.stderr
        name = source.split(".")[0]
        assert same(tmp_path / f"{name}.html", Arm.load(tmp_path / f"{name}.toml").tip(q_rad))
    result = calibrated(write_lengths(tmp_path / "study"))
    for source in (result, result.parent):
        done = here(tmp_path, source, "--pose", POSE, "--force")
        assert done.returncode == 0, done.stderr
        name = "result.html" if source == result else "out.html"
        expected_mm = Arm.load(result).tip(np.radians([float(each) for each in POSE.split(",")]))
        assert same(tmp_path / name, expected_mm)


def test_nothing_is_overwritten_unless_asked_and_never_an_input(tmp_path: Path) -> None:
    platinum().save(tmp_path / "arm.toml")
    (tmp_path / "arm.html").write_text("mine")
    assert_bad_input(here(tmp_path, "arm.toml"), "arm.html: exists already", "--force")
    assert (tmp_path / "arm.html").read_text() == "mine"
    before = (tmp_path / "arm.toml").read_bytes()
    assert_bad_input(
        here(tmp_path, "arm.toml", "-o", "arm.toml", "--force"), "arm.toml ends in .toml, which cannot be written"
    )
    assert (tmp_path / "arm.toml").read_bytes() == before
    assert here(tmp_path, "arm.toml", "--force").returncode == 0
    assert (tmp_path / "arm.html").read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["arm.toml", "--pose", "1,2,3"], "option --pose: got 3 angles (1,2,3), expected 7"),
        (["arm.toml", "--pose", "1,2,3,4,5,6,seven"], "option --pose: got 'seven' as angle 7"),
        (["arm.toml", "--probe", "bnt"], "Did you mean 'bent'?"),
        (["arm.toml", "--language", "fr"], "option --language: got 'fr', expected en, de or zh"),
        (["arm.toml", "--convention", "dh"], "option --convention: got it for arm.toml, an arm file"),
        (["arm.toml", "--convention", "craig"], "option --convention: got 'craig'"),
        (["none.toml"], "none.toml: no such file"),
        (["broken.toml"], "broken.toml"),
        (["table.csv"], "expected --convention dh (after) or modified-dh (before)"),
        (["table.csv", "--convention", "dh"], "table.csv"),
        (["arm.stl"], "arm.stl: its ending does not say what it is; expected one of .toml: an arm file"),
        (["empty"], "empty: there is neither result.json nor arm.toml in this folder"),
        (["study/study.toml"], "another kind of file; expected format = \"ulna-arm/1\""),
    ],
)  # fmt: skip
def test_what_is_wrong_is_one_sentence(tmp_path: Path, arguments: list[str], said: str) -> None:
    platinum().save(tmp_path / "arm.toml")
    (tmp_path / "broken.toml").write_text('format = "ulna-arm/1"\nunits = {')
    (tmp_path / "table.csv").write_text("theta,alpha\n1,2\n")
    (tmp_path / "arm.stl").write_text("solid")
    (tmp_path / "empty").mkdir()
    write_lengths(tmp_path / "study")
    before = sorted(path.name for path in tmp_path.iterdir())
    done = here(tmp_path, *arguments)
    assert_bad_input(done, said)
    assert done.stderr.count("\n") == 1, "one line"
    assert sorted(path.name for path in tmp_path.iterdir()) == before


def test_what_the_picture_leaves_open_is_told(tmp_path: Path) -> None:
    joints = (
        Joint(0.1, 1.5, 10.0, 90.0, sign=0),
        Joint(0.1, 1.5, 10.0, 90.0, limits_rad=(-0.5, 0.5)),
        Joint(effects=Effects(backlash_rad=1e-3)),
    )
    Arm("more", joints, {"one": Probe(0.0, 0.0, 50.0), "two": Probe(0.0, 9.0, 50.0)}).save(tmp_path / "arm.toml")
    done = here(tmp_path, "arm.toml", "--pose", "0,40,0", "--probe", "two")
    assert done.returncode == 0, done.stderr
    for said in (
        "probes one, two",
        "not in the picture: ",
        "which way joint 1 counts",
        "joint 2 begins beyond its limits",
    ):
        assert said in done.stderr
    assert "probe two" in re.sub("<[^>]+>", "", (tmp_path / "arm.html").read_text(encoding="utf-8"))


def test_it_opens_in_the_browser_that_there_is(tmp_path: Path) -> None:
    platinum().save(tmp_path / "arm.toml")
    note = tmp_path / "browser.py"
    note.write_text("import json, sys; json.dump(sys.argv[1:], open('opened.json', 'w'))")
    done = here(tmp_path, "arm.toml", "--open", BROWSER=f"{sys.executable} {note} %s")
    assert done.returncode == 0, done.stderr
    assert json.loads((tmp_path / "opened.json").read_text()) == [(tmp_path / "arm.html").resolve().as_uri()]
