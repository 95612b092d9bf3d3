"""How much an orientation counts beside a place, where neither the noise nor a lever is stated.

So much that both scatter alike about the fit (Helmert's estimation of variance components, by medians, which outliers
do not move).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ulna.artefacts.kinds import kind_of
from ulna.artefacts.orientation import target
from ulna.calibration.running import run_assembled
from ulna.ground.arrays import F64, Progress
from ulna.study.assembly import assemble
from ulna.study.options import with_options
from ulna.study.study import Study

ROUNDS = 6
MET = 0.02
"""Levers that change by less than this part are found."""
LIMITS_MM = (1.0, 1e6)
"""What a lever can be: beyond, one of the two is exact."""


def with_levers(study: Study, progress: Progress | None = None) -> Study:
    """The study with the levers that its residuals say; the same where there is none to be found."""
    open_, places = [], []
    for number, group in enumerate(study.readings):
        if not kind_of(group.artefact).turned:
            places.append(number)
        elif target(group.artefact).lever_mm is None:
            open_.append(number)
    if study.noise is not None or not open_ or not places:
        return study
    for _ in range(ROUNDS):
        fitting = with_options(study, extras=[]) if study.fit.auto else study
        fitted = run_assembled(fitting, assemble(fitting), progress)
        place_mm = _scatter([fitted.residuals(number) for number in places])
        readings, changed = list(study.readings), 1.0
        for number in open_:
            group = readings[number]
            own = target(group.artefact)
            ratio = place_mm / max(_scatter([fitted.residuals(number)]), np.finfo(np.float64).tiny)
            lever_mm = float(np.clip(ratio * own.weighs_mm, *LIMITS_MM))
            changed = max(changed, lever_mm / own.weighs_mm, own.weighs_mm / lever_mm)
            readings[number] = replace(group, artefact=replace(group.artefact, own=replace(own, lever_mm=lever_mm)))
        study = replace(study, readings=readings)
        if changed < 1.0 + MET:
            break
    return study


def _scatter(residuals_mm: list[F64]) -> float:
    return float(np.median(np.abs(np.concatenate([each.ravel() for each in residuals_mm]))))
