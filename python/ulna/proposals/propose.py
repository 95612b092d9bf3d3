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
from ulna.formats.names import check_name
from ulna.formats.table import read_header
from ulna.ground.errors import UlnaInputError
from ulna.proposals.angles import Angles, angles_of, counts_question, unit_of
from ulna.proposals.answers import Answers, Question, UnansweredError, check
from ulna.proposals.arms import DRAWING, PARALLEL, Drawn, as_asked, by_reach, drawn_arm, encoder_questions
from ulna.proposals.columns import Column, Taken, columns_of, named
from ulna.proposals.dialect import seen_dialect
from ulna.proposals.labels import Labels, feature_labels, matched_labels, other_labels, standing_labels
from ulna.proposals.stated import Stated, stated

WHAT = "a readings file (CSV, Parquet, .xlsx, .mat or HDF5: a row for each touch, a column for each axis)"
#: cells of a column that are no numbers, each of them said in the study
_MOST_WORDS = 12
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

    @property
    def inputs(self) -> list[Path]:
        """Files that are read and stay where they are."""
        return [self.readings, *self.drawn.files, *self.stated.files]


def propose(answers: Answers) -> Proposal:
    """The proposal. Raises UnansweredError with all questions that can be asked now, UlnaInputError for what cannot be
    used."""
    check(answers)
    path = answers.readings
    if path is None:
        raise UnansweredError(
            "ulna new", [Question("readings", "--readings FILE", "which file has the readings, a row for each touch")]
        )
    layout = Layout.of_options(answers.columns, answers.names, **{key: getattr(answers, key) for key in _LAYOUT})
    bare = replace(layout, columns={}, names={})
    bare, seen = seen_dialect(path, bare, WHAT)
    header = read_header(path, WHAT, bare)
    columns = columns_of(header)
    _check_mapped(layout, header)
    if not len(columns[0].texts):
        raise UlnaInputError(f"{path}: there are no rows; expected at least one reading. Add them.")
    found = drawn_arm(answers)
    questions = found if isinstance(found, list) else []
    drawn = None if isinstance(found, list) else found
    angles = angles_of(path, columns, layout.columns, None if drawn is None else drawn.joint_names)
    if isinstance(angles, Question):
        raise UnansweredError(str(path), [*questions, angles])
    what = stated(answers, columns, path)
    questions += what if isinstance(what, list) else []
    if drawn is None and not isinstance(found, list):
        if answers.reach is None:
            questions.append(DRAWING)
        elif not answers.parallel:
            questions.append(PARALLEL)
        else:
            _check_scale(what, answers)
            drawn = by_reach(angles.count, answers.reach, answers.parallel, path.stem)
    if drawn is not None:
        _check_axes(path, drawn, angles)
        questions += encoder_questions(drawn, answers)
    unit = unit_of(path, angles, answers)
    if isinstance(unit, Question):
        questions.append(unit)
    elif unit[0] == "counts" and not answers.counts_per_turn and not _counts_known(drawn):
        questions.append(counts_question(angles))
    if isinstance(what, list):
        raise UnansweredError(str(path), questions)
    labels = _labels(path, answers, columns, angles, what, layout)
    questions += labels.questions
    bad = _bad_cells(header, angles, answers)
    questions += [bad] if isinstance(bad, Question) else []
    if drawn is not None:
        questions += _ball(what, drawn, answers, path)
    if questions or drawn is None or isinstance(unit, Question) or isinstance(bad, Question):
        raise UnansweredError(str(path), questions)
    probes = _probe_names(columns, labels, drawn, path, dict(layout.names))
    arm, search = as_asked(drawn, answers, probes)
    taken = {each.column: each for each in [*labels.taken, *angles.taken]}
    entry = _entry(answers, seen, unit[0], list(taken.values()), labels, dict(layout.names), bad)
    remarks = [*drawn.remarks, *what.remarks]  # of the readings: whoever loads the study is told
    order = [taken[column.name] for column in columns]
    return Proposal(path, arm, drawn, search, what, *unit, order, entry, remarks, len(columns[0].texts))


def _check_mapped(layout: Layout, header: Header) -> None:
    """Columns that were said are there. Raises UlnaInputError."""
    known = [*(f"q{k}" for k in range(1, 65)), *(f"p{k}" for k in range(1, 65))]
    layout = replace(layout, names={})
    layout.mapped(
        header,
        [*known, "id", "probe", "artefact", "placement", "feature", "length", "distance", "temperature", *"xyzu"],
    )


def _check_axes(path: Path, drawn: Drawn, angles: Angles) -> None:
    if drawn.arm.n != angles.count:
        first, last = angles.columns[0].name, angles.columns[-1].name
        raise UlnaInputError(
            f"{path}: it has {angles.count} columns of angles ('{first}' to '{last}'), but the arm ({drawn.said}) has "
            f"{drawn.arm.n} joints; expected as many. Name the right arm, or say with --column q1=NAME … which columns "
            "they are."
        )


