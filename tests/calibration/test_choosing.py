"""A model that chooses itself: blocks that are there are found, those that are not do no harm, nothing leaks."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.calibration.test_extras_judged import eccentric, study_of
from tests.cli_runs import platinum

import ulna
from ulna.calibration.choosing import trying
from ulna.calibration.choosing.choose import choose
from ulna.calibration.choosing.groups import FEWEST_OF_PART, MOST_READINGS, groups_of, regions, thinned
from ulna.calibration.choosing.models import HARMONICS, allowed
from ulna.calibration.choosing.rule import compared
from ulna.calibration.figures import overall_figures
from ulna.study.data import FitOptions, Prior
from ulna.study.study import Study


def of_eccentric(rad: float, **fit: Any) -> Study:
    return study_of(eccentric(rad), platinum(wrong=0.3), **fit)


def test_harmonics_that_are_there_are_found() -> None:
    result = ulna.calibrate(of_eccentric(3e-4, extras="auto"))
    assert result.chosen is not None
    assert HARMONICS in result.chosen.extras
    assert result.chosen.by == "placements"
    assert [each.kept for each in result.chosen.tried].count(True) == 1
    assert result.fit.rms_mm < 0.02
    truth = eccentric(3e-4)
    q = np.random.default_rng(8).uniform(-2.0, 2.0, (50, 7))
    # what the base frame is, nobody tells: distances between the tips are compared
    found, right = (np.linalg.norm(np.diff(arm.tip(q), axis=0), axis=1) for arm in (result.arm, truth))
    assert np.abs(found - right).max() < 0.02


def test_where_there_are_none_nothing_is_lost() -> None:
    """Errors of readings of the same arm that nobody fitted, within 2 % of those of geometry alone."""
    study, fresh = of_eccentric(0.0), study_of(platinum(), platinum(wrong=0.3), noise_mm=0.0)
    plain, auto = ulna.calibrate(study), ulna.calibrate(study, extras="auto")
    one, other = (overall_figures(found.arm, fresh)["coordinate_error_mean_mm"] for found in (plain, auto))
    assert other <= 1.02 * one + 1e-6


def test_the_same_each_time_and_in_the_file(tmp_path: Path) -> None:
    study = of_eccentric(2e-4, extras="auto")
    first, again = choose(study).model, choose(study).model
    assert [replace(each, seconds=0.0) for each in first.tried] == [replace(each, seconds=0.0) for each in again.tried]
    assert first.harmonics == again.harmonics
    result = ulna.calibrate(study)
    result.save(tmp_path)
    assert ulna.Result.load(tmp_path).chosen == result.chosen
    assert result.provenance["options"]["auto"] is True


def test_the_budget_ends_the_search_and_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = choose(of_eccentric(3e-4, extras="auto")).model
    monkeypatch.setattr(trying, "BUDGET", 1.2e9)
    part = choose(of_eccentric(3e-4, extras="auto")).model
    assert whole.ended == "all-tried"
    assert part.ended == "budget"
    assert len(part.tried) + part.untried == len(whole.tried)
    assert part.tried[0].extras == []


def test_what_is_left_out_has_no_say(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each fold chooses from its training rows alone."""
    seen: list[int] = []
    real = choose

    def counted(study: Study, progress: object = None) -> object:
        seen.append(sum(len(group) for group in study.readings))
        return real(study)

    monkeypatch.setattr("ulna.calibration.cross_validate.choose", counted)
    ulna.cross_validate(of_eccentric(3e-4, extras="auto"))
    assert seen == [200] * 6


def test_one_standard_error() -> None:
    """Of what cannot be told from the best, the most blocks; never what is worse than geometry alone."""
    errors = np.array([[1.0, 1.2, 1.1], [0.5, 0.9, 0.6], [0.5, 0.8, 0.65], [0.5, 0.85, 0.62], [0.9, 1.1, 1.0]])
    found = compared(errors, [0, 1, 1, 2, 3])
    assert found.best == 2
    assert found.chosen == 3
    assert found.worse[2] == 0.0
    assert found.error_mm[0] == pytest.approx((1.0 * 1.2 * 1.1) ** (1 / 3))
    # within one standard error of the best, which is geometry alone: still worse than it
    assert compared(np.array([[1.0, 1.0, 1.0], [1.3, 1.0, 0.8]]), [0, 1]).chosen == 0


