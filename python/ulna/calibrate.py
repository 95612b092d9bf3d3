"""Calibrate: find the arm that explains a study's readings, with what is known of each parameter and what is not."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ulna.errors import UlnaInputError, nearest
from ulna.figures import figures
from ulna.identify import Identification
from ulna.model import ParameterCovariance
from ulna.provenance import provenance
from ulna.residuals import residual_table
from ulna.result import FitSummary, Parameter, Result
from ulna.study import FitOptions, Study

if TYPE_CHECKING:
    from ulna import _core

Progress = Callable[[str, int, int], None]


def calibrate(study: Study, progress: Progress | None = None, **overrides: Any) -> Result:
    """Fit the study's arm to its readings.

    `overrides` replace fields of `study.fit` (``hold=["joint.6.*"]``, ``start="search"``, ``seed=1`` …).
    `progress` is called about ten times a second with (stage, done, total).

    The result says in `fit.converged` whether the fit ended well: that is no error. Raises UlnaInputError for what
    cannot be asked (fewer observations than unknowns, a pattern that matches nothing); KeyboardInterrupt.
    """
    study = with_options(study, **overrides)
    hold = study.hold_mask()
    began = time.perf_counter()
    problem = study.problem()
    fitted = _fit(study, problem, hold, progress)
    seconds = time.perf_counter() - began
    arm = study.arm.with_parameters(fitted.parameters)
    identification = Identification.from_core(fitted.identifiability)
    covariance = _covariance(study, problem, fitted, hold, identification)
    artefacts, after = figures(arm, study)
    _, before = figures(study.arm, study)
    return Result(
        arm=dataclasses.replace(arm, uncertainty=covariance),
        parameters=_parameters(study, fitted, hold, covariance, identification),
        covariance=covariance,
        identifiability=identification,
        fit=FitSummary.from_core(fitted, sum(len(group) for group in study.readings)),
        residuals=residual_table(study, fitted),
        artefacts=artefacts,
        before=before,
        after=after,
        provenance=provenance(study, datetime.now(UTC), seconds),
    )


def with_options(study: Study, **overrides: Any) -> Study:
    """The study with some fields of its `fit` replaced. Raises UlnaInputError for a name that is none."""
    known = [field.name for field in dataclasses.fields(FitOptions)]
    for name in overrides:
        if name not in known:
            raise UlnaInputError(f"calibrate: there is no fit option '{name}'.{nearest(name, known)}")
    study = dataclasses.replace(study, fit=dataclasses.replace(study.fit, **overrides))
    for key, value, only in (("loss", study.fit.loss, "none"), ("extras", study.fit.extras, [])):
        if value != only:
            raise UlnaInputError(
                f"{study.label}: key 'fit.{key}': {value!r} comes with a later version; expected {only!r} for now."
            )
    limits = (("seed", study.fit.seed, 2**63 - 1), ("max_iterations", study.fit.max_iterations, 1_000_000))
    for name, number, most in limits:
        if not 0 <= number <= most:
            raise UlnaInputError(f"{study.label}: key 'fit.{name}': {number}; expected a whole number, 0 to {most}.")
    if study.fit.start not in ("given", "search"):
        raise UlnaInputError(
            f"{study.label}: key 'fit.start': {study.fit.start!r}; expected 'given' or 'search'."
            f"{nearest(str(study.fit.start), ('given', 'search'))}"
        )
    return study


def run_fit(study: Study, hold: NDArray[np.bool_], progress: Progress | None = None) -> _core.Fitted:
    """The core's fit with the study's options; its complaints as UlnaInputError, naming the study."""
    return _fit(study, study.problem(), hold, progress)


def _fit(study: Study, problem: _core.Problem, hold: NDArray[np.bool_], progress: Progress | None) -> _core.Fitted:
    from ulna import _core

    options = study.fit
    try:
        return _core.fit(
            problem,
            hold,
            start=options.start,
            max_iterations=options.max_iterations,
            seed=options.seed,
            known_length_mm=options.known_length_mm,
            known_angle_rad=options.known_angle_rad,
            progress=progress,
        )
    except _core.UlnaError as error:
        raise UlnaInputError(f"{study.label}: {error}") from None


def _covariance(
    study: Study,
    problem: _core.Problem,
    fitted: _core.Fitted,
    hold: NDArray[np.bool_],
    identification: Identification,
) -> ParameterCovariance:
    """Of the fitted parameters, and of held ones that an earlier calibration left uncertain.

    What is not known of a held parameter passes on to those fitted around it: with S = ∂(fitted)/∂(held), C_fitted
    grows by S C_held Sᵀ and the two are correlated by S C_held (consider covariance, Schmidt 1966).
    """
    from ulna import _core

    names = study.arm.parameter_names
    fitted_names = [names[column] for column in fitted.covariance_columns]
    lost = [dict(direction) for direction in identification.lost]
    known = study.arm.uncertainty
    kept = [k for k, name in enumerate(known.names) if hold[names.index(name)]] if known is not None else []
    if known is None or not kept:
        return ParameterCovariance(fitted_names, fitted.covariance, lost)
    held_names = [known.names[k] for k in kept]
    held = known.matrix[np.ix_(kept, kept)]
    columns = np.array([names.index(name) for name in held_names], dtype=np.int64)
    follow = _core.held_sensitivity(problem, hold, fitted, columns)
    both = follow @ held
    matrix = np.block([[fitted.covariance + both @ follow.T, both], [both.T, held]])
    earlier = [dict(direction) for direction in known.lost if set(direction["combination"]) & set(held_names)]
    return ParameterCovariance(fitted_names + held_names, matrix, lost + earlier)


def _parameters(
    study: Study,
    fitted: _core.Fitted,
    hold: NDArray[np.bool_],
    covariance: ParameterCovariance,
    identification: Identification,
) -> list[Parameter]:
    """Start, value, standard uncertainty and status of every parameter of the arm, in its order."""
    names = study.arm.parameter_names
    u = np.full(len(names), np.nan)
    # rounding may leave a variance that should be zero a hair below it
    u[[names.index(name) for name in covariance.names]] = np.sqrt(np.maximum(np.diag(covariance.matrix), 0.0))
    lost = set(identification.not_determined)
    rows = []
    for k, (name, unit) in enumerate(zip(names, study.arm.parameter_units, strict=True)):
        status = "held" if hold[k] else "not-determined" if name in lost else "fitted"
        known = status != "not-determined" and np.isfinite(u[k])
        rows.append(
            Parameter(
                name=name,
                unit=unit,
                start=float(fitted.start[k]),
                value=float(fitted.parameters[k]),
                u=float(u[k]) if known else None,
                status=status,
            )
        )
    return rows
