"""Noise-free readings: the truth comes back, as far as it is determinable, to the last digits."""

from dataclasses import replace

import numpy as np
import pytest
from tests.oracle import virtual
from tests.oracle.arms import parallel_axes
from tests.oracle.chain import chain, cylindrical_tip
from tests.oracle.core import core_arm, core_problem, nothing_held
from tests.oracle.observed import Points
from tests.oracle.published import STRAIGHT_4, TABLE_2, TABLE_3, six_axes, table_2, table_3, table_4

import ulna._core as _core

ENDED_WELL = {"exact", "converged-cost", "converged-step"}
BASE = ["joint.1.theta0", "joint.1.d"]


def assert_is(found, truth, but=()):
    """Every parameter within 1e-9 rad and 1e-6 mm, except those named."""
    names = core_arm(truth).parameter_names
    off = abs(found.parameters - truth.parameters)
    limit = np.where(truth.angular, 1e-9, 1e-6)
    wrong = {n: o for n, o, bad in zip(names, off, off > limit, strict=True) if bad and n not in but}
    assert not wrong
    assert found.converged
    assert found.termination in ENDED_WELL


@pytest.mark.parametrize("seed", range(10))
def test_table_2_from_table_3(seed):
    """Cheng 2011: r = 10 mm, 101 lengths. Everything but the base frame is found exactly."""
    truth, start = table_2(), table_3()
    groups = [virtual.random_lengths(truth, np.random.default_rng(seed), 101)]
    found = _core.fit(core_problem(start, groups), nothing_held(start))
    assert_is(found, truth, but=BASE)
    assert sorted(found.identifiability.not_determined) == sorted(BASE)
    assert found.identifiability.determined == 25
    # What is not determined keeps its start value, exactly.
    np.testing.assert_array_equal(found.parameters[[0, 3]], start.parameters[[0, 3]])
    assert found.rms_mm < 1e-9
    assert found.observations == 101
    assert found.degrees_of_freedom == 101 - 25
    assert found.search_reason == ""


@pytest.mark.parametrize("seed", range(5))
def test_a_straight_probe_still_measures(seed):
    """r = 0: 23 of 27, the family is named, and lengths measured with that probe are right to 1e-6 mm."""
    truth, start = table_2(r_mm=0.0), table_3(r_mm=0.0)
    rng = np.random.default_rng(seed)
    groups = [virtual.random_lengths(truth, rng, 101)]
    found = _core.fit(core_problem(start, groups), nothing_held(start))
    assert found.converged
    assert found.identifiability.determined == 23
    causes = [lost["cause"] for lost in found.identifiability.lost]
    assert sorted(causes) == ["base-frame", "base-frame", "probe-on-axis", "probe-on-axis"]
    fresh = virtual.random_lengths(truth, rng, 200)
    calibrated = start.with_parameters(found.parameters)
    assert abs(fresh.residuals(calibrated, np.zeros(0))).max() < 1e-6


@pytest.mark.parametrize("r_mm", [10.0, 0.0965])
@pytest.mark.parametrize("kind", ["length", "plate", "base frame"])
def test_a_straight_start_does_not_stay_straight(kind, r_mm):
    """Drawn straight, built with a bend: what is lost at the start is not lost at the arm that is found."""
    truth, start = table_2(r_mm=r_mm), table_3(r_mm=0.0)
    rng = np.random.default_rng(1)
    groups = {
        "length": lambda: [virtual.random_lengths(truth, rng, 101)],
        "plate": lambda: [virtual.plate(truth, rng, 8)],
        "base frame": lambda: [virtual.coordinates(truth, rng, 60, placed=False)],
    }[kind]()
    found = _core.fit(core_problem(start, groups), nothing_held(start))
    lost = [] if kind == "base frame" else BASE
    assert sorted(found.identifiability.not_determined) == sorted(lost)
    assert found.rms_mm < 1e-6
    if r_mm == 10.0:
        assert_is(found, truth, but=lost)


def test_axes_drawn_parallel_need_not_be():
    """The same for axes: nominally parallel DH joints, built with a tilt of ten milliradians and other offsets."""
    drawn = [[0.0, 1.57, 30.0, 200.0], [0.1, 0.0, 400.0, 0.0], [0.2, 0.0, 380.0, 0.0], [0.0, 1.57, 0.0, 120.0]]
    built = np.array(drawn) + [[0.0, 1e-2, 0.5, d_mm] for d_mm in (0.0, 1.0, -1.5, 2.0)]
    start, truth = chain(np.array(drawn), [40.0, 0.0, 150.0]), chain(built, [41.0, 1.0, 150.0])
    groups = [virtual.random_lengths(truth, np.random.default_rng(2), 101)]
    found = _core.fit(core_problem(start, groups), nothing_held(start))
    assert found.rms_mm < 1e-6
    assert sorted(found.identifiability.not_determined) == sorted(BASE)


