"""Figures that the record has go into statistics as they are, and advice says on what it rests."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.records.benches import evaluation, verification

from ulna import UlnaInputError
from ulna.control.drift import drift
from ulna.records.records import Records

NAME = "length_error_rms_mm"


def with_figures(folder: Path, values: list[float]) -> Records:
    """A figure each 1 January from 2016."""
    records = Records.init(folder / "bench", by="Jan")
    records.register("P7", model="Platinum")
    for year, value in enumerate(values, start=2016):
        path = evaluation(folder / f"{year}.json", value, f"{year}-01-01T12:00:00+00:00")
        records.add(path, arm="P7")
    return records


def test_the_line_is_that_of_the_figures(tmp_path: Path) -> None:
    values = (0.02 + 0.003 * np.arange(9) + np.random.default_rng(3).normal(0, 0.001, 9)).tolist()
    found = with_figures(tmp_path, values).trend("P7", NAME, limit=0.06)
    days = [365.0 * k + leap for k, leap in enumerate([0, 1, 1, 1, 1, 2, 2, 2, 2])]
    assert found.days.tolist() == pytest.approx(days)
    assert found.drift.line is not None
    assert found.drift.line.slope == pytest.approx(np.polyfit(days, values, 1)[0], rel=1e-9)
    assert found.drift == drift(found.days, values)
    assert found.drift.drifts
    assert found.until is not None
    assert found.until.meets_days is not None
    assert 0.0 < found.until.meets_days < (0.06 - values[-1]) / 0.003 * 365.25


def test_too_few_figures_say_nothing(tmp_path: Path) -> None:
    found = with_figures(tmp_path, [0.02, 0.03, 0.02]).trend("P7", NAME)
    assert found.drift.drifts is None
    assert found.chart.in_control is None
    assert "too few: 3" in found.drift.said


def test_a_figure_outside_is_out_of_control(tmp_path: Path) -> None:
    steady = [0.020, 0.021, 0.019, 0.020, 0.021, 0.019, 0.020, 0.0205]
    records = with_figures(tmp_path, [*steady, 0.020, 0.030])
    assert records.trend("P7", NAME, baseline=8).chart.in_control is False
    assert records.trend("P7", NAME, baseline=8).chart.limits.outside.tolist() == [1]
    assert records.trend("P7", NAME, since="2018-01-01").points[0].at.startswith("2018")


def test_series_of_several_states_are_not_one(tmp_path: Path) -> None:
    records = with_figures(tmp_path, [0.02, 0.03])
    records.add(Path(__file__).parents[1] / "data/fossils/result-1.json", arm="P7")
    with pytest.raises(UlnaInputError, match="several states"):
        records.trend("P7", NAME)


def test_an_adjustment_in_between_is_said(tmp_path: Path) -> None:
    records = with_figures(tmp_path, [0.02, 0.03, 0.02, 0.02])
    records.event("P7", "adjustment", "zeros set", at="2017-06-01")
    assert records.trend("P7", NAME).breaks == ["2017-06-01 adjustment: zeros set"]


def with_tests(folder: Path, arms: int, bad: int) -> Records:
    """Twenty tests as found a year apart, over so many arms, of which so many fail."""
    records = Records.init(folder / "bench", by="Jan")
    for arm in range(arms):
        records.register(f"P{arm}", model="Platinum")
    for k in range(20):
        arm, year = k % arms, 2000 + k // arms
        path = verification(folder / f"{k}.json", 1.0 + 1e-6 * k, "fail" if k < bad else "pass")
        records.add(path, arm=f"P{arm}", at=f"{year}-01-01")
    return records


def test_a3_is_over_all_arms_of_the_model(tmp_path: Path) -> None:
    """15 of 20 after 365 d with 95 %: 230.84604619 d, as suncal's documentation prints it."""
    records = with_tests(tmp_path, 4, 5)
    records.register("other", model="Quantum")
    records.add(verification(tmp_path / "o.json", 2.0, "fail"), arm="other", at="2001-01-01")
    records.interval("P0", 365.0)
    found = records.advise("P0", "a3")
    assert found.n == 20
    assert found.days == pytest.approx(230.84604619, abs=5e-9)
    assert records.advise("other", "a3").days is None  # one test is too few


def test_staircase_is_of_the_last_test(tmp_path: Path) -> None:
    records = with_tests(tmp_path, 1, 0)
    found = records.advise("P0", "staircase")
    last = records.figures("P0", records.series("P0")[0].name)[-1]
    assert last.limit is not None
    share = abs(last.value) / last.limit
    assert found.now_days == pytest.approx(365.0)
    assert found.days == pytest.approx(365.0 * (1.25 if share <= 0.8 else 0.5 if share > 1.0 else 1.0))


def test_a_decision_is_kept_and_due(tmp_path: Path) -> None:
    records = with_tests(tmp_path, 1, 0)
    records.interval("P0", 200.0, "staircase", "as the method says")
    (due,) = records.due("2019-08-01")
    assert (due.due, due.days) == ("2019-07-20", -12)
    for days in (0.0, float("nan"), 1e9):
        with pytest.raises(UlnaInputError, match="expected 1 to 36525"):
            records.interval("P0", days)
