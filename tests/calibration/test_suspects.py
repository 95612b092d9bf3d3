"""After a fit that ended badly, what would explain the readings is told, and only then."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from tests.simulations import PLATE, saved, write

import ulna
from ulna import Study
from ulna.calibration.suspects import suspicion
from ulna.cli.printed.hints import where_to_look


def swapped(q: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(q[:, [0, 3, 2, 1, 4, 5, 6]])


def coupled(q: np.ndarray) -> np.ndarray:
    shown = q.copy()
    shown[:, 3] -= q[:, 1]
    return shown


def in_degrees(q: np.ndarray) -> np.ndarray:
    return q * np.pi / 180.0


def other_way(q: np.ndarray) -> np.ndarray:
    return q * np.array([1.0, 1.0, 1.0, -1.0, 1.0, 1.0, 1.0])


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> Study:
    folder = tmp_path_factory.mktemp("suspects")
    simulated, study = saved(write(folder, PLATE + "placements = 20\n"))
    return replace(study, arm=simulated.truth.arm)


def spoiled(study: Study, how: Callable[[np.ndarray], np.ndarray]) -> Study:
    held = replace(study.fit, hold=["joint.*"])  # so that no other arm explains it
    groups = [replace(group, q_rad=how(group.q_rad)) for group in study.readings]
    return replace(study, readings=groups, fit=held)


@pytest.mark.parametrize(
    ("how", "said"),
    [
        (swapped, "readings of joints 2 and 4 are swapped"),
        (coupled, "joint 4 turns with joint 2's encoder too"),
        (in_degrees, "in radians, not in degrees"),
        (other_way, "encoder of joint 4 counts the other way"),
    ],
    ids=lambda value: getattr(value, "__name__", ""),
)
def test_what_is_wrong_is_what_is_suspected(study: Study, how: Callable[[np.ndarray], np.ndarray], said: str) -> None:
    wrong = spoiled(study, how)
    result = ulna.calibrate(wrong)
    assert not result.fit.converged
    found = suspicion(wrong, result)
    assert found is not None
    assert said in found.if_so
    assert found.rms_mm < 0.05
    # and so it is: done as told, the fit ends well
    again = ulna.calibrate(found.study)
    assert again.fit.converged
    assert again.fit.rms_mm < 0.05


def test_noise_alone_is_not_explained_by_anything(study: Study) -> None:
    rng = np.random.default_rng(4)
    wrong = spoiled(study, lambda q: q + 0.1 * rng.standard_normal(q.shape))
    result = ulna.calibrate(wrong)
    assert not result.fit.converged
    assert suspicion(wrong, result) is None


def test_a_terminal_says_it(study: Study) -> None:

    wrong = spoiled(study, coupled)
    result = ulna.calibrate(wrong)
    text = where_to_look(result, suspicion(wrong, result))
    assert "coupling = { 2 = 1.0 } in the table of joint 4" in text
    assert "[noise] seat" not in text
