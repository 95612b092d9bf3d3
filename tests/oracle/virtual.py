"""A virtual arm that is moved, touches things and reads its encoders: data with a known truth."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from .chain import Array, Chain
from .observed import Lengths, Points
from .surfaces import Cylinder, Distances, Plane, Sphere

#: Travel of every joint of the virtual arms, rad.
TRAVEL_RAD = np.pi

#: Diameter of the ball that surfaces are touched with.
BALL_MM = 6.0


def random_poses(arm: Chain, rng: np.random.Generator, count: int) -> Array:
    """(count, n) encoder angles, uniform over the travel."""
    return rng.uniform(-TRAVEL_RAD, TRAVEL_RAD, (count, arm.joints))


def try_poses(arm: Chain, points_mm: Array, rng: np.random.Generator, probe: int = 0, tries: int = 4) -> Array:
    """(N, n) encoder angles within the travel that put the tip on (N, 3) points; NaN where none was found.

    Damped Newton from random poses; what does not arrive is tried again from elsewhere, so elbow and wrist differ from
    touch to touch.
    """
    points_mm = np.atleast_2d(points_mm)
    out = np.full((len(points_mm), arm.joints), np.nan)
    for _ in range(tries):
        open_rows = np.flatnonzero(np.isnan(out[:, 0]))
        if not len(open_rows):
            break
        q = random_poses(arm, rng, len(open_rows))
        for _ in range(25):
            miss = points_mm[open_rows] - arm.tip(q, probe)
            there = np.linalg.norm(miss, axis=1) < 1e-10
            within = there & (abs(q) <= TRAVEL_RAD).all(axis=1)
            out[open_rows[within]] = q[within]
            open_rows, q, miss = open_rows[~there], q[~there], miss[~there]
            if not len(open_rows):
                break
            j = arm.encoder_jacobian(q, probe)
            damping = (1e-3 * (miss**2).sum(axis=1))[:, None, None] * np.eye(3)
            pull = np.linalg.solve(j @ j.transpose(0, 2, 1) + damping, miss[..., None])[..., 0]
            step = np.einsum("nki,nk->ni", j, pull)
            q = q + step / np.maximum(1.0, abs(step).max(axis=1, keepdims=True) / 0.5)
    return out


def poses_for_points(arm: Chain, points_mm: Array, rng: np.random.Generator, probe: int = 0) -> Array:
    """The same for points that the arm surely reaches."""
    q = try_poses(arm, points_mm, rng, probe, tries=300)
    assert np.isfinite(q).all(), "a point is out of the virtual arm's reach"
    return q


def random_points(arm: Chain, rng: np.random.Generator, count: int) -> Array:
    """(count, 3) mm: points that the arm surely reaches: it stands there in a random pose, not too near its column."""
    points = arm.tip(random_poses(arm, rng, 20 * count))
    far = np.linalg.norm(points, axis=1)
    usable = points[(far > 300.0) & (far < 0.8 * far.max())]
    return usable[:count]


@dataclass(frozen=True)
class Touches:
    """How touches and readings err: standard deviations in rad per encoder and mm per coordinate."""

    encoder_rad: float = 0.0
    seat_mm: float = 0.0

    def touch(self, arm: Chain, points_mm: Array, rng: np.random.Generator, probe: int = 0) -> Array:
        """(N, n) readings: the tip sits a little beside the point, and the encoders read a little beside the pose."""
        beside = points_mm + self.seat_mm * rng.standard_normal(np.shape(points_mm))
        return self.read(poses_for_points(arm, beside, rng, probe), rng)

    def read(self, q_rad: Array, rng: np.random.Generator) -> Array:
        return q_rad + self.encoder_rad * rng.standard_normal(q_rad.shape)


EXACT = Touches()


def random_lengths(arm: Chain, rng: np.random.Generator, count: int, probe: int = 0) -> Lengths:
    """Pairs of random poses and the true distance between their tips."""
    q, p = random_poses(arm, rng, count), random_poses(arm, rng, count)
    return Lengths(q, p, np.linalg.norm(arm.tip(q, probe) - arm.tip(p, probe), axis=1), probe)


def bars(
    arm: Chain,
    rng: np.random.Generator,
    count: int,
    length_mm: float,
    touches: Touches = EXACT,
    each: int = 1,
    probe: int = 0,
) -> Points:
    """A bar in ``count`` random places and directions, each end touched ``each`` times."""
    # Towards another place that the arm reaches, so that the far end is rarely out of reach.
    first, towards = random_points(arm, rng, 3 * count), random_points(arm, rng, 3 * count)
    apart = np.linalg.norm(towards - first, axis=1)
    chosen = np.flatnonzero(apart > 0.8 * length_mm)[: count + count // 3 + 3]
    first = first[chosen]
    second = first + (towards[chosen] - first) * (length_mm / apart[chosen])[:, None]
    reached = np.isfinite(try_poses(arm, second, rng, probe)).all(axis=1)
    assert reached.sum() >= count
    ends = np.stack([first[reached], second[reached]], axis=1)[:count]  # (count, 2, 3)
    ends = np.repeat(ends, each, axis=0)
    q = touches.touch(arm, ends.reshape(-1, 3), rng, probe)
    features = np.array([[0.0, 0.0, 0.0], [length_mm, 0.0, 0.0]])
    return Points(features, q, np.tile([0, 1], len(ends)), np.repeat(np.arange(count), 2 * each), probe)


def seats(
    arm: Chain, rng: np.random.Generator, places: int, each: int, touches: Touches = EXACT, probe: int = 0
) -> Points:
    """``places`` single seats, each touched ``each`` times with other elbows and wrists."""
    centres = np.repeat(random_points(arm, rng, places), each, axis=0)
    q = touches.touch(arm, centres, rng, probe)
    none = np.zeros(len(q), np.int64)
    return Points(np.zeros((1, 3)), q, none, np.repeat(np.arange(places), each), probe)


def coordinates(
    arm: Chain, rng: np.random.Generator, count: int, placed: bool, touches: Touches = EXACT, probe: int = 0
) -> Points:
    """``count`` reference points known in the base frame (``placed`` False) or in a frame of their own (True)."""
    q = random_poses(arm, rng, count)
    at = arm.tip(q, probe)
    beside = at + touches.seat_mm * rng.standard_normal(at.shape)
    if touches.seat_mm:
        q = poses_for_points(arm, beside, rng, probe)
    known = at
    if placed:
        turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
        known = at @ (turn * np.sign(np.linalg.det(turn))) + rng.uniform(-500, 500, 3)
    return Points(known, touches.read(q, rng), np.arange(count), np.zeros(count, np.int64), probe, placed)


def plate(arm: Chain, rng: np.random.Generator, count: int, touches: Touches = EXACT, probe: int = 0) -> Points:
    """A ball plate of nine balls 100 mm apart, in ``count`` places, every ball touched once."""
    grid = np.array([[100.0 * i, 100.0 * j, 5.0 * i * j] for i in range(3) for j in range(3)])
    balls = []
    for where in random_points(arm, rng, 8 * count):
        turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
        balls.append(grid @ (turn * np.sign(np.linalg.det(turn))).T + where)
    reached = np.isfinite(try_poses(arm, np.concatenate(balls), rng, probe)).reshape(-1, 9 * arm.joints).all(axis=1)
    assert reached.sum() >= count
    q = touches.touch(arm, np.stack(balls)[reached][:count].reshape(-1, 3), rng, probe)
    return Points(grid, q, np.tile(np.arange(9), count), np.repeat(np.arange(count), 9), probe)


def wrong_start(arm: Chain, rng: np.random.Generator, zero_rad: float, length_mm: float) -> Chain:
    """The arm as a drawing might know it: zero offsets off by up to ``zero_rad``, lengths by up to ``length_mm``."""
    return replace(
        arm,
        theta0_rad=arm.theta0_rad + rng.uniform(-zero_rad, zero_rad, arm.theta0_rad.shape),
        a_mm=arm.a_mm + rng.uniform(-length_mm, length_mm, arm.a_mm.shape),
        last=arm.last + rng.uniform(-length_mm, length_mm, arm.last.shape) * ~np.array(arm.hayati),
        tips_mm=arm.tips_mm + rng.uniform(-length_mm, length_mm, arm.tips_mm.shape),
    )


def spheres(arm: Chain, rng: np.random.Generator, count: int, each: int, inside: bool = False) -> Sphere:
    """A ball of 50 mm in ``count`` places, touched ``each`` times all around with the ball of probe 0."""
    around = rng.standard_normal((count * each, 3))
    around *= _radius(50.0, inside) / np.linalg.norm(around, axis=1, keepdims=True)
    centres = np.repeat(random_points(arm, rng, count), each, axis=0)
    q = EXACT.touch(arm, centres + around, rng)
    return Sphere(50.0, np.full(arm.probes, BALL_MM), q, np.repeat(np.arange(count), each), inside=inside)


def planes(arm: Chain, rng: np.random.Generator, count: int, each: int) -> Plane:
    """A flat of 300 mm in ``count`` places, touched ``each`` times with the ball of probe 0."""

    def spots() -> Array:
        return np.column_stack([rng.uniform(-150, 150, (2 * each, 2)), np.full(2 * each, 0.5 * BALL_MM)])

    q, turn, _ = _stood(arm, rng, count, each, spots)
    return Plane(np.full(arm.probes, BALL_MM), q, np.repeat(np.arange(count), each), turn[:, :, 2])


def cylinders(arm: Chain, rng: np.random.Generator, count: int, each: int, inside: bool = False) -> Cylinder:
    """A shaft or bore of 60 and 200 mm in ``count`` places, touched ``each`` times all around with the ball of probe
    0."""
    radius = _radius(60.0, inside)

    def spots() -> Array:
        angle, height = rng.uniform(-np.pi, np.pi, 2 * each), rng.uniform(-100, 100, 2 * each)
        return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height])

    q, turn, at = _stood(arm, rng, count, each, spots)
    placement = np.repeat(np.arange(count), each)
    return Cylinder(60.0, np.full(arm.probes, BALL_MM), q, placement, turn[:, :, 2], at, inside=inside)


def _radius(diameter_mm: float, inside: bool) -> float:
    """Of what the tip moves on, mm."""
    return 0.5 * (diameter_mm - BALL_MM if inside else diameter_mm + BALL_MM)


def _stood(
    arm: Chain, rng: np.random.Generator, count: int, each: int, spots: Callable[[], Array]
) -> tuple[Array, Array, Array]:
    """Something in ``count`` places and any attitude, where the arm reaches ``each`` of its ``spots`` (twice as many):
    encoder angles, (count, 3, 3) turns and (count, 3) places."""
    stands, turns, at = [], [], []
    for where in random_points(arm, rng, 3 * count):
        turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
        here = spots() @ turn.T + where
        reached = np.isfinite(try_poses(arm, here, rng)).all(axis=1)
        if reached.sum() >= each:
            stands.append(here[reached][:each])
            turns.append(turn)
            at.append(where)
    assert len(stands) >= count
    q = EXACT.touch(arm, np.concatenate(stands[:count]), rng)
    return q, np.stack(turns[:count]), np.stack(at[:count])


def distances(arm: Chain, rng: np.random.Generator, count: int, each: int) -> Distances:
    """Distances of ``each`` random poses' tips from each of ``count`` fixed points."""
    q, placement = random_poses(arm, rng, count * each), np.repeat(np.arange(count), each)
    feet = random_points(arm, rng, count)[placement]
    return Distances(np.linalg.norm(arm.tip(q) - feet, axis=1), q, placement)
