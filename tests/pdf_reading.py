"""Reading PDF files back with pypdf, which shares no code with what wrote them."""

from __future__ import annotations

import io
import re
from typing import Any

from pypdf import PdfReader
from pypdf.generic import ContentStream, IndirectObject


class Pdf:
    """What tests ask of a file."""

    def __init__(self, content: bytes) -> None:
        self.content = content
        self.reader = PdfReader(io.BytesIO(content), strict=True)
        self.texts: list[str] = [page.extract_text() for page in self.reader.pages]
        """Of each page."""

    @property
    def all_text(self) -> str:
        """Of all pages, as `squeezed`."""
        return squeezed("".join(self.texts))

    @property
    def metadata(self) -> bytes:
        """XMP, where the standards are named that the file keeps to."""
        found: bytes = self.root["/Metadata"].get_data()
        return found

    @property
    def root(self) -> Any:
        """The catalogue of the document."""
        return self.reader.trailer["/Root"]

    @property
    def images(self) -> int:
        """How many pictures of pixels there are."""
        return sum(len(page.images) for page in self.reader.pages)

    def alternatives(self) -> list[str]:
        """What a screen reader says of figures."""
        return _alternatives(self.root["/StructTreeRoot"])

    def fills(self, page: int) -> set[tuple[float, ...]]:
        """The colours (three numbers) that a page fills with."""
        content = ContentStream(self.reader.pages[page].get_contents(), self.reader)
        return {
            tuple(float(each) for each in operands)
            for operands, operator in content.operations
            if operator == b"scn" and len(operands) == 3
        }


def _alternatives(node: Any) -> list[str]:
    node = node.get_object() if isinstance(node, IndirectObject) else node
    if not hasattr(node, "get"):
        return []
    found = [str(node["/Alt"])] if "/Alt" in node else []
    kids = node.get("/K", [])
    for kid in kids if isinstance(kids, list) else [kids]:
        found += _alternatives(kid)
    return found


def squeezed(text: str) -> str:
    """Without white space, hyphens (of which some only break a word), marks of direction and places to break: what is
    left is what is read."""
    return re.sub("[\\s\u00ad\u200b\u2066-\u2069-]+", "", text)


def holds(pdf: Pdf, *parts: str) -> None:
    """Whether the parts are in the text of the file."""
    for part in parts:
        assert squeezed(part) in pdf.all_text, part
