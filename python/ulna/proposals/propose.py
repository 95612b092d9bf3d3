"""From a file of readings, and what a person says, to the proposal of a study; or to the questions that are left."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from ulna.arm.arm import Arm
from ulna.artefacts.kinds import kind_of
from ulna.formats.header import Header
from ulna.formats.layout import Layout
from ulna.formats.table import read_header
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.proposals.angles import Angles, angles_of, counts_question, unit_of
from ulna.proposals.answers import Answers, Question, UnansweredError, check
from ulna.proposals.arms import DRAWING, PARALLEL, Drawn, as_asked, by_reach, drawn_arm, encoder_questions
from ulna.proposals.columns import Column, Taken, columns_of, own_rows
from ulna.proposals.dialect import seen_dialect
from ulna.proposals.fitting import (
    ball_question,
    check_axes,
    check_mapped,
    check_scale,
    conditions_on_cells,
    counts_known,
    probe_names,
)
from ulna.proposals.labels import Labels, feature_labels, other_labels, standing_labels
from ulna.proposals.stated import Stated, stated

WHAT = "a readings file (CSV, Parquet, .xlsx, .mat or HDF5: a row for each touch, a column for each axis)"
#: keys that say how a file is written, of which options have the same names
_LAYOUT = [key for key in Layout.KEYS if key != "fill_down"]


@dataclass(frozen=True)
class Proposal:
    """A study that can be written, and what is to be said of it."""

    readings: Path
    arm: Arm
    drawn: Drawn
    search: bool
    """Whether the encoders' zeros are to be searched for."""
    stated: Stated
    angle: str
    angle_why: str
    taken: list[Taken]
    """Every column of the file, in its order."""
    entry: dict[str, Any]
    """Keys of the [[readings]] table but `file`."""
    remarks: list[str]
    rows: int
    others: tuple[Proposal, ...] = ()
    """Further readings of the same study: of other artefacts, or in other files."""

    @property
    def every(self) -> tuple[Proposal, ...]:
        """This one, and the others."""
        return (self, *self.others)

    @property
    def inputs(self) -> list[Path]:
        """Files that are read and stay where they are."""
        return [path for each in self.every for path in (each.readings, *each.drawn.files, *each.stated.files)]


@dataclass(frozen=True)
class Opened:
    """A file of readings, looked at."""

    layout: Layout
    """As it is said."""
    seen: dict[str, str]
    """Key → what was seen of how it is written."""
    header: Header
    columns: list[Column]


def opened(answers: Answers) -> Opened:
    """The file of readings. Raises UlnaInputError, UnansweredError where none was said."""
    path = answers.readings
    if path is None:
        raise UnansweredError(
            "ulna new",
            [Question("readings", "--readings FILE", worded("which file has the readings, a row for each touch"))],
        )
    layout = Layout.of_options(answers.columns, answers.names, **{key: getattr(answers, key) for key in _LAYOUT})
    bare, seen = seen_dialect(path, replace(layout, columns={}, names={}), WHAT)
    header = read_header(path, WHAT, bare)
    return Opened(layout, seen, header, columns_of(header))


