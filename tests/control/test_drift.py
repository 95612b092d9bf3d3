"""A line over time: SciPy's, false alarms as often as is said, drift found as often as theory has it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import optimize, stats

from ulna.control.drift import drift
from ulna.control.until import until
from ulna.ground.errors import UlnaInputError

YEARS = 365.25 * np.arange(6)
U = np.array([0.004, 0.005, 0.004, 0.006, 0.004, 0.005])
HISTORIES = 1000


def histories(slope_a_year: float, factor: float = 1.0, seed: int = 3) -> np.ndarray:
    """(1000, 6) figures of yearly calibrations, of true uncertainties that are so many times those stated."""
    noise = np.random.default_rng(seed).standard_normal((HISTORIES, len(YEARS))) * U * factor
    return noise + slope_a_year * np.arange(len(YEARS))


def test_without_u_it_is_the_line_of_scipy() -> None:
    y = histories(0.003)[0]
    found, expected = drift(YEARS, y), stats.linregress(YEARS, y)
    assert found.line is not None
    assert found.line.slope == pytest.approx(expected.slope, rel=1e-12)
    assert found.line.u_slope == pytest.approx(expected.stderr, rel=1e-12)
    assert found.p_value == pytest.approx(expected.pvalue, rel=1e-9)
    assert found.line.at(0.0) == pytest.approx(expected.intercept, rel=1e-9)
    assert (found.explained, found.birge) == (None, None)


def test_with_u_it_is_the_weighted_line_and_chi2_of_scipy() -> None:
    y = histories(0.003)[1]
    found = drift(YEARS, y, U)
    assert found.line is not None
    best, covariance = optimize.curve_fit(lambda t, a, b: a + b * (t - 900.0), YEARS, y, sigma=U)
    assert found.line.slope == pytest.approx(best[1], rel=1e-6)
    assert found.line.u_slope == pytest.approx(np.sqrt(covariance[1, 1]), rel=1e-6)
    chi2 = float((((y - best[0] - best[1] * (YEARS - 900.0)) / U) ** 2).sum())
    assert found.scatter_p == pytest.approx(stats.chi2.sf(chi2, 4), rel=1e-6)


@pytest.mark.parametrize("factor", [0.3, 1.0, 3.0])
def test_of_a_steady_arm_one_history_in_twenty_is_said_to_drift(factor: float) -> None:
    """Whatever the stated uncertainties are worth."""
    alarms = np.mean([drift(YEARS, y, U).drifts for y in histories(0.0, factor)])
    assert alarms == pytest.approx(0.05, abs=0.015)


@pytest.mark.parametrize("slope_a_year", [0.001, 0.002, 0.004])
def test_drift_is_found_as_often_as_the_noncentral_t_has_it(slope_a_year: float) -> None:
    w = 1.0 / U**2
    years = np.arange(len(YEARS))
    spread = float(w @ (years - (w @ years) / w.sum()) ** 2)
    away = slope_a_year * np.sqrt(spread)
    edge = stats.t.isf(0.025, 4)
    power = float(stats.nct.sf(edge, 4, away) + stats.nct.cdf(-edge, 4, away))
    found = np.mean([drift(YEARS, y, U).drifts for y in histories(slope_a_year)])
    assert found == pytest.approx(power, abs=3.0 * np.sqrt(power * (1.0 - power) / HISTORIES))


@pytest.mark.parametrize(("factor", "least", "most"), [(1.0, 0.95, 1.0), (3.0, 0.93, 0.98)])
def test_the_band_holds_the_next_figure_at_least_as_often_as_it_says(factor: float, least: float, most: float) -> None:
    """u is the least that is known: where the scatter is smaller by chance, the band is not."""
    rng = np.random.default_rng(8)
    u_next = np.sqrt(len(U) / (1.0 / U**2).sum()) * factor
    held = []
    for y in histories(0.002, factor):
        low, high = drift(YEARS, y, U).band(6 * 365.25)
        held.append(low <= 0.012 + u_next * rng.standard_normal() <= high)
    assert least <= np.mean(held) <= most


def test_where_u_does_not_explain_the_scatter_it_is_scaled_and_said() -> None:
    y = histories(0.0, factor=5.0)[0]
    found = drift(YEARS, y, U)
    assert found.explained is False
    assert found.birge == pytest.approx(np.sqrt(found.line.scale2))
    assert f"multiplied by {found.birge:.2f} (Birge)" in found.said
    good = drift(YEARS, histories(0.0, factor=0.5)[0], U)
    assert (good.explained, good.birge) == (True, 1.0)
    assert "Birge" not in good.said


def test_scale_of_unit_and_weights_changes_nothing_that_is_found() -> None:
    y = histories(0.002)[2]
    one, other = drift(YEARS, y, U), drift(YEARS - 5000.0, 1000.0 * y, 1000.0 * U)
    assert other.p_value == pytest.approx(one.p_value, rel=1e-9)
    assert other.band(0.0) == pytest.approx(tuple(1000.0 * x for x in one.band(5000.0)), rel=1e-9)
    loose = drift(YEARS, y, 10.0 * U)
    assert loose.p_value == pytest.approx(one.p_value, rel=1e-9)


@pytest.mark.parametrize("slope", [-0.004, 0.0, 0.004])
def test_the_interval_ends_where_the_band_meets_the_limit(slope: float) -> None:
    """Against a walk along the band, day by day."""
    for y in histories(slope)[:10]:
        found = drift(YEARS, y, U)
        got = until(found, 0.05, guard=0.005)
        edges = np.array([found.band(YEARS[-1] + day) for day in range(20_000)])
        beyond = np.flatnonzero((edges[:, 0] < -0.045) | (edges[:, 1] > 0.045))
        assert got.meets_days is not None
        assert got.meets_days == pytest.approx(float(beyond[0]), abs=1.0)
        assert got.interval_days == min(got.meets_days, YEARS[-1])
        assert (got.lower, got.upper) == pytest.approx((-0.045, 0.045))


def test_an_interval_of_one_sided_limits_and_of_what_is_beyond_already() -> None:
    falling = drift(YEARS, 0.02 - 0.01 * np.arange(6) + 1e-5 * np.array([1, -1, 2, -2, 1, -1]), np.full(6, 1e-4))
    free = until(falling, 0.05, lower=-np.inf)
    assert (free.meets_days, free.interval_days) == (None, YEARS[-1])
    assert "never" in free.reason
    assert until(falling, 0.02).interval_days == 0.0
    assert until(falling, 0.05, longest_days=10.0).interval_days == 10.0
    with pytest.raises(UlnaInputError, match="leaves nothing between"):
        until(falling, 0.05, guard=0.05)


def test_too_few_calibrations_are_said() -> None:
    found = drift([0.0, 365.0, 730.0], [0.1, 0.2, 0.3], [0.1, 0.1, 0.1])
    assert (found.line, found.p_value, found.drifts, found.explained) == (None, None, None, None)
    assert found.band(1000.0) is None
    assert found.said == "too few: 3 over 730 days, and at least 4 are needed; nothing is said of drift."
    advice = until(found, 1.0)
    assert (advice.meets_days, advice.interval_days) == (None, None)
    assert "no interval is advised" in advice.reason


@pytest.mark.parametrize(
    ("days", "values", "u", "said"),
    [
        ([0, 1, 2, 3], [1, 2, 3, 4], [0.1, 0.1, 0, 0.1], "above 0"),
        ([5, 5, 5, 5], [1, 2, 3, 4], None, "all figures are of one day"),
        ([0, 1, 2], [1, 2, 3, 4], None, "got 3, expected one for each of 4"),
        ([0, 1, 2, 3], [1, 2, 3, np.inf], None, "not finite"),
    ],
)
def test_what_are_no_figures_is_said(days, values, u, said: str) -> None:
    with pytest.raises(UlnaInputError, match=said):
        drift(days, values, u)


def test_figures_on_a_line_without_scatter_slope_surely() -> None:
    found = drift([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 2.0, 3.0])
    assert found.drifts
    assert drift([0.0, 1.0, 2.0, 3.0], [2.0, 2.0, 2.0, 2.0]).drifts is False
