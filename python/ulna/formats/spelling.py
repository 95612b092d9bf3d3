"""How numbers are written in texts: decimal sign, signs between thousands, and what a program's own spelling means.

A minus of Unicode (U+2212) and an exponent of Fortran (1.5D+00) mean the same in any file. A comma or a point does not:
what it means is said by the keys `decimal` and `thousands`.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

BLANKS = "\u00a0\u202f\u2009 "
"""What stands between thousands where the sign is a blank."""

MOST = 1e15
"""In size, of any number in a file that people or instruments write: no quantity in any unit comes near it, and what
is made of it, squares of its millimetres too, is a number still."""

_FORTRAN = re.compile(r"(?<=[0-9.])[dD](?=[+-]?[0-9]+$)")
_LOOKS = re.compile(r"[+-]?[\d.,'\u2019\u00a0\u202f\u2009]*\d[\d.,'\u2019]*([eEdD][+-]?\d+)?\s*[°%]?", re.ASCII)


@dataclass(frozen=True)
class Spelling:
    """Of the numbers in one table."""

    decimal: str = "."
    thousands: str = ""
    """The sign between groups of three digits; "" where there is none."""

    def number(self, text: str) -> float | None:
        """The number that a text holds, None where it is none. No underscores; thousands only in groups of three."""
        text = text.strip().replace("\u2212", "-")
        if "_" in text or (self.decimal == "," and "." in text and self.thousands != "."):
            return None
        if self.thousands:
            found = self._ungrouped(text)
            if found is None:
                return None
            text = found
        if self.decimal == ",":
            text = text.replace(",", ".")
        try:
            return float(_FORTRAN.sub("e", text))
        except ValueError:
            return None

    def _ungrouped(self, text: str) -> str | None:
        """Without the signs between thousands; None where they do not stand between groups of three digits."""
        signs = _SIGNS[self.thousands]
        whole, decimal, rest = text.partition(self.decimal)
        if not any(sign in text for sign in signs):
            return text
        if not re.fullmatch(rf"[+-]?\d{{1,3}}([{re.escape(signs)}]\d{{3}})+", whole, re.ASCII):
            return None
        return "".join(sign for sign in whole if sign not in signs) + decimal + rest


_SIGNS = {",": ",", ".": ".", "'": "'\u2019", " ": BLANKS}
"""What is taken for each sign."""
PLAIN = Spelling()


def usable(value: float | None) -> bool:
    """Whether a cell holds a number of a size that quantities have; no gap, NaN or infinity."""
    return value is not None and abs(value) <= MOST


def looks_numeric(text: str) -> bool:
    """Whether a text is a number in anybody's spelling."""
    return _LOOKS.fullmatch(text.strip().replace("\u2212", "-")) is not None


_DEGREES = re.compile(r"""([+-]?)\s*(\d+)\s*°\s*(\d+)\s*['′’]\s*(?:(\d+(?:[.,]\d+)?)\s*(?:["″”]|''))?""")


def sexagesimal(text: str) -> float | None:
    """The degrees of the first angle in a text that is written in degrees, minutes and seconds (12°30'15"); None where
    there is none."""
    found = _DEGREES.search(text.replace("\u2212", "-"))
    if found is None:
        return None
    sign, degrees, minutes, seconds = found.groups()
    value = int(degrees) + int(minutes) / 60.0 + float((seconds or "0").replace(",", ".")) / 3600.0
    return -value if sign == "-" else value


def thousands_of(text: str, decimal: str) -> str:
    """The sign that may stand between the thousands of a text that is no number as it is; "" where none does."""
    for sign in (",", ".", "'", " "):
        there = sign != decimal and any(each in text for each in _SIGNS[sign])
        if there and Spelling(decimal, sign).number(text) is not None:
            return sign
    return ""
