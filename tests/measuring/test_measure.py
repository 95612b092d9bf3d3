"""Measuring: the arm's own tips, uncertainties with their reasons, units, and nothing half written."""

from __future__ import annotations

import dataclasses
import io
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest

import ulna
from ulna.arm.arm import Arm
from ulna.arm.covariance import ParameterCovariance
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.ground.errors import InputWarning, UlnaInputError
from ulna.measuring.job import MeasureJob
from ulna.measuring.measure import measure_to_stream

PROBES = {"bent": Probe(35.0, -16.0, 224.0), "straight": Probe(0.0, 0.0, 238.0)}


def arm(probes: dict[str, Probe] | None = None, **last: Any) -> Arm:
    joints = [
        Joint(0.1, -1.57, 40.0, 250.0),
        Joint(2.2, 1.57, -40.0, 1.0, sign=-1),
        Joint(0.05, -1.57, 30.0, 450.0),
        Joint(0.0, 0.0, 0.0, 0.0, **last),
    ]
    return Arm("arm", tuple(joints), probes or {"bent": PROBES["bent"]})


def angles(rows: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-3, 3, (rows, 4))


def write(path: Path, q: np.ndarray, **more: Any) -> Path:
    frame = pl.DataFrame(more | {f"q{k + 1}": q[:, k] for k in range(q.shape[1])})
    frame.write_csv(path) if path.suffix == ".csv" else frame.write_parquet(path)
    return path


@pytest.mark.parametrize("suffix", [".csv", ".parquet"])
@pytest.mark.parametrize("out", ["points.csv", "points.parquet"])
def test_points_are_the_arms_tips_exactly(tmp_path: Path, suffix: str, out: str) -> None:
    q = angles(70_001)
    done = ulna.measure(arm(), write(tmp_path / f"readings{suffix}", q), out=tmp_path / out)
    read = pl.read_csv if out.endswith("csv") else pl.read_parquet
    points = read(tmp_path / out)
    assert points.columns == done.columns == ["x", "y", "z"]
    assert done.rows == 70_001
    np.testing.assert_array_equal(points.to_numpy(), arm().tip(q))


def test_in_memory_with_ids_and_probes_kept(tmp_path: Path) -> None:
    q = angles(6)
    probe = ["bent", "straight"] * 3
    path = write(tmp_path / "r.csv", q, id=list("abcdef"), probe=probe)
    done = ulna.measure(arm(PROBES), path)
    assert done.table is not None
    assert done.table.columns == ["id", "probe", "x", "y", "z"]
    assert done.table["id"].to_list() == list("abcdef")
    expected = np.stack([arm(PROBES).tip(q[k], probe[k]) for k in range(6)])
    np.testing.assert_allclose(done.table.select("x", "y", "z").to_numpy(), expected, rtol=0, atol=1e-9)


def test_units_of_angles_and_points(tmp_path: Path) -> None:
    q = angles(50)
    expected = arm().tip(q)
    degrees = ulna.measure(arm(), write(tmp_path / "deg.csv", np.degrees(q)), angle="deg", units="in")
    assert degrees.table is not None
    np.testing.assert_allclose(degrees.table.to_numpy() * 25.4, expected, atol=1e-9)
    counting = arm(counts_per_turn=10_000.0)
    joints = tuple(dataclasses.replace(joint, counts_per_turn=10_000.0) for joint in counting.joints)
    counts = ulna.measure(
        dataclasses.replace(counting, joints=joints),
        write(tmp_path / "c.csv", q / (2 * np.pi) * 10_000),
        angle="counts",
    )
    assert counts.table is not None
    np.testing.assert_allclose(counts.table.to_numpy(), expected, atol=1e-9)
    with pytest.raises(UlnaInputError, match=r"joint\.1\.counts_per_turn"):
        ulna.measure(arm(), tmp_path / "c.csv", angle="counts")


def calibrated(lost: list[dict[str, Any]], matrix: np.ndarray | None = None) -> Arm:
    names = arm(PROBES).parameter_names
    root = np.random.default_rng(1).normal(0, 1e-3, (len(names), len(names)))
    matrix = root @ root.T if matrix is None else matrix
    return dataclasses.replace(arm(PROBES), uncertainty=ParameterCovariance(names, matrix, lost))


