"""How sure a measured value is: first order, Monte Carlo, whether they agree, who contributes and what is left out."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import ulna
from ulna.directions import worth_naming
from ulna.errors import UlnaInputError
from ulna.model import Arm
from ulna.study import Study
from ulna.uncertainty.first_order import first_order
from ulna.uncertainty.gum import coverage_factor, effective_degrees_of_freedom
from ulna.uncertainty.monte_carlo import MonteCarlo, adaptive, agrees
from ulna.uncertainty.regions import Ellipsoid, ellipsoid
from ulna.uncertainty.task import Task, chi_squared_in_blocks, in_blocks
from ulna.work.pieces import Threads, Workers
from ulna.work.recalibrations import PIECE_RUNS, recalibrated

F64 = NDArray[np.float64]
Progress = Callable[[str, int, int], None]
Sets = Callable[[int, int], F64]
"""(first, count) → (count, P) parameters of as many trials."""

FORMAT = "ulna-uncertainty/1"


@dataclass(frozen=True)
class Value:
    """One of the values of a measurand, mm."""

    name: str
    value_mm: float
    u_mm: float | None
    """First order; None where the value is not determined, or nothing can be estimated."""
    expanded_mm: float | None
    """u times the coverage factor k."""
    k: float | None
    """From Student's t where the calibration estimated the noise from its own residuals (GUM G.4.1), else normal."""
    budget: dict[str, float]
    """Source → its standard uncertainty, mm; empty where there is none."""
    monte_carlo: MonteCarlo | None
    first_order_is_good: bool | None
    """By JCGM 101 clause 8; None without a Monte Carlo calculation, or before it is steady."""
    not_determined: list[dict[str, Any]]
    """Directions that the calibration left open, and on which this value depends."""


@dataclass(frozen=True)
class Assessment:
    """What is known of a measurement."""

    kind: str
    probe: str
    readings: int
    p: float
    values: list[Value]
    covariance_mm2: F64
    """(values, values) first order; NaN where not determined."""
    region: Ellipsoid | None
    """Of a point, JCGM 102: where it is with probability p; None where the noise was estimated."""
    parameters_from: str
    """"covariance" or "recalibrations": where the Monte Carlo calculation took the arm's parameters from."""
    left_out: list[str]
    seed: int
    most_trials: int

    def as_dict(self) -> dict[str, Any]:
        """`uncertainty.json`: JSON types only, no NaN."""
        covariance = [[value if np.isfinite(value) else None for value in row] for row in self.covariance_mm2.tolist()]
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
            "version": ulna.__version__,
            "seed": self.seed,
            "most_trials": self.most_trials,
            "p": self.p,
            "values": [asdict(value) for value in self.values],
            "covariance_mm2": covariance,
            "region": region,
            "parameters_from": self.parameters_from,
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
    progress: Progress | None = None,
) -> Assessment:
    """First order and Monte Carlo, for an arm that a calibration made (`arm.uncertainty` is set).

    study: the study that it was calibrated by: then the parameters of each trial are those of a whole calibration on
    new noise, else they are drawn from the covariance. most_trials 0: no Monte Carlo calculation. Raises UlnaInputError
    for an arm of which no uncertainty is known; KeyboardInterrupt.
    """
    if arm.uncertainty is None:
        raise UlnaInputError(
            f"arm '{arm.name}': no uncertainty is known of it; expected the result.json of a calibration, not an arm "
            "file."
        )
    if not np.isfinite(arm.uncertainty.matrix).all():
        raise UlnaInputError(
            f"arm '{arm.name}': its calibration had no degrees of freedom to estimate uncertainties from. Calibrate "
            "with more readings, or state the noise in the study."
        )
    found = first_order(arm, task)
    names = task.touched.measurand.names
    determined = [not directions for directions in found.open]
    simulated: list[MonteCarlo | None] = [None] * len(names)
    if most_trials and any(determined):
        if study is None:
            sets = _from_covariance(arm, task.degrees_of_freedom, seed)
        else:
            sets = _from_study(study, arm, seed, workers or Threads())
        simulated = _simulated(arm, task, sets, seed, most_trials, progress)
    covariance = found.covariance
    values = []
    for number, name in enumerate(names):
        value_mm = float(found.values_mm[number])
        lost = [arm.uncertainty.lost[direction] for direction in found.open[number]]
        if lost:
            values.append(Value(name, value_mm, None, None, None, {}, None, None, lost))
            covariance[number, :] = covariance[:, number] = np.nan
            continue
        budget = found.u_by_source(number)
        u = float(np.sqrt(sum(part**2 for part in budget.values())))
        k = coverage_factor(task.p, _degrees_of_freedom(budget, task))
        trial = simulated[number]
        good = agrees(value_mm, k * u, trial, task.digits)[0] if trial is not None and trial.settled else None
        values.append(Value(name, value_mm, u, k * u, k, budget, trial, good, []))
    point = task.touched.kind == "point" and all(determined) and math.isinf(task.degrees_of_freedom)
    return Assessment(
        kind=task.touched.kind,
        probe=task.probe,
        readings=len(task.q_rad),
        p=task.p,
        values=values,
        covariance_mm2=covariance,
        region=ellipsoid(found.values_mm, covariance, task.p) if point else None,
        parameters_from="covariance" if study is None else "recalibrations",
        left_out=_left_out(arm, task, found.exact),
        seed=seed,
        most_trials=most_trials,
    )


