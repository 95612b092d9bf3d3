"""Which rows of a readings file are used: the filter `where`, and the split into rows to fit and rows to check.

A row that is left out may be anything: it is not looked at any further. That is what filters are for where a machine
writes a row also when a measurement failed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import polars as pl

from ulna.formats.conditions import OneOrMore, Range
from ulna.formats.header import Header
from ulna.formats.models import Strict
from ulna.ground.arrays import I64
from ulna.ground.errors import UlnaInputError, nearest

Rows = Literal["fit", "check", "all"]

#: values of a column named in a message
_SHOWN = 8


class SplitTable(Strict):
    """Which rows are fitted and which are kept to check the fit; rows with any other value are not used."""

    column: str
    fit: OneOrMore
    """The value, or the values, of the column in the rows to fit."""
    check: OneOrMore
    """The same of the rows to check."""


@dataclass(frozen=True)
class Selection:
    """The rows of one file that are asked for."""

    where: Mapping[str, Any]
    """Column → condition: all must hold."""
    split: SplitTable | None
    rows: Rows
    key: str
    """How messages call the table of the keys: `study.toml: key 'readings.1`, without the closing quote."""

    def columns(self, header: Header) -> dict[str, str]:
        """The columns that are asked about: as the study calls them → as the table does. Raises UlnaInputError."""
        found = {}
        asked = dict.fromkeys(self.where, f"{self.key}.where'")
        if self.split is not None:
            asked[self.split.column] = f"{self.key}.split.column'"
        for name, key in asked.items():
            column = header.find(name)
            if column is None:
                there = [header.own(column) for column in header.columns]
                raise UlnaInputError(
                    f"{key}: there is no column '{name}' in {header.path}.{nearest(name, there)} Correct it."
                )
            found[name] = column
        return found

    def of(self, texts: pl.DataFrame, header: Header, remarks: list[str]) -> I64:
        """Indices of the rows that are used. `texts`: the columns asked about. Raises UlnaInputError."""
        columns = {name: texts[column].str.strip_chars() for name, column in self.columns(header).items()}
        kept = pl.Series([True]).new_from_index(0, len(texts))
        for name, condition in self.where.items():
            hits = _holds(columns[name], condition, header, kept)
            if not hits.any() and len(texts):
                raise _nothing(f"{self.key}.where.{name}'", columns[name], condition, header)
            kept &= hits
        if self.where:
            left_out = len(texts) - int(kept.sum())
            if left_out == len(texts) > 0:
                raise UlnaInputError(
                    f"{self.key}.where': each condition holds for some rows of {header.path}, but no row meets all; "
                    "expected at least one. Correct the conditions."
                )
            remarks.append(
                f"{header.path}: {left_out} of {_rows(len(texts))} left out by {self.key}.where'; "
                f"{len(texts) - left_out} used."
            )
        if self.split is not None:
            kept &= self._side(columns[self.split.column], self.split, header, kept, remarks)
        return kept.arg_true().to_numpy().astype(np.int64)

    def _side(
        self, column: pl.Series, split: SplitTable, header: Header, kept: pl.Series, remarks: list[str]
    ) -> pl.Series:
        sides = {"fit": split.fit, "check": split.check}
        hits = {side: _holds(column, condition, header, kept) & kept for side, condition in sides.items()}
        if (hits["fit"] & hits["check"]).any():
            raise UlnaInputError(
                f"{self.key}.split': fit ({_shown(split.fit)}) and check ({_shown(split.check)}) have a value in "
                "common; expected no row to be both. Correct one of them."
            )
        asked = list(sides) if self.rows == "all" else [self.rows]
        for side in asked:
            if not hits[side].any() and kept.any():
                raise _nothing(f"{self.key}.split.{side}'", column.filter(kept), sides[side], header)
        neither = column.filter(kept & ~hits["fit"] & ~hits["check"])
        if len(neither):
            remarks.append(
                f"{header.path}: {_rows(len(neither))} neither fitted nor checked, by {self.key}.split': in "
                f"{header.named(column.name)} they have {_values(neither)}."
            )
        return hits["fit"] | hits["check"] if self.rows == "all" else hits[self.rows]


def _nothing(key: str, column: pl.Series, condition: Any, header: Header) -> UlnaInputError:
    there = header.named(column.name)
    has = _values(column)
    if isinstance(condition, Range) and not (condition.above is None and condition.below is None):
        numbers = header.numbers(column).drop_nans().drop_nulls()
        low, high = numbers.to_numpy().min(initial=np.inf), numbers.to_numpy().max(initial=-np.inf)
        has = f"numbers from {low:g} to {high:g}" if len(numbers) else has
    return UlnaInputError(
        f"{key}: no row of {header.path} matches {_shown(condition)}; expected at least one. {there[0].upper()}"
        f"{there[1:]} has {has}. Correct the value."
    )


def _holds(column: pl.Series, condition: Any, header: Header, kept: pl.Series) -> pl.Series:
    """(N,) whether a condition holds; an empty cell meets none but `empty`, `not` and "".

    Raises UlnaInputError for a cell that should be a number and is none, in a row that meets the conditions before.
    """
    if isinstance(condition, Range):
        hits = pl.Series([True]).new_from_index(0, len(column))
        if condition.empty is not None:
            hits &= (column.fill_null("") == "") == condition.empty
        if condition.excluded is not None:
            hits &= ~_holds(column, condition.excluded, header, kept & hits)
        if condition.above is None and condition.below is None:
            return hits
        numbers = _numbers(column, header, kept & hits)
        hits &= numbers.is_not_null()
        if condition.above is not None:
            hits &= (numbers > condition.above).fill_null(False)
        if condition.below is not None:
            hits &= (numbers < condition.below).fill_null(False)
        return hits
    values = condition if isinstance(condition, list) else [condition]
    texts = [value for value in values if isinstance(value, str)]
    wanted = [float(value) for value in values if not isinstance(value, str)]
    hits = column.fill_null("").is_in(texts)
    if wanted:
        compared = kept & ~hits & (not texts)  # beside texts, what is no number is another text
        hits |= _numbers(column, header, compared).is_in(wanted).fill_null(False)
    return hits


def _numbers(column: pl.Series, header: Header, kept: pl.Series) -> pl.Series:
    """(N,) Float64, null where there is none. Raises UlnaInputError as `_holds`."""
    numbers = header.numbers(column)
    strange = kept & numbers.is_null() & (column != "").fill_null(False)
    if strange.any():
        index = int(strange.arg_true()[0])
        raise UlnaInputError(
            f"{header.path}: {header.at(index + 1, column.name)}: got '{column[index][:60]}', expected a number, "
            "because the study compares this column with one. Correct it, or write texts in quotes in the study."
        )
    return numbers.set(numbers.is_nan().fill_null(False), None)


def _shown(condition: Any) -> str:
    if isinstance(condition, Range):
        limits = {"above": condition.above, "below": condition.below}
        said = [f"{word} {limit:g}" for word, limit in limits.items() if limit is not None]
        said += [] if condition.excluded is None else [f"not {_shown(condition.excluded)}"]
        said += [] if condition.empty is None else ["an empty cell" if condition.empty else "a filled cell"]
        return " and ".join(said)
    values = condition if isinstance(condition, list) else [condition]
    return " or ".join(f"'{value}'" if isinstance(value, str) else f"{value:g}" for value in values)


def _values(column: pl.Series) -> str:
    """What stands in a column, shortly."""
    there = column.unique(maintain_order=True).drop_nulls()
    there = there.filter(there != "")
    shown = [f"'{value[:40]}'" for value in there[:_SHOWN]]
    empty = ["empty cells"] if len(column) > int((column != "").fill_null(False).sum()) else []
    return ", ".join([*shown, *(["…"] if len(there) > _SHOWN else []), *empty]) or "nothing"


def _rows(count: int) -> str:
    return f"{count} row{'s' * (count != 1)}"
