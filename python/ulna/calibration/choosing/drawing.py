"""Where a fit of the geometry ends: alone, and with what is known of it from a drawing.

Arms keep to their drawings: by 0.01 rad and 1 mm, and by five times as much where somebody mounted a probe. Without
that, blocks and geometry imitate each other, and a fit without a region of few places ends anywhere. An arm that is
farther from its drawing shows it: u is then its own distance.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

import ulna._core as _core
from ulna.arm.effects.effects import extra_of
from ulna.calibration.running import run_assembled
from ulna.ground.arrays import F64, Bool
from ulna.study.assembly import Assembled, assemble
from ulna.study.data import Prior
from ulna.study.parameters import names_like, priors
from ulna.study.study import Study

DRAWN = {
    "joint.*.theta0": ("rad", 1.0),
    "joint.*.alpha": ("rad", 1.0),
    "joint.*.beta": ("rad", 1.0),
    "joint.*.a": ("mm", 1.0),
    "joint.*.d": ("mm", 1.0),
    "probe.*": ("mm", 5.0),
}
"""Of which unit, and how many times less well than anything is known."""
LENGTHS = ("joint.*.a", "joint.*.d")
OFFSETS = "joint.*.theta0"
ROUNDS = 4
"""Of making u wider."""
GREW = 1.1
BELIEVED = 1.5
"""A drawing that makes residuals larger than this many times is none of this arm."""


@dataclass(frozen=True)
class Geometry:
    """Both fits, of a study that asks for blocks, all of which are held at what the arm file says."""

    study: Study
    """With what is known from the drawing."""
    assembled: Assembled
    alone: _core.Fitted
    """Plain: nothing known beforehand but what the study states."""
    fitted: _core.Fitted
    """With the drawing."""
    drawn_u: dict[str, float]
    """Pattern → standard deviation, mm or rad."""
    known: dict[int, tuple[float, float]]
    """Parameter → value and standard deviation before any reading, blocks' too."""


def alone_of(study: Study) -> dict[str, float]:
    """Parameters by name where the plain fit ends, other minima looked for where it has to; of an arm whose signs are
    not known none: they are found with them. study: asks for no blocks. Raises UlnaInputError."""
    if study.arm.unknown_signs.any():
        return {}
    assembled = assemble(study)
    return dict(zip(assembled.names, run_assembled(study, assembled).parameters.tolist(), strict=True))


def geometry_of(study: Study, near: Mapping[str, float]) -> Geometry:
    """study: asks for all blocks that will be tried; near: where the plain fit ends, for readings that are parted as
    well. Raises UlnaInputError."""
    assembled = assemble(study)
    names = assembled.names
    held = assembled.hold | np.array([extra_of(name) is not None for name in names])
    alone = _alone(study, dataclasses.replace(assembled, hold=held), near)
    signed = study.with_arm(study.arm.with_signs(alone.arm.signs))
    # nobody knows offsets that are searched for
    unknown = {OFFSETS} if study.fit.start == "search" or study.arm.unknown_signs.any() else set[str]()
    wide = {"rad": study.fit.known_angle_rad, "mm": study.fit.known_length_mm}
    u = {
        pattern: times * wide[unit]
        for pattern, (unit, times) in DRAWN.items()
        if pattern not in unknown and names_like(pattern, names)
    }
    start, largest = assembled.problem.parameters, BELIEVED * alone.rms_mm
    for again in range(ROUNDS):
        asked = _drawn(signed, u)
        own = assemble(asked)
        only = dataclasses.replace(own, hold=held)
        fitted = run_assembled(asked, only, search=False)
        if fitted.rms_mm > largest:
            fitted = min(
                fitted, run_assembled(asked, only, None, alone.parameters, search=False), key=lambda each: each.rms_mm
            )
        believed = fitted.rms_mm <= largest
        wider = _wider(u, names, held, (fitted if believed else alone).parameters - start)
        if wider == u or again == ROUNDS - 1:
            break
        u = wider
    known = priors(asked, names, own.units, start.tolist(), own.hold)
    return Geometry(asked, own, alone, fitted, u, known)


def _alone(study: Study, assembled: Assembled, near: Mapping[str, float]) -> _core.Fitted:
    if not near:
        return run_assembled(study, assembled)
    start = assembled.problem.parameters.tolist()
    begin = np.array([near.get(name, value) for name, value in zip(assembled.names, start, strict=True)])
    given = dataclasses.replace(study, fit=dataclasses.replace(study.fit, start="given"))
    return run_assembled(given, assembled, None, begin, search=False)


def _drawn(study: Study, u: dict[str, float]) -> Study:
    """With the drawing, over which goes what the study states."""
    known = {pattern: Prior(each) for pattern, each in u.items()} | study.fit.prior
    return dataclasses.replace(study, fit=dataclasses.replace(study.fit, start="given", prior=known))


def _wider(u: dict[str, float], names: list[str], held: Bool, off: F64) -> dict[str, float]:
    """u of each pattern, no smaller than the arm is from its drawing."""
    found = dict(u)
    for pattern, each in u.items():
        like = set(names_like(pattern, names))
        which = np.array([name in like for name in names], dtype=bool) & ~held
        spread = float(np.sqrt(np.mean(off[which] ** 2))) if which.any() else 0.0
        if spread > GREW * each:
            found[pattern] = spread
    return found
