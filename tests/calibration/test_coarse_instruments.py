"""What is poor: what the user states decides, then chi², and a part of the reach only where neither speaks."""

from dataclasses import replace

import numpy as np
import pytest
from tests.oracle import fits, virtual
from tests.oracle.core import core_problem, nothing_held
from tests.oracle.published import table_4
from tests.small_study import SmallStudy, says

import ulna._core as _core
from ulna.ground.errors import UlnaInputError
from ulna.study.options import with_options

ENCODER_RAD = 1e-6


def seen_by_a_camera(sigma_mm, seed, count=150):
    """The arm and its tips in exact poses, as a camera in a frame of its own sees them."""
    truth, rng = table_4(), np.random.default_rng(seed)
    exact = virtual.coordinates(truth, rng, count, placed=True)
    return truth, replace(exact, features_mm=exact.features_mm + sigma_mm * rng.standard_normal((count, 3)))


def stated(truth, sigma_mm):
    return fits.Noise(np.full(truth.joints, ENCODER_RAD), sigma_mm)


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("sigma_mm", [0.01, 1.0, 5.0, 20.0])
def test_a_fit_that_the_stated_noise_explains_is_good_however_coarse_it_is(sigma_mm, seed):
    truth, seen = seen_by_a_camera(sigma_mm, seed)
    found = _core.fit(core_problem(truth, [seen], stated(truth, sigma_mm)), nothing_held(truth))
    # of chi² with ν degrees: 1 ± √(2/ν)
    assert found.chi2_per_dof == pytest.approx(1.0, abs=5.0 * np.sqrt(2.0 / found.degrees_of_freedom))
    assert found.converged
    # and from where it is, nothing needs to be searched
    assert found.searched_starts == 0


@pytest.mark.parametrize("sigma_mm", [5.0, 20.0])
def test_without_a_stated_noise_such_a_fit_is_poor_unless_the_user_says_what_is(sigma_mm):
    truth, seen = seen_by_a_camera(sigma_mm, 3)

    def fit(above_mm):
        return _core.fit(core_problem(truth, [seen]), nothing_held(truth), search_starts=3, poor_above_mm=above_mm)

    left_mm = fit(10.0 * sigma_mm).rms_mm
    # the start is the truth: the minimum is the same, and poor or not is all that differs
    for above_mm in (None, 0.99 * left_mm, 1.01 * left_mm):
        found = fit(above_mm)
        assert found.converged == (above_mm is not None and above_mm > left_mm), above_mm
        assert found.rms_mm == pytest.approx(left_mm, rel=1e-6)


def test_a_noise_that_explains_nothing_outranks_nothing():
    """5 mm where 1 mm is stated: chi² 25."""
    truth, seen = seen_by_a_camera(5.0, 4)
    found = _core.fit(core_problem(truth, [seen], stated(truth, 1.0)), nothing_held(truth), search_starts=3)
    assert found.chi2_per_dof == pytest.approx(25.0, rel=0.3)
    assert found.termination == "poor-minimum"
    # what the user says of the length goes before what chi² says
    found = _core.fit(core_problem(truth, [seen], stated(truth, 1.0)), nothing_held(truth), poor_above_mm=20.0)
    assert found.converged


def test_a_wrong_arm_is_poor_with_its_noise_stated():
    """The places seen are mixed up: no arm explains that, and chi² says so."""
    truth, seen = seen_by_a_camera(1.0, 5)
    shuffled = replace(seen, features_mm=np.random.default_rng(5).permutation(seen.features_mm))
    found = _core.fit(core_problem(truth, [shuffled], stated(truth, 1.0)), nothing_held(truth), search_starts=3)
    assert found.termination == "poor-minimum"


def test_the_key_is_a_length_in_the_studys_unit(tmp_path):
    small = SmallStudy(tmp_path)
    assert small.load()[0].fit.poor_above_mm is None
    small.swap("study.toml", "[fit]\n", "[fit]\npoor_above = 2.5\n")
    assert small.load()[0].fit.poor_above_mm == 2.5
    small.swap("study.toml", 'length = "mm"', 'length = "in"')
    assert small.load()[0].fit.poor_above_mm == pytest.approx(2.5 * 25.4)
    for wrong in ("0", "-1", "true", "inf"):
        small.write("study.toml", small.path.read_text().replace("poor_above = 2.5", f"poor_above = {wrong}"))
        says(small.error(), "key 'fit.poor_above'")
        small.write("study.toml", small.path.read_text().replace(f"poor_above = {wrong}", "poor_above = 2.5"))


@pytest.mark.parametrize("wrong", [0.0, -1.0, float("nan"), float("inf")])
def test_from_python_it_has_the_same_limits(tmp_path, wrong):
    study, _ = SmallStudy(tmp_path).load()
    with pytest.raises(UlnaInputError, match=r"key 'fit.poor_above_mm'.*positive"):
        with_options(study, poor_above_mm=wrong)
