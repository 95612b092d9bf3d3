"""How sure a measurement is: each step against something that was made another way, and the whole against the truth."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from scipy.optimize import least_squares
from tests.cli_runs import assert_bad_input, run, strict_json

import ulna
from ulna.arm.arm import Arm
from ulna.arm.probe import Probe
from ulna.arm.reading_noise import UNKNOWN, ReadingNoise
from ulna.formats.models import fill
from ulna.formats.toml import read_toml
from ulna.ground.errors import UlnaInputError
from ulna.measuring.tip_uncertainty import TipUncertainty
from ulna.reproduce.ways import readings, trial
from ulna.reproduce.ways.arms import SEVEN, true_arm
from ulna.study.data import FitOptions
from ulna.uncertainties.assess import assess
from ulna.uncertainties.first_order import first_order
from ulna.uncertainties.measurands import MEASURANDS, Touched
from ulna.uncertainties.task import Task
from ulna.uncertainties.task_file import TaskFile

ENCODER_RAD, SEAT_MM = np.full(7, 5e-6), 0.008


@pytest.fixture(scope="module")
def calibrated() -> tuple[ulna.Study, Arm]:
    """The virtual Platinum from 140 lengths."""
    truth = true_arm(SEVEN)
    study = trial.study_of(trial.start_of(truth, 1), readings.lengths_alone(readings.ball_bar(truth, 1)))
    return study, ulna.calibrate(study).arm


def task_of(kind: str, feature: list[int], q_rad: np.ndarray, **more: object) -> Task:
    given = {"noise": ReadingNoise(ENCODER_RAD, SEAT_MM), "digits": 1} | more
    return Task(Touched(kind, np.array(feature)), q_rad, "bent", "task", **given)  # type: ignore[arg-type]


def poses(count: int, seed: int) -> np.ndarray:
    return true_arm(SEVEN).anywhere(count, np.random.default_rng(seed))


def test_a_ball_is_the_least_squares_sphere() -> None:
    rng = np.random.default_rng(1)
    for cap in (1.0, 0.4):  # a whole ball, and a cap of it
        direction = rng.standard_normal((25, 3))
        direction[:, 2] = np.abs(direction[:, 2]) / cap
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        touches = np.array([300.0, -200.0, 500.0]) + 15.5 * direction + 0.01 * rng.standard_normal((25, 3))

        def off(x: np.ndarray, touches: np.ndarray = touches) -> np.ndarray:
            return np.linalg.norm(touches - x[:3], axis=1) - x[3]

        by_scipy = least_squares(off, [310.0, -190.0, 490.0, 10.0], xtol=1e-15, ftol=1e-15, gtol=1e-15).x
        (found,) = MEASURANDS["ball"].of(touches[None])
        np.testing.assert_allclose(found, [*by_scipy[:3], 2 * by_scipy[3]], rtol=0, atol=1e-6)


def test_distances_and_lengths() -> None:
    rng = np.random.default_rng(2)
    normal = np.array([1.0, 2.0, -2.0]) / 3.0
    along = np.linalg.svd(normal[None])[2][1:]
    plane = 400.0 * normal + rng.uniform(-50, 50, (12, 2)) @ along
    point = 400.0 * normal + 30.0 * normal + np.array([7.0, 0.0, 0.0]) @ (np.eye(3) - np.outer(normal, normal))
    (found,) = MEASURANDS["distance"].of(plane[None], point[None, None])
    assert found[0] == pytest.approx(-30.0, abs=1e-9)  # beyond the plane, seen from the base
    (found,) = MEASURANDS["length"].of(np.zeros((1, 2, 3)), np.array([[[3.0, 4.0, 0.0], [3.0, 4.0, 0.0]]]))
    assert found[0] == 5.0


def test_a_points_first_order_is_that_of_measure(calibrated) -> None:
    """The same by the program's older way, which takes encoder noise as noise of zero offsets."""
    _, arm = calibrated
    for q_rad in poses(6, 3):
        found = first_order(arm, task_of("point", [0], q_rad[None], noise=ReadingNoise(ENCODER_RAD)))
        xx, xy, xz, yy, yz, zz = TipUncertainty(arm, ReadingNoise(ENCODER_RAD)).covariance(q_rad[None], 0)[0]
        expected = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]
        np.testing.assert_allclose(found.covariance, expected, rtol=1e-6, atol=1e-15)


