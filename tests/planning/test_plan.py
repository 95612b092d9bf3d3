"""Plans: rows agree with the core's fit, choices with closed forms, gains with simulation."""

from __future__ import annotations

import dataclasses
import json
import re
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.cli_runs import platinum, run

import ulna
from ulna import Artefact, InputWarning, PlanSpec, UlnaInputError, _core
from ulna.artefacts.dimension import Dimension
from ulna.artefacts.distance import Instrument
from ulna.artefacts.readings import Readings
from ulna.planning.candidates import draw
from ulna.planning.information import Coordinates, candidate_rows, observability, taken_rows
from ulna.planning.measurements import problem_of
from ulna.planning.order import nearest_first
from ulna.planning.refusals import free_parameters
from ulna.simulation.mover import Mover
from ulna.study.data import Noise
from ulna.study.study import Study

BAR = Artefact("bar", "bar", {"A": (0.0, 0.0, 0.0), "B": (443.172, 0.0, 0.0)}, 443.172)
SEAT = Artefact("cone", "seat", {"seat": (0.0, 0.0, 0.0)})
PLATE = Artefact("plate", "points", {"a": (0.0, 0.0, 0.0), "b": (200.0, 0.0, 0.0), "c": (50.0, 150.0, 0.0)})
FIXED = replace(PLATE, features={"a": (500.0, 100.0, 300.0), "b": (300.0, -350.0, 500.0)}, frame="arm")


SPHERE = Artefact("ball", "sphere", {}, diameter_mm=30.0)
HOLLOW = replace(SPHERE, inside=True)
PLANE = Artefact("flat", "plane", {})
WIRE = Artefact("wire", "distance", {}, own=Instrument(Dimension("offset", 12.0, 0.0, False)))
BORE = Artefact("bore", "cylinder", {}, diameter_mm=40.0, inside=True)


def limited() -> ulna.Arm:
    arm = platinum()
    arm = replace(arm, probes={name: replace(probe, ball_mm=6.0) for name, probe in arm.probes.items()})
    joints = []
    for k, joint in enumerate(arm.joints):
        limits = (joint.theta0_rad - 0.3, joint.theta0_rad + 2.7) if k in (1, 3, 5) else (-np.pi, np.pi)
        joints.append(replace(joint, limits_rad=limits))
    return replace(arm, joints=tuple(joints))


def spec(artefact: Artefact = BAR, **others: object) -> PlanSpec:
    usual = PlanSpec(artefact, np.full(7, 5e-6), 0.008, candidates=2000, choose=60, trials=0)
    return dataclasses.replace(usual, **others)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("artefact", "touches", "rows"),
    [
        (BAR, 1, 1),
        (BAR, 3, 13),
        (SEAT, 4, 9),
        (PLATE, 1, 3),
        (FIXED, 1, 6),
        (SPHERE, 9, 6),
        (HOLLOW, 9, 6),
        (PLANE, 7, 4),
        (BORE, 12, 8),
        (WIRE, 9, 6),
    ],
)
def test_the_rows_of_measurements_say_what_the_fit_says_of_them(artefact: Artefact, touches: int, rows: int) -> None:
    arm, asked = limited(), spec(artefact, touches=touches, candidates=400)
    free = free_parameters(arm, asked)
    mover = Mover(arm, np.array([joint.limits_rad for joint in arm.joints]))
    taken = draw(asked, mover, 0, np.random.default_rng(1)).select(np.arange(0, 400, 4))
    found = candidate_rows(asked, arm, 0, free, taken)
    assert found.shape == (100, rows, 27)
    problem = problem_of(arm, asked, 0, taken.poses(np.arange(len(taken))))
    fitted = _core.fit(problem, np.zeros(27, dtype=bool))
    natural = np.where(np.array(arm.parameter_units) == "mm", 1.0, 1400.0)
    coordinates = Coordinates.of(found.reshape(-1, 27), natural)
    assert coordinates.rank == fitted.identifiability.determined
    y = found.reshape(-1, 27) @ coordinates.to_free
    covariance = coordinates.to_free @ np.linalg.inv(y.T @ y) @ coordinates.to_free.T
    # the fit's lost directions stay at their values in another norm: what is determined without them is the same
    steady = [k for k, name in enumerate(fitted.names) if name not in fitted.identifiability.not_determined]
    assert len(steady) >= 10
    own = np.sqrt(np.diag(covariance))[steady]
    assert own == pytest.approx(np.sqrt(np.diag(fitted.covariance))[steady], rel=1e-5)


