"""How an artefact is touched in one placement, and where."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64, I64


@dataclass(frozen=True)
class Touching:
    """How a true artefact is touched in one placement."""

    touches: int
    """Of each feature with each probe, or in all with each probe."""
    probes: I64
    """(k,) indices of the probes that touch, each as often."""
    balls_mm: F64
    """(P,) of all the arm's probes; 0 where not known."""
    size_mm: tuple[float, float]
    """How large a part of it is touched, where the artefact itself has no end."""


@dataclass(frozen=True)
class Touches:
    """All touches of one placement, in the order in which they are read, in the artefact's own frame."""

    centre_mm: F64
    """(T, 3) of the ball."""
    off: F64
    """(T, 3) unit vector away from the surface; zero where a feature is touched, which may be missed anyhow."""
    probe: I64
    """(T,) index into the arm's probes."""
    feature: I64
    """(T,) index into the artefact's features; 0 for surfaces."""


def touched_features(points_mm: F64, how: Touching) -> Touches:
    """Every one of (F, 3) points as often, probe after probe."""
    feature = np.tile(np.repeat(np.arange(len(points_mm)), how.touches), len(how.probes))
    probe = np.repeat(how.probes, len(points_mm) * how.touches)
    return Touches(points_mm[feature], np.zeros((len(feature), 3)), probe, feature)
