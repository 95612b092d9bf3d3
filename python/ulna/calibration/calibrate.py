"""Calibrate: find the arm that explains a study's readings, with what is known of each parameter and what is not."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Callable
from datetime import UTC, datetime
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ulna.arm.covariance import ParameterCovariance
from ulna.calibration.estimators import Searched, search_box
from ulna.calibration.extras import judge_extras
from ulna.calibration.figures import figures
from ulna.calibration.identify import Identification
from ulna.calibration.outliers import outliers
from ulna.calibration.provenance import provenance
from ulna.calibration.residuals import residual_table
from ulna.calibration.result import FitSummary, Parameter, Result
from ulna.calibration.running import run_assembled
from ulna.study.assembly import Assembled, assemble
from ulna.study.options import with_options
from ulna.study.study import Study

if TYPE_CHECKING:
    import ulna._core as _core

F64 = NDArray[np.float64]
Progress = Callable[[str, int, int], None]


def calibrate(study: Study, progress: Progress | None = None, **overrides: Any) -> Result:
    """Fit the study's arm to its readings.

    `overrides` replace fields of `study.fit` (``hold=["joint.6.*"]``, ``start="search"``, ``seed=1`` …).
    `progress` is called about ten times a second with (stage, done, total).

    The result says in `fit.converged` whether the fit ended well: that is no error. Raises UlnaInputError for what
    cannot be asked (fewer observations than unknowns, a pattern that matches nothing); KeyboardInterrupt.
    """
    study = with_options(study, **overrides)
    began = time.perf_counter()
    assembled = assemble(study)
    searched = search_box(study, assembled, progress) if study.fit.method != "lm" else None
    fitted = run_assembled(study, assembled, progress, None if searched is None else searched.parameters)
    identification = Identification.from_core(fitted.identifiability)
    covariance = _covariance(study, assembled, fitted, identification)
    of_arm = len(assembled.arm.parameter_names)
    arm = assembled.arm.with_signs(fitted.arm.signs).with_parameters(fitted.parameters[:of_arm])
    artefacts, after = figures(arm, study)
    _, before = figures(assembled.arm, study)
    residuals = residual_table(study, fitted)
    extras = judge_extras(study, progress) if study.fit.extras and study.fit.judge_extras else []
    seconds = time.perf_counter() - began
    return Result(
        arm=dataclasses.replace(arm, uncertainty=covariance.of(assembled.arm.parameter_names)),
        parameters=_parameters(assembled, fitted, covariance, identification),
        covariance=covariance,
        identifiability=identification,
        fit=_summary(study, fitted, searched),
        residuals=residuals,
        outliers=outliers(residuals),
        extras=extras,
        artefacts=artefacts,
        before=before,
        after=after,
        provenance=provenance(study, datetime.now(UTC), seconds),
    )


def _summary(study: Study, fitted: _core.Fitted, searched: Searched | None) -> FitSummary:
    return FitSummary.from_core(
        fitted,
        readings=sum(len(group) for group in study.readings),
        method=study.fit.method,
        loss=study.fit.loss,
        box_evaluations=0 if searched is None else searched.evaluations,
        scatter={group.artefact.name: scale for group, scale in zip(study.readings, fitted.scales, strict=True)},
    )


def _covariance(
    study: Study, assembled: Assembled, fitted: _core.Fitted, identification: Identification
) -> ParameterCovariance:
    """Of the fitted parameters, and of held ones that an earlier calibration left uncertain.

    What is not known of a held parameter passes on to those fitted around it: with S = ∂(fitted)/∂(held), C_fitted
    grows by S C_held Sᵀ and the two are correlated by S C_held (consider covariance, Schmidt 1966).
    """
    import ulna._core as _core

    names, hold = assembled.names, assembled.hold
    fitted_names = [names[column] for column in fitted.covariance_columns]
    lost = [dict(direction) for direction in identification.lost]
    known = study.arm.uncertainty
    kept = [k for k, name in enumerate(known.names) if hold[names.index(name)]] if known is not None else []
    if known is None or not kept:
        return ParameterCovariance(fitted_names, fitted.covariance, lost)
    held_names = [known.names[k] for k in kept]
    held = known.matrix[np.ix_(kept, kept)]
    columns = np.array([names.index(name) for name in held_names], dtype=np.int64)
    follow = _core.held_sensitivity(assembled.problem, hold, fitted, columns)
    both = follow @ held
    matrix = np.block([[fitted.covariance + both @ follow.T, both], [both.T, held]])
    earlier = [dict(direction) for direction in known.lost if set(direction["combination"]) & set(held_names)]
    return ParameterCovariance(fitted_names + held_names, matrix, lost + earlier)


def _parameters(
    assembled: Assembled, fitted: _core.Fitted, covariance: ParameterCovariance, identification: Identification
) -> list[Parameter]:
    """Start, value, standard uncertainty, status and prior of every parameter, in their order."""
    names = assembled.names
    u = np.full(len(names), np.nan)
    # rounding may leave a variance that should be zero a hair below it
    u[[names.index(name) for name in covariance.names]] = np.sqrt(np.maximum(np.diag(covariance.matrix), 0.0))
    lost = set(identification.not_determined)
    prior = dict(zip(fitted.covariance_columns.tolist(), fitted.priors.tolist(), strict=True))
    rows = []
    for k, (name, unit) in enumerate(zip(names, assembled.units, strict=True)):
        status = "held" if assembled.hold[k] else "not-determined" if name in lost else "fitted"
        known = status != "not-determined" and np.isfinite(u[k])
        value, prior_u = prior.get(k, (np.nan, np.nan))
        rows.append(
            Parameter(
                name=name,
                unit=unit,
                start=float(fitted.start[k]),
                value=float(fitted.parameters[k]),
                u=float(u[k]) if known else None,
                status=status,
                prior={"value": value, "u": prior_u} if np.isfinite(prior_u) else None,
            )
        )
    return rows
