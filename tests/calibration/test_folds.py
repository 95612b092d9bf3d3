"""Which readings are left out together: every reading once, and what stands together stays together."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from ulna.artefacts.artefact import Artefact
from ulna.artefacts.readings import Readings
from ulna.calibration.folds import Fold, folds
from ulna.ground.errors import UlnaInputError
from ulna.study.data import FitOptions
from ulna.study.study import Study

ARM: Any = SimpleNamespace()
BAR = Artefact("bar", "bar", {"A": (0.0, 0.0, 0.0), "B": (100.0, 0.0, 0.0)}, length_mm=100.0)
CONE = Artefact("cone", "seat", {"seat": (0.0, 0.0, 0.0)})
GRID = Artefact("grid", "points", {"s": (0.0, 0.0, 0.0)}, frame="arm")


def group(artefact: Artefact, placement: list[str]) -> Readings:
    rows = len(placement)
    zeros = np.zeros(rows, dtype=np.int64)
    return Readings(
        artefact, np.zeros((rows, 2)), None, None, zeros, zeros, np.array(placement, dtype=object), zeros, zeros
    )


def study(*groups: Readings, seed: int = 0) -> Study:
    return Study(None, ARM, list(groups), fit=FitOptions(seed=seed))


def assert_each_reading_once(found: list[Fold]) -> None:
    for masks in zip(*(fold.masks for fold in found), strict=True):
        assert (np.sum(masks, axis=0) == 1).all()


def test_by_placement_each_standing_of_each_artefact() -> None:
    how, found = folds(study(group(BAR, ["p", "p", "r", "r"]), group(CONE, ["p", "p"])), "placement")
    assert how == "placement"
    assert [fold.name for fold in found] == ["bar/p", "bar/r", "cone/p"]
    assert [fold.rows for fold in found] == [2, 2, 2]
    assert_each_reading_once(found)


def test_by_artefact() -> None:
    _, found = folds(study(group(BAR, ["p", "p"]), group(CONE, ["p"])), "artefact")
    assert [(fold.name, fold.rows) for fold in found] == [("bar", 2), ("cone", 1)]
    assert_each_reading_once(found)


def test_folds_keep_placements_whole() -> None:
    placement = [str(k // 4) for k in range(40)]
    how, found = folds(study(group(BAR, placement)), 5)
    assert how == "5 folds of placements"
    assert [fold.rows for fold in found] == [8] * 5
    assert_each_reading_once(found)
    for fold in found:
        assert all(np.sum(fold.masks[0][np.array(placement) == label]) in (0, 4) for label in set(placement))


def test_folds_of_readings_where_no_placement_is_fitted_or_there_are_few() -> None:
    how, found = folds(study(group(GRID, ["1"] * 21)), 4)
    assert how == "4 folds of placements"  # each reading stands alone in the arm's frame
    assert sorted(fold.rows for fold in found) == [5, 5, 5, 6]
    how, found = folds(study(group(CONE, ["1"] * 21)), 4)
    assert how == "4 folds of readings"
    assert_each_reading_once(found)


@pytest.mark.parametrize("count", [1, 4, 6])
def test_more_folds_than_placements_are_refused_not_dealt_from_single_readings(count: int) -> None:
    # a bar that loses one end has no length any more: nothing would be judged in most folds
    bars = study(group(BAR, ["p", "p", "r", "r", "s", "s"]))
    with pytest.raises(UlnaInputError, match=rf"{count} folds of 3 placements; expected a number from 2 to 3\."):
        folds(bars, count)
    assert [fold.rows for fold in folds(bars, 3)[1]] == [2, 2, 2]


def test_one_placement_of_a_bar_is_not_torn_apart() -> None:
    bar = study(group(BAR, ["p"] * 8))
    with pytest.raises(UlnaInputError, match=r"2 folds of 1 placement; .*Measure more placements"):
        folds(bar, 2)
    with pytest.raises(UlnaInputError, match="all of one placement") as caught:
        folds(bar, "placement")
    assert "Or deal" not in str(caught.value)


def test_folds_follow_the_seed() -> None:
    cone = group(CONE, ["1"] * 30)
    first, again, other = (folds(study(cone, seed=seed), 3)[1][0].masks[0] for seed in (1, 1, 2))
    assert (first == again).all()
    assert (first != other).any()


@pytest.mark.parametrize(
    ("by", "expected"),
    [("placement", "all of one placement"), ("artefact", "all of one artefact"), ("plate", "expected 'placement'")],
)
def test_nothing_to_leave_out_is_told(by: str, expected: str) -> None:
    with pytest.raises(UlnaInputError, match=expected):
        folds(study(group(CONE, ["1"] * 5)), by)


@pytest.mark.parametrize("count", [0, 1, 6, -3])
def test_impossible_counts_of_folds_are_told(count: int) -> None:
    with pytest.raises(UlnaInputError, match="expected a number from 2 to 5"):
        folds(study(group(CONE, ["1"] * 5)), count)
