"""Files that are no table at all, told in one sentence: a PDF, a picture, a web page, JSON, prose.

The first bytes say what most of them are. Prose has no mark of its own: lines in which no cell is a number.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection
from dataclasses import dataclass
from pathlib import Path

from ulna.formats.encodings import utf16
from ulna.formats.spelling import looks_numeric, sexagesimal
from ulna.ground.errors import UlnaInputError

_EXPORT = "Export the table itself as CSV or .xlsx."
_UNPACK = "Unpack it and name the file in it."


@dataclass(frozen=True)
class Foreign:
    """A kind of file that is no table."""

    name: str
    recognised: Callable[[bytes], bool]
    """By the first bytes, without blanks before them."""
    remedy: str = _EXPORT


def _begins(*marks: bytes) -> Callable[[bytes], bool]:
    return lambda start: start.startswith(marks)


def _matches(pattern: bytes) -> Callable[[bytes], bool]:
    return lambda start: re.match(pattern, start, re.IGNORECASE | re.DOTALL) is not None


FOREIGN = (
    Foreign("a PDF document", _begins(b"%PDF-")),
    Foreign(
        "a picture",
        _matches(rb"\x89PNG\r\n|GIF8[79]a|\xff\xd8\xff|II\*\x00|MM\x00\*|RIFF....WEBP"),
        "A picture of a table is not read: type it, or export the table as CSV or .xlsx.",
    ),
    Foreign(
        "a packed file (gzip, 7z, xz, bzip2, rar)",
        _begins(b"\x1f\x8b", b"7z\xbc\xaf", b"\xfd7zXZ", b"BZh", b"Rar!"),
        _UNPACK,
    ),
    Foreign("an archive (tar)", lambda start: start[257:262] == b"ustar", _UNPACK),
    Foreign("a web page (HTML)", _matches(rb"(<!--.{0,500}?-->\s*)?<(!doctype html|html)\b")),
    Foreign(
        "a robot's description (URDF)",
        _matches(rb"(<\?xml.{0,2000}?)?<robot\b"),
        "It describes an arm: ulna import urdf makes an arm file of it; name the readings here.",
    ),
    Foreign("an XML file", _begins(b"<?xml")),
    Foreign("a JSON file", _matches(rb'\{\s*(["}]|\Z)|\[\s*[\[{]')),
    Foreign(
        "a page in Markdown",
        lambda start: (
            re.match(rb"#+ [^,;\t\n]*\r?\n\s*\n", start) is not None
            and any(mark in start for mark in (b"](", b"```", b"**"))
        ),
    ),
    Foreign("a LaTeX document", _begins(b"\\documentclass", b"\\begin{")),
    Foreign(
        "a file of Ulna's own (TOML)",
        _matches(rb"(#[^\n]*\n|\s)*format\s*=\s*[\"']ulna-"),
        "Name the table of readings.",
    ),
)
"""In the order in which they are asked."""

#: an old program fills up its last block of so many bytes at most
_MOST_ZEROS = 1 << 16
#: lines that are looked at, and of which a table has more with numbers
_LINES, _LEAST = 400, 0.05


def refuse_foreign(path: Path, start: bytes, what: str) -> None:
    """Raise UlnaInputError where the first bytes of a file are those of something that is no table."""
    bare = start.removeprefix(b"\xef\xbb\xbf").lstrip()
    for each in FOREIGN:
        if each.recognised(bare):
            raise UlnaInputError(f"{path}: this is {each.name}, and no table; expected {what}. {each.remedy}")


def refuse_zeros(path: Path, start: bytes, what: str) -> None:
    """Raise UlnaInputError where zeros fill more than the end of a text's last block; start: 64 KiB, or all of it."""
    text = start.rstrip(b"\0")
    filled = path.stat().st_size - len(text) if len(text) < len(start) else 0
    if utf16(start) is None and (not text.strip() or filled > _MOST_ZEROS):
        at = f"zeros alone from byte {len(text) + 1} on" if text.strip() else "zeros alone"
        raise UlnaInputError(
            f"{path}: holds {at}, and no text; expected {what}. It was not written to the end, or lost on the disk: "
            "copy it again."
        )


def is_prose(start: bytes, names: Collection[str] = ()) -> bool:
    """Whether a text has lines, and next to none of them holds a number in a cell; names: columns that make it a table
    all the same, whose cells are bad."""
    text = start.decode(utf16(start) or "utf-8", errors="replace")
    lines = [line for line in text.splitlines() if line.strip()][:_LINES]
    if any(cell in names or cell.casefold() in names for line in lines for cell in _cells(line)):
        return False
    return len(lines) > 1 and sum(map(_has_number, lines)) < _LEAST * len(lines)


def _cells(line: str) -> list[str]:
    return [cell.strip().strip("\"'") for cell in re.split(r"[,;\t|]", line)]


def _has_number(line: str) -> bool:
    """Of cells between signs, any; of words between blanks, every second: prose has numbers too."""
    words = line.split()
    return any(map(_is_number, _cells(line))) or 2 * sum(map(_is_number, words)) >= len(words)


def _is_number(cell: str) -> bool:
    return looks_numeric(cell) or sexagesimal(cell) is not None


def prose(path: Path, what: str) -> UlnaInputError:
    """The message about a text that is no table."""
    return UlnaInputError(
        f"{path}: this is a text without rows of numbers, and no table; expected {what}. Name the file with the table."
    )
