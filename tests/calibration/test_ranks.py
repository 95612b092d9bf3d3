"""What readings can and cannot determine: every rank of the model's table, and how well conditioned the rest is.

The ranks are those of section 4 of the model, checked here against the oracle as well, so the table cannot be wrong in
both. Random poses, the arm of Table 2.
"""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from tests.oracle import fits, virtual
from tests.oracle.chain import chain
from tests.oracle.core import core_problem, nothing_held
from tests.oracle.published import six_axes, table_2, table_4

import ulna._core as _core

BASE = {"joint.1.theta0", "joint.1.d"}


def two_straight_probes():
    return replace(table_2(r_mm=0.0), tips_mm=np.array([[0.0, 0.0, 200.0], [0.0, 0.0, 250.0]]))


def lengths(arm, rng):
    return [virtual.random_lengths(arm, rng, 101 if arm.probes == 1 else 60, k) for k in range(arm.probes)]


def in_base_frame(arm, rng):
    return [virtual.coordinates(arm, rng, 60, placed=False)]


def in_unknown_frame(arm, rng):
    return [virtual.coordinates(arm, rng, 60, placed=True)]


def one_seat(arm, rng):
    return [virtual.seats(arm, rng, 1, 60)]


def two_seats(arm, rng):
    return [virtual.seats(arm, rng, 2, 40)]


def bar_ends(arm, rng):
    return [virtual.bars(arm, rng, 40, 443.172)]


def bar_and_seat(arm, rng):
    return [virtual.bars(arm, rng, 20, 443.172), virtual.seats(arm, rng, 1, 20)]


def ball_plate(arm, rng):
    return [virtual.plate(arm, rng, 8)]


def bent():
    return table_2(r_mm=10.0)


def straight():
    return table_2(r_mm=0.0)


TABLE = [
    (bent, lengths, 25, 27),
    (lambda: table_2(r_mm=40.0), lengths, 25, 27),
    (straight, lengths, 23, 27),
    (bent, in_base_frame, 27, 27),
    (straight, in_base_frame, 25, 27),
    (bent, in_unknown_frame, 25, 27),  # 31 of 33 when the six of the frame are counted too
    (straight, in_unknown_frame, 23, 27),
    (two_straight_probes, lengths, 28, 30),
    (six_axes, lengths, 21, 23),
    (lambda: six_axes(x_mm=0.0), lengths, 19, 23),
    (bent, one_seat, 24, 27),
    (straight, one_seat, 22, 27),
    (bent, two_seats, 24, 27),
    (straight, two_seats, 22, 27),
    (bent, bar_ends, 25, 27),
    (bent, bar_and_seat, 25, 27),
    (bent, ball_plate, 25, 27),
    (table_4, lengths, 25, 27),
]


@cache
def case(row):
    """The arm and the readings of a row: several tests ask the same question of them."""
    build, readings, _, _ = TABLE[row]
    arm = build()
    return arm, readings(arm, np.random.default_rng(row))


@pytest.mark.parametrize("row", range(len(TABLE)))
def test_the_table_of_ranks(row):
    *_, determined, parameters = TABLE[row]
    arm, groups = case(row)
    assert fits.rank_of(fits.reduced_jacobian(groups, arm)) == determined, "the oracle disagrees with the model's table"
    found = _core.identify(core_problem(arm, groups), nothing_held(arm))
    assert (found.determined, found.parameters) == (determined, parameters)
    assert len(found.lost) == parameters - determined


@pytest.mark.parametrize("build", [bent, straight])
def test_the_probe_alone_is_determined_by_one_seat(build):
    """Joints held, one seat: 3 of 3, whatever the probe: the second step of Cheng 2011."""
    arm = build()
    hold = np.ones(27, bool)
    hold[-3:] = False
    groups = [virtual.seats(arm, np.random.default_rng(1), 1, 32)]
    found = _core.identify(core_problem(arm, groups), hold)
    assert (found.determined, found.parameters) == (3, 3)
    assert found.lost == []
    assert found.names == ["probe.bent.x", "probe.bent.y", "probe.bent.z"]


