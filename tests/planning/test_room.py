"""Where a person can put an artefact, the stands of a plan, and the words for how the arm is held."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.planning.test_plan import BAR, SPEC, limited, spec

import ulna
from ulna.arm.frames.bodies import bodies
from ulna.ground.errors import UlnaInputError
from ulna.planning.file import load_plan_spec
from ulna.planning.plots import places_of_numbers, rows_of
from ulna.planning.stands import SIDES, Stand, elbow_sides, probe_from, runs
from ulna.planning.within import Within, joints_mm


def stand(*points: tuple[float, float, float]) -> Stand:
    return Stand(1, np.array(points, dtype=float), np.array([1]))


def test_joints_are_where_the_bodies_are() -> None:
    arm = limited()
    q_rad = np.random.default_rng(1).uniform(-3, 3, (5, 7))
    for pose, found in zip(q_rad, joints_mm(arm, q_rad), strict=True):
        assert found == pytest.approx(np.array([t[:3, 3] for t in bodies(arm, pose)[1:]]), abs=1e-9)


@pytest.mark.parametrize("placements", [None, 6])
def test_a_plan_stays_above_the_table_in_reach_and_off_the_base(placements: int | None) -> None:
    within = Within(table_mm=50.0, low_mm=20.0, high_mm=600.0, aside_mm=200.0)
    arm = limited()
    found = ulna.plan(arm, spec(within=within, placements=placements, choose=40))
    points = np.array([each.points_mm for each in found.stands])
    assert points[..., 2].min() >= 70.0
    assert points[..., 2].max() <= 650.0
    # the bar's whole line, not only its ends, by the distance of a line from the axis
    a, b = points[:, 0, :2], points[:, 1, :2]
    share = np.clip(-(a * (b - a)).sum(1) / ((b - a) ** 2).sum(1), 0.0, 1.0)[:, None]
    assert np.linalg.norm(a + share * (b - a), axis=1).min() >= 199.0 - 443.172 / 8 / 8
    for pose in found.q_rad.reshape(-1, 7):
        assert min(t[2, 3] for t in bodies(arm, pose)[3:]) >= 50.0
    tips = arm.tip(found.q_rad.reshape(-1, 7)).reshape(-1, 2, 3)
    assert np.linalg.norm(tips[:, 1] - tips[:, 0], axis=1) == pytest.approx(np.full(40, 443.172), abs=1e-8)


def test_without_it_the_arm_reaches_below_the_table_and_overhead() -> None:
    found = ulna.plan(limited(), spec(within=None))
    z = np.concatenate([each.points_mm[:, 2] for each in found.stands])
    assert z.min() < 0.0
    assert z.max() > 1000.0


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", Within()),
        ('within = "reach"\n', None),
        ("[within]\ntable = -0.25\nhigh = 0.8\n", Within(table_mm=-250.0, high_mm=800.0)),
        ("[room]\nlow = [-1, -1, -1]\nhigh = [1, 1, 1]\n", None),
        ("[room]\nlow = [-1, -1, -1]\nhigh = [1, 1, 1]\n[within]\naside = 0.3\n", Within(aside_mm=300.0)),
    ],
)
def test_the_file_says_it_in_its_unit(tmp_path: Path, text: str, expected: Within | None) -> None:
    head, tables = SPEC.replace('length = "mm"', 'length = "m"').replace("443.172", "0.443172").split("[artefact", 1)
    word, table = (text, "") if text.startswith("within") else ("", text)
    (tmp_path / "plan.toml").write_text(f"{head}{word}[artefact{tables}{table}")
    assert load_plan_spec(tmp_path / "plan.toml", limited()).within == expected


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("[within]\nlow = 500\nhigh = 400\n", "low below high"),
        ("[within]\nfloor = 3\n", "unknown key 'within.floor'"),
        ("[within]\naside = -1\n", "within.aside"),
    ],
)
def test_what_nobody_can_reach_is_told(tmp_path: Path, text: str, says: str) -> None:
    (tmp_path / "plan.toml").write_text(SPEC + text)
    with pytest.raises(UlnaInputError, match=says):
        load_plan_spec(tmp_path / "plan.toml", limited())


def test_a_room_without_a_place_says_what_to_do() -> None:
    with pytest.raises(UlnaInputError, match="Take a smaller one, a larger box"):
        ulna.plan(limited(), spec(within=Within(low_mm=2000.0, high_mm=2100.0)))


def test_how_a_bar_lies() -> None:
    assert stand((0, 0, 0), (10, 0, 0)).lies == "level"
    assert stand((0, 0, 0), (10, 10, 5)).lies == "rising"
    assert stand((0, 0, 0), (10, 10, -5)).lies == "falling"
    assert stand((0, 0, 0), (0, 1, 50)).lies == "upright"
    assert stand((0, 0, 0), (0, 1, -50)).lies == "hanging"
    assert stand((3, 4, 5)).lies == "nowhere"
    assert stand((0, 0, 0), (0, -3, 0)).azimuth_deg == pytest.approx(270.0)
    assert stand((0, 0, 0), (3, 0, 3)).slope_deg == pytest.approx(45.0)
    assert runs([1, 2, 3, 7, 9, 10]) == "1–3, 7, 9–10"


def test_words_for_elbow_and_probe_turn_with_the_arm_and_mirror_with_it() -> None:
    """A turn about the base's axis changes no word, for they are those of somebody who stands behind the base."""
    arm = limited()
    q_rad = np.random.default_rng(2).uniform(-1.5, 1.5, (200, 7))
    tip_mm = arm.tip(q_rad)
    elbows, comes = elbow_sides(arm, q_rad, tip_mm), probe_from(arm, q_rad, tip_mm)
    assert set(elbows) <= {*SIDES, None}
    assert len(set(elbows)) == 8
    assert len(set(comes)) == 6
    turned = q_rad + np.eye(7)[0]
    assert elbow_sides(arm, turned, arm.tip(turned)) == elbows
    assert probe_from(arm, turned, arm.tip(turned)) == comes


