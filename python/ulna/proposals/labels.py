"""Columns with labels: where the artefact stood, what of it was touched, with which probe, and what is not used."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import listed, one_by_one, recalled, templates, worded
from ulna.proposals.answers import Question
from ulna.proposals.columns import Column, Taken, named

MEASURED = templates("length", "distance")
"""What a column may hold that was measured."""

_SHOWN = 6
SAID, OWN = worded("said with --column"), worded("Ulna's own name")


@dataclass
class Labels:
    """What was found; questions of what was not."""

    taken: list[Taken] = field(default_factory=list)
    fill_down: list[str] = field(default_factory=list)
    """Ulna's names."""
    names: dict[str, dict[str, list[str]]] = field(default_factory=dict)
    questions: list[Question] = field(default_factory=list)

    def take(self, column: Column, ours: str, why: str, filled: bool = False) -> None:
        """A column for something; filled: empty cells mean what the cell above says."""
        empty = len(column.texts) - column.filled
        if filled and empty and column.texts[0] != "":
            self.fill_down.append(ours)
            why = worded("{why}; {count} empty cells mean the cell above", why=why, count=empty)
        self.taken.append(Taken(column.name, ours, why))

    def has(self, ours: str) -> bool:
        """Whether some column is taken for it."""
        return any(taken.ours == ours for taken in self.taken)


def _of_role(columns: Sequence[Column], role: str, ours: str, mapped: Mapping[str, str]) -> tuple[Column, str] | None:
    """The column that is meant, and why: said, of Ulna's own name, or by a word."""
    if ours in mapped and (said := named(columns, mapped[ours])) is not None:
        return said, SAID
    own = named(columns, ours)
    if own is not None:
        return own, OWN
    by_word = [column for column in columns if column.meaning.role == role]
    exact = sorted(by_word, key=lambda column: (column.filled == 0, len(column.name)))
    return (exact[0], f"'{exact[0].meaning.word}'") if exact else None


def feature_labels(
    columns: Sequence[Column], features: Sequence[str], alike: bool, mapped: Mapping[str, str], found: Labels
) -> Column | None:
    """The column that says what was touched. alike: whether it does not matter which feature is called which."""
    meant = _of_role(columns, "feature", "feature", mapped)
    if meant is None or (meant[0].filled == 0 and len(columns) > 1):
        pairs = [c for c in columns if not c.numeric and len(c.labels) == len(features) and c.meaning.role is None]
        meant = (pairs[0], worded("its cells hold {count} labels", count=len(features))) if len(pairs) == 1 else None
    if meant is None:
        found.questions.append(
            Question(
                "columns",
                "--column feature=NAME",
                worded("which column says what was touched ({features})", features=_listed(features)),
            )
        )
        return None
    column, why = meant
    matched = matched_labels(column.labels, features, alike)
    if matched is None:
        found.questions.append(
            Question(
                "names",
                f"--name 'feature.{features[0]}=LABEL' for each",
                worded(
                    "which of the labels {labels} in '{column}' is which of {features}",
                    labels=_listed(column.labels),
                    column=column.name,
                    features=_listed(features),
                ),
            )
        )
        return column
    if any(ours != label for ours, labels in matched.items() for label in labels):
        found.names["feature"] = matched
        shown = list(matched.items())[:_SHOWN]
        means = [
            worded("{labels} is {ours}", labels=" and ".join(map(repr, theirs)), ours=ours) for ours, theirs in shown
        ]
        why = one_by_one([why, listed(means)])
    found.take(column, "feature", why, filled=True)
    return column


def matched_labels(labels: Sequence[str], features: Sequence[str], alike: bool) -> dict[str, list[str]] | None:
    """Feature → its labels in the file; None where that is not certain. alike: which is which does not matter."""
    groups: dict[str, list[str]] = {}
    for label in labels:
        groups.setdefault(" ".join(label.casefold().split()), []).append(label)
    for spelled in (str.casefold, _number_in):
        theirs = {key: spelled(key) for key in groups}
        ours = {spelled(feature): feature for feature in features}
        if (
            len(ours) == len(features)
            and len(set(theirs.values())) == len(theirs)
            and set(theirs.values()) <= set(ours)
        ):
            return {ours[theirs[key]]: group for key, group in groups.items()}
    if alike and len(groups) == len(features):
        return dict(zip(features, groups.values(), strict=True))
    return None


def _number_in(text: str) -> str:
    numbers = re.findall(r"\d+", text)
    return str(int(numbers[0])) if len(numbers) == 1 else text


