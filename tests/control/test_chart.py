"""A chart of what has not changed is out of control as seldom as it says, of short baselines too."""

from __future__ import annotations

import numpy as np
import pytest

from ulna.control.chart import chart


@pytest.mark.long
@pytest.mark.parametrize(("n", "later"), [(5, 1), (5, 10), (10, 10), (20, 20)])
def test_false_alarms_are_as_rare_as_alpha(n: int, later: int) -> None:
    rng, alpha, tries = np.random.default_rng(n + later), 0.02, 4000
    beyond = drifted = 0
    for _ in range(tries):
        values = rng.normal(size=n + later)
        found = chart(values[:n], values[n:], alpha=alpha)
        beyond += found.beyond
        drifted += found.drifted
    sigma = np.sqrt(alpha * (1 - alpha) / tries)
    assert beyond / tries == pytest.approx(alpha, abs=4 * sigma)
    assert drifted / tries == pytest.approx(alpha, abs=4 * sigma)


def test_the_newest_decides_and_earlier_ones_are_told() -> None:
    baseline = [0.0, 1.0, -1.0, 0.5, -0.5, 0.2, -0.2, 0.8, -0.8, 0.1]
    found = chart(baseline, [20.0, *([0.0] * 40)])
    assert found.limits.outside.tolist() == [0]
    assert found.in_control
    assert chart(baseline, [0.0, 20.0]).in_control is False


def test_nothing_after_the_baseline_says_nothing() -> None:
    assert chart([1.0, 2.0, 3.0, 4.0, 5.0], []).in_control is None
    assert chart([1.0, 2.0], [3.0]).in_control is None
