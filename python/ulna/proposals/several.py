"""Several artefacts, several files, one study: which file is of which artefact, each of them proposed like one alone.

A file for each artefact, in the order in which both are said; several files of one artefact; or one file with a column
that names the artefact of each row.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from ulna.artefacts.kinds import KINDS
from ulna.formats.names import check_name
from ulna.formats.units import MM_PER
from ulna.ground.errors import UlnaInputError, nearest
from ulna.ground.worded import worded
from ulna.proposals.answers import Answers, Question, UnansweredError
from ulna.proposals.columns import Column
from ulna.proposals.propose import Proposal, opened, propose


@dataclass(frozen=True)
class Touched:
    """An artefact as it is said in one word: `bar:443.172`, `ball=sphere:25.4:0.001`, `points:plate.csv`."""

    kind: str
    name: str | None = None
    """In the study, and in a column that names artefacts."""
    value: str | None = None
    """Its length or diameter in mm, or the file of its features."""
    u: float | None = None
    """mm."""

    def said(self, answers: Answers) -> Answers:
        """With this artefact. Raises UlnaInputError for a value that the kind has no place for."""
        answers = replace(answers, artefact=self.kind, called=self.name)
        if self.u is not None:
            answers = replace(answers, u=self.u)
        if self.value is None:
            return answers
        fields = KINDS[self.kind].table.model_fields
        if "features" in fields:
            return replace(answers, features=Path(self.value))
        key = next((key for key in ("length", "diameter") if key in fields), None)
        if key is None:
            raise UlnaInputError(
                f"--artefact {self.kind}:{self.value}: an artefact of kind '{self.kind}' has no dimension; expected "
                f"--artefact {self.kind}. Leave the value out."
            )
        number = _number(self.value)
        if number is None:
            raise UlnaInputError(
                f"--artefact {self.kind}:{self.value}: got '{self.value}', expected its {key} in mm, a number above 0."
            )
        return replace(answers, length=number) if key == "length" else replace(answers, diameter=number)


def touched(text: str) -> Touched:
    """An artefact as it is said. Raises UlnaInputError."""
    head, _, rest = text.strip().partition(":")
    name, _, kind = head.rpartition("=")
    if kind not in KINDS:
        raise UlnaInputError(
            f"--artefact: got '{text}', expected a kind of artefact, {', '.join(KINDS)}, perhaps with its size: "
            f"bar:443.172 (mm), points:plate.csv.{nearest(kind, KINDS)}"
        )
    value, _, last = rest.rpartition(":")
    u = _number(last) if value else None
    if u is None:
        value = rest
    if name:
        check_name(name, "artefact", Path("--artefact"))
    return Touched(kind, name or None, value or None, u)


def _number(text: str) -> float | None:
    try:
        value = float(text.replace(",", "."))
    except ValueError:
        return None
    return value if math.isfinite(value) and value > 0 else None


def parts_of(answers: Answers, readings: Sequence[Path], artefacts: Sequence[Touched]) -> list[Answers]:
    """What is proposed: for each file, or each artefact of a file, the answers. Raises UlnaInputError where it is not
    said which file is of which artefact, UnansweredError where a file names artefacts of which nothing is said."""
    if len(artefacts) > 1:
        for name in ("length", "diameter", "features", "u"):
            if getattr(answers, name) is not None:
                raise UlnaInputError(
                    f"--{name}: of which of the {len(artefacts)} artefacts? Say it with the artefact: --artefact "
                    "bar:443.172, --artefact points:plate.csv, a standard uncertainty behind it (bar:443.172:0.001)."
                )
    one = replace(answers, scaled=len(artefacts) > 1 and any(each.value for each in artefacts))
    if len(readings) == 1:
        own = _of_one_file(replace(one, readings=readings[0]), artefacts)
        if own is not None:
            return own
    if len(readings) <= 1 and len(artefacts) <= 1:
        made = replace(one, readings=readings[0] if readings else None)
        return [artefacts[0].said(made) if artefacts else made]
    if len(artefacts) == 1:
        return [artefacts[0].said(replace(one, readings=path)) for path in readings]
    if len(readings) != len(artefacts):
        raise UlnaInputError(
            f"--readings and --artefact: got {len(readings)} file{'s' * (len(readings) != 1)} and {len(artefacts)} "
            "artefacts; expected a file for each, in the same order, or one file with a column that names the artefact "
            "of each row (--column artefact=NAME). Say --readings again for each file."
        )
    names = _names(artefacts)
    return [
        replace(each, name=name).said(replace(one, readings=path))
        for path, each, name in zip(readings, artefacts, names, strict=True)
    ]


def _names(artefacts: Sequence[Touched]) -> list[str]:
    """A name for each: what was said, else its kind; numbered where that is there already."""
    found: list[str] = []
    for each in artefacts:
        base, number = each.name or each.kind, 1
        name = base
        while name in found:
            number += 1
            name = f"{base}-{number}"
        found.append(name)
    return found


def _of_one_file(answers: Answers, artefacts: Sequence[Touched]) -> list[Answers] | None:
    """A part for each artefact that a column of the file names; None where the file names none or one."""
    said = [each.partition("=") for each in answers.columns]
    mapped = next((theirs for ours, _, theirs in said if ours == "artefact"), None)
    column = _naming(opened(answers).columns, mapped)
    if column is None:
        return None
    labels = column.down().unique(maintain_order=True).to_list()
    known = {each.name: each for each in artefacts if each.name is not None}
    lacking = [label for label in labels if label not in known]
    strange = [name for name in known if name not in labels]
    if lacking and strange:
        raise UlnaInputError(
            f"--artefact {strange[0]}=…: column '{column.name}' of {answers.readings} names no '{strange[0]}'."
            f"{nearest(strange[0], labels)} Correct it."
        )
    if lacking:
        raise UnansweredError(
            str(answers.readings),
            [
                Question(
                    "artefact",
                    f"--artefact '{label}=KIND:VALUE'",
                    worded(
                        "what is '{label}' in column '{column}', and of which size", label=label, column=column.name
                    ),
                    about=label,
                )
                for label in lacking
            ],
        )
    rest = tuple(each for each in answers.columns if not each.startswith("artefact="))
    shared = replace(answers, columns=rest)
    return [known[label].said(replace(shared, of_rows=(column.name, label))) for label in labels]


def _naming(columns: Sequence[Column], mapped: str | None) -> Column | None:
    """The column that names several artefacts."""
    if mapped is not None:
        return next((column for column in columns if column.name == mapped), None)
    named = [c for c in columns if (c.meaning.role == "artefact" or c.name == "artefact") and not c.numeric]
    return next((column for column in named if len(column.labels) > 1), None)


def propose_all(parts: Sequence[Answers]) -> Proposal:
    """The study of all parts, with the first one's arm. Raises UnansweredError with all that is asked of any part, each
    thing once; UlnaInputError where the parts do not go together."""
    if len(parts) == 1:
        return propose(parts[0])
    found: list[Proposal] = []
    questions: dict[tuple[str, str, str], Question] = {}
    for part in parts:
        try:
            found.append(propose(part))
        except UnansweredError as asked:
            own = [_with_artefact(each, part) for each in asked.questions]
            questions |= {(each.field, each.flag, each.asks): each for each in own}
    if questions:
        raise UnansweredError(", ".join(dict.fromkeys(str(part.readings) for part in parts)), list(questions.values()))
    first, *others = in_one_unit(found)
    for other in others:
        if other.arm.n != first.arm.n:
            raise UlnaInputError(
                f"{other.readings}: it has {other.arm.n} columns of angles, {first.readings} has {first.arm.n}; "
                "expected readings of one arm. Write a study for each arm."
            )
    probes = {name: probe for each in (first, *others) for name, probe in each.arm.probes.items()}
    arm = replace(first.arm, probes=probes)
    return replace(first, arm=arm, others=tuple(replace(other, arm=arm) for other in others))


def _with_artefact(question: Question, part: Answers) -> Question:
    """Of several artefacts, sizes are said with the one that they are of."""
    if question.field not in ("length", "diameter", "features"):
        return question
    named = "" if part.called in (None, part.artefact) else f"{part.called}="
    return replace(question, flag=f"--artefact {named}{part.artefact}:{question.flag.rpartition(' ')[2]}")


def in_one_unit(found: Sequence[Proposal]) -> list[Proposal]:
    """The proposals with their lengths in the unit that the files have; a study has one. Raises UlnaInputError."""
    bound = {each.stated.length_unit: each for each in found if each.stated.bound}
    if len(bound) > 1:
        told = " and ".join(f"{each.stated.source or each.readings} in {unit}" for unit, each in bound.items())
        raise UlnaInputError(
            f"the lengths are in several units: {told}; expected one for a study. Write one of the files in the other "
            "unit."
        )
    unit = next(iter(bound), found[0].stated.length_unit)
    return [each if each.stated.length_unit == unit else _in_unit(each, unit) for each in found]


def _in_unit(proposal: Proposal, unit: str) -> Proposal:
    stated = proposal.stated
    factor = MM_PER[stated.length_unit] / MM_PER[unit]
    keys = {k: v * factor if k in ("length", "diameter", "u") else v for k, v in stated.keys.items()}
    return replace(proposal, stated=dataclasses.replace(stated, keys=keys, length_unit=unit))


_OF_THE_ARM = (
    *("reach", "parallel", "dh", "convention", "length_unit", "angle_unit", "tip", "urdf", "tip_link", "base_link"),
    *("arm", "ball", "zeros", "signs", "counts_per_turn"),
)


def arm_said(told: Answers, answers: Answers) -> Answers:
    """With what was said of the arm for other readings."""
    return replace(answers, **{name: getattr(told, name) for name in _OF_THE_ARM})


def another(done: Sequence[Answers], text: str) -> list[Answers]:
    """One more artefact and its file, `bar:443.172 FILE`; nothing for `no`. done: what there is. Raises
    UlnaInputError."""
    said, _, file = text.strip().partition(" ")
    if said.casefold() in ("no", "n", ""):
        return []
    if not file.strip():
        raise UlnaInputError(f"got '{text}', expected no, or an artefact and its file, such as bar:443.172 bar.csv.")
    known = [Touched(str(each.artefact), each.called) for each in done]
    new = touched(said)
    if new.name is not None and new.name in [each.name or each.kind for each in known]:
        raise UlnaInputError(f"got '{new.name}', which is another artefact already; expected a name of its own.")
    name = _names([*known, new])[-1]
    bare = replace(Answers(readings=Path(file.strip()), scaled=True), called=name)
    return [replace(new, name=name).said(arm_said(done[0], bare))]
