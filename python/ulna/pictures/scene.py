"""An arm as a scene: its bodies, what stands between them, and the shapes of each."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.frames.bodies import bodies, constant_transforms
from ulna.arm.frames.links import link_at_zero
from ulna.ground.arrays import F64
from ulna.pictures import parts
from ulna.pictures.shapes import Shape, at, extent, tube

LONGEST_NAME = 24
"""Of a joint, in letters; a longer one would hide the arm."""


@dataclass(frozen=True)
class Scene:
    """What is drawn of an arm with one of its probes on."""

    arm: Arm
    probe: str
    shapes: list[Shape]
    step_mm: float
    """Between the lines of the floor, which is the plane z = 0 of the base frame."""
    reach_mm: float
    """Sum of the lengths of all links and the tip."""

    def tip_mm(self, q_rad: F64) -> F64:
        """(3,) in the base frame: of links and axes alone, without effects beyond geometry."""
        after = constant_transforms(self.arm)[-1]
        tip_mm = self.arm.probes[self.probe].tip_mm
        found: F64 = at(bodies(self.arm, q_rad)[-1] @ after, tip_mm)[0]
        return found

    def extent(self, q_rad: F64) -> tuple[F64, float]:
        """Middle (3,) of the arm in a pose, and how far its farthest part is from there, mm."""
        stand = bodies(self.arm, q_rad)
        return extent([at(stand[s.body], s.points_mm) for s in self.shapes if s.group in ("arm", "axes", "frames")])


def scene(arm: Arm, probe: str | None = None, thickness: float = 0.01) -> Scene:
    """The arm with a probe on; None: its first. thickness: of joints, arrows and the like, as a share of the reach.
    Raises UlnaInputError for a probe that it has not."""
    name = next(iter(arm.probes)) if probe is None else list(arm.probes)[arm.probe_index(probe)]
    reach_mm = max(arm.core.reach_mm(arm.probe_index(name)), 1.0)
    unit_mm = thickness * reach_mm
    step_mm = round_step(reach_mm / 7.0)
    found = [*floor(step_mm, reach_mm), *_base(unit_mm)]
    constant = constant_transforms(arm)
    for k, joint in enumerate(arm.joints, start=1):
        label = f"{k}" if joint.name is None else f"{k} {joint.name[:LONGEST_NAME]}"
        found += parts.axis(k - 1, k, joint.sign, label, constant[k - 1], unit_mm)
        found += parts.frame(k - 1, k - 1, constant[k - 1], unit_mm)
        found += parts.barrel(k, k, unit_mm)
        if k < arm.n or arm.full_last_link:
            found += parts.link(k, joint, unit_mm)
            found += parts.dimensions(k, joint, unit_mm)
    if arm.full_last_link:
        found += parts.frame(arm.n, arm.n, constant[-1], unit_mm)
    tip = arm.probes[name]
    end = link_at_zero(arm.joints[-1]) if arm.full_last_link else np.eye(4)
    own = [
        Shape(s.kind, s.body, s.group, s.role, at(end, s.points_mm), s.joint, s.text, s.radius_mm)
        for s in parts.probe(arm.n, arm.n, tip.tip_mm, tip.ball_mm, name[:LONGEST_NAME], unit_mm)
    ]
    return Scene(arm, name, [*found, *own], step_mm, reach_mm)


def floor(step_mm: float, reach_mm: float) -> Iterator[Shape]:
    """Lines on the plane z = 0 of the base frame, as far as half the reach."""
    count = math.ceil(0.5 * reach_mm / step_mm)
    half = count * step_mm
    for k in range(-count, count + 1):
        role = "grid" if k else "grid-axis"
        for line in (((k, -count), (k, count)), ((-count, k), (count, k))):
            yield Shape("line", 0, "floor", role, np.array([[x * step_mm, y * step_mm, 0.0] for x, y in line]))
    for name, x, y in (("x", half, 0.0), ("y", 0.0, half)):
        place = np.array([[x, y, 0.0]]) * (1.0 + 0.3 / count)
        yield Shape("word", 0, "floor", "grid-name", place, text=name)


def round_step(about: float) -> float:
    """1, 2 or 5 times a power of ten, the largest that is not above."""
    power = 10.0 ** math.floor(math.log10(about))
    return float(power * max(step for step in (1.0, 2.0, 5.0) if step * power <= about * (1.0 + 1e-9)))


def _base(unit_mm: float) -> Iterator[Shape]:
    """A foot under axis 1."""
    yield Shape(
        "solid", 0, "arm", "foot", tube([0.0, 0.0, -5.0 * unit_mm], [0.0, 0.0, -3.4 * unit_mm], 5.0 * unit_mm, 24)
    )