@pytest.mark.parametrize(("artefact", "touches"), [(BAR, 1), (BAR, 3), (SEAT, 4), (PLATE, 1), (PLATE, 2), (FIXED, 2)])
def test_each_measurement_tells_what_its_placement_leaves(artefact: Artefact, touches: int) -> None:
    """Measurement by measurement: W J less its projection on the columns of shifts and turns."""
    arm, asked = limited(), spec(artefact, touches=touches, candidates=400)
    free = np.arange(5, 27)
    mover = Mover(arm, np.array([joint.limits_rad for joint in arm.joints]))
    taken = draw(asked, mover, 0, np.random.default_rng(3)).select(np.arange(0, 400, 20))
    poses = taken.poses(np.arange(len(taken)))
    found = candidate_rows(asked, arm, 0, free, taken)
    for q_rad, rows in zip(poses.reshape(len(taken), -1, 7), found, strict=True):
        by_encoder = arm.core.encoder_jacobian(np.ascontiguousarray(q_rad), 0) * 5e-6
        w = np.linalg.inv(np.linalg.cholesky(by_encoder @ by_encoder.transpose(0, 2, 1) + 0.008**2 * np.eye(3)))
        wj = (w @ arm.core.jacobian(np.ascontiguousarray(q_rad), 0)[:, :, free]).reshape(-1, len(free))
        at_mm = arm.tip(q_rad) - arm.tip(q_rad).mean(axis=0)
        turns = np.stack([np.cross(axis, at_mm) for axis in np.eye(3)], axis=2)
        own = (w @ np.concatenate([np.broadcast_to(np.eye(3), turns.shape), turns / 100.0], axis=2)).reshape(-1, 6)
        left = wj if artefact.frame == "arm" else wj - own @ np.linalg.pinv(own, rcond=1e-8) @ wj
        expected = left.T @ left
        # where encoders have noise the core adds a millionth to a touch's variance
        scale = np.sqrt(np.outer(np.diag(wj.T @ wj), np.diag(wj.T @ wj)))
        assert (np.abs(rows.T @ rows - expected) < 1e-5 * scale + 1e-12).all()


def test_readings_that_were_taken_count_as_the_candidates_they_are() -> None:
    arm = limited()
    for artefact, touches in ((BAR, 1), (BAR, 2), (SEAT, 4), (PLATE, 1)):
        asked = spec(artefact, touches=touches, candidates=200)
        free = free_parameters(arm, asked)
        mover = Mover(arm, np.array([joint.limits_rad for joint in arm.joints]))
        chosen = draw(asked, mover, 0, np.random.default_rng(2)).select(np.arange(0, 200, 5))
        poses = chosen.poses(np.arange(len(chosen)))
        count, features, each, n = poses.shape
        total = count * features * each
        readings = Readings(
            artefact,
            poses.reshape(-1, n),
            None,
            None,
            np.zeros(total, np.int64),
            np.tile(np.repeat(np.arange(features), each), count),
            np.repeat(np.arange(count).astype(str), features * each).astype(object),
            np.arange(total),
            np.zeros(total, np.int64),
        )
        study = Study(None, arm, [readings], noise=Noise(np.full(7, 5e-6), 0.008))
        rows, own = taken_rows(asked, study, arm, free), candidate_rows(asked, arm, 0, free, chosen).reshape(-1, 27)
        expected = own.T @ own
        assert np.abs(rows.T @ rows - expected).max() < 1e-7 * np.abs(expected).max()


