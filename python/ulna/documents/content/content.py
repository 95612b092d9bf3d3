"""What a report says: numbers and statements, no markup and no language. Each rendering shows all of it.

Lengths in mm, angles in rad unless a name says otherwise. What the data do not allow is None here and has a statement
in `Content.missing` that says what would be needed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ulna.calibration.choosing.tried import ChosenModel
from ulna.calibration.extras import JudgedExtra
from ulna.calibration.identify import Identification
from ulna.calibration.placements import PlacementFigures
from ulna.calibration.residual_map import ResidualMap
from ulna.calibration.summary import FitSummary
from ulna.comparison.compare import Compared
from ulna.documents.content.acceptance import Verification
from ulna.documents.content.artefacts import ArtefactRow
from ulna.documents.content.clouds import Cloud, Quiver
from ulna.documents.content.coverage import JudgedReadings
from ulna.documents.content.distribution import Sample
from ulna.documents.content.environment import Environment
from ulna.documents.content.model import Model
from ulna.documents.content.parameters import Observability, Parameters
from ulna.documents.content.provenance import Provenance
from ulna.documents.content.quality import QualityRow
from ulna.documents.content.readings import Lengths, ReadingRows
from ulna.documents.content.standing import StandingArm
from ulna.documents.laboratory.file import Laboratory
from ulna.documents.laboratory.issued import Issued
from ulna.documents.languages.said import Said


@dataclass(frozen=True)
class Content:
    """All that a report of a calibration says."""

    arm: str
    joints: int
    probes: list[str]
    model: Model
    standing: StandingArm
    fit: FitSummary
    quality: list[QualityRow]
    held_out: list[Said]
    """What the held-out readings are, or that there are none and what would be needed."""
    coverage: list[JudgedReadings]
    """Whether what was stated holds on them."""
    readings: ReadingRows
    samples: list[Sample]
    clouds: list[Cloud]
    """Over each joint angle, the reach, the temperature; empty where the study is not known."""
    quiver: Quiver | None
    parameters: Parameters
    identification: Identification
    observability: Observability | None
    lengths: Lengths | None
    placements: Sequence[PlacementFigures]
    artefacts: list[ArtefactRow]
    environment: Environment
    outliers: list[dict[str, Any]]
    """As in a result: all of them, the farthest first."""
    extras: list[JudgedExtra]
    chosen: ChosenModel | None
    residual_map: ResidualMap | None
    """Where the study left the blocks to Ulna."""
    moved: Compared | None
    """Since an earlier calibration, where one was named."""
    verification: Verification | None
    """The acceptance test, where one was given."""
    laboratory: Laboratory | None
    """What the laboratory file says, where one was given; of a certificate that was issued with its number and day."""
    issued: Issued | None
    """That it was issued; None for a draft."""
    missing: dict[str, Said]
    """Section → what it lacks and what would be needed: "study", "joints", "temperature", "verification", …"""
    provenance: Provenance
