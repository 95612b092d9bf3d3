"""Which effects readings determine, what imitates what, and the words for it."""

from dataclasses import replace

import numpy as np
import pytest
from tests.oracle import fits
from tests.oracle.core import core_problem, nothing_held
from tests.oracle.effects import affected
from tests.oracle.observed import Lengths
from tests.oracle.published import table_2

import ulna._core as _core


def lengths(arm, rng, count=300, travel=np.pi, warmth=None, approaches=None):
    """Pairs of poses and the true distances, each pose with temperatures and approaches where there are any."""
    poses = [rng.uniform(-travel, travel, (count, arm.joints)) for _ in range(2)]
    if warmth is not None:
        poses = [np.hstack([q, warmth]) for q in poses]
    if approaches is not None:
        poses = [
            np.hstack([q[:, : arm.joints], np.zeros(q.shape), approach])
            for q, approach in zip(poses, approaches, strict=True)
        ]
    q, p = poses
    return Lengths(q, p, np.linalg.norm(arm.tip(q) - arm.tip(p), axis=1))


def sessions(rng, arm, count=300):
    """Two sessions, ten kelvins apart, the links not all alike."""
    return np.where(np.arange(count) < count // 2, 0.0, 10.0)[:, None] + rng.uniform(-1, 1, (count, arm.joints))


def one_temperature(rng, arm, count=300):
    return np.full((count, arm.joints), 4.0)


#: blocks, tip off the last axis, temperatures → determined, of how many
TABLE = [
    ("harmonics", 40.0, None, 53, 55),  # the base frame is lost
    # a straight probe's last axis is not seen: two of the geometry, and all that its encoder may do
    ("harmonics", 0.0, None, 47, 55),
    ("expansion", 40.0, sessions, 32, 34),
    ("expansion", 40.0, one_temperature, 25, 34),  # no link's growth can be told from its length
    ("compliance", 40.0, None, 33, 34),  # gravity that leans tells how the base is turned
    ("harmonics expansion compliance", 40.0, sessions, 68, 69),
]


@pytest.mark.parametrize("row", range(len(TABLE)))
def test_ranks_are_those_of_the_oracle(row):
    blocks, r_mm, temperatures, determined, parameters = TABLE[row]
    rng = np.random.default_rng(row)
    arm = affected(table_2(r_mm=r_mm), rng, blocks)
    warmth = None if temperatures is None else temperatures(rng, arm)
    groups = [lengths(arm, rng, warmth=warmth)]
    assert fits.rank_of(fits.reduced_jacobian(groups, arm)) == determined
    found = _core.identify(core_problem(arm, groups), nothing_held(arm))
    assert (found.determined, found.parameters) == (determined, parameters)
    assert len(found.lost) == parameters - determined


def causes(arm, groups):
    """Cause → the sets of parameters that take part."""
    found = _core.identify(core_problem(arm, groups), nothing_held(arm))
    told = {}
    for direction in found.lost:
        told.setdefault(direction["cause"], []).append(set(direction["combination"]))
    return told


def test_growth_at_one_temperature_is_told():
    rng = np.random.default_rng(1)
    arm = affected(table_2(r_mm=40.0), rng, "expansion")
    told = causes(arm, [lengths(arm, rng, warmth=one_temperature(rng, arm))])
    assert set(told) == {"base-frame", "temperature-still"}
    assert {f"joint.{k}.expansion" for k in range(1, 8)} <= set().union(*told["temperature-still"])


def test_an_upright_axis_never_gives_way():
    rng = np.random.default_rng(2)
    arm = replace(affected(table_2(r_mm=40.0), rng, "compliance"), gravity=(0.0, 0.0, -1.0))
    told = causes(arm, [lengths(arm, rng)])
    assert told["no-moment"] == [{"joint.1.compliance"}]
    assert set(told) == {"base-frame", "no-moment"}


def test_the_last_encoder_of_a_straight_probe_is_told():
    rng = np.random.default_rng(3)
    arm = affected(table_2(r_mm=0.0), rng, "harmonics")
    told = causes(arm, [lengths(arm, rng)])
    assert {"joint.7.c1"} in told["probe-on-axis"]


def either_side(rng, arm, count=300):
    """Approaches of both poses, each joint from either side."""
    return [rng.choice([-1.0, 1.0], (count, arm.joints)) for _ in range(2)]


def test_play_shows_where_joints_are_approached_from_both_sides():
    rng = np.random.default_rng(5)
    arm = affected(table_2(r_mm=40.0), rng, "backlash")
    groups = [lengths(arm, rng, approaches=either_side(rng, arm))]
    assert fits.rank_of(fits.reduced_jacobian(groups, arm)) == 32
    assert causes(arm, groups) == {"base-frame": [{"joint.1.theta0"}, {"joint.1.d"}]}


@pytest.mark.parametrize("joint", [1, 2, 3, 6, 7])
@pytest.mark.parametrize(
    ("side", "cause"), [(1.0, "approach-one-sided"), (-1.0, "approach-one-sided"), (0.0, "approach-unknown")]
)
def test_play_of_a_joint_approached_from_one_side_is_a_zero_offset(joint, side, cause):
    rng = np.random.default_rng(6)
    arm = affected(table_2(r_mm=40.0), rng, "backlash")
    approaches = either_side(rng, arm)
    for approach in approaches:
        approach[:, joint - 1] = side
    groups = [lengths(arm, rng, approaches=approaches)]
    assert fits.rank_of(fits.reduced_jacobian(groups, arm)) == 31
    told = causes(arm, groups)
    # a zero offset of joint 1 is the base's, that of joint 7 the tip's, which lies on x
    with_it = {1: set(), 7: {"probe.bent.y"}}.get(joint, {f"joint.{joint}.theta0"})
    assert told[cause] == [{f"joint.{joint}.backlash"} | (with_it if side else set())]
    assert set(told) == {"base-frame", cause}


def test_what_is_lost_with_a_zero_offset_is_told_in_words():
    rng = np.random.default_rng(7)
    arm = affected(table_2(r_mm=40.0), rng, "backlash")
    approaches = either_side(rng, arm)
    for approach in approaches:
        approach[:, 2] = -1.0
    problem = core_problem(arm, [lengths(arm, rng, approaches=approaches)])
    (lost,) = [one for one in _core.identify(problem, nothing_held(arm)).lost if not one["frame"]]
    # b / 2 · (-1) and theta0 = ∓ b / 2 are the same turn, by the joint's sign
    assert lost["combination"] == pytest.approx({"joint.3.backlash": 1.0, "joint.3.theta0": -0.5 * arm.sign[2]})
    assert lost["because"].startswith("joint 3 was always approached from the same side")
    assert "joint 3 approached from both sides" in lost["remedy"]


def test_play_of_joint_1_needs_both_sides_while_the_artefact_stands():
    """Where both ends of each length are approached from the same side, the play of joint 1 turns them together."""
    rng = np.random.default_rng(8)
    arm = affected(table_2(r_mm=40.0), rng, "backlash")
    approaches = either_side(rng, arm)
    approaches[1][:, 0] = approaches[0][:, 0]
    groups = [lengths(arm, rng, approaches=approaches)]
    assert fits.rank_of(fits.reduced_jacobian(groups, arm)) == 31
    told = causes(arm, groups)
    assert told["approach-one-sided"] == [{"joint.1.backlash"}]


def test_readings_that_do_not_say_count_as_neither_side():
    """One file without approaches beside one with a single side: the two are told apart by half the play."""
    rng = np.random.default_rng(9)
    arm = affected(table_2(r_mm=40.0), rng, "backlash")
    said = lengths(arm, rng, approaches=[np.ones((300, 7))] * 2)
    groups = [said, lengths(arm, rng)]
    # but for joint 1, with which both ends of each length turn
    assert fits.rank_of(fits.reduced_jacobian(groups, arm)) == 31
    assert causes(arm, groups)["approach-one-sided"] == [{"joint.1.backlash"}]


def test_play_of_a_straight_probes_last_joint_is_not_seen():
    rng = np.random.default_rng(10)
    arm = affected(table_2(r_mm=0.0), rng, "backlash")
    told = causes(arm, [lengths(arm, rng, approaches=either_side(rng, arm))])
    assert {"joint.7.backlash"} in told["probe-on-axis"]


def seat_readings(arm, rng, travel):
    """Lengths of a bar with joint 4 turned over `travel` only, 5e-6 rad of noise."""
    groups = lengths(arm, rng)
    for poses in (groups.q_rad, groups.p_rad):
        poses[:, 3] *= travel / np.pi
    length = np.linalg.norm(arm.tip(groups.q_rad) - arm.tip(groups.p_rad), axis=1)
    return Lengths(groups.q_rad, groups.p_rad, length)


@pytest.mark.parametrize(("travel_rad", "known"), [(np.pi, True), (0.15, False)])
def test_over_a_short_travel_the_first_harmonic_is_a_zero_offset(travel_rad, known):
    """Over ±0.15 rad cos q is a constant and sin q a tilt that nothing else has: c1 goes with theta0, at the best."""
    rng = np.random.default_rng(4)
    arm = affected(table_2(r_mm=40.0), rng, "harmonics", orders=(1,))
    problem = core_problem(arm, [seat_readings(arm, rng, travel_rad)], fits.Noise(np.full(7, 2e-5), 0.02))
    fitted = _core.fit(problem, nothing_held(arm))
    names = fitted.names
    u = np.sqrt(np.diag(fitted.covariance))
    assert (u[names.index("joint.4.c1")] < 1e-4) == known
    correlation = fitted.covariance[names.index("joint.4.c1"), names.index("joint.4.theta0")]
    correlation /= u[names.index("joint.4.c1")] * u[names.index("joint.4.theta0")]
    assert (abs(correlation) > 0.99) != known
    # with the prior that calibrations use, it is known from that
    for k, name in enumerate(names):
        if name.rsplit(".", 1)[1] in ("c1", "s1"):
            problem.add_prior(k, 0.0, 1e-4)
    again = _core.fit(problem, nothing_held(arm))
    assert ("joint.4.c1" in again.identifiability.from_prior) != known