def test_points_of_one_length_share_the_parameters(calibrated) -> None:
    """Two ends in the same place, touched in the same pose: the parameters' part of the difference vanishes."""
    _, arm = calibrated
    q_rad = poses(1, 4)
    near = q_rad.copy()
    near[0, 6] += 1e-3
    found = first_order(arm, task_of("length", [0, 1], np.concatenate([q_rad, near])))
    parameters = np.sqrt(found.by_source["parameters"][0, 0])
    alone = first_order(arm, task_of("point", [0], q_rad)).by_source["parameters"]
    assert parameters < 0.01 * np.sqrt(np.trace(alone))
    touch = np.sqrt(found.by_source["touch"][0, 0])
    assert touch == pytest.approx(SEAT_MM * np.sqrt(2.0), rel=1e-3)


def test_monte_carlo_agrees_with_the_first_order_where_all_is_linear(calibrated) -> None:
    _, arm = calibrated
    found = assess(arm, task_of("length", [0, 1], poses(2, 5)), seed=1)
    (value,) = found.values
    assert value.monte_carlo is not None
    assert value.monte_carlo.settled
    assert value.first_order_is_good
    assert value.monte_carlo.u == pytest.approx(value.u, rel=0.02)
    low, high = value.monte_carlo.symmetric
    assert (high - low) / 2 == pytest.approx(value.expanded, rel=0.03)
    assert value.u**2 == pytest.approx(sum(u**2 for u in value.budget.values()))
    assert set(value.budget) == {"parameters", "encoders", "touch"}


def test_whole_calibrations_redrawn_say_the_same(calibrated) -> None:
    study, arm = calibrated
    task = task_of("length", [0, 1], poses(2, 6))
    by_covariance = assess(arm, task, seed=2).values[0].monte_carlo
    redrawn = assess(arm, task, study=study, seed=2, most_trials=20_000)
    assert redrawn.parameters_from == "recalibrations"
    again = redrawn.values[0].monte_carlo
    assert by_covariance is not None
    assert again is not None
    assert again.u == pytest.approx(by_covariance.u, rel=0.03)
    assert again.y == pytest.approx(by_covariance.y, abs=0.1 * by_covariance.u)


def test_a_seed_gives_one_answer(calibrated) -> None:
    _, arm = calibrated
    task = task_of("point", [0, 0], poses(2, 7))
    one, two, other = (assess(arm, task, seed=seed).as_dict() for seed in (3, 3, 4))
    assert one == two
    assert one != other
    assert json.loads(json.dumps(one)) == one


def test_a_short_length_is_not_normal(calibrated) -> None:
    """Ends nearer than their own scatter: a distance, far from normal. And no length at all has no direction."""
    _, arm = calibrated
    q_rad = np.repeat(poses(1, 8), 2, axis=0)
    with pytest.raises(ulna.UlnaInputError, match="A and B are in the same place"):
        assess(arm, task_of("length", [0, 1], q_rad))
    q_rad[1, 6] += 1e-4
    (value,) = assess(arm, task_of("length", [0, 1], q_rad), seed=1).values
    assert value.first_order_is_good is False
    assert value.monte_carlo is not None
    assert value.monte_carlo.shortest[0] > 0.0


def test_before_trials_are_steady_nothing_is_said_of_the_first_order(calibrated) -> None:
    _, arm = calibrated
    (value,) = assess(arm, task_of("length", [0, 1], poses(2, 5), digits=2), most_trials=10_000).values
    assert value.monte_carlo is not None
    assert not value.monte_carlo.settled
    assert value.first_order_is_good is None


def test_repeated_calibrations_start_where_the_calibration_ended(calibrated) -> None:
    """Not at a drawing that a search had to leave: zero offsets up to 2 rad off."""
    study, arm = calibrated
    far = study.arm.parameters.copy()
    offsets = np.array([name.endswith("theta0") for name in study.arm.parameter_names])
    offsets[0] = False
    far[offsets] += np.random.default_rng(1).uniform(-2.0, 2.0, int(offsets.sum()))
    drawn = replace(study.with_arm(study.arm.with_parameters(far)), fit=FitOptions(start="search"))
    task = task_of("length", [0, 1], poses(2, 6))
    (redrawn,) = assess(arm, task, study=drawn, seed=2, most_trials=10_000).values
    assert redrawn.monte_carlo is not None
    assert redrawn.monte_carlo.y == pytest.approx(redrawn.value, abs=0.1 * (redrawn.u or 0.0))
    assert redrawn.monte_carlo.u == pytest.approx(redrawn.u, rel=0.05)


