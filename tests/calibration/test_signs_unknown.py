"""Encoders that count nobody knows which way."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.oracle import virtual
from tests.oracle.core import core_problem
from tests.oracle.published import table_2, table_4
from tests.small_study import SmallStudy, says

import ulna
import ulna._core as _core


def as_drawn(arm, rng, offsets_rad):
    """All signs +1, zero offsets and lengths as somebody thought."""
    return virtual.wrong_start(replace(arm, sign=(1,) * 7), rng, offsets_rad, 10.0)


@pytest.mark.parametrize("offsets_rad", [0.3, np.pi], ids=["zeros known roughly", "zeros unknown"])
@pytest.mark.parametrize("seed", range(4))
def test_all_signs_of_seven_joints(seed, offsets_rad):
    """101 bars, noise of 5e-6 rad: the arm that made them, or its mirror image, which the report names."""
    rng = np.random.default_rng(seed)
    truth = replace(table_4(), sign=tuple(int(s) for s in rng.choice([-1, 1], 7)))
    bar = virtual.bars(truth, rng, 101, 443.172)
    bar = replace(bar, q_rad=bar.q_rad + 5e-6 * rng.standard_normal(bar.q_rad.shape))
    start = as_drawn(truth, rng, offsets_rad)
    found = _core.fit(
        core_problem(start, [bar]),
        np.zeros(27, bool),
        start="given" if offsets_rad < 1 else "search",
        seed=seed,
        unknown_signs=np.ones(7, bool),
    )
    assert found.converged
    assert found.rms_mm < 0.05
    wrong = {k + 1 for k in range(7) if found.arm.signs[k] != truth.sign[k]}
    assert not wrong or wrong in [set(joints) for joints in found.undecided_signs]
    # fresh distances are as true as the fit, whichever twin was found
    q, p = rng.uniform(-3, 3, (2, 50, 7))
    ours = np.linalg.norm(found.arm.tip(q) - found.arm.tip(p), axis=1)
    theirs = np.linalg.norm(truth.tip(q) - truth.tip(p), axis=1)
    assert abs(ours - theirs).max() < 0.2


def test_one_unknown_sign_is_decided():
    """The mirror turns all of them: with six known the seventh is no question."""
    rng = np.random.default_rng(7)
    truth = replace(table_2(r_mm=40.0), sign=(1, -1, 1, 1, -1, 1, 1))
    bar = virtual.bars(truth, rng, 101, 443.172)
    start = virtual.wrong_start(replace(truth, sign=(1, 1, 1, 1, -1, 1, 1)), rng, 0.2, 10.0)
    unknown = np.zeros(7, bool)
    unknown[1] = True
    found = _core.fit(core_problem(start, [bar]), np.zeros(27, bool), unknown_signs=unknown)
    assert found.arm.signs.tolist() == list(truth.sign)
    assert found.undecided_signs == []
    assert found.rms_mm < 1e-9


def test_coordinates_decide_between_the_arm_and_its_mirror_image():
    rng = np.random.default_rng(8)
    truth = replace(table_4(), sign=(-1, 1, -1, 1, 1, -1, 1))
    points = virtual.coordinates(truth, rng, 120, True)
    found = _core.fit(
        core_problem(as_drawn(truth, rng, 0.3), [points]), np.zeros(27, bool), unknown_signs=np.ones(7, bool)
    )
    assert found.arm.signs.tolist() == list(truth.sign)
    assert found.undecided_signs == []


def study_with_sign(small: SmallStudy, held: str) -> None:
    small.swap("arm.toml", "d = 1.5", "d = 1.5\nsign = 0")
    small.swap("study.toml", 'hold = ["joint.1.theta0"]', held)


def test_a_sign_of_nought_in_an_arm_file(tmp_path: Path) -> None:
    """From the file to the result: the sign that was found is in it."""
    small = SmallStudy(tmp_path)
    truth = ulna.Arm.load(tmp_path / "arm.toml")
    joints = list(truth.joints)
    joints[1] = replace(joints[1], sign=-1)
    truth = replace(truth, joints=tuple(joints))
    q, p = np.random.default_rng(9).uniform(-2, 2, (2, 60, 3))
    length = np.linalg.norm(truth.tip(q, "bent") - truth.tip(p, "bent"), axis=1)
    lines = [",".join(["q1,q2,q3", "p1,p2,p3", "length"])]
    lines += [",".join(repr(float(v)) for v in (*a, *b, c)) for a, b, c in zip(q, p, length, strict=True)]
    small.write("bars.csv", "\n".join(lines) + "\n")
    small.swap("study.toml", 'kind = "bar"\nlength = 443.172\nu = 0.001', 'kind = "length"')
    study_with_sign(small, "")
    study, _ = small.load()
    assert study.arm.unknown_signs.tolist() == [False, True, False]
    result = ulna.calibrate(study)
    assert [joint.sign for joint in result.arm.joints] == [1, -1, 1]
    assert result.fit.rms_mm < 1e-9
    result.save(tmp_path / "out")
    assert [joint.sign for joint in ulna.Arm.load(tmp_path / "out" / "arm.toml").joints] == [1, -1, 1]


def test_a_sign_is_not_found_without_the_geometry_around_it(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    study_with_sign(small, 'hold = ["joint.2.alpha"]')
    study, _ = small.load()
    with pytest.raises(ulna.UlnaInputError) as raised:
        ulna.calibrate(study)
    says(str(raised.value), "joint.2.sign is 0", "joint.2.alpha is held", "theta0 and alpha free", "State the sign")
