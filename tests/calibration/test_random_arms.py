"""Home-built arms of which next to nothing is known: zero offsets and signs unknown, lengths off by a tenth.

Each is found, or the fit says that it was not, or which signs are undecided: none is wrong and called converged. The
whole law is over many more arms than fit into a suite: `python -m tests.calibration.test_random_arms 0 200` goes
through 200 and counts. Here some of each number of joints and each artefact.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.calibration.test_wrong_minima import small_arm
from tests.oracle import virtual
from tests.oracle.chain import Chain
from tests.oracle.core import core_problem
from tests.oracle.fits import Groups, Noise
from tests.oracle.observed import Points
from tests.oracle.surfaces import Sphere

import ulna._core as _core

ENCODER_RAD, SEAT_MM = 2e-5, 0.03
TOUCHES = virtual.Touches(ENCODER_RAD, SEAT_MM)
#: distances between any two poses of an arm that was found are right to this, mm: a hundred times the noise, for the
#: readings of some arms tell little where they do not reach
RIGHT_MM = 3.0


def reach_mm(arm: Chain) -> float:
    return float(np.hypot(arm.a_mm, arm.last).sum() + np.linalg.norm(arm.tips_mm[0]))


def standing(arm: Chain, rng: np.random.Generator, features_mm: np.ndarray, count: int) -> Points:
    """Features in ``count`` places and attitudes where the arm reaches all of them: arms of three joints reach few."""
    found: list[np.ndarray] = []
    while len(found) < count:
        at = arm.tip(virtual.random_poses(arm, rng, 200))
        turn = np.linalg.qr(rng.standard_normal((200, 3, 3)))[0]
        turn *= np.sign(np.linalg.det(turn))[:, None, None]
        stood = np.einsum("nij,mj->nmi", turn, features_mm - features_mm[0]) + at[:, None, :]
        q_rad = virtual.try_poses(arm, stood.reshape(-1, 3), rng)
        found += list(stood[np.isfinite(q_rad).reshape(200, -1).all(axis=1)])
    q_rad = TOUCHES.touch(arm, np.concatenate(found[:count]), rng)
    feature, placement = np.tile(np.arange(len(features_mm)), count), np.repeat(np.arange(count), len(features_mm))
    return Points(features_mm, q_rad, feature, placement)


def bar(arm: Chain, rng: np.random.Generator, count: int) -> Points:
    return standing(arm, rng, np.array([[0.0, 0.0, 0.0], [0.4 * reach_mm(arm), 0.0, 0.0]]), count)


def plate(arm: Chain, rng: np.random.Generator, count: int) -> Points:
    grid = np.array([[i, j, 0.05 * i * j] for i in range(3) for j in range(3)])
    return standing(arm, rng, 0.12 * reach_mm(arm) * grid, count)


def balls(arm: Chain, rng: np.random.Generator, count: int) -> Sphere:
    found: list[np.ndarray] = []
    while len(found) < count:
        around = rng.standard_normal((20, 3))
        around *= (25.0 + 0.5 * virtual.BALL_MM) / np.linalg.norm(around, axis=1, keepdims=True)
        q_rad = virtual.try_poses(arm, arm.tip(virtual.random_poses(arm, rng, 1)) + around, rng)
        found += [q_rad] if np.isfinite(q_rad).all() else []
    placement = np.repeat(np.arange(count), 20)
    return Sphere(50.0, np.full(1, virtual.BALL_MM), np.concatenate(found), placement)


ARTEFACTS: dict[str, Callable[[Chain, np.random.Generator], Groups]] = {
    "bar": lambda arm, rng: [bar(arm, rng, 80)],
    "plate": lambda arm, rng: [plate(arm, rng, 10)],
    "coordinates": lambda arm, rng: [virtual.coordinates(arm, rng, 80, True, TOUCHES)],
    "sphere and bar": lambda arm, rng: [bar(arm, rng, 50), balls(arm, rng, 5)],
}


def outcome(joints: int, artefact: str, stated: bool, seed: int) -> tuple[str, float]:
    """ "right", "not found" (and so said), "wrong", "sign not told", or "not made" where the noise of a touch puts the
    artefact out of this arm's reach; and how long it was searched for, s."""
    rng = np.random.default_rng([seed, joints, list(ARTEFACTS).index(artefact)])
    truth = small_arm(joints, rng)
    truth = replace(truth, sign=tuple(int(sign) for sign in rng.choice([-1, 1], joints)))
    try:
        touched = ARTEFACTS[artefact](truth, rng)
    except AssertionError as unreachable:
        if "out of the virtual arm's reach" not in str(unreachable):
            raise
        return "not made", 0.0
    problem = core_problem(
        replace(
            truth,
            sign=(1,) * joints,
            theta0_rad=rng.uniform(-np.pi, np.pi, joints - 1),
            a_mm=truth.a_mm * rng.uniform(0.9, 1.1, joints - 1),
            last=truth.last * rng.uniform(0.9, 1.1, joints - 1),
            tips_mm=truth.tips_mm * rng.uniform(0.9, 1.1, (1, 3)),
        ),
        touched,
        Noise(np.full(joints, ENCODER_RAD), SEAT_MM) if stated else None,
    )
    free = np.zeros(len(problem.parameter_names), bool)
    began = time.perf_counter()
    found = _core.fit(problem, free, start="search", unknown_signs=np.ones(joints, bool), seed=seed)
    return _judged(found, truth, joints, rng), time.perf_counter() - began


