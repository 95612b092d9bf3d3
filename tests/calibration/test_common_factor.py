"""A stated size that is wrong makes every length of the arm wrong by one factor, and only the drawing can tell."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.oracle import virtual
from tests.oracle.chain import Chain
from tests.oracle.core import core_problem
from tests.oracle.published import table_4

import ulna._core as _core

FACTORS = [0.001, 1.0 / 25.4, 0.45, 0.82, 1.05, 1.9, 2.5]


def _scaled(truth: Chain, rng: np.random.Generator, factor: float) -> dict[str, Callable[[], Any]]:
    """Readings of each kind whose size somebody states, stated wrong by a factor."""

    def of(made: Any, *sizes: str) -> Any:
        return replace(made, **{size: factor * getattr(made, size) for size in sizes})

    return {
        "bar": lambda: of(virtual.bars(truth, rng, 40, 500.0), "features_mm"),
        "plate": lambda: of(virtual.plate(truth, rng, 8), "features_mm"),
        "coordinates": lambda: of(virtual.coordinates(truth, rng, 60, True), "features_mm"),
        "lengths": lambda: of(virtual.random_lengths(truth, rng, 60), "length_mm"),
        "distance": lambda: of(virtual.distances(truth, rng, 6, 20), "measured_mm"),
    }


@pytest.mark.parametrize("factor", FACTORS)
@pytest.mark.parametrize("kind", ["bar", "plate", "coordinates", "lengths", "distance"])
def test_the_factor_is_found_and_what_no_drawing_could_be_off_by_is_not_believed(kind: str, factor: float) -> None:
    rng = np.random.default_rng(5)
    truth = table_4()
    problem = core_problem(truth, [_scaled(truth, rng, factor)[kind]()])
    found = _core.fit(problem, np.zeros(len(problem.parameter_names), bool), search_starts=0)
    assert found.common_factor is not None or not found.converged
    if found.common_factor is not None and factor > 0.4:
        assert found.common_factor == pytest.approx(factor, rel=1e-3)
    assert found.converged == (0.5 <= factor <= 2.0)


@pytest.mark.parametrize("seed", range(20))
def test_drawings_that_are_off_length_by_length_are_no_wrong_bar(seed: int) -> None:
    """Each length off by up to a tenth, to either side: no one factor tells that."""
    rng = np.random.default_rng(seed)
    truth = table_4()
    drawn = replace(
        truth,
        a_mm=truth.a_mm * rng.uniform(0.9, 1.1, truth.a_mm.shape),
        last=truth.last * rng.uniform(0.9, 1.1, truth.last.shape),
        tips_mm=truth.tips_mm * rng.uniform(0.9, 1.1, truth.tips_mm.shape),
    )
    problem = core_problem(drawn, [virtual.bars(truth, rng, 60, 500.0)])
    found = _core.fit(problem, np.zeros(len(problem.parameter_names), bool))
    assert found.converged
    assert found.common_factor is None


def test_who_says_that_lengths_are_only_guesses_is_believed() -> None:
    """A length known to half a metre beforehand is contradicted by nothing that one of a metre comes out as."""
    rng = np.random.default_rng(5)
    truth = table_4()
    problem = core_problem(truth, [_scaled(truth, rng, 2.5)["bar"]()])
    hold = np.zeros(len(problem.parameter_names), bool)
    found = _core.fit(problem, hold, search_starts=0, known_length_mm=500.0)
    assert found.converged
    assert found.common_factor == pytest.approx(2.5, rel=1e-3)
