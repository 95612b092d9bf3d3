"""`ulna export` and the imports that answer it, as a user runs them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.cli_runs import BENT, STRAIGHT, assert_bad_input, platinum, run
from tests.oracle.drawn import drawn_tips
from tests.urdf_texts import Made, poses, urdf, write

from ulna import Arm

FOSSILS = Path(__file__).parents[1] / "data" / "fossils"
MADE = urdf(
    [
        Made((0.0, 0.0, 0.3), (0.0, 0.0, 0.2), (0.0, 0.0, 1.0)),
        Made((0.2, 0.0, 0.1), (0.1, 1.0, 0.0), (0.0, 1.0, 0.0)),
        Made((0.1, 0.2, 0.1), (0.3, 1.0, 0.0), (1.0, 0.0, 0.0)),
    ]
)


def test_urdf_there_and_back(tmp_path: Path) -> None:
    platinum({"bent": BENT, "straight": STRAIGHT}).save(tmp_path / "arm.toml")
    done = run("export", "urdf", tmp_path / "arm.toml", "-o", tmp_path / "arm.urdf")
    assert (done.returncode, done.stdout) == (0, "")
    assert done.stderr == f"{tmp_path / 'arm.urdf'}: 'virtual Platinum', 7 joints, probes 'bent', 'straight'.\n"
    done = run("import", "urdf", tmp_path / "arm.urdf", "-o", tmp_path / "again.toml", "--tip-link", "bent")
    assert done.returncode == 0, done.stderr
    assert "7 joints, probe 'ball' at link 'bent'.\nThe arm's base frame is that of link 'base_link'." in done.stderr
    tips = [
        Arm.load(tmp_path / f"{name}.toml").tip(poses(7), probe) for name, probe in (("arm", "bent"), ("again", None))
    ]
    assert np.abs(tips[0] - tips[1]).max() < 1e-9
    assert_bad_input(run("export", "urdf", tmp_path / "arm.toml", "-o", tmp_path / "arm.urdf"), "exists already")


def test_a_template(tmp_path: Path) -> None:
    path = write(tmp_path, MADE)
    assert run("import", "urdf", path, "-o", tmp_path / "arm.toml").returncode == 0
    arm = Arm.load(tmp_path / "arm.toml")
    arm.with_parameters(arm.parameters + 1e-3).save(tmp_path / "found.toml")
    out = tmp_path / "out.urdf"
    done = run("export", "urdf", tmp_path / "found.toml", "-o", out, "--template", path)
    assert done.returncode == 0, done.stderr
    assert done.stderr.startswith(f"{out}: 4 origins changed, at most by ")
    assert done.stderr.endswith("link 'tip' ends in probe 'ball'.\n")
    found = Arm.load(tmp_path / "found.toml")
    assert np.abs(drawn_tips(out, "tip", poses(3)) - found.tip(poses(3))).max() < 1e-9
    done = run("export", "urdf", tmp_path / "arm.toml", "-o", out, "--template", path, "--force")
    assert done.stderr == f"{out}: no origin changed, link 'tip' is where probe 'ball' ends: the arm is as drawn.\n"
    assert out.read_bytes() == path.read_bytes()
    for target in (path, tmp_path / "arm.toml"):
        done = run("export", "urdf", tmp_path / "arm.toml", "-o", target, "--template", path, "--force")
        assert_bad_input(done, f"error: {target}: is an input of this run")


def test_what_a_user_is_told(tmp_path: Path) -> None:
    path = write(tmp_path, MADE)
    platinum({"bent": BENT, "straight": STRAIGHT}).save(tmp_path / "arm.toml")
    arm, out = tmp_path / "arm.toml", tmp_path / "out.urdf"
    assert_bad_input(
        run("export", "urdf", arm, "-o", out, "--probe", "bent"), "option --probe: got 'bent'", "--template"
    )
    assert_bad_input(run("export", "urdf", arm, "-o", out, "--tip-link", "l"), "option --tip-link: got 'l' without")
    template = ("--template", path)
    assert_bad_input(run("export", "urdf", arm, "-o", out, *template), "has 2 probes (bent, straight)", "--probe")
    assert_bad_input(run("export", "urdf", arm, "-o", out, *template, "--probe", "bend"), "Did you mean 'bent'?")
    done = run("export", "urdf", arm, "-o", out, *template, "--probe", "bent")
    assert_bad_input(done, f"error: {path}: there are 3 rotary joints", "has 7", "--tip-link")
    assert_bad_input(run("export", "urdf", tmp_path / "no.toml", "-o", out), "no.toml: no such file")
    assert_bad_input(run("export", "urdf", path, "-o", out), "not valid TOML")
    done = run("export", "urdf", arm, "-o", out, "--template", tmp_path / "no.urdf", "--probe", "bent")
    assert_bad_input(done, "no.urdf: no such file; expected a robot description")
    done = run("export", "dh", arm, "-o", out, "--convention", "modified")
    assert_bad_input(done, "option --convention: got 'modified', expected dh or modified-dh.", "'modified-dh'?")
    assert_bad_input(run("export", "dh", arm, "-o", out, "--angle-unit", "grad"), "option --angle-unit: got 'grad'")
    done = run("import", "dh", arm, "-o", out, "--convention", "dh", "--length-unit", "cm")
    assert_bad_input(done, "option --length-unit: got 'cm', expected mm, m or in.")
    assert not out.exists()


@pytest.mark.parametrize("command", ["urdf", "dh"])
def test_numbers_that_no_reading_determined_are_named(tmp_path: Path, command: str) -> None:
    done = run("export", command, FOSSILS / "result-1.json", "-o", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    assert "'fossil', 5 joints, probes 'bent', 'straight'." in done.stderr
    assert "warning: " in done.stderr
    assert (
        "the readings did not determine joint.1.d, probe.straight.x, probe.straight.y, probe.straight.z" in done.stderr
    )


def test_dh_there_and_back(tmp_path: Path) -> None:
    platinum({"bent": BENT, "straight": STRAIGHT}).save(tmp_path / "arm.toml")
    table = tmp_path / "table.csv"
    options = ("--convention", "modified-dh", "--length-unit", "m", "--angle-unit", "deg")
    done = run("export", "dh", tmp_path / "arm.toml", "-o", table, *options)
    assert done.returncode == 0, done.stderr
    assert done.stderr.splitlines()[0] == f"{table}: 'virtual Platinum', 7 joints, probes 'bent', 'straight'."
    at = f"x = {BENT.x_mm:.4f}, y = {BENT.y_mm:.4f}, z = {BENT.z_mm:.4f} mm"
    assert f"Probe 'bent' is at {at} in the frame that turns with joint 7: a controller's tool." in done.stderr
    done = run("import", "dh", table, "-o", tmp_path / "again.toml", "--convention", "modified-dh")
    assert done.returncode == 0, done.stderr
    made, taken = done.stderr.splitlines()
    assert made == f"{tmp_path / 'again.toml'}: 'table', 7 joints, probes 'bent', 'straight'."
    assert taken.startswith("Read: ")
    for probe in ("bent", "straight"):
        tips = [Arm.load(tmp_path / name).tip(poses(7), probe) for name in ("arm.toml", "again.toml")]
        assert np.abs(tips[0] - tips[1]).max() < 1e-9
    assert_bad_input(run("import", "dh", table, "-o", tmp_path / "x.toml"), "Missing option '--convention'")
    assert_bad_input(
        run("import", "dh", table, "-o", table, "--convention", "dh", "--force"), "is an input of this run"
    )


def test_a_makers_table_and_where_the_tip_is(tmp_path: Path) -> None:
    table = tmp_path / "ur.csv"
    table.write_text("theta0,alpha,a,d\n0,90,0,128\n0,0,-612.7,0\n0,90,0,163.9\n0,0,0,92.2\n")
    units = ("--convention", "dh", "--length-unit", "mm", "--angle-unit", "deg")
    done = run("import", "dh", table, "-o", tmp_path / "ur.toml", *units, "--tip", "-1", "0", "-30")
    assert done.returncode == 0, done.stderr
    assert "Hayati joints, because the next axis is (nearly) parallel: 2." in done.stderr
    assert Arm.load(tmp_path / "ur.toml").probes["tip"].tip_mm.tolist() == [-1.0, 0.0, 62.2]
