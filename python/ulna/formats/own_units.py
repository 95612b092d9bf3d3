"""What a file itself says of its units, in brackets behind a column's name or in a row of units: the same as is stated,
or an error. A word that is no unit of the kind that is asked for says nothing.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ulna.formats.header import Header
from ulna.ground.errors import UlnaInputError


@dataclass(frozen=True)
class Kind:
    """Units of one kind of quantity."""

    known: Mapping[str, str]
    """Word, casefolded → the unit that files of Ulna are told."""
    others: frozenset[str]
    """Words for units of the kind that Ulna does not read."""
    its: str
    """How a message calls such numbers."""

    def unit(self, said: str) -> str | None:
        """The unit that a word means; None where it is none of those that Ulna reads."""
        return self.known.get(said.strip().casefold())

    def names(self, said: str) -> bool:
        """Whether a word is a unit of the kind, read or not."""
        return said.strip().casefold() in {*self.known, *self.others}


def _words(*words: str) -> frozenset[str]:
    return frozenset(word.casefold() for word in words)


ANGLES = Kind(
    {
        **dict.fromkeys(("rad", "radian", "radians", "弧度"), "rad"),
        **dict.fromkeys(("deg", "°", "degree", "degrees", "度"), "deg"),
        **dict.fromkeys(("counts", "count", "cnt", "inc", "pulses"), "counts"),
    },
    _words("mrad", "µrad", "urad", "gon", "mgon", "arcmin", "arcsec", "rev", "revs", "turns", "mdeg"),
    "angles",
)
LENGTHS = Kind(
    {
        **dict.fromkeys(("mm", "millimeter", "millimetre", "millimeters", "millimetres", "毫米"), "mm"),
        **dict.fromkeys(("m", "meter", "metre", "meters", "metres", "米"), "m"),
        **dict.fromkeys(("in", "inch", "inches"), "in"),
    },
    _words("cm", "dm", "km", "µm", "um", "micron", "microns", "nm", "mil", "mils", "ft", "feet", "foot", "厘米"),
    "lengths",
)

LENGTHS_STATED = "State the unit with units.length, for all lengths of the file that says it, or convert the column."


def check_units(header: Header, columns: Sequence[str], stated: str, kind: Kind, remedy: str) -> None:
    """What the file says of these columns is what is stated. Raises UlnaInputError; remedy: how it is stated here."""
    for column in columns:
        said = header.units.get(header.own(column), "").strip()
        if said.casefold() in kind.others:
            raise UlnaInputError(
                f"{header.path}: {header.named(column)}: the file says '{said}', a unit that Ulna does not read; "
                f"expected {', '.join(dict.fromkeys(kind.known.values()))}. Write the column in {stated}, and say "
                "so in its heading."
            )
        if (kind.unit(said) or stated) != stated:
            raise UlnaInputError(
                f"{header.path}: {header.named(column)}: the file says '{said}', but its {kind.its} are said to be in "
                f"{stated}; expected the same. {remedy}"
            )
