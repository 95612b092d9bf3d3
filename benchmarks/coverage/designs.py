"""Where a case's artefacts stand, the study of them, and the drawing that a calibration starts from."""

import dataclasses
import zlib
from fnmatch import fnmatchcase
from functools import lru_cache
from typing import Any

import numpy as np

import ulna
from benchmarks.coverage.arms import ARMS, TrueArm
from benchmarks.coverage.cases import CASES, Case
from benchmarks.coverage.touching import Placed, rows_of

EFFECTS_KNOWN = {"joint.*.[cs][0-9]*": 5e-4, "joint.*.backlash": 5e-4}
"""What Ulna takes as known of effects where a study says nothing, rad (docs/concepts/effects.md)."""
WRONG = {"rad": 0.005, "mm": 0.5}
"""How far off a drawing may be of which nothing is known."""
GEOMETRY = (".theta0", ".alpha", ".a", ".d", ".beta", ".x", ".y", ".z")
"""Ends of names of parameters that are no effects."""


@dataclasses.dataclass(frozen=True)
class Design:
    """Where artefacts stand, and the study with the readings of one calibration."""

    true: TrueArm
    arm: ulna.Arm
    """The truth."""
    told: ulna.Arm
    """What of it the study can be right about."""
    placed: list[Placed]
    study: ulna.Study


PLACED: dict[str, list[Placed]] = {}
"""Looked for once: cases with the same arm touch the same."""


def places(case: Case, true: TrueArm, number: int) -> list[Placed]:
    """Where a case's artefacts stand."""
    key = f"{case.arm} {case.touched!r} {number}"
    if key not in PLACED:
        rng = np.random.default_rng(zlib.crc32(key.encode()))
        PLACED[key] = [artefact.place(true, rng) for artefact in case.touched]
    return PLACED[key]


@lru_cache(maxsize=8)
def design(name: str, number: int) -> Design:
    """Of a case."""
    case = CASES[name]
    true = ARMS[case.arm]()
    arm = true.in_ulna()
    placed = places(case, true, number)
    told = without_effects(arm) if case.lacking else arm
    fit = {"judge_extras": False, **case.fit, "prior": {key: ulna.Prior(u) for key, u in case.priors.items()}}
    stated: dict[str, Any] = {}
    if case.states is not None:
        stated = {
            "encoder_u_rad": case.states * case.errors.encoder_rad,
            "seat_u_mm": case.states * case.errors.touch_mm,
        }
    studies = []
    for each in placed:
        frame = rows_of(each, np.split(each.readings, each.poses))
        table = {each.name: each.table}
        studies.append(ulna.Study.from_frame(told, frame, table, angle="rad", length_unit="mm", **stated, **fit))
    readings = [group for study in studies for group in study.readings]
    return Design(true, arm, told, placed, dataclasses.replace(studies[0], readings=readings))


def without_effects(arm: ulna.Arm) -> ulna.Arm:
    """Geometry alone."""
    return dataclasses.replace(arm, joints=tuple(dataclasses.replace(j, effects=ulna.Effects()) for j in arm.joints))


def drawing(case: Case, arm: ulna.Arm, rng: np.random.Generator) -> ulna.Arm:
    """Where a calibration starts from."""
    values = arm.parameters.copy()
    known = (EFFECTS_KNOWN if case.effects_drawn else {}) | dict(case.priors)
    for k, (name, unit) in enumerate(zip(arm.parameter_names, arm.parameter_units, strict=True)):
        u = next((u for pattern, u in reversed(known.items()) if fnmatchcase(name, pattern)), None)
        if u is not None:
            values[k] += u * rng.standard_normal()
        elif name.endswith(GEOMETRY) and not (case.drawn_straight and name.endswith((".x", ".y"))):
            values[k] += WRONG[unit] * rng.uniform(-1.0, 1.0)
        else:
            values[k] = 0.0
    return arm.with_parameters(values)
