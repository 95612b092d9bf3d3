"""After a fit that ended badly: where to look, and what to try, as far as the readings or the ending suggest it."""

from __future__ import annotations

import numpy as np
import polars as pl

from ulna.calibration.result import Result
from ulna.calibration.summary import FitSummary
from ulna.calibration.suspects import Suspicion
from ulna.cli.printed.scale import beyond_reach
from ulna.ground.digits import figure_mm

#: neighbours in the file err alike where their residuals correlate by more than this many standard deviations
_ALIKE = 4.0
#: with fewer rows nothing of the kind shows
_FEWEST = 8


def where_to_look(result: Result, suspected: Suspicion | None = None) -> str:
    """What to try, and the reading that fits worst; suspected: what would explain them."""
    residuals = result.residuals
    if not len(residuals):
        return ""
    worst = residuals.row(residuals["norm_mm"].arg_max() or 0, named=True)
    largest = (
        f"The largest residual, {figure_mm(worst['norm_mm'])} mm, is of row {worst['row']} of {worst['file']} "
        f"(artefact '{worst['artefact']}', placement '{worst['placement']}'); residuals.csv has them all."
    )
    return " ".join(filter(None, [what_to_try(result, suspected), largest]))


def what_to_try(result: Result, suspected: Suspicion | None = None) -> str:
    """What the ending or the rows suggest; suspected: what would explain them."""
    residuals = result.residuals
    if not len(residuals):
        return ""
    hints = []
    if result.fit.termination == "max-iterations":
        hints.append(
            f"It was still on its way after {result.fit.iterations} iterations: allow more with [fit] max_iterations, "
            "or start nearer."
        )
    moved = _taken_as_one_standing(residuals)
    wrong_size = result.fit.common_factor is not None or bool(beyond_reach(result))
    if suspected is not None:
        hints.append(f"They are met to {figure_mm(suspected.rms_mm)} mm, rms, {suspected.if_so}. {suspected.to_do}")
    if result.fit.termination in ("poor-minimum", "held-poor") and not moved and not wrong_size and suspected is None:
        hints.append(_if_that_is_its_noise(result.fit))
    if result.fit.termination == "off-scale":
        hints.append(
            "Correct the size or the arm file and calibrate again; if its lengths are only guesses, say how far off "
            "they may be: [fit] known_length."
        )
    hints += [said for said in [beyond_reach(result)] if said]
    return " ".join(hints + moved)


def _if_that_is_its_noise(fit: FitSummary) -> str:
    """What is called poor may be what the instrument leaves, and only its owner knows."""
    left = f"{figure_mm(fit.rms_mm)} mm are left, rms"
    if fit.chi2_per_dof is None:
        return (
            f"{left}, and no noise is stated to explain them. If the instrument is that coarse, say so: [noise] seat, "
            "its standard deviation, or [fit] poor_above, what is too much."
        )
    return (
        f"{left}: {fit.chi2_per_dof**0.5:.3g} times what the stated noise explains. If the readings are that much "
        "coarser, state it in [noise]."
    )


def _taken_as_one_standing(residuals: pl.DataFrame) -> list[str]:
    """Artefacts with one placement whose neighbouring rows err alike, as those of an artefact do that was moved."""
    # of length rows it does not matter which standing they are of
    touches = residuals.filter(residuals["length_mm"].is_null())
    return [
        f"All {len(rows)} readings of artefact '{artefact}' were taken as one standing, '{rows['placement'][0]}', and "
        "neighbouring rows err alike, as if it had been moved in between: is a column 'placement' missing?"
        for (artefact,), rows in touches.group_by("artefact", maintain_order=True)
        if rows["placement"].n_unique() == 1 and err_alike(rows.select("x_mm", "y_mm", "z_mm").to_numpy())
    ]


def err_alike(residuals_mm: np.ndarray) -> bool:
    """Whether (N, 3) residuals in the order of the file correlate with their neighbours: of independent ones the sum of
    e_i · e_(i+1) has the standard deviation √Σ (e_i · e_(i+1))²."""
    e = residuals_mm[np.isfinite(residuals_mm).all(axis=1)]
    if len(e) < _FEWEST:
        return False
    products = np.einsum("ij,ij->i", e[:-1], e[1:])
    return bool(products.sum() > _ALIKE * np.sqrt(np.square(products).sum()))
