"""Readings of one artefact from several files, as one."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.labels import Labels
from ulna.artefacts.readings import InputFile, Readings
from ulna.ground.errors import UlnaInputError
from ulna.study.readings.own_points import has_own_points, joined_points


def merge(parts: list[Readings], artefacts: dict[str, Artefact], files: list[InputFile], study: Path) -> list[Readings]:
    """The parts of each artefact as one, in the order in which the study declares artefacts. Raises UlnaInputError."""
    merged: list[Readings] = []
    for artefact in artefacts.values():
        own = [part for part in parts if part.artefact.name == artefact.name]
        if not own:
            continue
        _name_placements(own, artefact, study)
        if len(own) > 1 and has_own_points(artefact):
            own = _with_one_artefact(own, files)
        merged.append(own[0] if len(own) == 1 else _joined(own[0].artefact, own))
    return merged


def _name_placements(own: list[Readings], artefact: Artefact, study: Path) -> None:
    unnamed = [part for part in own if part.placement[0] == ""]
    matters = kind_of(artefact).placed(artefact)
    if unnamed and len(own) > 1 and matters:
        raise UlnaInputError(
            f"{study}: artefact '{artefact.name}' is in {len(own)} readings files, and not all of them say which "
            "standing of it was touched; expected a column 'placement' in each, or the key 'placement' in each "
            "[[readings]] table: the same label where the artefact was not moved in between. Add it."
        )
    for part in unnamed:
        part.placement = Labels.all_alike("1", len(part))


def _with_one_artefact(own: list[Readings], files: list[InputFile]) -> list[Readings]:
    """Each part brought points of its own: all of them are the features of one artefact."""
    artefact, features = joined_points(own, [file.path for file in files])
    return [replace(part, artefact=artefact, feature=feature) for part, feature in zip(own, features, strict=True)]


def _joined(artefact: Artefact, own: list[Readings]) -> Readings:
    def of(name: str) -> Any:
        arrays = [getattr(part, name) for part in own]
        return None if any(array is None for array in arrays) else np.concatenate(arrays)

    return Readings(
        artefact=artefact,
        q_rad=of("q_rad"),
        p_rad=of("p_rad"),
        length_mm=of("length_mm"),
        probe=of("probe"),
        feature=of("feature"),
        placement=Labels.joined([part.labels for part in own]),
        row=of("row"),
        file=of("file"),
        id=of("id"),
        temperature_c=_said(own, "temperature_c"),
        approach=_said(own, "approach"),
        p_approach=_said(own, "p_approach"),
        rotation_rad=of("rotation_rad"),
        rotation_u_rad=of("rotation_u_rad"),
        payload=_said(own, "payload"),
    )


def _said(own: list[Readings], field: str) -> Any:
    """NaN where a file gives none; one column per joint where any file has that."""
    arrays: list[Any] = [getattr(part, field) for part in own]
    given = [array for array in arrays if array is not None]
    if not given:
        return None
    widths = [array.shape[1] for array in given if array.ndim == 2]
    joined = []
    for part, said in zip(own, arrays, strict=True):
        array = np.full(len(part), np.nan) if said is None else said
        if widths and array.ndim == 1:
            array = np.repeat(array[:, np.newaxis], widths[0], axis=1)
        joined.append(array)
    return np.concatenate(joined)
