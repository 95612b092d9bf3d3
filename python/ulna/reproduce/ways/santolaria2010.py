"""A bar of 14 balls, many poses on each: points and lengths together."""

from __future__ import annotations

from ulna.reproduce.claims import Claim
from ulna.reproduce.ways import readings
from ulna.reproduce.ways.arms import ARMS, SEVEN, SIX
from ulna.reproduce.ways.outcome import Way
from ulna.reproduce.ways.redundant import determined_of_full_link
from ulna.reproduce.ways.trial import Trial, calibrate, start_of
from ulna.reproduce.ways.work import ERRORS_BELOW, REPORTED, UNKNOWN, Found, Work
from ulna.simulation.virtual_arm import VirtualArm


def _points_alone(truth: VirtualArm, seed: int) -> Trial:
    return calibrate(truth, start_of(truth, seed), readings.points_alone(readings.ball_bar(truth, seed)))


def _lengths_alone(truth: VirtualArm, seed: int) -> Trial:
    return calibrate(truth, start_of(truth, seed), readings.lengths_alone(readings.ball_bar(truth, seed)))


TOGETHER = Way(
    "14-ball bar",
    places=5,
    carry_out=lambda truth, seed: calibrate(truth, start_of(truth, seed), readings.ball_bar(truth, seed)),
)
POINTS = Way("… its points alone", places=5, carry_out=_points_alone)
LENGTHS = Way("… its lengths alone", places=5, carry_out=_lengths_alone)


def _claims(found: Found) -> list[Claim]:
    seven = found(TOGETHER, SEVEN)
    parameters, determined = determined_of_full_link(found(TOGETHER, SIX).first)
    by_arm = {way.label: [1000 * found(way, arm).bars_by_arm_rms_mm for arm in ARMS] for way in WORK.ways}
    scale = [(found(TOGETHER, arm).determined or 0) - (found(POINTS, arm).determined or 0) for arm in ARMS]
    together, lengths = by_arm[TOGETHER.label], by_arm[LENGTHS.label]
    return [
        Claim(
            "parameters of the model",
            "27",
            f"seven axes: {seven.parameters}, {seven.determined} determined; six with a full last link and a tip: "
            f"{parameters}, {determined} determined, {parameters - 23} of them redundant",
            seven.parameters == parameters == 27 and determined == 21,
        ),
        Claim(
            "points and lengths together",
            f"so calibrated; figures {UNKNOWN}",
            f"fresh bars by the arm {_pair(together)} µm, by lengths alone {_pair(lengths)}",
            None,
        ),
        Claim(
            "points alone",
            UNKNOWN,
            f"leave the scale open ({scale[0]} combination less): {_pair(by_arm[POINTS.label])} µm",
            None,
        ),
        ERRORS_BELOW,
    ]


def _pair(values: list[float]) -> str:
    return " and ".join(f"{value:.1f}" if value < 100 else f"{value:.0f}" for value in values)


WORK = Work(
    name="santolaria2010",
    title="Santolaria, Aguilar 2010: a bar of 14 balls, points and lengths together",
    source=REPORTED,
    chosen="Chosen by us: balls 60 mm apart in a line, five places, each ball in four poses. Lengths: between balls "
    "seven apart.",
    ways=(TOGETHER, POINTS, LENGTHS),
    claims=_claims,
)

run = WORK.run
