"""The kinds of artefacts: one row each. Whoever asks about an artefact asks `kind_of` it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from ulna.artefacts.artefact import Artefact
from ulna.artefacts.bar import Bar
from ulna.artefacts.cylinder import Cylinder
from ulna.artefacts.distance import Distance
from ulna.artefacts.kind import Kind
from ulna.artefacts.length import Length
from ulna.artefacts.orientation import Orientation
from ulna.artefacts.plane import Plane
from ulna.artefacts.points import Points
from ulna.artefacts.seat import Seat
from ulna.artefacts.sphere import Sphere
from ulna.artefacts.tables import Place, StatedTable, TouchedTable
from ulna.formats.models import OneOf, check_kind
from ulna.formats.names import check_name
from ulna.ground.errors import UlnaInputError, nearest

KINDS: dict[str, Kind] = {
    kind.name: kind
    for kind in (
        Bar(),
        Seat(),
        Points(),
        Length(),
        Sphere(),
        Plane(),
        Cylinder(),
        Distance(),
        Orientation(),
    )
}
"""By name, in the order in which messages list them."""


def kind_of(artefact: Artefact) -> Kind:
    """What an artefact's kind knows. Raises UlnaInputError for a kind that there is not."""
    if artefact.kind not in KINDS:
        raise UlnaInputError(
            f"artefact '{artefact.name}': there is no kind {artefact.kind!r}; expected {', '.join(KINDS)}."
            f"{nearest(str(artefact.kind), KINDS)}"
        )
    return KINDS[artefact.kind]


ArtefactTable = Annotated[StatedTable, OneOf({name: kind.table for name, kind in KINDS.items()})]
"""The table of an artefact in a study or plan."""
SimulatedTable = Annotated[TouchedTable, OneOf({name: kind.simulated for name, kind in KINDS.items()})]
"""The table of an artefact in a simulation file."""


def check_kinds(document: dict[str, Any], path: Path) -> None:
    """The kinds of all artefacts, before the rest of the tables is looked at. Raises UlnaInputError."""
    tables = document.get("artefact")
    for name, table in tables.items() if isinstance(tables, dict) else ():
        if isinstance(table, dict) and "record" in table and "kind" not in table:
            continue  # the record knows
        check_kind(table, f"artefact.{name}", list(KINDS), path)


def made(name: str, table: StatedTable, place: Place) -> Artefact:
    """The artefact that a table states, mm; files that it names are added to `place`. Raises UlnaInputError."""
    check_name(name, f"artefact.{name}", place.path)
    return table.made(name, place)