def _degrees_of_freedom(budget: dict[str, float], task: Task) -> float:
    """Effective ones of a value: what the calibration estimated, beside what was stated."""
    if math.isinf(task.degrees_of_freedom) or not any(budget.values()):
        return math.inf
    each = [task.degrees_of_freedom if source == "parameters" else math.inf for source in budget]
    return effective_degrees_of_freedom(np.array(list(budget.values())), np.array(each))


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

    return [of(value) for value in range(len(task.touched.measurand.names))]


def _from_covariance(arm: Arm, degrees_of_freedom: float, seed: int) -> Sets:
    """Normal; where the covariance was scaled by the calibration's own scatter, multivariate t (JCGM 101 6.4.9)."""
    known = arm.uncertainty
    assert known is not None
    covariance = known.over(arm.parameter_names)
    # a covariance is singular along what is held or open: its root by eigenvectors, of what is scaled alike
    scale = np.sqrt(np.maximum(np.diag(covariance), 0.0))
    scale[scale == 0.0] = 1.0
    sizes, vectors = np.linalg.eigh(covariance / np.outer(scale, scale))
    root = scale[:, None] * vectors * np.sqrt(np.maximum(sizes, 0.0))
    mean = arm.parameters

    def sets(first: int, count: int) -> F64:
        off: F64 = in_blocks(first, count, seed, 2, mean.shape) @ root.T
        if math.isfinite(degrees_of_freedom):
            scatter = chi_squared_in_blocks(first, count, seed, 3, degrees_of_freedom)
            off *= np.sqrt(degrees_of_freedom / scatter)[:, None]
        return mean + off

    return sets


def _from_study(study: Study, arm: Arm, seed: int, workers: Workers) -> Sets:
    if study.noise is None:
        raise UlnaInputError(
            f"{study.label}: calibrations are repeated on noise drawn anew, but no noise is stated; expected [noise]. "
            "State it, or leave the study out: then parameters are drawn from the result's covariance."
        )

    def sets(first: int, count: int) -> F64:
        pieces = [(k, min(PIECE_RUNS, first + count - k)) for k in range(first, first + count, PIECE_RUNS)]
        done = recalibrated(study, arm, seed, pieces, workers)
        lost = sum(int((~piece["converged"]).sum()) for piece in done.values())
        if lost:
            raise UlnaInputError(
                f"{study.label}: {lost} of {count} calibrations on new noise did not converge; expected all, else "
                "their figures mean nothing. Look at the calibration itself, or leave the study out."
            )
        return np.concatenate([done[number]["parameters"] for number in range(len(pieces))])[:, : len(arm.parameters)]

    return sets


def _left_out(arm: Arm, task: Task, exact: list[str]) -> list[str]:
    """What is not in the figures, in words."""
    left = []
    if exact:
        left.append(f"parameters that the calibration held, which count as exact: {', '.join(exact)}")
    if task.encoder_rad is None:
        left.append("the encoders' noise while measuring: nobody stated it")
    if task.seat_mm is None:
        left.append("how well a touch finds its place (a seat, a surface): nobody stated it")
    if "link-expansion" not in arm.extras:
        left.append("links that grow with temperature: the arm's model has none")
    elif not task.u_temperature_k:
        left.append("the uncertainty of the temperature: nobody stated it")
    if "encoder-harmonics" not in arm.extras:
        left.append("eccentric encoders: the arm's model has none")
    if "compliance" not in arm.extras:
        left.append("joints that give way under load: the arm's model has none")
    left.append("the form and the temperature of what is measured")
    left.append("errors of the calibration's artefact beyond the u that its study states")
    return left


def not_determined(value: Value) -> str:
    """In a sentence, why a value has no uncertainty and what would help."""
    first = value.not_determined[0]
    because, remedy = (first[key].rstrip(".") for key in ("because", "remedy"))
    names = ", ".join(worth_naming(first["combination"]))
    return f"{value.name} depends on {names}, which the calibration left open. Why: {because}. Remedy: {remedy}."