def test_words_for_elbow_and_probe_by_hand() -> None:
    """A planar arm of four joints: shoulder at the origin, elbow up in the middle, tip level ahead."""
    joint = ulna.Joint
    arm = ulna.Arm(
        "planar",
        (joint(alpha_rad=np.pi / 2), joint(a_mm=500.0), joint(a_mm=500.0), joint()),
        {"p": ulna.Probe(100.0, 0.0, 0.0)},
    )
    up = np.array([[0.0, 1.0, -2.0, 1.0]])
    down = -up
    assert elbow_sides(arm, up, arm.tip(up)) == ["up"]
    assert elbow_sides(arm, down, arm.tip(down)) == ["down"]
    drop = np.array([[0.0, 1.0, -1.0, -np.pi / 2]])
    assert probe_from(arm, drop, arm.tip(drop)) == ["above"]
    assert probe_from(arm, up, arm.tip(up)) == ["near"]


def test_numbers_of_stands_can_be_read() -> None:
    """No two numbers of a picture are nearer than two letters, whatever the plan, and each is by its own line."""
    stands = ulna.plan(limited(), spec(choose=40)).stands
    groups = rows_of(stands)
    assert [each.number for group in groups for each in group] == [each.number for each in stands]
    assert max(map(len, groups)) <= 12
    for group in groups:
        points = [each.points_mm[:, :2] for each in group]
        found = np.array(places_of_numbers(points, 1500.0))
        apart = np.linalg.norm(found[:, None] - found[None], axis=2) + 1e9 * np.eye(len(found))
        assert apart.min() > 0.02 * 1500.0
        for at, (a, b) in zip(found, points, strict=True):
            share = np.clip((at - a) @ (b - a) / ((b - a) @ (b - a)), 0.0, 1.0)
            assert np.linalg.norm(at - a - share * (b - a)) <= 0.036 * 1500.0


def test_stands_are_those_of_the_list() -> None:
    found = ulna.plan(limited(), spec(choose=40, placements=5, artefact=replace(BAR, name="bar")))
    document = found.as_dict()
    of_steps = {(step["stand"], step["placement"]) for step in document["steps"]}
    assert of_steps == {(each["stand"], number) for each in document["places"] for number in each["placements"]}
    assert len(document["places"]) == document["stands"] <= 5