def test_observability_indices_by_hand() -> None:
    # orthogonal columns of norms 6, 3, 2 over 4 rows; all columns of unit root mean square over the candidates
    rows = np.zeros((4, 3))
    rows[0, 0], rows[1, 1], rows[2, 2] = 6.0, 3.0, 2.0
    unit = np.concatenate([np.eye(3)] * 3) * np.sqrt(3.0)
    found = observability(rows, Coordinates.of(unit, np.ones(3)))
    assert found["O1"] == pytest.approx(36 ** (1 / 3) / 2)
    assert found["O2"] == pytest.approx(1 / 3)
    assert found["O3"] == pytest.approx(2.0)
    assert found["O4"] == pytest.approx(4 / 6)
    assert found["O5"] == pytest.approx(1.0)


def test_choosing_finds_the_known_optimum_of_a_parabola() -> None:
    x = np.repeat(np.linspace(-1.0, 1.0, 41), 5)
    rows = np.stack([np.ones_like(x), x, x**2], axis=1)[:, None]
    chosen, history, exchanges = _core.choose(np.ascontiguousarray(rows), 6, "volume")
    assert x[chosen].tolist() == [-1.0, -1.0, 0.0, 0.0, 1.0, 1.0]
    assert exchanges > 0
    assert (np.diff(history) <= 1e-12).all()
    with pytest.raises(_core.UlnaError, match="determine every unknown"):
        _core.choose(np.ascontiguousarray(rows), 2, "volume")
    with pytest.raises(_core.UlnaError, match="criterion"):
        _core.choose(np.ascontiguousarray(rows), 6, "best")


@pytest.mark.parametrize("criterion", ["D", "A", "E", "G", "length", "length-worst", "point"])
def test_each_criterion_does_best_what_it_is_for(criterion: str) -> None:
    arm = limited()
    found = ulna.plan(arm, spec(criterion=criterion, candidates=1500))
    assert found.planned.criterion < found.random.criterion
    assert found.determined == 25
    # what is weakest of the parameters is not what lengths need
    assert found.gain > (-0.3 if criterion in "AE" else 0.2)
    assert len(np.unique(np.column_stack([found.chosen.place, found.chosen.picked.reshape(60, -1)]), axis=0)) == 60


@pytest.mark.slow
def test_a_plan_beats_random_poses_by_thirty_per_cent_in_simulation() -> None:
    found = ulna.plan(limited(), spec(choose=60, candidates=20_000, trials=100))
    assert found.trial is not None
    assert found.trial.converged == 200
    assert found.trial.gain > 0.3
    # and the criterion says what the simulation shows
    assert found.trial.planned_mm == pytest.approx(found.planned.u_length_mm, rel=0.12)
    assert found.trial.random_mm == pytest.approx(found.random.u_length_mm, rel=0.2)


def test_a_start_is_completed_and_few_places_are_kept_to() -> None:
    arm = limited()
    first = ulna.plan(arm, spec(choose=40, placements=6, candidates=3000))
    assert len(np.unique(first.chosen.place)) <= 6
    assert (np.diff(first.chosen.place) != 0).sum() <= 5
    flat = first.q_rad.reshape(-1, 7)
    readings = Readings(
        BAR,
        flat,
        None,
        None,
        np.zeros(80, np.int64),
        np.tile([0, 1], 40),
        np.repeat(np.arange(40).astype(str), 2).astype(object),
        np.arange(80),
        np.zeros(80, np.int64),
    )
    taken = Study(None, arm, [readings], noise=Noise(np.full(7, 5e-6), 0.008))
    more = ulna.plan(arm, spec(choose=10, taken=taken, candidates=3000))
    assert len(more.chosen) == 10
    assert more.planned.u_length_mm < first.planned.u_length_mm
    assert more.planned.u_length_mm < more.random.u_length_mm


def test_the_same_seed_gives_the_same_plan_and_postures_touch_the_features() -> None:
    arm = limited()
    first, again = (ulna.plan(arm, spec(seed=3)) for _ in range(2))
    assert first.q_rad.tolist() == again.q_rad.tolist()
    assert ulna.plan(arm, spec(seed=4)).q_rad.tolist() != first.q_rad.tolist()
    tips = arm.tip(first.q_rad.reshape(-1, 7)).reshape(60, 2, 3)
    assert np.linalg.norm(tips[:, 1] - tips[:, 0], axis=1) == pytest.approx(np.full(60, 443.172), abs=1e-8)
    limits = np.array([joint.limits_rad for joint in arm.joints])
    assert (first.q_rad >= limits[:, 0]).all()
    assert (first.q_rad <= limits[:, 1]).all()


