"""What nobody knows of simulated readings: the true arm, the true artefacts, where they stood."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.ground.arrays import Bool
from ulna.simulation.standing import Standings


@dataclass(frozen=True)
class TrueTouching:
    """What nobody knows of the readings of one artefact."""

    artefact: Artefact
    """As it really is."""
    standings: Standings
    """Where it stood, and the true encoder angles."""

    @property
    def missed(self) -> Bool:
        """(N,) readings that are missed touches; of rows of two poses: of either."""
        missed = self.standings.missed
        return np.asarray(missed.reshape(-1, kind_of(self.artefact).poses).any(axis=1))


@dataclass(frozen=True)
class Truth:
    """The true arm and artefacts behind simulated readings."""

    arm: Arm
    touchings: list[TrueTouching]
    """One for each of the study's readings, in their order."""
