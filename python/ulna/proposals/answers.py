"""What a person has said, and what must still be asked: each question has a flag that answers it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ulna.ground.errors import UlnaInputError


@dataclass(frozen=True)
class Answers:
    """All that may be said; None where nobody has."""

    readings: Path | None = None
    artefact: str | None = None
    """The kind: a row of `ulna.artefacts.kinds`."""
    length: float | None = None
    """mm, like all lengths here."""
    diameter: float | None = None
    features: Path | None = None
    u: float | None = None
    angle: str | None = None
    counts_per_turn: tuple[float, ...] = ()
    one_standing: bool = False
    skip_bad: bool = False
    reach: float | None = None
    """From the base to the tip of the stretched arm."""
    parallel: tuple[str, ...] = ()
    """With a reach: axes that are parallel to the next one, by their numbers; or "none"."""
    dh: Path | None = None
    convention: str | None = None
    length_unit: str | None = None
    angle_unit: str | None = None
    tip: tuple[float, float, float] | None = None
    """In the drawing's unit of length."""
    urdf: Path | None = None
    tip_link: str | None = None
    base_link: str | None = None
    arm: Path | None = None
    ball: float | None = None
    zeros: str | None = None
    signs: str | None = None
    columns: tuple[str, ...] = ()
    names: tuple[str, ...] = ()
    sheet: str | None = None
    dataset: str | None = None
    separator: str | None = None
    decimal: str | None = None
    thousands: str | None = None
    encoding: str | None = None
    comment: str | None = None
    header: bool | int = True
    units_row: bool | None = None
    called: str | None = None
    """The study's name of the artefact; its kind where nobody says."""
    of_rows: tuple[str, str] | None = None
    """Which rows are of this artefact: the column that names it, and how it is called there."""
    scaled: bool = False
    """Whether another artefact of the study has a known length."""


@dataclass(frozen=True)
class Question:
    """One thing that nobody has said and the file does not say."""

    field: str
    """Of `Answers`."""
    flag: str
    """What answers it on a command line: `--length MM`."""
    asks: str
    """What is asked, and why; without the question mark."""
    choices: tuple[str, ...] = ()
    about: str = ""
    """Of several alike, which one: an artefact that a file names."""

    def answered(self, answers: Answers, text: str) -> Answers:
        """With what somebody typed. Raises UlnaInputError for what is no answer."""
        return answer(answers, self, text)


class UnansweredError(UlnaInputError):
    """What must be said before a study can be written."""

    def __init__(self, where: str, questions: Sequence[Question]) -> None:
        self.questions = list(questions)
        asked = "; ".join(f"{each.asks} ({each.flag})" for each in self.questions)
        super().__init__(f"{where}: what the files do not say is asked for: {asked}. Say it with these options.")


def _number(text: str, question: Question) -> float:
    try:
        value = float(text.replace(",", "."))
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value > 0):
        raise UlnaInputError(f"{question.flag}: got '{text}', expected a number above 0.")
    return value


def _is_number(text: str) -> bool:
    return text.replace(",", "").replace(".", "").isdecimal()


def _numbers(text: str, question: Question) -> tuple[float, ...]:
    return tuple(_number(each, question) for each in text.split())


def _path(text: str, question: Question) -> Path:
    return Path(text)


def _word(text: str, question: Question) -> str:
    if question.choices and text not in question.choices:
        known = " or ".join(filter(None, [", ".join(question.choices[:-1]), question.choices[-1]]))
        raise UlnaInputError(f"{question.flag.split()[0]}: got '{text}', expected {known}.")
    return text


#: field of `Answers` → how it is read; all others are words
_READ: dict[str, Any] = {
    "readings": _path,
    "features": _path,
    "dh": _path,
    "urdf": _path,
    "arm": _path,
    "length": _number,
    "diameter": _number,
    "reach": _number,
    "ball": _number,
    "counts_per_turn": _numbers,
}
#: fields that take several answers
_SEVERAL = ("columns", "names")
#: in place of a field: the first word says which it is
DRAWN = {"reach": "reach", "dh": "dh", "urdf": "urdf", "arm": "arm"}


def answer(answers: Answers, question: Question, text: str) -> Answers:
    """With what somebody typed. Raises UlnaInputError for what is no answer."""
    text, field = text.strip(), question.field
    if field == "drawing":
        word, _, rest = f"reach {text}".partition(" ") if _is_number(text) else text.lstrip("-").partition(" ")
        if word not in DRAWN or not rest.strip():
            raise UlnaInputError(
                f"got '{text}', expected such as reach 1200, dh arm.csv, urdf arm.urdf or arm arm.toml."
            )
        field, text = DRAWN[word], rest.strip()
    if field == "standing":
        if text == "one":
            return replace(answers, one_standing=True)
        field, text = "columns", f"placement={text}"
    if field == "parallel":
        return replace(answers, parallel=tuple(text.replace(",", " ").split()))
    if field == "skip_bad":
        return replace(answers, skip_bad=_word(text, question) == "yes")
    read = (*getattr(answers, field), text) if field in _SEVERAL else _READ.get(field, _word)(text, question)
    changed: dict[str, Any] = {field: read}
    return replace(answers, **changed)


def check(answers: Answers) -> None:
    """What was said with options is what they take. Raises UlnaInputError."""
    for option, value, known in (
        ("--angle", answers.angle, ("rad", "deg", "counts")),
        ("--zeros", answers.zeros, ("known", "unknown")),
        ("--signs", answers.signs, ("known", "unknown")),
        ("--convention", answers.convention, ("dh", "modified-dh")),
        ("--length-unit", answers.length_unit, ("mm", "m", "in")),
        ("--angle-unit", answers.angle_unit, ("rad", "deg")),
    ):
        if value is not None and value not in known:
            raise UlnaInputError(f"{option}: got '{value}', expected {' or '.join(known)}. Correct it.")
    given = [f"--{name}" for name in DRAWN if getattr(answers, name) is not None]
    if len(given) > 1:
        raise UlnaInputError(
            f"{' and '.join(given)}: the arm is said twice; expected one of them. Leave the other out."
        )
    for option in ("length", "diameter", "u", "reach", "ball", "counts_per_turn"):
        value = getattr(answers, option)
        for each in value if isinstance(value, tuple) else (value,):
            if each is not None and not (math.isfinite(each) and each > 0):
                raise UlnaInputError(
                    f"--{option.replace('_', '-')}: got {each:g}, expected a number above 0. Correct it."
                )
