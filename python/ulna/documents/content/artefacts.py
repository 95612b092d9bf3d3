"""What was touched, and what is calibrated of it."""

from __future__ import annotations

from dataclasses import dataclass

from ulna.artefacts.readings import Readings
from ulna.calibration.result import Result
from ulna.study.study import Study


@dataclass(frozen=True)
class ArtefactRow:
    """An artefact that was touched."""

    name: str
    kind: str
    placements: int
    readings: int
    dimension: str | None
    """"length", "diameter", "features" or None where nothing of it is calibrated or the study is not known."""
    value_mm: float | None
    """Length or diameter."""
    features: int
    """Number of calibrated points."""
    u_mm: float | None
    """Standard uncertainty of length, diameter or (the largest) of a coordinate; 0 where none is stated; None where the
    study is not known."""
    frame: str


def artefact_rows(result: Result, study: Study | None) -> list[ArtefactRow]:
    """In the order of the result; study: where it is known."""
    known = {} if study is None else {group.artefact.name: group for group in study.readings}
    rows = []
    for name in dict.fromkeys(entry.artefact for entry in result.artefacts):
        own = [entry for entry in result.artefacts if entry.artefact == name]
        group = known.get(name)
        artefact = None if group is None else group.artefact
        dimension, value = _dimension(group)
        u = None
        if artefact is not None:
            u = max(artefact.feature_u_mm) if artefact.feature_u_mm else artefact.u_mm
        rows.append(
            ArtefactRow(
                name=name,
                kind=own[0].kind,
                placements=len(own),
                readings=sum(entry.readings for entry in own),
                dimension=dimension,
                value_mm=value,
                features=0 if artefact is None else len(artefact.features),
                u_mm=u,
                frame="free" if artefact is None else artefact.frame,
            )
        )
    return rows


def _dimension(group: Readings | None) -> tuple[str | None, float | None]:
    """What is calibrated, by what there is of it, whatever kind it is: one seat alone has no dimension."""
    if group is None:
        return None, None
    artefact = group.artefact
    if artefact.length_mm is not None:
        return "length", artefact.length_mm
    if artefact.diameter_mm is not None:
        return "diameter", artefact.diameter_mm
    if group.length_mm is not None:
        return "lengths", None
    return ("features", None) if artefact.frame == "arm" or len(artefact.features) > 1 else (None, None)
