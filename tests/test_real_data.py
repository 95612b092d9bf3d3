"""Readings of real arms, measured by others: how well a calibration explains what it has not seen.

The limits are those the project set itself before it began; our reference fits (SciPy, everything free) are written
beside them. The data stand beside the project (`../shared/data`), are not part of it, and tests skip without them.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.oracle import fits
from tests.oracle.chain import Chain, chain
from tests.oracle.core import core_arm
from tests.oracle.observed import Points

import ulna
from ulna.importers.ipa import import_ipa_ur10
from ulna.importers.mukca import import_mukca

DATA = Path(__file__).parents[2] / "shared" / "data"

pytestmark = [
    pytest.mark.shared_data,
    pytest.mark.slow,
    pytest.mark.filterwarnings("ignore::ulna.errors.InputWarning"),  # real readings go a little beyond the limits
]

if not DATA.is_dir():
    pytest.skip(f"{DATA} is absent: no real measurements to test with", allow_module_level=True)


def positions(robot: str, tmp_path: Path) -> ulna.Study:
    import_mukca(DATA / "mukca" / robot, tmp_path / robot)
    return ulna.Study.load(tmp_path / robot / "study.toml")


# robot, readings, mean distance to the socket before, limit after, limit of the mean length error after
ROBOTS = [
    ("panda_2_clean", 497, 7.6, 0.29, 0.15),  # reference 7.59 → 0.288, length 1.47 → 0.149
    ("panda_1", 182, 8.4, 0.81, 0.65),  # reference 8.46 → 0.81, length 2.74 → 0.62
    ("kuka_14", 180, 0.706, 0.25, 0.07),
]


@pytest.mark.parametrize(("robot", "rows", "before", "after", "length"), ROBOTS)
def test_leaving_one_tool_position_out(robot, rows, before, after, length, tmp_path):
    study = positions(robot, tmp_path)
    assert sum(len(group) for group in study.readings) == rows
    found = ulna.cross_validate(study, by="placement")
    assert found.converged
    assert found.before["seat_scatter_mean_mm"] == pytest.approx(before, rel=0.03)
    assert found.after["seat_scatter_mean_mm"] <= after
    assert found.after["length_error_mean_abs_mm"] <= length
    for group in found.groups:
        # The base frame is lost with noise too, although residuals turn with it.
        assert {"joint.1.theta0", "joint.1.d"} <= {name for lost in group.lost for name in lost["combination"]}


def panda() -> Chain:
    """The maker's public geometry, written once more and by another hand than the importer's."""
    quarter = np.pi / 2
    links = [
        [0.0, -quarter, 0.0, 333.0],
        [0.0, quarter, 0.0, 0.0],
        [0.0, quarter, 82.5, 316.0],
        [0.0, -quarter, -82.5, 0.0],
        [0.0, quarter, 0.0, 384.0],
        [0.0, quarter, 88.0, 0.0],
    ]
    return chain(links, [0.0, 0.0, 240.4])


def test_the_importer_brings_in_the_robot_that_was_measured(tmp_path):
    study = positions("panda_1", tmp_path)
    np.testing.assert_allclose(study.arm.parameters, core_arm(panda()).parameters, rtol=0, atol=1e-12)


def test_the_optimum_on_real_readings_is_that_of_scipy(tmp_path):
    """Everything free, one position left out: the same sum of squares, the same predictions.

    Both start with the ball a millimetre off the axis: a start exactly on it is a saddle, where the program keeps what
    the drawing says unless the readings clearly speak against it.
    """
    off_axis = 1.0
    q, feature, placement = [], [], []
    for number, place in enumerate(["back-high", "right"]):
        for hole in (0, 1):
            poses = np.loadtxt(DATA / "mukca" / "panda_1" / place / f"hole_{hole}.csv", delimiter=",")
            q.append(poses)
            feature.append(np.full(len(poses), hole))
            placement.append(np.full(len(poses), number))
    ends = np.array([[0.0, 0.0, 0.0], [50.0, 0.0, 0.0]])
    touched = Points(ends, np.concatenate(q), np.concatenate(feature), np.concatenate(placement))
    free = np.ones(27, bool)
    free[[0, 3]] = False
    start = replace(panda(), tips_mm=np.array([[off_axis, 0.0, 240.4]]))
    oracle = fits.fit([touched], start, free)

    study = positions("panda_1", tmp_path)
    masks = [group.placement != "front" for group in study.readings]
    drawn = study.arm.with_parameters(core_arm(start).parameters)
    result = ulna.calibrate(study.subset(masks).with_arm(drawn))
    readings = len(touched.q_rad)
    assert result.fit.rms_mm == pytest.approx(np.sqrt(oracle.cost / readings), rel=1e-6)
    unseen = np.loadtxt(DATA / "mukca" / "panda_1" / "front" / "hole_0.csv", delimiter=",")

    def scatter(tips):
        return np.linalg.norm(tips - tips.mean(axis=0), axis=1)

    np.testing.assert_allclose(scatter(result.arm.tip(unseen)), scatter(oracle.arm.tip(unseen)), rtol=0, atol=1e-3)


def middles(count: int, rows: int) -> np.ndarray:
    """The middle of each of `count` equal blocks: spread over the whole file, since the tracker's frame creeps."""
    chosen = np.zeros(rows, bool)
    chosen[(2 * np.arange(count) + 1) * rows // (2 * count)] = True
    return chosen


def ur10(tmp_path: Path) -> ulna.Study:
    table = DATA / "ipa_ur10" / "Series_B" / "measurements_joint_configurations.csv"
    import_ipa_ur10(table, tmp_path / "ur10")
    return ulna.Study.load(tmp_path / "ur10" / "study.toml")


def test_ur10_with_hayati_joints(tmp_path):
    """300 rows fitted, 1195 held out: 0.585 → 0.40 mm (reference 0.401)."""
    study = ur10(tmp_path)
    assert [joint.model for joint in study.arm.joints] == ["dh", "hayati", "hayati", "dh", "dh", "dh"]
    chosen = middles(300, 1495)
    held_out = study.subset([~chosen])
    assert sum(len(group) for group in held_out.readings) == 1195
    probe_only = ulna.calibrate(study.subset([chosen]), hold=["joint.*"])
    before = ulna.evaluate(probe_only.arm, held_out).overall["coordinate_error_mean_mm"]
    result = ulna.calibrate(study.subset([chosen]))
    assert result.fit.converged
    after = ulna.evaluate(result.arm, held_out).overall["coordinate_error_mean_mm"]
    assert before == pytest.approx(0.585, abs=0.01)
    assert after <= 0.40


def test_the_tracker_of_the_ur10_creeps(tmp_path):
    """One placement for each fifth of the file: part of the error is not the arm's but a motion of base or tracker."""
    study = ur10(tmp_path)
    (group,) = study.readings
    group.placement = np.array([f"s{1 + 5 * row // len(group)}" for row in range(len(group))], dtype=object)
    chosen = middles(300, 1495)
    result = ulna.calibrate(study.subset([chosen]))
    after = ulna.evaluate(result.arm, study.subset([~chosen])).overall["coordinate_error_mean_mm"]
    assert after <= 0.37
