"""The columns of a table in memory, recognised as `ulna new` recognises those of a file: `Study.from_frame`, guess."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import Artefact
from ulna.formats.layout import Layout
from ulna.formats.tables.frame import FrameTable
from ulna.ground.errors import UlnaInputError
from ulna.proposals.angles import angles_of, unit_of
from ulna.proposals.answers import Answers, Question
from ulna.proposals.columns import Column, columns_of, named
from ulna.proposals.labels import Labels, matched_labels
from ulna.proposals.propose import entry_of, labels_of
from ulna.proposals.stated import Stated
from ulna.study.data import Taken

#: what is asked, by the field that a command would fill → the argument that says it
ARGUMENTS = {
    "angle": "angle = 'rad', 'deg' or 'counts'",
    "columns": "columns = {OURS: NAME}",
    "names": "names = {'feature': {OURS: LABEL}}",
    "standing": "columns = {'placement': NAME}, or placement = '1'",
}


def recognised(
    table: FrameTable, arm: Arm, artefacts: Sequence[Artefact], said: dict[str, Any], angle: str | None
) -> tuple[dict[str, Any], list[Taken]]:
    """Keys of a [[readings]] table, and what each column was taken for, in their order. said: the keys that were given.

    Raises UlnaInputError for what leaves a doubt, naming the argument that would say it.
    """
    if len(artefacts) != 1:
        raise UlnaInputError(
            f"{table.path}: columns are recognised where one artefact was touched; got {len(artefacts)}. Say what they "
            "are: columns = {OURS: NAME}."
        )
    columns = columns_of(table)
    if not columns or not len(columns[0].texts):
        raise UlnaInputError(f"{table.path}: there are no rows; expected at least one reading. Add them.")
    mapped = dict(said.get("columns", {}))
    answers = Answers(angle=angle, one_standing="placement" in said)
    angles = angles_of(table.path, columns, mapped, None)
    if isinstance(angles, Question):
        raise _asked(table, [angles])
    if angles.count != arm.n:
        raise UlnaInputError(
            f"{table.path}: {angles.count} columns of angles are recognised ('{angles.columns[0].name}' to "
            f"'{angles.columns[-1].name}'), but arm '{arm.name}' has {arm.n} joints; expected one for each. Say which "
            "they are: columns = {'q1': NAME, …}."
        )
    unit = unit_of(table.path, angles, answers)
    layout = Layout(columns=mapped, names=dict(said.get("names", {})))
    labels = labels_of(table.path, answers, columns, angles, Stated(artefacts[0], {}, "mm"), layout)
    _match_probes(columns, labels, arm, layout)
    questions = [*([unit] if isinstance(unit, Question) else []), *labels.questions]
    if questions or isinstance(unit, Question):
        raise _asked(table, questions)
    taken = {each.column: each for each in [*labels.taken, *angles.taken]}
    keys = entry_of(Answers(), {}, unit[0], list(taken.values()), labels, dict(layout.names), {})
    given = {key: value for key, value in said.items() if key not in ("columns", "names", "ignore")}
    found = keys | given | ({"columns": mapped | keys.get("columns", {})} if mapped or "columns" in keys else {})
    ignored = [*said.get("ignore", ()), *keys.get("ignore", ())]
    return found | ({"ignore": ignored} if ignored else {}), [taken[column.name] for column in columns]


def _match_probes(columns: Sequence[Column], labels: Labels, arm: Arm, layout: Layout) -> None:
    """What the cells call the arm's probes; a single label is its only one."""
    column = next((named(columns, each.column) for each in labels.taken if each.ours == "probe"), None)
    if column is None or "probe" in layout.names:
        return
    have = list(arm.probes)
    if len(have) == len(column.labels) == 1:
        matched: dict[str, list[str]] | None = {have[0]: column.labels}
    else:
        matched = matched_labels(column.labels, have, alike=False)
    if matched is not None and any(ours != label for ours, theirs in matched.items() for label in theirs):
        labels.names["probe"] = matched


def _asked(table: FrameTable, questions: Sequence[Question]) -> UlnaInputError:
    """The error that asks."""
    told = "; ".join(f"{each.asks} ({ARGUMENTS.get(each.field, each.field)})" for each in questions)
    return UlnaInputError(
        f"{table.path}: what the frame does not say is asked for: {told}. Say it with these arguments."
    )
