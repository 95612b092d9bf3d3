"""What the template can set, as JSON: headings, paragraphs, tables, facts, plots. All text is strings."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from ulna.documents.pdf.text import Cell

Block = dict[str, Any]


def heading(text: str, level: int = 1) -> Block:
    """Numbered by the template."""
    return {"kind": "heading", "text": text, "level": level}


def paragraph(text: Cell, style: str = "plain") -> Block:
    """style: "plain", "note" (small), "lead" (small, kept with what follows), "good" (strong), "missing" (marked:
    something is not known) or "bad" (marked strongly)."""
    return {"kind": "paragraph", "text": text, "style": style}


def listed(texts: Sequence[Cell]) -> Block:
    """Points."""
    return {"kind": "list", "texts": list(texts)}


def table(
    heads: Sequence[str], rows: Iterable[Sequence[Cell]], widths: Sequence[float], left: int = 1, size_pt: float = 8.0
) -> Block:
    """A table that may break across pages and repeats its heads there.

    widths: of each column, as shares; 0 for as wide as its cells. The first `left` columns hold words, the others
    numbers.
    """
    cells = [list(row) for row in rows]
    return {
        "kind": "table",
        "heads": list(heads),
        "rows": cells,
        "widths": list(widths),
        "left": left,
        "size": size_pt,
    }


def facts(rows: Iterable[tuple[Cell, Sequence[Cell]]]) -> Block:
    """What and its values, each on a line."""
    return {"kind": "facts", "rows": [[what, list(values)] for what, values in rows]}


def plot(svg: str, caption: str) -> dict[str, str]:
    """A picture with its caption, which is also what a screen reader says."""
    return {"svg": svg, "caption": caption}


def plots(found: Sequence[dict[str, str]], columns: int) -> Block:
    """Pictures side by side."""
    return {"kind": "plots", "plots": list(found), "columns": columns}
