"""How sure a measured value is: first order, Monte Carlo, whether they agree, who contributes and what is left out."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.causes import said_of
from ulna.arm.covariance import ParameterCovariance, root_of
from ulna.arm.directions import worth_naming
from ulna.calibration.recalibrations import recalibrated
from ulna.ground.arrays import F64, Progress
from ulna.ground.digits import uncertainty as digits
from ulna.ground.errors import UlnaInputError
from ulna.ground.shown import About, Shown, Table
from ulna.ground.version import VERSION
from ulna.ground.worded import worded
from ulna.study.study import Study
from ulna.uncertainties.constrained import Constrained, Shares
from ulna.uncertainties.first_order import first_order
from ulna.uncertainties.gum import coverage_factor, effective_degrees_of_freedom
from ulna.uncertainties.left_out import left_out
from ulna.uncertainties.monte_carlo import MonteCarlo, adaptive, agrees
from ulna.uncertainties.regions import Ellipsoid, ellipsoid
from ulna.uncertainties.task import Task, in_blocks
from ulna.work.ledger import Ledger
from ulna.work.pieces import Threads, Workers

Sets = Callable[[int, int], F64]
"""(first, count) → (count, P) parameters of as many trials."""

FORMAT = "ulna-uncertainty/1"
MOST_ARMS = 100_000
"""Arms that agree with a performance test: each costs some fifty that do not."""


@dataclass(frozen=True)
class Value:
    """One of the values of a measurand."""

    name: str
    unit: str
    """"mm" or "1": of the value and of its uncertainties."""
    value: float
    u: float | None
    """First order; None where the value is not determined, or nothing can be estimated."""
    expanded: float | None
    """u times the coverage factor k."""
    k: float | None
    """From Student's t where the calibration estimated the noise from its own residuals (GUM G.4.1), else normal."""
    budget: dict[str, float]
    """Source → its standard uncertainty; empty where there is none."""
    monte_carlo: MonteCarlo | None
    first_order_is_good: bool | None
    """By JCGM 101 clause 8; None without a Monte Carlo calculation, or before it is steady."""
    not_determined: list[dict[str, Any]]
    """Directions that the calibration left open, and on which this value depends."""


@dataclass(frozen=True, repr=False)
class Assessment(Shown):
    """What is known of a measurement."""

    kind: str
    probe: str
    readings: int
    p: float
    values: list[Value]
    covariance: F64
    """(values, values) first order, in the values' units; NaN where not determined."""
    region: Ellipsoid | None
    """Of a point, JCGM 102: where it is with probability p; None where the noise was estimated."""
    parameters_from: str
    """"covariance", "recalibrations" or "performance": where the Monte Carlo calculation took the arm's parameters
    from."""
    arms: Shares | None
    """Of arms drawn for a performance test, how many agreed."""
    left_out: list[str]
    seed: int
    most_trials: int

    def about(self) -> About:
        """Each value with what it is made of."""
        rows = [
            [each.name, each.unit, f"{each.value:.6g}", *map(digits, (each.u, each.expanded))] for each in self.values
        ]
        budget = [[each.name, source, digits(u)] for each in self.values for source, u in each.budget.items()]
        return About(
            f"Assessment of a {self.kind}, {self.readings} readings, probe '{self.probe}'",
            {},
            [
                Table(["value", "unit", "", "u", f"U (p = {100 * self.p:g} %)"], rows, texts=2),
                Table(["of", "source", "u"], budget, "Budget", texts=2),
            ],
            [not_determined(each) for each in self.values if each.not_determined],
        )

    def as_dict(self) -> dict[str, Any]:
        """`uncertainty.json`: JSON types only, no NaN."""
        covariance = [[value if np.isfinite(value) else None for value in row] for row in self.covariance.tolist()]
        region = None
        if self.region is not None:
            region = {
                "centre_mm": self.region.centre.tolist(),
                "axes": self.region.axes.tolist(),
                "half_lengths_mm": self.region.half_lengths.tolist(),
                "k": self.region.k,
            }
        document = {
            "format": FORMAT,
            "kind": self.kind,
            "probe": self.probe,
            "readings": self.readings,
            "version": VERSION,
            "seed": self.seed,
            "most_trials": self.most_trials,
            "p": self.p,
            "values": [asdict(value) for value in self.values],
            "covariance": covariance,
            "region": region,
            "parameters_from": self.parameters_from,
            "arms": None if self.arms is None else asdict(self.arms),
            "left_out": self.left_out,
        }
        plain: dict[str, Any] = json.loads(json.dumps(document, allow_nan=False))  # tuples are lists there
        return plain


