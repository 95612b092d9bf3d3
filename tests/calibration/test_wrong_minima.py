"""A fit that ends elsewhere than at the arm is found out: mirror images, arms that shrink, families that were left."""

from dataclasses import replace

import numpy as np
import pytest
from tests.oracle import virtual
from tests.oracle.chain import Chain
from tests.oracle.core import core_problem
from tests.oracle.fits import Noise
from tests.oracle.published import table_4

import ulna._core as _core

SEAT_MM = 0.02


def small_arm(joints: int, rng: np.random.Generator) -> Chain:
    """Some arm of few joints, axes square to each other or parallel by chance, as home-built ones are."""
    linked = joints - 1
    turned = rng.choice([-np.pi / 2, np.pi / 2, 0.3, -0.3], linked) + rng.uniform(-0.02, 0.02, linked)
    return Chain(
        theta0_rad=rng.uniform(-3.0, 3.0, linked),
        alpha_rad=turned,
        a_mm=rng.uniform(60.0, 200.0, linked),
        last=rng.uniform(-150.0, 150.0, linked),
        tips_mm=rng.uniform(60.0, 150.0, (1, 3)),
        hayati=(False,) * linked,
        sign=(1,) * joints,
    )


def known_points(arm: Chain, rng: np.random.Generator, count: int):
    """Reference points in a frame of their own, each off by the seat's noise."""
    points = virtual.coordinates(arm, rng, count, True)
    return replace(points, features_mm=points.features_mm + SEAT_MM * rng.standard_normal((count, 3)))


@pytest.mark.parametrize("start", ["search", "given"])
@pytest.mark.parametrize("joints", [3, 4, 5])
@pytest.mark.parametrize("seed", range(6))
def test_coordinates_are_never_explained_by_the_mirror_image(seed: int, joints: int, start: str) -> None:
    """Zero offsets anywhere: the arm itself is found, whatever the first search, by lengths, came to."""
    rng = np.random.default_rng(100 * joints + seed)
    truth = small_arm(joints, rng)
    points = known_points(truth, rng, 60)
    drawn = virtual.wrong_start(truth, rng, 3.0, 5.0)
    problem = core_problem(drawn, [points])
    found = _core.fit(problem, np.zeros(len(problem.parameter_names), bool), start=start, seed=seed)
    assert found.converged
    assert found.rms_mm < 3.0 * SEAT_MM
    q, p = rng.uniform(-2.0, 2.0, (2, 50, joints))
    ours = np.linalg.norm(found.arm.tip(q) - found.arm.tip(p), axis=1)
    theirs = np.linalg.norm(truth.tip(q) - truth.tip(p), axis=1)
    assert abs(ours - theirs).max() < 0.5


@pytest.mark.parametrize("kind", ["sphere", "plane", "cylinder", "seat"])
@pytest.mark.parametrize("seed", range(3))
def test_an_arm_that_does_not_move_is_not_an_arm(seed: int, kind: str) -> None:
    """Whatever passes through a tip that stands still explains it exactly; a fit ends at an arm about as long as the
    drawn one, or not well."""
    rng = np.random.default_rng(seed)
    truth = table_4()
    make = {
        "sphere": lambda: virtual.spheres(truth, rng, 8, 30),
        "plane": lambda: virtual.planes(truth, rng, 8, 30),
        "cylinder": lambda: virtual.cylinders(truth, rng, 8, 30),
        "seat": lambda: virtual.seats(truth, rng, 8, 30),
    }
    noise = Noise(np.full(7, 5e-6), 0.008)
    problem = core_problem(virtual.wrong_start(truth, rng, 0.1, 20.0), [make[kind]()], noise)
    found = _core.fit(problem, np.zeros(len(problem.parameter_names), bool), seed=seed, search_starts=20)
    q, p = rng.uniform(-2.0, 2.0, (2, 50, 7))
    length = np.linalg.norm(found.arm.tip(q) - found.arm.tip(p), axis=1)
    as_long = length.mean() > 0.5 * np.linalg.norm(truth.tip(q) - truth.tip(p), axis=1).mean()
    assert as_long or not found.converged


@pytest.mark.parametrize("seed", range(3))
def test_a_short_bar_ends_at_the_arm_or_not_well(seed: int) -> None:
    """Residuals can never be large on so small an artefact: what is left is held against the stated noise."""
    rng = np.random.default_rng(seed)
    truth = table_4()
    touches = virtual.Touches(5e-6, 0.005)
    bar = virtual.bars(truth, rng, 60, 5.0, touches)
    problem = core_problem(virtual.wrong_start(truth, rng, 0.1, 5.0), [bar], Noise(np.full(7, 5e-6), 0.005))
    found = _core.fit(problem, np.zeros(len(problem.parameter_names), bool), seed=seed)
    assert not found.converged or found.chi2_per_dof < 3.0


@pytest.mark.parametrize("noise_mm", [0.05, 0.5, 1.5])
def test_what_the_start_pinned_is_let_go_where_the_fit_has_left_it(noise_mm: float) -> None:
    """A tip that the drawing has on the last axis and the readings put far from it: all that can be told has its u, as
    from a drawing with the tip beside the axis."""
    rng = np.random.default_rng(5)
    truth = replace(table_4(), tips_mm=np.array([[80.0, 90.0, 120.0]]))
    points = virtual.coordinates(truth, rng, 40, True)
    points = replace(points, features_mm=points.features_mm + noise_mm * rng.standard_normal((40, 3)))
    found = []
    for tip_mm in ([0.0, 0.0, 120.0], [20.0, 0.0, 120.0]):
        problem = core_problem(replace(truth, tips_mm=np.array([tip_mm])), [points])
        found.append(_core.fit(problem, np.zeros(len(problem.parameter_names), bool)))
    on_axis, beside = found
    assert abs(on_axis.rms_mm / beside.rms_mm - 1.0) < 1e-6
    assert on_axis.identifiability.determined == beside.identifiability.determined
    assert np.isfinite(on_axis.covariance).all()


@pytest.mark.parametrize("start", ["given", "search"])
@pytest.mark.parametrize("seed", range(5))
def test_noise_alone_releases_no_family(seed: int, start: str) -> None:
    """A probe that is straight stays straight: its turn about the last axis is not told by noise."""
    rng = np.random.default_rng(seed)
    truth = replace(table_4(), tips_mm=np.array([[0.0, 0.0, 200.0]]))
    points = virtual.coordinates(truth, rng, 60, True)
    points = replace(points, features_mm=points.features_mm + 0.02 * rng.standard_normal((60, 3)))
    problem = core_problem(truth, [points])
    found = _core.fit(problem, np.zeros(len(problem.parameter_names), bool), start=start, seed=seed)
    tip_mm = found.parameters[-3:]
    assert np.hypot(tip_mm[0], tip_mm[1]) < 0.05
    assert found.identifiability.determined < len(problem.parameter_names) - 2