def test_uncertainty_is_of_the_calibration_and_of_the_encoders(tmp_path: Path) -> None:
    q = angles(40)
    path = write(tmp_path / "r.csv", q)
    known = calibrated([])
    assert known.uncertainty is not None
    jacobian = known.jacobian(q, "bent")
    of_arm = np.einsum("nij,jk,nik->ni", jacobian, known.uncertainty.matrix, jacobian)
    columns = ["u_x", "u_y", "u_z"]
    done = ulna.measure(known, path, "bent")
    assert done.table is not None
    np.testing.assert_allclose(done.table.select(columns).to_numpy(), np.sqrt(of_arm), rtol=1e-9)
    noise_rad = np.array([1e-5, 2e-5, 3e-5, 4e-5])
    of_encoders = (known.core.encoder_jacobian(q, 0) ** 2 * noise_rad**2).sum(axis=2)
    done = ulna.measure(known, path, "bent", encoder_u_rad=noise_rad)
    assert done.table is not None
    np.testing.assert_allclose(done.table.select(columns).to_numpy(), np.sqrt(of_arm + of_encoders), rtol=1e-9)
    assert done.notes == []


def direction(combination: dict[str, float], frame: bool) -> dict[str, Any]:
    return {"combination": combination, "frame": frame, "because": "BECAUSE.", "remedy": "REMEDY."}


def test_no_uncertainty_where_the_point_depends_on_what_was_lost(tmp_path: Path) -> None:
    q = angles(10)
    path = write(tmp_path / "r.csv", q, probe=["bent", "straight"] * 5)
    lost = [direction({"probe.straight.x": 1.0}, frame=False), direction({"joint.1.theta0": 1.0}, frame=True)]
    done = ulna.measure(calibrated(lost), path)
    assert done.table is not None
    for column in ("u_x", "u_y", "u_z"):
        assert done.table[column].is_null().to_list() == [False, True] * 5
    assert done.table["x"].null_count() == 0
    noise, note = done.notes
    assert noise.startswith("How its readings scatter is not in")
    assert "probe 'straight'" in note
    assert "probe.straight.x" in note
    assert "Why: BECAUSE. Remedy: REMEDY." in note


def test_no_degrees_of_freedom_no_uncertainty(tmp_path: Path) -> None:
    matrix = np.full((len(arm(PROBES).parameter_names),) * 2, np.nan)
    done = ulna.measure(calibrated([], matrix), write(tmp_path / "r.csv", angles(3)), "bent")
    assert done.table is not None
    assert done.table["u_x"].null_count() == 3
    assert "no degrees of freedom" in done.notes[0]


@pytest.mark.parametrize("out", ["points.csv", "points.parquet"])
def test_one_bad_cell_leaves_no_output(tmp_path: Path, out: str) -> None:
    q = angles(200_000)
    q[180_000, 2] = np.nan
    path = write(tmp_path / "r.parquet", q)
    with pytest.raises(UlnaInputError, match="row 180001, column 'q3'"):
        ulna.measure(arm(), path, out=tmp_path / out)
    assert [each.name for each in tmp_path.iterdir()] == ["r.parquet"]


def test_to_a_stream_nothing_goes_out_before_all_is_checked(tmp_path: Path) -> None:
    q = angles(150_000)
    good, bad = io.BytesIO(), io.BytesIO()
    done = measure_to_stream(MeasureJob(_saved(tmp_path), write(tmp_path / "r.csv", q)), good)
    assert done.rows == 150_000
    np.testing.assert_array_equal(pl.read_csv(good.getvalue()).to_numpy(), arm().tip(q))
    q[149_999, 0] = 100.0
    with pytest.raises(UlnaInputError, match=r"row 150000 .*column 'q1': got 100 rad.*degrees or counts"):
        measure_to_stream(MeasureJob(_saved(tmp_path), write(tmp_path / "r.csv", q)), bad)
    assert bad.getvalue() == b""


def _saved(folder: Path) -> Path:
    arm().save(folder / "arm.toml", force=True)
    return folder / "arm.toml"