def test_nearest_first() -> None:
    assert nearest_first(np.array([[0.0], [5.0], [1.0], [3.0]])).tolist() == [0, 2, 3, 1]


SPEC = """format = "ulna-plan/1"
units = { length = "mm", angle = "rad" }
[artefact.bar]
kind = "bar"
length = 443.172
[noise]
encoder = 5e-6
seat = 0.008
[plan]
choose = 40
candidates = 1000
trials = 10
"""


def test_the_command_writes_a_list_to_follow(tmp_path: Path) -> None:
    limited().save(tmp_path / "arm.toml")
    (tmp_path / "plan.toml").write_text(SPEC)
    done = run("plan", str(tmp_path / "arm.toml"), str(tmp_path / "plan.toml"), "-o", str(tmp_path / "out"))
    assert done.returncode == 0, done.stderr
    assert max(len(line.rstrip()) for line in done.stdout.splitlines()) <= 80
    assert {"O1", "O2", "O3", "O4", "O5"} <= set(re.findall(r"^O\d", done.stdout, re.MULTILINE))
    steps = pl.read_csv(tmp_path / "out" / "plan.csv")
    assert len(steps) == 80
    q_rad = steps.select([f"q{k}" for k in range(1, 8)]).to_numpy()
    at_mm = steps.select("x", "y", "z").to_numpy()
    assert np.abs(limited().tip(q_rad) - at_mm).max() < 0.02
    assert steps["q3_deg"].to_numpy() == pytest.approx(np.degrees(steps["q3"].to_numpy()), abs=0.006)
    document = json.loads((tmp_path / "out" / "plan.json").read_text())
    assert document["format"] == "ulna-plan-result/1"
    assert document["planned"]["u_length_mm"] < document["random"]["u_length_mm"]
    assert (tmp_path / "out" / "places.png").stat().st_size > 5000
    again = run("plan", str(tmp_path / "arm.toml"), str(tmp_path / "plan.toml"), "-o", str(tmp_path / "out"))
    assert again.returncode == 2
    assert "--force" in again.stderr


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("choose = 40", "chose = 40", "unknown key 'plan.chose'"),
        ('kind = "bar"', 'kind = "plane"', "artefact.bar.length"),
        ("encoder = 5e-6", "encoder = [5e-6, 1e-6]", "expected one, or 7"),
        ("choose = 40", "choose = 40\nhold = ['joint.9.*']", "matches no parameter"),
        ("choose = 40", "choose = 20", "too few|determine every unknown"),
        ("choose = 40", "choose = 4000", "Raise candidates"),
        ("choose = 40", "choose = 18", "18 measurements give 18 equations, too few for the"),
        ("candidates = 1000", "candidates = 60", "60 candidates; expected 1000 or more"),
        ("choose = 40", "choose = 40\nplacements = 30", "30 placements, but 1000 candidates stand in 10 places"),
        ("choose = 40", "choose = 40\ntaken = 'none.toml'", "no such file"),
        ('kind = "bar"\nlength = 443.172', 'kind = "seat"', "Raise touches"),
        ("443.172", "9000.0", "Take a smaller one"),
        ("trials = 10", "criterion = 'F'", "plan.criterion"),
        ('kind = "bar"', 'kind = "length"', "unknown key|is a length"),
        ("443.172", "443.172\nfit = true\nu = 0.01", "has fit = true"),
        ('kind = "bar"\nlength = 443.172', 'kind = "sphere"\ndiameter = 30', "whose ball has no diameter"),
        ('kind = "bar"\nlength = 443.172\n', 'kind = "plane"\n', "tell nothing"),
        ("choose = 40\ncandidates = 1000", "choose = 40\ncandidates = 900000\ntouches = 50", "Lower candidates"),
    ],
)
def test_what_cannot_be_planned_is_told(tmp_path: Path, old: str, new: str, says: str) -> None:
    from ulna.planning.file import load_plan_spec

    text, arm = SPEC.replace(old, new), limited()
    if "no diameter" in says:
        arm = replace(arm, probes={name: replace(probe, ball_mm=None) for name, probe in arm.probes.items()})
    if "tell nothing" in says:
        text = text.replace("[plan]", "[plan]\ntouches = 3")
    if "Lower" in says:
        text = text.replace('kind = "bar"\nlength = 443.172\n', 'kind = "plane"\n')
    (tmp_path / "plan.toml").write_text(text)
    with pytest.raises(UlnaInputError, match=says):
        ulna.plan(arm, load_plan_spec(tmp_path / "plan.toml", arm))


