"""Cross-validate: refit with each group of readings left out, and see how well the arm explains what was left out.

"before" is the start arm with its probes fitted to the training readings, so that a probe whose tip nobody measured
is not counted against the arm; "after" is the arm fitted to the training readings. Both are judged on the readings
left out, by the figures of `ulna.calibration.figures`.
"""

from __future__ import annotations

import dataclasses
import json
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ulna.calibration.about import about_cross_validation
from ulna.calibration.choosing.choose import choose, start_of
from ulna.calibration.coverage import Coverage, Judged
from ulna.calibration.figures import over_groups, overall_figures
from ulna.calibration.fitted import FittedStudy
from ulna.calibration.folds import Fold, folds
from ulna.calibration.held_out import judged
from ulna.calibration.levers import with_levers
from ulna.calibration.likely import Cause, likely_causes, together
from ulna.calibration.placements import FigureEntry, Figures
from ulna.calibration.provenance import provenance
from ulna.calibration.result_file import CrossValidationFile, ProvenanceEntry
from ulna.calibration.running import run_assembled, run_fit
from ulna.calibration.summary import GroupFigures
from ulna.formats.output import output_folder
from ulna.ground.arrays import Progress
from ulna.ground.errors import UlnaInputError
from ulna.ground.shown import About, Shown
from ulna.study.assembly import assemble
from ulna.study.given import StudyLike, as_study
from ulna.study.options import with_options
from ulna.study.parameters import hold_mask
from ulna.study.study import Study

FORMAT: Literal["ulna-cross-validation/1"] = "ulna-cross-validation/1"
FILES = ("cross-validation.json",)


@dataclass(repr=False)
class CrossValidation(Shown):
    """How well arms fitted without a group explain that group."""

    by: str
    """What a group is: "placement", "artefact" or "K folds of placements" (or "of readings")."""
    groups: list[GroupFigures]
    before: Figures
    """Over all groups: mean of the groups' means, root mean square of their rms, largest of their maxima."""
    after: Figures
    provenance: dict[str, Any]
    coverage: Coverage | None = None
    """Whether the uncertainties that each fit states hold on what was left out."""

    @property
    def converged(self) -> bool:
        """Whether the fits of all groups ended well."""
        return all(group.converged for group in self.groups)

    def as_dict(self) -> dict[str, Any]:
        """`cross-validation.json`: JSON types only, no NaN."""
        return CrossValidationFile.model_construct(
            format=FORMAT,
            by=self.by,
            groups=self.groups,
            before=FigureEntry.model_construct(None, **self.before),
            after=FigureEntry.model_construct(None, **self.after),
            provenance=ProvenanceEntry.model_construct(None, **self.provenance),
            coverage=self.coverage,
        ).model_dump(mode="json", exclude_unset=True)

    def about(self) -> About:
        """Over all groups."""
        return about_cross_validation(self.by, self.groups, self.before, self.after, self.coverage)

    def save(self, folder: str | Path, force: bool = False) -> None:
        """Write `cross-validation.json` into a folder. Raises UlnaInputError."""
        with output_folder(folder, FILES, force) as staging:
            text = json.dumps(self.as_dict(), indent=1, ensure_ascii=False, allow_nan=False)
            (staging / FILES[0]).write_text(text + "\n", encoding="utf-8")


def cross_validate(
    study: StudyLike,
    by: str | int = "placement",
    progress: Progress | None = None,
    **overrides: Any,
) -> CrossValidation:
    """Leave each group out once, fit the rest, judge what was left out.

    `by`: each placement of each artefact; each artefact; or a number of random folds (2 or more), dealt by
    `study.fit.seed`. `overrides` replace fields of `study.fit`. Raises UlnaInputError, KeyboardInterrupt.
    """
    study = with_levers(with_options(as_study(study), **overrides))
    how, left_out = folds(study, by)
    groups, held, likely = [], [], []
    for number, fold in enumerate(left_out):
        if progress is not None:
            progress("groups left out", number, len(left_out))
        group, inside, causes = _judge(study, fold)
        groups.append(group)
        held.append(inside)
        likely.append(causes)
    if progress is not None:
        progress("groups left out", len(left_out), len(left_out))
    return CrossValidation(
        by=how,
        groups=groups,
        before=over_groups(group.before for group in groups),
        after=over_groups(group.after for group in groups),
        provenance=provenance(study, datetime.now(UTC)),
        coverage=Judged.together(held).coverage(together(likely)),
    )


def _judge(study: Study, fold: Fold) -> tuple[GroupFigures, Judged, list[Cause]]:
    """Of one group left out: its figures, whether what the fit to the others states holds, and why it may not."""
    training = study.subset([~mask for mask in fold.masks])
    test = study.subset(fold.masks)

    def all_but_probes(names: list[str]) -> NDArray[np.bool_]:
        held: NDArray[np.bool_] = np.array([not name.startswith("probe.") for name in names])
        return hold_mask(study, names) | held

    try:
        # chosen anew: what is left out has no say in the model either
        choice = choose(training) if training.fit.auto else None
        training = training if choice is None else choice.study
        assembled = assemble(training)
        start_arm = assembled.arm
        begin = None if choice is None else start_of(choice, assembled)
        fitted = run_assembled(training, assembled, None, begin, search=begin is None)
        given = dataclasses.replace(training, fit=dataclasses.replace(training.fit, start="given"))
        # signs that nobody knows are those that were found
        start = run_fit(given.with_arm(given.arm.with_signs(fitted.arm.signs)), all_but_probes)
    except UlnaInputError as error:
        raise UlnaInputError(f"without {fold.name} ({fold.rows} readings left out): {error}") from None
    arm = start_arm.with_signs(fitted.arm.signs)
    of_arm = len(arm.parameter_names)
    before = overall_figures(arm.with_parameters(start.parameters[:of_arm]), test)
    after = overall_figures(arm.with_parameters(fitted.parameters[:of_arm]), test)
    found = FittedStudy(training, assembled, fitted, None, [], datetime.now(UTC), 0.0)
    group = GroupFigures(
        group=fold.name,
        readings=fold.rows,
        before=before,
        after=after,
        converged=fitted.converged,
        termination=fitted.termination,
        lost=[dict(direction) for direction in fitted.identifiability.lost],
    )
    arm, noise = found.arm, found.noise
    return group, judged(arm, noise, test), likely_causes(arm, noise, test, elsewhere=False)
