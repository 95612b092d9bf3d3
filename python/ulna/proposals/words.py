"""What headings mean, in the languages of `headings.toml`."""

from __future__ import annotations

import re
import tomllib
import unicodedata
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

ROLES = (
    "angle",
    "measurement",
    "standing",
    "feature",
    "probe",
    "artefact",
    "temperature",
    "measured",
    "aside",
    "goal",
)
"""What a column may be for; each language says words for each."""

ANGLE_UNITS = {
    **dict.fromkeys(("rad", "radian", "radians", "弧度", "bogenmass", "radiant"), "rad"),
    **dict.fromkeys(("deg", "°", "degree", "degrees", "grad", "度", "degré", "degrés", "grados", "gradi"), "deg"),
    **dict.fromkeys(
        (
            "counts",
            "count",
            "cnt",
            "cts",
            "inc",
            "ink",
            "inkr",
            "inkremente",
            "increments",
            "pulses",
            "impulse",
            "impulses",
        ),
        "counts",
    ),
    **dict.fromkeys(
        (
            "ticks",
            "pulses",
            "impulse",
            "impulses",
            "lsb",
            "digits",
            "digit",
            "striche",
            "脉冲",
            "脉冲数",
            "计数",
            "パルス",
        ),
        "counts",
    ),
}
"""What people write behind an angle → the unit of a study."""
LENGTH_UNITS = {"mm": "mm", "毫米": "mm", "m": "m", "米": "m", "in": "in", "inch": "in", "zoll": "in"}


@dataclass(frozen=True)
class Meaning:
    """What a heading says."""

    role: str | None
    """One of `ROLES`; None where no language knows a word of it."""
    number: int | None
    """`Achse 3` has 3."""
    unit: str
    """As it stands in brackets, or at the end; "" where none does."""
    word: str = ""
    """By which word it was known."""
    goal: bool = False
    """Whether it says that this is what was wanted, not what was read."""


@cache
def languages() -> dict[str, dict[str, list[str]]]:
    """Code of a language → role → words."""
    text = files(__package__).joinpath("headings.toml").read_text(encoding="utf-8")
    found: dict[str, dict[str, list[str]]] = tomllib.loads(text)
    return found


@cache
def _roles() -> dict[str, str]:
    """Word → role; where languages differ, the first one that has it."""
    found: dict[str, str] = {}
    for words in languages().values():
        for role in ROLES:
            for word in words[role]:
                found.setdefault(word, role)
    return found


def meaning(heading: str) -> Meaning:
    """What a heading says."""
    text = unicodedata.normalize("NFKC", heading).replace("_", " ").casefold().strip()
    bracket = re.search(r"[\[(]\s*([^\])]*?)\s*[\])]", text)
    unit = bracket[1] if bracket else ""
    text = text.replace(bracket[0], " ") if bracket else text
    last = re.search(r"(?:^|\s|/)([^\s/\d]+)\s*$", text)
    if not unit and last and last[1] in ANGLE_UNITS and text.strip() != last[1]:
        unit, text = last[1], text[: last.start()]
    if text.rstrip().endswith("°"):
        unit, text = "°", text.rstrip()[:-1]
    numbers = re.findall(r"\d+", text)
    number = int(numbers[0]) if len(numbers) == 1 else None
    bare = " ".join(re.sub(r"[\d.:,;/()#№\-–]+" if text.strip() != "#" else r"\d+", " ", text).split())
    roles = _roles()
    goals = [word for word, role in roles.items() if role == "goal" and _holds(bare, word)]
    known = [word for word in roles if _holds(bare, word)]
    if bare in roles:
        known = [bare]
    word = max(known, key=len, default="")
    return Meaning(roles.get(word), number, unit, word, bool(goals))


def _holds(text: str, word: str) -> bool:
    """Whether a text holds a word: a whole one, where words have blanks between them."""
    if word.isascii() or not re.search(r"[\u3040-\u30ff\u3400-\u9fff]", word):
        return re.search(rf"(?<!\w){re.escape(word)}(?!\w)", text) is not None
    return word in text
