"""The arms of the paper. Angles rad, lengths mm."""

from __future__ import annotations

import math

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.simulation.reading_errors import ReadingErrors
from ulna.simulation.virtual_arm import VirtualArm

_QUARTER = math.pi / 2

#: theta0, alpha, a, d of joints 1 to 6
Links = tuple[tuple[float, float, float, float], ...]

TABLE_2: Links = (
    (0.0, -_QUARTER, 40.0, 250.0),
    (2.2689, _QUARTER, -40.0, 0.0),
    (0.0, -_QUARTER, 30.0, 450.0),
    (2.2689, _QUARTER, -30.0, 0.0),
    (0.0, -_QUARTER, 30.0, 450.0),
    (2.2689, _QUARTER, -30.0, 0.0),
)
"""The assumed truth; the probe has theta0 = 0, h = 200, r = 0 or 10."""

TABLE_3: Links = (
    (0.1, -1.57, 35.0, 260.0),
    (2.2, 1.57, -35.0, 0.0),
    (0.1, -1.57, 35.0, 400.0),
    (2.2, 1.57, -35.0, 0.0),
    (0.1, -1.57, 35.0, 400.0),
    (2.2, 1.57, -35.0, 0.0),
)
"""Where the fit starts; the probe has theta0 = 0.1, h = 180; r is not given."""

TABLE_4: Links = (
    (1.521927, -1.572781, 42.4754, 149.7000),
    (0.791659, 1.567756, -42.0588, -0.9472),
    (0.022211, -1.570242, 28.5382, 439.5104),
    (0.879434, 1.568061, -28.5351, -0.8421),
    (0.032396, -1.574439, 28.5535, 439.4015),
    (0.860088, 1.572594, -28.5478, -0.9604),
)
"""A real arm, as the paper's authors calibrated it."""

#: theta0, r, h of the probes of that arm
BENT_PROBE = (0.431148, 39.4321, 223.8773)
STRAIGHT_PROBE = (-1.8676, 0.0965, 238.5596)

BAR_MM = 443.172
RATED_MM = 0.037
"""The arm's rated length accuracy: ten fresh measurements of the bar stayed within ± this."""
ENCODER_RAD = 5e-6
SEAT_MM = 0.008
"""Noise of the virtual experiments, standard deviations: of each encoder, and of a touch per coordinate."""


def arm_of(name: str, links: Links, probe: Probe) -> Arm:
    """Six links and a probe as a seven-axis arm."""
    return Arm(name, (*(Joint(*link) for link in links), Joint()), {"bent": probe})


def simulated(r_mm: float) -> tuple[Arm, Arm]:
    """Truth (Table 2) and start (Table 3) for a probe bent by `r_mm`."""
    truth = arm_of("Table 2", TABLE_2, Probe.from_cylindrical(0.0, r_mm, 200.0))
    start = arm_of("Table 3", TABLE_3, Probe.from_cylindrical(0.1, r_mm, 180.0))
    return truth, start


def platinum(probe: tuple[float, float, float]) -> Arm:
    """The arm of Table 4 with one of its probes."""
    return arm_of("FARO Platinum (Table 4)", TABLE_4, Probe.from_cylindrical(*probe))


def virtual(arm: Arm) -> VirtualArm:
    """With limits of travel: the paper gives none. Swivels turn once, hinges from -0.3 to 2.7 rad.

    A hinge (joints 2, 4, 6) at turn 0 stretches the arm straight.
    """
    limits = np.tile([-math.pi, math.pi], (arm.n, 1))
    for i in (1, 3, 5):
        limits[i] = arm.joints[i].theta0_rad + np.array([-0.3, 2.7])
    return VirtualArm(arm, limits, ReadingErrors(np.full(arm.n, ENCODER_RAD), SEAT_MM))
