"""Who touches an artefact in a simulation, and where the centre of the probe's ball is then. Lengths mm."""

from __future__ import annotations

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.touching import Touches
from ulna.artefacts.touching import Touching as How
from ulna.ground.errors import UlnaInputError
from ulna.simulation.spec import Touching


def probes_of(touching: Touching, arm: Arm, label: str) -> list[int]:
    """Indices of the probes that touch. Raises UlnaInputError for those that cannot."""
    name, artefact = touching.artefact.name, touching.artefact
    try:
        used = [arm.probe_index(probe) for probe in touching.probes or (None,)]
    except UlnaInputError as error:
        raise UlnaInputError(f"{label}: key 'artefact.{name}.probe': {error} Correct it.") from None
    if len(set(used)) < len(used):
        raise UlnaInputError(f"{label}: key 'artefact.{name}.probe': a probe stands there twice. Remove one of them.")
    kind_of(artefact).check_probes(artefact, arm, used, label)
    return used


def touches_of(touching: Touching, true: Artefact, arm: Arm, probes: list[int]) -> Touches:
    """The touches of one placement of the true artefact, in its own frame."""
    balls_mm = np.array([probe.ball_mm or 0.0 for probe in arm.probes.values()])
    how = How(touching.touches, np.array(probes, dtype=np.int64), balls_mm, touching.size_mm)
    return kind_of(true).touched(true, how)