def _judged(found: Any, truth: Chain, joints: int, rng: np.random.Generator) -> str:
    if not found.converged:
        return "not found"
    q, p = rng.uniform(-2.5, 2.5, (2, 60, joints))
    ours = np.linalg.norm(found.arm.tip(q) - found.arm.tip(p), axis=1)
    theirs = np.linalg.norm(truth.tip(q) - truth.tip(p), axis=1)
    if abs(ours - theirs).max() > RIGHT_MM:
        return "wrong"
    wrong = {k + 1 for k in range(joints) if found.arm.signs[k] != truth.sign[k]}
    return "right" if not wrong or wrong in [set(own) for own in found.undecided_signs] else "sign not told"


@pytest.mark.parametrize("artefact", ["plate", "coordinates", "bar"])
@pytest.mark.parametrize("joints", [4, 5, 6])
def test_an_arm_is_found_or_the_fit_says_that_it_was_not(joints: int, artefact: str) -> None:
    assert outcome(joints, artefact, stated=joints % 2 == 0, seed=1)[0] in ("right", "not found")


@pytest.mark.parametrize("seed", [1, 2, 7, 10])
def test_a_bar_of_two_millimetres_does_not_shrink_the_arm(seed: int) -> None:
    """A drawing that is nearly right, nothing stated of the noise: residuals of a tenth of the bar are small beside the
    arm, and a minimum with an arm of half the size leaves no more."""
    rng = np.random.default_rng([seed, 52])
    truth = small_arm(6, rng)
    touched = standing(truth, rng, np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]]), 60)
    drawn = replace(
        truth,
        theta0_rad=truth.theta0_rad + rng.normal(0.0, 0.03, 5),
        a_mm=truth.a_mm + rng.normal(0.0, 0.5, 5),
        last=truth.last + rng.normal(0.0, 0.5, truth.last.shape),
        tips_mm=truth.tips_mm + rng.normal(0.0, 0.5, (1, 3)),
    )
    problem = core_problem(drawn, [touched])
    found = _core.fit(problem, np.zeros(len(problem.parameter_names), bool), seed=seed)
    q, p = rng.uniform(-2.5, 2.5, (2, 60, 6))
    ours = np.linalg.norm(found.arm.tip(q) - found.arm.tip(p), axis=1)
    theirs = np.linalg.norm(truth.tip(q) - truth.tip(p), axis=1)
    assert abs(ours - theirs).max() < 0.02 * reach_mm(truth)


if __name__ == "__main__":
    kinds = list(ARTEFACTS)
    counted: Counter[str] = Counter()
    seconds: list[float] = []
    for number in range(int(sys.argv[1]), int(sys.argv[2])):
        said, took_s = outcome(3 + number % 5, kinds[number // 5 % 4], number // 20 % 2 == 0, number)
        counted[said] += 1
        if said != "right":
            print(number, 3 + number % 5, kinds[number // 5 % 4], said, flush=True)
        seconds.append(took_s)
    print(dict(counted), f"searched for {np.median(seconds):.2f} s at the median, {max(seconds):.1f} s at the most")
