"""Numbers in the attributes of a URDF."""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from ulna.arm.frames.rigid import from_quaternion, from_rpy
from ulna.arm.joint import MOST_RAD
from ulna.exchange.urdf.document import EXPAND
from ulna.formats.cells import number_of
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError

#: no robot is larger (m) or heavier (kg), no joint stands farther round (rad)
MOST = 1e6

#: a quaternion's length may be off by so much: it was written with some digits
UNIT = 1e-3


def vector(element: Element | None, key: str, usual: str, what: str, path: Path) -> F64:
    """(3,) numbers of an attribute, of `usual` where it or its element is not there. Raises UlnaInputError."""
    return _numbers(usual if element is None else element.get(key, usual), 3, key, what, path, MOST)


def rotation_of(origin: Element | None, what: str, path: Path) -> F64:
    """(3, 3) of an `<origin>`, by `rpy` or, in URDF 1.1, by `quat_xyzw`. Raises UlnaInputError."""
    text = None if origin is None else origin.get("quat_xyzw")
    if origin is None or text is None:
        rpy = vector(origin, "rpy", "0 0 0", what, path)
        if np.abs(rpy).max() > MOST_RAD:
            raise UlnaInputError(
                f"{path}: {what}, rpy: got '{' '.join(f'{angle:g}' for angle in rpy)}', more than two turns; expected "
                "rad. Are these degrees? Write them in rad."
            )
        return from_rpy(*rpy)
    if origin.get("rpy") is not None:
        raise UlnaInputError(
            f"{path}: {what}, origin: got rpy '{origin.get('rpy')}' and quat_xyzw '{text}'; expected one of them. "
            "Remove the other."
        )
    quaternion = _numbers(text, 4, "quat_xyzw", what, path, MOST)
    length = float(np.linalg.norm(quaternion))
    if abs(length - 1.0) > UNIT:
        raise UlnaInputError(
            f"{path}: {what}, quat_xyzw: got '{text}', whose length is {length:g}; expected a unit quaternion, of "
            "length 1. Correct it."
        )
    return from_quaternion(quaternion / length)


def number(
    element: Element | None,
    key: str,
    usual: str,
    what: str,
    path: Path,
    least: float = -math.inf,
    most: float = MOST,
    called: str | None = None,
) -> float:
    """The same for one number. Raises UlnaInputError."""
    text = usual if element is None else element.get(key, usual)
    value = float(_numbers(text, 1, called or key, what, path, most)[0])
    if value < least:
        raise UlnaInputError(f"{path}: {what}, {called or key}: got '{text}', expected {least:g} or more. Correct it.")
    return value


def _numbers(text: str, count: int, key: str, what: str, path: Path, most: float) -> F64:
    values = [number_of(part) for part in text.split()]
    if len(values) == count and all(value is not None and abs(value) <= most for value in values):
        return np.array(values, dtype=np.float64)
    expected = {1: "a number", 3: "three numbers", 4: "four numbers"}[count]
    hint = f"This is xacro. {EXPAND}." if "$" in text else "Correct it."
    raise UlnaInputError(f"{path}: {what}, {key}: got '{text[:60]}', expected {expected} (m, rad). {hint}")