def standing_labels(
    columns: Sequence[Column], touched: Column | None, needed: bool, one: bool, mapped: Mapping[str, str], found: Labels
) -> None:
    """The column that says where the artefact stood: cells of one standing are alike. touched: the column of features;
    needed: whether the artefact stands somewhere unknown; one: whether it was said that it never moved."""
    own = named(columns, "placement")
    if own is not None and not needed and not one:
        found.take(own, "placement", OWN, filled=True)
    if not needed or (one and "placement" not in mapped):
        return
    meant = _of_role(columns, "standing", "placement", mapped)
    if meant is not None and (meant[1] in (SAID, OWN) or _groups(meant[0], touched)):
        found.take(
            meant[0],
            "placement",
            worded("{why}: {count} standings", why=meant[1], count=len(meant[0].labels)),
            filled=True,
        )
        return
    for column in columns:
        if column.meaning.role == "measurement" and _groups(column, touched):
            word, count = f"'{column.meaning.word}'", len(column.labels)
            why = worded("{why}: {count} groups of rows", why=word, count=count)
            found.take(column, "placement", why, filled=True)
            return
    found.questions.append(
        Question(
            "standing",
            "--column placement=NAME, or --one-standing",
            worded("which column says where the artefact stood (or one: it stood still)"),
        )
    )


def _groups(column: Column, touched: Column | None) -> bool:
    """Whether a column says which rows belong together: fewer labels than rows; where features are touched, most groups
    have more than one of them."""
    down = column.down()
    groups = down.n_unique()
    if not column.filled or groups == len(down) or (down == "").any():
        return False
    if touched is None or groups == 1:
        return True
    several: dict[str, set[str]] = {}
    for group, label in zip(down.to_list(), touched.down().to_list(), strict=True):
        several.setdefault(group, set()).add(label.casefold())
    return 2 * sum(len(labels) > 1 for labels in several.values()) > groups


def other_labels(
    path: Path, columns: Sequence[Column], measured: str | None, mapped: Mapping[str, str], found: Labels
) -> None:
    """Probes, temperature, a measured distance, ids; the rest is not used, and said. Raises UlnaInputError for a column
    that names several artefacts."""
    used = {taken.column for taken in found.taken}
    for role, ours, wanted in (("probe", "probe", True), ("measured", measured or "", measured is not None)):
        meant = _of_role([c for c in columns if c.name not in used], role, ours, mapped) if wanted else None
        if meant is not None and meant[0].filled:
            found.take(meant[0], ours, meant[1], filled=role == "probe")
            used.add(meant[0].name)
    if measured is not None and not found.has(measured):
        found.questions.append(
            Question(
                "columns",
                f"--column {measured}=NAME",
                worded("which column holds the {what} that was measured", what=recalled(measured, MEASURED)),
            )
        )
    for column in columns:
        if column.name in used:
            continue
        heading = column.meaning
        if heading.role == "artefact" and not column.numeric and len(column.labels) > 1:
            raise UlnaInputError(
                f"{path}: column '{column.name}' names several artefacts ({_listed(column.labels)}); expected to be "
                f"told what each is. Say it: --artefact '{column.labels[0]}=KIND:VALUE', and so on."
            )
        if heading.role == "temperature" and column.numeric and not column.bad and not found.has("temperature"):
            found.take(column, "temperature", f"'{heading.word}'")
        elif heading.role == "measurement" and column.texts.n_unique() == len(column.texts) and not found.has("id"):
            found.take(column, "id", worded("{why}: another in each row", why=f"'{heading.word}'"))
        else:
            found.taken.append(Taken(column.name, "", _unused(column)))


def _unused(column: Column) -> str:
    if column.meaning.goal:
        return worded("what was wanted, not what was read")
    if column.meaning.role == "aside":
        return worded("{why}, {count} cells", why=f"'{column.meaning.word}'", count=column.filled)
    if column.meaning.role == "temperature":
        why, count = f"'{column.meaning.word}'", len(column.bad)
        return worded("{why}, but {count} cells hold no number", why=why, count=count)
    if not column.filled:
        return worded("all its cells are empty")
    return worded("nothing that a study needs: {labels}", labels=_listed(column.labels))


def _listed(labels: Sequence[str]) -> str:
    return ", ".join(f"'{label[:30]}'" for label in labels[:_SHOWN]) + (", …" if len(labels) > _SHOWN else "")
