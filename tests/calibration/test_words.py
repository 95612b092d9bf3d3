"""Lost directions in words: the right parameters, the right cause, a remedy; and they truly change no residual."""

from dataclasses import replace

import numpy as np
import pytest
from tests.calibration.test_ranks import BASE, TABLE, case, lengths, one_seat
from tests.oracle import fits, virtual
from tests.oracle.core import core_arm, core_problem, nothing_held
from tests.oracle.observed import Lengths, stack
from tests.oracle.published import six_axes, table_2

import ulna._core as _core


def vector(arm, direction):
    names = core_arm(arm).parameter_names
    out = np.zeros(len(names))
    for name, weight in direction["combination"].items():
        out[names.index(name)] = weight
    return out


@pytest.mark.parametrize("row", range(len(TABLE)))
def test_a_lost_direction_changes_no_residual(row):
    """The claim itself, held against the oracle: a step along each lost combination is absorbed by the placements."""
    arm, groups = case(row)
    j = fits.reduced_jacobian(groups, arm)
    norms = np.linalg.norm(j, axis=0)
    for lost in _core.identify(core_problem(arm, groups), nothing_held(arm)).lost:
        step = vector(arm, lost)
        assert np.abs(step).max() > 0
        moved = np.linalg.norm(j @ step)
        # Relative to what the same step would do if its parts did not cancel.
        assert moved <= 1e-6 * max(np.linalg.norm(norms * step), norms.max() * np.abs(step).max() * 1e-3)


@pytest.mark.parametrize("row", range(len(TABLE)))
def test_every_lost_direction_has_a_cause_and_a_remedy(row):
    arm, groups = case(row)
    found = _core.identify(core_problem(arm, groups), nothing_held(arm))
    for lost in found.lost:
        assert len(lost["because"]) > 20
        assert len(lost["remedy"]) > 20
        assert lost["cause"] in {
            *("base-frame", "scale", "probe-on-axis", "probe-unused", "joint-still", "parallel-axes", "coverage"),
        }
        assert set(lost["combination"]) <= set(found.names)
    assert set(found.not_determined) == {name for lost in found.lost for name in lost["combination"]}


def causes(arm, groups, hold=None):
    found = _core.identify(core_problem(arm, groups), nothing_held(arm) if hold is None else hold)
    return found, [lost["cause"] for lost in found.lost]


def test_lengths_with_a_bent_probe_lose_exactly_the_base_frame():
    arm = table_2()
    found, why = causes(arm, lengths(arm, np.random.default_rng(1)))
    assert [lost["combination"] for lost in found.lost] == [{"joint.1.theta0": 1.0}, {"joint.1.d": 1.0}] or {
        *found.not_determined
    } == BASE
    assert why == ["base-frame", "base-frame"]
    assert all(lost["frame"] for lost in found.lost)


@pytest.mark.parametrize(
    ("build", "axis"), [(lambda: table_2(r_mm=0.0), 7), (lambda: six_axes(x_mm=0.0), 6)], ids=["seven", "six"]
)
def test_a_straight_probe_names_its_family(build, axis):
    arm = build()
    found, why = causes(arm, lengths(arm, np.random.default_rng(2)))
    assert sorted(why) == ["base-frame", "base-frame", "probe-on-axis", "probe-on-axis"]
    family = set(found.not_determined) - BASE
    last = axis - 1
    allowed = {f"joint.{last}.{p}" for p in ("theta0", "alpha", "a", "d")} | {f"probe.bent.{c}" for c in "xyz"}
    assert family <= allowed
    # The tip's distance along the axis goes with d of the last link; its offset with theta0 and alpha or a.
    assert {f"joint.{last}.d"} <= family
    for lost in found.lost:
        if lost["cause"] == "probe-on-axis":
            assert not lost["frame"]
            assert "probe" in lost["remedy"]


