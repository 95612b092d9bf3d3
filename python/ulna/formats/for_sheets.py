"""Tables as text that people open in a spreadsheet: a name out of somebody's file is never a formula there.

A spreadsheet runs what begins with =, +, - or @ (OWASP, "CSV injection"), blanks before it or not. Such a text gets an
apostrophe in front, as people write it there themselves; numbers, also those that stand in a column of texts, stay.
"""

from __future__ import annotations

import polars as pl

_FORMULA = r"^[\s\x00]*[=+\-@\uff1d\uff0b\uff0d\uff20]"
_NUMBER = r"^\s*[+-]?(\d+([.,]\d*)?|[.,]\d+)([eE][+-]?\d+)?\s*$"


def for_sheets(frame: pl.DataFrame) -> pl.DataFrame:
    """The same table, where no text and no column's name is a formula."""
    texts = [name for name, dtype in frame.schema.items() if dtype == pl.String]
    neutral = frame.with_columns(
        pl.when(pl.col(name).str.contains(_FORMULA) & ~pl.col(name).str.contains(_NUMBER))
        .then(pl.lit("'") + pl.col(name))
        .otherwise(pl.col(name))
        .alias(name)
        for name in texts
    )
    heads = pl.Series(frame.columns)
    formulas = heads.filter(heads.str.contains(_FORMULA)).to_list()
    return neutral.rename({name: f"'{name}" for name in formulas if f"'{name}" not in frame.columns})
