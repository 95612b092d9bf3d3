"""Running the core's fit on a study; its complaints name the study."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ulna.ground.arrays import Progress
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import recalled, templates, worded
from ulna.study.assembly import Assembled, assemble
from ulna.study.study import Study

if TYPE_CHECKING:
    import ulna._core as _core

SEARCH_STARTS = 2000
"""From where other minima are looked for: the core's own number."""

NO_FIT = templates(
    "the readings give {equations} equations for {unknowns} unknowns ({parameters} parameters that these readings "
    "could determine and {places} of placements): take more readings (at least {missing}), or hold parameters",
    "there are no readings",
    "touches so far",
)
"""Why there is no fit, as the core says it, and of which touches."""


def run_fit(
    study: Study, hold: Callable[[list[str]], NDArray[np.bool_]] | None = None, progress: Progress | None = None
) -> _core.Fitted:
    """The core's fit with the study's options. hold: what is held, by names, in place of what the study says.

    Raises UlnaInputError.
    """
    return run_assembled(study, assemble(study, hold), progress)


def run_assembled(
    study: Study,
    assembled: Assembled,
    progress: Progress | None = None,
    from_parameters: NDArray[np.float64] | None = None,
    search: bool = True,
) -> _core.Fitted:
    """The same, of a study that is in the core already; from other parameters than the arm file's where given. search:
    whether a poor minimum is left for others, which may take seconds."""
    import ulna._core as _core

    options = study.fit
    unknown = study.arm.unknown_signs
    if unknown.any():
        _check_signs(study, assembled, unknown)
    try:
        return _core.fit(
            assembled.problem,
            assembled.hold,
            start=options.start,
            max_iterations=options.max_iterations,
            seed=options.seed,
            search_starts=SEARCH_STARTS if search else 0,
            known_length_mm=options.known_length_mm,
            known_angle_rad=options.known_angle_rad,
            progress=progress,
            unknown_signs=unknown if unknown.any() else None,
            from_parameters=from_parameters,
            poor_above_mm=options.poor_above_mm,
        )
    except _core.UlnaError as error:
        why = recalled(str(error), NO_FIT)
        raise UlnaInputError(worded("{of}: {why}", of=recalled(study.label, NO_FIT), why=why)) from None


def _check_signs(study: Study, assembled: Assembled, unknown: NDArray[np.bool_]) -> None:
    """A sign is found together with the geometry around it, so that must be free. Raises UlnaInputError."""
    joint = int(np.flatnonzero(unknown)[0]) + 1
    names = [name for name in assembled.names if name.startswith((f"joint.{joint}.", "joint.1.theta0"))]
    held = [name for name in names if assembled.hold[assembled.names.index(name)]]
    of_joint = [name for name in held if name.startswith(f"joint.{joint}.") and name.endswith(("theta0", "alpha"))]
    if of_joint or assembled.hold.all():
        raise UlnaInputError(
            f"{study.label}: arm '{study.arm.name}': joint.{joint}.sign is 0 (not known), but "
            f"{', '.join(of_joint) or 'every parameter'} is held; expected its sign, or its theta0 and alpha free: "
            "signs are found with them. State the sign, or calibrate."
        )
