"""Why the uncertainties that a calibration states may be too small for readings that it has not seen."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Literal, get_args

from ulna.arm.arm import Arm
from ulna.arm.reading_noise import ReadingNoise
from ulna.study.study import Study

Cause = Literal["elsewhere", "blocks", "held", "artefact-u", "few-places"]
"""Poses elsewhere than the calibration's; no block beyond geometry in the model; parameters held, which count as exact;
an artefact whose u nobody stated; few places or few degrees of freedom."""

CAUSES: tuple[Cause, ...] = get_args(Cause)

FEW = 10.0
"""Degrees of freedom of the parameters' uncertainties, below which they are themselves known to a quarter only."""
FRAME = ("joint.1.theta0", "joint.1.d")
"""Held by convention: they say where the base frame is, and no length depends on them."""


def likely_causes(arm: Arm, noise: ReadingNoise, study: Study, elsewhere: bool) -> list[Cause]:
    """arm: as it was calibrated; study: of the readings that it is judged by; elsewhere: whether they were chosen apart
    from the calibration's."""
    known = arm.uncertainty
    fitted = [] if known is None else known.names
    held = [name for name in arm.parameter_names if name not in fitted and name not in FRAME]
    artefacts = [group.artefact for group in study.readings]
    stated = [each.u_mm > 0.0 or bool(each.feature_u_mm and max(each.feature_u_mm) > 0.0) for each in artefacts]
    found: dict[Cause, bool] = {
        "elsewhere": elsewhere,
        "blocks": all(effect.of_first for effect in arm.effects),
        "held": bool(held),
        "artefact-u": not all(stated),
        "few-places": noise.degrees_of_freedom < FEW,
    }
    return [cause for cause in CAUSES if found[cause]]


def together(parts: Iterable[Sequence[Cause]]) -> list[Cause]:
    """Of several fits."""
    named = {cause for part in parts for cause in part}
    return [cause for cause in CAUSES if cause in named]
