"""How a text is written: which sign stands between its columns, and which is its decimal sign. Seen, and shown."""

from __future__ import annotations

import csv
import re
from collections import Counter
from dataclasses import replace
from pathlib import Path

from ulna.formats.encodings import decoded
from ulna.formats.layout import Layout
from ulna.formats.no_table import is_prose, prose, refuse_foreign
from ulna.formats.tables.marks import is_text
from ulna.formats.toml import read_bytes
from ulna.ground.errors import UlnaInputError

SEPARATORS = ("\t", ";", "|", ",")
_LOOKED_AT = 1 << 18
_LINES = 400


def seen_dialect(path: Path, layout: Layout, what: str) -> tuple[Layout, dict[str, str]]:
    """The layout with what is seen of the text, and what was seen: key → value, as a study writes it. Workbooks and
    other formats know it themselves. Raises UlnaInputError for a file that is not there, or empty."""
    start = read_bytes(path, what, limit=_LOOKED_AT)
    if not start.strip():
        raise UlnaInputError(f"{path}: the file is empty; expected {what}.")
    refuse_foreign(path, start, what)
    if is_text(start) and is_prose(start):
        raise prose(path, what)
    if start.startswith((b"PK\x03\x04", b"\xd0\xcf\x11\xe0", b"PAR1")) or not is_text(start):
        return layout, {}
    whole = start if len(start) < _LOOKED_AT else start[: start.rfind(b"\n") + 1]
    text, _ = decoded(path, whole, what, layout.encoding, layout.say("encoding", "cp1252"))
    lines = [line for line in text.splitlines() if line.strip()][:_LINES]
    said = re.fullmatch(r"sep=(.)", lines[0].strip()) if lines else None
    separator = layout.separator or (said[1] if said else _separator(lines))
    decimal = layout.decimal or _decimal(lines, separator)
    seen = {}
    if layout.separator is None and not said and separator != ",":
        seen["separator"] = "tab" if separator == "\t" else separator
    if layout.decimal is None and decimal == ",":
        seen["decimal"] = decimal
    changed = {key: "\t" if value == "tab" else value for key, value in seen.items()}
    return replace(layout, **changed), seen  # type: ignore[arg-type]


def _separator(lines: list[str]) -> str:
    """The sign that most often stands equally often in two lines that follow each other."""

    def agreeing(sign: str) -> int:
        counts = [len(row) - 1 for row in csv.reader(lines, delimiter=sign)]
        usual, times = Counter(counts).most_common(1)[0] if counts else (0, 0)
        return times if usual else 0

    found = {sign: agreeing(sign) for sign in SEPARATORS}
    best = max(found.values(), default=0)
    return next((sign for sign in SEPARATORS if found[sign] == best and best), ",")


def _decimal(lines: list[str], separator: str) -> str:
    if separator == ",":
        return "."
    cells = [cell.strip() for row in csv.reader(lines, delimiter=separator) for cell in row]
    commas = sum(re.fullmatch(r"[-+]?\d+,\d+", cell) is not None for cell in cells)
    points = sum(re.fullmatch(r"[-+]?\d+\.\d+", cell) is not None for cell in cells)
    return "," if commas > points else "."
