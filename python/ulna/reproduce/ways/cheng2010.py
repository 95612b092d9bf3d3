"""A probe from one seat, the joints being known from a calibration with another probe."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.probe import Probe
from ulna.reproduce.claims import Claim
from ulna.reproduce.ways import readings
from ulna.reproduce.ways.arms import ARMS, SIX, true_arm
from ulna.reproduce.ways.outcome import Way
from ulna.reproduce.ways.trial import WRONG_MM, Trial, calibrate, start_of
from ulna.reproduce.ways.wang2007 import ARMS_FRAME
from ulna.reproduce.ways.work import REPORTED, UNKNOWN, Found, Work
from ulna.simulation.virtual_arm import VirtualArm


def _probe(truth: VirtualArm, seed: int) -> Trial:
    """The joints from bars with the bent probe; then the straight one, joints held and their uncertainty considered."""
    joints = calibrate(truth, start_of(truth, seed), readings.bars(truth, seed)).arm
    straight = true_arm(truth.arm.name, straight=True)
    touched = readings.seat(straight, seed + 1000, known=False, poses=readings.PROBE_POSES)
    return calibrate(straight, _with_drawn_probe(joints, straight.arm, seed), touched, hold=["joint.*"])


def _with_drawn_probe(joints: Arm, other: Arm, seed: int) -> Arm:
    """The calibrated joints, and the other probe as a drawing has it."""
    ((name, probe),) = other.probes.items()
    off = np.random.default_rng([seed, 4]).uniform(-WRONG_MM, WRONG_MM, 3)
    known = joints.uncertainty
    assert known is not None
    of_joints = known.of([name for name in known.names if name.startswith("joint.")])
    return replace(joints, probes={name: Probe(*(probe.tip_mm + off).tolist())}, uncertainty=of_joints)


PROBE = Way("probe from one seat", places=1, carry_out=_probe)


def _claims(found: Found) -> list[Claim]:
    model = found(ARMS_FRAME, SIX)
    probe = [found(PROBE, arm) for arm in ARMS]
    return [
        Claim(
            "six axes: parameters that are not redundant",
            "23",
            f"{model.parameters}, all determined by coordinates"
            if model.determined == model.parameters
            else f"{model.determined} of {model.parameters}",
            (model.determined, model.parameters) == (23, 23),
        ),
        Claim(
            "probe from one seat",
            f"yes; figures {UNKNOWN}",
            f"seven axes {probe[0].determined} of {probe[0].parameters}, six axes {probe[1].determined} of "
            f"{probe[1].parameters}; fresh bars by the arm {1000 * probe[0].bars_by_arm_rms_mm:.1f} and "
            f"{1000 * probe[1].bars_by_arm_rms_mm:.1f} µm",
            all(each.determined == each.parameters == 3 for each in probe),
        ),
    ]


WORK = Work(
    name="cheng2010",
    title="Cheng, Fei, Yu 2010: a probe from one seat",
    source=REPORTED,
    chosen="Chosen by us: joints from a bar in 140 places with a bent probe, then 32 poses of a straight probe in one "
    "seat that stands anywhere. The count of the model is asked of coordinates, as in wang2007.",
    ways=(PROBE, ARMS_FRAME),
    claims=_claims,
)

run = WORK.run
