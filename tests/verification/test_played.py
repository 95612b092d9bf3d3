"""A plan is made, played by a virtual arm and evaluated: the truth comes back, and a wrong arm is found out."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.cli_runs import platinum, run, strict_json

import ulna
from ulna.arm.arm import Arm
from ulna.arm.probe import Probe
from ulna.verification.player import play
from ulna.verification.profile import load_profile, shipped
from ulna.verification.steps import steps_of
from ulna.verification.test_plan import make_test_plan, play_test_plan

BENT = Probe.from_cylindrical(0.431148, 39.4321, 223.8773)
SMALL = (
    'format = "ulna-profile/1"\nname = "small"\nbased_on = "iso-10360-12"\n'
    "[test.uni]\nlengths = 2\npositions = 2\nrepeats = 2\n[test.bi]\nlengths = 2\npositions = 2\nrepeats = 1\n"
)


@pytest.fixture(scope="module")
def truth() -> Arm:
    return platinum({"bent": Probe(BENT.x_mm, BENT.y_mm, BENT.z_mm, ball_mm=6.0)})


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("profile") / "small.toml"
    path.write_text(SMALL, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def exact(truth: Arm, small: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Played without any noise."""
    folder = tmp_path_factory.mktemp("exact")
    truth.save(folder / "arm.toml")
    play_test_plan(str(small), truth, 0.0, 0.0, seed=3).save(folder / "plan")
    return folder


def test_a_true_arm_without_noise_finds_the_true_artefacts(exact: Path, truth: Arm, small: Path) -> None:
    """What remains is what the artefacts truly are off their certificates."""
    found = ulna.verify(exact / "plan" / "plan.toml", exact / "arm.toml")
    true_mm = play(load_profile(str(small), Path(), ""), truth, 0.0, 0.0, seed=3).truth
    by_key = {figure.definition.key: figure for figure in found.states[0].figures.values()}
    for single in (judged.single for figure in by_key.values() for judged in figure.values):
        if single.measured_mm is not None:
            assert single.measured_mm == pytest.approx(true_mm[single.labels.artefact], abs=1e-6)
    assert by_key["P_Form"].worst.single.value_mm < 1e-6
    assert by_key["L_Dia"].worst.single.value_mm < 1e-6
    assert found.verdict == "pass"
    assert [text for test in found.states[0].tests for text in test.departures] == []


def test_encoders_and_coordinates_say_the_same(exact: Path, truth: Arm) -> None:
    beside = exact / "coordinates"
    beside.mkdir()
    table = pl.read_csv(exact / "plan" / "touches.csv")
    angles = [f"q{k + 1}" for k in range(7)]
    p_mm = truth.tip(table.select(angles).to_numpy())
    table = table.drop(angles).with_columns(pl.Series(axis, p_mm[:, k]) for k, axis in enumerate("xyz"))
    table.write_csv(beside / "touches.csv")
    text = (exact / "plan" / "plan.toml").read_text(encoding="utf-8")
    (beside / "plan.toml").write_text(text.replace("\nrange =", "\nball = 6.0\nrange ="), encoding="utf-8")
    ours, theirs = ulna.verify(exact / "plan" / "plan.toml", exact / "arm.toml"), ulna.verify(beside / "plan.toml")
    for name, figure in ours.states[0].figures.items():
        other = theirs.states[0].figures[name]
        assert [each.single.value_mm for each in figure.values] == pytest.approx(
            [each.single.value_mm for each in other.values], abs=1e-9
        )


def test_a_wrong_arm_fails_as_found_and_the_right_one_passes_as_left(exact: Path, truth: Arm) -> None:
    """The same readings through two arms: a zero offset is 0.2 mrad off in one."""
    beside = exact / "states"
    beside.mkdir()
    wrong = truth.parameters.copy()
    wrong[truth.parameter_names.index("joint.3.theta0")] += 2e-4
    truth.with_parameters(wrong).save(beside / "found.toml")
    (beside / "touches.csv").write_bytes((exact / "plan" / "touches.csv").read_bytes())
    text = (exact / "plan" / "plan.toml").read_text(encoding="utf-8")
    text += '\n[[readings]]\nfile = "touches.csv"\nstate = "as-found"\narm = "found.toml"\n'
    (beside / "plan.toml").write_text(text, encoding="utf-8")
    done = run("verify", exact / "arm.toml", beside / "plan.toml", "--json")
    assert done.returncode == 0, "it is as it was left"
    assert "A value fails (as-found)" in done.stderr
    assert "The exit code is that of the arm as-left: pass." in done.stderr
    document = strict_json(done.stdout)
    assert [(state["state"], state["verdict"]) for state in document["states"]] == [
        ("as-found", "fail"),
        ("as-left", "pass"),
    ]
    assert len(document["provenance"]["arms"]) == 2
    # the other way round: what was made worse fails
    other = text.replace('"as-left"', '"as-FOUND"').replace('"as-found"', '"as-left"').replace("as-FOUND", "as-found")
    other = "\n".join(line.split("   # or")[0] for line in other.splitlines()) + "\n"
    (beside / "worse.toml").write_text(other)
    worse = run("verify", exact / "arm.toml", beside / "worse.toml")
    assert worse.returncode == 1
    assert "The exit code is that of the arm as-left: FAIL." in worse.stderr
    # only as found: that decides
    (beside / "only.toml").write_text(text.split("[[readings]]")[0] + "[[readings]]" + text.split("[[readings]]")[2])
    assert run("verify", exact / "arm.toml", beside / "only.toml").returncode == 1


