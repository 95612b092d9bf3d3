"""Arms known by a certificate alone: simulated tests by hand, the arms that are kept, whether they hold the truth."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.cli_runs import assert_bad_input, run, strict_json

from ulna.arm.arm import Arm
from ulna.arm.effects.effects import Effects
from ulna.arm.reading_noise import UNKNOWN
from ulna.ground.errors import InputWarning, UlnaInputError
from ulna.reproduce.ways.arms import SEVEN, true_arm
from ulna.simulation.mover import Mover
from ulna.uncertainties.assess import assess
from ulna.uncertainties.constrained import Constrained
from ulna.uncertainties.knowledge import known_of_performance
from ulna.uncertainties.measurands import Touched
from ulna.uncertainties.performance import LengthTest, Performance, PointTest, SphereTest
from ulna.uncertainties.performance_file import read_performance
from ulna.uncertainties.simulated_tests import SetUp, set_up
from ulna.uncertainties.task import Task
from ulna.work.pieces import Threads

TRAVEL = np.tile([-3.0, 3.0], (7, 1))
ENCODER_RAD = np.full(7, 5e-6)
POINT = PointTest({"two_s": 0.05})
LENGTH = LengthTest({"two_sigma": 0.05}, (600.0,))
SPHERE = SphereTest({"form": 0.05}, 25.0)


def certificate(*tests: PointTest | LengthTest | SphereTest, **more: object) -> Performance:
    usual = Performance("certificate", "bent", 1e-5, 0.01, (0.1, 20.0), (), ENCODER_RAD, 0.008, tests)
    return replace(usual, **more)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def arm() -> Arm:
    return true_arm(SEVEN).arm


def still(test: PointTest | LengthTest | SphereTest, tip_mm: np.ndarray, shape: tuple[int, int]) -> SetUp:
    """Poses whose tips move by whatever the parameters are off: three parameters to each coordinate."""
    size = tip_mm.size
    return SetUp(test, tip_mm, np.eye(size), np.zeros((len(tip_mm), 3, 3)), shape)


def test_figures_of_points_by_hand() -> None:
    # one seat touched four times, off by ±3 µm in x and ±4 µm in y: each 5 µm from the mean
    off = np.array([[3.0, 4.0, 0], [-3.0, 4.0, 0], [3.0, -4.0, 0], [-3.0, -4.0, 0]]) / 1000
    found = still(POINT, np.tile([500.0, 0.0, 0.0], (4, 1)), (1, 4)).figures(
        off.reshape(1, -1), np.random.default_rng(0)
    )
    assert found["largest"] == pytest.approx([0.005])
    assert found["two_s"] == pytest.approx([2 * np.sqrt(4 * 0.005**2 / 3)])
    assert found["half_range"] == pytest.approx([0.004])


def test_figures_of_lengths_by_hand() -> None:
    # three bars of 100 mm along x, found too long by 1, -2 and 4 µm
    ends = np.array([[0.0, 0, 0], [100.0, 0, 0]] * 3)
    off = np.zeros((6, 3))
    off[1::2, 0] = np.array([1.0, -2.0, 4.0]) / 1000
    found = still(LENGTH, ends, (3, 2)).figures(off.reshape(1, -1), np.random.default_rng(0))
    assert found["largest"] == pytest.approx([0.004])
    assert found["two_sigma"] == pytest.approx([2 * 0.003])  # about their mean of 1: 0, -3, 3
    assert found["half_range"] == pytest.approx([0.003])


def test_figures_of_spheres_by_hand() -> None:
    # an octahedron's corners on a ball of 20 mm, all 1 µm too far out: the diameter is 2 µm too large, the form nothing
    corners = np.concatenate([np.eye(3), -np.eye(3)])
    found = still(SPHERE, 300.0 + 10.0 * corners, (1, 6)).figures(
        (0.001 * corners).reshape(1, -1), np.random.default_rng(0)
    )
    assert found["size"] == pytest.approx([0.002], abs=1e-9)
    assert found["form"] == pytest.approx([0.0], abs=1e-9)
    # two opposite corners 3 µm out, by symmetry about the same centre: the radius is 1 µm larger, the form 3 µm
    off = 0.003 * corners * (np.abs(corners[:, :1]) > 0)
    found = still(SPHERE, 300.0 + 10.0 * corners, (1, 6)).figures(off.reshape(1, -1), np.random.default_rng(0))
    assert found["size"] == pytest.approx([0.002], abs=1e-7)
    assert found["form"] == pytest.approx([0.003], abs=1e-7)


def test_what_is_linear_is_nearly_the_whole_arm(arm: Arm) -> None:
    """For an arm as far off as usual certificates allow, the square of it is a hundredth of a micrometre."""
    rng = np.random.default_rng(5)
    off = rng.standard_normal(len(arm.parameters)) * np.where(np.array(arm.parameter_units) == "mm", 0.02, 2e-5)
    q_rad = rng.uniform(-3.0, 3.0, (200, 7))
    moved = arm.with_parameters(arm.parameters + off).tip(q_rad) - arm.tip(q_rad)
    assert np.abs(moved).max() > 0.02
    assert np.abs(moved - arm.core.jacobian(q_rad, 0) @ off).max() < 1e-5


def test_seats_are_where_they_were_asked_to_be(arm: Arm) -> None:
    (made, *_) = set_up(arm, certificate(POINT, LENGTH, SPHERE), Mover(arm, TRAVEL), np.random.default_rng(6))
    seats = made.tip_mm.reshape(3, 10, 3)
    assert np.ptp(seats, axis=1).max() < 1e-8
    assert np.abs(np.linalg.norm(seats[:, 0], axis=1) / arm.core.reach_mm(0) - [0.2, 0.5, 0.8]).max() < 0.1


def test_the_cut_of_the_work_changes_nothing(arm: Arm) -> None:
    asked = certificate(POINT, LENGTH)
    one = Constrained(arm, asked, TRAVEL, seed=3, workers=Threads(1)).sets(0, 500)
    two = Constrained(arm, asked, TRAVEL, seed=3, workers=Threads(3))
    assert two.sets(0, 200).tolist() == one[:200].tolist()
    assert two.sets(100, 400).tolist() == one[100:].tolist()
    # the base frame shows in no test and stays
    frame = [arm.parameter_names.index(name) for name in ("joint.1.theta0", "joint.1.d")]
    assert np.ptp(one[:, frame], axis=0).max() == 0.0
    assert np.ptp(np.delete(one, frame, axis=1), axis=0).min() > 0
    assert two.shares.kept >= 500


def test_tighter_figures_keep_tighter_arms(arm: Arm) -> None:
    def spread(two_sigma: float) -> float:
        asked = certificate(LengthTest({"two_sigma": two_sigma}, (600.0,)))
        sets = Constrained(arm, asked, TRAVEL).sets(0, 400)
        return float(np.sqrt(np.mean((sets - arm.parameters) ** 2)))

    assert spread(0.2) > 2 * spread(0.06)


@pytest.mark.long
@pytest.mark.slow
def test_the_truth_is_where_the_certificate_says(arm: Arm) -> None:
    """Arms drawn as the file says, each with the certificate that its own test gave: the interval of a length of such
    an arm holds the truth in about 95 of 100."""
    rng = np.random.default_rng(11)
    free = np.array([name not in ("joint.1.theta0", "joint.1.d") for name in arm.parameter_names])
    unit = np.where(np.array(arm.parameter_units) == "mm", 0.01, 1e-5) * free
    mover = Mover(arm, TRAVEL)
    held = []
    for seed in range(10):
        factor = np.exp(rng.uniform(np.log(0.1), np.log(20.0)))
        truth = arm.with_parameters(arm.parameters + factor * unit * rng.standard_normal(len(unit)))
        asked = certificate(POINT, LENGTH)
        tests = set_up(arm, asked, mover, rng)
        found = [test.figures((truth.parameters - arm.parameters)[None], rng) for test in tests]
        point = replace(POINT, figures_mm={"two_s": float(found[0]["two_s"][0])})
        length = replace(LENGTH, figures_mm={"two_sigma": float(found[1]["two_sigma"][0])})
        arms = Constrained(arm, certificate(point, length), TRAVEL, seed=seed)
        sets = arms.sets(0, 400)
        for q_rad in rng.uniform(-2.5, 2.5, (8, 2, 7)):
            ends = np.stack([arm.with_parameters(row).tip(q_rad) for row in sets])
            lengths = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
            low, high = np.quantile(lengths, (0.025, 0.975))
            p = truth.tip(q_rad)
            held.append(bool(low < np.linalg.norm(p[1] - p[0]) < high))
    assert np.mean(held) == pytest.approx(0.95, abs=0.08)


PERFORMANCE = Path(__file__).parents[2] / "examples" / "platinum" / "performance.toml"


@pytest.fixture
def files(tmp_path: Path, root: Path) -> Path:
    for name in ("platinum.toml", "length.toml", "length.csv", "volume.toml"):
        (tmp_path / name).write_bytes((root / "examples" / "platinum" / name).read_bytes())
    text = (
        PERFORMANCE.read_text().replace("two_s = 0.060", "two_s = 0.060\ntouches = 5").replace("[600, 1200]", "[600]")
    )
    (tmp_path / "performance.toml").write_text(text)
    return tmp_path


def test_the_command(files: Path) -> None:
    ask = ("uncertainty", files / "platinum.toml", files / "length.toml", "--performance", files / "performance.toml")
    done = run(*ask, "--trials", "2000", "-o", files / "out")
    assert done.returncode == 0, done.stderr
    assert max(map(len, done.stdout.splitlines())) <= 80
    for words in ("of arms that agree", "agree with the certificate", "assumed, in"):
        assert words in done.stdout
    found = strict_json((files / "out" / "uncertainty.json").read_text())
    assert found["parameters_from"] == "performance"
    assert 5000 <= found["arms"]["kept"] < found["arms"]["drawn"]
    (value,) = found["values"]
    assert value["u"] == pytest.approx(value["monte_carlo"]["u"], rel=0.1)
    volume = run("uncertainty", files / "platinum.toml", files / "volume.toml", *ask[3:])
    assert volume.returncode == 0, volume.stderr


def test_known_of_a_certificate_is_first_order_too(files: Path) -> None:
    known = known_of_performance(files / "platinum.toml", files / "performance.toml", seed=1)
    assert known.arms is not None
    touched = Touched("length", np.array([0, 1]))
    q_rad = np.random.default_rng(2).uniform(-2.0, 2.0, (2, 7))
    task = Task(touched, q_rad, "bent", "task", UNKNOWN, digits=1)
    (value,) = assess(known.arm, task, arms=known.arms, most_trials=5000).values
    assert value.monte_carlo is not None
    assert value.monte_carlo.u == pytest.approx(value.u, rel=0.05)


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("two_s = 0.060", "", ("key 'test.1'", "figure is missing", "largest, two_s, half_range")),
        ("two_s = 0.060", "two_s = 0.001", ("drawn none agrees", "two_s of test 1", "noise alone")),
        ('kind = "point"', 'kind = "pont"', ("key 'test.1.kind'", "Did you mean 'point'?")),
        ("two_s = 0.060", "two_sigma = 0.060", ("unknown key 'test.1.two_sigma'",)),
        ("angle = 1e-5", "angle = 1e-5\nfactor = [2, 1]", ("'spread.factor'", "Swap them")),
        ("angle = 1e-5", "angle = 1e-5\nhold = ['joint.9.*']", ("'spread.hold'", "joint.9.*")),
        ("angle = 1e-5", "angle = 1e-5\nhold = ['*']", ("every parameter is held",)),
        ("lengths = [600]", "lengths = [9000]", ("test 2: length 9000 mm", "Take a smaller one")),
        ("units = {", 'probe = "bend"\nunits = {', ("key 'probe'", "'bend'", "'bent'")),
    ],
)
def test_messages(files: Path, old: str, new: str, expected: tuple[str, ...]) -> None:
    path = files / "performance.toml"
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    done = run("uncertainty", files / "platinum.toml", files / "length.toml", "--performance", path)
    assert_bad_input(done, *expected)


def test_nothing_is_known_of_another_probe(files: Path) -> None:
    with (files / "platinum.toml").open("a") as arm:
        arm.write("\n[probe.other]\ntip = { x = 0.0, y = 10.0, z = 100.0 }\n")
    path = files / "performance.toml"
    path.write_text(path.read_text().replace("units = {", 'probe = "bent"\nunits = {', 1))
    for name, key in (("length.toml", 'file = "length.csv"\nprobe = "other"'), ("volume.toml", None)):
        task = files / name
        text = task.read_text()
        task.write_text(
            text.replace('file = "length.csv"', key)
            if key
            else text.replace("units = {", 'probe = "other"\nunits = {', 1)
        )
        done = run("uncertainty", files / "platinum.toml", task, "--performance", path)
        assert_bad_input(done, "probe 'other' is on", "is of probe 'bent'", "nothing is known")


def test_arms_that_grow_are_refused(arm: Arm) -> None:
    grows = replace(arm, joints=(replace(arm.joints[0], effects=Effects(expansion_per_k=1e-5)), *arm.joints[1:]))
    with pytest.raises(UlnaInputError, match="grow with temperature"):
        Constrained(grows, certificate(POINT), TRAVEL)


def test_a_study_and_a_certificate_are_one_too_many(files: Path, root: Path) -> None:
    study = root / "examples" / "platinum" / "study.toml"
    ask = ("uncertainty", files / "platinum.toml", files / "length.toml", "--performance", files / "performance.toml")
    assert_bad_input(run(*ask, "--study", study), "Leave one out")
    stated = read_performance(files / "performance.toml", Arm.load(files / "platinum.toml"))
    assert stated.performance.tests[1].figures_mm == {"two_sigma": 0.055}


def test_a_file_of_format_1_arrives(root: Path) -> None:
    fossils = root / "tests" / "data" / "fossils"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        arm = Arm.load(fossils / "arm-1.toml")
    stated = read_performance(fossils / "performance-1.toml", arm)
    assert stated.travel_rad is not None
    assert stated.travel_rad[3] == pytest.approx(np.radians([-70.0, 70.0]))
    found = stated.performance
    assert (found.probe, found.within, found.at_most, found.factor, found.hold) == (
        "bent",
        0.3,
        True,
        (0.1, 10.0),
        ("joint.1.*",),
    )
    assert (found.spread_rad, found.spread_mm) == pytest.approx((np.radians(0.001), 0.0254))
    assert found.encoder_rad == pytest.approx(np.radians([0.001, 0.002, 0.001, 0.001]))
    assert found.seat_mm == pytest.approx(0.01016)
    point, length, sphere = found.tests
    assert isinstance(point, PointTest)
    assert (point.positions, point.touches) == ((0.3, 0.7), 8)
    assert point.figures_mm == pytest.approx({"largest": 0.0254, "two_s": 0.0508, "half_range": 0.0381})
    assert isinstance(length, LengthTest)
    assert (length.lengths_mm, length.places) == (pytest.approx((254.0, 508.0)), 6)
    assert length.figures_mm == pytest.approx({"largest": 0.0762, "two_sigma": 0.1016, "half_range": 0.0889})
    assert isinstance(sphere, SphereTest)
    assert (sphere.diameter_mm, sphere.positions, sphere.touches) == (25.4, 3, 9)
    assert sphere.figures_mm == pytest.approx({"form": 0.127, "size": 0.1524})