def propose(answers: Answers) -> Proposal:
    """The proposal. Raises UnansweredError with all questions that can be asked now, UlnaInputError for what cannot be
    used."""
    check(answers)
    file = opened(answers)
    path, layout, header, columns = file.header.path, file.layout, file.header, file.columns
    check_mapped(layout, header)
    if not len(columns[0].texts):
        raise UlnaInputError(f"{path}: there are no rows; expected at least one reading. Add them.")
    found = drawn_arm(answers)
    questions = found if isinstance(found, list) else []
    drawn = None if isinstance(found, list) else found
    if drawn is not None:
        drawn.arm.check_turns(path, "studies proposed from tables")
    angles = angles_of(path, columns, layout.columns, None if drawn is None else drawn.joint_names)
    if isinstance(angles, Question):
        raise UnansweredError(str(path), [*questions, angles])
    own = own_rows(columns, answers.of_rows)
    what = stated(answers, own, path)
    questions += what if isinstance(what, list) else []
    if drawn is None and not isinstance(found, list):
        if answers.reach is None:
            questions.append(DRAWING)
        elif not answers.parallel:
            questions.append(PARALLEL)
        else:
            if not answers.scaled:
                check_scale(what, answers)
            drawn = by_reach(angles.count, answers.reach, answers.parallel, path.stem)
    if drawn is not None:
        check_axes(path, drawn, angles)
        questions += encoder_questions(drawn, answers)
    unit = unit_of(path, angles, answers)
    if isinstance(unit, Question):
        questions.append(unit)
    elif unit[0] == "counts" and not answers.counts_per_turn and not counts_known(drawn):
        questions.append(counts_question(angles))
    if isinstance(what, list):
        raise UnansweredError(str(path), questions)
    labels = labels_of(path, answers, own, angles, what, layout)
    questions += labels.questions
    bad = conditions_on_cells(header, angles, answers)
    questions += [bad] if isinstance(bad, Question) else []
    if drawn is not None:
        questions += ball_question(what, drawn, answers, path)
    if questions or drawn is None or isinstance(unit, Question) or isinstance(bad, Question):
        raise UnansweredError(str(path), questions)
    probes = probe_names(own, labels, drawn, path, dict(layout.names))
    arm, search = as_asked(drawn, answers, probes)
    if answers.of_rows is not None:
        name, label = answers.of_rows
        naming = next(column for column in columns if column.name == name)
        labels.take(naming, "artefact", worded("the rows of '{label}'", label=label), filled=True)
        bad = {**bad, "artefact": label}
    taken = {each.column: each for each in [*labels.taken, *angles.taken]}
    entry = entry_of(answers, file.seen, unit[0], list(taken.values()), labels, dict(layout.names), bad)
    remarks = [*drawn.remarks, *what.remarks]  # of the readings: whoever loads the study is told
    order = [taken[column.name] for column in columns]
    return Proposal(path, arm, drawn, search, what, *unit, order, entry, remarks, len(own[0].texts))


def labels_of(
    path: Path, answers: Answers, columns: Sequence[Column], angles: Angles, what: Stated, layout: Layout
) -> Labels:
    """What the columns beside the angles hold. Raises UlnaInputError."""
    found = Labels()
    used = {column.name for column in angles.columns}
    rest = [column for column in columns if column.name not in used]
    artefact, kind = what.artefact, kind_of(what.artefact)
    features, touched = list(artefact.features), None
    said = layout.names.get("feature")
    if kind.named and len(features) > 1:
        alike = len(features) == 2
        if said is not None:
            column = next((c for c in rest if c.name in (layout.columns.get("feature"), "feature")), None)
            column = column or next((c for c in rest if c.meaning.role == "feature"), None)
            if column is not None:
                found.take(column, "feature", worded("said with --name"), filled=True)
            touched = column
        else:
            touched = feature_labels(rest, features, alike, layout.columns, found)
    rest = [column for column in rest if touched is None or column.name != touched.name]
    standing_labels(rest, touched, kind.placed(artefact), answers.one_standing, layout.columns, found)
    taken = {each.column for each in found.taken}
    rest = [column for column in rest if column.name not in taken]
    for column in list(rest):
        if re.fullmatch(r"[xyzu]|p\d+", column.name) and column.numeric and (not features or kind.poses == 2):
            found.take(column, column.name, worded("Ulna's own name"))
            rest.remove(column)
    other_labels(path, rest, None if artefact.length_mm is not None else kind.measured_column, layout.columns, found)
    return found


def entry_of(
    answers: Answers,
    seen: dict[str, str],
    angle: str,
    taken: list[Taken],
    labels: Labels,
    said: dict[str, Any],
    where: dict[str, Any],
) -> dict[str, Any]:
    """Keys of the [[readings]] table."""
    entry: dict[str, Any] = {"angle": angle}
    usual = Answers()
    given = {key: getattr(answers, key) for key in _LAYOUT if getattr(answers, key) != getattr(usual, key)}
    entry |= given
    entry |= seen
    columns = {each.ours: each.column for each in taken if each.ours and each.ours != each.column}
    ordered = sorted(columns, key=lambda ours: (ours[0] != "q", len(ours), ours))
    if columns:
        entry["columns"] = {ours: columns[ours] for ours in ordered}
    names = labels.names | said
    if names:
        entry["names"] = {column: {ours: _plain(own) for ours, own in each.items()} for column, each in names.items()}
    if labels.fill_down:
        entry["fill_down"] = labels.fill_down
    unused = [each.column for each in taken if not each.ours]
    if unused:
        entry["ignore"] = unused
    if where:
        entry["where"] = where
    return entry


def _plain(labels: Any) -> Any:
    """One label as it is, several as a list."""
    return labels[0] if isinstance(labels, list) and len(labels) == 1 else labels