def test_two_straight_probes_need_no_bent_one():
    """200 and 250 mm in one fit: 28 of 30, and the truth."""
    probes = np.array([[0.0, 0.0, 200.0], [0.0, 0.0, 250.0]])
    truth = replace(table_2(r_mm=0.0), tips_mm=probes)
    start = replace(table_3(r_mm=0.0), tips_mm=probes + np.array([[3.0, -2.0, -20.0], [-2.0, 4.0, 15.0]]))
    rng = np.random.default_rng(4)
    groups = [virtual.random_lengths(truth, rng, 70, k) for k in (0, 1)]
    found = _core.fit(core_problem(start, groups), nothing_held(start))
    assert_is(found, truth, but=BASE)
    assert found.identifiability.determined == 28


def six_start(truth):
    rng = np.random.default_rng(9)
    return virtual.wrong_start(truth, rng, 0.1, 20.0)


@pytest.mark.parametrize("build", [six_axes, parallel_axes], ids=["measuring arm", "parallel axes"])
def test_six_axes(build):
    truth = build()
    start = six_start(truth)
    groups = [virtual.random_lengths(truth, np.random.default_rng(5), 101)]
    found = _core.fit(core_problem(start, groups), nothing_held(start))
    assert_is(found, truth, but=BASE)
    assert found.identifiability.determined == 21


def test_coordinates_in_the_base_frame_find_everything():
    truth, start = table_2(), table_3()
    groups = [virtual.coordinates(truth, np.random.default_rng(6), 60, placed=False)]
    found = _core.fit(core_problem(start, groups), nothing_held(start))
    assert_is(found, truth)
    assert found.identifiability.lost == []


@pytest.mark.parametrize("kind", ["frame", "bar", "plate", "bar touched often", "bar and seats", "lengths and seats"])
def test_artefacts_that_stand_somewhere(kind):
    """Placements are unknown; the arm is found all the same, but for the base frame."""
    truth, start = table_2(), table_3()
    rng = np.random.default_rng(7)
    groups = {
        "frame": lambda: [virtual.coordinates(truth, rng, 60, placed=True)],
        "bar": lambda: [virtual.bars(truth, rng, 60, 443.172)],
        "plate": lambda: [virtual.plate(truth, rng, 8)],
        "bar touched often": lambda: [virtual.bars(truth, rng, 12, 443.172, each=4)],
        "bar and seats": lambda: [virtual.bars(truth, rng, 20, 443.172), virtual.seats(truth, rng, 3, 10)],
        "lengths and seats": lambda: [virtual.random_lengths(truth, rng, 30), virtual.seats(truth, rng, 2, 12)],
    }[kind]()
    found = _core.fit(core_problem(start, groups), nothing_held(start))
    assert_is(found, truth, but=BASE)
    assert found.identifiability.determined == 25
    unknowns = {
        "frame": 6,
        "bar": 60 * 5,
        "plate": 8 * 6,
        "bar touched often": 12 * 5,
        "bar and seats": 20 * 5 + 9,
        "lengths and seats": 6,
    }
    assert found.placement_unknowns == unknowns[kind]
    assert found.degrees_of_freedom == found.observations - unknowns[kind] - 25


def test_a_bar_touched_once_at_each_end_is_a_length():
    """The pose absorbs the other five components: the same estimate as length rows from the same touches."""
    truth, start = table_4(), table_4()
    rng = np.random.default_rng(8)
    bar = virtual.bars(truth, rng, 60, 443.172)
    bar = replace(bar, q_rad=bar.q_rad + 2e-5 * rng.standard_normal(bar.q_rad.shape))
    start = virtual.wrong_start(truth, rng, 0.02, 2.0)
    as_bar = _core.fit(core_problem(start, [bar]), nothing_held(start))
    from tests.oracle.observed import Lengths

    rows = Lengths(bar.q_rad[0::2], bar.q_rad[1::2], np.full(60, 443.172))
    as_lengths = _core.fit(core_problem(start, [rows]), nothing_held(start))
    np.testing.assert_allclose(as_bar.parameters, as_lengths.parameters, rtol=0, atol=1e-6)
    # A length error of e is shared by the two ends, e/2 each: half the sum of squares.
    assert as_bar.cost == pytest.approx(as_lengths.cost / 2, rel=1e-8)


