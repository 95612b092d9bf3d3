"""`orientation`: how a target on the last link is turned, as an instrument sees it, a row each: a laser tracker's probe
of six degrees of freedom, a camera. Its positions are readings of `points` beside it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field

import ulna._core as _core
from ulna.arm.attitudes import attitudes
from ulna.arm.conditions import Conditions
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.dimension import Dimension
from ulna.artefacts.entering import enter_rows
from ulna.artefacts.judging import Errors, Tips
from ulna.artefacts.kind import Kind
from ulna.artefacts.mounting import mounting
from ulna.artefacts.readings import Readings
from ulna.artefacts.tables import Place, StatedTable, TouchedTable
from ulna.artefacts.touching import Touches, Touching
from ulna.formats.numbers import Positive, Uncertainty
from ulna.formats.units import RAD_PER
from ulna.geometry.rotation import matrices_of_vectors, vectors_of_matrices
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError

AXES = ("rx", "ry", "rz")
LEVER_MM = 1000.0
"""At which an angle is told as a length: mrad as mm."""
Rotation = Literal[
    "vector", "quaternion", "xyz", "xzy", "yxz", "yzx", "zxy", "zyx", "XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"
]
"""How it may be written: the orders of turns are those of `ulna.geometry.rotation.SEQUENCES`."""


@dataclass(frozen=True)
class Target:
    """What is stated of a target and of who sees it."""

    rotation: Rotation
    rad_per: float
    """rad in one unit of its columns."""
    u_rad: float
    """Standard uncertainty of an orientation about each axis, where rows do not say it."""
    mount_rad: tuple[float, float, float] | None
    """Rotation vector from the target's frame to the probe's; None: to be found."""
    u_mount_rad: float
    fit_mount: bool
    lever_mm: float | None = None
    """None: nobody says it."""

    @property
    def weighs_mm(self) -> float:
        """The lever, or what is taken where nobody says it."""
        return self.lever_mm or LEVER_MM

    @property
    def dimensions(self) -> list[Dimension]:
        """Of the mount."""
        values = self.mount_rad or (0.0, 0.0, 0.0)
        fitted = self.fit_mount or self.mount_rad is None
        return [
            Dimension(axis, value, self.u_mount_rad, fitted, "rad") for axis, value in zip(AXES, values, strict=True)
        ]


class OrientationTable(StatedTable):
    """Orientations of a target on the last link, as an instrument sees them, one a row."""

    kind: Literal["orientation"]
    rotation: Rotation
    """How it is written: "vector", the axis times the angle, in columns rx, ry, rz; "quaternion", in rw, rx, ry, rz; or
    angles about x, y and z in rx, ry, rz, in the order in which they turn: "xyz" about axes that stay, "XYZ" about axes
    that turn along."""
    angle: Literal["rad", "deg"] | None = None
    """Unit of its columns, of `u` and of `mount`; the study's angle unit where it is not given."""
    frame: Literal["free", "arm"] = "free"
    """"arm": the instrument's axes are those of the arm's base frame; "free": each placement is a standing of the
    instrument, turned as nobody knows."""
    u: Uncertainty = 0.0
    """Standard uncertainty of an orientation about each axis, where no column `ur` says it of each."""
    mount: Annotated[list[float], Field(min_length=3, max_length=3)] | None = None
    """Rotation vector from the target's frame to the probe's, which turns with the last link; found where not given."""
    u_mount: Uncertainty = 0.0
    """Standard uncertainty of the mount about each axis."""
    fit_mount: bool = False
    """Whether a mount that is given is fitted: within its uncertainty, or freely where none is stated."""
    lever: Positive | None = None
    """How far from the tip an error of orientation counts as one of a place; with 1 m, 1 mrad counts as 1 mm. It weighs
    orientations where no noise is stated; not given, both weigh so that they scatter alike."""

    def made(self, name: str, place: Place) -> Artefact:
        """Without features: nobody touches it. Raises UlnaInputError for a mount that is uncertain and not there."""
        rad = RAD_PER[self.angle or place.units.angle]
        if self.mount is None and (self.u_mount or self.fit_mount):
            key = "u_mount" if self.u_mount else "fit_mount"
            raise UlnaInputError(
                f"{place.path}: key 'artefact.{name}.{key}': says how well the mount is known, but the key 'mount' is "
                "missing; expected the rotation vector that it is about. Add it, or remove the key: it is then found."
            )
        mount_rad = None if self.mount is None else (self.mount[0] * rad, self.mount[1] * rad, self.mount[2] * rad)
        if mount_rad is not None and math.hypot(*mount_rad) > math.tau:
            raise UlnaInputError(
                f"{place.path}: key 'artefact.{name}.mount': got {self.mount}, more than a whole turn; expected a "
                f"rotation vector in {self.angle or place.units.angle}. State its unit with the key 'angle'."
            )
        lever_mm = None if self.lever is None else self.lever * place.units.mm
        u_rad, u_mount_rad = self.u * rad, self.u_mount * rad
        own = Target(self.rotation, rad, u_rad, mount_rad, u_mount_rad, self.fit_mount, lever_mm)
        return Artefact(name, "orientation", {}, None, 0.0, self.frame, own=own)


