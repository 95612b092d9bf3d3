"""What a calibration found, as it is looked at first."""

from __future__ import annotations

from typing import Literal

from ulna.serve.contract.model import Said, Sentence, Sha256, Value


class Residual(Said):
    """One reading: what the fit leaves of it."""

    index: int
    artefact: str
    place: str
    feature: str
    off_mm: float
    weight: float
    """1: counts whole; 0: taken for an outlier."""
    q_deg: list[float]
    touch: int | None
    """Number of the touch, where the result is of a session."""


class Group(Said):
    """Figures of one artefact, before and after."""

    name: str
    figures: list[tuple[str, Value, Value]]
    """What, by the drawing, by the calibrated arm."""


class Held(Said):
    """Of readings that were not fitted."""

    places: int
    readings: int
    figures: list[tuple[str, Value, Value]]
    """What, by the drawing, by the calibrated arm."""
    inside: Sentence | None
    """How many are inside their stated intervals."""


class ResultInfo(Said):
    """One result."""

    sha256: Sha256
    arm: str
    converged: bool
    ending: Sentence
    headline: list[Sentence]
    """What is wrong or most important, in words, the worst first; as `ulna calibrate` prints it."""
    chi_squared: Value
    dof: int
    readings: int
    outliers: int
    noise: list[Sentence]
    held_out: Held | None
    groups: list[Group]
    lost: list[Sentence]
    weak: list[Sentence]
    residuals: list[Residual]
    study: Sha256 | None
    state: Literal["as found", "as left", "unknown"] = "unknown"
