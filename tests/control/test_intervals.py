"""Intervals and E_n: published figures, closed forms, SciPy."""

from __future__ import annotations

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import stats

from ulna.control.a3 import clopper_pearson, interval_test
from ulna.control.en import en
from ulna.control.staircase import staircase
from ulna.ground.errors import UlnaInputError


def test_a3_is_that_of_the_published_example() -> None:
    """15 of 20 in tolerance after 365 days, 95 % wanted: the documentation of Sandia's suncal prints 230.84604619 d."""
    found = interval_test(15, 20, 365.0, target=0.95, span_days=7300.0)
    assert found.calculated_days == pytest.approx(230.84604619, abs=5e-9)
    assert found.interval_days == found.calculated_days
    assert (found.reliability, found.rejected) == (0.75, True)
    assert found.surely == pytest.approx(1.0 - 2.0 * stats.binom.cdf(15, 20, 0.95), abs=1e-13)
    assert (found.basis.n, found.basis.span_days, found.basis.method) == (20, 7300.0, "NCSLI RP-1 A3")


def test_a3_keeps_what_it_cannot_reject_and_stays_in_bounds() -> None:
    kept = interval_test(19, 20, 365.0)
    assert (kept.rejected, kept.interval_days, kept.surely) == (False, 365.0, 0.0)
    held = interval_test(15, 20, 365.0, bounds_days=(270.0, 730.0))
    assert held.interval_days == 270.0
    assert held.calculated_days == pytest.approx(230.846, abs=1e-3)
    longer = interval_test(200, 200, 365.0, target=0.9)
    assert longer.surely == pytest.approx(1.0 - 2.0 * 0.9**200)
    assert longer.interval_days == pytest.approx(365.0 * 10.0 ** (0.1 * (1.0 - 2.0 * 0.9**200)))


def test_a3_of_too_few_says_so() -> None:
    found = interval_test(1, 3, 365.0)
    assert (found.calculated_days, found.interval_days, found.rejected, found.bounds) == (None, None, None, None)
    assert found.basis.said == "too few: 3, and at least 4 are needed"
    with pytest.raises(UlnaInputError, match="got 21 of 20 in tolerance"):
        interval_test(21, 20, 365.0)


@given(st.data(), st.integers(1, 300), st.floats(0.5, 0.99))
def test_bounds_are_those_of_scipy(data: st.DataObject, n: int, confidence: float) -> None:
    x = data.draw(st.integers(0, n))
    expected = stats.binomtest(x, n).proportion_ci(confidence, method="exact")
    assert clopper_pearson(x, n, confidence) == pytest.approx((expected.low, expected.high), abs=1e-9)


@settings(max_examples=20)
@given(st.integers(4, 25), st.floats(0.5, 0.99))
def test_a_larger_share_never_gives_a_shorter_interval(n: int, target: float) -> None:
    days = [interval_test(x, n, 365.0, target).calculated_days for x in range(n + 1)]
    assert all(days[k] <= days[k + 1] + 1e-9 for k in range(n))
    assert days[0] <= 365.0 <= days[-1]


@pytest.mark.parametrize(
    ("found", "step", "days", "says"),
    [
        ({"E": (0.040, 0.050), "P": (-0.001, 0.01)}, "longer", 456.25, "'E' was found at 80 % of its limit"),
        ({"E": (0.041, 0.050)}, "kept", 365.0, "inside, but not within 80 %"),
        ({"E": (0.01, 0.050), "P": (-0.0101, 0.01)}, "shorter", 182.5, "'P' was found at 101 % of its limit"),
    ],
)
def test_staircase(found: dict[str, tuple[float, float]], step: str, days: float, says: str) -> None:
    got = staircase(found, 365.0)
    assert (got.step, got.interval_days) == (step, days)
    assert says in got.reason
    assert "after 365 days" in got.reason
    assert got.basis.n == len(found)


def test_staircase_stays_in_bounds_and_says_so() -> None:
    got = staircase({"E": (0.0, 1.0)}, 1600.0)
    assert got.interval_days == 1826.0
    assert "held to the bounds 30 to 1826 days" in got.reason
    assert staircase({"E": (2.0, 1.0)}, 40.0).interval_days == 30.0
    nothing = staircase({}, 365.0)
    assert (nothing.step, nothing.interval_days, nothing.basis.too_few) == (None, None, True)
    with pytest.raises(UlnaInputError, match=r"'E': got limit 0"):
        staircase({"E": (0.0, 0.0)}, 365.0)
    with pytest.raises(UlnaInputError, match=r"longer by 0\.9"):
        staircase({"E": (0.0, 1.0)}, 365.0, longer=0.9)


def test_en_is_the_closed_form() -> None:
    assert en(10.02, 0.03, 10.0, 0.04).value == pytest.approx(0.4)
    assert en(10.06, 0.03, 10.0, 0.04).satisfactory is False
    assert en(10.05, 0.03, 10.0, 0.04).value == pytest.approx(1.0)
    shared = en(10.02, 0.03, 10.0, 0.04, correlation=0.5)
    assert shared.expanded == pytest.approx(math.sqrt(0.0009 + 0.0016 - 0.0012))
    assert shared.value == pytest.approx(0.02 / shared.expanded)
    with pytest.raises(UlnaInputError, match="no uncertainty"):
        en(1.0, 0.1, 2.0, 0.1, correlation=1.0)
    with pytest.raises(UlnaInputError, match="correlation 2"):
        en(1.0, 0.1, 2.0, 0.1, correlation=2.0)
