"""How much an SVG picture draws: elements may stand for others, and those for others, so that 30 lines draw 10⁹ things.

SVG 2, 5.6 (`use`), 12.3 (`image`) and 13 to 15 (what a fill, a marker, a mask or a clip may refer to).
"""

from __future__ import annotations

import base64
import binascii
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator

from ulna.documents.pdf.picture_size import MOST_PIXELS, pixels

MOST_ELEMENTS = 500_000
_REFERENCE = re.compile(r"#([^\s\"')]+)")
_INSIDE = re.compile(r"\s*data:[^,]*;base64,(.*)", re.DOTALL)


def too_large(picture: bytes) -> str | None:
    """What of it is too large, in words; None where it is not, or where it is no SVG that can be read."""
    if b"<!ENTITY" in picture:
        return "an SVG with entities of its own"
    try:
        root = ElementTree.fromstring(picture)
        drawn = _Drawn(root).of(root)
    except ElementTree.ParseError:
        return None
    except (LookupError, ValueError):  # letters that nobody knows
        return "an SVG that cannot be read"
    except RecursionError:
        drawn = MOST_ELEMENTS + 1
    if drawn > MOST_ELEMENTS:
        return f"an SVG of more than {MOST_ELEMENTS} elements, as they refer to each other"
    if sum(map(_points, _pictures(root))) > MOST_PIXELS:
        return f"an SVG with pictures in it of more than {MOST_PIXELS / 1e6:.0f} million points"
    return None


class _Drawn:
    """Elements with all that they refer to, counted, up to a little more than is allowed."""

    def __init__(self, root: ElementTree.Element) -> None:
        self._named = {each.get("id", ""): each for each in root.iter()}
        self._known: dict[str, int] = {}
        self._looked = 0

    def of(self, top: ElementTree.Element) -> int:
        count = 0
        for each in top.iter():
            count += 1
            self._looked += 1
            for key, value in each.items():
                if key.endswith("href") or "url(" in value:
                    count += sum(map(self._behind, _REFERENCE.findall(value)))
            if count > MOST_ELEMENTS or self._looked > MOST_ELEMENTS:
                return MOST_ELEMENTS + 1
        return count

    def _behind(self, name: str) -> int:
        if name not in self._known:
            self._known[name] = 0  # what refers to itself is not drawn
            self._known[name] = self.of(self._named[name]) if name in self._named else 0
        return self._known[name]


def _pictures(root: ElementTree.Element) -> Iterator[bytes]:
    for each in root.iter():
        for key, value in each.items():
            inside = _INSIDE.match(value) if key.endswith("href") else None
            if inside is not None:
                try:
                    yield base64.b64decode(inside[1])
                except (binascii.Error, ValueError):
                    continue


def _points(picture: bytes) -> int:
    size = pixels(picture)
    if size is None and b"<svg" in picture[:2000] and too_large(picture):
        return MOST_PIXELS + 1
    return size or 0
