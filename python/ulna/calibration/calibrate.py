"""Calibrate: find the arm that explains a study's readings, with what is known of each parameter and what is not."""

from __future__ import annotations

import time
from datetime import UTC, datetime
from typing import Any

from ulna.calibration.choosing.choose import choose, start_of
from ulna.calibration.estimators import search_box
from ulna.calibration.extras import judge_extras
from ulna.calibration.fitted import FittedStudy
from ulna.calibration.levers import with_levers
from ulna.calibration.result import Result
from ulna.calibration.running import run_assembled
from ulna.ground.arrays import Progress
from ulna.ground.extras import need
from ulna.study.assembly import assemble
from ulna.study.given import StudyLike, as_study
from ulna.study.options import with_options


def calibrate(study: StudyLike, progress: Progress | None = None, **overrides: Any) -> Result:
    """Fit the study's arm to its readings. `study`: a study, a study file or the folder with it.

    `overrides` replace fields of `study.fit` (``hold=["joint.6.*"]``, ``start="search"``, ``seed=1`` …).
    `progress` is called about ten times a second with (stage, done, total).

    The result says in `fit.converged` whether the fit ended well: that is no error. Its tables and figures are made of
    the study's arrays when they are first read: leave those as they are until then. Raises UlnaInputError for what
    cannot be asked (fewer observations than unknowns, a pattern that matches nothing); KeyboardInterrupt.
    """
    asked = with_options(as_study(study), **overrides)
    began = time.perf_counter()
    if asked.fit.judge:
        need(f"{asked.label}: key 'fit.judge'", "sklearn")
    asked = with_levers(asked, progress)
    choice = choose(asked, progress) if asked.fit.auto else None
    study = asked if choice is None else choice.study
    assembled = assemble(study)
    searched = search_box(study, assembled, progress) if study.fit.method != "lm" else None
    start = None if searched is None else searched.parameters
    if choice is not None:
        start = start_of(choice, assembled)
    # a choice began with a fit of the geometry, which has looked for other minima where it had to
    looked = choice is not None and start is not None
    fitted = run_assembled(study, assembled, progress, start, search=not looked)
    extras = judge_extras(study, progress) if study.fit.extras and study.fit.judge_extras else []
    ended, seconds = datetime.now(UTC), time.perf_counter() - began
    of_choice = (asked.fit, None if choice is None else choice.model)
    return Result.on_demand(FittedStudy(study, assembled, fitted, searched, extras, ended, seconds, *of_choice).parts())
