"""Reading a URDF file: XML from anywhere, so without document types and entities, and told from what only looks alike.

Where each element begins in the file is kept, so that a file can be given other numbers and stay the same otherwise.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, TreeBuilder
from xml.parsers import expat

from ulna.formats.toml import MOST_BYTES, read_bytes
from ulna.ground.errors import UlnaInputError

WHAT = "a robot description (URDF)"

EXPAND = "Expand it first (in ROS: xacro FILE > robot.urdf) and name what comes out"


@dataclass(frozen=True)
class Document:
    """A parsed file, and the file itself."""

    path: Path
    content: bytes
    robot: Element
    """The outermost element."""
    starts: dict[Element, int]
    """Where each element's start tag begins in `content`."""


def read_document(path: Path) -> Document:
    """Parse a URDF file. Raises UlnaInputError for what is no XML, no URDF, or not yet one (xacro)."""
    content = read_bytes(path, WHAT, MOST_BYTES + 1)
    if len(content) > MOST_BYTES:
        raise UlnaInputError(f"{path}: more than {MOST_BYTES >> 20} MB, too large; expected {WHAT}. Check the path.")
    if not content.strip():
        raise UlnaInputError(f"{path}: the file is empty; expected {WHAT}.")
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        raise UlnaInputError(f"{path}: the file is UTF-16; expected {WHAT} in UTF-8. Save it as UTF-8.")
    robot, starts = _parsed(path, content)
    if robot.tag != "robot":
        raise UlnaInputError(
            f"{path}: the outermost element is <{robot.tag}>; expected <robot>: {WHAT}. Name the right file."
        )
    _refuse_xacro(path, robot, starts)
    return Document(path, content, robot, starts)


def _parsed(path: Path, content: bytes) -> tuple[Element, dict[Element, int]]:
    parser, builder = expat.ParserCreate(), TreeBuilder()
    starts: dict[Element, int] = {}

    def start(name: str, attributes: dict[str, str]) -> None:
        starts[builder.start(name, attributes)] = parser.CurrentByteIndex

    def end(name: str) -> None:
        builder.end(name)

    def doctype(*_: object) -> None:
        # An entity may stand for a million others, or for a file of the reader's; no robot needs one.
        raise UlnaInputError(
            f"{path}: line {parser.CurrentLineNumber}: got a document type (<!DOCTYPE …>), which may define entities; "
            f"expected {WHAT} without one. Remove it."
        )

    parser.StartElementHandler = start
    parser.EndElementHandler = end
    parser.StartDoctypeDeclHandler = doctype
    try:
        parser.Parse(content, True)
    except (expat.ExpatError, LookupError, ValueError) as error:  # the last two: an encoding that nobody knows
        raise UlnaInputError(f"{path}: not valid XML: {error}; expected {WHAT}. Correct that place.") from None
    return builder.close(), starts


def _refuse_xacro(path: Path, robot: Element, elements: dict[Element, int]) -> None:
    # A URDF made by xacro often still declares the prefix; only elements of that kind show what is unfinished.
    prefixes = {"xacro"}
    for element in elements:
        prefixes |= {key[6:] for key, value in element.items() if key.startswith("xmlns:") and "xacro" in value}
    for element in elements:
        if ":" in element.tag and element.tag.split(":")[0] in prefixes:
            raise UlnaInputError(
                f"{path}: element <{element.tag}>: this is a xacro file, of which a URDF is yet to be made; expected "
                f"{WHAT}. {EXPAND}."
            )


def start_tag(document: Document, element: Element) -> tuple[int, int]:
    """Where an element's start tag begins and ends (past its `>`) in the file."""
    begin = document.starts[element]
    # a > within quotes ends nothing
    tag = re.compile(rb"""<(?:[^>"']|"[^"]*"|'[^']*')*>""").match(document.content, begin)
    assert tag is not None, "the parser has seen a start tag here"
    return begin, tag.end()
