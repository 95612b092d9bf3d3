"""What `ulna new` asks on a terminal: one question after the other, until nothing is missing; elsewhere one message."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TypeVar

import typer

from ulna.ground.errors import UlnaInputError, for_people
from ulna.proposals.answers import Answers, Question, UnansweredError
from ulna.proposals.propose import Proposal, propose
from ulna.proposals.several import Touched, another, arm_said, parts_of, propose_all, touched

Answered = TypeVar("Answered")


def proposed(answers: Answers, readings: Sequence[Path], artefacts: Sequence[Touched]) -> Proposal:
    """The proposal of all files and artefacts. Raises UlnaInputError, UnansweredError where nobody can be asked."""
    if not sys.stdin.isatty():
        return propose_all(parts_of(answers, readings, artefacts))
    parts, asked = _parts(answers, readings, artefacts), False
    done: list[Answers] = []
    while parts:
        part = arm_said(done[0], parts.pop(0)) if done else parts.pop(0)
        told = _answered(part)
        asked = asked or told != part
        done.append(told)
        if asked and not parts:
            parts = _more(done)
    return propose_all(done)


def _parts(answers: Answers, readings: Sequence[Path], artefacts: Sequence[Touched]) -> list[Answers]:
    """What is proposed; artefacts that a file names are asked for. Raises UlnaInputError."""
    known = list(artefacts)
    while True:
        try:
            return parts_of(answers, readings, known)
        except UnansweredError as error:
            question = error.questions[0]
            known.append(_typed(question, partial(_named, question.about)))


def _named(name: str, text: str) -> Touched:
    return touched(f"{name}={text}")


def _answered(answers: Answers) -> Answers:
    """With all that is missing. Raises UlnaInputError where what was said without being asked does not fit."""
    before: Answers | None = None
    while True:
        try:
            propose(answers)
            return answers
        except UnansweredError as error:
            before, question = answers, error.questions[0]
            answers = _typed(question, partial(question.answered, answers))
        except UlnaInputError as error:  # what was typed last does not fit: it is asked for again
            if before is None or before == answers:
                raise
            print(for_people(str(error)), file=sys.stderr)
            answers = before


def _more(done: Sequence[Answers]) -> list[Answers]:
    """What was touched besides; nothing where nothing was."""
    question = Question("another", "no, or such as bar:443.172 FILE", "was another artefact touched")
    return _typed(question, partial(another, done))


def _typed(question: Question, read: Callable[[str], Answered]) -> Answered:
    """What somebody types, asked for again until it is an answer."""
    choices = "/".join(question.choices) or question.flag
    asks = f"{question.asks[0].upper()}{question.asks[1:]}? [{choices}]\n"
    while True:
        text = typer.prompt(asks, prompt_suffix="> ", err=True)
        try:
            return read(text)
        except UlnaInputError as error:
            print(for_people(str(error)), file=sys.stderr)
