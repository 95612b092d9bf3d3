"""Reference coordinates from a Cartesian measuring machine."""

from __future__ import annotations

from ulna.reproduce.claims import Claim
from ulna.reproduce.ways import readings
from ulna.reproduce.ways.arms import ARMS, SIX
from ulna.reproduce.ways.outcome import Way
from ulna.reproduce.ways.redundant import determined_of_full_link
from ulna.reproduce.ways.trial import Trial, calibrate, start_of
from ulna.reproduce.ways.work import ERRORS_BELOW, UNKNOWN, Found, Work
from ulna.simulation.virtual_arm import VirtualArm


def _in_arms_frame(truth: VirtualArm, seed: int) -> Trial:
    return calibrate(truth, start_of(truth, seed), readings.coordinates(truth, seed, in_arms_frame=True))


def _in_own_frame(truth: VirtualArm, seed: int) -> Trial:
    return calibrate(truth, start_of(truth, seed), readings.coordinates(truth, seed, in_arms_frame=False))


ARMS_FRAME = Way("coordinates, frame known", places=1, carry_out=_in_arms_frame)
OWN_FRAME = Way("coordinates, frame unknown", places=1, carry_out=_in_own_frame)

LINK_AND_LENGTH = ("probe.bent.x", "probe.bent.y")
"""Held in the model of 25: a whole last link and a length."""


def _claims(found: Found) -> list[Claim]:
    known = determined_of_full_link(found(ARMS_FRAME, SIX).first, hold=LINK_AND_LENGTH)
    unknown = determined_of_full_link(found(OWN_FRAME, SIX).first, hold=LINK_AND_LENGTH)
    by_arm = [[1000 * found(way, arm).bars_by_arm_rms_mm for arm in ARMS] for way in WORK.ways]
    return [
        Claim(
            "six axes: parameters, to calibrate, found (Wang 2006)",
            "25, 23, 21: two are linearly dependent",
            f"{known[0]}; machine in the arm's frame {known[1]}, in a frame of its own {unknown[1]}",
            known == (25, 23) and unknown == (25, 21),
        ),
        Claim(
            "does it matter that the machine's frame is unknown?",
            UNKNOWN,
            f"fresh bars by the arm: {by_arm[0][0]:.1f} and {by_arm[0][1]:.1f} µm known, {by_arm[1][0]:.1f} and "
            f"{by_arm[1][1]:.1f} µm unknown",
            None,
        ),
        ERRORS_BELOW,
    ]


WORK = Work(
    name="wang2007",
    title="Wang, Fei, Shang 2007: reference coordinates from a Cartesian machine",
    source="Facts as Cheng, Yu, Fei 2011 report them; the counts are those of Wang 2006, by the same group.",
    chosen="Chosen by us: 280 points anywhere in the volume, the machine's coordinates exact.",
    ways=(ARMS_FRAME, OWN_FRAME),
    claims=_claims,
)

run = WORK.run