def test_seats_alone_lose_the_scale_and_say_so():
    arm = table_2()
    found, why = causes(arm, one_seat(arm, np.random.default_rng(3)))
    assert sorted(why) == ["base-frame", "base-frame", "scale"]
    scale = next(lost for lost in found.lost if lost["cause"] == "scale")
    assert "scale" in scale["because"].lower()
    assert "length" in scale["remedy"].lower() or "bar" in scale["remedy"].lower()
    lengths_of_arm = {n for n, unit in zip(found.names, core_arm(arm).parameter_units, strict=True) if unit == "mm"}
    nonzero = {n for n, x in zip(found.names, arm.parameters, strict=True) if x != 0.0} & lengths_of_arm - BASE
    assert nonzero <= set(scale["combination"])
    weights = vector(arm, scale)
    true = np.where(arm.angular, 0.0, arm.parameters)
    for part in (weights, true):
        part[3] = 0.0  # joint.1.d is lost anyway and may be mixed in
    cosine = abs(weights @ true) / np.linalg.norm(weights) / np.linalg.norm(true)
    assert cosine == pytest.approx(1.0, abs=1e-9)


def test_a_probe_that_touched_nothing():
    arm = replace(table_2(), tips_mm=np.array([[10.0, 0.0, 200.0], [0.0, 0.0, 250.0]]))
    found, why = causes(arm, [virtual.random_lengths(arm, np.random.default_rng(4), 101, 0)])
    assert found.determined == 25
    assert why.count("probe-unused") == 3
    assert {"probe.p1.x", "probe.p1.y", "probe.p1.z"} <= set(found.not_determined)


def test_a_joint_that_was_never_turned():
    arm = table_2()
    rng = np.random.default_rng(5)
    exact = virtual.random_lengths(arm, rng, 101)
    q, p = exact.q_rad.copy(), exact.p_rad.copy()
    q[:, 4] = p[:, 4] = 0.7
    still = Lengths(q, p, np.linalg.norm(arm.tip(q) - arm.tip(p), axis=1))
    found, why = causes(arm, [still])
    assert found.determined == fits.rank_of(fits.reduced_jacobian([still], arm)) < 25
    assert "joint-still" in why
    said = " ".join(lost["because"] + lost["remedy"] for lost in found.lost if lost["cause"] == "joint-still")
    assert "joint 5" in said or "joint.5" in said


def test_what_is_held_is_not_asked_about():
    arm = table_2()
    hold = nothing_held(arm)
    hold[[0, 3]] = True
    found, why = causes(arm, lengths(arm, np.random.default_rng(6)), hold)
    assert (found.determined, found.parameters, why) == (25, 25, [])
    assert BASE.isdisjoint(found.names)


def test_determined_but_worse_than_a_drawing_is_weak():
    """A probe 0.1 mm off its axis: 25 directions by rank, but two of them are hidden by the stated noise."""
    arm = table_2(r_mm=0.1)
    rng = np.random.default_rng(7)
    noise = fits.Noise(np.full(7, 5e-6), 0.008)
    groups = lengths(arm, rng)
    found = _core.identify(core_problem(arm, groups, noise), nothing_held(arm))
    assert found.determined == 25
    assert found.weak
    named = {name for weak in found.weak for name in weak["combination"]}
    assert named & {"joint.6.theta0", "joint.6.d", "probe.bent.z", "joint.6.alpha", "joint.6.a"}
    for weak in found.weak:
        assert weak["u"] > (1.0 if weak["unit"] == "mm" else 0.01)
        assert len(weak["remedy"]) > 20
    good = table_2(r_mm=40.0)
    fine = _core.identify(core_problem(good, lengths(good, rng), noise), nothing_held(good))
    assert fine.weak == []


def test_a_weak_direction_has_the_uncertainty_of_the_oracle():
    arm = table_2(r_mm=0.1)
    groups = lengths(arm, np.random.default_rng(8))
    noise = fits.Noise(np.full(7, 5e-6), 0.008)
    found = _core.identify(core_problem(arm, groups, noise), nothing_held(arm))
    unknowns, _ = stack(groups, arm)
    _, j, _ = fits.assemble(groups, arm, unknowns, fits.whitener(groups, arm, noise))
    free = np.ones(27, bool)
    free[[0, 3]] = False
    u = np.sqrt(np.diag(np.linalg.inv(j[:, free].T @ j[:, free])))
    worst = dict(zip(np.array(core_arm(arm).parameter_names)[free], u, strict=True))
    top = found.weak[0]
    leading = max(top["combination"], key=lambda name: abs(top["combination"][name]))
    # One weak direction dominates the uncertainty of its leading parameter.
    assert top["u"] == pytest.approx(worst[leading], rel=0.5)