def test_an_existing_file_is_not_overwritten(tmp_path: Path) -> None:
    path = write(tmp_path / "r.csv", angles(3))
    (tmp_path / "points.csv").write_text("kept")
    with pytest.raises(UlnaInputError, match="--force"):
        ulna.measure(arm(), path, out=tmp_path / "points.csv")
    assert (tmp_path / "points.csv").read_text() == "kept"
    ulna.measure(arm(), path, out=tmp_path / "points.csv", force=True)
    assert pl.read_csv(tmp_path / "points.csv").height == 3


def test_readings_outside_the_limits_are_told_with_their_rows(tmp_path: Path) -> None:
    q = angles(10)
    q[:, 3] = 0.0
    q[4, 3] = 2.5
    with pytest.warns(
        InputWarning, match=r"column 'q4': 1 reading outside .* joint 4 .*: row 5; the farthest is 2\.5 rad"
    ):
        ulna.measure(arm(limits_rad=(-2.0, 2.0)), write(tmp_path / "r.csv", q))


@pytest.mark.parametrize(
    ("probes", "columns", "probe", "expected"),
    [
        (PROBES, {}, None, "--probe bent or --probe straight"),
        (PROBES, {}, "bend", "Did you mean 'bent'"),
        (PROBES, {"probe": ["bent", "strait"]}, None, "row 2 .*'strait'.*Did you mean 'straight'"),
        (None, {"q5": [0.0, 0.0]}, None, "'q5' is one too many"),
        (None, {"prob": ["bent", "bent"]}, None, "unknown column 'prob'.*Did you mean 'probe'"),
    ],
)
def test_what_is_wrong_with_the_columns_is_told(
    tmp_path: Path, probes: Any, columns: dict[str, Any], probe: str | None, expected: str
) -> None:
    with pytest.raises(UlnaInputError, match=expected):
        ulna.measure(arm(probes), write(tmp_path / "r.csv", angles(2), **columns), probe)


def test_no_rows(tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError, match="no rows"):
        ulna.measure(arm(), write(tmp_path / "r.csv", angles(0)), out=tmp_path / "points.csv")
    assert not (tmp_path / "points.csv").exists()


@pytest.mark.parametrize(("key", "value"), [("angle", "grad"), ("units", "cm")])
def test_unknown_units(tmp_path: Path, key: str, value: str) -> None:
    with pytest.raises(UlnaInputError, match=f"'{value}'; expected"):
        ulna.measure(arm(), write(tmp_path / "r.csv", angles(2)), **{key: value})  # type: ignore[arg-type]


def test_the_whole_covariance_of_each_point(tmp_path: Path) -> None:
    """J C Jᵀ by NumPy, from the arm's own Jacobian; in inches as the squares of inches."""
    known = arm()
    count = len(known.parameter_names)
    root = np.random.default_rng(4).standard_normal((count, count)) * 1e-3
    known = dataclasses.replace(known, uncertainty=ParameterCovariance(list(known.parameter_names), root @ root.T, []))
    q = angles(40, 2)
    path = write(tmp_path / "r.csv", q)
    by_parameter = known.jacobian(q)
    expected = by_parameter @ (root @ root.T) @ by_parameter.transpose(0, 2, 1)
    for unit, mm in (("mm", 1.0), ("in", 25.4)):
        table = ulna.measure(known, path, covariance=True, units=unit).table  # type: ignore[arg-type]
        assert table is not None
        six = ["c_xx", "c_xy", "c_xz", "c_yy", "c_yz", "c_zz"]
        assert table.columns == ["x", "y", "z", "u_x", "u_y", "u_z", *six]
        i, j = np.triu_indices(3)
        np.testing.assert_allclose(table.select(six).to_numpy(), expected[:, i, j] / mm**2, rtol=1e-9)
        u = np.sqrt(np.diagonal(expected, axis1=1, axis2=2)) / mm
        np.testing.assert_allclose(table.select("u_x", "u_y", "u_z").to_numpy(), u, rtol=1e-9)
    with pytest.raises(UlnaInputError, match=r"no uncertainty is known of this arm"):
        ulna.measure(arm(), path, covariance=True)
