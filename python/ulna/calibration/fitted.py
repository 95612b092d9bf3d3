"""A fit that has ended, and how each part of its result is made of it when somebody asks for that part."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime
from functools import cached_property
from pathlib import Path
from typing import Any, cast

import numpy as np
import polars as pl

import ulna._core as _core
from ulna.arm.arm import Arm
from ulna.arm.covariance import ParameterCovariance
from ulna.arm.reading_noise import ReadingNoise, noise_of
from ulna.arm.unknown import why_unknown
from ulna.calibration.between_places import BetweenPlaces, between_places
from ulna.calibration.choosing.tried import ChosenModel
from ulna.calibration.estimators import Searched
from ulna.calibration.extras import JudgedExtra
from ulna.calibration.figures import GroupErrors, by_placement, group_errors, over_all, overall_figures
from ulna.calibration.identify import Identification
from ulna.calibration.outliers import outliers
from ulna.calibration.placements import Figures
from ulna.calibration.poses import PlacementPose, placement_poses
from ulna.calibration.provenance import provenance, stated_noise
from ulna.calibration.reading_scatter import reading_scatter
from ulna.calibration.residual_map import ResidualMap, residual_map
from ulna.calibration.residuals import residual_table
from ulna.calibration.summary import FitSummary, Parameter, ReadingScatter, Status, Unit
from ulna.study.assembly import Assembled
from ulna.study.data import FitOptions
from ulna.study.study import Study


@dataclass(frozen=True)
class FittedStudy:
    """A study, what the core made of it, and its result's parts: each made once, when it is first read."""

    study: Study
    assembled: Assembled
    core: _core.Fitted
    searched: Searched | None
    """Of a method without derivatives."""
    extras: list[JudgedExtra]
    when: datetime
    seconds: float
    """What it all took."""
    asked: FitOptions | None = None
    """What the fit was asked for, where the study's blocks were chosen."""
    chosen: ChosenModel | None = None

    @property
    def arm(self) -> Arm:
        """The fitted one, with its uncertainty."""
        return dataclasses.replace(self._arm, uncertainty=self._covariance.of(self.assembled.arm.parameter_names))

    @property
    def noise(self) -> ReadingNoise:
        """How its readings scatter."""
        stated, shown = self.study.noise, self._reading_scatter
        return noise_of(
            None if stated is None else stated_noise(stated),
            None if shown is None else dataclasses.asdict(shown),
            self._arm,
            Path("result"),
        )

    def parts(self) -> dict[str, Callable[[], Any]]:
        """A function for each field of `ulna.calibration.result.Result`."""
        return {
            "arm": lambda: self.arm,
            "parameters": self._parameters,
            "covariance": lambda: self._covariance,
            "identifiability": lambda: self._identification,
            "fit": self._summary,
            "residuals": lambda: self._residuals,
            "artefacts": lambda: by_placement(self._after),
            "placements": self._poses,
            "before": lambda: overall_figures(self.assembled.arm, self.study),
            "after": lambda: over_all(self._after),
            "without_far_off": self._without_far_off,
            "provenance": lambda: provenance(self._as_asked(), self.when, self.seconds),
            "outliers": lambda: outliers(self._residuals, self.study.files) if self._any_outliers() else [],
            "extras": lambda: self.extras,
            "chosen": lambda: self.chosen,
            "residual_map": self._residual_map,
            "study": lambda: self.study,
        }

    def _residual_map(self) -> ResidualMap | None:
        return residual_map(self.study, self._arm, self.core) if self.study.fit.judge else None

    def _as_asked(self) -> Study:
        return self.study if self.asked is None else dataclasses.replace(self.study, fit=self.asked)

    @cached_property
    def _arm(self) -> Arm:
        start = self.assembled.arm
        parameters = self.core.parameters[: len(start.parameter_names)]
        return start.with_signs(self.core.arm.signs).with_parameters(parameters)

    @cached_property
    def _identification(self) -> Identification:
        return Identification.from_core(self.core.identifiability)

    @cached_property
    def _after(self) -> list[GroupErrors]:
        return group_errors(self._arm, self.study)

    @cached_property
    def _residuals(self) -> pl.DataFrame:
        return residual_table(self.study, self.core)

    def _poses(self) -> list[PlacementPose]:
        core = self.core
        of_parameters = self._covariance.of(self.assembled.arm.parameter_names)
        residuals = [core.residuals(group) for group in range(len(self.study.readings))]
        return placement_poses(self._arm, self.study, residuals, of_parameters, core.variance)

    def _without_far_off(self) -> Figures | None:
        if self.study.fit.loss == "none" or not self._any_outliers():
            return None
        groups = [
            group.select(~self.core.outliers(number))
            for number, group in enumerate(self.study.readings)
            if not self.core.outliers(number).all()
        ]
        return overall_figures(self._arm, dataclasses.replace(self.study, readings=groups))

    def _any_outliers(self) -> bool:
        return any(self.core.outliers(group).any() for group in range(len(self.study.readings)))

    def _summary(self) -> FitSummary:
        study = self.study
        return FitSummary.from_core(
            self.core,
            readings=sum(len(group) for group in study.readings),
            method=study.fit.method,
            loss=study.fit.loss,
            signs_found=self._signs_found(),
            box_evaluations=0 if self.searched is None else self.searched.evaluations,
            reading_scatter=self._reading_scatter,
            scatter={group.artefact.name: scale for group, scale in zip(study.readings, self.core.scales, strict=True)},
        )

    def _signs_found(self) -> dict[str, int]:
        found = zip(self.study.arm.unknown_signs.tolist(), self.core.arm.signs.tolist(), strict=True)
        return {f"joint.{k}.sign": int(sign) for k, (unknown, sign) in enumerate(found, 1) if unknown}

    @cached_property
    def _between(self) -> BetweenPlaces | None:
        return between_places(self.study, self._arm, self.assembled, self.core)

    @cached_property
    def _reading_scatter(self) -> ReadingScatter | None:
        return reading_scatter(self.core, self.study, self._between)

    @cached_property
    def _covariance(self) -> ParameterCovariance:
        """Of the fitted parameters, and of held ones that an earlier calibration left uncertain.

        What is not known of a held parameter passes on to those fitted around it: with S = ∂(fitted)/∂(held), C_fitted
        grows by S C_held Sᵀ and the two are correlated by S C_held (consider covariance, Schmidt 1966).
        """
        fitted = self.core
        of_fitted = fitted.covariance * (1.0 if self._between is None else self._between.factor**2)
        names, hold = self.assembled.names, self.assembled.hold
        fitted_names = [names[column] for column in fitted.covariance_columns]
        lost = [dict(direction) for direction in self._identification.lost]
        fit = {key: getattr(fitted, key) for key in ("observations", "placement_unknowns", "degrees_of_freedom")}
        fit["loss"] = self.study.fit.loss
        known = self.study.arm.uncertainty
        kept = [k for k, name in enumerate(known.names) if hold[names.index(name)]] if known is not None else []
        if known is None or not kept:
            return ParameterCovariance(fitted_names, of_fitted, lost, why_unknown(fit))
        held_names = [known.names[k] for k in kept]
        held = known.matrix[np.ix_(kept, kept)]
        columns = np.array([names.index(name) for name in held_names], dtype=np.int64)
        follow = _core.held_sensitivity(self.assembled.problem, hold, fitted, columns)
        both = follow @ held
        matrix = np.block([[of_fitted + both @ follow.T, both], [both.T, held]])
        earlier = [dict(direction) for direction in known.lost if set(direction["combination"]) & set(held_names)]
        return ParameterCovariance(fitted_names + held_names, matrix, lost + earlier, why_unknown(fit))

    def _parameters(self) -> list[Parameter]:
        """Start, value, standard uncertainty, status and prior of every parameter, in their order."""
        names, hold, covariance = self.assembled.names, self.assembled.hold, self._covariance
        u = np.full(len(names), np.nan)
        # rounding may leave a variance that should be zero a hair below it
        u[[names.index(name) for name in covariance.names]] = np.sqrt(np.maximum(np.diag(covariance.matrix), 0.0))
        lost = set(self._identification.not_determined)
        prior = dict(zip(self.core.covariance_columns.tolist(), self.core.priors.tolist(), strict=True))
        start, value = self.core.start.tolist(), self.core.parameters.tolist()
        rows = []
        for k, (name, unit) in enumerate(zip(names, self.assembled.units, strict=True)):
            status: Status = "held" if hold[k] else "not-determined" if name in lost else "fitted"
            known = status != "not-determined" and np.isfinite(u[k])
            prior_value, prior_u = prior.get(k, (np.nan, np.nan))
            rows.append(
                Parameter(
                    name=name,
                    unit=cast(Unit, unit),
                    start=start[k],
                    value=value[k],
                    u=float(u[k]) if known else None,
                    status=status,
                    prior={"value": prior_value, "u": prior_u} if np.isfinite(prior_u) else None,
                )
            )
        return rows
