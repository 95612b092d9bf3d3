"""Two calibrations of an arm that has not moved differ by what their uncertainties say; of one that has, by more."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

import ulna
from ulna import Result, Study
from ulna.arm.arm import Arm
from ulna.arm.reading_noise import UNKNOWN
from ulna.calibration.recalibrations import recalibrations
from ulna.comparison.compare import Compared, compare
from ulna.comparison.determined import Determined, determined
from ulna.comparison.pair import Calibrated, pair
from ulna.comparison.poses import lengths
from ulna.ground.errors import UlnaInputError

PAIRS = 1000


@pytest.fixture(scope="module")
def study(root: Path) -> Study:
    return Study.load(root / "examples" / "platinum" / "study.toml")


@pytest.fixture(scope="module")
def truth(study: Study) -> Arm:
    return ulna.calibrate(study).arm


def known(arm: Arm, parameters: np.ndarray, of: Result) -> Calibrated:
    return Calibrated(
        "a calibration", replace(arm.with_parameters(parameters), uncertainty=of.arm.uncertainty), UNKNOWN
    )


def of_pairs(result: Result, parameters: np.ndarray, shared_u: float = 0.0) -> list[Determined]:
    """Of (2 K, P) calibrations, one after the other."""
    found = []
    for one, other in parameters.reshape(-1, 2, parameters.shape[1]):
        both = pair(known(result.arm, one, result), known(result.arm, other, result), shared_u=shared_u)
        found.append(determined(both, lengths(both, 200)))
    return found


def test_of_an_arm_that_has_not_moved_chi2_is_distributed_as_chi2(study: Study, truth: Arm) -> None:
    """1000 pairs, whose covariance is that of one calibration: Kolmogorov and Smirnov find nothing."""
    result = ulna.calibrate(study)
    drawn = recalibrations(study, truth, 2 * PAIRS, seed=11)
    found = of_pairs(result, drawn.parameters[drawn.converged][: 2 * PAIRS])
    assert {each.rank for each in found} == {25}
    assert stats.kstest([each.chi2 for each in found], stats.chi2(25).cdf).pvalue > 0.01
    assert np.mean([each.p_value < 0.05 for each in found]) == pytest.approx(0.05, abs=0.022)  # three sigma
    u = np.array([each.u for each in found]).mean(axis=0)
    scatter = np.array([each.delta for each in found]).std(axis=0)
    seen = u > 1e-3 * u.max()
    np.testing.assert_allclose(scatter[seen], u[seen], rtol=0.1)


def test_the_error_of_an_artefact_of_both_cancels(study: Study, truth: Arm) -> None:
    """The same bar, wrong by as much in both: with it stated χ² is χ², and a difference is seen sooner."""
    u_mm, rng = 0.02, np.random.default_rng(7)
    bar = study.readings[0].artefact
    length = bar.features["B"][0]
    uncertain = replace(study, readings=[replace(g, artefact=replace(bar, u_mm=u_mm)) for g in study.readings])
    result = ulna.calibrate(uncertain)
    drawn = recalibrations(study, truth, 600, seed=12)  # with bars as long as they are stated
    factor = np.repeat(1.0 + rng.normal(0.0, u_mm / length, 300), 2)  # each pair by a bar of its own
    units = np.array(truth.parameter_units)
    grown = np.where(units == "mm", drawn.parameters * factor[:, None], drawn.parameters)
    grown[:, truth.parameter_names.index("joint.1.d")] = truth.parameters[truth.parameter_names.index("joint.1.d")]
    stated = of_pairs(result, grown, u_mm / length)
    unsaid = of_pairs(result, grown)
    assert stats.kstest([each.chi2 for each in stated], stats.chi2(stated[0].rank).cdf).pvalue > 0.01
    gained = np.array([one.chi2 - other.chi2 for one, other in zip(stated, unsaid, strict=True)])
    assert (gained > -1e-9).all()
    assert 0.5 < gained.mean() < 1.0  # of one combination, the arm's scale, most is the bar's


def moved_by(study: Study, truth: Arm, names: dict[str, float], seed: int = 3) -> Compared:
    """Two calibrations, the arm having moved in between."""
    later = truth.parameters.copy()
    for name, step in names.items():
        later[truth.parameter_names.index(name)] += step
    moved = truth.with_parameters(later)
    result = ulna.calibrate(study)
    one = recalibrations(study, truth, 1, seed=seed).parameters[0]
    other = recalibrations(study, moved, 1, seed=seed + 1).parameters[0]
    arms = [known(result.arm, each, result).arm for each in (one, other)]
    return compare(*arms).steps[0]


def test_what_has_moved_is_named(study: Study, truth: Arm) -> None:
    said = moved_by(study, truth, {"joint.4.theta0": 200e-6})
    assert said.moved
    assert said.p_value < 1e-6
    top = said.parameters[0]
    assert top.name == "joint.4.theta0"
    assert top.delta == pytest.approx(200e-6, abs=4 * top.u)
    assert said.largest is not None
    assert abs(said.largest.largest_mm) > said.largest.expanded_mm


def test_a_move_of_the_base_is_none(study: Study, truth: Arm) -> None:
    """The same arm set up anew: every zero of joint 1 and every height is as good as another."""
    said = moved_by(study, truth, {"joint.1.theta0": 0.3, "joint.1.d": 25.0})
    still = moved_by(study, truth, {})
    assert not still.moved
    assert not said.moved
    assert said.chi2 == pytest.approx(still.chi2, rel=0.1)


def test_a_zero_a_whole_turn_away_is_the_same_arm(study: Study) -> None:
    result = ulna.calibrate(study)
    turned = result.arm.parameters.copy()
    turned[result.arm.parameter_names.index("joint.3.theta0")] += 2.0 * np.pi
    said = compare(result, known(result.arm, turned, result).arm).steps[0]
    assert not said.moved
    assert said.chi2 == pytest.approx(0.0, abs=1e-6)


def test_no_more_of_an_artefact_is_shared_than_is_in_the_calibrations(study: Study) -> None:
    result = ulna.calibrate(study)
    with pytest.raises(UlnaInputError, match=r"shared u 0\.001: calibration 1 knows its own lengths better"):
        compare(result, result, shared_u=1e-3)


def test_what_cannot_be_compared_is_told(study: Study, truth: Arm) -> None:
    result = ulna.calibrate(study)
    with pytest.raises(UlnaInputError, match="got 1 calibration; expected 2 to 6"):
        compare(result)
    with pytest.raises(UlnaInputError, match="an arm without its calibration"):
        compare(result, replace(truth, uncertainty=None))
    with pytest.raises(UlnaInputError, match="--probe: got 'none', expected one that both have: bent"):
        compare(result, result, probe="none")
    with pytest.raises(UlnaInputError, match="none of its probes"):
        compare(result, replace(result.arm, probes={"other": result.arm.probes["bent"]}))
    other = ulna.calibrate(study, extras=["encoder-harmonics"])
    with pytest.raises(UlnaInputError, match="only one of them has joint"):
        compare(result, other)
