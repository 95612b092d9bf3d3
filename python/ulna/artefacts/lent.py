"""An artefact that a study names as a record has it: its size and u come from the certificate that is valid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag

from ulna.artefacts.kinds import KINDS, ArtefactTable
from ulna.artefacts.tables import Place, StatedTable
from ulna.formats.models import Strict, fill
from ulna.ground.errors import UlnaInputError
from ulna.ground.provided import provided


class LentTable(Strict):
    """`artefact.bar = { record = "KB-443" }`."""

    record: str
    """Its name, or its serial number, in the record of ULNA_RECORDS or of the settings file."""
    kind: Literal["bar", "sphere", "cylinder"] | None = None
    """None: a certified length is that of a bar, a diameter that of a sphere."""
    fit: bool = False
    """As of an artefact that is written out."""
    expired_because: Annotated[str, Field(min_length=3)] | None = None
    """Why it is used although its certificate has expired; it is kept with the result."""


@dataclass(frozen=True)
class Lent:
    """What a record says."""

    name: str
    """As registered."""
    quantity: str
    value_mm: float
    u_mm: float
    said: str
    """Which certificate, in words."""


def _which(table: Any) -> str:
    return "<lent>" if isinstance(table, LentTable) or (isinstance(table, dict) and "record" in table) else "<stated>"


StatedOrLent = Annotated[
    Annotated[ArtefactTable, Tag("<stated>")] | Annotated[LentTable, Tag("<lent>")], Discriminator(_which)
]
"""The table of an artefact in a study."""


def stated(name: str, table: StatedTable | LentTable, place: Place) -> StatedTable:
    """A table as it stands, or that of what the record lends; which certificate that is, is a remark. Raises
    UlnaInputError where there is no record, no such artefact, or no valid certificate."""
    if isinstance(table, StatedTable):
        return table
    kinds = [kind.name for kind in KINDS.values() if kind.lent] if table.kind is None else [table.kind]
    quantities = {kind: str(KINDS[kind].lent) for kind in kinds}
    try:
        lent: Lent = provided("artefact of a record")(
            table.record, list(dict.fromkeys(quantities.values())), table.expired_because
        )
    except UlnaInputError as error:
        raise UlnaInputError(f"{place.path}: key 'artefact.{name}.record': {error}") from None
    kind = next(each for each, quantity in quantities.items() if quantity == lent.quantity)
    size = {lent.quantity: lent.value_mm / place.units.mm, "u": lent.u_mm / place.units.mm}
    place.remarks.append(f"artefact '{name}' is '{lent.name}' of the record: {lent.said}")
    made = fill(KINDS[kind].table, {"kind": kind, "fit": table.fit, **size}, place.path)
    assert isinstance(made, StatedTable)
    return made
