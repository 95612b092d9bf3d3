"""Where the centre of the probe's ball is when it touches an artefact, in the artefact's own frame. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import SURFACES, Artefact
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError
from ulna.simulation.spec import Touching
from ulna.study.assembly import check_balls

#: touches of surfaces are spread by the golden ratio and by its relative in two dimensions, so that none are near
GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0
PLASTIC = 1.324717957244746


@dataclass(frozen=True)
class Touches:
    """All touches of one placement, in the order in which they are read."""

    centre_mm: F64
    """(T, 3) of the ball."""
    off: F64
    """(T, 3) unit vector away from the surface; zero where a feature is touched, which may be missed anyhow."""
    probe: I64
    """(T,) index into the arm's probes."""
    feature: I64
    """(T,) index into the artefact's features; 0 for surfaces."""


def true_artefact(stated: Artefact, rng: np.random.Generator) -> Artefact:
    """The artefact itself: what its certificate states, off by a normal draw of the stated uncertainty."""
    if stated.kind == "points":
        u_mm = np.array(stated.feature_u_mm or [stated.u_mm] * len(stated.features))
        points_mm = np.array(list(stated.features.values())) + u_mm[:, None] * rng.standard_normal((len(u_mm), 3))
        named = zip(stated.features, points_mm.tolist(), strict=True)
        return replace(stated, features={name: (x, y, z) for name, (x, y, z) in named})
    off_mm = stated.u_mm * float(rng.standard_normal())
    if stated.diameter_mm is not None:
        return replace(stated, diameter_mm=stated.diameter_mm + off_mm)
    if stated.length_mm is None:
        return stated
    length_mm = stated.length_mm + off_mm
    ends = {"A": (0.0, 0.0, 0.0), "B": (length_mm, 0.0, 0.0)} if stated.kind == "bar" else {}
    return replace(stated, length_mm=length_mm, features=ends)


def probes_of(touching: Touching, arm: Arm, label: str) -> list[int]:
    """Indices of the probes that touch. Raises UlnaInputError for those that cannot."""
    name, artefact = touching.artefact.name, touching.artefact
    try:
        used = [arm.probe_index(probe) for probe in touching.probes or (None,)]
    except UlnaInputError as error:
        raise UlnaInputError(f"{label}: key 'artefact.{name}.probe': {error} Correct it.") from None
    if len(set(used)) < len(used):
        raise UlnaInputError(f"{label}: key 'artefact.{name}.probe': a probe stands there twice. Remove one of them.")
    check_balls(artefact, arm, used, label)
    return used


def touches_of(touching: Touching, true: Artefact, arm: Arm, probes: list[int]) -> Touches:
    """The touches of one placement of the true artefact."""
    if true.kind in SURFACES:
        balls_mm = np.array([probe.ball_mm or 0.0 for probe in arm.probes.values()])
        probe = np.repeat(np.array(probes, dtype=np.int64), touching.touches)
        surface = _on_sphere if true.kind == "sphere" else _on_plane
        centre_mm, off = surface(touching, true, balls_mm[probe])
        return Touches(centre_mm, off, probe, np.zeros(len(probe), np.int64))
    ends = [(0.0, 0.0, 0.0), (true.length_mm or 0.0, 0.0, 0.0)]
    points_mm = np.array(ends if true.kind == "length" else list(true.features.values()), dtype=np.float64)
    feature = np.tile(np.repeat(np.arange(len(points_mm)), touching.touches), len(probes))
    probe = np.repeat(np.array(probes, dtype=np.int64), len(points_mm) * touching.touches)
    return Touches(points_mm[feature], np.zeros((len(feature), 3)), probe, feature)


def _on_sphere(touching: Touching, true: Artefact, balls_mm: F64) -> tuple[F64, F64]:
    """The half of the sphere that is away from its stem, evenly; of a hollow the half that is opposite its mouth."""
    number = np.tile(np.arange(touching.touches), len(balls_mm) // touching.touches)
    height = (number + 0.5) / touching.touches
    angle, radius = 2.0 * np.pi * number * GOLDEN, np.sqrt(1.0 - height**2)
    outward = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), height])
    assert true.diameter_mm is not None
    side = -1.0 if true.inside else 1.0
    return 0.5 * (true.diameter_mm + side * balls_mm)[:, None] * outward, side * outward


def _on_plane(touching: Touching, true: Artefact, balls_mm: F64) -> tuple[F64, F64]:
    """A rectangle about the origin, evenly."""
    number = np.tile(np.arange(touching.touches), len(balls_mm) // touching.touches) + 1.0
    x, y = ((0.5 + number / PLASTIC**power) % 1.0 - 0.5 for power in (1, 2))
    width_mm, height_mm = touching.size_mm
    centre_mm = np.column_stack([width_mm * x, height_mm * y, 0.5 * balls_mm])
    return centre_mm, np.tile([0.0, 0.0, 1.0], (len(balls_mm), 1))
