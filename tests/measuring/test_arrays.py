"""Measuring arrays: the arm's own tips, and uncertainties that hold against differences and simulation."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import polars as pl
import pytest

import ulna
from ulna.arm.arm import Arm
from ulna.arm.covariance import ParameterCovariance
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.ground.errors import UlnaInputError
from ulna.measuring.measured import Measured

PROBES = {"bent": Probe(35.0, -16.0, 224.0), "straight": Probe(0.0, 0.0, 238.0)}
JOINTS = (
    Joint(0.1, -1.57, 40.0, 250.0),
    Joint(2.2, 1.57, -40.0, 1.0, sign=-1),
    Joint(0.05, -1.57, 30.0, 450.0),
    Joint(0.3, 1.57, -30.0, 1.0),
    Joint(),
)
U_RAD = np.array([1e-5, 2e-5, 1.5e-5, 3e-5, 2e-5])


def calibrated(lost: list[dict[str, Any]] | None = None, scale: float = 1e-3) -> Arm:
    """An arm with a covariance that is full and positive, angles known better than lengths."""
    arm = Arm("arm", JOINTS, PROBES)
    names = arm.parameter_names
    each = np.array([scale if unit == "mm" else scale * 1e-2 for unit in arm.parameter_units])
    root = np.random.default_rng(1).standard_normal((len(names), len(names))) * each[:, None] / np.sqrt(len(names))
    return dataclasses.replace(arm, uncertainty=ParameterCovariance(names, root @ root.T, lost or []))


def poses(count: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-2.5, 2.5, (count, 5))


def by_difference(arm: Arm, q: np.ndarray, probe: str) -> tuple[np.ndarray, np.ndarray]:
    """(N, 3, parameters) and (N, 3, n): derivatives of the tips by central differences, of nothing but `tip`."""
    x = arm.parameters
    columns = []
    for k, unit in enumerate(arm.parameter_units):
        step = np.zeros(len(x))
        step[k] = 1e-4 if unit == "mm" else 1e-6
        up, down = (arm.with_parameters(x + sign * step).tip(q, probe) for sign in (1, -1))
        columns.append((up - down) / (2 * step[k]))
    turned = []
    for k in range(arm.n):
        step = np.zeros(arm.n)
        step[k] = 1e-6
        turned.append((arm.tip(q + step, probe) - arm.tip(q - step, probe)) / 2e-6)
    return np.stack(columns, axis=2), np.stack(turned, axis=2)


def test_points_and_covariances_are_those_of_differences() -> None:
    arm, q = calibrated(), poses(30)
    found = ulna.measure(arm, q, "bent", encoder_u_rad=U_RAD)
    np.testing.assert_array_equal(found.points_mm, arm.tip(q, "bent"))
    by_parameter, by_angle = by_difference(arm, q, "bent")
    assert arm.uncertainty is not None
    expected = by_parameter @ arm.uncertainty.matrix @ by_parameter.transpose(0, 2, 1)
    expected += by_angle @ np.diag(U_RAD**2) @ by_angle.transpose(0, 2, 1)
    np.testing.assert_allclose(found.covariance_mm2, expected, rtol=2e-6, atol=1e-12)
    np.testing.assert_allclose(found.u_mm, np.sqrt(np.diagonal(expected, axis1=1, axis2=2)), rtol=2e-6)


def test_points_err_together_as_differences_say() -> None:
    arm, q = calibrated(), poses(4, 3)
    found = ulna.measure(arm, q, "straight", encoder_u_rad=U_RAD)
    by_parameter, by_angle = by_difference(arm, q, "straight")
    assert arm.uncertainty is not None
    flat = by_parameter.reshape(12, -1)
    expected = flat @ arm.uncertainty.matrix @ flat.T
    for k in range(4):
        own = slice(3 * k, 3 * k + 3)
        expected[own, own] += by_angle[k] @ np.diag(U_RAD**2) @ by_angle[k].T
    np.testing.assert_allclose(found.joint_covariance_mm2(), expected, rtol=1e-5, atol=1e-11)
    some = found.joint_covariance_mm2([2, 0])
    order = [6, 7, 8, 0, 1, 2]
    np.testing.assert_allclose(some, expected[np.ix_(order, order)], rtol=1e-5, atol=1e-11)


def test_a_point_named_twice_errs_with_itself() -> None:
    found = ulna.measure(calibrated(), poses(2), "bent", encoder_u_rad=U_RAD)
    both = found.joint_covariance_mm2([1, 1])
    for block in (both[:3, :3], both[:3, 3:], both[3:, 3:]):
        np.testing.assert_allclose(block, found.covariance_mm2[1], rtol=1e-12)  # type: ignore[index]


def test_lengths_are_those_of_a_simulation() -> None:
    """Parameters and encoder angles drawn 40 000 times, lengths from nothing but the tips."""
    arm, q = calibrated(scale=3e-3), poses(6, 8)
    found = ulna.measure(arm, q, "bent", encoder_u_rad=U_RAD)
    first, second = [0, 2, 4], [1, 3, 5]
    value, u = found.lengths(first, second)
    np.testing.assert_allclose(value, np.linalg.norm(found.points_mm[1::2] - found.points_mm[::2], axis=1), rtol=1e-15)
    rng = np.random.default_rng(6)
    assert arm.uncertainty is not None
    trials = 40_000
    # of a whole arm many draws cost too much: the tips' own derivatives, checked against differences above
    by_parameter, by_angle = by_difference(arm, q, "bent")
    draws = rng.multivariate_normal(np.zeros(len(arm.parameters)), arm.uncertainty.matrix, trials)
    angles = rng.standard_normal((trials, 6, 5)) * U_RAD
    tips = found.points_mm + np.einsum("nip,tp->tni", by_parameter, draws) + np.einsum("nij,tnj->tni", by_angle, angles)
    drawn = np.linalg.norm(tips[:, second] - tips[:, first], axis=2)
    np.testing.assert_allclose(u, drawn.std(axis=0), rtol=0.02)  # 40 000 trials: u of u is 0.35 %
    apart = np.sqrt((found.u_mm[first] ** 2 + found.u_mm[second] ** 2).sum(axis=1))  # type: ignore[index]
    assert (np.abs(u / apart - 1.0) > 0.02).any(), "what the ends have in common changes nothing here: no test"


def test_whole_arms_drawn_give_the_same_lengths() -> None:
    """The same with 3000 whole arms: the law is that of small errors, and these are small."""
    arm, q = calibrated(), poses(2, 4)
    found = ulna.measure(arm, q, "bent")
    rng = np.random.default_rng(5)
    assert arm.uncertainty is not None
    draws = rng.multivariate_normal(arm.parameters, arm.uncertainty.matrix, 3000)
    tips = np.array([arm.with_parameters(x).tip(q, "bent") for x in draws])
    drawn = np.linalg.norm(tips[:, 1] - tips[:, 0], axis=1).std()
    length = found.length(0, 1)
    assert length.u_mm == pytest.approx(drawn, rel=0.05)
    assert length.value_mm == pytest.approx(np.linalg.norm(found.points_mm[1] - found.points_mm[0]), rel=1e-15)


def test_what_moves_all_points_alike_changes_no_length() -> None:
    """joint.1.theta0 turns the whole, so nothing of it is left in a length, however badly it is known."""
    arm = calibrated()
    names = arm.parameter_names
    matrix = np.zeros((len(names),) * 2)
    k = names.index("joint.1.theta0")
    matrix[k, k] = 1e-6
    arm = dataclasses.replace(arm, uncertainty=ParameterCovariance(names, matrix, []))
    found = ulna.measure(arm, poses(2), "bent")
    assert found.u_mm is not None
    assert found.u_mm.max() > 0.1
    assert found.length(0, 1).u_mm == pytest.approx(0.0, abs=1e-9)


def direction(combination: dict[str, float], frame: bool = False) -> dict[str, Any]:
    return {"combination": combination, "frame": frame, "because": "BECAUSE.", "remedy": "REMEDY."}


def test_a_probe_that_was_not_calibrated_has_no_uncertainty() -> None:
    arm = calibrated([direction({"probe.straight.x": 1.0})])
    found = ulna.measure(arm, poses(4), ["bent", "straight", "bent", "straight"])
    assert found.covariance_mm2 is not None
    assert np.isnan(found.covariance_mm2).all(axis=(1, 2)).tolist() == [False, True, False, True]
    assert "probe 'straight'" in found.notes[-1]
    assert "REMEDY" in repr(found)
    together = found.joint_covariance_mm2([0, 1, 2])
    assert np.isnan(together[3:6]).all()
    assert np.isnan(together[:, 3:6]).all()
    assert np.isfinite(together[np.ix_([0, 1, 2, 6, 7, 8], [0, 1, 2, 6, 7, 8])]).all()
    assert found.length(0, 2).u_mm is not None
    assert found.length(0, 1).u_mm is None
    assert found.to_polars()["u_x_mm"].is_null().to_list() == [False, True, False, True]


def test_a_length_is_known_where_its_ends_alone_are_not() -> None:
    """What was not determined moves both ends by the same: the whole arm up and down."""
    arm = calibrated([direction({"joint.1.d": 1.0})])
    found = ulna.measure(arm, poses(2), "bent")
    assert found.u_mm is not None
    assert np.isnan(found.u_mm).all()
    assert found.length(0, 1).u_mm is not None


def test_no_uncertainty_known_none_told() -> None:
    found = ulna.measure(Arm("arm", JOINTS, PROBES), poses(3), "bent")
    assert found.covariance_mm2 is None
    assert found.u_mm is None
    assert found.length(0, 1).u_mm is None
    assert found.lengths([0], [1])[1] is None
    with pytest.raises(ValueError, match="no uncertainty is known"):
        found.joint_covariance_mm2()
    assert found.to_polars().columns == ["probe", "x_mm", "y_mm", "z_mm"]


def test_one_pose_units_and_counts() -> None:
    arm = calibrated()
    q = poses(1)
    one = ulna.measure(arm, q[0], "bent")
    assert one.points_mm.shape == (1, 3)
    degrees = ulna.measure(arm, np.degrees(q), "bent", angle="deg")
    np.testing.assert_allclose(degrees.points_mm, one.points_mm, atol=1e-9)
    counting = dataclasses.replace(arm, joints=tuple(dataclasses.replace(j, counts_per_turn=4096.0) for j in JOINTS))
    counts = ulna.measure(counting, q / (2 * np.pi) * 4096, "bent", angle="counts")
    np.testing.assert_allclose(counts.points_mm, one.points_mm, atol=1e-9)
    with pytest.raises(UlnaInputError, match=r"joint\.1\.counts_per_turn"):
        ulna.measure(arm, q, "bent", angle="counts")


FRAMES = {
    "dict": dict,
    "polars": pl.DataFrame,
    "pandas": pd.DataFrame,
    "arrow": lambda columns: pl.DataFrame(columns).to_arrow(),
    "records": lambda columns: pl.DataFrame(columns).to_dicts(),
}


@pytest.mark.parametrize("make", FRAMES.values(), ids=FRAMES)
def test_a_frame_is_its_array_with_names(make: Any, tmp_path: Path) -> None:
    arm, q = calibrated(), poses(5)
    probe = ["bent", "straight", "bent", "bent", "straight"]
    columns: dict[str, Any] = {"id": [f"n{k}" for k in range(5)], "probe": probe}
    columns |= {f"q{k + 1}": q[:, k] for k in range(5)}
    found = ulna.measure(arm, make(columns))
    assert isinstance(found, Measured)
    array = ulna.measure(arm, q, probe)
    np.testing.assert_array_equal(found.points_mm, array.points_mm)
    np.testing.assert_array_equal(found.covariance_mm2, array.covariance_mm2)
    table = found.to_pandas()
    assert table["id"].tolist() == columns["id"]
    assert table["probe"].tolist() == probe
    np.testing.assert_array_equal(table[["x_mm", "y_mm", "z_mm"]].to_numpy(), array.points_mm)
    pl.DataFrame(columns).write_csv(tmp_path / "r.csv")
    of_file = ulna.measure(arm, tmp_path / "r.csv", covariance=True).table
    assert of_file is not None
    np.testing.assert_array_equal(of_file.select("x", "y", "z").to_numpy(), found.points_mm)
    i, j = np.triu_indices(3)
    six = of_file.select("c_xx", "c_xy", "c_xz", "c_yy", "c_yz", "c_zz").to_numpy()
    np.testing.assert_array_equal(six, found.covariance_mm2[:, i, j])  # type: ignore[index]


@pytest.mark.parametrize(
    ("readings", "error", "expected"),
    [
        (poses(3)[:, :4], ValueError, r"expected \(N, 5\) encoder angles, got \(3, 4\)"),
        (poses(3) * 1000, UlnaInputError, r"row 0 \(counted from 0\), joint 1: .*State the unit"),
        (np.full((2, 5), np.nan), UlnaInputError, r"row 0 \(counted from 0\), joint 1: got nan"),
        (None, TypeError, "got None, expected readings: the path of a table"),
        (3.0, TypeError, "got a float, expected readings"),
        ([["a"] * 5], TypeError, "got a list, expected readings"),
        ({"q1": [0.0]}, UlnaInputError, "the column 'q2' is missing"),
    ],
)
def test_what_can_be_no_readings_is_told(readings: Any, error: type[Exception], expected: str) -> None:
    with pytest.raises(error, match=expected) as caught:
        ulna.measure(calibrated(), readings, "bent")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("more", "error", "expected"),
    [
        ({"probe": "bend"}, UlnaInputError, "Did you mean 'bent'"),
        ({"probe": None}, UlnaInputError, "say which of bent, straight"),
        ({"probe": ["bent"]}, ValueError, "expected one name, or 2, got 1"),
        ({"out": "p.csv"}, UlnaInputError, "the readings are in memory"),
        ({"units": "m"}, UlnaInputError, "points in memory are in mm"),
        ({"encoder_u_rad": [1e-5]}, ValueError, r"one or \(5,\)"),
        ({"angle": "grad"}, UlnaInputError, "expected rad, deg or counts"),
    ],
)
def test_what_is_said_wrongly_is_told(more: dict[str, Any], error: type[Exception], expected: str) -> None:
    with pytest.raises(error, match=expected):
        ulna.measure(calibrated(), poses(2), **{"probe": "bent", **more})


def test_points_that_there_are_not() -> None:
    found = ulna.measure(calibrated(), poses(2), "bent")
    with pytest.raises(IndexError, match="numbered from 0; got 0 to 2"):
        found.joint_covariance_mm2([0, 2])
    with pytest.raises(ValueError, match="same place"):
        found.length(1, 1)
    with pytest.raises(ValueError, match="whole numbers"):
        found.joint_covariance_mm2([0.5])  # type: ignore[list-item]
