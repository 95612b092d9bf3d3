"""Simulated readings repeat, and a calibration finds the truth within what it states."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from scipy import stats
from tests.cli_runs import run
from tests.simulations import BALL, BAR, NOISE, PLATE, off_over_u, saved, true_arm, with_effects, write

import ulna
from ulna import Arm, Probe
from ulna.simulation.file import load_simulation

WAYS = {
    "bar": BAR + "placements = 150\n",
    "seat and bar": BAR + '[artefact.cone]\nkind = "seat"\nplacements = 3\n',
    "plate": PLATE + "placements = 25\ntouches = 2\n",
    "sphere and bar": BAR + BALL,
    "plane and bar": BAR + '[artefact.table]\nkind = "plane"\nsize = [300.0, 150.0]\n',
    "lengths": '[artefact.rows]\nkind = "length"\nlength = 350.0\nu = 0.001\nplacements = 300\n',
    "points in the arm's frame": '[artefact.tracker]\nkind = "points"\nframe = "arm"\ntouches = 20\nu = 0.002\n'
    "features = { a = [600.0, 0.0, 300.0], b = [0.0, 700.0, 100.0], c = [-500.0, 100.0, 500.0] }\n",
}


@pytest.mark.parametrize("way", WAYS)
def test_a_calibration_finds_the_truth_within_its_uncertainties(tmp_path: Path, way: str) -> None:
    # another seed for each way: one set of noise proves little
    simulated, study = saved(write(tmp_path, WAYS[way], f"seed = {10 + list(WAYS).index(way)}\n{NOISE}"))
    result = ulna.calibrate(study)
    assert result.fit.converged
    dof = result.fit.degrees_of_freedom
    low, high = stats.chi2(dof).ppf([0.0005, 0.9995]) / dof
    assert low < result.fit.chi2_per_dof < high
    off = off_over_u(simulated, result)
    assert len(off) >= 25
    assert np.abs(off).max() < 4.5
    # parameters correlate, so that this is loose; a noise stated twice too small or large is seen
    assert 0.3 < np.mean(off**2) < 2.5


def test_the_loaded_study_is_the_one_in_memory(tmp_path: Path) -> None:
    spec = write(tmp_path, WAYS["plate"] + BALL, "noise = { encoder = 5e-6, seat = 0.008, counts_per_turn = 163840 }")
    simulated, study = saved(spec)
    for made, loaded in zip(simulated.study.readings, study.readings, strict=True):
        assert made.q_rad.tolist() == loaded.q_rad.tolist()
        assert made.placement.tolist() == loaded.placement.tolist()
        assert made.feature.tolist() == loaded.feature.tolist()
        assert made.artefact == loaded.artefact
    assert study.noise is not None
    assert simulated.study.noise is not None
    assert study.noise.encoder_rad == pytest.approx(simulated.study.noise.encoder_rad, rel=1e-15)
    assert study.arm.parameters.tolist() == simulated.study.arm.parameters.tolist()


def test_the_same_seed_gives_the_same_bytes(tmp_path: Path) -> None:
    spec = write(tmp_path, BAR + BALL)
    for folder, seed in (("one", "4"), ("two", "4"), ("three", "5")):
        done = run("simulate", spec, "-o", tmp_path / folder, "--seed", seed)
        assert done.returncode == 0, done.stderr
    files = sorted(path.name for path in (tmp_path / "one").iterdir())
    assert files == ["arm.toml", "ball.csv", "bar.csv", "study.toml", "truth.json", "truth.toml"]
    same = {name: (tmp_path / "one" / name).read_bytes() == (tmp_path / "two" / name).read_bytes() for name in files}
    assert same == dict.fromkeys(files, True)
    other = {name: (tmp_path / "one" / name).read_bytes() == (tmp_path / "three" / name).read_bytes() for name in files}
    assert other == {name: name in ("study.toml", "truth.toml") for name in files}


def test_an_artefact_has_draws_of_its_own(tmp_path: Path) -> None:
    alone = ulna.simulate(write(tmp_path / "alone", BAR))
    both = ulna.simulate(write(tmp_path / "both", BAR + BALL))
    assert alone.study.readings[0].q_rad.tolist() == both.study.readings[0].q_rad.tolist()
    assert alone.study.arm.parameters.tolist() == both.study.arm.parameters.tolist()


def test_missed_seats_are_among_the_readings_that_calibrate_finds_far_off(tmp_path: Path) -> None:
    more = f'{NOISE}\nmissed = {{ share = 0.02, size = 0.5 }}\nfit = {{ loss = "tukey" }}'
    simulated, study = saved(write(tmp_path, PLATE + "placements = 20\ntouches = 4\n", more))
    missed = {(entry["file"], entry["row"]) for entry in simulated.as_dict()["missed"]}
    assert 2 <= len(missed) <= 15
    assert all(entry["off_mm"] == pytest.approx(0.5) for entry in simulated.as_dict()["missed"])
    residuals = ulna.calibrate(study).residuals
    far = {(row["file"], row["row"]) for row in residuals.filter(pl.col("outlier")).iter_rows(named=True)}
    assert missed <= far
    assert len(far - missed) <= 2


def test_a_calibration_with_extras_finds_the_effects(tmp_path: Path) -> None:
    extras = 'fit = { extras = ["encoder-harmonics", "link-expansion", "compliance"], judge_extras = false }'
    more = f"{NOISE}\ntemperature = {{ mean = 22.0, spread = 4.0 }}\n{extras}"
    simulated, study = saved(write(tmp_path, BAR + "placements = 600\n", more, with_effects()))
    assert study.arm.extras == []  # the drawing knows none of it, but the masses
    assert [joint.effects.mass_kg for joint in study.arm.joints] == [0.8] * 7
    result = ulna.calibrate(study)
    off = off_over_u(simulated, result)
    assert result.fit.converged
    assert result.fit.chi2_per_dof == pytest.approx(1.0, abs=0.15)
    assert len(off) > 45
    assert np.abs(off).max() < 4.5
    without = ulna.calibrate(study, extras=[])
    assert without.fit.chi2_per_dof > 2


def test_two_probes_touch_each_feature(tmp_path: Path) -> None:
    arm = true_arm({"short": Probe(0.0, 0.0, 200.0, 4.0), "long": Probe(0.0, 0.0, 250.0, 6.0)})
    ball = BALL + 'probe = ["long", "short"]\ntouches = 6\nplacements = 2\n'
    bar = BAR + 'probe = ["short", "long"]\nplacements = 60\n'
    simulated, study = saved(write(tmp_path, bar + ball, NOISE, arm))
    bars, balls = study.readings
    assert bars.probe.reshape(60, 4).tolist() == [[0, 0, 1, 1]] * 60
    assert bars.feature.reshape(60, 4).tolist() == [[0, 1, 0, 1]] * 60
    assert balls.probe.tolist() == ([1] * 6 + [0] * 6) * 2
    result = ulna.calibrate(study)
    assert result.fit.chi2_per_dof == pytest.approx(1.0, abs=0.25)
    assert np.abs(off_over_u(simulated, result)).max() < 4.5


def test_encoders_that_count_backwards(tmp_path: Path) -> None:
    arm = true_arm()
    arm = replace(
        arm,
        joints=tuple(
            replace(j, sign=-1, limits_rad=(-j.limits_rad[1], -j.limits_rad[0]), counts_per_turn=65536.0)
            for j in arm.joints
        ),
    )
    simulated, study = saved(write(tmp_path, BAR, NOISE, arm))
    assert [joint.sign for joint in study.arm.joints] == [-1] * 7
    assert 'angle = "counts"' in (tmp_path / "out" / "study.toml").read_text()
    assert np.abs(off_over_u(simulated, ulna.calibrate(study))).max() < 4.5


def test_from_python_with_progress_and_without_files(tmp_path: Path) -> None:
    simulation = load_simulation(write(tmp_path, BAR))
    heard: list[tuple[str, int, int]] = []
    simulated = ulna.simulate(replace(simulation, seed=3), lambda *each: heard.append(each))
    assert heard[-1] == ("touching bar", 100, 100)
    assert ulna.calibrate(simulated.study).fit.converged


def test_the_command_from_the_specification_to_the_calibrated_arm(tmp_path: Path) -> None:
    spec = write(tmp_path, BAR, NOISE + "\ntemperature = { mean = 20.0 }", with_effects())
    shown = run("simulate", spec)
    assert (shown.returncode, shown.stderr) == (0, "Nothing was written: give -o DIR to keep the readings.\n")
    assert all(len(line) <= 80 for line in shown.stdout.splitlines())
    assert '"encoder-harmonics", "link-expansion", "compliance"' in " ".join(shown.stdout.split())
    printed = run("simulate", spec, "-o", tmp_path / "out", "--json")
    assert json.loads(printed.stdout) == json.loads((tmp_path / "out" / "truth.json").read_text())
    assert run("calibrate", tmp_path / "out" / "study.toml").returncode == 0
    assert Arm.load(tmp_path / "out" / "truth.toml").joints == with_effects().joints