def test_an_estimated_noise_widens_the_interval(calibrated) -> None:
    """Ten degrees of freedom: Student's t by the first order, a multivariate t by trial."""
    _, arm = calibrated
    task = task_of("length", [0, 1], poses(2, 11), noise=ReadingNoise(degrees_of_freedom=10.0))
    (value,) = assess(arm, task, seed=1).values
    assert value.k == pytest.approx(2.2281, abs=1e-4)
    assert value.monte_carlo is not None
    low, high = value.monte_carlo.symmetric
    assert (high - low) / 2 == pytest.approx(value.expanded, rel=0.03)
    (stated,) = assess(arm, replace(task, noise=UNKNOWN), most_trials=0).values
    assert stated.k == pytest.approx(1.95996, abs=1e-5)


def test_degrees_of_freedom_come_from_a_result_without_stated_noise(tmp_path: Path, root: Path) -> None:
    folder = root / "examples" / "platinum"
    text = (folder / "study.toml").read_text()
    text = text.replace('"bars.csv"', f'"{folder / "bars.csv"}"').replace(
        "platinum.toml", f"{folder / 'platinum.toml'}"
    )
    (tmp_path / "silent.toml").write_text(text[: text.index("[noise]")] + text[text.index("[fit]") :])
    result = ulna.calibrate(ulna.Study.load(tmp_path / "silent.toml"))
    result.save(tmp_path / "out")
    (value,) = ulna.uncertainty(tmp_path / "out", folder / "length.toml", most_trials=0).values
    assert result.fit.degrees_of_freedom == 76
    assert value.k == pytest.approx(1.9917, abs=1e-4)  # t of 76


def test_the_study_must_be_that_of_the_result(result: Path, root: Path) -> None:
    folder = root / "examples" / "platinum"
    done = run("uncertainty", result, folder / "length.toml", "--study", folder / "seat.toml")
    assert_bad_input(done, "was not made from it")


def test_held_parameters_count_as_exact_and_are_told(calibrated) -> None:
    study, _ = calibrated
    held = ulna.calibrate(replace(study, fit=FitOptions(hold=["joint.3.a", "joint.1.theta0", "joint.1.d"])))
    found = assess(held.arm, task_of("length", [0, 1], poses(2, 12)), most_trials=0)
    (told,) = (text for text in found.left_out if "count as exact" in text)
    assert told.endswith(": joint.3.a")  # the base frame moves no length


@pytest.mark.long
@pytest.mark.slow
def test_intervals_hold_the_truth() -> None:
    """Virtual calibrations, each with a point, a length and a ball measured afterwards; benchmarks/coverage does it
    a thousand times."""
    from benchmarks.coverage.virtual import by_calibrations, by_covariance

    held: dict[str, list[bool]] = {}
    truth = true_arm(SEVEN)
    for seed in range(1, 151):
        by_covariance(truth, seed, 0, held)
    for seed in range(1, 26):
        by_calibrations(truth, seed, 200, held)
    for what, each in held.items():
        assert np.mean(each) == pytest.approx(0.95, abs=0.05), what


def straight() -> tuple[Arm, Arm]:
    """Calibrated with a straight probe, which leaves the last axis open; and the same with another probe on."""
    truth = true_arm(SEVEN, straight=True)
    truth = replace(truth, arm=replace(truth.arm, probes={"bent": Probe(0.0, 0.0, 238.5)}))
    study = trial.study_of(truth.arm, readings.bars(truth, 2))
    arm = ulna.calibrate(study).arm
    return arm, replace(arm, probes={"bent": Probe(60.0, 10.0, 150.0)}, uncertainty=arm.uncertainty)


def test_what_was_not_determined_has_no_figure() -> None:
    arm, other = straight()
    q_rad = poses(2, 9)
    (good,) = assess(arm, task_of("length", [0, 1], q_rad), most_trials=0).values
    assert good.u is not None
    (lost,) = assess(other, task_of("length", [0, 1], q_rad)).values
    assert (lost.u, lost.expanded, lost.monte_carlo, lost.budget) == (None, None, None, {})
    assert {direction["cause"] for direction in lost.not_determined} == {"probe-on-axis"}


@pytest.fixture(scope="module")
def result(tmp_path_factory, root) -> Path:
    out = tmp_path_factory.mktemp("demo") / "out"
    ulna.calibrate(ulna.Study.load(root / "examples" / "platinum" / "study.toml")).save(out)
    return out


