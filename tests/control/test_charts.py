"""Charts of single figures: the handbook's printed examples, and how often they find something that is not there."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from ulna.control.basis import basis, normal_scores
from ulna.control.ewma import against, ewma
from ulna.control.shewhart import BEYOND_3, MANY, shewhart
from ulna.ground.errors import UlnaInputError

#: NIST/SEMATECH e-Handbook 6.3.2.4: figures, and their averages with λ = 0.3 from 50, as printed there
HANDBOOK = "52.0 47.0 53.0 49.3 50.1 47.0 51.0 50.1 51.2 50.5 49.6 47.6 49.9 51.3 47.8 51.2 52.6 52.4 53.6 52.1"
AVERAGES = (
    "50.60 49.52 50.56 50.18 50.16 49.21 49.75 49.85 50.26 50.33 50.11 49.36 49.52 50.05 49.38 49.92 50.73 51.23 51.94 "
    "51.99"
)


def test_ewma_is_that_of_the_handbook() -> None:
    figures = np.array([float(x) for x in HANDBOOK.split()])
    found = against(figures, 50.0, 2.0539, basis("EWMA", 20, 2), weight=0.3, exact=False)
    assert found.averages == pytest.approx([float(x) for x in AVERAGES.split()], abs=0.0051)
    assert 50.0 + found.half == pytest.approx(np.full(20, 52.5884), abs=5e-5)
    assert 50.0 - found.half == pytest.approx(np.full(20, 47.4115), abs=1e-4)  # printed from a rounded factor
    assert found.in_control


def test_exact_limits_begin_at_those_of_one_figure_and_end_at_those_of_many() -> None:
    found = against(np.zeros(200), 0.0, 1.0, basis("EWMA", 20, 2), weight=0.2, k=3.0)
    assert found.half[0] == pytest.approx(3.0 * 0.2)
    assert found.half[-1] == pytest.approx(3.0 * np.sqrt(0.2 / 1.8))
    assert (np.diff(found.half) >= 0.0).all()
    rng = np.random.default_rng(4)
    averages = [against(x, 0.0, 1.0, basis("EWMA", 20, 2)).averages for x in rng.standard_normal((4000, 6))]
    assert np.std(averages, axis=0) == pytest.approx(found.half[:6] / 3.0, rel=0.04)


def test_ewma_sees_a_step_that_single_figures_do_not() -> None:
    baseline = [9.0, 10.0, 11.0, 10.0, 10.0, 9.0, 11.0, 10.0]
    step = [10.0, 11.5, 11.5, 11.5, 11.5, 11.5, 11.5]
    assert shewhart(baseline, step).in_control
    assert ewma(baseline, step).outside.tolist() == [3, 4, 5, 6]
    assert ewma(baseline, step).basis.n == 8


def test_limits_of_few_figures_are_those_of_the_handbook() -> None:
    """2.3.5.2: with K = 6 and α = 0.05, t is 2.571."""
    baseline = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    found = shewhart(baseline, [3.5, 8.4, -1.4], days=[0, 7, 14, 21, 28, 35], alpha=0.05)
    s = np.sqrt(3.5)
    assert found.centre == pytest.approx(3.5)
    assert found.s == pytest.approx(s)
    assert found.k == pytest.approx(2.571, abs=5e-4)
    assert (found.lower, found.upper) == pytest.approx((3.5 - 2.571 * s, 3.5 + 2.571 * s), abs=1e-3)
    assert found.outside.tolist() == [1, 2]
    assert (found.basis.n, found.basis.span_days) == (6, 35.0)


def test_limits_of_many_are_three_s() -> None:
    baseline = np.random.default_rng(1).standard_normal(MANY)
    found = shewhart(baseline, [0.0])
    assert found.k == 3.0
    assert stats.t.ppf(1.0 - 0.5 * BEYOND_3, MANY - 1) == pytest.approx(3.0, rel=0.03)
    nearly = shewhart(baseline[:20], [0.0])
    assert nearly.k == pytest.approx(stats.t.ppf(1.0 - 0.5 * BEYOND_3, 19))


@pytest.mark.parametrize("alpha", [0.05, BEYOND_3])
def test_predictions_are_missed_as_often_as_is_said(alpha: float) -> None:
    """Of the mean of six, as of a known one, it is more than was asked."""
    rng = np.random.default_rng(2)
    draws = rng.standard_normal((5000, 7))
    missed = np.mean([len(shewhart(x[:6], x[6:], alpha=alpha, of_the_mean=True).outside) for x in draws])
    plain = np.mean([len(shewhart(x[:6], x[6:], alpha=alpha).outside) for x in draws])
    assert missed == pytest.approx(alpha, abs=4.0 * np.sqrt(alpha / 5000))
    assert plain == pytest.approx(2.0 * stats.t.sf(stats.t.isf(alpha / 2, 5) / np.sqrt(7 / 6), 5), abs=0.012)
    assert plain > missed


def test_too_few_are_said_and_have_no_limits() -> None:
    found = shewhart([1.0, 2.0, 1.5], [99.0], days=[0.0, 10.0, 30.0])
    assert (found.centre, found.upper, found.lower, found.in_control) == (None, None, None, None)
    assert found.basis.said == "too few: 3 over 30 days, and at least 5 are needed"
    averages = ewma([1.0, 2.0], [99.0])
    assert (averages.in_control, len(averages.averages)) == (None, 0)
    assert averages.basis.said == "too few: 2, and at least 5 are needed"


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (lambda: shewhart([1.0, np.nan, 2.0, 3.0, 4.0], [1.0]), "not finite"),
        (lambda: shewhart([[1.0]], [1.0]), "2 dimensions"),
        (lambda: shewhart([1.0, 2.0], [1.0], days=[1.0]), "got 1, expected one for each of 2"),
        (lambda: shewhart([1.0, 2.0], [1.0], alpha=0.0), "alpha 0"),
        (lambda: ewma([1.0] * 5, [1.0], weight=0.0), "weight 0"),
    ],
)
def test_what_are_no_figures_is_said(wrong, said: str) -> None:
    with pytest.raises(UlnaInputError, match=said):
        wrong()


def test_averages_against_a_mean_of_few_are_missed_as_often_as_is_said() -> None:
    """The fourth average after a baseline of six, k of Student's t: 5 % of them; as of a known mean it is more."""
    rng = np.random.default_rng(3)
    k = float(stats.t.isf(0.025, 5))
    missed = {True: 0, False: 0}
    for x in rng.standard_normal((4000, 10)):
        for known in missed:
            found = against(x[6:], x[:6].mean(), x[:6].std(ddof=1), basis("", 6, 2), k=k, of_the_mean=known)
            missed[known] += 3 in found.outside
    assert missed[True] / 4000 == pytest.approx(0.05, abs=0.012)
    assert missed[False] > 1.3 * missed[True]


def test_normal_scores_are_standard_normal() -> None:
    rng = np.random.default_rng(4)
    z = [normal_scores(x[5:], x[:5].mean(), x[:5].std(ddof=1), 5)[0] for x in rng.standard_normal((4000, 6))]
    assert stats.kstest(z, stats.norm.cdf).pvalue > 0.01
    expected = stats.norm.isf(stats.t.sf(2.0 / np.sqrt(1.2), 4))
    assert normal_scores(np.array([2.0, -2.0]), 0.0, 1.0, 5) == pytest.approx([expected, -expected], rel=1e-9)
    assert np.isfinite(normal_scores(np.array([1e9]), 0.0, 1.0, 5)).all()