def test_seats_alone_find_the_shape_but_not_the_scale():
    """Two seats, no length: hold one known length and everything else is found."""
    truth = table_2()
    start = virtual.wrong_start(truth, np.random.default_rng(3), 0.05, 10.0)
    start = start.with_parameters(
        np.where(np.arange(27) == 11, truth.parameters, start.parameters)
    )  # joint.3.d is known
    hold = nothing_held(start)
    hold[11] = True
    groups = [virtual.seats(truth, np.random.default_rng(9), 2, 40)]
    found = _core.fit(core_problem(start, groups), hold)
    assert_is(found, truth, but=BASE)
    assert found.identifiability.determined == 24


def test_seats_alone_do_not_shrink_the_arm():
    """Nothing held and noise: a smaller arm has smaller residuals. The scale must stay where it started."""
    truth = table_2()
    rng = np.random.default_rng(10)
    groups = [virtual.seats(truth, rng, 2, 60, virtual.Touches(2e-4, 0.05))]
    start = virtual.wrong_start(truth, rng, 0.01, 1.0)
    found = _core.fit(core_problem(start, groups), nothing_held(start))
    assert found.converged
    lengths = ~truth.angular
    lengths[3] = False  # joint.1.d is the base frame

    def size(parameters):
        return np.linalg.norm(parameters[lengths])

    assert size(found.parameters) == pytest.approx(size(start.parameters), rel=5e-3)
    assert "scale" in [lost["cause"] for lost in found.identifiability.lost]
    assert found.identifiability.determined == 24


def test_the_probe_alone_in_one_seat():
    """The second step of Cheng 2011: joints held as calibrated, 32 poses in one seat, the straight probe is found."""
    truth, calibrated = table_4(straight=True), table_4()
    start = replace(calibrated, tips_mm=np.array([[5.0, 5.0, 220.0]]))
    groups = [virtual.seats(truth, np.random.default_rng(11), 1, 32)]
    hold = np.ones(27, bool)
    hold[-3:] = False
    found = _core.fit(core_problem(start, groups), hold)
    np.testing.assert_allclose(found.parameters[-3:], cylindrical_tip(*STRAIGHT_4), rtol=0, atol=1e-6)
    np.testing.assert_array_equal(found.parameters[:-3], calibrated.parameters[:-3])
    assert found.identifiability.determined == 3


def test_everything_held_is_an_evaluation():
    """Placements are fitted, the arm is not."""
    truth = table_2()
    wrong = virtual.wrong_start(truth, np.random.default_rng(1), 1e-3, 0.1)
    groups = [virtual.bars(truth, np.random.default_rng(12), 10, 443.172, each=3)]
    hold = np.ones(27, bool)
    evaluated = _core.fit(core_problem(wrong, groups), hold)
    assert evaluated.termination == "nothing-to-fit"
    np.testing.assert_array_equal(evaluated.parameters, wrong.parameters)
    from tests.oracle import fits

    oracle = fits.fit(groups, wrong, ~hold)
    assert evaluated.cost == pytest.approx(oracle.cost, rel=1e-9)
    np.testing.assert_allclose(evaluated.residuals(0).ravel(), oracle.residuals, rtol=0, atol=1e-6)
    assert evaluated.rms_mm == pytest.approx(np.sqrt(oracle.cost / len(groups[0].q_rad)), rel=1e-9)


def test_fewer_readings_than_unknowns_are_refused():
    truth = table_2()
    groups = [virtual.random_lengths(truth, np.random.default_rng(13), 20)]
    with pytest.raises(_core.UlnaError, match="20"):
        _core.fit(core_problem(truth, groups), nothing_held(truth))


def test_any_labels_and_any_order_of_rows():
    """Placements are told apart by equal labels only; the order of rows is of no account."""
    truth, start = table_2(), table_3()
    bar = virtual.bars(truth, np.random.default_rng(14), 40, 443.172)
    order = np.random.default_rng(15).permutation(len(bar.q_rad))
    labels = np.random.default_rng(16).permutation(10_000)[:40] - 5000
    mixed = Points(bar.features_mm, bar.q_rad[order], bar.feature[order], labels[bar.placement][order])
    found = _core.fit(core_problem(start, [mixed]), nothing_held(start))
    assert_is(found, truth, but=BASE)
    wrong = _core.fit(core_problem(start, [mixed]), np.ones(27, bool))
    straight = _core.fit(core_problem(start, [bar]), np.ones(27, bool))
    np.testing.assert_allclose(wrong.residuals(0), straight.residuals(0)[order], rtol=0, atol=1e-6)


def test_the_tables_of_the_paper_are_what_they_were():
    """Nobody edits the published numbers by accident: sums of the columns as printed."""
    np.testing.assert_allclose(np.sum(TABLE_2, axis=0), [6.8067, 0.0, 0.0, 1150.0], atol=1e-12)
    np.testing.assert_allclose(np.sum(TABLE_3, axis=0), [6.9, 0.0, 0.0, 1060.0], atol=1e-12)
