"""The least-squares cylinder: the sum of the squared distances of the points from its surface is least. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ulna.geometry.clouds import Clouds, Fitted
from ulna.geometry.settling import settle
from ulna.ground.arrays import F64, Bool
from ulna.ground.errors import UlnaInputError

LEAST = 5
"""Points that determine a cylinder, if they are not placed unluckily."""
FARTHEST = 1e7
"""Radius over the extent of the points beyond which they do not tell the cylinder from a plane."""
DIRECTIONS = 200
"""Of axes that are tried: none is farther than some 7° from one of them."""
KEPT = 4
"""Of these go on to Gauss–Newton: a short cylinder, or a small part of one, has several minima."""
MOST_NUMBERS = 1_000_000
"""Coordinates worked on at a time."""


@dataclass(frozen=True)
class Cylinder(Fitted):
    """Fitted to one set of points, or to many: the leading axes are those of the points."""

    point_mm: F64
    """(..., 3) on the axis, nearest to the mean of the points."""
    direction: F64
    """(..., 3) of the axis, unit vector; its largest component is positive."""
    radius_mm: F64
    """(...,)"""
    residuals_mm: F64
    """(..., N) distance from the axis minus the radius (and the offset): positive is outside."""


def fit_cylinder(points_mm: ArrayLike, what: str = "cylinder", offsets_mm: ArrayLike = 0.0) -> Cylinder:
    """(..., N, 3) points, N ≥ 5 → the least-squares cylinder of each set; `what`: how messages call it.

    offsets_mm, a number or (..., N): how much farther out than the surface each point is, such as a ball's radius.

    Axes of all directions are tried, each with the algebraic circle of the points seen along it (Kåsa 1976);
    Gauss–Newton on the distances ends the best of them. Raises UlnaInputError for fewer than five points, points on a
    line, and where no cylinder is nearest.
    """
    clouds = Clouds.of(points_mm, LEAST, what)
    clouds.need(2, "on a line", "A cylinder needs points around it: spread them.")
    offsets = clouds.one_each(offsets_mm) / clouds.size_mm[:, None]
    surface = _Around(clouds.at, offsets)
    everyone = np.ones(len(clouds.at), dtype=bool)
    state, cost = np.zeros((len(clouds.at), 7)), np.full(len(clouds.at), np.inf)
    for start in _started(clouds.at, offsets):
        found, settled = settle(surface, start)
        sums = (surface.residuals(found, everyone) ** 2).sum(axis=1)
        better = settled & np.isfinite(found).all(axis=1) & (np.abs(found[:, 6]) <= FARTHEST) & (sums < cost)
        state[better], cost[better] = found[better], sums[better]
    if np.isinf(cost).any():
        k = int(np.argmax(np.isinf(cost)))
        raise UlnaInputError(
            f"{what}: {clouds.in_set(k)}no cylinder is nearest to the {clouds.count} points: they go round too little "
            "of it for their scatter. Spread the points around and along the cylinder."
        )
    direction = state[:, 3:6]
    direction = direction * np.sign(np.take_along_axis(direction, np.abs(direction).argmax(axis=1)[:, None], axis=1))
    along = (state[:, :3] * direction).sum(axis=1, keepdims=True)
    return Cylinder(
        clouds.vectors(clouds.mean_mm + clouds.size_mm[:, None] * (state[:, :3] - along * direction)),
        clouds.vectors(direction),
        clouds.numbers(clouds.size_mm * state[:, 6]),
        clouds.each(clouds.size_mm[:, None] * surface.residuals(state, everyone)),
    )


def _started(at: F64, offsets: F64) -> list[F64]:
    """Starts (T, 7), the best of all directions first: a point on the axis, its direction, the radius."""
    directions = _hemisphere(DIRECTIONS)
    step = max(1, MOST_NUMBERS // at.size)
    found = [_seen_along(directions[first : first + step], at, offsets) for first in range(0, DIRECTIONS, step)]
    states, costs = (np.concatenate(parts, axis=1) for parts in zip(*found, strict=True))
    order = np.argsort(costs, axis=1)[:, :KEPT]
    return [np.take_along_axis(states, order[:, k, None, None], axis=1)[:, 0] for k in range(KEPT)]


def _hemisphere(count: int) -> F64:
    """(count, 3) directions evenly over half a sphere, by the golden ratio."""
    number = np.arange(count)
    height = (number + 0.5) / count
    angle = np.pi * (1.0 + np.sqrt(5.0)) * number
    across = np.sqrt(1.0 - height**2)
    return np.column_stack([across * np.cos(angle), across * np.sin(angle), height])


def _seen_along(direction: F64, at: F64, offsets: F64) -> tuple[F64, F64]:
    """(D, 3) directions → (T, D, 7) cylinders, (T, D) mean square distances from them; inf where there is none."""
    across = _across(direction)
    flat = np.einsum("tni,dki->tdnk", at, across)
    # about the mean, which is zero: 2 M c = m, with M the second moments and m the third
    second = flat.transpose(0, 1, 3, 2) @ flat
    third = np.einsum("tdnk,tdn->tdk", flat, (flat**2).sum(axis=3))
    seen = np.linalg.det(second) > 1e-12 * np.trace(second, axis1=2, axis2=3) ** 2
    centre = np.zeros(third.shape)
    centre[seen] = 0.5 * np.linalg.solve(second[seen], third[seen][..., None])[..., 0]
    distance = np.linalg.norm(flat - centre[:, :, None], axis=3) - offsets[:, None]
    radius = distance.mean(axis=2)
    cost = np.where(seen, ((distance - radius[..., None]) ** 2).mean(axis=2), np.inf)
    point = np.einsum("tdk,dki->tdi", centre, across)
    state = np.concatenate([point, np.broadcast_to(direction, point.shape), radius[..., None]], axis=2)
    return state, cost


def _across(direction: F64) -> F64:
    """(S, 3) unit vectors → (S, 2, 3) two directions across each."""
    helper = np.eye(3)[np.abs(direction).argmin(axis=1)]
    first = np.cross(direction, helper)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return np.stack([first, np.cross(direction, first)], axis=1)


@dataclass(frozen=True)
class _Around:
    """A `Surface` of `settling`: distances from the axis minus the radius and what each point is farther out."""

    at: F64
    offsets: F64

    def residuals(self, state: F64, own: Bool) -> F64:
        away, _ = self._away(state, own)
        distance: F64 = np.linalg.norm(away, axis=2)
        return distance - state[:, 6:] - self.offsets[own]

    def jacobian(self, state: F64, own: Bool) -> F64:
        """By shifts across the axis, tilts of it, and the radius."""
        away, along = self._away(state, own)
        distance = np.linalg.norm(away, axis=2)
        unit = away / np.maximum(distance, np.finfo(np.float64).tiny)[:, :, None]
        shifts = -np.einsum("tni,tki->tnk", unit, _across(state[:, 3:6]))
        return np.concatenate([shifts, along[:, :, None] * shifts, -np.ones((*distance.shape, 1))], axis=2)

    def moved(self, state: F64, step: F64) -> F64:
        across = _across(state[:, 3:6])
        point = state[:, :3] + np.einsum("tk,tki->ti", step[:, :2], across)
        direction = state[:, 3:6] + np.einsum("tk,tki->ti", step[:, 2:4], across)
        direction /= np.linalg.norm(direction, axis=1, keepdims=True)
        return np.concatenate([point, direction, state[:, 6:] + step[:, 4:]], axis=1)

    def _away(self, state: F64, own: Bool) -> tuple[F64, F64]:
        """(S, N, 3) from the axis to each point, and (S, N) how far along the axis it is."""
        away = self.at[own] - state[:, None, :3]
        along: F64 = np.einsum("tni,ti->tn", away, state[:, 3:6])
        return away - along[:, :, None] * state[:, None, 3:6], along
