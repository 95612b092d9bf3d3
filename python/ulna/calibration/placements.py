"""The figures of each placement: a table, whose rows are looked at one by one."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, overload

import polars as pl
from pydantic import Field, create_model

from ulna.artefacts.quantities import MEANINGS, NAMES
from ulna.formats.models import Open
from ulna.ground.arrays import F64

Figures = dict[str, float]
"""Name (of `NAMES`) → mm."""


_MEANING = (
    "What a metrologist reads, from the readings alone, in mm. A figure that the readings do not give is left out."
)

if TYPE_CHECKING:

    class FigureEntry(Open):
        """A key for each of `NAMES`."""
else:
    _FIELDS = {name: (float | None, Field(None, description=meaning)) for name, meaning in MEANINGS.items()}
    FigureEntry = create_model("FigureEntry", __base__=Open, __doc__=_MEANING, **_FIELDS)


class _OnePlacement(Open):
    artefact: str
    placement: str
    kind: str
    readings: int
    """Number of rows."""


class PlacementEntry(FigureEntry, _OnePlacement):
    """The figures of one artefact in one placement."""


@dataclass(frozen=True)
class PlacementFigures:
    """The figures of one artefact in one placement."""

    artefact: str
    placement: str
    kind: str
    readings: int
    """Number of rows."""
    figures: Figures
    """Only those of `NAMES` that these readings give, mm."""

    @classmethod
    def of_entry(cls, entry: PlacementEntry) -> PlacementFigures:
        """As a file has it."""
        return cls(entry.artefact, entry.placement, entry.kind, entry.readings, figures_of(entry))

    def entry(self) -> PlacementEntry:
        """As files have it."""
        return PlacementEntry.model_construct(
            None,
            artefact=self.artefact,
            placement=self.placement,
            kind=self.kind,
            readings=self.readings,
            **self.figures,
        )


SCHEMA: dict[str, Any] = {
    "artefact": pl.String,
    "placement": pl.String,
    "kind": pl.String,
    "readings": pl.Int64,
    **dict.fromkeys(NAMES, pl.Float64),
}


class Placements(Sequence[PlacementFigures]):
    """Very many of them, without an object for each until it is asked for. Immutable."""

    def __init__(self, table: pl.DataFrame) -> None:
        """table: columns as in `SCHEMA`; null where a placement does not give a figure."""
        self.table = table

    @classmethod
    def of(cls, entries: Iterable[PlacementFigures]) -> Placements:
        """From one entry for each placement."""
        if isinstance(entries, Placements):
            return entries
        return cls(pl.DataFrame([_row(entry) for entry in entries], schema=SCHEMA))

    @classmethod
    def of_columns(
        cls, artefact: str, kind: str, placements: Sequence[str], readings: Any, columns: Mapping[str, F64]
    ) -> Placements:
        """Those of one artefact. readings: (P,) numbers of rows; columns: figure → (P,), NaN where there is none."""
        rows = len(placements)
        given: dict[str, Any] = {
            "artefact": pl.Series([artefact]).new_from_index(0, rows),
            "placement": pl.Series(placements, dtype=pl.String),
            "kind": pl.Series([kind]).new_from_index(0, rows),
            "readings": readings,
        }
        given |= {name: pl.Series(column, nan_to_null=True) for name, column in columns.items()}
        lacking = pl.Series([None], dtype=pl.Float64).new_from_index(0, rows)
        return cls(pl.DataFrame({name: given.get(name, lacking) for name in SCHEMA}, schema=SCHEMA))

    @classmethod
    def joined(cls, parts: Sequence[Placements]) -> Placements:
        """One after the other."""
        return cls(pl.concat([part.table for part in parts]) if parts else pl.DataFrame(schema=SCHEMA))

    def __len__(self) -> int:
        return self.table.height

    def __iter__(self) -> Iterator[PlacementFigures]:
        for row in self.table.iter_rows(named=True):
            yield _of_row(row)

    @overload
    def __getitem__(self, index: int) -> PlacementFigures: ...
    @overload
    def __getitem__(self, index: slice) -> Placements: ...
    def __getitem__(self, index: int | slice) -> PlacementFigures | Placements:
        if isinstance(index, slice):
            return Placements(self.table[index])
        if not -len(self) <= index < len(self):
            raise IndexError(f"there are {len(self)} placements; got {index}")
        return _of_row(self.table.row(index, named=True))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and list(self) == list(other)

    __hash__ = None  # type: ignore[assignment]  # as lists have none

    def __repr__(self) -> str:
        return f"Placements({list(self[:3])!r}{', …' * (len(self) > 3)})"


def figures_of(entry: FigureEntry) -> Figures:
    """The figures that an entry of a file has."""
    found = {name: getattr(entry, name) for name in NAMES}
    return {name: value for name, value in found.items() if value is not None}


def _row(entry: PlacementFigures) -> dict[str, Any]:
    row = {"artefact": entry.artefact, "placement": entry.placement, "kind": entry.kind, "readings": entry.readings}
    return row | dict.fromkeys(NAMES) | entry.figures


def _of_row(row: Mapping[str, Any]) -> PlacementFigures:
    found = {name: row[name] for name in NAMES if row[name] is not None}
    return PlacementFigures(row["artefact"], row["placement"], row["kind"], row["readings"], found)


def without_repeats(entries: Sequence[PlacementFigures], columns: Sequence[str]) -> list[str]:
    """Where every placement has one length, its signed error says all: the columns without the sizes of it."""
    mean, largest = "length_error_mean_abs_mm", "length_error_max_abs_mm"
    if all(entry.figures.get(mean) == entry.figures.get(largest) for entry in entries):
        return [name for name in columns if name not in (mean, largest)]
    return list(columns)
