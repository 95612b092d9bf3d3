"""A circle: its first order in closed form, trials, a hole and a shaft, how often its intervals hold the truth."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.cli_runs import assert_bad_input, run, strict_json

import ulna
from ulna.arm.arm import Arm
from ulna.arm.covariance import root_of
from ulna.arm.reading_noise import ReadingNoise
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.reproduce.ways import readings, trial
from ulna.reproduce.ways.arms import SEVEN, true_arm
from ulna.uncertainties.assess import assess
from ulna.uncertainties.first_order import first_order
from ulna.uncertainties.measurands import MEASURANDS, Touched
from ulna.uncertainties.task import UNSTATED_BALL, Task

ENCODER_RAD, SEAT_MM = np.full(7, 5e-6), 0.008
NORMAL = np.array([1.0, 2.0, -2.0]) / 3.0
ALONG = np.array([2.0, 1.0, 2.0]) / 3.0
CENTRE = np.array([400.0, 200.0, 300.0])
RADIUS_MM, COUNT = 15.0, 12


def ring(centre: F64 = CENTRE, radius_mm: float = RADIUS_MM, arc_rad: float = 2.0 * np.pi, count: int = COUNT) -> F64:
    """(count, 3) evenly around."""
    angle = np.arange(count) / count * arc_rad
    out = np.cos(angle)[:, None] * ALONG + np.sin(angle)[:, None] * np.cross(NORMAL, ALONG)
    return centre + radius_mm * out


@pytest.fixture(scope="module")
def arm() -> Arm:
    """The virtual Platinum from 140 lengths."""
    truth = true_arm(SEVEN)
    study = trial.study_of(trial.start_of(truth, 1), readings.lengths_alone(readings.ball_bar(truth, 1)))
    return ulna.calibrate(study).arm


def task_of(kind: str, at_mm: F64, **more: object) -> Task:
    truth = true_arm(SEVEN)
    feature = np.zeros(len(at_mm), dtype=int)
    if kind == "distance":
        feature[-1] = 1
    q_rad = truth.touch(at_mm, 1, np.random.default_rng(1))
    given = {"noise": ReadingNoise(ENCODER_RAD, SEAT_MM), "digits": 1} | more
    return Task(Touched(kind, feature), q_rad, "bent", "task", **given)  # type: ignore[arg-type]


def test_the_gradient_of_an_even_ring_has_a_closed_form() -> None:
    """Of N even touches: centre 2/N along its radius and 1/N along the normal, diameter 2/N, a tilt of 2/(N r)."""
    at_mm = ring()
    touched = Touched("circle", np.zeros(COUNT, dtype=int))
    out = (at_mm - CENTRE) / RADIUS_MM
    normal = touched.values(at_mm[None])[0, 4:]
    np.testing.assert_allclose(normal, -np.sign(NORMAL @ CENTRE) * NORMAL, atol=1e-12)  # towards the base
    gradient = touched.gradient(at_mm)
    centre = (2.0 * np.einsum("ni,nj->nij", out, out) + np.outer(normal, normal)) / COUNT
    np.testing.assert_allclose(gradient[:3], np.moveaxis(centre, 1, 0), atol=1e-7)
    np.testing.assert_allclose(gradient[3], 2.0 * out / COUNT, atol=1e-7)
    tilt = -2.0 * np.einsum("ni,j->nij", out, normal) / (COUNT * RADIUS_MM)
    np.testing.assert_allclose(gradient[4:], np.moveaxis(tilt, 1, 0), atol=1e-8)


def test_the_first_order_of_touches_and_of_parameters(arm: Arm) -> None:
    task = task_of("circle", ring())
    found = first_order(arm, task)
    # noise of the touches alone: 2 s / sqrt(N) of the diameter
    assert found.u_by_source(3)["touch"] == pytest.approx(2.0 * SEAT_MM / np.sqrt(COUNT), rel=1e-3)
    quarter = first_order(arm, task_of("circle", ring(arc_rad=0.5 * np.pi)))
    assert 9.0 < quarter.u_by_source(3)["touch"] / found.u_by_source(3)["touch"] < 12.0
    # parameters: the whole evaluated one step to each side, in place of Jacobians
    known = arm.uncertainty
    assert known is not None
    covariance = known.over(arm.parameter_names)
    step = 0.1 * np.sqrt(np.diag(covariance))
    values = []
    for sign in (1.0, -1.0):
        cores = [arm.core.with_parameters(arm.parameters + sign * each) for each in np.diag(step)]
        tips = np.array([core.tip(task.q_rad, arm.probe_index("bent")) for core in cores])
        values.append(task.touched.values(tips, arm.tip(task.q_rad, "bent")))
    moves = np.divide((values[0] - values[1]).T, 2.0 * step, out=np.zeros((7, len(step))), where=step > 0.0)
    np.testing.assert_allclose(moves @ covariance @ moves.T, found.by_source["parameters"], rtol=1e-3, atol=1e-12)


@pytest.mark.parametrize("kind", ["circle", "plane", "distance"])
@pytest.mark.parametrize("at", [CENTRE, 400.0 * ALONG])
def test_trials_agree_also_in_a_plane_through_the_base(arm: Arm, kind: str, at: F64) -> None:
    """There noise alone says on which side of it the origin is, and yet no normal turns over among the trials."""
    at_mm = ring(at, 60.0)
    if kind == "distance":
        at_mm = np.concatenate([at_mm, [at + 30.0 * NORMAL]])
    for value in assess(arm, task_of(kind, at_mm), seed=1).values:
        assert value.monte_carlo is not None
        assert value.monte_carlo.u == pytest.approx(value.u, rel=0.04)
        assert value.monte_carlo.y == pytest.approx(value.value, abs=0.1 * (value.u or 0.0))


def test_roundness_is_of_the_plane_alone(arm: Arm) -> None:
    """Three lobes of 0.2 mm each way, and touches 0.5 mm high or low."""
    out = (ring() - CENTRE) / RADIUS_MM
    lobes = np.where(np.arange(COUNT) % 2, 0.2, -0.2)
    height = np.array([0.5, 0.5, -0.5, -0.5] * 3)
    at_mm = ring() + lobes[:, None] * out + height[:, None] * NORMAL
    ((form,),) = MEASURANDS["roundness"].of(at_mm[None])
    assert form == pytest.approx(0.4, abs=0.01)
    (value,) = assess(arm, task_of("roundness", at_mm), most_trials=0).values
    assert value.value == pytest.approx(0.4, abs=0.06)
    with pytest.raises(UlnaInputError, match="3 readings of feature 'circle', but a roundness needs 4"):
        Touched("roundness", np.zeros(3, dtype=int)).check("task")


def test_intervals_of_circles_hold_the_truth(arm: Arm) -> None:
    """Arms drawn from the covariance touch holes somewhere, with noise of encoders and touches."""
    known = arm.uncertainty
    assert known is not None
    root = root_of(known.over(arm.parameter_names))
    truth, rng = true_arm(SEVEN), np.random.default_rng(5)
    held = []
    for _ in range(150):
        place = truth.places(ring(np.zeros(3)), 1, rng)[0]
        core = arm.core.with_parameters(arm.parameters + root @ rng.standard_normal(len(root)))
        q_rad = truth.touch(place, 1, rng)
        really = core.tip(q_rad, arm.probe_index("bent"))
        task = Task(
            Touched("circle", np.zeros(COUNT, dtype=int)),
            q_rad + ENCODER_RAD * rng.standard_normal(q_rad.shape),
            "bent",
            "task",
            ReadingNoise(ENCODER_RAD, SEAT_MM),
        )
        true = task.touched.values((really + SEAT_MM * rng.standard_normal(really.shape))[None])[0]
        # what is touched is the ring that the tips lay on but for their noise
        found = assess(arm, task, most_trials=0).values
        held.append(
            [abs(each.value - value) <= (each.expanded or 0.0) for each, value in zip(found, true, strict=True)]
        )
    share = np.mean(held, axis=0)
    assert share[:4] == pytest.approx(0.95, abs=0.055)
    assert np.mean(share) == pytest.approx(0.95, abs=0.025)


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory, root: Path) -> Path:
    out = tmp_path_factory.mktemp("demo") / "out"
    ulna.calibrate(ulna.Study.load(root / "examples" / "platinum" / "study.toml")).save(out)
    return out


@pytest.mark.parametrize(("inside", "rolled_mm"), [(False, 36.0), (True, 24.0)])
def test_a_shaft_and_a_hole_of_30_mm_from_a_file(result: Path, tmp_path: Path, inside: bool, rolled_mm: float) -> None:
    """The probe's ball of 6 mm rolls around the shaft on a circle of 36 mm, within the hole on one of 24 mm."""
    q_rad = true_arm(SEVEN).touch(ring(radius_mm=0.5 * rolled_mm), 1, np.random.default_rng(3))
    pl.DataFrame({f"q{k + 1}": np.rad2deg(q_rad[:, k]) for k in range(7)}).write_csv(tmp_path / "ring.csv")
    (tmp_path / "task.toml").write_text(
        f'format = "ulna-task/1"\nkind = "circle"\ninside = {str(inside).lower()}\n'
        'units = { length = "mm", angle = "deg" }\n[readings]\nfile = "ring.csv"\n'
    )
    done = run("uncertainty", result, tmp_path / "task.toml", "--json", "--trials", "0")
    assert done.returncode == 0, done.stderr
    found = strict_json(done.stdout)
    assert [value["name"] for value in found["values"]] == ["x", "y", "z", "diameter", "n_x", "n_y", "n_z"]
    diameter = found["values"][3]
    assert abs(diameter["value"] - 30.0) < 1.5 * diameter["expanded"] < 0.1
    assert any("taken off in that plane" in text for text in found["left_out"])
    assert UNSTATED_BALL not in found["left_out"]
    shown = run("uncertainty", result, tmp_path / "task.toml", "--trials", "0").stdout
    assert "diameter" in shown
    assert max(map(len, shown.splitlines())) <= 80


