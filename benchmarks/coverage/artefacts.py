"""What true arms touch: artefacts, placed at random within reach. Lengths mm, angles rad."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from benchmarks.coverage.arms import BALL_MM, Array, TrueArm
from benchmarks.coverage.touching import Placed, found, somewhere, turns

BAR_MM = 443.172


@dataclass(frozen=True)
class Features:
    """Features (F, 3) known to u (F, 3), in `places` places, each touched `each` times there."""

    name: str
    table: dict[str, Any]
    labels: tuple[str, ...]
    features_mm: Array
    u_mm: Array
    places: int
    each: int = 1

    def place(self, true: TrueArm, rng: np.random.Generator) -> Placed:
        """All features of a place within reach."""
        count, missing = len(self.features_mm), self.places
        at, turned, readings = [], [], []
        while missing:
            centres, frames = somewhere(true, missing + 10, rng), turns(missing + 10, rng)
            points = np.einsum("pij,fj->pfi", frames, self.features_mm - self.features_mm.mean(axis=0))
            points += centres[:, None]
            r = found(true, np.repeat(points, self.each, axis=1).reshape(-1, 3), rng)
            r = r.reshape(len(points), count * self.each, -1)
            good = np.flatnonzero(np.isfinite(r).all(axis=(1, 2)))[:missing]
            at.append(points[good])
            turned.append(frames[good])
            readings.append(r[good])
            missing -= len(good)
        points_mm = np.repeat(np.concatenate(at), self.each, axis=1).reshape(-1, 3)
        feature = np.tile(np.repeat(np.arange(count), self.each), self.places)
        place = np.repeat(np.arange(self.places), count * self.each)
        moves = np.zeros((len(points_mm), count, 3, 3))
        axes = np.concatenate(turned)[place].transpose(0, 2, 1)  # rows the artefact's axes, in the base frame
        moves[np.arange(len(points_mm)), feature] = self.u_mm[feature][:, :, None] * axes
        columns = {
            "feature": [self.labels[k] for k in feature.tolist()],
            "placement": [f"p{k + 1}" for k in place.tolist()],
        }
        each_move = moves.reshape(len(points_mm), -1, 3)
        uncertain = np.abs(each_move).max(axis=(0, 2)) > 0.0
        at_readings = np.concatenate(readings)
        return Placed(
            true,
            self.name,
            self.table,
            columns,
            1,
            points_mm,
            at_readings.reshape(len(points_mm), -1),
            each_move[:, uncertain],
        )


def bar(places: int, u_mm: float = 0.0, fit: bool = False, length_mm: float = BAR_MM, name: str = "bar") -> Features:
    """A bar, each end touched once in each place."""
    stated = {"u_mm": u_mm} | ({"fit": True} if fit else {}) if u_mm else {}
    ends, u = np.array([[0.0, 0.0, 0.0], [length_mm, 0.0, 0.0]]), np.zeros((2, 3))
    u[1, 0] = u_mm
    return Features(name, {"kind": "bar", "length_mm": length_mm} | stated, ("A", "B"), ends, u, places)


def plate(places: int, u_mm: float = 0.0, fit: bool = False) -> Features:
    """A ball plate of nine balls 100 mm apart, each touched once in each place."""
    grid = np.array([[100.0 * i, 100.0 * j, 5.0 * i * j] for i in range(3) for j in range(3)])
    labels = tuple(f"b{k + 1}" for k in range(len(grid)))
    stated = {"u_mm": u_mm} | ({"fit": True} if fit else {}) if u_mm else {}
    table = {"kind": "points", "features_mm": dict(zip(labels, grid.tolist(), strict=True))} | stated
    return Features("plate", table, labels, grid, np.full(grid.shape, u_mm), places)


def seats(places: int, each: int) -> Features:
    """Single seats, each touched in many postures."""
    return Features("seat", {"kind": "seat"}, ("seat",), np.zeros((1, 3)), np.zeros((1, 3)), places, each)


@dataclass(frozen=True)
class Surface:
    """Something touched on its surface, `each` times in each of `places` places."""

    name: str
    table: dict[str, Any]
    spots: Callable[[int, np.random.Generator], Array] = field(repr=False)
    """(count, 3) centres of the probe's ball, in its own frame."""
    places: int
    each: int

    def place(self, true: TrueArm, rng: np.random.Generator) -> Placed:
        """Enough of the spots within reach."""
        points: list[Array] = []
        readings: list[Array] = []
        while len(points) < self.places:
            (centre,), (frame,) = somewhere(true, 1, rng), turns(1, rng)
            here = self.spots(3 * self.each, rng) @ frame.T + centre
            r = found(true, here, rng)
            good = np.flatnonzero(np.isfinite(r).all(axis=1))[: self.each]
            if len(good) == self.each:
                points.append(here[good])
                readings.append(r[good])
        columns = {"placement": [f"p{k + 1}" for k in range(self.places) for _ in range(self.each)]}
        points_mm = np.concatenate(points)
        none = np.zeros((len(points_mm), 0, 3))
        return Placed(true, self.name, self.table, columns, 1, points_mm, np.concatenate(readings), none)


