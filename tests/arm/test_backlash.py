"""Backlash from files to figures: sides in columns or by the order of rows, and uncertainties that hold the truth."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.oracle import fits
from tests.oracle.core import core_problem, nothing_held
from tests.oracle.effects import affected
from tests.oracle.observed import Lengths
from tests.oracle.published import table_4
from tests.simulations import BAR, NOISE, true_arm, write

import ulna
import ulna._core as _core
from ulna import Arm, Effects, Study
from ulna.study.readings.conditions import approach_by_order

RUNS = 300
ENCODER_RAD, SEAT_MM = 5e-6, 0.008
NORMAL_95 = 1.959963984540054
LENGTH = '[artefact.bar]\nkind = "length"\nlength = 300.0\nplacements = 30\n'


def loose_arm() -> Arm:
    arm = true_arm()
    joints = [replace(joint, effects=Effects(backlash_rad=1e-4 + 2e-5 * k)) for k, joint in enumerate(arm.joints)]
    return replace(arm, joints=tuple(joints))


def simulated(folder: Path, artefacts: str, more: str = "") -> Path:
    spec = write(folder, artefacts, f"{NOISE}\ndrawing = {{ effects = true }}\n{more}", loose_arm())
    ulna.simulate(spec).save(folder / "out")
    return folder / "out"


def one_by_one(poses: np.ndarray) -> np.ndarray:
    """The sides by the order of poses, as a person would do it."""
    found = np.zeros(poses.shape)
    for joint in range(poses.shape[1]):
        side = 0.0
        for k in range(1, len(poses)):
            step = poses[k, joint] - poses[k - 1, joint]
            side = 1.0 if step > 0 else -1.0 if step < 0 else side
            found[k, joint] = side
    return found


def test_the_order_of_rows_gives_the_sides() -> None:
    poses = np.random.default_rng(1).integers(0, 3, (40, 5)).astype(float)  # joints often stand still
    first, none = approach_by_order(poses, None)
    assert none is None
    np.testing.assert_array_equal(first, one_by_one(poses))
    first, second = approach_by_order(poses[::2], poses[1::2])
    assert second is not None
    np.testing.assert_array_equal(np.stack([first, second], axis=1).reshape(40, 5), one_by_one(poses))


def test_columns_of_both_poses_come_back(tmp_path: Path) -> None:
    folder = simulated(tmp_path, LENGTH)
    (group,) = Study.load(folder / "study.toml").readings
    table = pl.read_csv(folder / "bar.csv")
    for field, prefix in ((group.approach, "approach"), (group.p_approach, "papproach")):
        assert field is not None
        np.testing.assert_array_equal(field, table.select(f"{prefix}{k}" for k in range(1, 8)).to_numpy())
        assert set(np.unique(field)) == {-1.0, 1.0}
    assert not np.array_equal(group.approach, group.p_approach)


def ordered(folder: Path, where: str = "") -> Study:
    """The study of a folder with its sides taken from the order of rows."""
    table = pl.read_csv(folder / "bar.csv")
    table.select(c for c in table.columns if "approach" not in c).write_csv(folder / "bar.csv")
    text = (folder / "study.toml").read_text()
    (folder / "study.toml").write_text(text.replace('file = "bar.csv"', f'file = "bar.csv"\napproach = "order"{where}'))
    return Study.load(folder / "study.toml")


def test_the_order_is_that_of_the_file_whatever_rows_are_used(tmp_path: Path) -> None:
    folder = simulated(tmp_path, BAR + "placements = 12\n")
    with pytest.warns(ulna.InputWarning, match="18 of 24 rows left out"):
        (group,) = ordered(folder, '\nwhere = { placement = ["3", "7", "8"] }').readings
    q_rad = pl.read_csv(folder / "bar.csv").select(f"q{k}" for k in range(1, 8)).to_numpy()
    assert len(group) == 6
    assert group.approach is not None
    np.testing.assert_array_equal(group.approach, one_by_one(q_rad)[group.row - 1])


def test_two_ways_of_saying_it_are_one_too_many(tmp_path: Path) -> None:
    folder = simulated(tmp_path, BAR + "placements = 12\n")
    text = (folder / "study.toml").read_text()
    (folder / "study.toml").write_text(text.replace('file = "bar.csv"', 'file = "bar.csv"\napproach = "order"'))
    with pytest.raises(ulna.UlnaInputError, match=r"readings.1.approach': got 'order'.*Remove the key or the columns"):
        Study.load(folder / "study.toml")


@pytest.mark.parametrize("cell", [0.5, 2.0])
def test_a_side_that_is_none_is_named_with_its_cell(tmp_path: Path, cell: float) -> None:
    folder = simulated(tmp_path, BAR + "placements = 12\n")
    table = pl.read_csv(folder / "bar.csv").with_columns(pl.col("approach3").cast(pl.Float64))
    table[4, "approach3"] = cell
    table.write_csv(folder / "bar.csv")
    for load in (lambda: Study.load(folder / "study.toml"), lambda: ulna.measure(loose_arm(), folder / "bar.csv")):
        with pytest.raises(ulna.UlnaInputError, match=rf"bar.csv.*row 5.*approach3.*got {cell:g}.*\+1"):
            load()


def test_what_does_not_say_sides_refuses_the_arm(tmp_path: Path) -> None:
    simulated(tmp_path, BAR + "placements = 12\n")
    with pytest.raises(ulna.UlnaInputError, match=r"joints of arm .* have backlash, which plans do not cover"):
        loose_arm().check_covered("plan.toml", "plans")


def test_intervals_hold_the_truth() -> None:
    """Noise drawn here, of lengths and encoders; every calibration from a rigid start."""
    rng = np.random.default_rng(11)
    truth = affected(table_4(), rng, "backlash")
    count, n = 150, truth.joints
    poses = [rng.uniform(-np.pi, np.pi, (count, n)) for _ in range(2)]
    sides = [rng.choice([-1.0, 1.0], (count, n)) for _ in range(2)]

    def seen(angles: list[np.ndarray]) -> list[np.ndarray]:
        return [np.hstack([q, np.zeros((count, n)), side]) for q, side in zip(angles, sides, strict=True)]

    length_mm = np.linalg.norm(truth.tip(seen(poses)[0]) - truth.tip(seen(poses)[1]), axis=1)
    start = truth.with_parameters(
        np.concatenate([truth.chain.parameters, np.zeros(len(truth.parameters) - len(truth.chain.parameters))])
    )
    own = slice(len(truth.chain.parameters), None)
    values, u, chi2 = np.empty((RUNS, n)), np.empty((RUNS, n)), np.empty(RUNS)
    for run in range(RUNS):
        noisy = seen([q + ENCODER_RAD * rng.standard_normal(q.shape) for q in poses])
        touched_mm = length_mm + np.sqrt(2.0) * SEAT_MM * rng.standard_normal(count)
        problem = core_problem(start, [Lengths(*noisy, touched_mm)], fits.Noise(np.full(n, ENCODER_RAD), SEAT_MM))
        found = _core.fit(problem, nothing_held(truth))
        assert found.converged
        values[run], u[run] = found.parameters[own], np.sqrt(np.diag(found.covariance))[own]
        chi2[run] = found.chi2_per_dof
    inside = (np.abs(values - truth.parameters[own]) < NORMAL_95 * u).mean(axis=0)
    # 300 runs scatter by 1.3 % each: three and a half of these
    assert inside.min() > 0.905, inside
    assert inside.mean() == pytest.approx(0.95, abs=0.02), inside
    freedom = count - (len(truth.parameters) - 2)
    assert chi2.mean() == pytest.approx(1.0, abs=4.0 * np.sqrt(2.0 / freedom / RUNS))
