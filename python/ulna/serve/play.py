"""A virtual arm to play with: the seven-axis arm of the paper, off its drawing, and a bar to touch."""

from __future__ import annotations

from fnmatch import fnmatch

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.file import arm_toml
from ulna.reproduce.cheng2011.arms import BAR_MM, BENT_PROBE, ENCODER_RAD, SEAT_MM, platinum
from ulna.serve.contract.about import Play
from ulna.serve.desk import Desk

OFF_MM, OFF_RAD = 0.2, 0.0015
"""How far the true arm is off its drawing, standard deviations."""
HELD = ("joint.1.theta0", "joint.1.d")
"""The base frame: what no reading tells."""
SEED = 2011
GOAL_MM, LENGTH_MM = 0.06, 500.0
"""Of U, which a dozen touches come to."""
TRAVEL = ((-3.14, 3.14), (0.49, 3.49), (-3.14, 3.14), (0.58, 3.58), (-3.14, 3.14), (0.56, 3.56), (-3.14, 3.14))
PLAN = f"""# A bar with two seats, to be touched by the virtual arm.
format = "ulna-plan/1"
units = {{ length = "mm", angle = "rad" }}

[artefact.bar]
kind = "bar"
length = {BAR_MM}

[noise]
encoder = {ENCODER_RAD}
seat = {SEAT_MM}

[travel]
limits = [{", ".join(f"[{low}, {high}]" for low, high in TRAVEL)}]

[plan]
choose = 100
criterion = "length"
test_length = {LENGTH_MM}
"""


def play(desk: Desk) -> Play:
    """The drawing, the plan and the source, on the desk."""
    drawing = platinum(BENT_PROBE)
    drawn = desk.put("platinum.toml", arm_toml(drawing).encode())
    true = desk.put("virtual-platinum.toml", arm_toml(_truth(drawing)).encode())
    plan = desk.put("bar-plan.toml", PLAN.encode())
    source = f"virtual:{true.sha256}?moves=told&noise={ENCODER_RAD}&rate=500&hand=1.5"
    return Play(arm=drawn.sha256, plan=plan.sha256, source=source, goal_mm=GOAL_MM, length_mm=LENGTH_MM)


def _truth(drawing: Arm) -> Arm:
    """What the hand moves, and nobody knows."""
    rng = np.random.default_rng(SEED)
    names, units = drawing.parameter_names, np.array(drawing.parameter_units)
    off = np.where(units == "mm", OFF_MM, OFF_RAD) * rng.standard_normal(len(units))
    off[[any(fnmatch(name, held) for held in HELD) for name in names]] = 0.0
    return drawing.with_parameters(drawing.core.parameters + off)
