"""Cross-validate: refit with each group of readings left out, and see how well the arm explains what was left out.

"before" is the start arm with its probes fitted to the training readings, so that a probe whose tip nobody measured
is not counted against the arm; "after" is the arm fitted to the training readings. Both are judged on the readings
left out, by the figures of `ulna.figures`.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ulna.calibrate import run_fit, with_options
from ulna.errors import UlnaInputError
from ulna.figures import Figures, figures, over_groups
from ulna.files.output import output_folder
from ulna.folds import Fold, folds
from ulna.provenance import provenance
from ulna.study import Study

FORMAT = "ulna-cross-validation/1"
FILES = ("cross-validation.json",)
Progress = Callable[[str, int, int], None]


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

    def as_dict(self) -> dict[str, Any]:
        """As in `cross-validation.json`, list `groups`."""
        return dataclasses.asdict(self)


@dataclass
class CrossValidation:
    """How well arms fitted without a group explain that group."""

    by: str
    """What a group is: "placement", "artefact" or "K folds of placements" (or "of readings")."""
    groups: list[GroupFigures]
    before: Figures
    """Over all groups: mean of the groups' means, root mean square of their rms, largest of their maxima."""
    after: Figures
    provenance: dict[str, Any]

    @property
    def converged(self) -> bool:
        """Whether the fits of all groups ended well."""
        return all(group.converged for group in self.groups)

    def as_dict(self) -> dict[str, Any]:
        """`cross-validation.json`: JSON types only, no NaN."""
        return {
            "format": FORMAT,
            "by": self.by,
            "groups": [group.as_dict() for group in self.groups],
            "before": self.before,
            "after": self.after,
            "provenance": self.provenance,
        }

    def save(self, folder: str | Path, force: bool = False) -> None:
        """Write `cross-validation.json` into a folder. Raises UlnaInputError."""
        with output_folder(folder, FILES, force) as staging:
            text = json.dumps(self.as_dict(), indent=1, ensure_ascii=False, allow_nan=False)
            (staging / FILES[0]).write_text(text + "\n", encoding="utf-8")


def cross_validate(
    study: Study,
    by: str | int = "placement",
    progress: Progress | None = None,
    **overrides: Any,
) -> CrossValidation:
    """Leave each group out once, fit the rest, judge what was left out.

    `by`: each placement of each artefact; each artefact; or a number of random folds (2 or more), dealt by
    `study.fit.seed`. `overrides` replace fields of `study.fit`. Raises UlnaInputError, KeyboardInterrupt.
    """
    study = with_options(study, **overrides)
    hold = study.hold_mask()
    names = study.arm.parameter_names
    hold_all_but_probes = hold | np.array([not name.startswith("probe.") for name in names])
    how, left_out = folds(study, by)
    groups = []
    for number, fold in enumerate(left_out):
        if progress is not None:
            progress("groups left out", number, len(left_out))
        groups.append(_judge(study, fold, hold, hold_all_but_probes))
    if progress is not None:
        progress("groups left out", len(left_out), len(left_out))
    return CrossValidation(
        by=how,
        groups=groups,
        before=over_groups(group.before for group in groups),
        after=over_groups(group.after for group in groups),
        provenance=provenance(study, datetime.now(UTC)),
    )


def _judge(study: Study, fold: Fold, hold: NDArray[np.bool_], hold_all_but_probes: NDArray[np.bool_]) -> GroupFigures:
    training = study.subset([~mask for mask in fold.masks])
    test = study.subset(fold.masks)
    given = dataclasses.replace(training, fit=dataclasses.replace(training.fit, start="given"))
    try:
        start = run_fit(given, hold_all_but_probes)
        fitted = run_fit(training, hold)
    except UlnaInputError as error:
        raise UlnaInputError(f"without {fold.name} ({fold.rows} readings left out): {error}") from None
    _, before = figures(study.arm.with_parameters(start.parameters), test)
    _, after = figures(study.arm.with_parameters(fitted.parameters), test)
    return GroupFigures(
        group=fold.name,
        readings=fold.rows,
        before=before,
        after=after,
        converged=fitted.converged,
        termination=fitted.termination,
        lost=[dict(direction) for direction in fitted.identifiability.lost],
    )
