"""The joints of a URDF from its root to a link: which there are, and that an arm can be made of them."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from ulna.exchange.urdf.document import WHAT, Document, read_document
from ulna.exchange.urdf.masses import NO_MASS, Mass, mass_behind, origin_of
from ulna.exchange.urdf.numbers import MOST, number, vector
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError, nearest

TURNING = ("revolute", "continuous")

#: the name of a link that is the tip where nothing else is said
USUAL_TIP = "ball_link"


@dataclass(frozen=True)
class Step:
    """One joint of a chain: a fixed transform, then, unless fixed, a turn about an axis."""

    name: str
    t_parent_joint: F64
    """(4, 4), mm."""
    axis: F64 | None
    """(3,) unit vector in the joint's frame; None for a fixed joint."""
    limits_rad: tuple[float, float] | None = None
    mass: Mass = NO_MASS
    """Of what moves with it, up to the next rotary joint."""
    element: Element | None = field(default=None, compare=False, repr=False)
    """Where it comes from."""


@dataclass(frozen=True)
class Chain:
    """The joints from a root to a tip."""

    name: str
    """Of the robot."""
    steps: tuple[Step, ...]
    path: Path
    base_link: str = "base_link"
    tip_link: str = USUAL_TIP

    @property
    def turning(self) -> list[Step]:
        """Its rotary joints."""
        return [step for step in self.steps if step.axis is not None]


def read_chain(path: Path, tip_link: str | None = None, base_link: str | None = None) -> Chain:
    """The chain from one link, or the root, to another; without `tip_link` to `ball_link`, or to the outermost link of
    the longest chain.

    Raises UlnaInputError for a file that is no URDF, an unknown link, two longest chains, or a joint on the way whose
    angle no encoder of its own gives.
    """
    return chain_of(read_document(path), tip_link, base_link)


def chain_of(document: Document, tip_link: str | None = None, base_link: str | None = None) -> Chain:
    """The same of a document that is read already."""
    above = _above(document)
    ends = _ends(above, document.path)
    if base_link is not None:
        above, ends = _from(base_link, above, document.path)
    if not ends:
        raise UlnaInputError(f"{document.path}: there are no joints; expected {WHAT} with at least two rotary joints.")
    if tip_link is None:
        tip_link = _outermost(ends, document.path)
    if tip_link not in ends:
        raise UlnaInputError(
            f"{document.path}: there is no link '{tip_link}' below a joint; expected the name of one."
            f"{nearest(tip_link, ends)}"
        )
    way: list[Element] = []
    link = tip_link
    while link in above:
        link, joint = above[link]
        way.insert(0, joint)
    steps = _with_masses([_step(joint, document.path) for joint in way], document)
    return Chain(document.robot.get("name") or document.path.stem, steps, document.path, link, tip_link)


def _with_masses(steps: list[Step], document: Document) -> tuple[Step, ...]:
    links = {link.get("name", ""): link for link in document.robot.findall("link")}
    below: defaultdict[str, list[tuple[Element, str]]] = defaultdict(list)
    for child, (parent, joint) in _above(document).items():
        below[parent].append((joint, child))
    found: list[Step] = []
    stop: Element | None = None
    for step in reversed(steps):
        if step.axis is not None and step.element is not None:
            child = _link(step.element, "child", document.path)
            step = replace(step, mass=mass_behind(child, stop, links, below, document.path))
            stop = step.element
        found.insert(0, step)
    return tuple(found)


def _above(document: Document) -> dict[str, tuple[str, Element]]:
    """Link → the link above it, and the joint between them."""
    above: dict[str, tuple[str, Element]] = {}
    for joint in document.robot.findall("joint"):
        parent, child = (_link(joint, role, document.path) for role in ("parent", "child"))
        if child in above:
            raise UlnaInputError(
                f"{document.path}: link '{child}' is the child of two joints, '{above[child][1].get('name')}' and "
                f"'{joint.get('name')}'; expected one. Remove or rename one of them."
            )
        above[child] = (parent, joint)
    return above


def _link(joint: Element, role: str, path: Path) -> str:
    element = joint.find(role)
    name = None if element is None else element.get("link")
    if name is None:
        raise UlnaInputError(
            f"{path}: joint '{joint.get('name')}' names no {role} link; expected <{role} link=\"…\"/>. Add it."
        )
    return name


def _from(
    base_link: str, above: dict[str, tuple[str, Element]], path: Path
) -> tuple[dict[str, tuple[str, Element]], dict[str, _End]]:
    """The same with a link as root: without what is above it, or beside it."""
    rest = {link: entry for link, entry in above.items() if link != base_link}
    ends = {link: end for link, end in _ends(rest, path).items() if end.root == base_link}
    if not ends:
        parents = [parent for parent, _ in above.values()]
        raise UlnaInputError(
            f"{path}: there is no link '{base_link}' above a joint; expected the name of one."
            f"{nearest(base_link, dict.fromkeys(parents))}"
        )
    return rest, ends


