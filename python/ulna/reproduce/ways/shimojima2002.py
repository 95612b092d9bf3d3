"""A plate that carries many calibrated balls."""

from __future__ import annotations

from ulna.reproduce.claims import Claim
from ulna.reproduce.ways import readings
from ulna.reproduce.ways.arms import ARMS, SIX
from ulna.reproduce.ways.outcome import Way
from ulna.reproduce.ways.trial import calibrate, start_of
from ulna.reproduce.ways.work import ERRORS_BELOW, REPORTED, UNKNOWN, Found, Work

PLATE = Way(
    "ball plate",
    places=10,
    carry_out=lambda truth, seed: calibrate(truth, start_of(truth, seed), readings.plate(truth, seed)),
)

COVERED = (0.90, 0.99)
"""Share of the parameters' errors that must lie within twice their uncertainty: 0.954 expected, of some hundred."""


def _claims(found: Found) -> list[Claim]:
    six = found(PLATE, SIX)
    shares = [found(PLATE, arm).within_2u or 0.0 for arm in ARMS]
    return [
        Claim(
            "parameters of the model, of them calibrated",
            "23, 21",
            f"six axes: {six.parameters}, {six.determined}; where the arm's base stands and its zero stay open",
            (six.parameters, six.determined) == (23, 21),
        ),
        Claim(
            "uncertainty",
            f"estimated; figures {UNKNOWN}",
            "of every parameter; true error within twice it in " + ", ".join(f"{100 * s:.0f} %" for s in shares),
            all(COVERED[0] <= share <= COVERED[1] for share in shares),
        ),
        ERRORS_BELOW,
    ]


WORK = Work(
    name="shimojima2002",
    title="Shimojima, Furutani, Takamasu 2002: a ball plate",
    source=REPORTED,
    chosen="Chosen by us: 28 balls 100 mm apart, ten places, each ball touched once with a self-centring probe.",
    ways=(PLATE,),
    claims=_claims,
)

run = WORK.run