def test_the_command(result: Path, root: Path, tmp_path: Path) -> None:
    task = root / "examples" / "platinum" / "length.toml"
    done = run("uncertainty", result / "result.json", task, "-o", tmp_path / "u")
    assert done.returncode == 0, done.stderr
    assert max(map(len, done.stdout.splitlines())) <= 80
    for words in ("the arm's parameters", "first order good", "Left out", "eccentric encoders"):
        assert words in done.stdout
    written = json.loads((tmp_path / "u" / "uncertainty.json").read_text("utf-8"))
    printed = strict_json(run("uncertainty", result, task, "--json").stdout)
    assert printed == written
    (value,) = written["values"]
    assert abs(value["value"] - 443.172) < 2 * value["expanded"]


def test_a_ball_from_a_file(result: Path, tmp_path: Path) -> None:
    truth = true_arm(SEVEN)
    rng = np.random.default_rng(3)
    direction = rng.standard_normal((25, 3))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    q_rad = truth.touch(np.array([400.0, 200.0, 300.0]) + 15.0 * direction, 1, rng)
    pl.DataFrame({f"q{k + 1}": np.rad2deg(q_rad[:, k]) for k in range(7)}).write_csv(tmp_path / "ball.csv")
    (tmp_path / "task.toml").write_text(
        'format = "ulna-task/1"\nkind = "ball"\nunits = { length = "mm", angle = "deg" }\np = 0.99\ndigits = 1\n'
        '[readings]\nfile = "ball.csv"\n[noise]\nencoder = 0.0003\nseat = 0.01\n'
    )
    done = run("uncertainty", result, tmp_path / "task.toml", "--json")
    assert done.returncode == 0, done.stderr
    found = strict_json(done.stdout)
    assert [value["name"] for value in found["values"]] == ["x", "y", "z", "diameter"]
    assert found["values"][3]["value"] == pytest.approx(24.0, abs=0.03)  # the probe's own 6 mm taken off
    assert found["values"][3]["k"] == pytest.approx(2.5758, abs=1e-4)


def touched_plane(seed: int, count: int = 12) -> np.ndarray:
    """(count, 7) encoder angles on a tilted plate of 200 mm square; its normal towards the base is (-2, -1, -2) / 3."""
    truth = true_arm(SEVEN)
    rng = np.random.default_rng(seed)
    along = np.array([[1.0, -2.0, 0.0], [4.0, 2.0, -5.0]])
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    at_mm = 450.0 * np.array([2.0, 1.0, 2.0]) / 3.0 + rng.uniform(-100, 100, (count, 2)) @ along
    return truth.touch(at_mm, seed, rng)


def test_a_plane_its_normal_and_its_form(calibrated) -> None:
    _, arm = calibrated
    q_rad = touched_plane(1)
    plane = assess(arm, task_of("plane", [0] * 12, q_rad), seed=1)
    assert [value.unit for value in plane.values] == ["1", "1", "1", "mm"]
    for value, really in zip(plane.values, (-2 / 3, -1 / 3, -2 / 3, 450.0), strict=True):
        assert value.expanded is not None
        assert abs(value.value - really) < 1.5 * value.expanded
        assert value.monte_carlo is not None
        assert value.monte_carlo.u == pytest.approx(value.u, rel=0.03)
    # a normal has length 1: along itself it cannot err
    normal = np.array([value.value for value in plane.values[:3]])
    assert normal @ plane.covariance[:3, :3] @ normal < 1e-6 * np.trace(plane.covariance[:3, :3])
    # a form is the larger the more it is disturbed: trials lie above the value, and first order does not know it
    (form,) = assess(arm, task_of("flatness", [0] * 12, q_rad), seed=1).values
    assert form.monte_carlo is not None
    assert form.monte_carlo.y > form.value + 0.3 * (form.u or 0.0)
    assert form.first_order_is_good is False


def test_form_of_a_ball(calibrated) -> None:
    _, arm = calibrated
    truth, rng = true_arm(SEVEN), np.random.default_rng(8)
    corners = np.concatenate([np.eye(3), -np.eye(3)])
    q_rad = truth.touch(np.array([400.0, 200.0, 300.0]) + 15.0 * corners, 2, rng)
    (form,) = assess(arm, task_of("sphericity", [0] * 6, q_rad), most_trials=0).values
    away = np.linalg.norm(arm.tip(q_rad) - MEASURANDS["ball"].of(arm.tip(q_rad)[None])[0, :3], axis=1)
    assert form.value == pytest.approx(np.ptp(away), abs=1e-9)


