"""Which parameters a study frees, which it holds, and what it knows of them beforehand."""

from __future__ import annotations

import fnmatch
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.effects.effects import extra_of, with_extras
from ulna.ground.arrays import Bool
from ulna.ground.errors import UlnaInputError, nearest
from ulna.study.data import StudyData

HARMONICS_U_RAD = 5e-4
"""The prior of every amplitude of an encoder's harmonics where the study gives none: over a short travel they would
otherwise imitate zero offsets, and each other. Ten times what a good encoder shows, and what robots show."""


def start_arm(study: StudyData) -> Arm:
    """The study's arm with zero of the blocks that are asked for beyond what it has. Raises UlnaInputError."""
    arm, extras = study.arm, study.fit.extras
    if "compliance" in extras and not any(joint.effects.mass_kg for joint in arm.joints):
        raise UlnaInputError(
            f"{study.label}: key 'fit.extras': 'compliance' is how joints give way to the weight of the links, but no "
            f"joint of arm '{arm.name}' has a mass; expected mass (kg) and centre in the arm file's joint tables. Add "
            "them: rough ones will do, the compliance takes their scale."
        )
    if not extras:
        return arm
    joints = [replace(joint, effects=with_extras(joint.effects, extras, study.fit.harmonics)) for joint in arm.joints]
    return replace(arm, joints=tuple(joints))


def hold_mask(study: StudyData, names: Sequence[str]) -> Bool:
    """(parameters,) true where not fitted: all but `free`, and `hold`; and blocks of the arm that `extras` leaves out.

    names: of the problem's parameters. Raises UlnaInputError for a pattern that matches none of them.
    """
    free = np.zeros(len(names), dtype=bool)
    for value, patterns, key in ((True, study.fit.free, "fit.free"), (False, study.fit.hold, "fit.hold")):
        for pattern in patterns:
            free[matching(study, pattern, names, key)] = value
    asked = [extra_of(name) in (None, *study.fit.extras) for name in names]
    hold: Bool = ~(free & np.array(asked, dtype=bool))
    return hold


def matching(study: StudyData, pattern: str, names: Sequence[str], key: str) -> Bool:
    """(parameters,) true where the name matches. Raises UlnaInputError where none does."""
    hits = np.array([fnmatch.fnmatchcase(name, pattern) for name in names], dtype=bool)
    if not hits.any():
        off = next((extra for name, extra in _OF_EXTRAS.items() if fnmatch.fnmatchcase(name, pattern)), None)
        hint = f" Is '{off}' missing in fit.extras?" if off is not None else nearest(pattern, names)
        raise UlnaInputError(
            f"{study.label}: key '{key}': the pattern '{pattern}' matches no parameter of arm '{study.arm.name}'; "
            f"expected a name such as joint.1.theta0 or a pattern such as joint.6.*.{hint}"
        )
    return hits


_OF_EXTRAS = {
    **{
        f"joint.{joint}.{part}{order}": "encoder-harmonics"
        for joint in range(1, 13)
        for part in "cs"
        for order in (1, 2)
    },
    **{f"joint.{joint}.expansion": "link-expansion" for joint in range(1, 13)},
    **{f"joint.{joint}.compliance": "compliance" for joint in range(1, 13)},
}


def priors(
    study: StudyData, names: Sequence[str], units: Sequence[str], values: Sequence[float], hold: Bool
) -> dict[int, tuple[float, float]]:
    """Parameter number → (value, standard deviation), of free parameters. Raises UlnaInputError for a vain pattern."""
    found: dict[int, tuple[float, float]] = {}
    for k, name in enumerate(names):
        if extra_of(name) == "encoder-harmonics" and not hold[k]:
            found[k] = (values[k], HARMONICS_U_RAD)
    for pattern, prior in study.fit.prior.items():
        for k in np.flatnonzero(matching(study, pattern, names, "fit.prior")).tolist():
            if not hold[k]:
                u, value = prior.in_unit(units[k])
                found[k] = (values[k] if value is None else value, u)
    return found


def check_patterns(study: StudyData) -> None:
    """Tell of a vain pattern before the work. Dimensions of artefacts are known only when readings are: such patterns
    are told then. Raises UlnaInputError."""
    names = start_arm(study).parameter_names
    of_artefacts = "artefact."

    def known(patterns: Sequence[str]) -> list[str]:
        return [pattern for pattern in patterns if not pattern.startswith(of_artefacts)]

    fit = replace(
        study.fit,
        free=known(study.fit.free),
        hold=known(study.fit.hold),
        prior={pattern: prior for pattern, prior in study.fit.prior.items() if not pattern.startswith(of_artefacts)},
    )
    early = replace(study, fit=fit)
    hold_mask(early, names)
    for pattern in fit.prior:
        matching(early, pattern, names, "fit.prior")