def test_a_ball_that_nobody_stated_is_told(arm: Arm) -> None:
    assert arm.probes["bent"].ball_mm is None
    for kind, told in (("circle", True), ("ball", True), ("roundness", False), ("plane", False)):
        at_mm = ring() + (20.0 * NORMAL * (np.arange(COUNT) % 3 == 0)[:, None] if kind == "ball" else 0.0)
        assert (UNSTATED_BALL in assess(arm, task_of(kind, at_mm), most_trials=0).left_out) == told
    probe = replace(arm.probes["bent"], ball_mm=6.0)
    known = replace(arm, probes={"bent": probe}, uncertainty=arm.uncertainty)
    outside, within = (
        assess(known, task_of("circle", ring(), inside=inside), most_trials=0).values[3] for inside in (False, True)
    )
    assert within.value - outside.value == pytest.approx(12.0, abs=1e-9)
    assert within.u == outside.u


def test_what_is_no_circle_is_refused(result: Path, arm: Arm, tmp_path: Path) -> None:
    line = CENTRE + np.outer(np.linspace(0.0, 40.0, 5), ALONG)
    with pytest.raises(UlnaInputError, match=r"hardly say what is asked, a circle|no circle is nearest|on a line"):
        first_order(arm, task_of("circle", line))
    q_rad = np.zeros((3, 7))
    pl.DataFrame({f"q{k + 1}": q_rad[:, k] for k in range(7)}).write_csv(tmp_path / "bare.csv")
    (tmp_path / "task.toml").write_text(
        'format = "ulna-task/1"\nkind = "roundness"\ninside = true\nunits = { length = "mm", angle = "rad" }\n'
        '[readings]\nfile = "bare.csv"\n'
    )
    done = run("uncertainty", result, tmp_path / "task.toml")
    assert_bad_input(done, "a roundness has no inside", 'kind = "ball" or "circle"')
