"""What is stated of an arm holds on readings that it has not seen, and where it does not it is said.

Arms are simulated, so that the truth is known; a hundred and more touches of a plate, or lengths between them, are
judged by calibrations whose study stated the right noise, none, half of it, or twice.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from tests.cli_runs import platinum
from tests.simulations import true_arm

import ulna
from ulna import Arm, Study
from ulna.arm.covariance import ParameterCovariance
from ulna.arm.reading_noise import UNKNOWN, ReadingNoise
from ulna.calibration.coverage import Coverage, Judged, P
from ulna.calibration.held_out import judged
from ulna.simulation.file import load_simulation
from ulna.study.data import Noise

ENCODER_RAD, SEAT_MM = 5e-6, 0.008
ARMS = 16
SPEC = f"""\
format = "ulna-simulation/1"
arm = "true.toml"
units = {{ length = "mm", angle = "rad" }}
drawing = "exact"
noise = {{ encoder = {ENCODER_RAD}, seat = {SEAT_MM} }}
"""
BAR = '[artefact.bar]\nkind = "bar"\nlength = 443.172\nplacements = 70\n'
PLATE = """\
[artefact.plate]
kind = "points"
features = { a = [0, 0, 0], b = [300, 0, 0], c = [0, 200, 0], d = [300, 200, 40], e = [150, 100, 90] }
placements = 6
"""

Pair = tuple[Study, Study]


@pytest.fixture(scope="module")
def pairs(tmp_path_factory: pytest.TempPathFactory) -> list[Pair]:
    """Of one true arm, with fresh noise each: readings of a bar, and of a plate in other places."""
    folder = tmp_path_factory.mktemp("simulated")
    true_arm().save(folder / "true.toml")

    def simulated(name: str, artefact: str, seed: int) -> Study:
        (folder / name).write_text(SPEC + artefact)
        return ulna.simulate(replace(load_simulation(folder / name), seed=seed)).study

    return [(simulated("bar.toml", BAR, k), simulated("plate.toml", PLATE, 100 + k)) for k in range(ARMS)]


def stated(factor: float | None) -> Noise | None:
    return None if factor is None else Noise(np.full(7, factor * ENCODER_RAD), factor * SEAT_MM)


def held(pairs: Sequence[Pair], factor: float | None) -> Judged:
    found = []
    for bar, plate in pairs:
        result = ulna.calibrate(replace(bar, noise=stated(factor)))
        assert result.fit.converged
        found.append(judged(result.arm, result.noise, plate))
    return Judged.together(found)


@pytest.mark.slow
@pytest.mark.parametrize("factor", [1.0, None, 0.5, 2.0])
def test_intervals_hold_whatever_was_stated(pairs: list[Pair], factor: float | None) -> None:
    """480 points and 192 lengths, of which those of one plate share the errors of the arm."""
    found = held(pairs, factor).coverage()
    assert found.points is not None
    assert found.lengths is not None
    assert (found.points.count, found.lengths.count) == (ARMS * 30, ARMS * 12)
    assert 0.92 <= found.points.share <= 0.98
    assert 0.92 <= found.lengths.share <= 0.98
    assert not found.too_small


@pytest.mark.slow
def test_errors_of_lengths_are_as_large_as_is_expected(pairs: list[Pair]) -> None:
    """What is expected of them, root mean square, is what they are: half as much, or twice, would be seen."""
    found = held(pairs, 1.0)
    errors_mm, u_mm = found.errors_mm.T
    assert len(errors_mm) == len(found.lengths) == ARMS * 12
    assert np.sqrt((errors_mm**2).mean()) == pytest.approx(np.sqrt((u_mm**2).mean()), rel=0.15)
    assert np.allclose(np.abs(errors_mm) / u_mm, found.lengths * 1.96, rtol=0.02)


TOUCHES = 12
PAIRS_OF_FIVE = list(combinations(range(5), 2))


def touched(truth: Arm, rng: np.random.Generator) -> Study:
    """Points of a tracker, where a true arm's tip was, each off by a touch's noise, the tracker standing anywhere."""
    q_rad = rng.uniform(-1.5, 1.5, (TOUCHES, 7))
    at_mm = truth.tip(q_rad) + SEAT_MM * rng.standard_normal((TOUCHES, 3))
    turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    seen_mm = at_mm @ (turn * np.linalg.det(turn)) + rng.uniform(-1e3, 1e3, 3)
    frame = {"q": q_rad, **{f"{axis}_mm": seen_mm[:, k] for k, axis in enumerate("xyz")}}
    return Study.from_frame(truth, frame, {"tracker": {"kind": "points"}}, angle="rad", placement="there")


def test_a_covariance_that_is_right_holds_and_half_of_it_is_too_small_by_two() -> None:
    """Arms drawn from a covariance, touches from a noise; nothing is fitted but where the tracker stood."""
    rng = np.random.default_rng(5)
    arm = platinum()
    scale = np.where(np.array(arm.parameter_units) == "rad", 3e-5, 1e-2)
    root = scale[:, None] * rng.standard_normal((len(scale), len(scale))) / len(scale) ** 0.5

    def known(part: float) -> tuple[Arm, ReadingNoise]:
        matrix = part**2 * root @ root.T
        covariance = ParameterCovariance(list(arm.parameter_names), matrix, [])
        return replace(arm, uncertainty=covariance), ReadingNoise(seat_mm=part * SEAT_MM)

    drawn = [arm.with_parameters(arm.parameters + root @ rng.standard_normal(len(scale))) for _ in range(80)]
    checks = [touched(truth, rng) for truth in drawn]
    right, half = (Judged.together([judged(*known(part), check) for check in checks]) for part in (1.0, 0.5))
    assert (len(right.points), len(right.lengths)) == (80 * TOUCHES, 80 * TOUCHES // 2)
    assert (right.points <= 1.0).mean() == pytest.approx(P, abs=0.025)
    assert (right.lengths <= 1.0).mean() == pytest.approx(P, abs=0.025)
    np.testing.assert_allclose(half.points, 2.0 * right.points, rtol=1e-6)
    np.testing.assert_allclose(half.lengths, 2.0 * right.lengths, rtol=1e-6)
    told = half.coverage(["blocks"])
    assert told.likely == ["blocks"]
    assert told.too_small == pytest.approx({"points": 2.0, "lengths": 2.0}, rel=0.12)
    assert right.coverage(["blocks"]) == right.coverage()


def test_intervals_much_too_wide_are_called_so() -> None:
    wide = np.linspace(0.0, 0.3, 200)
    found = Judged(wide, wide).coverage(["blocks"])
    assert (found.too_small, found.likely) == ({}, [])
    assert found.too_large == pytest.approx(0.285)
    some = Judged(wide, np.linspace(0.0, 1.0, 200)).coverage()
    assert some.too_large is None


def test_of_few_no_factor_is_said() -> None:
    found = Judged(np.full(8, 3.0), np.zeros(0)).coverage()
    assert found.points is not None
    assert (found.points.factor, found.lengths) == (None, None)
    assert found.too_small == {"points": 1.0}


def test_of_two_touches_one_error_is_left(pairs: list[Pair]) -> None:
    """A bar touched once at each end: its two ends are off by the same, so that one is counted, as its length is."""
    bar, _ = pairs[0]
    result = ulna.calibrate(bar)
    found = judged(result.arm, result.noise, pairs[1][0])
    assert len(found.points) == len(found.lengths) == 70
    np.testing.assert_allclose(found.points, found.lengths, rtol=1e-3)


def test_nothing_is_judged_where_nothing_is_known(pairs: list[Pair]) -> None:
    """Of an arm file, of an arm without what its calibration knew of the readings, of a calibration without any u."""
    bar, plate = pairs[0]
    result = ulna.calibrate(bar)
    assert ulna.evaluate(result, plate).coverage is not None
    assert ulna.evaluate(replace(result.arm, uncertainty=None), plate).coverage is None
    assert judged(result.arm, UNKNOWN, plate).coverage() == Coverage(None, None)
    nothing = ParameterCovariance(["joint.2.a"], np.full((1, 1), np.nan), [])
    assert judged(replace(result.arm, uncertainty=nothing), result.noise, plate).coverage() == Coverage(None, None)


def test_a_saved_result_is_judged_as_the_one_in_memory(pairs: list[Pair], tmp_path: Path) -> None:
    """The file brings the scatter along, for a command too."""
    bar, plate = pairs[0]
    result = ulna.calibrate(replace(bar, noise=None))
    result.save(tmp_path / "out")
    in_memory, from_file = ulna.evaluate(result, plate), ulna.evaluate(tmp_path / "out", plate)
    assert in_memory.coverage == from_file.coverage
    cross = ulna.cross_validate(replace(bar, noise=None), 5)
    assert cross.coverage is not None
    assert cross.coverage.lengths is not None
    assert cross.coverage.lengths.count == 70
    document = cross.as_dict()["coverage"]
    assert document["lengths"]["inside"] == cross.coverage.lengths.inside


@pytest.mark.slow
@pytest.mark.parametrize("factor", [None, 0.5])
def test_measured_lengths_have_the_scatter_in_their_u(pairs: list[Pair], factor: float | None) -> None:
    """`measure`, of a plate's touches by their angles alone, against its own distances: ten of each standing."""
    ratios = []
    for bar, plate in pairs:
        result = ulna.calibrate(replace(bar, noise=stated(factor)))
        measured = ulna.measure(result, plate.readings[0].q_rad, "bent")
        assert result.noise.variance_mm2 > (0.7 * SEAT_MM) ** 2
        at_mm = np.array(list(plate.readings[0].artefact.features.values()))
        first, second = (np.array(ends) for ends in zip(*PAIRS_OF_FIVE, strict=True))
        for standing in range(6):
            lengths_mm, u_mm = measured.lengths(5 * standing + first, 5 * standing + second)
            assert u_mm is not None
            assert (u_mm**2 > 2.0 * result.noise.variance_mm2).all()  # of both touches alone
            ratios.append((lengths_mm - np.linalg.norm(at_mm[first] - at_mm[second], axis=1)) / u_mm)
    within = np.abs(np.concatenate(ratios)) <= 1.99  # t of some 70 degrees of freedom
    assert len(within) == 60 * ARMS
    assert 0.92 <= within.mean() <= 0.98
