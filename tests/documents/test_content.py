"""What a report says, against numbers computed here from the readings, with NumPy and SciPy alone."""

from __future__ import annotations

import dataclasses
import json
import math
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats
from tests.cli_runs import write_lengths
from tests.reports import calibrated, seats_study

import ulna
from ulna.documents.content.clouds import trend
from ulna.documents.content.content import Content
from ulna.documents.content.distribution import bin_edges, normal_quantiles
from ulna.documents.content.thinning import runs, shown, shown_ranks
from ulna.documents.gather import gather


@pytest.fixture(scope="module")
def lengths(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return calibrated(write_lengths(tmp_path_factory.mktemp("lengths"), fit='hold = ["joint.1.theta0", "joint.1.d"]'))


@pytest.fixture(scope="module")
def seats(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return calibrated(seats_study(tmp_path_factory.mktemp("seats")))


@pytest.fixture(scope="module")
def of_lengths(lengths: Path) -> Content:
    return gather(lengths)


@pytest.fixture(scope="module")
def of_seats(seats: Path) -> Content:
    return gather(seats)


def length_errors(result: Path) -> tuple[ulna.Arm, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Arm, poses q and p, stated lengths and errors, from the files."""
    arm = ulna.Arm.load(result)
    rows = pl.read_csv(result.parent.parent / "rows.csv")
    q, p = (rows.select([f"{letter}{k}" for k in range(1, 8)]).to_numpy() for letter in "qp")
    stated = rows["length"].to_numpy()
    return arm, q, p, stated, np.linalg.norm(arm.tip(q) - arm.tip(p), axis=1) - stated


def test_before_and_after_are_those_of_the_readings(lengths, of_lengths):
    *_, error = length_errors(lengths)
    row = next(row for row in of_lengths.quality if row.quantity == "length_error")
    assert row.readings == "fitted"
    after = row.after
    assert after.mean_mm == pytest.approx(error.mean(), abs=1e-12)
    assert after.rms_mm == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-12)
    assert after.max_mm == pytest.approx(np.abs(error).max(), rel=1e-12)
    assert after.two_sigma_mm == pytest.approx(2 * np.std(error), rel=1e-9)
    start = ulna.Arm.load(lengths.parent.parent / "start.toml")
    _, q, p, stated, _ = length_errors(lengths)
    old = np.linalg.norm(start.tip(q) - start.tip(p), axis=1) - stated
    assert row.before.rms_mm == pytest.approx(np.sqrt(np.mean(old**2)), rel=1e-12)
    assert row.before.two_sigma_mm == pytest.approx(2 * np.std(old), rel=1e-9)


def test_distribution_is_that_of_scipy(lengths, of_lengths):
    *_, error = length_errors(lengths)
    (sample,) = of_lengths.samples
    assert (sample.artefact, sample.kind) == ("rows", "length")
    theory, ordered = stats.probplot(error, fit=False)
    assert np.allclose(sample.quantile, theory, atol=1e-12)
    assert np.allclose(sample.ordered_mm, ordered, atol=1e-12)
    assert sample.sigma_mm == pytest.approx(np.std(error, ddof=1), rel=1e-9)
    # the outermost errors are the edges, up to the rounding of two ways to compute them
    within = error.clip(sample.edges_mm[0], sample.edges_mm[-1])
    assert np.allclose(sample.counts, np.histogram(within, sample.edges_mm)[0])
    assert sample.counts.sum() == len(error)
    assert len(sample.edges_mm) == len(np.histogram_bin_edges(error, bins="fd"))


@pytest.mark.parametrize("count", [1, 2, 3, 10, 1000])
def test_quantiles_of_any_number(count):
    expected = stats.probplot(np.zeros(count), fit=False)[0]
    assert np.allclose(normal_quantiles(count), expected, atol=1e-12)


def test_equal_errors_have_a_histogram_too():
    assert len(bin_edges(np.full(5, 0.25))) == 2
    assert len(bin_edges(np.array([0.0, 0.0, 0.0, 0.0, 1.0]))) == 2


def test_correlation_is_that_of_the_covariance(lengths, of_lengths):
    document = json.loads(lengths.read_text(encoding="utf-8"))
    names, c = document["covariance"]["names"], document["covariance"]["matrix"]
    known = of_lengths.parameters
    assert known.correlation_names == names
    for i in range(len(names)):
        assert known.correlation[i, i] == pytest.approx(1.0)
        for j in range(i):
            assert known.correlation[i, j] == pytest.approx(c[i][j] / math.sqrt(c[i][i] * c[j][j]), abs=1e-12)


def test_singular_values_and_indices_are_those_of_numpy(lengths, of_lengths):
    arm, q, p, _, _ = length_errors(lengths)
    names = of_lengths.identification.names
    start = arm.parameters

    def measured(x):
        other = arm.with_parameters(x)
        return np.linalg.norm(other.tip(q) - other.tip(p), axis=1)

    columns = []
    for name in names:
        step = np.zeros(len(start))
        step[arm.parameter_names.index(name)] = 1e-5
        columns.append((measured(start + step) - measured(start - step)) / 2e-5)
    jacobian = np.stack(columns, axis=1)
    jacobian /= np.linalg.norm(jacobian, axis=0)
    values = np.linalg.svd(jacobian, compute_uv=False)
    found = of_lengths.observability
    assert found.determined == len(names) == 25
    assert found.equations == 101
    assert np.allclose(found.singular_values, values, rtol=1e-4)
    long = np.linalg.svd(jacobian * math.sqrt(101), compute_uv=False)
    assert found.indices["O1"] == pytest.approx(np.prod(long) ** (1 / 25) / math.sqrt(101), rel=1e-4)
    assert found.indices["O2"] == pytest.approx(long[-1] / long[0], rel=1e-4)
    assert found.indices["O3"] == pytest.approx(long[-1], rel=1e-4)
    assert found.indices["O4"] == pytest.approx(long[-1] ** 2 / long[0], rel=1e-4)
    assert found.indices["O5"] == pytest.approx(1 / np.sum(1 / long), rel=1e-4)


def test_parameters_have_expanded_uncertainties(lengths, of_lengths):
    document = json.loads(lengths.read_text(encoding="utf-8"))
    known = of_lengths.parameters
    freedom = document["fit"]["degrees_of_freedom"]
    assert known.k == pytest.approx(stats.t.ppf(0.975, freedom), rel=1e-9)
    assert [row.name for row in known.rows] == [row["name"] for row in document["parameters"]]
    for row, there in zip(known.rows, document["parameters"], strict=True):
        assert (row.nominal, row.estimate, row.u, row.status) == (
            there["start"],
            there["value"],
            there["u"],
            there["status"],
        )
        if row.u is None:
            assert row.expanded is None
            assert row.ratio is None
        else:
            assert row.expanded == pytest.approx(known.k * row.u)
            assert row.ratio == pytest.approx((row.estimate - row.nominal) / row.u)


def test_stated_noise_has_the_normal_factor(tmp_path):
    study = write_lengths(tmp_path, noise="[noise]\nencoder = 5e-7\nseat = 0.007")
    content = gather(calibrated(study))
    assert math.isinf(content.parameters.degrees_of_freedom)
    assert content.parameters.k == pytest.approx(stats.norm.ppf(0.975))
    assert content.environment.encoder_rad == [5e-7] * 7
    assert content.environment.seat_mm == 0.007
    lost = [row for row in content.parameters.rows if row.status == "not-determined"]
    assert {row.name for row in lost} == {"joint.1.theta0", "joint.1.d"}
    assert {row.cause for row in lost} == {"base-frame"}
    assert all("base frame" in row.reason for row in lost)
    assert not {"joint.1.theta0", "joint.1.d"} & set(content.parameters.correlation_names)


def test_residuals_over_a_joint_are_along_the_change_of_the_length(lengths, of_lengths):
    arm, q, p, _, error = length_errors(lengths)
    for joint in (2, 5):
        cloud = next(cloud for cloud in of_lengths.clouds if (cloud.over, cloud.joint) == ("joint", joint))
        step = np.zeros(7)
        step[joint - 1] = 1e-6
        by_q = np.linalg.norm(arm.tip(q + step) - arm.tip(p), axis=1) - np.linalg.norm(
            arm.tip(q - step) - arm.tip(p), axis=1
        )
        by_p = np.linalg.norm(arm.tip(q) - arm.tip(p + step), axis=1) - np.linalg.norm(
            arm.tip(q) - arm.tip(p - step), axis=1
        )
        assert np.allclose(cloud.x, np.degrees(np.concatenate([q, p])[:, joint - 1]))
        expected = np.concatenate([np.sign(by_q) * error, np.sign(by_p) * error])
        assert np.allclose(cloud.residual_mm, expected, atol=1e-9)
        assert np.array_equal(cloud.reading, np.tile(np.arange(len(q)), 2))


def test_vectors_of_lengths_lie_along_them(lengths, of_lengths):
    arm, q, p, _, error = length_errors(lengths)
    found = of_lengths.quiver
    assert np.allclose(found.at_mm, arm.tip(p))
    assert np.allclose(np.linalg.norm(found.vector_mm, axis=1), np.abs(error))
    along = arm.tip(p) - arm.tip(q)
    assert np.allclose(np.sign(np.sum(found.vector_mm * along, axis=1)), np.sign(error))


def test_residuals_of_seats_over_joints_reach_and_temperature(seats, of_seats):
    arm = ulna.Arm.load(seats)
    touches = pl.read_csv(seats.parent.parent / "touches.csv")
    q = touches.select([f"q{k}" for k in range(1, 8)]).to_numpy()
    residuals = pl.read_csv(seats.parent / "residuals.csv")
    vector = residuals.select("x_mm", "y_mm", "z_mm").to_numpy()
    clouds = {(cloud.over, cloud.joint): cloud for cloud in of_seats.clouds}
    assert [key for key in clouds if key[0] == "joint"] == [("joint", k) for k in range(1, 8)]
    for joint in (1, 4):
        step = np.zeros(7)
        step[joint - 1] = 1e-6
        motion = arm.tip(q + step) - arm.tip(q - step)
        motion /= np.linalg.norm(motion, axis=1, keepdims=True)
        assert np.allclose(clouds["joint", joint].residual_mm, np.sum(vector * motion, axis=1), atol=1e-6)
    assert np.allclose(clouds["reach", 0].x, np.linalg.norm(arm.tip(q), axis=1))
    assert np.allclose(clouds["reach", 0].residual_mm, np.linalg.norm(vector, axis=1), atol=1e-12)
    assert np.allclose(clouds["temperature", 0].x, touches["temperature"].to_numpy())
    assert of_seats.environment.temperature_c == pytest.approx((20.0, touches["temperature"].mean(), 21.0))
    assert np.allclose(of_seats.quiver.vector_mm, vector)


def test_a_reading_far_off_is_an_outlier_and_is_kept(of_seats):
    assert [(entry["row"], entry["placement"]) for entry in of_seats.outliers] == [(8, "here")]
    assert np.flatnonzero(of_seats.readings.outlier).tolist() == [7]
    assert of_seats.readings.size_mm[7] == of_seats.readings.size_mm.max()
    assert len(of_seats.samples[0].value_mm) == 3 * len(of_seats.readings.row)


def test_bars_touched_once_at_each_end_count_by_their_lengths(root):
    study = root / "examples" / "platinum" / "study.toml"
    result = ulna.calibrate(ulna.Study.load(study))
    from ulna.documents.content.distribution import samples

    (sample,) = samples(result.residuals, result.artefacts)
    assert sample.kind == "length"
    assert len(sample.value_mm) == 101
    assert np.sqrt(np.mean(sample.value_mm**2)) == pytest.approx(result.after["length_error_rms_mm"])


def test_an_eccentric_encoder_shows_in_the_means_of_its_joint(tmp_path):
    # the third encoder reads 0.3 mrad too much at 90°, too little at -90°
    study = write_lengths(tmp_path, rows=3000, fit='free = ["joint.1.theta0"]')
    rows = pl.read_csv(tmp_path / "rows.csv")
    for name in ("q3", "p3"):
        rows = rows.with_columns((pl.col(name) + 3e-4 * pl.col(name).sin()).alias(name))
    rows.write_csv(tmp_path / "rows.csv")
    from tests.cli_runs import platinum

    platinum().save(tmp_path / "start.toml", force=True)
    content = gather(calibrated(study))
    wave = {}
    for cloud in content.clouds:
        if cloud.over == "joint":
            sine = np.sin(np.radians(cloud.trend.x))
            wave[cloud.joint] = float(sine @ cloud.trend.mean_mm / (sine @ sine))
    assert max(wave, key=lambda joint: abs(wave[joint])) == 3
    assert abs(wave[3]) > 10 * max(abs(size) for joint, size in wave.items() if joint != 3)


def test_means_over_ranges_are_those_of_the_values():
    x = np.array([0.0, 0.1, 0.2, 10.0, 23.95, 24.0])
    found = trend(x, np.array([1.0, 2.0, 6.0, 100.0, 4.0, 4.0]))
    assert found.x.tolist() == [0.5]  # one range has three readings
    assert found.mean_mm.tolist() == [3.0]
    assert found.u_mm == pytest.approx([np.std([1, 2, 6], ddof=1) / np.sqrt(3)])
    assert len(trend(np.full(9, 2.0), np.zeros(9)).x) == 0


@given(st.lists(st.booleans(), min_size=1, max_size=300), st.integers(1, 50))
def test_thinning_keeps_every_outlier_and_says_what_it_does(outlier, most):
    always = np.array(outlier)
    part = shown(always, most)
    assert set(np.flatnonzero(always)) <= set(part.index.tolist()) or part.step == 1
    assert len(part.index) <= most + int(always.sum())
    assert sorted(set(part.index.tolist())) == part.index.tolist()
    if part.step == 1:
        assert len(part.index) == len(always)
        assert part.said.key == "shown.all"
    else:
        assert part.said.values == {"step": part.step, "count": len(always), "outliers": int(always.sum())}


@given(st.integers(1, 2000))
def test_thinned_ranks_keep_the_tails(count):
    kept = shown_ranks(count, 500)
    assert len(kept) <= max(500, 0) or count <= 500
    assert {0, count - 1} <= set(kept.tolist())
    if count > 500:
        assert set(range(100)) | set(range(count - 100, count)) <= set(kept.tolist())


@given(st.lists(st.floats(0, 10), min_size=1, max_size=200), st.integers(1, 20))
def test_runs_of_readings(values, most):
    value = np.array(values)
    found = runs(value, value > 9.0, most)
    assert len(found.first) <= most
    for k, first in enumerate(found.first):
        own = value[first : first + found.step]
        assert found.rms[k] == pytest.approx(np.sqrt(np.mean(own**2)))
        assert found.largest[k] == own.max()
        assert found.outlier[k] == (own > 9.0).any()


def test_every_dataclass_of_the_content_is_frozen(of_lengths):
    with pytest.raises(dataclasses.FrozenInstanceError):
        of_lengths.arm = "another"
    assert of_lengths.provenance.time.startswith("20")
    assert [file.state for file in of_lengths.provenance.files] == ["same"] * 3