def assess(
    arm: Arm,
    task: Task,
    *,
    study: Study | None = None,
    seed: int = 0,
    most_trials: int = 1_000_000,
    workers: Workers | None = None,
    ledger: Ledger | None = None,
    arms: Constrained | None = None,
    progress: Progress | None = None,
) -> Assessment:
    """First order and Monte Carlo, for an arm that a calibration made (`arm.uncertainty` is set).

    study: the study that it was calibrated by: then the parameters of each trial are those of a whole calibration on
    new noise, else they are drawn from the covariance. most_trials 0: no Monte Carlo calculation. ledger: keeps
    calibrations that are finished. arms: in place of a calibration, those that agree with a performance test, and
    `arm.uncertainty` is theirs. Raises UlnaInputError for an arm of which no uncertainty is known;
    KeyboardInterrupt.
    """
    known = check_known(arm)
    found = first_order(arm, task)
    units = task.touched.measurand.units
    determined = [not directions for directions in found.open]
    simulated: list[MonteCarlo | None] = [None] * len(units)
    if most_trials and any(determined):
        sets: Sets
        if arms is not None:
            sets = arms.sets
            most_trials = min(most_trials, MOST_ARMS)
        elif study is None:
            sets = _from_covariance(arm, task, seed)
        else:
            sets = _from_study(study, arm, seed, workers or Threads(), ledger)
        simulated = _simulated(arm, task, sets, seed, most_trials, progress)
    covariance = found.covariance
    values = []
    for number, (name, unit) in enumerate(units.items()):
        y = float(found.values[number])
        lost = [known.lost[direction] for direction in found.open[number]]
        if lost:
            values.append(Value(name, unit, y, None, None, None, {}, None, None, lost))
            covariance[number, :] = covariance[:, number] = np.nan
            continue
        budget = found.u_by_source(number)
        u = float(np.sqrt(sum(part**2 for part in budget.values())))
        k = coverage_factor(task.p, _degrees_of_freedom(budget, task))
        trial = simulated[number]
        good = agrees(y, k * u, trial, task.digits)[0] if trial is not None and trial.settled else None
        values.append(Value(name, unit, y, u, k * u, k, budget, trial, good, []))
    source = "performance" if arms is not None else "covariance" if study is None else "recalibrations"
    point = task.touched.kind == "point" and all(determined) and math.isinf(task.noise.degrees_of_freedom)
    return Assessment(
        kind=task.touched.kind,
        probe=task.probe,
        readings=len(task.q_rad),
        p=task.p,
        values=values,
        covariance=covariance,
        region=ellipsoid(found.values, covariance, task.p) if point else None,
        parameters_from=source,
        arms=None if arms is None else arms.shares,
        left_out=[
            *([] if arms is None else arms.assumed),
            *left_out(arm, task.noise, task.u_temperature_k, found.exact, task.left_out(arm)),
        ],
        seed=seed,
        most_trials=most_trials,
    )


def check_known(arm: Arm) -> ParameterCovariance:
    """What is known of an arm's parameters. Raises UlnaInputError where nothing is."""
    if arm.uncertainty is None:
        raise UlnaInputError(
            f"arm '{arm.name}': no uncertainty is known of it; expected the result.json of a calibration, not an arm "
            "file."
        )
    unknown = arm.uncertainty.why_none
    if unknown is not None:
        raise UlnaInputError(f"arm '{arm.name}': no uncertainty is known of it: {unknown.because}. {unknown.remedy}")
    return arm.uncertainty


def _degrees_of_freedom(budget: dict[str, float], task: Task) -> float:
    """Effective ones of a value: what the calibration estimated, beside what was stated."""
    noise = task.noise
    # what residuals showed is one estimate, and so one contribution: its parts grow and shrink together
    shown = {"parameters", "unexplained"} | ({"touch"} if noise.estimated else set())
    together: dict[float, float] = {}
    for source, u in budget.items():
        freedom = noise.degrees_of_freedom if source in shown else math.inf
        together[freedom] = math.hypot(together.get(freedom, 0.0), u)
    return effective_degrees_of_freedom(np.array(list(together.values())), np.array(list(together)))


def _simulated(
    arm: Arm, task: Task, sets: Sets, seed: int, most: int, progress: Progress | None
) -> list[MonteCarlo | None]:
    """Each value's own adaptive procedure, on the same trials."""
    kept: dict[int, F64] = {}

    def trials(first: int, count: int) -> F64:
        if first not in kept or len(kept[first]) < count:
            kept[first] = task.drawn(arm, sets(first, count), first, seed)
        return kept[first][:count]

    def of(value: int) -> MonteCarlo:
        return adaptive(
            lambda first, count: trials(first, count)[:, value], task.p, task.digits, most=most, progress=progress
        )

    return [of(value) for value in range(len(task.touched.measurand.units))]


def _from_covariance(arm: Arm, task: Task, seed: int) -> Sets:
    """Normal; where the covariance was scaled by the calibration's own scatter, multivariate t (JCGM 101 6.4.9)."""
    known = arm.uncertainty
    assert known is not None
    root = root_of(known.over(arm.parameter_names))
    mean = arm.parameters

    def sets(first: int, count: int) -> F64:
        off: F64 = in_blocks(first, count, seed, 2, mean.shape) @ root.T
        return mean + off * task.inflated(first, count, seed)[:, None]

    return sets


def _from_study(study: Study, arm: Arm, seed: int, workers: Workers, ledger: Ledger | None) -> Sets:
    if study.noise is None:
        raise UlnaInputError(
            f"{study.label}: calibrations are repeated on noise drawn anew, but no noise is stated; expected [noise]. "
            "State it, or leave the study out: then parameters are drawn from the result's covariance."
        )

    def sets(first: int, count: int) -> F64:
        done = recalibrated(study, arm, seed, first, count, workers, ledger)
        lost = int((~done["converged"]).sum())
        if lost:
            raise UlnaInputError(
                f"{study.label}: {lost} of {count} calibrations on new noise did not converge; expected all, else "
                "their figures mean nothing. Look at the calibration itself, or leave the study out."
            )
        found: F64 = done["parameters"][:, : len(arm.parameters)]
        return found

    return sets


def not_determined(value: Value) -> str:
    """In a sentence, why a value has no uncertainty and what would help."""
    return depends_on(value.name, value.not_determined[0])


def depends_on(what: str, direction: dict[str, Any]) -> str:
    """In a sentence, on which direction that the calibration left open something depends, why, and what would help."""
    because, remedy = (said_of(direction[key].rstrip(".")) for key in ("because", "remedy"))
    names = ", ".join(worth_naming(direction["combination"]))
    return worded(
        "{what} depends on {names}, which the calibration left open. Why: {because}. Remedy: {remedy}.",
        what=what,
        names=names,
        because=because,
        remedy=remedy,
    )
