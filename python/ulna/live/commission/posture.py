"""A posture that a person can take by eye, said in words, and how each joint is turned from there.

The encoders' readings in it give the zeros to some degrees, and which way the tip goes gives the signs. mm and rad,
base frame: x is forward, y to the left, z up.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.frames.bodies import bodies
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded

RIGHT_ANGLES = (0.0, math.pi / 2, -math.pi / 2, math.pi)
LEVER = 0.1
"""Of the reach: what is nearer to an axis does not show by its way how the joint turns."""
CLOSE = 0.02
"""Of the reach: nearer points are one place."""
FREE = 0.1
"""Of the reach: links that come nearer to each other are in each other's way."""
ALONG = math.cos(math.radians(10.0))
"""A direction this near to one of the six is called by its name alone."""
_WORDS = (
    (worded("forward"), worded("back")),
    (worded("to the left"), worded("to the right")),
    (worded("up"), worded("down")),
)
_STRAIGHT = worded("straight up"), worded("straight down")
_SEEN = (
    (worded("in front"), worded("behind")),
    (worded("the left"), worded("the right")),
    (worded("above"), worded("below")),
)


@dataclass(frozen=True)
class Posture:
    """The posture."""

    turned_rad: F64
    """(n,) turns of the joints in it, as drawn: `sign * encoder - theta0`."""
    words: tuple[str, ...]
    """How the arm lies in it, from the base to the tip, a line each."""
    ways: tuple[str, ...]
    """Of each joint, how it is turned from there so that it counts as positive."""


def posture(arm: Arm, stated_rad: Sequence[float] | None = None) -> Posture:
    """The posture to commission an arm in. stated_rad: (n,) encoder angles as drawn, where somebody prefers their own.

    Without them, of all postures with right angles at joints 2 to n - 1, within limits, above the base and with free
    links, that in which the joint that shows least by its own turn shows most. A joint whose sign nobody knows is taken
    as drawn with sign 1. Raises UlnaInputError where stated ones are not n, or none is found.
    """
    arm = replace(arm, joints=tuple(replace(joint, sign=joint.sign or 1) for joint in arm.joints))
    if stated_rad is not None:
        if len(stated_rad) != arm.n:
            raise UlnaInputError(
                f"--posture: got {len(stated_rad)} angles, expected {arm.n}, one for each joint. Correct it."
            )
        chosen = np.array(stated_rad, dtype=np.float64)
    else:
        chosen = _chosen(arm)
    theta0 = np.array([joint.theta0_rad for joint in arm.joints])
    points, axes = _points_and_axes(arm, chosen)
    reach_mm = arm.core.reach_mm(0)
    return Posture(
        arm.signs * chosen - theta0,
        tuple(_lying(points, reach_mm)),
        tuple(_way(k, points, axes, reach_mm) for k in range(arm.n)),
    )


def _chosen(arm: Arm) -> F64:
    signs, reach_mm = arm.signs, arm.core.reach_mm(0)
    each: list[list[float]] = []
    for k, joint in enumerate(arm.joints):
        turned = RIGHT_ANGLES if 0 < k < arm.n - 1 else RIGHT_ANGLES[:1]
        angles = [math.remainder(signs[k] * (angle + joint.theta0_rad), 2 * math.pi) for angle in turned]
        low, high = joint.travel_rad or (-math.inf, math.inf)
        within = [angle for angle in angles if low <= angle <= high]
        if not within and k in (0, arm.n - 1):
            within = [(low + high) / 2.0]
        each.append(within)
    postures = np.array(list(product(*each)))
    if not len(postures):
        narrow = next(k + 1 for k, angles in enumerate(each) if not angles)
        raise UlnaInputError(
            f"arm '{arm.name}': joint {narrow} is at a right angle nowhere within its limits, so that no posture is "
            "found that is easy to say. State one with --posture, or give --zeros unknown."
        )
    found = [_points_and_axes(arm, q_rad) for q_rad in postures]
    levers = np.array([[_lever(k, *each)[1] for k in range(arm.n)] for each in found])
    shown = (levers / np.maximum(levers.max(axis=0), 1e-9)).min(axis=1)
    under = np.array([min(points[:, 2].min(), 0.0) < -CLOSE * reach_mm for points, _ in found])
    folded = np.array([_folded(points, reach_mm) for points, _ in found])
    forward = np.array([points[-1, 0] - abs(points[-1, 1]) for points, _ in found]) / reach_mm
    turned = np.abs(np.array([signs * q for q in postures])).sum(axis=1) / math.pi
    best: F64 = postures[
        int((np.round(shown, 2) - 0.5 * under - 0.5 * folded + 0.02 * forward - 0.01 * turned).argmax())
    ]
    return best


