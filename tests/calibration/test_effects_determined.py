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


def lengths(arm, rng, count=300, travel=np.pi, warmth=None):
    """Pairs of poses and the true distances, each pose with temperatures where there are any."""
    poses = [rng.uniform(-travel, travel, (count, arm.joints)) for _ in range(2)]
    if warmth is not None:
        poses = [np.hstack([q, warmth]) for q in poses]
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
