"""What must fit together before a study can be proposed: columns, axes, probes, cells, a length to scale the arm by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from ulna.artefacts.kinds import kind_of
from ulna.formats.header import Header
from ulna.formats.layout import Layout
from ulna.formats.names import check_name
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.proposals.angles import Angles
from ulna.proposals.answers import Answers, Question
from ulna.proposals.arms import Drawn
from ulna.proposals.columns import Column, named
from ulna.proposals.labels import Labels, matched_labels
from ulna.proposals.stated import Stated

#: cells of a column that are no numbers, each of them said in the study
_MOST_WORDS = 12


def check_mapped(layout: Layout, header: Header) -> None:
    """Columns that were said are there. Raises UlnaInputError."""
    known = [*(f"q{k}" for k in range(1, 65)), *(f"p{k}" for k in range(1, 65))]
    layout = replace(layout, names={})
    layout.mapped(
        header,
        [*known, "id", "probe", "artefact", "placement", "feature", "length", "distance", "temperature", *"xyzu"],
    )


def check_axes(path: Path, drawn: Drawn, angles: Angles) -> None:
    if drawn.arm.n != angles.count:
        first, last = angles.columns[0].name, angles.columns[-1].name
        raise UlnaInputError(
            f"{path}: it has {angles.count} columns of angles ('{first}' to '{last}'), but the arm ({drawn.said}) has "
            f"{drawn.arm.n} joints; expected as many. Name the right arm, or say with --column q1=NAME … which columns "
            "they are."
        )


def check_scale(what: Stated | list[Question], answers: Answers) -> None:
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


def counts_known(drawn: Drawn | None) -> bool:
    return drawn is not None and all(joint.counts_per_turn is not None for joint in drawn.arm.joints)


def ball_question(what: Stated, drawn: Drawn, answers: Answers, path: Path) -> list[Question]:
    """Of the probe, where the kind cannot do without."""
    if answers.ball is not None:
        return []
    try:
        kind_of(what.artefact).check_probes(what.artefact, drawn.arm, range(len(drawn.arm.probes)), str(path))
    except UlnaInputError:
        return [Question("ball", "--ball MM", worded("what is the diameter of the probe's ball, in mm"))]
    return []


def conditions_on_cells(header: Header, angles: Angles, answers: Answers) -> dict[str, Any] | Question:
    """Conditions that leave out rows without a number, where that was said; else the question."""
    bad = [(row, column) for column in angles.columns for row in column.bad]
    if not bad:
        return {}
    if not answers.skip_bad:
        told = ", ".join(f"{header.at(row, column.name)}: '{column.texts[row - 1][:20]}'" for row, column in bad[:6])
        more = ", …" if len(bad) > 6 else ""
        rows = len({row for row, _ in bad})
        cells = f"{told}{more}"
        asks = (
            worded("shall {count} rows be left out in which an axis has no number ({cells})", count=rows, cells=cells)
            if rows > 1
            else worded("shall 1 row be left out in which an axis has no number ({cells})", cells=cells)
        )
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


def probe_names(columns: Sequence[Column], labels: Labels, drawn: Drawn, path: Path, said: dict[str, Any]) -> list[str]:
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