def _points_and_axes(arm: Arm, q_rad: F64) -> tuple[F64, F64]:
    """(n + 1, 3) where each joint's axis has its frame, then the tip; (n, 3) the axes."""
    frames = bodies(arm, q_rad)
    tip_mm = arm.core.tip(np.ascontiguousarray(q_rad[None]), 0)
    points: F64 = np.vstack([*(frame[:3, 3] for frame in frames[1:]), tip_mm])
    return points, np.array([frame[:3, 2] for frame in frames[1:]])


def _lever(joint: int, points: F64, axes: F64) -> tuple[int, float]:
    """The point beyond a joint that is farthest from its axis, and how far."""
    beyond = points[joint + 1 :] - points[joint]
    across = beyond - np.outer(beyond @ axes[joint], axes[joint])
    far = np.linalg.norm(across, axis=1)
    # the tip, where it goes about as far: that is what people look at
    best = len(far) - 1 if far[-1] > 0.7 * far.max() else int(far.argmax())
    return joint + 1 + best, float(far[best])


def _folded(points: F64, reach_mm: float) -> bool:
    places = _places(points, reach_mm)
    at = np.array([points[own[0]] for own in places])
    apart = np.linalg.norm(at[:, None] - at[None], axis=2)
    return bool((apart[np.triu_indices(len(at), 2)] < FREE * reach_mm).any())


def _places(points: F64, reach_mm: float) -> list[list[int]]:
    """Points one after another that are at one place."""
    places = [[0]]
    for k in range(1, len(points)):
        if np.linalg.norm(points[k] - points[places[-1][-1]]) < CLOSE * reach_mm:
            places[-1].append(k)
        else:
            places.append([k])
    return places


def _name(own: Sequence[int], count: int) -> str:
    if own[-1] == count - 1:
        return worded("the tip")
    if len(own) == 1:
        return worded("joint {joint}", joint=own[0] + 1)
    return worded("joints {first}–{last}", first=own[0] + 1, last=own[-1] + 1)


def _lying(points: F64, reach_mm: float) -> list[str]:
    places = _places(np.vstack([np.zeros(3), points]), reach_mm)
    count, lines = len(points), list[str]()
    before, name = np.zeros(3), worded("the base")
    for own in places:
        joints = [k - 1 for k in own if k > 0]
        if not joints:
            continue
        here = points[joints[-1]]
        step = here - before
        if np.linalg.norm(step) >= CLOSE * reach_mm:
            lines.append(
                worded(
                    "from {one} to {other}: {far} mm {direction}",
                    one=name,
                    other=_name(joints, count),
                    far=f"{np.linalg.norm(step):.0f}",
                    direction=direction(step),
                )
            )
        before, name = here, _name(joints, count)
    return lines


def _way(joint: int, points: F64, axes: F64, reach_mm: float) -> str:
    which, far = _lever(joint, points, axes)
    if far < LEVER * reach_mm:
        return worded("anticlockwise, seen from {side}", side=seen_from(axes[joint]))
    goes = np.cross(axes[joint], points[which] - points[joint])
    return worded("so that {what} goes {direction}", what=_name([which], len(points)), direction=direction(goes))


def direction(step: F64) -> str:
    """A direction in words."""
    unit = step / np.linalg.norm(step)
    order = np.argsort(-np.abs(unit))
    names = [_WORDS[k][0 if unit[k] > 0 else 1] for k in order]
    if abs(unit[order[0]]) >= ALONG:
        return _STRAIGHT[0 if unit[2] > 0 else 1] if order[0] == 2 else names[0]
    if abs(unit[2]) >= 1.0 - ALONG:
        level = unit[:2] / max(float(np.linalg.norm(unit[:2])), 1e-12)
        above = math.degrees(math.asin(float(unit[2])))
        said = {"direction": _level(level), "degrees": f"{abs(above):.0f}"}
        if above > 0:
            return worded("{direction}, {degrees}° above level", **said)
        return worded("{direction}, {degrees}° below level", **said)
    return _level(unit[:2])


def _level(unit: F64) -> str:
    order = np.argsort(-np.abs(unit))
    names = [_WORDS[k][0 if unit[k] > 0 else 1] for k in order]
    if abs(unit[order[0]]) >= ALONG:
        return names[0]
    aside = math.degrees(math.asin(abs(float(unit[order[1]]))))
    return worded("{direction}, turned {degrees}° {aside}", direction=names[0], degrees=f"{aside:.0f}", aside=names[1])


def seen_from(axis: F64) -> str:
    """From where one looks against an axis."""
    k = int(np.abs(axis).argmax())
    return _SEEN[k][0 if axis[k] > 0 else 1]