def _check_scale(what: Stated | list[Question], answers: Answers) -> None:
    """An arm that nobody drew has its lengths from the artefact, which must have some. Raises UlnaInputError."""
    if isinstance(what, list):
        return
    artefact, kind = what.artefact, kind_of(what.artefact)
    has_length = kind.dimensions(artefact) or len(artefact.features) > 1 or kind.measured_column is not None
    if not has_length and "features" not in kind.table.model_fields:
        raise UlnaInputError(
            f"--reach: an artefact of kind '{kind.name}' has no length, so that every length of the arm would be a "
            f"guess from its reach of {answers.reach:g} mm; expected a drawing of the arm, or an artefact of known "
            "length. Give --dh, --urdf or --arm, or touch a bar as well."
        )


def _counts_known(drawn: Drawn | None) -> bool:
    return drawn is not None and all(joint.counts_per_turn is not None for joint in drawn.arm.joints)


def _labels(
    path: Path, answers: Answers, columns: Sequence[Column], angles: Angles, what: Stated, layout: Layout
) -> Labels:
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
                found.take(column, "feature", "said with --name", filled=True)
            touched = column
        else:
            touched = feature_labels(rest, features, alike, layout.columns, found)
    rest = [column for column in rest if touched is None or column.name != touched.name]
    standing_labels(rest, touched, kind.placed(artefact), answers.one_standing, layout.columns, found)
    taken = {each.column for each in found.taken}
    rest = [column for column in rest if column.name not in taken]
    for column in list(rest):
        if re.fullmatch(r"[xyzu]|p\d+", column.name) and column.numeric and (not features or kind.poses == 2):
            found.take(column, column.name, "Ulna's own name")
            rest.remove(column)
    other_labels(path, rest, None if artefact.length_mm is not None else kind.measured_column, layout.columns, found)
    return found


def _ball(what: Stated, drawn: Drawn, answers: Answers, path: Path) -> list[Question]:
    """Of the probe, where the kind cannot do without."""
    if answers.ball is not None:
        return []
    try:
        kind_of(what.artefact).check_probes(what.artefact, drawn.arm, range(len(drawn.arm.probes)), str(path))
    except UlnaInputError:
        return [Question("ball", "--ball MM", "what is the diameter of the probe's ball, in mm")]
    return []


def _bad_cells(header: Header, angles: Angles, answers: Answers) -> dict[str, Any] | Question:
    """Conditions that leave out rows without a number, where that was said; else the question."""
    bad = [(row, column) for column in angles.columns for row in column.bad]
    if not bad:
        return {}
    if not answers.skip_bad:
        told = ", ".join(f"{header.at(row, column.name)}: '{column.texts[row - 1][:20]}'" for row, column in bad[:6])
        more = ", …" if len(bad) > 6 else ""
        rows = len({row for row, _ in bad})
        asks = f"shall {rows} row{'s' * (rows > 1)} be left out in which an axis has no number ({told}{more})"
        return Question("skip_bad", "--skip-bad", asks, ("yes",))
    where: dict[str, Any] = {}
    for k, column in enumerate(angles.columns, start=1):
        words = sorted({column.texts[row - 1] for row in column.bad} - {""})
        if len(words) > _MOST_WORDS:
            raise UlnaInputError(
                f"{header.path}: {header.named(column.name)}: {len(words)} different texts stand where numbers are "
                "expected; expected a few at the most, such as 'error'. Correct the cells."
            )
        if column.bad:
            where[f"q{k}"] = {"not": words, "empty": False} if words else {"empty": False}
    return where


def _probe_names(
    columns: Sequence[Column], labels: Labels, drawn: Drawn, path: Path, said: dict[str, Any]
) -> list[str]:
    """Names of the probes as the readings call them; [] where they do not. Raises UlnaInputError where they do not fit
    those of the arm."""
    column = next((named(columns, taken.column) for taken in labels.taken if taken.ours == "probe"), None)
    if column is None:
        return []
    names = list(said.get("probe", column.labels))
    have = list(drawn.arm.probes)
    if len(have) == 1:
        for name in names:
            check_name(name, "probe", path)
        return names
    matched = matched_labels(names, have, alike=False)
    if matched is None:
        raise UlnaInputError(
            f"{path}: column '{column.name}' names the probes {', '.join(names[:8])}, the arm has {', '.join(have[:8])}"
            f"; expected the same. Say which is which: --name 'probe.{have[0]}=LABEL'."
        )
    if any(ours != label for ours, theirs in matched.items() for label in theirs) and "probe" not in said:
        labels.names["probe"] = matched
    return []


def _entry(
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
