"""The smallest sphere that holds all points. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
from numpy.typing import ArrayLike

from ulna.geometry.clouds import Clouds
from ulna.ground.arrays import F64

FEW = 6
"""Points of which all pairs, triples and quadruples are tried at once."""
MOST_EXCHANGES = 1000
"""Each makes the sphere larger; tens are usual for 10⁵ points."""
WITHIN = 1e-14
"""Over the radius: a point this far outside is on the sphere."""


@dataclass(frozen=True)
class Enclosing:
    """Of one set of points, or of many: the leading axes are those of the points."""

    centre_mm: F64
    """(..., 3)"""
    radius_mm: F64
    """(...,) 0 for a single point."""

    @property
    def diameter_mm(self) -> F64:
        """(...,)"""
        return 2.0 * self.radius_mm


def enclosing_sphere(points_mm: ArrayLike, what: str = "smallest enclosing sphere") -> Enclosing:
    """(..., N, 3) points, N ≥ 1 → the smallest sphere that holds each set; `what`: how messages call it.

    Exact: two, three or four points lie on it, and it is the smallest of the spheres through pairs, triples and
    quadruples that hold all points. Of more than a few points those are exchanged: the farthest point joins, and the
    smallest sphere of these at most five is found anew, until none is outside. Raises UlnaInputError for no points.
    """
    clouds = Clouds.of(points_mm, 1, what)
    if clouds.count <= FEW:
        centre, radius = _of_few(clouds.at)
    else:
        found = [_exchanged(at) for at in clouds.at]
        centre, radius = np.stack([each[0] for each in found]), np.array([each[1] for each in found])
    centre_mm = clouds.mean_mm + clouds.size_mm[:, None] * centre
    return Enclosing(clouds.vectors(centre_mm), clouds.numbers(clouds.size_mm * radius))


def _of_few(at: F64) -> tuple[F64, F64]:
    """(T, 3) centres and (T,) radii of (T, N, 3) sets of few points.

    A sphere about any centre holds all points if its radius is the largest distance: of all candidates the smallest
    such radius is the answer, and none needs to be tested with a tolerance.
    """
    candidates = [_middles(at, size) for size in range(1, min(at.shape[1], 4) + 1)]
    centres = np.concatenate(candidates, axis=1)
    radii = np.linalg.norm(at[:, None] - centres[:, :, None], axis=3).max(axis=2)
    radii = np.where(np.isfinite(radii), radii, np.inf)
    best = radii.argmin(axis=1)
    rows = np.arange(len(at))
    return centres[rows, best], radii[rows, best]


def _middles(at: F64, size: int) -> F64:
    """(T, C, 3) the points equally far from, and nearest to, each choice of `size` of the N points.

    Choices that are nearly degenerate get some point near by: it is a candidate like any other, and never the best.
    """
    chosen = np.array(list(combinations(range(at.shape[1]), size)))
    corners = at[:, chosen]
    first = corners[:, :, 0]
    edges = corners[:, :, 1:] - first[:, :, None]
    if size == 1:
        return first
    # Gauss–Schmidt by QR: the middle lies in the span of the edges, at half of each edge's length along it
    q, r = np.linalg.qr(edges.transpose(0, 1, 3, 2))
    half = 0.5 * (edges**2).sum(axis=3)
    diagonal = np.abs(np.diagonal(r, axis1=2, axis2=3))
    whole = diagonal.min(axis=2) > 1e-13 * np.maximum(diagonal.max(axis=2), 1e-300)
    r = np.where(whole[..., None, None], r, np.eye(size - 1))
    inside = np.linalg.solve(r.transpose(0, 1, 3, 2), half[..., None])
    middle = first + (q @ inside)[..., 0]
    return np.where(whole[..., None], middle, first)


def _exchanged(at: F64) -> tuple[F64, float]:
    """Centre and radius of one (N, 3) set of many points."""
    held = [int(np.linalg.norm(at, axis=1).argmax())]
    centre, radius = at[held[0]], 0.0
    for _ in range(MOST_EXCHANGES):
        away = np.linalg.norm(at - centre, axis=1)
        farthest = int(away.argmax())
        if away[farthest] <= radius * (1.0 + WITHIN) or farthest in held:
            break
        held.append(farthest)
        few_centre, few_radius = _of_few(at[held][None])
        centre, radius = few_centre[0], float(few_radius[0])
        if len(held) > 4:
            held = _needed(at, held, radius)
    return centre, float(np.linalg.norm(at - centre, axis=1).max())


def _needed(at: F64, held: list[int], radius: float) -> list[int]:
    """At most four of five points whose smallest sphere is the same."""
    for out in held[:-1]:  # the last one was outside: it is needed
        rest = [each for each in held if each != out]
        if float(_of_few(at[rest][None])[1][0]) >= radius * (1.0 - WITHIN):
            return rest
    sizes = [(float(_of_few(at[[e for e in held if e != out]][None])[1][0]), out) for out in held[:-1]]
    least = max(sizes)[1]
    return [each for each in held if each != least]
