"""A virtual arm, a protocol and a short test to try them with: the arm is known exactly, so that it passes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.file import arm_toml
from ulna.arm.probe import Probe
from ulna.reproduce.cheng2011.arms import BAR_MM, BENT_PROBE, ENCODER_RAD, platinum
from ulna.serve.contract.guided import CertifiedAsked, LimitAsked, PlayGuided, TestAsked
from ulna.serve.play import TRAVEL
from ulna.serve.tests_made import test_made
from ulna.serve.workshop import Workshop

BALL_MM = 6.0
PROTOCOL = f"""# A check of a minute: a seat, and a bar in two places.
format = "ulna-protocol/1"
name = "before work"
arm = "arm.toml"
units = {{ length = "mm", angle = "rad" }}
decision = {{ rule = "simple", k = 2.0, p = 0.95 }}

[test.seat]
kind = "single-point"
positions = 1
points = 5
figures = ["asme"]

[test.bar]
kind = "length"
direction = "uni"
lengths = 1
positions = 2
repeats = 1

[artefact.bar]
kind = "length"
length = {BAR_MM}
u = 0.001
ends = "seats"
expansion = 11.5e-6
u_expansion = 0.5e-6

[limit]
SPAT_max = 0.060
E_Uni = 0.060

[temperature]
value = 20.0
u = 0.5

[fixture]
u = 0.002
"""
PROFILE = """# A test of a few minutes, to see how one goes; no standard has it.
format = "ulna-profile/1"
name = "short"
standard = "none"
statement = "A short test, to be tried; counts are of no standard."

[decision]
rule = "1.65u"
k = 2.0
p = 0.95

[test.probing]
kind = "sphere"
positions = 1
points = 6

[test.seat]
kind = "single-point"
positions = 1
points = 4
figures = ["asme"]

[test.lengths]
kind = "length"
direction = "uni"
lengths = 2
positions = 2
repeats = 1
"""
SIZES = {"ball": (25.0, 0.0003), "length-1": (300.0, 0.001), "length-2": (600.0, 0.001)}
LIMITS = (("P_Size", 0.06, None), ("P_Form", 0.1, None), ("SPAT_2S", 0.08, None), ("E_Uni", 0.06, 40000.0))


def play_guided(workshop: Workshop) -> PlayGuided:
    """All of it, on the desk."""
    desk = workshop.desk
    arm = desk.put("virtual-known.toml", arm_toml(_arm()).encode()).sha256
    protocol = desk.put("before-work.toml", PROTOCOL.encode()).sha256
    profile = desk.put("short.toml", PROFILE.encode()).sha256
    made = test_made(
        workshop,
        TestAsked(
            profile=profile,
            arm=arm,
            limits=[LimitAsked(figure=figure, a_mm=a, b=b) for figure, a, b in LIMITS],
            artefacts=[
                CertifiedAsked(
                    name=name,
                    size_mm=size,
                    u_mm=u,
                    form_mm=0.0005 if name == "ball" else None,
                    expansion=11.5e-6,
                    u_expansion=0.5e-6,
                )
                for name, (size, u) in SIZES.items()
            ],
            temperature_c=20.0,
            u_temperature_k=0.2,
            fixture_mm=0.002,
        ),
    )
    source = f"virtual:{arm}?moves=told&noise={ENCODER_RAD}&rate=500&hand=1.5"
    return PlayGuided(arm=arm, source=source, protocol=protocol, test=made.test, beside=made.beside)


def _arm() -> Arm:
    """With joints that end somewhere, and a ball."""
    drawn = platinum(BENT_PROBE)
    joints = tuple(
        replace(joint, limits_rad=(float(low), float(high)))
        for joint, (low, high) in zip(drawn.joints, np.array(TRAVEL), strict=True)
    )
    ((name, tip),) = drawn.probes.items()
    return Arm("virtual arm", joints, {name: Probe(tip.x_mm, tip.y_mm, tip.z_mm, ball_mm=BALL_MM)})
