"""Numbers in the attributes of a URDF."""

from __future__ import annotations

import math
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from ulna.exchange.urdf.document import EXPAND
from ulna.formats.cells import number_of
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError

#: no robot is larger (m) or heavier (kg), no joint stands farther round (rad)
MOST = 1e6


def vector(element: Element | None, key: str, usual: str, what: str, path: Path) -> F64:
    """(3,) numbers of an attribute, of `usual` where it or its element is not there. Raises UlnaInputError."""
    return _numbers(usual if element is None else element.get(key, usual), 3, key, what, path, MOST)


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
    expected = "three numbers" if count == 3 else "a number"
    hint = f"This is xacro. {EXPAND}." if "$" in text else "Correct it."
    raise UlnaInputError(f"{path}: {what}, {key}: got '{text[:60]}', expected {expected} (m, rad). {hint}")
