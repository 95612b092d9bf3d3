"""What is touched, as far as a person states it: the keys that its kind wants, each from a flag of the same name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ulna.artefacts.artefact import Artefact
from ulna.artefacts.features import WHAT
from ulna.artefacts.kinds import KINDS, made
from ulna.artefacts.tables import Place
from ulna.formats.layout import Layout, TableKeys
from ulna.formats.table import read_header
from ulna.formats.units import MM_PER, Units
from ulna.ground.errors import UlnaInputError, nearest
from ulna.ground.worded import worded
from ulna.proposals.answers import Answers, Question
from ulna.proposals.columns import Column, columns_of
from ulna.proposals.dialect import seen_dialect
from ulna.proposals.words import LENGTH_UNITS

#: key of an artefact's table → the flag, and what is asked; of a kind whose table has the key and cannot do without
FLAGS: dict[str, tuple[str, Callable[[str], str]]] = {
    "length": (
        "--length MM",
        lambda kind: worded("how long is the {kind}, in mm, as its certificate says", kind=kind),
    ),
    "diameter": ("--diameter MM", lambda kind: worded("what is the diameter of the {kind}, in mm", kind=kind)),
    "features": (
        "--features FILE",
        lambda _: worded("which table has the coordinates of the points: columns feature, x, y, z"),
    ),
}


@dataclass(frozen=True)
class Stated:
    """The artefact of a study to be written."""

    artefact: Artefact
    keys: dict[str, Any]
    """Of its table, the kind first; lengths in `length_unit`."""
    length_unit: str
    """Of the study."""
    remarks: tuple[str, ...] = ()
    files: tuple[Path, ...] = ()
    bound: bool = False
    """Whether a file says that unit; else the lengths may be written in any."""

    @property
    def source(self) -> Path | None:
        """The file of its features."""
        return self.files[0] if self.files else None


def kind_question() -> Question:
    """Which artefact was touched."""
    *most, last = touched = tuple(name for name, kind in KINDS.items() if not kind.turned)
    return Question("artefact", f"--artefact {', '.join(most)} or {last}", worded("what was touched"), touched)


def stated(answers: Answers, columns: Sequence[Column], label: Path) -> Stated | list[Question]:
    """The artefact. columns: of the readings; label: what messages call the study. Raises UlnaInputError."""
    if answers.artefact is None:
        return [kind_question()]
    if answers.artefact not in KINDS:
        raise UlnaInputError(
            f"--artefact: got '{answers.artefact}', expected a kind of artefact.{nearest(answers.artefact, KINDS)}"
        )
    kind = KINDS[answers.artefact]
    if kind.turned:
        raise UlnaInputError(
            f"--artefact: got '{kind.name}'; expected something that is touched: orientations are read beside places "
            "of the same target. Make the study of the places, and add a second [[readings]] table and "
            f'[artefact.target] with kind = "{kind.name}" to it.'
        )
    fields = kind.table.model_fields
    own_points = {"x", "y", "z"} <= {column.name.casefold() for column in columns}
    wanted = [name for name in FLAGS if name in fields and (fields[name].is_required() or name == "features")]
    if own_points:
        wanted = [name for name in wanted if name != "features"]
    missing = [name for name in wanted if getattr(answers, name) is None]
    given = [name for name in (*FLAGS, "u") if getattr(answers, name) is not None]
    for name in given:
        if name not in fields:
            raise UlnaInputError(
                f"--{name}: an artefact of kind '{kind.name}' has none; expected {_listed(fields)}. Leave it out."
            )
    if missing:
        return [Question(name, FLAGS[name][0], FLAGS[name][1](kind.name)) for name in missing]
    measured = kind.measured_column is not None and answers.length is None
    found = _features(answers, label) if answers.features is not None else None
    unit = found[1] if found else _own_unit(answers, columns, measured or own_points)
    if isinstance(unit, Question):
        return [unit]
    per_mm = 1.0 / MM_PER[unit]
    keys: dict[str, Any] = {"kind": kind.name}
    keys |= {
        name: value if per_mm == 1.0 else value * per_mm
        for name in ("length", "diameter", "u")
        if (value := getattr(answers, name)) is not None
    }
    if found:
        keys |= {"features": str(answers.features), **found[0]}
    remarks: list[str] = []
    units = Units(length=unit, angle="rad")  # type: ignore[arg-type]
    place = Place(label, units, remarks)
    artefact = made(answers.called or kind.name, kind.table.model_validate(keys | _absolute(answers)), place)
    files = () if answers.features is None else (answers.features,)
    return Stated(artefact, keys, unit, tuple(remarks), files, bool(found) or measured or own_points)


def _absolute(answers: Answers) -> dict[str, str]:
    return {} if answers.features is None else {"features": str(answers.features.absolute())}


def _listed(fields: Any) -> str:
    return " or ".join(f"--{name}" for name in (*FLAGS, "u") if name in fields) or "no number"


def _own_unit(answers: Answers, columns: Sequence[Column], measured: bool) -> str | Question:
    """Of lengths in the readings, where they hold any: what the file says, or what was said."""
    if not measured:
        return "mm"
    said = {LENGTH_UNITS.get(c.meaning.unit, "") for c in columns if c.numeric and c.meaning.role != "angle"} - {""}
    if len(said) == 1:
        return said.pop()
    return answers.length_unit or _unit_question(worded("the lengths in the readings"))


def _unit_question(whose: str) -> Question:
    return Question(
        "length_unit", "--length-unit mm, m or in", worded("in which unit are {whose}", whose=whose), ("mm", "m", "in")
    )


def _features(answers: Answers, label: Path) -> tuple[dict[str, Any], str | Question]:
    """What a study says of how the table of features is written, and its unit of length. Raises UlnaInputError."""
    path = answers.features
    assert path is not None
    layout, seen = seen_dialect(path, Layout.of_options(), WHAT)
    columns = columns_of(read_header(path, WHAT, layout))
    taken: dict[str, Column] = {}
    for column in columns:
        bare = column.name.casefold().partition("[")[0].partition("(")[0].strip()
        bare = bare.removesuffix("_mm").removesuffix("_m")
        if bare in ("x", "y", "z", "u") and column.numeric:
            taken.setdefault(bare, column)
        elif column.name == "feature" or (
            column.meaning.role in ("feature", "measurement") and column.texts.n_unique() == len(column.texts)
        ):
            taken.setdefault("feature", column)
    said = {LENGTH_UNITS.get(column.meaning.unit, "") for key, column in taken.items() if key in "xyz"} - {""}
    said |= {ending for c in columns for ending in ("mm", "m") if c.name.casefold().endswith(f"_{ending}")}
    if len(said) > 1:
        raise UlnaInputError(
            f"{path}: its columns have several units of length ({', '.join(sorted(said))}); expected one."
        )
    if said and answers.length_unit not in (None, *said) and answers.dh is None:
        raise UlnaInputError(
            f"{path}: its columns are in {next(iter(said))}, but --length-unit says {answers.length_unit}; expected "
            "the same. Leave --length-unit out."
        )
    renamed = {ours: column.name for ours, column in taken.items() if column.name != ours}
    keys = seen | ({"columns": renamed} if renamed else {})
    unit: str | Question = (
        said.pop()
        if said
        else answers.length_unit or _unit_question(worded("the coordinates in {file}", file=path.name))
    )
    if keys:
        TableKeys.model_validate(keys)
    return ({"features_format": keys} if keys else {}), unit