def test_one_bad_group_does_not_outweigh_the_others() -> None:
    """Ratios, not millimetres: better by a tenth nine times, worse by a tenth where all err hundredfold."""
    alone = np.array([1.0] * 9 + [100.0])
    other = np.array([0.9] * 9 + [110.0])
    assert compared(np.array([alone, other]), [0, 1]).chosen == 1


def test_regions_are_of_near_equal_size_and_hold_together() -> None:
    q = np.random.default_rng(2).uniform(-2.0, 2.0, (203, 6))
    code = regions(q, 8)
    sizes = np.bincount(code)
    assert len(sizes) == 8
    assert sizes.max() - sizes.min() <= 1 + 203 // 64
    within = np.mean([q[code == k].std(axis=0).mean() for k in range(8)])
    assert within < 0.9 * q.std(axis=0).mean()


def test_a_single_standing_is_told_into_regions_and_few_readings_are_not() -> None:
    study = of_eccentric(3e-4)
    (group,) = study.readings
    one = replace(study, readings=[group.select(np.arange(240) < 40)])
    assert groups_of(one) is None
    assert choose(replace(one, fit=FitOptions(extras="auto"))).model.ended == "too-few"  # type: ignore[arg-type]
    whole = replace(study, readings=[replace(group, placement=np.array(["a"] * 240, dtype=object))])
    found = groups_of(whole)
    assert found is not None
    assert found.by == "regions of readings"
    assert found.count == 8
    assert len(found.standings) == 8


def test_parts_that_say_next_to_nothing_are_left_out_of_it() -> None:
    study = of_eccentric(3e-4)
    (group,) = study.readings
    two = np.array(["a"] * 238 + ["b"] * 2, dtype=object)
    found = groups_of(replace(study, readings=[replace(group, placement=two)]))
    assert found is not None
    assert sum(len(each) for each in found.study.readings) == 238
    for each in found.study.readings:
        assert np.bincount(each.placement_code).min() >= FEWEST_OF_PART


def test_blocks_that_a_study_does_not_allow_say_why() -> None:
    found, impossible = allowed(of_eccentric(3e-4))
    assert found == []
    assert "mass" in impossible["compliance"]
    assert "temperature" in impossible["link-expansion"]
    assert "base frame" in impossible["base-tilt"]


def test_what_the_study_states_of_amplitudes_stands() -> None:
    study = of_eccentric(3e-4, extras="auto", prior={"joint.*.[cs][0-9]*": Prior(1e-4)})
    choice = choose(study)
    assert all(each.fall is None and HARMONICS not in each.prior_u for each in choice.model.tried)
    assert list(choice.study.fit.prior)[-1] == "joint.*.[cs][0-9]*"


@pytest.mark.parametrize(
    ("fit", "said"),
    [
        ({"extras": "auto", "method": "annealing"}, "'auto' compares models by their derivatives"),
        ({"extras": ["auto"]}, "stands alone"),
        ({"extras": ["autoo"]}, "expected"),
    ],
)
def test_what_cannot_be_combined_is_said(fit: dict[str, Any], said: str) -> None:
    with pytest.raises(ulna.UlnaInputError, match=said):
        ulna.calibrate(of_eccentric(3e-4), **fit)


def test_very_many_readings_are_thinned() -> None:
    study = of_eccentric(3e-4)
    (group,) = study.readings
    many = replace(study, readings=[group.select(np.tile(np.arange(240), 40))])
    (fewer,) = thinned(many).readings
    # whole placements, and no fewer than can be left out one by one
    assert len(many.readings[0]) > MOST_READINGS
    assert len(np.unique(fewer.placement_code)) == 5
    assert len(fewer) == 5 * 1600
    assert thinned(study) is study
