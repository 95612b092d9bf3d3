"""What to simulate, in memory: a true arm, what it touches, and how all of it errs. Units are mm and rad, always.

Made from files by `ulna.simulation.file`, carried out by `ulna.simulate`; nothing here reads, writes or draws.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import Artefact
from ulna.ground.arrays import F64
from ulna.study.data import FitOptions


@dataclass(frozen=True)
class Followed:
    """A plan that the placements follow, P of T touches each."""

    points_mm: F64
    """(P, T, 3) where each touch of the artefact, as it is stated, is in the base frame."""
    q_rad: F64
    """(P, T, n) postures to begin from: the nearest that is on the true point is taken."""


@dataclass(frozen=True)
class Touching:
    """An artefact, and how it is touched."""

    artefact: Artefact
    """As its certificate states it; the true one is drawn within its uncertainty."""
    placements: int
    """How often it stands somewhere; of kind length: rows."""
    touches: int = 1
    """Of each feature with each probe at each placement; of a surface: touches in all, with each probe."""
    probes: tuple[str, ...] = ()
    """With which it is touched; none: the arm's only one."""
    size_mm: tuple[float, float] = (200.0, 200.0)
    """How large a part is touched of what has no end of its own, as its kind understands it."""
    followed: Followed | None = None
    """None: it stands anywhere, and is touched in any posture."""


@dataclass(frozen=True)
class Drawing:
    """How far the arm that is written down is from the true one. The base frame (joint.1.theta0 and d) is right."""

    offset_rad: float = 0.05
    """Zero offsets are off by up to so much, uniformly."""
    length_mm: float = 1.0
    """Lengths are, those of the probes too."""
    twist_rad: float | None = None
    """Twists (alpha, and beta of a Hayati joint) are; None: the drawing says the nearest right angle."""
    effects: bool = False
    """Whether it has the true arm's effects beyond geometry; else only the masses, which are known from the design."""


@dataclass(frozen=True)
class Temperature:
    """Of the arm, one for each placement, °C."""

    mean_c: float
    spread_c: float = 0.0
    """Standard deviation."""


@dataclass(frozen=True)
class Missed:
    """Touches that were none: the ball was not in its seat, or not on the surface."""

    share: float
    """Of all touches."""
    size_mm: float
    """How far off the ball was: in any direction, or off the surface."""


@dataclass(frozen=True)
class Simulation:
    """What to simulate."""

    arm: Arm
    """The truth."""
    touching: list[Touching]
    seed: int = 0
    drawing: Drawing | None = field(default_factory=Drawing)
    """None: the arm that is written down is the true one, with all its effects."""
    encoder_rad: F64 | None = None
    """(n,) standard deviation of each encoder."""
    seat_mm: float = 0.0
    """Of a touch, per coordinate."""
    quantised: bool = True
    """Whether encoders count in steps, where `arm` says how many counts a turn has."""
    travel_rad: F64 | None = None
    """(n, 2) lowest and highest encoder angle; None: the arm's limits, and a whole turn of joints that have none."""
    temperature: Temperature | None = None
    carried: tuple[str, ...] = ()
    """Names of what the arm carries, one of them at each placement; "none": no load."""
    missed: Missed | None = None
    volume_mm: tuple[tuple[float, float, float], tuple[float, float, float]] | None = None
    """Lowest and highest corner of the box, in the base frame, in which artefacts stand; None: all that is in reach."""
    fit: FitOptions = field(default_factory=FitOptions)
    """What the study asks for."""
    path: Path | None = None
    files: tuple[Path, ...] = ()
    """What it was made from, so that nothing of it is overwritten."""

    @property
    def label(self) -> str:
        """How messages call it."""
        return "simulation" if self.path is None else str(self.path)

    @property
    def step_rad(self) -> F64 | None:
        """(n,) one count of each encoder; None where they do not count, or not all say how."""
        counts = [joint.counts_per_turn for joint in self.arm.joints]
        if not self.quantised or None in counts:
            return None
        return 2.0 * np.pi / np.array(counts, dtype=np.float64)

    @property
    def reading_u_rad(self) -> F64 | None:
        """(n,) standard deviation of an encoder reading: noise, and the rounding to counts (uniform over one)."""
        noise = np.zeros(self.arm.n) if self.encoder_rad is None else self.encoder_rad
        rounding = np.zeros(self.arm.n) if self.step_rad is None else self.step_rad / np.sqrt(12.0)
        u_rad: F64 = np.hypot(noise, rounding)
        return u_rad if u_rad.any() else None

    @property
    def limits_rad(self) -> F64:
        """(n, 2) where joints are moved to: the travel, less what noise might read beyond it."""
        if self.travel_rad is not None:
            travel = np.array(self.travel_rad, dtype=np.float64)
        else:
            travel = np.array([joint.travel_rad or (-np.pi, np.pi) for joint in self.arm.joints])
        noise = np.zeros(self.arm.n) if self.encoder_rad is None else self.encoder_rad
        margin = 6.0 * noise + (0.0 if self.step_rad is None else self.step_rad)
        return travel + np.outer(margin, [1.0, -1.0])
