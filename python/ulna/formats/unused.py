"""Columns of a table that nobody uses: remarked upon, or taken for a slip."""

from __future__ import annotations

import difflib
import re
from collections.abc import Collection, Sequence

from ulna.formats.header import Header
from ulna.ground.errors import UlnaInputError


def remark_strange(
    header: Header, known: Sequence[str], words: Sequence[str], remarks: list[str], asked: Collection[str] = ()
) -> None:
    """Remark upon the columns that nobody uses, and hand on what was remarked when the file was opened.

    Raises UlnaInputError for a column whose name is nearly one of `words`, if that is not there: a slip, most likely.
    """
    remarks += [remark for remark in header.remarks if remark not in remarks]
    strange = [column for column in header.columns if column not in known and column not in asked]
    lacking = [name for name in words if name not in header.columns]
    for column in strange:
        slips = difflib.get_close_matches(column.lower(), lacking, n=1, cutoff=0.8)
        if slips:
            raise UlnaInputError(
                f"{header.path}: unknown column '{column}'. Did you mean '{slips[0]}'? Rename or map it; a column that "
                "is not meant needs a name that is not so near."
            )
    if strange:
        runs = _runs(strange)
        shown = ", ".join(runs[:MOST_SHOWN]) + (f", … ({len(strange)} in all)" if len(runs) > MOST_SHOWN else "")
        remarks.append(f"{header.path}: not used: the column{'s' * (len(strange) > 1)} {shown}.")


def _runs(names: Sequence[str]) -> list[str]:
    """Names in order, those that are numbered one after the other told shortly: `force1 … force6`."""
    found: list[list[str]] = []
    for name in names:
        stem, number = re.fullmatch(r"(.*?)([0-9]*)", name, re.DOTALL).groups()  # type: ignore[union-attr]
        if found and number and found[-1][-1] == f"{stem}{int(number) - 1}":
            found[-1].append(name)
        else:
            found.append([name])
    return [run[0] if len(run) == 1 else f"{run[0]} … {run[-1]}" if len(run) > 2 else ", ".join(run) for run in found]


#: unused columns named in a remark
MOST_SHOWN = 24
