"""How often a check of an arm that has not changed says that it has, and how soon it sees one that has."""

from __future__ import annotations

import numpy as np
import pytest

from ulna.checking.history import Past
from ulna.checking.series import History, judged
from ulna.checking.tables import ControlTable
from ulna.control.shewhart import BEYOND_3
from ulna.verification.figures.asme_b89_4_22 import single_point
from ulna.verification.figures.faro import half_ranges

CONTROL = ControlTable()


def history(values: np.ndarray, now: float, signed: bool, control: ControlTable = CONTROL) -> History:
    count = len(values)
    return judged(Past(values, np.arange(count, dtype=float), np.ones(count, bool), 0), now, signed, control)


def lengths(checks: int, rng: np.random.Generator) -> np.ndarray:
    """(checks,) errors of one length, µm."""
    return 3.0 + 10.0 * rng.standard_normal(checks)


def seats(checks: int, rng: np.random.Generator) -> np.ndarray:
    """(checks, 5) figures of eight touches of a seat."""
    touches = 10.0 * rng.standard_normal((checks, 8, 3))
    return np.stack([figure.value for figure in (*single_point(touches), *half_ranges(touches))], axis=1)


@pytest.mark.long
@pytest.mark.parametrize("earlier", [5, 10, 25])
def test_a_signed_figure_is_out_by_chance_as_often_as_was_asked(earlier: int) -> None:
    """By its limits, and by its average: each at alpha, 5 % here."""
    rng = np.random.default_rng(earlier)
    control = ControlTable(alpha=0.05)
    rules = []
    for _ in range(3000):
        x = lengths(earlier + 1, rng)
        rules += [signal.rule for signal in history(x[:-1], x[-1], True, control).signals]
    for rule in ("limits", "average"):
        assert rules.count(rule) / 3000 == pytest.approx(0.05, abs=0.012), rule


@pytest.mark.long
def test_a_whole_check_of_a_steady_arm_is_out_by_chance_in_one_of_thirty() -> None:
    """Eight figures, of a seat and of a bar in three places, after 15 checks: what docs/check.md says."""
    rng = np.random.default_rng(5)
    out = 0
    for _ in range(1000):
        points, bars = seats(16, rng), np.stack([lengths(16, rng) for _ in range(3)], axis=1)
        found = [history(x[:-1], x[-1], False) for x in points.T] + [history(x[:-1], x[-1], True) for x in bars.T]
        out += any(each.signals for each in found)
    print(f"{out / 1000:.1%} of checks of a steady arm are out")
    assert 8.0 * BEYOND_3 / 3.0 < out / 1000 < 0.04


def test_rows_count_only_where_the_protocol_says_so() -> None:
    rng = np.random.default_rng(6)
    base = lengths(10, rng)
    row = np.concatenate([base, np.full(8, base.mean() + 0.8 * base.std())])
    told = history(row[:-1], row[-1], True)
    assert "eight in a row on one side of the mean" in told.notes
    counted = history(row[:-1], row[-1], True, ControlTable(rows=["eight-on-one-side"]))
    assert [signal.rule for signal in counted.signals if signal.rule != "average"] == ["eight-on-one-side"]
    assert all(signal.slow for signal in counted.signals)


@pytest.mark.parametrize(("step", "most"), [(2.0, 8.0), (4.0, 2.0)])
def test_how_soon_a_step_is_seen(step: float, most: float) -> None:
    """In checks, the median of 100 arms that step by so many standard deviations after the baseline of ten."""
    rng = np.random.default_rng(7)
    until = []
    for _ in range(100):
        x = rng.standard_normal(40)
        x[10:] += step
        until.append(next((k for k in range(10, 40) if history(x[:k], x[k], True).signals), 40) - 9)
    print(f"a step of {step:g} s is seen at check {np.median(until):g}")
    assert np.median(until) <= most


def test_a_figure_that_cannot_be_negative_is_out_only_upward() -> None:
    rng = np.random.default_rng(8)
    x = seats(20, rng)[:, 0]
    small, large = history(x, 0.0, False), history(x, 10.0 * x.max(), False)
    assert small.signals == ()
    assert {signal.rule for signal in large.signals} >= {"limits"}
    assert small.lower is None
    assert small.average_lower is None
    assert small.centre == pytest.approx(np.mean(x[:10] ** (2 / 3)) ** 1.5)


def test_too_few_say_nothing() -> None:
    found = history(np.array([1.0, 2.0, 3.0]), 99.0, True)
    assert (found.in_control, found.centre, found.upper, found.average) == (None, None, None, None)
    assert found.basis.said == "too few: 3 over 2 days, and at least 5 are needed"


def test_no_baseline_rests_on_a_check_that_was_out() -> None:
    x = np.array([1.0, 2.0, 50.0, 1.5, 2.5, 1.0, 2.0])
    well = np.array([True, True, False, True, True, True, True])
    found = judged(Past(x, np.arange(7.0), well, 2), 60.0, True, CONTROL)
    assert found.basis.n == 6
    assert (found.earlier, found.not_used) == (7, 2)
    assert found.centre == pytest.approx(x[well].mean())
    assert {signal.rule for signal in found.signals} == {"limits", "average"}


def test_figures_all_alike_are_no_reason_to_fail() -> None:
    assert history(np.full(6, 2.0), 2.0, True).in_control
    assert history(np.full(6, 2.0), 2.1, True).in_control is False
