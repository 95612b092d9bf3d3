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
from ulna.exchange.urdf.known import check_joint, check_tree
from ulna.exchange.urdf.masses import NO_MASS, Mass, mass_behind, origin_of
from ulna.exchange.urdf.numbers import MOST, number, vector
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError, nearest

TURNING = ("revolute", "continuous")
SLIDING = "prismatic"

#: the name of a link that is the tip where nothing else is said
USUAL_TIP = "ball_link"


@dataclass(frozen=True)
class Step:
    """One joint of a chain: a fixed transform, then, unless fixed, a turn about an axis or a shift along it."""

    name: str
    t_parent_joint: F64
    """(4, 4), mm."""
    axis: F64 | None
    """(3,) unit vector in the joint's frame; None for a fixed joint."""
    limits_rad: tuple[float, float] | None = None
    """Of one that slides mm."""
    slides: bool = False
    """Of type prismatic."""
    endless: bool = False
    """Of type continuous."""
    mass: Mass = NO_MASS
    """Of what moves with it, up to the next joint with an encoder."""
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
    remarks: tuple[str, ...] = ()
    """What was not read, and what else might have been meant."""

    @property
    def turning(self) -> list[Step]:
        """Its joints with encoders: rotary ones, and prismatic ones, which slide."""
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
    remarks = check_tree(document)
    if base_link is not None:
        above, ends = _from(base_link, above, document.path)
    if not ends:
        raise UlnaInputError(f"{document.path}: there are no joints; expected {WHAT} with at least two rotary joints.")
    if tip_link is None:
        tip_link = _outermost(ends, document.path)
        remarks += _others(tip_link, ends, above, document.path)
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
    found = []
    for joint in way:
        found.append(_step(joint, document.path))
        remarks += check_joint(joint, document.path)
    name = document.robot.get("name") or document.path.stem
    return Chain(name, _with_masses(found, document), document.path, link, tip_link, tuple(remarks))


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
    own: bool = True
    """Only rotary and prismatic joints with encoders of their own, and fixed ones."""
    slid: bool = False
    """Behind a prismatic joint behind which none turns: a finger of a gripper, rather than a joint of an arm."""

    @property
    def usable(self) -> bool:
        """Whether an arm may end there that nobody named."""
        return self.own and not self.slid

    def below(self, joint: Element) -> _End:
        turns, slides = joint.get("type") in TURNING, joint.get("type") == SLIDING
        return _End(
            self.root,
            self.joints + 1,
            self.turning + turns,
            (joint.get("name") or "?") if turns else self.last,
            self.own and (joint.get("type") == "fixed" or ((turns or slides) and joint.find("mimic") is None)),
            slides or (self.slid and not turns),
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
    roots = dict.fromkeys(end.root for end in pool.values() if end.turning >= 2)
    if len(roots) > 1:
        raise UlnaInputError(
            f"{path}: several links are roots of chains of rotary joints, {_listed(roots)}; expected one. Say which "
            "the arm stands on with --base-link."
        )
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


def _others(tip_link: str, ends: dict[str, _End], above: dict[str, tuple[str, Element]], path: Path) -> list[str]:
    """What else might have been meant, where nobody said: ends of other chains, other ends of this one."""
    if tip_link == USUAL_TIP:
        return []
    way = [tip_link]
    while way[-1] in above:
        way.append(above[way[-1]][0])
    parents = {parent for parent, _ in above.values()}
    leaves = [link for link in ends if link not in parents and link not in way and ends[link].usable]
    same = [link for link in leaves if ends[link].last == ends[tip_link].last]
    on_way = {ends[link].last for link in way if link in ends}
    other = [link for link in leaves if ends[link].turning >= 2 and ends[link].last not in on_way]
    return [
        f"{path}: the tip is link '{tip_link}'; {what} {_listed(links)}. Say which is meant with --tip-link."
        for what, links in (("the last joint also carries", same), ("other chains end at", other))
        if links
    ]


def _step(joint: Element, path: Path) -> Step:
    name, kind = joint.get("name"), joint.get("type")
    if not name:
        child = _link(joint, "child", path)
        raise UlnaInputError(f"{path}: the joint above link '{child}' has no name; expected name=\"…\". Add it.")
    t = origin_of(joint, f"joint '{name}'", path)
    if kind == "fixed":
        return Step(name, t, None, element=joint)
    if kind not in (*TURNING, SLIDING):
        raise UlnaInputError(
            f"{path}: joint '{name}' is of type '{kind}'; expected rotary (revolute, continuous), prismatic or fixed "
            "joints from base to tip. Choose a tip before it with --tip-link, or a base behind it with --base-link."
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
    slides, limits = kind == SLIDING, _limits(joint, name, path)
    if slides and limits is None:
        raise UlnaInputError(
            f'{path}: joint \'{name}\' is prismatic and has no limits; expected <limit lower="…" upper="…"/> with how '
            "far it slides. Add it."
        )
    if slides and limits is not None:
        limits = 1000.0 * limits[0], 1000.0 * limits[1]
    return Step(name, t, axis / length, limits, slides, kind == "continuous", element=joint)


def _limits(joint: Element, name: str, path: Path) -> tuple[float, float] | None:
    """rad, or m of one that slides; None where there are none, as also 0 and 0, or numbers that no joint reaches, are
    meant to say."""
    limit = joint.find("limit")
    if joint.get("type") not in ("revolute", SLIDING) or limit is None:
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
