"""What each way touches: artefacts, where they stand, and the readings. Angles rad, lengths mm.

Every artefact is exact. Every way has the same number of touches, so that what is compared is the artefact and the
places, not the diligence.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ulna.artefacts.artefact import Artefact
from ulna.artefacts.readings import Readings
from ulna.ground.arrays import F64, I64
from ulna.reproduce.ways.arms import BAR_ENDS_MM, BAR_MM
from ulna.simulation.virtual_arm import VirtualArm

TOUCHES = 280

PLATE_MM = np.array([[100.0 * i, 100.0 * j, 0.0] for i in range(4) for j in range(7)])
"""28 balls, 100 mm apart."""
BALL_BAR_MM = np.array([[60.0 * i, 0.0, 0.0] for i in range(14)])
"""14 balls in a line, 60 mm apart."""
POSES_PER_BALL = 4
FREE_SEAT = Artefact("cone", "seat", {"seat": (0.0, 0.0, 0.0)})
"""Only that it stays where it is."""
PROBE_POSES = 32
"""In the one seat that a probe is calibrated in, as Cheng 2011 did."""


def bars(truth: VirtualArm, seed: int) -> Readings:
    """A bar in 140 places, each end touched once."""
    artefact = Artefact("bar", "bar", {"A": (0.0, 0.0, 0.0), "B": (BAR_MM, 0.0, 0.0)}, length_mm=BAR_MM)
    return _standing(truth, artefact, BAR_ENDS_MM, places=TOUCHES // 2, each=1, seed=seed)


def plate(truth: VirtualArm, seed: int) -> Readings:
    """A ball plate in ten places, each ball touched once."""
    artefact = Artefact("plate", "points", _features(PLATE_MM))
    return _standing(truth, artefact, PLATE_MM, places=TOUCHES // len(PLATE_MM), each=1, seed=seed)


def ball_bar(truth: VirtualArm, seed: int) -> Readings:
    """A bar of 14 balls in five places, each ball in several poses."""
    artefact = Artefact("ball bar", "points", _features(BALL_BAR_MM))
    places = TOUCHES // (len(BALL_BAR_MM) * POSES_PER_BALL)
    return _standing(truth, artefact, BALL_BAR_MM, places, POSES_PER_BALL, seed)


def points_alone(of_ball_bar: Readings) -> Readings:
    """The same touches, but all that is known is which are of one ball."""
    own = of_ball_bar.placement_code * len(BALL_BAR_MM) + of_ball_bar.feature
    return replace(
        of_ball_bar,
        artefact=FREE_SEAT,
        feature=np.zeros(len(of_ball_bar), np.int64),
        placement=own.astype(str).astype(object),
    )


def lengths_alone(of_ball_bar: Readings) -> Readings:
    """The same touches in pairs, of which only the distance is known: each touch with one of another ball of its place.

    Balls half a bar apart are paired, so each touch counts once.
    """
    half = len(BALL_BAR_MM) // 2
    first = np.flatnonzero(of_ball_bar.feature < half)
    # within a place the touches stand ball by ball, each ball in all its poses
    second = first + half * POSES_PER_BALL
    apart = BALL_BAR_MM[of_ball_bar.feature[second], 0] - BALL_BAR_MM[of_ball_bar.feature[first], 0]
    return replace(
        of_ball_bar.select(first),
        artefact=Artefact("lengths", "length", {}),
        p_rad=of_ball_bar.q_rad[second],
        length_mm=apart,
        feature=np.zeros(len(first), np.int64),
    )


def coordinates(truth: VirtualArm, seed: int, in_arms_frame: bool) -> Readings:
    """Points anywhere whose coordinates a measuring machine gives: in the arm's base frame, or in its own."""
    rng = np.random.default_rng([seed, 3])
    at_mm = truth.arm.tip(truth.anywhere(TOUCHES, rng))
    known_mm = at_mm if in_arms_frame else at_mm @ _turned() + np.array([900.0, -400.0, 250.0])
    artefact = Artefact("machine", "points", _features(known_mm), frame="arm" if in_arms_frame else "free")
    return _touches(artefact, truth.touch(at_mm, seed, rng), np.arange(TOUCHES), np.zeros(TOUCHES, np.int64))


def seat(truth: VirtualArm, seed: int, known: bool, poses: int = TOUCHES) -> Readings:
    """One seat in many poses; its coordinates in the arm's base frame known or not."""
    rng = np.random.default_rng([seed, 3])
    at_mm = truth.places(BAR_ENDS_MM, 1, rng)[0, :1]
    q_rad = truth.touch(np.repeat(at_mm, poses, axis=0), seed, rng)
    none = np.zeros(poses, np.int64)
    artefact = Artefact("cone", "points", _features(at_mm), frame="arm") if known else FREE_SEAT
    return _touches(artefact, q_rad, none, none)


def _standing(truth: VirtualArm, artefact: Artefact, features_mm: F64, places: int, each: int, seed: int) -> Readings:
    rng = np.random.default_rng([seed, 3])
    at_mm = np.repeat(truth.places(features_mm, places, rng), each, axis=1).reshape(-1, 3)
    feature = np.tile(np.repeat(np.arange(len(features_mm)), each), places)
    placement = np.repeat(np.arange(places), len(features_mm) * each)
    return _touches(artefact, truth.touch(at_mm, seed, rng), feature, placement)


def _touches(artefact: Artefact, q_rad: F64, feature: I64, placement: I64) -> Readings:
    count = len(q_rad)
    none = np.zeros(count, np.int64)
    labels = placement.astype(str).astype(object)
    return Readings(artefact, q_rad, None, None, none, feature, labels, np.arange(count) + 1, none)


def _features(at_mm: F64) -> dict[str, tuple[float, float, float]]:
    return {f"{k + 1}": (x, y, z) for k, (x, y, z) in enumerate(at_mm.tolist())}


def _turned() -> F64:
    """The machine's axes, seen from the arm: turned by a third of a turn about the diagonal, then a little."""
    c, s = np.cos(0.2), np.sin(0.2)
    return np.array([[0.0, c, s], [0.0, -s, c], [1.0, 0.0, 0.0]])