@dataclass(frozen=True)
class _End:
    """What lies between the root and a link."""

    root: str
    joints: int = 0
    turning: int = 0
    last: str = ""
    """The last rotary joint."""
    usable: bool = True
    """Only rotary joints with encoders of their own, and fixed ones."""

    def below(self, joint: Element) -> _End:
        turns = joint.get("type") in TURNING
        return _End(
            self.root,
            self.joints + 1,
            self.turning + turns,
            (joint.get("name") or "?") if turns else self.last,
            self.usable and (joint.get("type") == "fixed" or (turns and joint.find("mimic") is None)),
        )


def _ends(above: dict[str, tuple[str, Element]], path: Path) -> dict[str, _End]:
    """Of every link below a joint, in the order of the file."""
    known: dict[str, _End] = {}
    for link in above:
        way: dict[str, Element] = {}
        at = link
        while at in above and at not in known:
            if at in way:
                raise UlnaInputError(
                    f"{path}: the joints {_listed(joint.get('name') for joint in way.values())} go round in a circle; "
                    "expected a tree from one root. Correct their parents."
                )
            parent, way[at] = above[at]
            at = parent
        end = known.get(at, _End(at))
        for child in reversed(way):
            end = known[child] = end.below(way[child])
    return {link: known[link] for link in above}


def _listed(names: Iterable[str | None]) -> str:
    shown = [f"'{name}'" for name in names]
    return ", ".join(shown[:8]) + (", …" if len(shown) > 8 else "")


def _outermost(ends: dict[str, _End], path: Path) -> str:
    pool = {link: end for link, end in ends.items() if end.usable and end.turning >= 2} or ends
    most = max(end.turning for end in pool.values())
    pool = {link: end for link, end in pool.items() if end.turning == most}
    if most >= 2 and len({end.last for end in pool.values()}) > 1:
        tips = [max((link for link in pool if pool[link].last == last), key=lambda link: pool[link].joints)
                for last in dict.fromkeys(end.last for end in pool.values())]  # fmt: skip
        raise UlnaInputError(
            f"{path}: several chains have {most} rotary joints, those to the links {_listed(tips)}; expected one that "
            "is longest. Say which link is the tip with --tip-link."
        )
    return USUAL_TIP if USUAL_TIP in pool else max(pool, key=lambda link: pool[link].joints)


def _step(joint: Element, path: Path) -> Step:
    name, kind = joint.get("name"), joint.get("type")
    if not name:
        child = _link(joint, "child", path)
        raise UlnaInputError(f"{path}: the joint above link '{child}' has no name; expected name=\"…\". Add it.")
    t = origin_of(joint, f"joint '{name}'", path)
    if kind == "fixed":
        return Step(name, t, None, element=joint)
    if kind not in TURNING:
        raise UlnaInputError(
            f"{path}: joint '{name}' is of type '{kind}'; expected rotary (revolute, continuous) or fixed joints from "
            "base to tip. Choose a tip before it with --tip-link, or a base behind it with --base-link."
        )
    mimic = joint.find("mimic")
    if mimic is not None:
        raise UlnaInputError(
            f"{path}: joint '{name}' mimics joint '{mimic.get('joint')}'; expected joints with encoders of their own "
            "from base to tip. Choose a tip before it with --tip-link."
        )
    axis = vector(joint.find("axis"), "xyz", "1 0 0", f"joint '{name}'", path)
    length = float(np.linalg.norm(axis))
    if length < 1e-9:
        raise UlnaInputError(
            f"{path}: joint '{name}', axis: got '{_plain(axis)}', which has no direction; expected a unit vector such "
            "as '0 0 1'. Correct it."
        )
    return Step(name, t, axis / length, _limits(joint, name, path), element=joint)


def _limits(joint: Element, name: str, path: Path) -> tuple[float, float] | None:
    """rad; None where there are none, as also 0 and 0, or numbers that no joint reaches, are meant to say."""
    limit = joint.find("limit")
    if joint.get("type") != "revolute" or limit is None:
        return None
    low, high = (
        number(limit, key, "0", f"joint '{name}'", path, most=math.inf, called=f"limit {key}")
        for key in ("lower", "upper")
    )
    if low > high:
        raise UlnaInputError(
            f"{path}: joint '{name}', limit: got lower '{limit.get('lower', '0')}' and upper "
            f"'{limit.get('upper', '0')}'; expected the lower one first. Swap them."
        )
    return (float(low), float(high)) if low < high and max(-low, high) <= MOST else None


def _plain(values: F64) -> str:
    return " ".join(f"{value:g}" for value in values)
