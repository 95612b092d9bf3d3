"""Searches without derivatives end where Levenberg–Marquardt ends, on the paper's problem and from far away."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.oracle import virtual
from tests.oracle.chain import Chain
from tests.oracle.published import table_4
from tests.small_study import SmallStudy, says

import ulna
from ulna.arm.arm import Arm
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.readings import Readings
from ulna.calibration.estimators import search_box
from ulna.study.assembly import assemble
from ulna.study.data import FitOptions, Noise
from ulna.study.study import Study

METHODS = ["annealing", "evolution"]


def arm_of(chain: Chain) -> Arm:
    links = zip(chain.theta0_rad, chain.alpha_rad, chain.a_mm, chain.last, strict=True)
    joints = (*(Joint(*map(float, link)) for link in links), Joint())
    return Arm("virtual", joints, {"bent": Probe(*map(float, chain.tips_mm[0]))})


def papers_problem() -> Study:
    """Cheng, Wang and others (2011): the arm of Table 4, a bar of 443.172 mm in 101 places, from some way off."""
    rng = np.random.default_rng(2011)
    bar = virtual.bars(table_4(), rng, 101, 443.172, virtual.Touches(5e-6, 0.008))
    count = 101
    readings = Readings(
        Artefact("bar", "length", {}),
        bar.q_rad[0::2].copy(),
        bar.q_rad[1::2].copy(),
        np.full(count, 443.172),
        np.zeros(count, np.int64),
        np.zeros(count, np.int64),
        np.array([str(k) for k in range(count)], dtype=object),
        np.arange(1, count + 1),
        np.zeros(count, np.int64),
    )
    start = virtual.wrong_start(table_4(), rng, 0.5, 60.0)
    return Study(None, arm_of(start), [readings], Noise(np.full(7, 5e-6), 0.008))


@pytest.fixture(scope="module")
def study() -> Study:
    return papers_problem()


@pytest.fixture(scope="module")
def by_lm(study: Study) -> ulna.Result:
    return ulna.calibrate(study)


@pytest.mark.parametrize("method", METHODS)
def test_each_reaches_the_optimum(study: Study, by_lm: ulna.Result, method: str) -> None:
    result = ulna.calibrate(study, method=method)
    assert result.fit.converged
    assert result.fit.method == method
    assert 1000 < result.fit.box_evaluations <= 130_000  # a population is finished that has begun
    assert result.fit.searched_starts == 0  # no other search helped
    assert result.fit.cost == pytest.approx(by_lm.fit.cost, rel=1e-9)
    u = np.array([row.u or 1.0 for row in by_lm.parameters])
    ours, theirs = (np.array([row.value for row in found.parameters]) for found in (result, by_lm))
    assert (abs(ours - theirs) / u).max() < 1e-3
    for ours_row, theirs_row in zip(result.parameters, by_lm.parameters, strict=True):
        assert ours_row.start == theirs_row.start
        assert (ours_row.u or 0.0) == pytest.approx(theirs_row.u or 0.0, rel=1e-4)


@pytest.mark.parametrize("method", METHODS)
def test_the_search_itself_comes_near(study: Study, method: str) -> None:
    """Not the finish alone: the search brings the rms of lengths from 170 mm to a few millimetres."""
    searched_study = replace(study, fit=FitOptions(method=method, seed=1))  # type: ignore[arg-type]
    assembled = assemble(searched_study)
    begun = search_box(replace(searched_study, fit=replace(searched_study.fit, budget=100)), assembled)
    found = search_box(searched_study, assembled)
    rms = [np.sqrt(each.cost / 101) for each in (begun, found)]
    assert rms[1] < 0.05 * rms[0]
    assert rms[1] < {"annealing": 400.0, "evolution": 1.5}[method]  # in units of the noise, hundredths of a millimetre


@pytest.mark.parametrize("method", METHODS)
def test_a_seed_gives_one_answer(study: Study, method: str) -> None:
    options = FitOptions(method=method, budget=3000, seed=5)  # type: ignore[arg-type]
    assembled = assemble(study)
    one, two, other = (
        search_box(replace(study, fit=replace(options, seed=seed)), assembled).parameters for seed in (5, 5, 6)
    )
    np.testing.assert_array_equal(one, two)
    assert abs(one - other).max() > 0


@pytest.mark.parametrize("method", METHODS)
def test_held_parameters_stay_and_the_box_is_kept(study: Study, method: str) -> None:
    options = FitOptions(
        method=method,  # type: ignore[arg-type]
        budget=2000,
        hold=["joint.3.*", "joint.1.theta0"],
        box_length_mm=5.0,
        box_angle_rad=0.01,
        box_offset_rad=0.02,
    )
    limited = replace(study, fit=options)
    assembled = assemble(limited)
    found = search_box(limited, assembled).parameters - assembled.problem.parameters
    units = np.array(assembled.units)
    assert not found[assembled.hold].any()
    assert abs(found[units == "mm"]).max() <= 5.0
    assert abs(found[units == "rad"]).max() <= 0.02
    assert (found != 0).sum() >= 20


def test_progress_and_budget(study: Study) -> None:
    told: list[tuple[str, int, int]] = []
    assembled = assemble(study)
    options = FitOptions(method="annealing", budget=2500)
    found = search_box(replace(study, fit=options), assembled, lambda *args: told.append(args))
    assert found.evaluations <= 2500 + 60  # one chain of moves is finished that has begun
    assert {stage for stage, _, _ in told} == {"annealing"}
    done = [count for _, count, _ in told]
    assert done == sorted(done)
    assert {total for _, _, total in told} == {2500}


def test_nothing_to_search_is_told(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    small.swap("study.toml", 'hold = ["joint.1.theta0"]', 'hold = ["*"]\nmethod = "evolution"')
    study, _ = small.load()
    with pytest.raises(ulna.UlnaInputError) as raised:
        ulna.calibrate(study)
    says(str(raised.value), "'fit.method': 'evolution' searches the geometry", "hold all of it", 'method "lm"')
