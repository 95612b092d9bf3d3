"""One conical seat whose coordinates are known, and simulated annealing; and what happens when they are not known."""

from __future__ import annotations

import numpy as np

from ulna.reproduce.claims import Claim
from ulna.reproduce.ways import readings
from ulna.reproduce.ways.arms import ARMS, SIX
from ulna.reproduce.ways.outcome import Way
from ulna.reproduce.ways.redundant import determined_of_full_link
from ulna.reproduce.ways.trial import Trial, calibrate, search_alone, start_of
from ulna.reproduce.ways.work import UNKNOWN, Found, Work, same_optimum
from ulna.simulation.virtual_arm import VirtualArm


def _known(truth: VirtualArm, seed: int) -> Trial:
    return calibrate(truth, start_of(truth, seed), readings.seat(truth, seed, known=True))


def _unknown(truth: VirtualArm, seed: int) -> Trial:
    return calibrate(truth, start_of(truth, seed), readings.seat(truth, seed, known=False))


def _annealed(truth: VirtualArm, seed: int) -> Trial:
    touched = readings.seat(truth, seed, known=True)
    return calibrate(truth, start_of(truth, seed), touched, method="annealing", seed=seed)


def _annealing_alone(truth: VirtualArm, seed: int) -> Trial:
    touched = readings.seat(truth, seed, known=True)
    return search_alone(truth, start_of(truth, seed), touched, method="annealing", seed=seed)


KNOWN = Way("one seat, known", places=1, carry_out=_known)
ALONE = Way("… by annealing alone", places=1, carry_out=_annealing_alone, once=True)
ANNEALED = Way("… by annealing, then LM", places=1, carry_out=_annealed, once=True)
UNKNOWN_SEAT = Way("one seat, unknown", places=1, carry_out=_unknown)


def _claims(found: Found) -> list[Claim]:
    parameters, determined = determined_of_full_link(found(KNOWN, SIX).first)
    scatter = [_scatter_mm(found(KNOWN, SIX).first, after) for after in (False, True)]
    six = found(KNOWN, SIX)
    open_ = [(found(KNOWN, arm).determined or 0) - (found(UNKNOWN_SEAT, arm).determined or 0) for arm in ARMS]
    lost = [1000 * found(UNKNOWN_SEAT, arm).bars_rms_mm for arm in ARMS]
    return [
        Claim(
            "parameters",
            "27",
            f"six axes with a full last link and a tip: {parameters}, {determined} determined, the rest redundant",
            (parameters, determined) == (27, 23),
        ),
        Claim(
            "repeatability in the seat, better by",
            "7.87 times",
            f"{scatter[0] / scatter[1]:.0f} times, from our drawing; how wrong theirs was is {UNKNOWN}",
            None,
        ),
        Claim(
            "length error, better by",
            "5.59 times",
            f"{six.start_bars_rms_mm / six.bars_rms_mm:.0f} times, from our drawing",
            None,
        ),
        Claim(
            "where the seat stands",
            UNKNOWN,
            f"matters: fresh bars by the arm {1000 * six.bars_by_arm_rms_mm:.1f} µm in the median, "
            f"{1000 * six.bars_by_arm_worst_rms_mm:.0f} µm in the worst of {six.repeats} places (six axes)",
            None,
        ),
        Claim(
            "annealing, finished by LM",
            "modified annealing only",
            "reaches the optimum of LM alone" if same_optimum(found, KNOWN, ANNEALED) else "ends elsewhere than LM",
            same_optimum(found, KNOWN, ANNEALED),
        ),
        Claim(
            "the seat's coordinates are not known",
            UNKNOWN,
            f"{open_[0]} and {open_[1]} combinations less, the scale among them: fresh bars wrong by "
            f"{lost[0]:.0f} and {lost[1]:.0f} µm",
            None,
        ),
    ]


def _scatter_mm(trial: Trial, after: bool) -> float:
    """Rms distance of the touches in the seat to their mean."""
    tips = (trial.arm if after else trial.start).tip(trial.readings.q_rad)
    return float(np.sqrt(((tips - tips.mean(axis=0)) ** 2).sum(axis=1).mean()))


WORK = Work(
    name="gao2009",
    title="Gao et al. 2009: one conical seat, simulated annealing",
    source="Six axes; what it reports is from its abstract.",
    chosen="Chosen by us: 280 poses in one seat. The annealing is SciPy's generalized one, 100 000 evaluations.",
    ways=(KNOWN, ALONE, UNKNOWN_SEAT),
    claims=_claims,
    checks=(ANNEALED,),
)

run = WORK.run
