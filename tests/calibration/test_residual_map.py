"""A map of residuals as judge: it names the joint that errs, finds nothing where nothing is, and is asked for."""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import pytest
from tests.calibration.test_extras_judged import study_of
from tests.cli_runs import platinum
from tests.simulations import write

import ulna
from ulna.arm.arm import Arm
from ulna.arm.effects.effects import Effects
from ulna.calibration.residual_map import ResidualMap
from ulna.cli.printed.mapped import said
from ulna.ground import extras


def erring(joint: int, order: int, rad: float) -> Arm:
    """The virtual Platinum, one of whose encoders errs."""
    arm = platinum()
    joints = list(arm.joints)
    joints[joint - 1] = replace(joints[joint - 1], effects=Effects(harmonics_rad={order: (rad, 0.5 * rad)}))
    return replace(arm, joints=tuple(joints))


def mapped(truth: Arm, **fit: object) -> ResidualMap:
    pytest.importorskip("sklearn", reason="the extra judge is not installed")
    result = ulna.calibrate(study_of(truth, platinum(wrong=0.3), noise_mm=0.02), judge=True, **fit)
    assert result.residual_map is not None
    return result.residual_map


@pytest.mark.parametrize(("joint", "order"), [(3, 2), (2, 7), (4, 3)])
def test_the_joint_that_errs_is_named(joint: int, order: int) -> None:
    found = mapped(erring(joint, order, 2e-4))
    assert found.missing == [joint]
    told = found.joints[joint - 1]
    assert 1e-4 < told.amplitude_rad < 2.5e-4  # 1.6e-4: 2e-4 √((1 + 1/4)/2)
    assert told.share > 0.3
    assert f"joint {joint} (" in said(found)


def test_nothing_is_found_where_nothing_is_and_where_the_model_has_it() -> None:
    assert mapped(platinum()).missing == []
    fitted = mapped(erring(3, 2, 2e-4), extras=["encoder-harmonics"], harmonics=[1, 2], judge_extras=False)
    assert fitted.missing == []
    assert "nothing that follows a single joint" in said(fitted)


def test_orientations_are_no_places(tmp_path: Path) -> None:
    """They have three numbers as well, of which no joint's lever moves one by a millimetre."""
    pytest.importorskip("sklearn", reason="the extra judge is not installed")
    features = "{ a = [0, 0, 0], b = [250, 0, 0], c = [0, 180, 0] }"
    plate = f"[artefact.plate]\nkind = 'points'\nplacements = 6\ntouches = 3\nfeatures = {features}\n"
    turns = "[artefact.target]\nkind = 'orientation'\nrotation = 'vector'\nu = 2e-5\n"
    study = ulna.simulate(write(tmp_path, plate + turns)).study
    found = ulna.calibrate(study, judge=True).residual_map
    assert found is not None
    assert found.readings == sum(len(each) for each in study.readings if each.rotation_rad is None)


def test_it_is_in_the_file(tmp_path: Path) -> None:
    pytest.importorskip("sklearn", reason="the extra judge is not installed")
    result = ulna.calibrate(study_of(erring(3, 2, 2e-4), platinum(wrong=0.3), noise_mm=0.02), judge=True)
    result.save(tmp_path)
    assert ulna.Result.load(tmp_path).residual_map == result.residual_map
    assert ulna.calibrate(study_of(platinum(), platinum(wrong=0.3))).residual_map is None


def test_without_the_package_it_is_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extras, "installed", lambda package: package != "sklearn")
    monkeypatch.setitem(sys.modules, "sklearn", None)
    with pytest.raises(ulna.UlnaInputError, match=r'scikit-learn is not installed.*pip install "ulna\[judge\]"'):
        ulna.calibrate(study_of(platinum(), platinum(wrong=0.3)), judge=True)


def test_too_few_readings_are_told() -> None:
    study = study_of(platinum(), platinum(wrong=0.3))
    (group,) = study.readings
    few = replace(study, readings=[group.select(group.feature < 40)])
    monkey = pytest.MonkeyPatch()
    monkey.setattr(extras, "installed", lambda package: True)
    found = ulna.calibrate(few, judge=True).residual_map
    monkey.undo()
    assert found is not None
    assert found.joints == []
