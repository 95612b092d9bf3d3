"""Which parameters a study frees, which it holds, and what it knows of them beforehand."""

from __future__ import annotations

import fnmatch
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.conditions import PAYLOAD
from ulna.arm.effects.effect import Effect
from ulna.arm.effects.effects import EFFECTS, effect_named, extra_of, with_extras
from ulna.ground.arrays import Bool
from ulna.ground.errors import UlnaInputError, nearest
from ulna.study.data import FitOptions, StudyData


def start_arm(study: StudyData) -> Arm:
    """The study's arm with zero of the blocks that are asked for beyond what it has. Raises UlnaInputError."""
    arm, extras = study.arm, study.fit.extras
    for extra in extras:
        effect_named(extra).check_asked([joint.effects for joint in arm.joints], arm.name, study.label, arm.heaviest_kg)
    if not extras:
        return arm
    effects = with_extras([joint.effects for joint in arm.joints], extras, study.fit.harmonics)
    joints = [replace(joint, effects=own) for joint, own in zip(arm.joints, effects, strict=True)]
    return replace(arm, joints=tuple(joints))


def remark_vain_payloads(study: StudyData) -> None:
    """Adds a remark where the readings say what was carried, and the model has nothing that gives way to it."""
    said = any(group.payload is not None for group in study.readings)
    if said and PAYLOAD not in start_arm(study).uses:
        study.warnings.append(
            f"{study.label}: the readings say what was carried, but no joint of arm '{study.arm.name}' gives way to "
            'it: the loads are not used. Ask for it, extras = ["compliance"] in [fit], or leave them out.'
        )


def hold_mask(study: StudyData, names: Sequence[str]) -> Bool:
    """(parameters,) true where not fitted: all but `free`, and `hold`; and blocks of the arm that `extras` leaves out.

    names: of the problem's parameters. Raises UlnaInputError for a pattern that matches none of them.
    """
    free = np.zeros(len(names), dtype=bool)
    for value, patterns, key in ((True, study.fit.free, "fit.free"), (False, study.fit.hold, "fit.hold")):
        for pattern in patterns:
            free[matching(study, pattern, names, key)] = value
    asked = [extra_of(name) in (None, *study.fit.extras) and not _of_no_turn(study, name) for name in names]
    hold: Bool = ~(free & np.array(asked, dtype=bool))
    return hold


def _of_no_turn(study: StudyData, name: str) -> bool:
    """Whether a parameter is of what only joints do that turn, and its joint slides."""
    extra = extra_of(name)
    return extra is not None and EFFECTS[extra].of_turn and study.arm.joints[int(name.split(".")[1]) - 1].slides


def matching(study: StudyData, pattern: str, names: Sequence[str], key: str) -> Bool:
    """(parameters,) true where the name matches. Raises UlnaInputError where none does."""
    hits = np.array([fnmatch.fnmatchcase(name, pattern) for name in names], dtype=bool)
    if not hits.any():
        off = next((effect.name for effect in EFFECTS.values() if _is_of(effect, pattern)), None)
        hint = f" Is '{off}' missing in fit.extras?" if off is not None else nearest(pattern, names)
        raise UlnaInputError(
            f"{study.label}: key '{key}': the pattern '{pattern}' matches no parameter of arm '{study.arm.name}'; "
            f"expected a name such as joint.1.theta0 or a pattern such as joint.6.*.{hint}"
        )
    return hits


def _is_of(effect: Effect, pattern: str) -> bool:
    """Whether it asks for parameters of an effect."""
    names = (f"joint.{joint}.{example}" for joint in range(1, 13) for example in effect.examples)
    return any(fnmatch.fnmatchcase(name, pattern) for name in names)


def _of_block(pattern: str) -> bool:
    """Whether it asks for parameters of any effect."""
    return any(_is_of(effect, pattern) for effect in EFFECTS.values())


def names_like(pattern: str, names: Sequence[str]) -> list[str]:
    """Those of the names that match."""
    return [name for name in names if fnmatch.fnmatchcase(name, pattern)]


def without_vain(study: StudyData, names: Sequence[str]) -> FitOptions:
    """The options without patterns of effects that match none of these names: of blocks that were not chosen."""

    def kept(patterns: Sequence[str]) -> list[str]:
        return [each for each in patterns if not _of_block(each) or names_like(each, names)]

    fit = study.fit
    prior = {pattern: fit.prior[pattern] for pattern in kept(list(fit.prior))}
    return replace(fit, hold=kept(fit.hold), free=kept(fit.free), prior=prior)


def priors(
    study: StudyData, names: Sequence[str], units: Sequence[str], values: Sequence[float], hold: Bool
) -> dict[int, tuple[float, float]]:
    """Parameter number → (value, standard deviation), of free parameters. Raises UlnaInputError for a vain pattern."""
    found: dict[int, tuple[float, float]] = {}
    for k, name in enumerate(names):
        extra = extra_of(name)
        u_before = None if extra is None else EFFECTS[extra].prior_u
        if u_before is not None and not hold[k]:
            found[k] = (values[k], u_before)
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
        return [each for each in patterns if not each.startswith(of_artefacts) and not (fit_auto and _of_block(each))]

    fit_auto = study.fit.auto

    fit = replace(
        study.fit,
        free=known(study.fit.free),
        hold=known(study.fit.hold),
        prior={pattern: study.fit.prior[pattern] for pattern in known(list(study.fit.prior))},
    )
    early = replace(study, fit=fit)
    hold_mask(early, names)
    for pattern in fit.prior:
        matching(early, pattern, names, "fit.prior")
