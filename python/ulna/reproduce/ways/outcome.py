"""Ways carried out again and again on both arms, and what they gave. Angles rad, lengths mm."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ulna.ground.arrays import F64, Progress
from ulna.reproduce.ways.arms import ARMS, true_arm
from ulna.reproduce.ways.trial import CarryOut, Trial, errors_of

SEED = 2011


@dataclass(frozen=True)
class Way:
    """One way of calibrating, as a work of the literature did it."""

    label: str
    places: int
    """Where the artefact is put."""
    carry_out: CarryOut
    once: bool = False
    """Carried out once only: a search that takes seconds."""


@dataclass(frozen=True)
class Outcome:
    """What a way gave on one arm, over some repeats with other places and other noise."""

    way: str
    arm: str
    repeats: int
    places: int
    touches: int
    parameters: int | None
    """Of the model; None where nothing tells."""
    determined: int | None
    """Combinations of parameters that the readings determine."""
    start_bars_rms_mm: float
    """Length errors of fresh bars by the drawing; here and below the median of the repeats."""
    bars_rms_mm: float
    """By the calibrated arm, readings as noisy as those of the calibration."""
    bars_by_arm_rms_mm: float
    """What the arm contributes to them."""
    bars_by_arm_worst_rms_mm: float
    """The same in the worst of the repeats."""
    worst_point_mm: float
    """Anywhere in the volume, after the best rigid motion."""
    seconds: float
    """Of one calibration."""
    within_2u: float | None
    """Share of the determined parameters whose error is within twice the stated uncertainty."""
    first: Trial
    """The first of the repeats."""


def outcomes_of(ways: tuple[Way, ...], repeats: int, progress: Progress | None) -> list[Outcome]:
    """Each way on both arms."""
    total = sum(1 if way.once else repeats for way in ways) * len(ARMS)
    done = 0

    def told() -> None:
        nonlocal done
        if progress is not None:
            progress("calibrations", done, total)
        done += 1

    return [_outcome(way, arm, repeats, told) for way in ways for arm in ARMS]


def _outcome(way: Way, arm: str, repeats: int, told: Callable[[], None]) -> Outcome:
    trials, errors, starts = [], [], []
    for seed in range(SEED, SEED + (1 if way.once else repeats)):
        told()
        trial = way.carry_out(true_arm(arm), seed)
        trials.append(trial)
        errors.append(errors_of(trial.arm, trial.truth, seed))
        starts.append(errors_of(trial.start, trial.truth, seed))
    first = trials[0]
    known = None if first.result is None else first.result.identifiability
    by_arm = [_rms(each.bars_by_arm_mm) for each in errors]
    off = np.abs([ratio for trial in trials for ratio in trial.off_over_u])
    return Outcome(
        way=way.label,
        arm=arm,
        repeats=len(trials),
        places=way.places,
        touches=first.touches,
        parameters=None if known is None else known.parameters,
        determined=None if known is None else known.determined,
        start_bars_rms_mm=float(np.median([_rms(each.bars_mm) for each in starts])),
        bars_rms_mm=float(np.median([_rms(each.bars_mm) for each in errors])),
        bars_by_arm_rms_mm=float(np.median(by_arm)),
        bars_by_arm_worst_rms_mm=max(by_arm),
        worst_point_mm=float(np.median([each.worst_point_mm for each in errors])),
        seconds=float(np.median([trial.seconds for trial in trials])),
        within_2u=float((off <= 2.0).mean()) if len(off) else None,
        first=first,
    )


def _rms(values: F64) -> float:
    return float(np.sqrt(np.mean(values**2)))
