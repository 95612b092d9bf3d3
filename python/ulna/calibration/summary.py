"""What a calibration says of each parameter, of how the fit ended, and of a group that was left out.

These are entries of files as they stand (`ulna.calibration.result_file`): a field with a default may be absent in files
of earlier versions.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal

import ulna._core as _core
from ulna.calibration.placements import Figures
from ulna.study.data import Loss, Method

Unit = Literal["rad", "mm", "1/K", "rad/(N m)", "1"]
Status = Literal["fitted", "held", "not-determined"]


@dataclass(frozen=True)
class Parameter:
    """One parameter of the arm before and after."""

    name: str
    """As `joint.3.theta0`, `probe.bent.x`, `joint.3.c1` or `artefact.ball.diameter`."""
    unit: Unit
    """Of start, value and u."""
    start: float
    value: float
    u: float | None
    """Standard uncertainty; None where held, not determined, or where nothing tells it."""
    status: Status
    prior: dict[str, float] | None = None
    """What was known of it before: value and u, where the fit used it."""


FEW_PLACES = 3
"""So few show neither how an arm errs in another one, nor how readings scatter there."""


@dataclass(frozen=True)
class ReadingScatter:
    """What the residuals say of a reading's noise."""

    touch_mm: float | None = None
    """Where no noise was stated: standard deviation of a touch per coordinate, what the encoders add included."""
    factor: float | None = None
    """Where noise was stated: by how much the readings scattered more, or less. 1 where chi² does not contradict what
    was stated. Uncertainties of parameters are scaled by it."""
    unexplained_mm: float | None = None
    """Where they scattered more: the standard deviation per coordinate, beside the stated noise, that the model does
    not explain."""
    degrees_of_freedom: float | None = None
    """Of these figures, and of the parameters' uncertainties; None where the stated noise stands."""
    places: int | None = None
    """Standings of artefacts of which each was left out to see how the arm errs elsewhere; None where there is one."""
    place_factor: float | None = None
    """By what errors in a place left out exceed what the scatter within places makes of them: parameters' uncertainties
    are multiplied by it. 1 where chance explains it."""

    @property
    def few_places(self) -> bool:
        """Whether k says that there are few: where residuals had a say in what is stated."""
        return self.degrees_of_freedom is not None and self.places is not None and self.places <= FEW_PLACES


@dataclass(frozen=True)
class FitSummary:
    """How the fit ended."""

    termination: str
    """"converged-cost", "converged-step", "exact", "nothing-to-fit", "no-progress",
    "max-iterations", "poor-minimum", "held-poor", "off-scale"."""
    converged: bool
    iterations: int
    evaluations: int
    cost_start: float
    """Sum of squares of the whitened residuals at the start; mm² where no noise is stated."""
    cost: float
    rms_start_mm: float
    """Root of the mean of the squared norms of the readings' residuals, unweighted."""
    rms_mm: float
    readings: int
    observations: int
    """Scalar equations: three for each point reading, one for each length row or touch of a surface."""
    placement_unknowns: int
    degrees_of_freedom: float
    """Equations less what placements and parameters took of them; what is known beforehand takes a part, or none."""
    chi2_per_dof: float | None = None
    """1 where the stated noise is right; None without stated noise."""
    searched_starts: int = 0
    search_reason: str = ""
    folded: list[str] = field(default_factory=list)
    undecided_signs: list[list[int]] = field(default_factory=list)
    """Sets of joints that may all count the other way: readings and the arm file do not tell."""
    mirrored_signs: list[list[int]] = field(default_factory=list)
    """Those of them with which the arm is the mirror image of the one found; with the others it is the same arm."""
    signs_found: dict[str, int] = field(default_factory=dict)
    """Of joints whose sign the arm file had as not known, `joint.3.sign`: what was found, 1 or -1."""
    common_factor: float | None = None
    """Found over drawn, where all lengths of the arm are off the arm file by one factor: a stated size may be wrong."""
    method: Method = "lm"
    """What searched before Levenberg–Marquardt finished: "lm" (nothing), "annealing" or "evolution"."""
    box_evaluations: int = 0
    """How often that search evaluated the sum of squares."""
    loss: Loss = "none"
    scatter: dict[str, float] = field(default_factory=dict)
    """Of each artefact's readings, from the median: in units of the stated noise, or mm where none is stated."""
    reading_scatter: ReadingScatter | None = None
    """What the residuals say of a reading's noise; None without degrees of freedom."""

    @classmethod
    def from_core(cls, fitted: _core.Fitted, **more: Any) -> FitSummary:
        """Copy out of the core; `more` are the fields that it does not know."""
        values = {name: getattr(fitted, name) for name in cls.__dataclass_fields__ if name not in more}
        return cls(**(values | more | {"folded": list(fitted.folded)}))


@dataclass(frozen=True)
class GroupFigures:
    """One group left out."""

    group: str
    readings: int
    """Rows left out."""
    before: Figures
    after: Figures
    converged: bool
    """Whether the fit to the other readings ended well."""
    termination: str
    lost: list[dict[str, Any]] = field(default_factory=list)
    """What the other readings could not determine, as `Identification.lost`."""
