"""Plan files filled in from an arm and a study: what one of them says is not typed again."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.cli_runs import assert_bad_input, run
from tests.planning.test_plan import BAR, PLATE, limited, spec

import ulna
from ulna.artefacts.artefact import Artefact
from ulna.planning.file import load_plan_spec
from ulna.planning.making import plan_toml
from ulna.planning.measurements import readings_of
from ulna.study.data import FitOptions, Noise
from ulna.study.study import Study


@pytest.mark.parametrize("artefact", [replace(BAR, u_mm=0.002), replace(PLATE, u_mm=0.01)])
def test_a_study_says_artefact_noise_and_hold(tmp_path: Path, artefact: Artefact) -> None:
    arm = limited()
    q_rad = np.zeros((2, len(artefact.features), 1, 7))
    readings = readings_of(arm, spec(artefact), 0, q_rad)
    noise = Noise(np.arange(1, 8) * 1e-6, 0.007)
    study = Study(None, arm, [readings], noise, FitOptions(hold=["joint.1.*"]))
    (tmp_path / "plan.toml").write_text(plan_toml(arm, study, tmp_path))
    found = load_plan_spec(tmp_path / "plan.toml", arm)
    assert found.artefact == artefact
    assert found.encoder_rad.tolist() == (np.arange(1, 8) * 1e-6).tolist()
    assert found.seat_mm == 0.007
    assert found.hold == ["joint.1.*"]
    assert found.travel_rad is None
    assert found.placements == 12


def test_limits_are_the_arms_and_what_is_missing_is_marked(tmp_path: Path) -> None:
    arm = limited()
    joints = [replace(joint, limits_rad=None) if k == 4 else joint for k, joint in enumerate(arm.joints)]
    half = replace(arm, joints=tuple(joints))
    text = plan_toml(half, None, tmp_path)
    (tmp_path / "plan.toml").write_text(text)
    found = load_plan_spec(tmp_path / "plan.toml", half)
    assert found.travel_rad is not None
    expected = [list(joint.limits_rad or (-3.14, 3.14)) for joint in half.joints]
    assert found.travel_rad == pytest.approx(np.array(expected), abs=1e-5)
    assert [line for line in text.splitlines() if "joint" in line and "an example" in line] == [
        "    [-3.14, 3.14], # joint 5: an example"
    ]


def test_limits_that_nobody_states_are_what_was_read(tmp_path: Path) -> None:
    arm = limited()
    bare = replace(arm, joints=tuple(replace(joint, limits_rad=None) for joint in arm.joints))
    q_rad = np.random.default_rng(8).uniform(-2.0, 2.5, (5, 2, 1, 7))
    study = Study(None, bare, [readings_of(bare, spec(BAR), 0, q_rad)])
    text = plan_toml(bare, study, tmp_path)
    (tmp_path / "plan.toml").write_text(text)
    found = load_plan_spec(tmp_path / "plan.toml", bare)
    flat = q_rad.reshape(-1, 7)
    assert found.travel_rad is not None
    assert found.travel_rad.tolist() == np.stack([flat.min(axis=0), flat.max(axis=0)], axis=1).tolist()
    assert text.count("as the study's readings go") == 7


def test_counting_encoders_say_their_noise(tmp_path: Path) -> None:
    arm = limited()
    arm = replace(arm, joints=tuple(replace(joint, counts_per_turn=2.0**16) for joint in arm.joints))
    (tmp_path / "plan.toml").write_text(plan_toml(arm, None, tmp_path))
    found = load_plan_spec(tmp_path / "plan.toml", arm)
    assert found.encoder_rad == pytest.approx(np.full(7, 2 * np.pi / 2**16 / np.sqrt(12)), rel=2e-3)


def test_the_command_writes_a_file_that_plans(tmp_path: Path) -> None:
    limited().save(tmp_path / "arm.toml")
    done = run("plan", tmp_path / "arm.toml", "--make-plan", tmp_path / "plan.toml")
    assert done.returncode == 0, done.stderr
    assert "ulna plan" in done.stderr
    found = load_plan_spec(tmp_path / "plan.toml", limited())
    ulna.plan(limited(), replace(found, candidates=2000, trials=0, placements=None))
    assert_bad_input(run("plan", tmp_path / "arm.toml", "--make-plan", tmp_path / "plan.toml"), "exists already")
    own = run("plan", tmp_path / "arm.toml", "--make-plan", tmp_path / "arm.toml", "--force")
    assert_bad_input(own, "is an input of this run")


def test_a_test_plan_is_filled_in_from_its_arm(tmp_path: Path) -> None:
    arm = limited()
    arm.save(tmp_path / "arm.toml")
    done = run("verify", tmp_path / "arm.toml", "--make-plan", "iso-10360-12", "-o", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "out" / "plan.toml").read_text()
    reach_mm = arm.core.reach_mm(0)
    range_mm = round(1.6 * reach_mm, -1)
    assert f'\narm = "{arm.name}"\n' in text
    assert f"\nrange = {range_mm}\n" in text
    # the longest gauge is 66 % of the range at the least, as the profile has it
    lengths = [float(line.split("=")[1].split("#")[0]) for line in text.splitlines() if line.startswith("# length =")]
    assert len(lengths) == 10
    assert 0.66 * range_mm <= max(lengths) < 0.7 * range_mm
