"""What form an output file has: as options say it, else as its ending does."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path


def by_ending(out: Path, known: Mapping[str, str], asked: Sequence[str], folder: bool) -> list[str]:
    """The forms to write: those that options asked for; without any, the one of the file's ending.

    known: ending → form; folder: whether `out` may be a folder, which has no ending or is there already. [] of such a
    folder where nothing was asked for. Raises UlnaInputError for an ending that cannot be written.
    """
    from ulna.ground.errors import UlnaInputError

    ending = out.suffix.lower()
    if folder and (out.is_dir() or not re.fullmatch(r"\.[a-z][a-z0-9]{1,7}", ending)):
        return list(asked)
    if ending not in known:
        shown = f"ends in {ending}" if ending else "has no ending"
        raise UlnaInputError(
            f"option -o: {out} {shown}, which cannot be written; expected {_listed(known)}. Correct it."
        )
    return list(asked) or [known[ending]]


def _listed(known: Mapping[str, str]) -> str:
    *first, last = known
    return f"{', '.join(first)} or {last}" if first else last
