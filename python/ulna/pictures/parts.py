"""Parts of an arm as shapes: a joint, a link, a frame, an axis, and the lines that show what a parameter is."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ulna.arm.frames.links import link_at_zero
from ulna.arm.frames.rigid import turn
from ulna.arm.joint import Joint
from ulna.ground.arrays import F64
from ulna.pictures.shapes import Group, Shape, arc, at, cone, ring, tube

NOTHING_MM, NOTHING_RAD = 1e-3, 1e-5
"""Lengths and angles that no picture shows."""
X, Y, Z = np.eye(3)
SENSE_RAD = 1.4 * math.pi
"""Of the arrow that says which way an encoder counts."""


def barrel(body: int, joint: int, unit_mm: float) -> Iterator[Shape]:
    """A joint as a cylinder on its axis, with a mark on its ends that turns along."""
    radius, half = 2.6 * unit_mm, 3.4 * unit_mm
    yield Shape("solid", body, "arm", "joint", tube(-half * Z, half * Z, radius, 24), joint)
    for side in (1.0, -1.0):
        end = side * half * Z
        yield Shape("face", body, "arm", "cap", ring(end, side * Z, radius, 24), joint)
        mark = np.array([0.25 * radius, 0.0, 0.0]), np.array([0.95 * radius, 0.0, 0.0])
        width = np.array([0.0, 0.09 * radius * side, 0.0])
        corners = [end + mark[0] - width, end + mark[1] - width, end + mark[1] + width, end + mark[0] + width]
        yield Shape("face", body, "arm", "mark", np.array(corners), joint)


def link(body: int, joint: Joint, unit_mm: float) -> Iterator[Shape]:
    """From the joint's axis to the end of its link: along the axis by d, then along the common normal by a."""
    turned, end = _corners(joint)
    for start, stop in ((np.zeros(3), turned), (turned, end)):
        points = tube(start, stop, 1.25 * unit_mm)
        if len(points):
            yield Shape("solid", body, "arm", "link", points, body)


def frame(body: int, number: int, transform: F64, unit_mm: float) -> Iterator[Shape]:
    """A Denavit–Hartenberg frame: arrows x, y, z with their names, `number` being that of the link at whose end it is.
    transform: (4, 4) in the body's frame."""
    length = 8.0 * unit_mm
    for axis, direction in zip("xyz", np.eye(3), strict=True):
        yield from arrow(body, "frames", axis, transform, np.zeros(3), length * direction, 0.55 * unit_mm)
        at_mm = at(transform, 1.16 * length * direction)
        yield Shape("word", body, "frames", f"{axis}-name", at_mm, text=f"{axis}{number}")


def axis(body: int, joint: int, sign: int, name: str, transform: F64, unit_mm: float) -> Iterator[Shape]:
    """The axis of a joint with its name, and an arrow about it in the sense in which the encoder counts up. body: the
    one that it is fixed to, before the joint. sign: 0 where it is not known."""
    low, high = -9.0 * unit_mm, 15.0 * unit_mm
    yield Shape("line", body, "axes", "axis", at(transform, [low * Z, high * Z]), joint)
    yield Shape("word", body, "axes", "axis-name", at(transform, (high + 2.2 * unit_mm) * Z), joint, name)
    if sign:
        radius, centre = 2.6 * unit_mm, 12.5 * unit_mm * Z
        turned = arc(centre, X, Z, sign * SENSE_RAD, radius)
        yield Shape("line", body, "axes", "sense", at(transform, turned), joint)
        ahead = turned[-1] + 1.6 * unit_mm * _direction(turned[-1] - turned[-2])
        yield Shape("solid", body, "axes", "sense-head", at(transform, cone(turned[-1], ahead, 0.6 * unit_mm)), joint)


def probe(body: int, number: int, tip_mm: F64, ball_mm: float | None, name: str, unit_mm: float) -> Iterator[Shape]:
    """From the last frame along its axis, then across to the tip; the ball at its own size. tip_mm: (3,)."""
    turned = np.array([0.0, 0.0, tip_mm[2]])
    for start, stop in ((np.zeros(3), turned), (turned, tip_mm)):
        points = tube(start, stop, 0.7 * unit_mm, 8)
        if len(points):
            yield Shape("solid", body, "arm", "probe", points, number)
    yield Shape("ball", body, "arm", "tip", tip_mm[None], number, radius_mm=(ball_mm or 0.0) / 2.0)
    yield Shape("word", body, "axes", "tip-name", tip_mm[None], number, name)


def dimensions(body: int, joint: Joint, unit_mm: float) -> Iterator[Shape]:
    """What theta0, alpha, a, d and beta of a link are, each where it is not zero.

    theta0: from the link to where x of the frame before stands at encoder 0. alpha: from the direction of this axis to
    that of the next, about the link.
    """
    turned, end = _corners(joint)
    radius = 6.5 * unit_mm
    rz = turn("z", -joint.theta0_rad)
    along = rz @ X
    for name, start, stop in (("d", np.zeros(3), turned), ("a", turned, end)):
        if float(np.linalg.norm(stop - start)) > NOTHING_MM:
            yield Shape("line", body, "dimensions", "length", np.array([start, stop]), body)
            yield Shape("word", body, "dimensions", "length-name", ((start + stop) / 2.0)[None], body, name)
    before = rz @ turn("x", joint.alpha_rad)
    angles = (
        ("theta0", turned, along, Z, joint.theta0_rad, X),
        ("alpha", end, Z, along, joint.alpha_rad, Z),
        ("beta", end, before @ Z, before @ Y, joint.beta_rad, before @ Z),
    )
    for name, centre, start, about, angle_rad, reference in angles:
        if abs(angle_rad) > NOTHING_RAD:
            shown = math.remainder(angle_rad, 2.0 * math.pi)
            bent = arc(centre, start, about, shown, radius)
            middle = arc(centre, start, about, shown / 2.0, 1.4 * radius)[-1:]
            line = np.array([centre, centre + 1.25 * radius * reference])
            yield Shape("line", body, "dimensions", "reference", line, body)
            yield Shape("line", body, "dimensions", "angle", bent, body)
            yield Shape("word", body, "dimensions", "angle-name", middle, body, name)


def arrow(
    body: int, group: Group, role: str, transform: F64, start_mm: F64, end_mm: F64, width_mm: float
) -> Iterator[Shape]:
    """A line with a head."""
    neck = end_mm - 3.2 * width_mm * _direction(end_mm - start_mm)
    yield Shape("line", body, group, role, at(transform, [start_mm, neck]))
    yield Shape("solid", body, group, f"{role}-head", at(transform, cone(neck, end_mm, width_mm)))


def _corners(joint: Joint) -> tuple[F64, F64]:
    """(3,) each: where the link leaves the joint's axis, and its end."""
    return np.array([0.0, 0.0, joint.d_mm]), link_at_zero(joint)[:3, 3]


def _direction(vector: F64) -> F64:
    found: F64 = vector / float(np.linalg.norm(vector))
    return found
