"""Maps of uncertainty over the volume: each place against the single measurement there, and what users get wrong."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.cli_runs import assert_bad_input, run, strict_json

from ulna.arm.arm import Arm
from ulna.arm.covariance import ParameterCovariance
from ulna.arm.reading_noise import ReadingNoise
from ulna.ground.errors import InputWarning
from ulna.measuring.tip_uncertainty import TipUncertainty
from ulna.reproduce.ways import readings, trial
from ulna.reproduce.ways.arms import SEVEN, true_arm
from ulna.uncertainties.assess import assess
from ulna.uncertainties.measurands import Touched
from ulna.uncertainties.task import Task
from ulna.uncertainties.volume import Account, Somewhere, VolumeMap, VolumeTask, volume_map
from ulna.uncertainties.volume_file import is_volume, read_volume
from ulna.uncertainties.zones import Spread, by_distance, cells

TRAVEL = np.tile([-3.0, 3.0], (7, 1))
ENCODER_RAD = np.full(7, 5e-6)


@pytest.fixture(scope="module")
def calibrated() -> Arm:
    import ulna

    truth = true_arm(SEVEN)
    study = trial.study_of(trial.start_of(truth, 1), readings.lengths_alone(readings.ball_bar(truth, 1)))
    return ulna.calibrate(study).arm


def asked(**more: object) -> VolumeTask:
    usual = VolumeTask(TRAVEL, "bent", "volume", ReadingNoise(ENCODER_RAD, 0.008), points=200, bars=100)
    return replace(usual, **more)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "noise",
    [
        ReadingNoise(ENCODER_RAD, 0.008),
        ReadingNoise(ENCODER_RAD, 0.008, unexplained_mm=0.02, degrees_of_freedom=20.0),
        ReadingNoise(None, 0.02, degrees_of_freedom=20.0, estimated=True),
    ],
)
def test_a_place_is_as_sure_as_the_measurement_there(calibrated: Arm, noise: ReadingNoise) -> None:
    rng = np.random.default_rng(3)
    q_rad = rng.uniform(-2.5, 2.5, (12, 2, 7))
    task = asked(noise=noise)
    u_mm, expanded_mm = Account(calibrated, task).of_lengths(q_rad)
    for k, poses in enumerate(q_rad):
        measured = Task(
            Touched("length", np.array([0, 1])),
            np.ascontiguousarray(poses),
            "bent",
            "length",
            noise,
        )
        (value,) = assess(calibrated, measured, most_trials=0).values
        assert u_mm[k] == pytest.approx(value.u, rel=1e-6)
        assert expanded_mm[k] == pytest.approx(value.expanded, rel=1e-6)
    flat = np.ascontiguousarray(q_rad.reshape(-1, 7))
    position = np.sqrt(TipUncertainty(calibrated, noise).covariance(flat, 0)[:, [0, 3, 5]].sum(axis=1))
    assert Account(calibrated, task).of_points(flat) == pytest.approx(position, rel=1e-9)


def test_what_the_calibration_left_open_has_no_figure(calibrated: Arm) -> None:
    known = calibrated.uncertainty
    assert known is not None
    direction = {"combination": {"joint.3.a": 1.0}, "because": "nobody looked", "remedy": "look"}
    opened = replace(calibrated, uncertainty=replace(known, lost=[*known.lost, direction]))
    found = volume_map(opened, asked(lengths_mm=(300.0,)), seed=1)
    assert np.isnan(found.points.u_mm).all()
    assert not found.whole
    assert direction in found.not_determined
    # of the base frame nothing depends that has a shape
    frame = volume_map(replace(calibrated, uncertainty=known), asked(lengths_mm=(300.0,)), seed=1)
    assert frame.whole
    assert frame.not_determined == []
    # what was held counts as exact, and is said
    k = known.names.index("joint.3.a")
    names, matrix = [*known.names[:k], *known.names[k + 1 :]], np.delete(np.delete(known.matrix, k, 0), k, 1)
    held = replace(calibrated, uncertainty=ParameterCovariance(names, matrix, known.lost))
    assert volume_map(held, asked(), seed=1).left_out[0].endswith("exact: joint.3.a")


def test_places_are_within_reach_and_in_the_box(calibrated: Arm) -> None:
    box = ((100.0, -200.0, 0.0), (700.0, 300.0, 600.0))
    found = volume_map(calibrated, asked(box_mm=box, lengths_mm=(150.0,)), seed=2)
    for places in (found.points, found.lengths[150.0]):
        assert (places.at_mm >= box[0]).all()
        assert (places.at_mm <= box[1]).all()
    # uniform: the middle of the points is the middle of the box
    spread = np.subtract(box[1], box[0]) / np.sqrt(12 * len(found.points.at_mm))
    assert (np.abs(found.points.at_mm.mean(axis=0) - np.mean(box, axis=0)) < 4 * spread).all()
    again = volume_map(calibrated, asked(box_mm=box, lengths_mm=(150.0,)), seed=2)
    assert again.points.u_mm.tolist() == found.points.u_mm.tolist()


def test_zones_and_cells_by_hand() -> None:
    at_mm = np.array([[30.0, 40.0, 0.0]] * 4 + [[0.0, 95.0, 0.0]] * 3 + [[0.0, 0.0, 15.0]])
    u_mm = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0, np.nan, 9.0])
    points = Somewhere(at_mm, u_mm, np.full(8, np.nan))
    found = VolumeMap("arm", "ball", 100.0, 0.95, 0, points, {10.0: points}, [], [])
    zones = by_distance(found)
    assert [(low, high) for low, high, _ in zones] == [(0.0, 20.0), (40.0, 60.0), (80.0, 100.0)]
    assert zones[1][2] == Spread(4, 0, 2.5, pytest.approx(3.85), 4.0)
    assert zones[2][2] == Spread(3, 1, 5.5, pytest.approx(5.95), 6.0)
    table = cells(found)
    assert table.select("r_mm", "z_mm").rows() == [(5.0, 15.0), (55.0, 5.0), (95.0, 5.0)]
    # one place is too few, and a cell with something open has no figure
    assert table["point_u_mm"].to_list() == [None, 2.5, None]
    assert table["point_places"].to_list() == [1, 4, 3]


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory, root: Path) -> Path:
    out = tmp_path_factory.mktemp("volume") / "out"
    assert run("calibrate", root / "examples" / "platinum" / "study.toml", "-o", out).returncode == 0
    return out


def test_the_command_writes_a_map(result: Path, tmp_path: Path, root: Path) -> None:
    volume = tmp_path / "volume.toml"
    text = (root / "examples" / "platinum" / "volume.toml").read_text()
    volume.write_text(text.replace("\n[travel]", "points = 3000\nbars = 300\nlengths = [900, 300]\n\n[travel]"))
    done = run("uncertainty", result, volume, "-o", tmp_path / "map")
    assert done.returncode == 0, done.stderr
    assert max(len(line) for line in done.stdout.splitlines()) <= 80
    document = strict_json((tmp_path / "map" / "volume.json").read_text())
    assert [row["length_mm"] for row in document["lengths"]] == [300.0, 900.0]
    assert document["lengths"][0]["u"]["places"] == 300
    table = pl.read_csv(tmp_path / "map" / "volume.csv")
    assert table["point_places"].sum() == 3000
    assert (tmp_path / "map" / "volume.png").stat().st_size > 10_000
    printed = run("uncertainty", result, volume, "--json")
    assert strict_json(printed.stdout) == document
    assert_bad_input(run("uncertainty", result, volume, "-o", tmp_path / "map"), "exists already")


def test_messages(result: Path, tmp_path: Path, root: Path) -> None:
    text = (root / "examples" / "platinum" / "volume.toml").read_text()
    volume = tmp_path / "volume.toml"

    def refused(new: str, *expected: str, options: tuple[str, ...] = ()) -> None:
        volume.write_text(new)
        assert_bad_input(run("uncertainty", result, volume, *options), *expected)

    refused(text.split("[travel]")[0], "joint 1", "has no limits", "[travel]")
    refused(text.replace("\n[travel]", 'probe = "bend"\n\n[travel]'), "key 'probe'", "'bend'", "bent")
    refused(text.replace("\n[travel]", "lengths = [9000]\n\n[travel]"), "length 9000 mm", "only 0 of 2000")
    refused(text.replace("\n[travel]", "lengths = [-1]\n\n[travel]"), "lengths", "-1")
    refused(text.replace("volume/1", "volume/2"), "version 2 of ulna-volume")
    refused(text + "\n[volume]\nlow = [5000, 0, 0]\nhigh = [5001, 1, 1]\n", "only 0 of 20000", "within its reach")
    study = str(root / "examples" / "platinum" / "study.toml")
    refused(text, "first order and quick", "--study", options=("--study", study))


def test_a_file_of_format_1_arrives(root: Path) -> None:
    fossils = root / "tests" / "data" / "fossils"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        arm = Arm.load(fossils / "arm-1.toml")
    assert is_volume(fossils / "volume-1.toml")
    found = read_volume(fossils / "volume-1.toml", arm)
    assert found.probe == "bent"
    assert found.lengths_mm == pytest.approx((254.0, 508.0))
    assert found.box_mm == ((-254.0, -254.0, 0.0), (254.0, 254.0, 508.0))
    assert found.travel_rad == pytest.approx(np.radians([[-100.0, 100.0]] * 4))
    assert found.noise is not None
    assert found.noise.encoder_rad == pytest.approx(np.radians([0.001, 0.002, 0.001, 0.001]))
    assert found.noise.seat_mm == pytest.approx(0.01016)
    assert (found.file.points, found.file.bars, found.file.p) == (500, 200, 0.99)
    assert found.file.temperature is not None
    assert (found.file.temperature.value, found.file.temperature.u) == (21.5, 0.5)
