"""What is said after a fit that ended badly fits the failure: a missing placement only where rows suggest one."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import polars as pl
import pytest
from tests.cli.test_tables import result

from ulna.calibration.result import Result
from ulna.cli.printed.hints import err_alike, where_to_look


def ended(
    residuals_mm: np.ndarray, termination: str = "poor-minimum", chi2: float | None = None, **more: Any
) -> Result:
    """A result with (N, 3) residuals of one artefact in one placement, unless `more` says otherwise."""
    n = len(residuals_mm)
    rows = {
        "row": np.arange(1, n + 1),
        "file": ["bars.csv"] * n,
        "artefact": ["bar"] * n,
        "placement": ["1"] * n,
        "length_mm": pl.Series([None] * n, dtype=pl.Float64),
        "x_mm": residuals_mm[:, 0],
        "y_mm": residuals_mm[:, 1],
        "z_mm": residuals_mm[:, 2],
        "norm_mm": np.linalg.norm(residuals_mm, axis=1),
    }
    fit = dataclasses.replace(result().fit, termination=termination, converged=False, chi2_per_dof=chi2)
    return dataclasses.replace(result(), fit=fit, residuals=pl.DataFrame(rows | more))


def noise(seed: int, n: int = 60) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal((n, 3))


def moved(seed: int, n: int = 60, parts: int = 3) -> np.ndarray:
    """Noise, and what is left of an artefact that stood in so many places, told as one: each part off by its own."""
    places = 3.0 * np.random.default_rng(1000 + seed).standard_normal((parts, 3))
    return noise(seed, n) + np.repeat(places - places.mean(axis=0), n // parts, axis=0)


def test_the_worst_row_is_named() -> None:
    residuals = noise(1)
    residuals[16] *= 100.0
    assert "row 17 of bars.csv (artefact 'bar', placement '1')" in where_to_look(ended(residuals))


def test_independent_residuals_suggest_no_placement_and_those_of_what_was_moved_do() -> None:
    assert sum(err_alike(noise(seed)) for seed in range(1000)) <= 2  # four standard deviations
    assert sum(err_alike(moved(seed)) for seed in range(200)) >= 190
    # nor is an outlier two rows that err alike
    outlier = noise(3)
    outlier[20] = outlier[21] = 500.0
    assert not err_alike(outlier)
    assert not err_alike(moved(1)[:6])
    assert "is a column 'placement' missing?" not in where_to_look(ended(noise(1)))
    text = where_to_look(ended(moved(1)))
    assert "All 60 readings of artefact 'bar' were taken as one standing, '1'" in text
    assert "is a column 'placement' missing?" in text


def test_nor_where_there_are_placements_or_they_do_not_matter() -> None:
    two = where_to_look(ended(moved(1), placement=["1"] * 30 + ["2"] * 30))
    lengths = where_to_look(ended(moved(1), length_mm=[443.0] * 60))
    for text in (two, lengths):
        assert "placement' missing" not in text


@pytest.mark.parametrize(
    ("termination", "chi2", "words", "others"),
    [
        ("poor-minimum", None, ("no noise is stated", "[noise] seat", "[fit] poor_above"), ("max_iterations",)),
        ("poor-minimum", 25.0, ("5 times what the stated noise explains", "[noise]"), ("max_iterations",)),
        ("max-iterations", None, ("[fit] max_iterations",), ("poor_above", "[noise]")),
        ("no-progress", None, (), ("max_iterations", "poor_above", "[noise]")),
    ],
)
def test_each_ending_has_its_own(termination: str, chi2: float | None, words: Any, others: Any) -> None:
    text = where_to_look(ended(noise(2), termination, chi2))
    assert all(word in text for word in words), text
    assert not any(word in text for word in others), text


def test_without_residuals_nothing_is_said() -> None:
    assert where_to_look(result()) == ""