@pytest.mark.parametrize("name", sorted(shipped()))
def test_a_plan_asks_for_what_the_profile_counts(name: str, tmp_path: Path) -> None:
    made = make_test_plan(name)
    expected = {
        "iso-10360-12": {"probing": 2 * 25, "articulation": 5 * 5, "uni": 5 * 7 * 3 * 2, "bi": 5 * 7 * 3 * 2 * 3},
        "asme-b89-4-22": {"diameter": 3 * 9, "single-point": 3 * 10, "volumetric": 20 * 2},
    }
    assert made.counts() == expected["asme-b89-4-22" if name.startswith("asme") else "iso-10360-12"]
    made.save(tmp_path)
    done = run("verify", tmp_path / "plan.toml")
    assert done.returncode == 2, "a plan that is not filled in says what is missing"
    assert "key 'artefact." in done.stderr
    assert "is missing. Add it." in done.stderr


def test_asme_is_played_and_evaluated(truth: Arm, tmp_path: Path) -> None:
    truth.save(tmp_path / "arm.toml")
    done = run(
        "verify", "--make-plan", "asme-b89-4-22", "--play", tmp_path / "arm.toml", "--seed", "4", "-o", tmp_path / "p"
    )
    assert done.returncode == 0, done.stderr
    assert "97 touches (diameter 27, single-point 30, volumetric 40)" in done.stdout
    found = ulna.verify(tmp_path / "p" / "plan.toml", tmp_path / "arm.toml")
    figures = {figure.definition.key: figure.worst.single.value_mm for figure in found.states[0].figures.values()}
    assert 0.005 < figures["SPAT_2S"] < 0.06
    assert figures["Volumetric_half_range"] <= abs(figures["Volumetric_max"]) + 1e-12
    assert figures["FARO_SPAT_x"] < figures["SPAT_2S"]
    assert [text for test in found.states[0].tests for text in test.departures] == []


def test_playing_is_repeatable_and_shows_noise(truth: Arm, small: Path) -> None:
    first, again = (play_test_plan(str(small), truth, seed=5).table for _ in range(2))
    assert first.equals(again)
    assert not first.equals(play_test_plan(str(small), truth, seed=6).table)


def test_seats_of_a_single_point_test_stand_where_the_standard_wants_them(truth: Arm) -> None:
    profile = load_profile("asme-b89-4-22", Path(), "")
    played = play(profile, truth, 0.0, 0.0, seed=7)
    reach_mm = 0.5 * (played.filled.range_mm or 0.0)
    steps = steps_of(profile.file)
    for place, low, high in (("middle", 0.4, 0.6), ("far", 0.79, 0.91)):
        rows = [k for k, step in enumerate(steps) if step.position == place]
        p_mm = truth.tip(played.q_rad[rows])
        assert np.ptp(p_mm, axis=0).max() < 1e-6
        assert low < np.linalg.norm(p_mm[0]) / reach_mm < high


def test_a_played_plan_is_json_when_asked(truth: Arm, small: Path, tmp_path: Path) -> None:
    truth.save(tmp_path / "arm.toml")
    done = run("verify", "--make-plan", small, "--play", tmp_path / "arm.toml", "-o", tmp_path / "p", "--json")
    assert json.loads(done.stdout)["touches"]["articulation"] == 25
    text = (tmp_path / "p" / "plan.toml").read_text(encoding="utf-8")
    assert 'profile = "../' in text, "from where the plan stands, so that both may move"
    assert run("verify", tmp_path / "arm.toml", tmp_path / "p" / "plan.toml").returncode == 0


def test_seats_at_the_wrong_distance_are_told(truth: Arm, tmp_path: Path) -> None:
    truth.save(tmp_path / "arm.toml")
    play_test_plan("asme-b89-4-22", truth, seed=4).save(tmp_path)
    (tmp_path / "own.toml").write_text(
        'format = "ulna-profile/1"\nname = "own"\nbased_on = "asme-b89-4-22"\n[test.single-point]\n'
        "shares = [[0.0, 0.2], [0.7, 0.75], [0.8, 1.2]]\n",
        encoding="utf-8",
    )
    text = (tmp_path / "plan.toml").read_text(encoding="utf-8").replace('"asme-b89-4-22"', '"own.toml"')
    (tmp_path / "plan.toml").write_text(text, encoding="utf-8")
    told = ulna.verify(tmp_path / "plan.toml", tmp_path / "arm.toml").states[0].tests[1].departures
    assert len(told) == 1
    assert told[0].startswith("seat position middle: ")
    assert told[0].endswith("the profile asks for 70 to 75 %.")


def test_seats_in_any_frame_are_not_taken_for_checked(truth: Arm, tmp_path: Path) -> None:
    made = play_test_plan("asme-b89-4-22", truth, seed=4)
    angles = [f"q{k + 1}" for k in range(7)]
    p_mm = truth.tip(made.table.select(angles).to_numpy())
    table = made.table.drop(angles).with_columns(pl.Series(axis, p_mm[:, k]) for k, axis in enumerate("xyz"))
    table.write_csv(tmp_path / "touches.csv")
    text = made.text(tmp_path).replace("\nrange =", "\nball = 6.0\nrange =")
    (tmp_path / "plan.toml").write_text(text, encoding="utf-8")
    told = ulna.verify(tmp_path / "plan.toml").states[0].tests[1].departures
    assert told == ["how far from the base the seats stood was not checked: coordinates may be in any frame."]