def test_touches_on_a_line_say_no_plane(calibrated) -> None:
    _, arm = calibrated
    truth, rng = true_arm(SEVEN), np.random.default_rng(9)
    line = np.array([400.0, 200.0, 300.0]) + np.outer(np.linspace(0, 100, 5), [1.0, 0.0, 0.0])
    q_rad = truth.touch(line, 3, rng)
    with pytest.raises(UlnaInputError, match="hardly say what is asked, a plane"):
        first_order(arm, task_of("plane", [0] * 5, q_rad))  # about the line it may turn as it likes
    with pytest.raises(UlnaInputError, match=r"hardly say|on a line"):
        first_order(arm, task_of("plane", [0] * 5, np.repeat(q_rad[:1], 5, axis=0)))


def test_wrong_tasks(result: Path, tmp_path: Path) -> None:
    q = poses(3, 1)
    frame = pl.DataFrame({f"q{k + 1}": q[:, k] for k in range(7)})
    frame.write_csv(tmp_path / "bare.csv")
    frame.with_columns(feature=pl.Series(["A", "A", "C"])).write_csv(tmp_path / "strange.csv")
    frame.with_columns(feature=pl.Series(["A", "A", "A"])).write_csv(tmp_path / "one.csv")

    def of(text: str) -> Path:
        head = 'format = "ulna-task/1"\nunits = { length = "mm", angle = "rad" }\n'
        (tmp_path / "task.toml").write_text(head + text)
        return tmp_path / "task.toml"

    def refused(text: str, *words: str) -> None:
        assert_bad_input(run("uncertainty", result, of(text), "-o", tmp_path / "none"), *words)
        assert not (tmp_path / "none").exists()

    refused('kind = "lenght"\n[readings]\nfile = "bare.csv"\n', "key 'kind'", "'lenght'")
    refused('kind = "length"\n[readings]\nfile = "bare.csv"\n', "no column 'feature'", "A, B")
    refused('kind = "length"\n[readings]\nfile = "strange.csv"\n', "got 'C'", "a length does not have")
    refused('kind = "length"\n[readings]\nfile = "one.csv"\n', "0 readings of feature 'B'", "needs 1")
    refused('kind = "ball"\n[readings]\nfile = "bare.csv"\n', "3 readings of feature 'ball'", "needs 4")
    refused('kind = "point"\ninside = true\n[readings]\nfile = "bare.csv"\n', "key 'inside'", "a point has no inside")
    refused('kind = "point"\np = 95\n[readings]\nfile = "bare.csv"\n', "key 'p'", "95")
    refused('kind = "point"\n[readings]\nfile = "bare.csv"\n[noise]\nseat = 0\n', "key 'noise.seat'")
    refused('kind = "point"\n[readings]\nfile = "none.csv"\n', "none.csv")
    pl.concat([frame] * 400).write_csv(tmp_path / "scan.csv")
    refused('kind = "ball"\n[readings]\nfile = "scan.csv"\n', "1200 readings", "at most 1000", "ulna measure")
    good = of('kind = "point"\n[readings]\nfile = "bare.csv"\n')
    assert run("uncertainty", result, good, "--trials", "0").returncode == 0
    assert_bad_input(run("uncertainty", result / "arm.toml", good), "arm.toml", "the result.json of a calibration")
    assert_bad_input(run("uncertainty", result, good, "--trials", "-1"), "--trials")


def test_options_of_the_fit_do_not_matter_to_the_type(calibrated) -> None:
    """A study with priors or held parameters gives a covariance with zeros; a draw from it stays where it is held."""
    study, arm = calibrated
    begun = study.with_arm(replace(arm, uncertainty=None))
    held = ulna.calibrate(replace(begun, fit=FitOptions(hold=["joint.3.*", "joint.1.theta0", "joint.1.d"])))
    (value,) = assess(held.arm, task_of("length", [0, 1], poses(2, 10)), seed=1).values
    assert value.monte_carlo is not None
    assert value.monte_carlo.u == pytest.approx(value.u, rel=0.02)


def test_the_fossil_loads() -> None:
    path = Path(__file__).parents[1] / "data" / "fossils" / "task-1.toml"
    document, _ = read_toml(path, "a task")
    file = fill(TaskFile, document, path)
    assert file.model_fields_set == set(TaskFile.model_fields)
    assert file.readings.model_fields_set >= {"file", "angle", "probe", "feature", "separator", "decimal", "header"}
    assert (file.kind, file.inside, file.p, file.digits) == ("ball", True, 0.99, 1)
    assert file.temperature is not None
    assert file.temperature.u == 0.5
