"""What moves with a joint of a URDF: the masses of its links up to the next joint of the chain, and their centre."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from ulna.arm.frames.rigid import from_rpy, pose
from ulna.exchange.urdf.numbers import number, vector
from ulna.ground.arrays import F64


@dataclass(frozen=True)
class Mass:
    """Of several links together."""

    kg: float = 0.0
    centre_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """In the frame of the joint that moves them."""


NO_MASS = Mass()


def origin_of(element: Element, what: str, path: Path) -> F64:
    """(4, 4) of its `<origin>`, mm; the identity where there is none. Raises UlnaInputError."""
    origin = element.find("origin")
    xyz_m = vector(origin, "xyz", "0 0 0", what, path)
    return pose(from_rpy(*vector(origin, "rpy", "0 0 0", what, path)), 1000.0 * xyz_m)


def mass_behind(
    link: str,
    stop: Element | None,
    links: Mapping[str, Element],
    below: Mapping[str, Sequence[tuple[Element, str]]],
    path: Path,
) -> Mass:
    """Of a link and all that hangs on it, but for what lies behind the joint `stop`; joints beside the chain at zero.

    links: by name; below: link → joints and links on it. Raises UlnaInputError for numbers that are none.
    """
    kg, moment = 0.0, np.zeros(3)
    rest = [(link, np.eye(4))]
    while rest:
        name, t = rest.pop()
        inertial = links[name].find("inertial") if name in links else None
        if inertial is not None:
            what = f"link '{name}'"
            own_kg = number(inertial.find("mass"), "value", "0", what, path, least=0.0)
            centre = t @ origin_of(inertial, what, path)
            kg, moment = kg + own_kg, moment + own_kg * centre[:3, 3]
        for joint, child in below.get(name, ()):
            if joint is not stop:
                rest.append((child, t @ origin_of(joint, f"joint '{joint.get('name')}'", path)))
    if kg == 0.0:
        return NO_MASS
    x, y, z = (moment / kg).tolist()
    return Mass(kg, (x, y, z))
