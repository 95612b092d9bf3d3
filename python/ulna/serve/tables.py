"""Files of readings, looked at and made into studies, as `ulna new` does it."""

from __future__ import annotations

import secrets
from collections.abc import Iterator
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import polars as pl

from ulna.calibration.identify import identify, not_determined
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import capital, kept, recalled, templates, worded
from ulna.proposals.answers import Answers, Question, UnansweredError
from ulna.proposals.columns import Column
from ulna.proposals.propose import Opened, Proposal, opened
from ulna.proposals.several import Touched, parts_of, propose_all, touched
from ulna.proposals.write import write_proposal
from ulna.serve.contract import tables as wire
from ulna.serve.contract.model import shortened
from ulna.serve.desk import Desk
from ulna.serve.remarks import remarks
from ulna.serve.workshop import SESSIONS, Workshop
from ulna.study.study import Study

FIRST, MOST_BAD, LONGEST = 20, 20, 200

ROLES = templates(
    "angle",
    "feature",
    "standing",
    "artefact",
    "measurement",
    "temperature",
    "probe",
    "measured",
    "goal",
    "aside",
    "length",
    "distance",
    "bar",
    "seat",
    "points",
    "sphere",
    "plane",
    "cylinder",
    "orientation",
)
"""What a column may be, and what may be touched."""


def looked(desk: Desk, asked: wire.StudyAsked) -> wire.Looked:
    """The files as they stand, and what `ulna new` proposes, asks or refuses. Raises UlnaInputError for what is not on
    the desk, or no table."""
    answers, paths = _answers(desk, asked), [desk.path(each) for each in asked.files]
    seen = [opened(replace(answers, readings=path)) for path in paths]
    proposal: Proposal | None = None
    questions: list[Question] = []
    wrong: str | None = None
    try:
        with remarks():  # of the proposal itself, which says them
            proposal = _proposed(desk, asked)
    except UnansweredError as error:
        questions = error.questions
    except UlnaInputError as error:
        wrong = kept(error)
    tables = [_table(desk, sha256, each, proposal) for sha256, each in zip(asked.files, seen, strict=True)]
    return wire.Looked(
        tables=tables,
        proposal=None if proposal is None else _proposal(proposal),
        questions=[_question(each) for each in questions],
        wrong=None if wrong is None else shortened(wrong),
    )


def study_made(workshop: Workshop, asked: wire.StudyAsked) -> wire.StudyMade:
    """What `ulna new --readings FILE` writes, in a folder of its own. Raises UlnaInputError, with nothing written."""
    proposal = _proposed(workshop.desk, asked)
    folder = workshop.folder / SESSIONS / f"{datetime.now(UTC):%Y-%m-%d-%H%M%S}-{secrets.token_hex(2)}"
    write_proposal(proposal, folder)
    study = folder / "study.toml"
    with remarks() as said:
        found = identify(Study.load(study))
    return wire.StudyMade(
        study=workshop.desk.take(study),
        arm=workshop.desk.take(folder / "arm.toml"),
        proposal=_proposal(proposal),
        determined=found.determined,
        parameters=found.parameters,
        sentences=[*said, *(not_determined(each) for each in found.lost if not each["frame"])],
    )


def _proposed(desk: Desk, asked: wire.StudyAsked) -> Proposal:
    paths = [desk.path(each) for each in asked.files]
    return propose_all(parts_of(_answers(desk, asked), paths, [_touched(desk, each) for each in asked.touched]))


def _touched(desk: Desk, asked: wire.TouchedAsked) -> Touched:
    given = [each for each in (asked.length_mm, asked.diameter_mm, asked.features) if each is not None]
    if len(given) > 1:
        raise UlnaInputError(
            f"touched: '{asked.kind}' has several of length_mm, diameter_mm and features; expected one of them at most."
        )
    name = f"{asked.name}=" if asked.name is not None else ""
    found = touched(f"{name}{asked.kind}")  # that the kind is one, and the name can be used
    value = str(desk.path(asked.features)) if asked.features is not None else None
    if asked.length_mm is not None or asked.diameter_mm is not None:
        value = repr(asked.length_mm if asked.length_mm is not None else asked.diameter_mm)
    return replace(found, value=value, u=asked.u_mm)


