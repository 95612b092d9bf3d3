"""Readings that are written like those of a study: what its [[readings]] say need not be typed again."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ulna.formats.layout import Layout, TableKeys
from ulna.ground.errors import UlnaInputError
from ulna.study.file import study_file
from ulna.study.readings.columns import ReadingsEntry
from ulna.study.readings.conditions import is_condition


@dataclass(frozen=True)
class Like:
    """What a study says of how its readings are written, as far as measuring asks for it."""

    angle: str
    """rad, deg or counts."""
    probe: str | None
    """Which was on, where the study says so of the whole file."""
    payload: str | None
    """What was carried, where the study says so of the whole file."""
    keys: dict[str, Any]
    """Of `TableKeys`; columns and labels that only a calibration needs are left out."""
    study: Path
    number: int
    """Which of its [[readings]], from 1."""
    unused: list[str] = field(default_factory=list)
    """The file's own names of columns that only a calibration needs."""
    remarks: list[str] = field(default_factory=list)

    def layout(self, given: Mapping[str, Any]) -> Layout:
        """With what was said besides, which goes first: keys of `TableKeys`. Raises UlnaInputError."""
        keys = self.keys | {key: value for key, value in given.items() if value not in (None, (), {})}
        if keys != self.keys:
            return Layout.of_options(**keys)
        place = (f"{self.study}: key 'readings.{self.number}.", "'")
        return Layout.of(TableKeys.model_validate(self.keys), place, "[[readings]]")


def like_study(path: Path, number: int | None = None) -> Like:
    """What the readings of a study are written like. number: which of its [[readings]], from 1, where they differ.

    Raises UlnaInputError for a study that cannot be read, or where they differ and nobody says which is meant.
    """
    file = study_file(path)
    found = [_of(entry, file.units.angle, file.carried, path, k) for k, entry in enumerate(file.readings, start=1)]
    if number is not None:
        if not 1 <= number <= len(found):
            raise UlnaInputError(
                f"--like-readings: got {number}, but {path} has {len(found)} [[readings]]; expected 1 to {len(found)}."
            )
        return found[number - 1]
    alike = [dataclasses.replace(each, number=1, remarks=[]) for each in found]
    if any(each != alike[0] for each in alike):
        names = ", ".join(f"{k}: {entry.file}" for k, entry in enumerate(file.readings, start=1))
        raise UlnaInputError(
            f"{path}: its [[readings]] are written differently ({names}); expected to be told which of them these are "
            "like. Say --like-readings N."
        )
    return found[0]


def _is_measured_with(column: str) -> bool:
    return column in ("id", "probe") or is_condition(column) or re.fullmatch(r"[qp][0-9]+", column) is not None


def _of(entry: ReadingsEntry, angle: str, carried: str | None, path: Path, number: int) -> Like:
    usual = TableKeys()
    keys = {key: getattr(entry, key) for key in TableKeys.model_fields if getattr(entry, key) != getattr(usual, key)}
    columns, names = dict(entry.columns or {}), dict(entry.names or {})
    unused = [theirs for ours, theirs in columns.items() if not _is_measured_with(ours)]
    kept: dict[str, Any] = {
        "columns": {ours: theirs for ours, theirs in columns.items() if _is_measured_with(ours)},
        "names": {column: labels for column, labels in names.items() if _is_measured_with(column)},
        "fill_down": [column for column in entry.fill_down or () if _is_measured_with(column)],
    }
    keys = {key: value for key, value in (keys | kept).items() if value or key == "header"}
    remarks = []
    if entry.where is not None:
        remarks.append(f"{path}: key 'readings.{number}.where' is not used: every row is measured.")
    return Like(
        entry.angle or angle,
        entry.probe,
        entry.payload or carried,
        keys,
        path,
        number,
        [*unused, *(entry.ignore or ())],
        remarks,
    )
