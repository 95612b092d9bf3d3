"""Columns whose names are Ulna's but for capitals and a unit in brackets: `Q1`, `q1 [rad]`, `x (mm)`.

They are taken for what they say, and told, where the table could not be used otherwise: encoder angles, and tables that
have none (points). Any other column of such a name stays one that nobody uses, or a slip that is asked about.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from ulna.formats.header import Header


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
        match = re.fullmatch(r"(.+?)\s*[\[(]\s*([^\])]+?)\s*[\])]", column)
        ours = (match[1] if match else column).casefold()
        if ours not in known or ours in header.columns or ours in mapped.values() or ours in names.values():
            continue
        if "q1" in known and not re.fullmatch(r"q\d+", ours) and not (match and ours[0] == "p" and names):
            continue
        names[column] = ours
        if match:
            units[column] = match[2]
    return names, units
