"""What a URDF may say, so that what Ulna does not know is refused or named, and nothing is dropped in silence.

A word that looks like one that says where a joint stands is refused: it was meant to be that. What else is unknown
(other programs' elements) is named in a remark. After the specification of URDF 1.0, 1.1 (`quat_xyzw`) and 1.2.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path
from xml.etree.ElementTree import Element

from ulna.exchange.urdf.document import Document
from ulna.formats.wording import SHOWN
from ulna.ground.errors import UlnaInputError, nearest

#: elements of a joint, each with the attributes that it may have; those of the others are nobody's affair here
PLACING = {
    "origin": ("xyz", "rpy", "quat_xyzw"),
    "axis": ("xyz",),
    "parent": ("link",),
    "child": ("link",),
    "limit": ("lower", "upper", "effort", "velocity", "acceleration", "deceleration", "jerk"),
    "mimic": ("joint", "multiplier", "offset"),
}
BESIDE = ("calibration", "dynamics", "safety_controller")

#: what a robot is made of: the first two say where joints stand
OF_ROBOT = ("link", "joint", "material", "transmission", "gazebo")


def check_tree(document: Document) -> list[str]:
    """Whether names are used once and stand for something; what to remark. Raises UlnaInputError."""
    robot, path = document.robot, document.path
    for element in robot:
        close = _close(element.tag, OF_ROBOT[:2])
        if element.tag not in OF_ROBOT and close:
            raise UlnaInputError(f"{path}: unknown element <{element.tag}>.{close} Correct it.")
    links = [link.get("name") or "" for link in robot.findall("link")]
    for what, names in (("links", links), ("joints", [joint.get("name") or "" for joint in robot.findall("joint")])):
        for name, count in Counter(names).items():
            if name and count > 1:
                raise UlnaInputError(
                    f"{path}: {count} {what} are called '{name}'; expected a name of its own for each. Rename one."
                )
    used: dict[str, None] = {}
    for joint in robot.findall("joint"):
        for role in ("parent", "child"):
            named = joint.find(role)
            link = "" if named is None else named.get("link", "")
            used[link] = None
            if link and link not in links:
                raise UlnaInputError(
                    f"{path}: joint '{joint.get('name')}' has the {role} link '{link}', but there is no "
                    f'<link name="{link}"/>; expected links that are there.{_link_hint(link, links)} Correct it, or '
                    "add the link."
                )
    return _remarks(path, "element", (f"<{each.tag}>" for each in robot if each.tag not in OF_ROBOT)) + _remarks(
        path, "link that no joint holds", (f"'{link}'" for link in links if link not in used and len(links) > 1)
    )


def check_joint(joint: Element, path: Path) -> list[str]:
    """Whether all is understood that says where a joint of the chain stands; what to remark. Raises UlnaInputError."""
    what = f"{path}: joint '{joint.get('name')}'"
    strange = _check_attributes(joint, ("name", "type"), what)
    for tag, count in Counter(element.tag for element in joint).items():
        if tag in PLACING and count > 1:
            raise UlnaInputError(f"{what}: {count} elements <{tag}>; expected one. Remove the others.")
    for element in joint:
        if element.tag in PLACING:
            strange += _check_attributes(element, PLACING[element.tag], f"{what}, {element.tag}")
        elif element.tag not in BESIDE:
            close = _close(element.tag, PLACING)
            if close:
                raise UlnaInputError(f"{what}: unknown element <{element.tag}>.{close} Correct it.")
            strange.append(f"<{element.tag}>")
    return _remarks(path, f"of joint '{joint.get('name')}'", strange)


def _link_hint(link: str, links: Sequence[str]) -> str:
    same = [each for each in links if each.casefold() == link.casefold()]
    return f" Did you mean '{same[0]}'?" if same else nearest(link, links)


def _close(tag: str, known: Iterable[str]) -> str:
    """What may have been meant, where something is near enough."""
    hint = nearest(tag.lower(), list(known))
    return hint if "Did you mean" in hint else ""


def _check_attributes(element: Element, known: Sequence[str], what: str) -> list[str]:
    """Those that are not known. Raises UlnaInputError where one looks like a known one."""
    # another program's own, such as those left by xacro, have a prefix
    strange = {name: value for name, value in element.items() if name not in known and ":" not in name}
    for name, value in strange.items():
        close = _close(name, [each for each in known if each not in element.attrib])
        if close:
            raise UlnaInputError(
                f'{what}: unknown attribute {name}="{value[:40]}"; expected {", ".join(known)}.{close} Correct or '
                "remove it."
            )
    return [f"attribute {name} of <{element.tag}>" for name in strange]


def _remarks(path: Path, what: str, found: Iterable[str]) -> list[str]:
    names = list(dict.fromkeys(found))
    if not names:
        return []
    more = ", …" if len(names) > SHOWN else ""
    return [f"{path}: not read, {what}: {', '.join(names[:SHOWN])}{more}."]
