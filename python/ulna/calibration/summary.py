"""What a calibration says of each parameter, and of how the fit ended."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any

import ulna._core as _core


@dataclass(frozen=True)
class Parameter:
    """One parameter of the arm before and after."""

    name: str
    """As `joint.3.theta0`, `probe.bent.x`, `joint.3.c1` or `artefact.ball.diameter`."""
    unit: str
    """"rad", "mm", "1/K" or "rad/(N m)", of start, value and u."""
    start: float
    value: float
    u: float | None
    """Standard uncertainty; None where held, not determined, or without degrees of freedom to estimate it from."""
    status: str
    """"fitted", "held" or "not-determined"."""
    prior: dict[str, float] | None = None
    """What was known of it before: value and u, where the fit used it."""

    def as_dict(self) -> dict[str, Any]:
        """As in `result.json`, list `parameters`."""
        entry = asdict(self)
        if self.prior is None:
            del entry["prior"]
        return entry


@dataclass(frozen=True)
class FitSummary:
    """How the fit ended."""

    termination: str
    """"converged-cost", "converged-step", "exact", "nothing-to-fit", "no-progress",
    "max-iterations", "poor-minimum"."""
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
    degrees_of_freedom: int
    chi2_per_dof: float | None
    """1 where the stated noise is right; None without stated noise."""
    searched_starts: int
    search_reason: str
    folded: list[str]
    undecided_signs: list[list[int]] = field(default_factory=list)
    """Sets of joints that may all count the other way: readings and the arm file do not tell."""
    method: str = "lm"
    """What searched before Levenberg–Marquardt finished: "lm" (nothing), "annealing" or "evolution"."""
    box_evaluations: int = 0
    """How often that search evaluated the sum of squares."""
    loss: str = "none"
    scatter: dict[str, float] = field(default_factory=dict)
    """Of each artefact's readings, from the median: in units of the stated noise, or mm where none is stated."""

    @classmethod
    def from_core(cls, fitted: _core.Fitted, **more: Any) -> FitSummary:
        """Copy out of the core; `more` are the fields that it does not know."""
        values = {name: getattr(fitted, name) for name in cls.__dataclass_fields__ if name not in more}
        return cls(**(values | more | {"folded": list(fitted.folded)}))

    def as_dict(self) -> dict[str, Any]:
        """As in `result.json`, key `fit`; `chi2_per_dof` is left out where it is not known."""
        entry = asdict(self)
        if self.chi2_per_dof is None:
            del entry["chi2_per_dof"]
        return entry

    @classmethod
    def from_dict(cls, entry: Mapping[str, Any]) -> FitSummary:
        """The inverse of `as_dict`."""
        values: dict[str, Any] = {"chi2_per_dof": None} | dict(entry)
        # older files lack the later fields
        return cls(**{name: values[name] for name in cls.__dataclass_fields__ if name in values})
