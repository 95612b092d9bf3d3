"""Columns whose names are Ulna's but for capitals and a unit in brackets: `Q1`, `q1 [rad]`, `x (mm)`.

They are taken for what they say, and told, where the table could not be used otherwise: encoder angles, lengths and
orientations with their unit, and tables without angles (points). Any other column of such a name stays one that nobody
uses, or a slip that is asked about.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from ulna.formats.header import Header
from ulna.formats.own_units import ANGLES, LENGTHS

_UNIT = re.compile(r"(.+?)\s*[\[(]\s*([^\])]+?)\s*[\])]")


def near_names(
    header: Header, known: Sequence[str], mapped: Mapping[str, str]
) -> tuple[dict[str, str], dict[str, str]]:
    """(the file's name → Ulna's, the file's name → the unit in its brackets) of columns that are recognised.

    mapped: the file's name → Ulna's of columns that the study maps.
    """
    names: dict[str, str] = {}
    units: dict[str, str] = {}
    for column in header.columns:
        if column in known or column in mapped:
            continue
        match = _UNIT.fullmatch(column)
        ours = (match[1] if match else column).casefold()
        if ours not in known or ours in header.columns or ours in mapped.values() or ours in names.values():
            continue
        if "q1" in known and not re.fullmatch(r"q\d+", ours) and not _goes_along(ours, match, column, header, names):
            continue
        names[column] = ours
        if match:
            units[column] = match[2]
    return names, units | {column: match[2] for column in mapped if (match := _UNIT.fullmatch(column))}


def _goes_along(ours: str, match: re.Match[str] | None, column: str, header: Header, names: Mapping[str, str]) -> bool:
    """Whether a column beside the angles is meant: a second pose as the first one is written, a number with a unit."""
    if match and (LENGTHS.names(match[2]) or ANGLES.names(match[2])) and not re.fullmatch(r"[qp]\d+", ours):
        return True
    if re.fullmatch(r"p\d+", ours) is None or not names:
        return False
    angles = [name for name in (*header.columns, *names.values()) if re.fullmatch(r"q\d+", name)]
    return match is not None or all(f"P{name[1:]}" in header.columns for name in angles)
