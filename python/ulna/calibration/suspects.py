"""After a fit that ended badly: what would explain the readings, if it were so. One source of suspicions a row.

Each suspicion is the study with one thing changed that people get wrong, fitted again from the arm file, on some of the
readings. One that is met so much better is worth a look; none is ever taken.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations, permutations

import numpy as np

import ulna._core as _core
from ulna.arm.effects.effects import EFFECTS
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.readings import Readings
from ulna.calibration.result import Result
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.study.assembly import assemble
from ulna.study.study import Study

#: so many readings of an artefact are enough to see a gross error in
_READINGS = 400
_ITERATIONS = 40
#: what is left of the residuals, root mean square, if a suspicion is to be told
_LEFT = 0.2


@dataclass(frozen=True)
class Suspicion:
    """One thing that would explain the readings."""

    if_so: str
    """ "if columns q2 and q3 are swapped"."""
    to_do: str
    """What to try, as a sentence."""
    study: Study
    """As it would be."""
    rms_mm: float = np.inf
    """Reading to fit, root mean square, with it."""


def suspicion(study: Study, result: Result) -> Suspicion | None:
    """What explains the readings best of all that is suspected, or None.

    Nothing where zero offsets or signs are sought: everything else would have to be sought along with them.
    """
    if study.fit.start == "search" or study.arm.unknown_signs.any() or not study.readings:
        return None
    some = replace(study, readings=[_first(group) for group in study.readings])
    found = [tried for source in SOURCES for tried in map(_tried, source(some)) if tried is not None]
    best = min(found, key=lambda tried: tried.rms_mm, default=None)
    return best if best is not None and best.rms_mm < _LEFT * result.fit.rms_mm else None


def _first(group: Readings) -> Readings:
    """Enough of them to tell a gross fault, of an artefact as it is stated: to fit each of its features takes long."""
    known = replace(group.artefact, fitted=group.artefact.fitted and not _uncertain(group.artefact))
    return replace(group if len(group) <= _READINGS else group.select(np.arange(_READINGS)), artefact=known)


def _uncertain(artefact: Artefact) -> bool:
    return artefact.u_mm > 0.0 or any(artefact.feature_u_mm or ())


def _tried(suspected: Suspicion) -> Suspicion | None:
    """With what it leaves; None where it ends badly too."""
    options = suspected.study.fit
    try:
        assembled = assemble(suspected.study)
        fitted = _core.fit(
            assembled.problem,
            assembled.hold,
            max_iterations=_ITERATIONS,
            search_starts=0,
            known_length_mm=options.known_length_mm,
            poor_above_mm=options.poor_above_mm,
        )
    except (UlnaInputError, _core.UlnaError):
        return None
    return replace(suspected, rms_mm=fitted.rms_mm) if fitted.converged else None


def _of_angles(study: Study, change: Callable[[F64], F64]) -> Study:
    """With other encoder angles, (N, n) rad."""

    def group(own: Readings) -> Readings:
        p_rad = None if own.p_rad is None else change(own.p_rad)
        return replace(own, q_rad=change(own.q_rad), p_rad=p_rad)

    return replace(study, readings=[group(own) for own in study.readings])


def _units(study: Study) -> Iterator[Suspicion]:
    for was, should, factor in (("radians", "degrees", np.pi / 180.0), ("degrees", "radians", 180.0 / np.pi)):
        changed = _of_angles(study, partial(np.multiply, study.arm.each(factor, 1.0)))
        yield Suspicion(
            f"if the encoder angles are in {should}, not in {was}", f"State {should} as their unit.", changed
        )


def _swapped(study: Study) -> Iterator[Suspicion]:
    if study.arm.slides.any():
        return
    for one, other in combinations(range(study.arm.n), 2):
        order = np.arange(study.arm.n)
        order[[one, other]] = other, one
        yield Suspicion(
            f"if the readings of joints {one + 1} and {other + 1} are swapped",
            f"Look at the columns: [[readings]] columns says which is which, q{one + 1} and q{other + 1}.",
            _of_angles(study, partial(np.take, indices=order, axis=1)),
        )


def _counted(study: Study) -> Iterator[Suspicion]:
    for joint in range(study.arm.n):
        signs = np.array([own.sign for own in study.arm.joints], dtype=np.float64)
        signs[joint] *= -1.0
        yield Suspicion(
            f"if the encoder of joint {joint + 1} counts the other way",
            f"Turn sign of joint {joint + 1} in the arm file, or state sign = 0, not known.",
            replace(study, arm=study.arm.with_signs(signs)),
        )


def _coupled(study: Study) -> Iterator[Suspicion]:
    joints = study.arm.joints
    if study.arm.slides.any() or any(effect is EFFECTS["compliance"] for effect in study.arm.effects):
        return
    for joint, other in permutations(range(study.arm.n), 2):
        for ratio in (1.0, -1.0):
            own = joints[joint].effects
            if other + 1 in own.coupled_to:
                continue
            known = dict(zip(own.coupled_to, own.coupling or (0.0,) * len(own.coupled_to), strict=True))
            pairs = sorted((known | {other + 1: ratio}).items())
            effects = replace(own, coupled_to=tuple(k for k, _ in pairs), coupling=tuple(r for _, r in pairs))
            changed = list(joints)
            changed[joint] = replace(joints[joint], effects=effects)
            yield Suspicion(
                f"if joint {joint + 1} turns with joint {other + 1}'s encoder too, as controllers of robots show it",
                f"Try coupling = {{ {other + 1} = {ratio:.1f} }} in the table of joint {joint + 1} of the arm file.",
                replace(study, arm=replace(study.arm, joints=tuple(changed))),
            )


def _standing(study: Study) -> Iterator[Suspicion]:
    more = [effect.name for effect in EFFECTS.values() if effect.of_first and effect.name not in study.fit.extras]
    if more and any(group.artefact.frame == "arm" for group in study.readings):
        extras = [*study.fit.extras, *more]
        yield Suspicion(
            "if the first axis leans, or stands aside, in the frame of the coordinates",
            f"Try [fit] extras = {extras}: where it stands is then found.".replace("'", '"'),
            replace(study, fit=replace(study.fit, extras=extras)),
        )


SOURCES: tuple[Callable[[Study], Iterator[Suspicion]], ...] = (_units, _swapped, _counted, _coupled, _standing)
"""One a row."""
