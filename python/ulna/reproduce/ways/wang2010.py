"""An evolutionary search on an arm like a FARO."""

from __future__ import annotations

from ulna.reproduce.claims import Claim
from ulna.reproduce.ways import readings
from ulna.reproduce.ways.arms import SEVEN
from ulna.reproduce.ways.outcome import Way
from ulna.reproduce.ways.trial import Trial, calibrate, search_alone, start_of
from ulna.reproduce.ways.work import REPORTED, UNKNOWN, Found, Work, same_optimum
from ulna.simulation.virtual_arm import VirtualArm


def _by_lm(truth: VirtualArm, seed: int) -> Trial:
    return calibrate(truth, start_of(truth, seed), readings.bars(truth, seed))


def _evolved(truth: VirtualArm, seed: int) -> Trial:
    return calibrate(truth, start_of(truth, seed), readings.bars(truth, seed), method="evolution", seed=seed)


def _evolution_alone(truth: VirtualArm, seed: int) -> Trial:
    return search_alone(truth, start_of(truth, seed), readings.bars(truth, seed), method="evolution", seed=seed)


BARS = Way("bar, 140 places", places=140, carry_out=_by_lm)
ALONE = Way("… by evolution alone", places=140, carry_out=_evolution_alone, once=True)
EVOLVED = Way("… by evolution, then LM", places=140, carry_out=_evolved, once=True)


def _claims(found: Found) -> list[Claim]:
    alone, lm = found(ALONE, SEVEN), found(BARS, SEVEN)
    return [
        Claim(
            "seven axes, a FARO arm, evolutionary search",
            f"improved genetic algorithm; figures {UNKNOWN}",
            f"alone: fresh bars by the arm {1000 * alone.bars_by_arm_rms_mm:.1f} µm in {alone.seconds:.2g} s; LM: "
            f"{1000 * lm.bars_by_arm_rms_mm:.1f} µm in {lm.seconds:.2g} s",
            None,
        ),
        Claim(
            "evolution, finished by LM",
            UNKNOWN,
            "reaches the optimum of LM alone" if same_optimum(found, BARS, EVOLVED) else "ends elsewhere than LM",
            same_optimum(found, BARS, EVOLVED),
        ),
    ]


WORK = Work(
    name="wang2010",
    title="Wang X. et al. 2010: an evolutionary search on an arm of seven axes",
    source=REPORTED,
    chosen="Chosen by us: a bar in 140 places. The evolution is SciPy's differential one, at most 100 000 evaluations.",
    ways=(BARS, ALONE),
    claims=_claims,
    checks=(EVOLVED,),
)

run = WORK.run
