"""The fitted readings one by one, and their length errors."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from ulna.calibration.result import Result
from ulna.study.study import Study

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]
Bool = NDArray[np.bool_]


@dataclass(frozen=True)
class ReadingRows:
    """The fitted readings in their order, N of them."""

    row: I64
    """(N,) of their file, from 1."""
    file: list[str]
    artefact: list[str]
    placement: list[str]
    size_mm: F64
    """(N,) the residual's size."""
    outlier: Bool
    """(N,) farther off than one normal reading in ten thousand."""


@dataclass(frozen=True)
class Lengths:
    """Length errors over lengths, of the fitted readings."""

    length_mm: F64
    """(N,) calibrated."""
    error_mm: F64
    """(N,) measured minus calibrated."""


def reading_rows(residuals: pl.DataFrame) -> ReadingRows:
    """Of a result's residuals."""
    return ReadingRows(
        row=residuals["row"].to_numpy(),
        file=residuals["file"].to_list(),
        artefact=residuals["artefact"].to_list(),
        placement=residuals["placement"].to_list(),
        size_mm=residuals["norm_mm"].to_numpy(),
        outlier=residuals["outlier"].fill_null(False).to_numpy(),
    )


def length_errors(study: Study, result: Result) -> Lengths | None:
    """Of length rows each, of bars the mean of each placement; None where no length was measured."""
    length_mm, error_mm = [], []
    first = 0
    for group in study.readings:
        rows = result.residuals[first : first + len(group)]
        first += len(group)
        if group.length_mm is not None:
            length_mm.append(group.length_mm)
            error_mm.append(rows["length_mm"].to_numpy())
        elif group.artefact.length_mm is not None:
            own = [entry for entry in result.artefacts if entry.artefact == group.artefact.name]
            errors = [each for each in (entry.figures.get("length_error_mean_mm") for entry in own) if each is not None]
            length_mm.append(np.full(len(errors), group.artefact.length_mm))
            error_mm.append(np.array(errors))
    if not length_mm:
        return None
    return Lengths(np.concatenate(length_mm), np.concatenate(error_mm))
