"""What a count says of a probability: against published intervals, SciPy's, and what must hold of them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from ulna.ground.binomial import wilson

#: Newcombe, Statistics in Medicine 17 (1998) 857, table I, method 3: inside, count → both ends
PUBLISHED = {
    (81, 263): (0.2553, 0.3662),
    (15, 148): (0.0624, 0.1605),
    (0, 20): (0.0, 0.1611),
    (1, 29): (0.0061, 0.1718),
}


@pytest.mark.parametrize("counted", PUBLISHED)
def test_published_intervals(counted: tuple[int, int]) -> None:
    assert wilson(*counted) == pytest.approx(PUBLISHED[counted], abs=5e-5)


@given(st.data(), st.integers(1, 5000), st.floats(0.5, 0.999))
def test_the_interval_is_that_of_scipy(data: st.DataObject, count: int, p: float) -> None:
    inside = data.draw(st.integers(0, count))
    expected = stats.binomtest(inside, count).proportion_ci(p, method="wilson")
    low, high = wilson(inside, count, p)
    assert (low, high) == pytest.approx((expected.low, expected.high), abs=1e-9)
    assert 0.0 <= low <= inside / count + 1e-12
    assert inside / count - 1e-12 <= high <= 1.0
    assert wilson(count - inside, count, p) == pytest.approx((1.0 - high, 1.0 - low), abs=1e-12)