def test_a_surface_is_planned_too(tmp_path: Path) -> None:
    """The normals in the list are those of the surface, and what was chosen is better than chance by simulation."""
    asked = spec(PLANE, touches=9, candidates=2000, choose=20, trials=60)
    planned = ulna.plan(limited(), asked)
    assert planned.trial is not None
    assert planned.trial.gain > 0.1
    planned.save(tmp_path / "plane")
    steps = pl.read_csv(tmp_path / "plane" / "plan.csv")
    assert len(steps) == 180
    for one in steps.partition_by("placement"):
        at_mm = one.select("x", "y", "z").to_numpy()
        normal = np.linalg.svd(at_mm - at_mm.mean(axis=0))[2][2]
        outward = one.select("direction_x", "direction_y", "direction_z").to_numpy()
        assert np.abs(np.abs(outward @ normal) - 1.0).max() < 1e-3
    ball = ulna.plan(limited(), spec(SPHERE, touches=9, candidates=2000, choose=20))
    ball.save(tmp_path / "ball")
    steps = pl.read_csv(tmp_path / "ball" / "plan.csv")
    outward = steps.select("direction_x", "direction_y", "direction_z").to_numpy()
    centres = steps.select("x", "y", "z").to_numpy() - 18.0 * outward  # 30 mm, and a ball of 6 mm
    for _, one in steps.with_row_index().group_by("placement"):
        assert np.ptp(centres[one["index"].to_numpy()], axis=0).max() < 0.02


def test_an_arm_without_limits_is_refused() -> None:
    with pytest.raises(UlnaInputError, match="joint 1 of arm 'virtual Platinum' has no limits"):
        ulna.plan(platinum(), spec())


def test_a_file_of_format_1_arrives() -> None:
    from ulna.planning.file import load_plan_spec

    fossils = Path(__file__).parents[1] / "data" / "fossils"
    arm = ulna.Arm.load(fossils / "arm-1.toml")
    arm = replace(arm, joints=tuple(replace(joint, limits_rad=None) for joint in arm.joints))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        found = load_plan_spec(fossils / "plan-1.toml", arm)
    assert found.artefact.length_mm == pytest.approx(444.5)
    assert found.artefact.u_mm == pytest.approx(0.00254)
    assert found.encoder_rad == pytest.approx(np.radians([0.001, 0.002, 0.001, 0.001]))
    assert found.seat_mm == pytest.approx(0.01016)
    assert (found.choose, found.touches, found.placements, found.candidates) == (50, 2, 12, 5000)
    assert (found.criterion, found.hold, found.probe, found.trials, found.seed) == (
        "length-worst",
        ["joint.1.*"],
        "bent",
        100,
        7,
    )
    assert found.taken is not None
    assert found.taken.arm.n == 4
    assert found.test_mm == pytest.approx(508.0)
    assert found.travel_rad is not None
    assert found.travel_rad == pytest.approx(np.radians([[-100.0, 100.0]] * 4))
    assert found.volume_mm is not None
    assert found.volume_mm[0] == pytest.approx((-254.0, -254.0, 0.0))
    assert found.room_mm is not None
    assert found.room_mm[1] == pytest.approx((508.0, 508.0, 635.0))
