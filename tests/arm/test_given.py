"""The doors: whatever stands for an arm, a study or a result does so in every function that takes one."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import ulna
from ulna.arm.given import as_arm
from ulna.calibration.given import as_result
from ulna.exchange.export.dh import dh_table
from ulna.exchange.export.urdf import urdf_text
from ulna.study.given import as_study

PLATINUM = Path(__file__).resolve().parents[2] / "examples" / "platinum"


@pytest.fixture(scope="module")
def result() -> ulna.Result:
    return ulna.calibrate(PLATINUM / "study.toml")


@pytest.fixture(scope="module")
def folder(result: ulna.Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("out")
    result.save(place, force=True)
    return place


def arms(result: ulna.Result, folder: Path) -> dict[str, Any]:
    return {
        "an arm": result.arm,
        "a result": result,
        "a folder": folder,
        "a path": folder / "result.json",
        "a text": str(folder / "result.json"),
        "a loaded result": ulna.Result.load(folder),
    }


def test_every_way_gives_the_same_arm(result: ulna.Result, folder: Path) -> None:
    for name, given in arms(result, folder).items():
        found = as_arm(given)
        assert found.uncertainty is not None, name
        np.testing.assert_array_equal(found.parameters, result.arm.parameters)
        np.testing.assert_array_equal(found.uncertainty.matrix, result.arm.uncertainty.matrix)  # type: ignore[union-attr]
    plain = as_arm(folder / "arm.toml")
    np.testing.assert_array_equal(plain.parameters, result.arm.parameters)


FUNCTIONS: dict[str, Callable[[Any], Any]] = {
    "urdf_text": urdf_text,
    "dh_table": lambda arm: dh_table(arm, "dh", Path("arm")),
    "evaluate": lambda arm: ulna.evaluate(arm, PLATINUM / "check.toml").overall,
    "measure": lambda arm: ulna.measure(arm, np.full((2, 7), 0.3)).points_mm.tolist(),
    "measure a file": lambda arm: ulna.measure(arm, PLATINUM / "length.csv").table.select("x", "y", "z").rows(),  # type: ignore[union-attr]
}


@pytest.mark.parametrize("function", FUNCTIONS.values(), ids=FUNCTIONS)
def test_functions_take_all_of_them(function: Callable[[Any], Any], result: ulna.Result, folder: Path) -> None:
    expected = function(result.arm)
    for name, given in arms(result, folder).items():
        assert function(given) == expected, name


def test_a_result_brings_the_noise_that_its_study_stated(result: ulna.Result, folder: Path) -> None:
    q = np.full((1, 7), 0.3)
    of_arm, encoders = ulna.measure(result.arm, q), ulna.measure(result.arm, q, encoder_u_rad=5e-6)
    assert (of_arm.u_mm < encoders.u_mm).all()  # type: ignore[operator]
    assert [note.split(":")[0] for note in of_arm.notes] == ["How its readings scatter is not in the uncertainties"]
    touched_mm = np.sqrt(encoders.u_mm**2 + 0.008**2)  # type: ignore[operator]
    for given in (result, folder, ulna.Result.load(folder)):
        found = ulna.measure(given, q)
        np.testing.assert_allclose(found.u_mm, touched_mm, rtol=1e-12)  # type: ignore[arg-type]
        assert found.notes == []


def test_verify_takes_arms_in_memory(result: ulna.Result, folder: Path, tmp_path: Path) -> None:
    from ulna.verification.test_plan import play_test_plan

    play_test_plan("iso-10360-12", PLATINUM / "truth.toml").save(tmp_path / "test")
    found = [ulna.verify(tmp_path / "test" / "plan.toml", arm) for arm in (folder / "result.json", folder, result)]
    worst = [[f.worst.single.value_mm for state in each.states for f in state.figures.values()] for each in found]
    assert worst[0] == worst[1] == worst[2]
    assert all(each.arm == result.arm.name for each in found)


def test_uncertainty_takes_results_and_studies_of_every_kind(result: ulna.Result, folder: Path) -> None:
    task = PLATINUM / "length.toml"
    study = PLATINUM / "study.toml"
    first = ulna.uncertainty(folder, task, most_trials=0)
    for given in (result, folder / "result.json", ulna.Result.load(folder)):
        assert ulna.uncertainty(given, task, most_trials=0).values == first.values
    with pytest.raises(TypeError, match="got an Arm, expected a result"):
        ulna.uncertainty(result.arm, task)
    with pytest.raises(ulna.UlnaInputError, match="was not made from it"):
        ulna.uncertainty(result, task, study=PLATINUM / "check.toml", most_trials=0)
    assert ulna.uncertainty(result, task, study=study, most_trials=0).values == first.values


def test_every_way_gives_the_same_study(result: ulna.Result, tmp_path: Path) -> None:
    study = ulna.Study.load(PLATINUM / "study.toml")
    for given in (study, PLATINUM / "study.toml", str(PLATINUM / "study.toml"), PLATINUM, result):
        found = as_study(given)
        np.testing.assert_array_equal(found.readings[0].q_rad, study.readings[0].q_rad)
        assert ulna.identify(given).determined == 25
    assert ulna.calibrate(PLATINUM).parameters == result.parameters
    by_path, by_study = (ulna.cross_validate(given, by=3) for given in (PLATINUM / "study.toml", study))
    assert by_path.after == by_study.after


def test_a_result_from_a_file_has_no_study(folder: Path) -> None:
    with pytest.raises(ulna.UlnaInputError, match=r"has no readings; expected a study\. Name .*study\.toml"):
        ulna.identify(ulna.Result.load(folder))


def test_a_result_sent_elsewhere_leaves_its_readings_behind(result: ulna.Result) -> None:
    again = pickle.loads(pickle.dumps(result))
    assert again.study is None
    assert again.parameters == result.parameters
    assert result.study is not None


@pytest.mark.parametrize("given", [3, None, {"name": "arm"}, [1, 2], object()])
def test_a_wrong_type_is_one_sentence(given: Any) -> None:
    for door, expected in ((as_arm, "an arm: an Arm, a Result"), (as_study, "a study: "), (as_result, "a result: ")):
        with pytest.raises(TypeError, match=f"expected {expected}") as caught:
            door(given)
        assert str(caught.value).count(".") <= 3
        assert "\n" not in str(caught.value)


def test_a_study_is_no_arm(result: ulna.Result) -> None:
    with pytest.raises(TypeError, match="got a Study, expected an arm"):
        ulna.evaluate(result.study, PLATINUM / "check.toml")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="got an Arm, expected a study"):
        ulna.calibrate(result.arm)  # type: ignore[arg-type]