def _answers(desk: Desk, asked: wire.StudyAsked) -> Answers:
    arm = asked.arm

    def place(sha256: str | None) -> Path | None:
        return None if sha256 is None else desk.path(sha256)

    tip: Any = None if arm.tip is None else tuple(arm.tip)
    layout = asked.layout.model_dump(exclude_none=True)
    return Answers(
        angle=asked.angle,
        counts_per_turn=tuple(arm.counts_per_turn or ()),
        one_standing=asked.one_standing,
        skip_bad=asked.skip_bad,
        reach=arm.reach_mm,
        parallel=tuple(arm.parallel or ()),
        dh=place(arm.dh),
        convention=arm.convention,
        length_unit=asked.length_unit,
        angle_unit=arm.angle_unit,
        tip=tip,
        urdf=place(arm.urdf),
        tip_link=arm.tip_link,
        base_link=arm.base_link,
        arm=place(arm.arm),
        ball=arm.ball_mm,
        zeros=arm.zeros,
        signs=arm.signs,
        columns=tuple(f"{each.ours}={each.theirs}" for each in asked.columns),
        names=tuple(f"{each.column}.{each.ours}={each.theirs}" for each in asked.labels),
        **layout,
    )


def _table(desk: Desk, sha256: str, seen: Opened, proposal: Proposal | None) -> wire.TableSeen:
    header = seen.header
    own = [] if proposal is None else [each for each in proposal.every if each.readings == header.path]
    taken = {each.column: (each.ours, each.why) for part in own for each in part.taken}
    texts = pl.DataFrame([column.texts.alias(str(k)) for k, column in enumerate(seen.columns)])
    return wire.TableSeen(
        file=desk.info(sha256),
        head=header.head,
        seen=[(key, str(value)[:LONGEST]) for key, value in seen.seen.items()],
        columns=[_column(seen, each, taken) for each in seen.columns],
        first=[
            wire.RowSeen(at=header.where(number), cells=[str(cell)[:LONGEST] for cell in row])
            for number, row in enumerate(texts.head(FIRST).iter_rows(), start=1)
        ],
        rows=len(texts),
        remarks=list(header.remarks),
    )


def _column(seen: Opened, column: Column, taken: dict[str, tuple[str, str]]) -> wire.ColumnSeen:
    role, word = column.meaning.role, column.meaning.word
    guess = "" if role is None else worded("'{word}' says {role}", word=word or column.name, role=recalled(role, ROLES))
    ours, why = taken.get(column.name, (None, guess))
    empty = column.meaning.role == "angle" or (ours or "").startswith("q")  # elsewhere what is empty may be meant
    bad = [row for row in column.bad if empty or column.texts[row - 1]][:MOST_BAD] if column.numeric else []
    return wire.ColumnSeen(
        name=column.name,
        taken_for=ours,
        why=why,
        unit=column.meaning.unit,
        numeric=column.numeric,
        filled=column.filled,
        bad=[f"{seen.header.at(row, column.name)}: '{column.texts[row - 1][:20]}'" for row in bad],
    )


def _question(question: Question) -> wire.QuestionSaid:
    return wire.QuestionSaid(
        field=question.field,
        asks=capital(worded("{asks}?", asks=question.asks)),
        choices=list(question.choices),
        about=question.about,
        flag=question.flag,
    )


def _proposal(proposal: Proposal) -> wire.ProposalSaid:
    stated = {each.stated.artefact.name: each.stated.artefact for each in proposal.every}
    return wire.ProposalSaid(
        arm=proposal.drawn.said,
        joints=proposal.arm.n,
        search=proposal.search,
        signs_unknown=bool(proposal.arm.unknown_signs.any()),
        angle=proposal.angle,
        angle_why=proposal.angle_why,
        artefacts=[
            worded("{name}: {kind}", name=name, kind=recalled(each.kind, ROLES))
            if each.stated == "–"
            else worded("{name}: {kind}, {size}", name=name, kind=recalled(each.kind, ROLES), size=each.stated)
            for name, each in stated.items()
        ],
        rows=sum(each.rows for each in proposal.every),
        remarks=list(dict.fromkeys(_remarks(proposal))),
    )


def _remarks(proposal: Proposal) -> Iterator[str]:
    for each in proposal.every:
        yield from each.remarks