@pytest.mark.parametrize(("r_mm", "about"), [(40.0, 3e-2), (10.0, 7e-3), (1.0, 6e-4), (0.1, 6e-5)])
def test_conditioning_falls_with_the_bend_of_the_probe(r_mm, about):
    """The model states typical figures; one draw of random poses lies within a factor of three of them."""
    arm = table_2(r_mm=r_mm)
    groups = lengths(arm, np.random.default_rng(3))
    found = _core.identify(core_problem(arm, groups), nothing_held(arm))
    assert found.determined == 25
    assert about / 3 < found.condition < about * 3


@pytest.mark.parametrize("row", [0, 2, 7, 10, 14, 16])
def test_singular_values_are_those_of_the_oracle(row):
    *_, determined, parameters = TABLE[row]
    arm, groups = case(row)
    found = _core.identify(core_problem(arm, groups), nothing_held(arm))
    ours, oracle = np.array(found.singular_values), fits.singular_values(fits.reduced_jacobian(groups, arm))
    assert len(ours) == parameters
    np.testing.assert_allclose(ours[:determined], oracle[:determined], rtol=1e-6)
    assert (np.diff(ours) <= 0).all()
    assert found.condition == pytest.approx(oracle[determined - 1] / oracle[0], rel=1e-6)


def test_hayati_joints_of_parallel_axes_lose_nothing_more():
    """Written with d, parallel axes lose a direction each pair; written with beta they do not."""
    from tests.oracle.arms import parallel_axes

    arm = parallel_axes()
    groups = lengths(arm, np.random.default_rng(2))
    found = _core.identify(core_problem(arm, groups), nothing_held(arm))
    assert (found.determined, found.parameters) == (21, 23)
    dh = replace(
        arm,
        hayati=(False,) * 5,
        alpha_rad=np.where(arm.hayati, 0.0, arm.alpha_rad),
        last=np.where(arm.hayati, 0.0, arm.last),
    )
    groups = lengths(dh, np.random.default_rng(2))
    found = _core.identify(core_problem(dh, groups), nothing_held(dh))
    assert found.determined == fits.rank_of(fits.reduced_jacobian(groups, dh)) < 21
    assert {"parallel-axes"} <= {lost["cause"] for lost in found.lost}


def test_the_base_frame_of_an_arm_whose_first_axes_are_parallel():
    """The lift of the base is then no parameter but a combination of several; with noise too."""
    links = [[0.1, 0.02, 300.0, 0.01], [0.3, 1.5, 50.0, 100.0], [0.2, 1.57, 30.0, 200.0], [0.1, -1.5, 20.0, 30.0]]
    arm = chain(np.array(links), [30.0, 10.0, 120.0], (True, False, False, False))
    rng = np.random.default_rng(11)
    exact = virtual.seats(arm, rng, 3, 30)
    expected = fits.rank_of(fits.reduced_jacobian([exact], arm))
    assert expected == 16
    noisy = replace(exact, q_rad=exact.q_rad + 2e-4 * rng.standard_normal(exact.q_rad.shape))
    found = _core.fit(core_problem(arm, [noisy]), nothing_held(arm))
    assert found.converged
    assert found.identifiability.determined == expected
    assert sorted(lost["cause"] for lost in found.identifiability.lost) == ["base-frame", "base-frame", "scale"]


@pytest.mark.parametrize("readings", [one_seat, bar_ends, in_unknown_frame, ball_plate])
def test_noise_does_not_make_lost_directions_look_determined(readings):
    """With residuals left the base's turn also turns the residuals, so its column is small but not zero: still lost."""
    arm = bent()
    rng = np.random.default_rng(7)
    exact = readings(arm, rng)
    groups = [replace(g, q_rad=g.q_rad + 3e-4 * rng.standard_normal(g.q_rad.shape)) for g in exact]
    problem = core_problem(arm, groups)
    before = _core.identify(problem, nothing_held(arm))
    expected = 24 if readings is one_seat else 25
    assert before.determined == expected
    fitted = _core.fit(problem, nothing_held(arm))
    assert fitted.identifiability.determined == expected
    assert fitted.rms_mm > 0.03  # there were residuals to mislead it