class SimulatedOrientation(OrientationTable, TouchedTable):
    """A target, and in how many poses it is seen."""


def target(artefact: Artefact) -> Target:
    """What is stated of an artefact of this kind."""
    assert isinstance(artefact.own, Target)
    return artefact.own


class Orientation(Kind):
    """One orientation a row."""

    name = "orientation"
    table, simulated = OrientationTable, SimulatedOrientation
    named, scattered, turned = False, True, True
    residual_columns = ("turn_x_mm", "turn_y_mm", "turn_z_mm")
    placements, touches = 2, 40
    size_mm = (400.0, 400.0)

    def dimensions(self, artefact: Artefact) -> list[Dimension]:
        """The mount's three angles."""
        return target(artefact).dimensions

    def certain(self, artefact: Artefact) -> Artefact:
        """With the mount that is stated; one that is to be found still is."""
        own = target(artefact)
        return replace(
            artefact, own=replace(own, mount_rad=own.mount_rad or (0.0, 0.0, 0.0), u_mount_rad=0.0, fit_mount=False)
        )

    def check_noise(self, group: Readings, label: str) -> None:
        """Its own uncertainty is stated beside the arm's noise. Raises UlnaInputError."""
        if group.rotation_u_rad is None or not (group.rotation_u_rad > 0.0).all():
            raise UlnaInputError(
                f"{label}: artefact '{group.artefact.name}': the study states the noise of the arm, but not how "
                "uncertain these orientations are; expected their standard uncertainty, which weighs them against "
                f"other readings. Add the key 'artefact.{group.artefact.name}.u', or a column 'ur', above 0."
            )

    def enter(self, problem: _core.Problem, group: Readings, balls_mm: F64, conditions: list[Conditions]) -> None:
        """With the mount that fits best at the start, where none is stated."""
        own = target(group.artefact)
        stated = own.dimensions
        if own.mount_rad is None:
            held = attitudes(problem.arm, np.ascontiguousarray(group.q_rad), group.probe, conditions[0])
            free = group.artefact.frame == "free"
            found = mounting(held, _seen(group), group.placement_code, free)
            start = vectors_of_matrices(found.mount[None])[0].tolist()
            stated = [replace(each, value=value) for each, value in zip(stated, start, strict=True)]
        assert group.rotation_rad is not None
        enter_rows(
            problem,
            "orientation",
            group,
            conditions[0],
            placement=group.placement_code,
            frame=group.artefact.frame,
            rotation_rad=group.rotation_rad,
            rotation_u_rad=group.rotation_u_rad,
            dimensions=[(each.name, each.value, each.u, each.fitted) for each in stated]
            + [("lever", own.weighs_mm, 0.0, False)],
        )

    def errors(self, readings: Readings, tips: Tips) -> dict[str, Errors]:
        """Angles to the orientations measured, in mm at 1 m (mrad); with the frames, and the mount where it is fitted,
        that fit best here."""
        own = target(readings.artefact)
        assert tips.turned is not None
        free = readings.artefact.frame == "free"
        known = own.mount_rad if own.mount_rad is not None and not own.fit_mount else None
        mount = None if known is None else matrices_of_vectors(np.array([known]))[0]
        seen = _seen(readings)
        off_rad = mounting(tips.turned, seen, tips.code, free, mount).off_rad(tips.turned, seen, tips.code)
        return {"orientation_error": Errors(LEVER_MM * np.linalg.norm(off_rad, axis=1), tips.code)}

    def drawn(self, stated: Artefact, rng: np.random.Generator) -> Artefact:
        """The target as it is really mounted: anyhow, where nothing is stated."""
        own = target(stated)
        drawn = rng.standard_normal(3)
        mount = drawn if own.mount_rad is None else np.array(own.mount_rad) + own.u_mount_rad * drawn
        return replace(stated, own=replace(own, mount_rad=tuple(mount.tolist())))

    def touched(self, true: Artefact, how: Touching) -> Touches:
        """The tip anywhere in a cube about the middle of what is seen, by halves of irrational parts."""
        number = np.arange(how.touches)[:, None]
        steps = np.array([0.8191725134, 0.6710436067, 0.5497004779])
        place_mm = how.size_mm[0] * ((0.5 + number * steps) % 1.0 - 0.5)
        probe = np.repeat(how.probes, how.touches)
        centre_mm = np.tile(place_mm, (len(how.probes), 1))
        return Touches(centre_mm, np.zeros_like(centre_mm), probe, np.zeros(len(probe), np.int64))

    def seen(
        self, stated: Artefact, true: Artefact, held: F64, axes: F64, rng: np.random.Generator
    ) -> tuple[F64, F64 | None]:
        """What the instrument says of each row, and how uncertain that is."""
        u_rad, mount = target(stated).u_rad, matrices_of_vectors(np.array([target(true).mount_rad]))[0]
        noise = matrices_of_vectors(u_rad * rng.standard_normal((len(held), 3)))
        turned = axes @ held @ mount @ noise
        return vectors_of_matrices(turned), np.full(len(held), u_rad) if u_rad else None

    def check_simulated(self, table: TouchedTable, key: str) -> None:
        """As rotation vectors in rad, seen from anywhere. Raises UlnaInputError."""
        assert isinstance(table, SimulatedOrientation)
        for name, value, only in (("rotation", table.rotation, "vector"), ("frame", table.frame, "free")):
            if value != only:
                raise UlnaInputError(
                    f'{key}.{name}\': got "{value}", but simulated orientations are written with {name} = "{only}". '
                    "Say so."
                )

    def check_planned(self, artefact: Artefact, touches: int, label: str) -> None:
        """Raises UlnaInputError."""
        raise UlnaInputError(
            f"{label}: artefact '{artefact.name}' is of kind 'orientation'; expected something that is touched: a plan "
            "says where to put it. Plan the points, and read the orientations along with them."
        )

    def written(self, artefact: Artefact, features_file: str) -> dict[str, Any]:
        """All that is stated, in rad."""
        own = target(artefact)
        keys: dict[str, Any] = {"rotation": "vector", "angle": "rad"}
        keys |= {"frame": artefact.frame} if artefact.frame != "free" else {}
        keys |= {"u": own.u_rad} if own.u_rad else {}
        keys |= {"mount": list(own.mount_rad)} if own.mount_rad is not None else {}
        keys |= {"u_mount": own.u_mount_rad} if own.u_mount_rad else {}
        keys |= {"fit_mount": True} if own.fit_mount else {}
        return keys | ({"lever": own.lever_mm} if own.lever_mm is not None else {})


def _seen(group: Readings) -> F64:
    assert group.rotation_rad is not None
    return matrices_of_vectors(group.rotation_rad)


def columns_of(artefact: Artefact) -> Sequence[str]:
    """Of a readings file, in which the orientation stands."""
    return ("rw", *AXES) if target(artefact).rotation == "quaternion" else AXES
