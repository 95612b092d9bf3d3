"""A plan read again: simulated as it says, and what was measured beside it."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.cli_runs import assert_bad_input, run
from tests.planning.test_plan import BAR, BORE, FIXED, PLANE, PLATE, SEAT, SPHERE, WIRE, limited, spec

import ulna
from ulna.artefacts.artefact import Artefact
from ulna.ground.errors import UlnaInputError
from ulna.planning.checking import check_study
from ulna.planning.planned import Planned, load_planned
from ulna.planning.trying import simulation_of


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("room") / "planned"
    ulna.plan(limited(), spec(choose=40, placements=8)).save(out)
    return out


@pytest.fixture(scope="module")
def tried(folder: Path) -> Path:
    out = folder.parent / "tried"
    ulna.simulate(simulation_of(load_planned(folder), seed=3)).save(out)
    return out


@pytest.mark.parametrize(
    ("artefact", "touches"),
    [
        (BAR, 1),
        (BAR, 2),
        (SEAT, 3),
        (replace(PLATE, u_mm=0.002), 1),
        (FIXED, 1),
        (SPHERE, 9),
        (PLANE, 7),
        (BORE, 12),
        (WIRE, 9),
    ],
)
def test_readings_are_where_the_plan_has_them(tmp_path: Path, artefact: Artefact, touches: int) -> None:
    """Tips of the readings, by the true arm and without noise, are the planned points."""
    planned = ulna.plan(limited(), spec(artefact, touches=touches, choose=30, candidates=1000))
    planned.save(tmp_path / "planned")
    again = load_planned(tmp_path / "planned")
    assert again.spec.artefact.features == artefact.features
    assert again.q_rad == pytest.approx(planned.q_rad, abs=1e-6)
    quiet = replace(simulation_of(again), encoder_rad=None, seat_mm=0.0)
    quiet = replace(
        quiet, touching=[replace(each, artefact=replace(each.artefact, u_mm=0.0)) for each in quiet.touching]
    )
    found = ulna.simulate(quiet)
    (group,) = found.study.readings
    tips = limited().tip(group.q_rad)
    points = np.repeat(again.points_mm, again.q_rad.shape[2], axis=1).reshape(-1, 3)
    assert tips == pytest.approx(points, abs=1e-6)
    # and the posture is the planned one, not any
    assert group.q_rad == pytest.approx(again.q_rad.reshape(-1, 7), abs=1e-4)
    assert group.placement[0] == "1"
    assert len(set(group.placement)) == 30


@pytest.mark.slow
def test_what_a_plan_promises_is_what_calibrations_of_it_show(folder: Path) -> None:
    """The promised u(length) against the scatter of lengths by arms calibrated on readings simulated from the plan."""
    planned = load_planned(folder)
    rng = np.random.default_rng(5)
    poses = rng.uniform(*np.array([joint.limits_rad for joint in planned.arm.joints]).T, (20000, 7))
    tips = planned.arm.tip(poses)
    a = rng.integers(0, 20000, 400_000)
    b = rng.integers(0, 20000, 400_000)
    near = np.abs(np.linalg.norm(tips[a] - tips[b], axis=1) - 443.172) < 2.0
    a, b = a[near][:600], b[near][:600]
    true = np.linalg.norm(tips[a] - tips[b], axis=1)
    squares = []
    for seed in range(40):
        study = ulna.simulate(simulation_of(planned, seed=seed)).study
        result = ulna.calibrate(study)
        assert result.fit.converged
        found = result.arm.tip(poses)
        squares.append(np.mean((np.linalg.norm(found[a] - found[b], axis=1) - true) ** 2))
    assert np.sqrt(np.mean(squares)) == pytest.approx(planned.u_length_mm, rel=0.15)


def test_all_measured_as_planned_tells_what_was_promised(folder: Path, tried: Path) -> None:
    found = check_study(load_planned(folder), ulna.Study.load(tried / "study.toml"))
    assert found.missing == []
    assert found.other == []
    assert found.far == []
    assert found.touches == 80
    assert found.determined == found.to_determine == 25
    assert found.u_length_mm == pytest.approx(found.promised_u_length_mm, rel=1e-3)
    assert found.promised_u_length_mm == pytest.approx(load_planned(folder).u_length_mm, rel=0.1)
    assert found.worse == []


def study_of(tried: Path, to: Path, frame: pl.DataFrame) -> Path:
    to.mkdir()
    for name in ("arm.toml", "study.toml"):
        (to / name).write_text((tried / name).read_text())
    frame.write_csv(to / "bar.csv")
    return to / "study.toml"


@pytest.mark.filterwarnings("ignore::ulna.InputWarning")  # a whole turn more is beyond a limit
def test_what_is_missing_far_and_besides_is_named(folder: Path, tried: Path, tmp_path: Path) -> None:
    frame = pl.read_csv(tried / "bar.csv")
    frame = frame.filter(~pl.col("placement").is_in([3, 4, 20]))
    other = frame.filter(pl.col("placement") == 1).with_columns(placement=pl.lit(99))
    frame = pl.concat([frame, other.cast(frame.schema)])
    row = int(np.flatnonzero((frame["placement"] == 7).to_numpy() & (frame["feature"] == "B").to_numpy())[0])
    q1 = frame["q1"].to_numpy().copy()
    q1[row] += 0.7
    whole_turn = int(np.flatnonzero((frame["placement"] == 8).to_numpy())[0])
    q7 = frame["q7"].to_numpy().copy()
    q7[whole_turn] += 2.0 * np.pi
    frame = frame.with_columns(q1=q1, q7=q7)
    study = study_of(tried, tmp_path / "less", frame)
    planned = load_planned(folder)
    found = check_study(planned, ulna.Study.load(study))
    assert found.missing == [3, 4, 20]
    assert found.other == ["99"]
    (far,) = found.far
    assert (far.placement, far.feature, far.joint, far.row) == ("7", "B", 1, row + 1)
    assert far.off_deg == pytest.approx(np.degrees(0.7), abs=0.1)
    tips = planned.arm.tip(frame.select([f"q{k}" for k in range(1, 8)]).to_numpy()[row])
    assert far.off_mm == pytest.approx(np.linalg.norm(tips - planned.points_mm[6, 1]), abs=0.01)
    done = run("plan", folder, "--check", study)
    row_of = next(line.split() for line in done.stdout.splitlines() if line.startswith("7 "))
    assert row_of == ["7", "B", str(row + 1), f"{far.off_mm:.0f}", f"{far.off_deg:.0f}", "1"]
    # less tells less, never more
    assert found.u_length_mm is not None
    assert found.u_length_mm > found.promised_u_length_mm


def test_too_few_readings_leave_open_what_the_plan_determines(folder: Path, tried: Path, tmp_path: Path) -> None:
    frame = pl.read_csv(tried / "bar.csv").filter(pl.col("placement") <= 12)
    study = study_of(tried, tmp_path / "few", frame)
    found = check_study(load_planned(folder), ulna.Study.load(study))
    assert found.u_length_mm is None
    assert found.determined == 12
    assert found.missing == list(range(13, 41))
    done = run("plan", folder, "--check", study)
    assert done.returncode == 1, done.stderr
    assert "placements 13–40" in done.stdout
    assert max(len(line.rstrip()) for line in done.stdout.splitlines()) <= 80


def test_uncertainties_of_the_check_are_those_of_the_fit(folder: Path, tried: Path, tmp_path: Path) -> None:
    """Of a parameter that is known worse: both figures against the covariance of calibrations of the readings."""
    frame = pl.read_csv(tried / "bar.csv").filter(pl.col("placement") <= 28)
    study = ulna.Study.load(study_of(tried, tmp_path / "part", frame))
    found = check_study(load_planned(folder), study)
    assert found.worse
    few, full = (ulna.calibrate(each) for each in (study, ulna.Study.load(tried / "study.toml")))
    u = [{each.name: each.u for each in result.parameters} for result in (few, full)]
    worst = found.worse[0]
    assert worst.now == pytest.approx(u[0][worst.name], rel=0.1)
    assert worst.promised == pytest.approx(u[1][worst.name], rel=0.1)


def test_the_commands_go_from_plan_to_readings_to_check(folder: Path, tmp_path: Path) -> None:
    done = run("simulate", "--plan", folder, "-o", tmp_path / "tried", "--seed", "4")
    assert done.returncode == 0, done.stderr
    done = run("plan", folder, "--check", tmp_path / "tried" / "study.toml", "--json")
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["missing"] == []
    # the study that waits in the plan's folder takes the readings as they are
    waiting = tmp_path / "waiting"
    waiting.mkdir()
    for name in ("arm.toml", "study.toml"):
        (waiting / name).write_text((folder / name).read_text())
    (waiting / "bar.csv").write_text((tmp_path / "tried" / "bar.csv").read_text())
    study = ulna.Study.load(waiting / "study.toml")
    assert len(study.readings[0]) == 80
    assert study.noise is not None
    assert study.noise.seat_mm == 0.008


def test_a_simulation_file_says_the_truth_and_the_plan_the_places(folder: Path, tmp_path: Path) -> None:
    truth = limited()
    x = truth.parameters.copy()
    x[truth.parameter_names.index("joint.3.d")] += 0.5
    truth.with_parameters(x).save(tmp_path / "true.toml")
    text = (
        'format = "ulna-simulation/1"\narm = "true.toml"\nunits = { length = "mm", angle = "rad" }\ndrawing = "exact"\n'
    )
    text += '[artefact.bar]\nkind = "bar"\nlength = 443.172\n'
    (tmp_path / "spec.toml").write_text(text)
    done = run("simulate", tmp_path / "spec.toml", "--plan", folder, "-o", tmp_path / "tried")
    assert done.returncode == 0, done.stderr
    planned: Planned = load_planned(folder)
    group = ulna.Study.load(tmp_path / "tried" / "study.toml").readings[0]
    tips = truth.with_parameters(x).tip(group.q_rad).reshape(-1, 2, 3)
    assert tips == pytest.approx(planned.points_mm, abs=1e-6)
    assert np.abs(group.q_rad - planned.q_rad.reshape(-1, 7)).max() < 0.05
    (tmp_path / "spec.toml").write_text(text.replace("artefact.bar", "artefact.rod"))
    assert_bad_input(run("simulate", tmp_path / "spec.toml", "--plan", folder), "artefact 'bar'", "'rod'")


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["plan"], "got 0 files; expected ARM SPEC"),
        (["plan", "{arm}", "--check", "{study}"], "plan.json"),
        (["plan", "{folder}", "{arm}", "--check", "{study}"], "Name it alone"),
        (["plan", "{folder}", "--check", "{study}", "--make-plan", "x.toml"], "got both"),
        (["plan", "{arm}", "{arm}", "--study", "{study}"], "expected --make-plan as well"),
        (["simulate"], "no file was named"),
    ],
)
def test_what_does_not_go_together_is_told(folder: Path, tried: Path, arguments: list[str], says: str) -> None:
    values = {"arm": folder / "arm.toml", "study": tried / "study.toml", "folder": folder}
    assert_bad_input(run(*(each.format(**values) for each in arguments)), says)


def test_placements_by_other_names_are_told(folder: Path, tried: Path, tmp_path: Path) -> None:
    frame = pl.read_csv(tried / "bar.csv").with_columns(placement="left " + pl.col("placement").cast(pl.String))
    study = ulna.Study.load(study_of(tried, tmp_path / "named", frame))
    with pytest.raises(UlnaInputError, match="expected the numbers of the plan's column placement, 1 to 40"):
        check_study(load_planned(folder), study)
    with pytest.raises(UlnaInputError, match="has no readings of artefact 'bar'"):
        check_study(load_planned(folder), replace(study, readings=[]))