def _on_ball(count: int, rng: np.random.Generator) -> Array:
    direction = rng.standard_normal((count, 3))
    return np.asarray(0.5 * (50.0 + BALL_MM) * direction / np.linalg.norm(direction, axis=1, keepdims=True))


def _on_flat(count: int, rng: np.random.Generator) -> Array:
    return np.column_stack([rng.uniform(-150.0, 150.0, (count, 2)), np.full(count, 0.5 * BALL_MM)])


def _on_shaft(count: int, rng: np.random.Generator) -> Array:
    angle, height = rng.uniform(-np.pi, np.pi, count), rng.uniform(-100.0, 100.0, count)
    radius = 0.5 * (60.0 + BALL_MM)
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height])


def sphere(places: int, each: int) -> Surface:
    """A ball of 50 mm."""
    return Surface("ball", {"kind": "sphere", "diameter_mm": 50.0}, _on_ball, places, each)


def plane(places: int, each: int) -> Surface:
    """A flat of 300 mm."""
    return Surface("flat", {"kind": "plane"}, _on_flat, places, each)


def cylinder(places: int, each: int) -> Surface:
    """A shaft of 60 mm, 200 mm long."""
    return Surface("shaft", {"kind": "cylinder", "diameter_mm": 60.0}, _on_shaft, places, each)


def _poses(
    true: TrueArm,
    name: str,
    table: dict[str, Any],
    columns: dict[str, Any],
    points_mm: Array,
    readings: Array,
    poses: int = 1,
) -> Placed:
    return Placed(true, name, table, columns, poses, points_mm, readings, np.zeros((len(points_mm), 0, 3)))


@dataclass(frozen=True)
class Coordinates:
    """Points in random postures, whose coordinates somebody measured: in the arm's frame, or in another."""

    count: int
    frame: str

    def place(self, true: TrueArm, rng: np.random.Generator) -> Placed:
        """Anywhere."""
        readings = true.random(self.count, rng)
        at_mm = true.tips.tip(readings)
        known_mm = at_mm if self.frame == "arm" else at_mm @ turns(1, rng)[0] + rng.uniform(-500.0, 500.0, 3)
        labels = [f"m{k + 1}" for k in range(self.count)]
        table: dict[str, Any] = {"kind": "points", "frame": self.frame}
        table |= {"features_mm": dict(zip(labels, known_mm.tolist(), strict=True))}
        return _poses(true, "tracker", table, {"feature": labels, "placement": ["p1"] * self.count}, at_mm, readings)


@dataclass(frozen=True)
class Lengths:
    """Rows of two random postures and the distance between them."""

    count: int

    def place(self, true: TrueArm, rng: np.random.Generator) -> Placed:
        """Anywhere."""
        readings = true.random(2 * self.count, rng)
        at_mm = true.tips.tip(readings)
        apart_mm = np.linalg.norm(at_mm[self.count :] - at_mm[: self.count], axis=1)
        return _poses(true, "lengths", {"kind": "length"}, {"length_mm": apart_mm}, at_mm, readings, poses=2)


@dataclass(frozen=True)
class Distances:
    """Distances from some fixed points, random postures."""

    places: int
    each: int

    def place(self, true: TrueArm, rng: np.random.Generator) -> Placed:
        """Anywhere."""
        readings = true.random(self.places * self.each, rng)
        at_mm, place = true.tips.tip(readings), np.repeat(np.arange(self.places), self.each)
        apart_mm = np.linalg.norm(at_mm - somewhere(true, self.places, rng)[place], axis=1)
        columns = {"distance_mm": apart_mm, "placement": [f"p{k + 1}" for k in place.tolist()]}
        return _poses(true, "instrument", {"kind": "distance"}, columns, at_mm, readings)
