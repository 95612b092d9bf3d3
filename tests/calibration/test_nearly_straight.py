"""A tip that stands a hair off the last axis, of which the readings cannot tell whether it stands on it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import ulna
from ulna.arm.arm import Arm
from ulna.arm.directions import combination, worth_naming
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.readings import Readings
from ulna.study.data import FitOptions
from ulna.study.study import Study

LINKS = [
    (0.1, -1.57, 35.0, 250.0),
    (0.2, 1.57, 20.0, 10.0),
    (-0.3, -1.57, 15.0, 600.0),
    (0.4, 1.57, -20.0, 5.0),
    (0.15, -1.57, 12.0, 550.0),
]
NOISE_MM = 0.4
OF_THE_AXIS = {"joint.5.theta0", "joint.5.alpha", "joint.5.a", "joint.5.d", "probe.target.z"}
OF_THE_BASE = {"joint.1.theta0", "joint.1.d"}


def arm(tip_mm: tuple[float, float, float], wrong: float, rng: np.random.Generator) -> Arm:
    """Lengths off by up to `wrong` mm, angles by up to a thousandth of it in rad."""
    off = rng.uniform(-wrong, wrong, (5, 4)) * np.array([1e-3, 1e-3, 1.0, 1.0])
    joints = (*(Joint(*link) for link in (np.array(LINKS) + off).tolist()), Joint())
    return Arm("six axes", joints, {"target": Probe(*tip_mm)})


def calibrated(seed: int) -> tuple[Arm, ulna.Result]:
    """Tracked points in the tracker's frame, started from a drawing whose tip is on the axis."""
    rng = np.random.default_rng(seed)
    truth, drawn = arm((0.15, 0.1, 190.0), 0.0, rng), arm((0.0, 0.0, 200.0), 1.0, rng)
    start = {"theta0_rad": truth.joints[0].theta0_rad, "d_mm": truth.joints[0].d_mm}
    drawn = replace(drawn, joints=(replace(drawn.joints[0], **start), *drawn.joints[1:]))
    q = rng.uniform(-2.5, 2.5, (300, 6))
    seen = truth.tip(q) + NOISE_MM * rng.standard_normal((300, 3)) + np.array([900.0, -300.0, 50.0])
    artefact = Artefact("tracker", "points", {f"m{k}": tuple(p) for k, p in enumerate(seen.tolist())})
    zeros, labels = np.zeros(300, np.int64), np.array(["1"] * 300, dtype=object)
    readings = Readings(artefact, q, None, None, zeros, np.arange(300), labels, np.arange(300), zeros)
    return truth, ulna.calibrate(Study(None, drawn, [readings], fit=FitOptions()))


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_only_what_the_hair_leaves_open_is_left_open(seed: int) -> None:
    truth, result = calibrated(seed)
    assert set(result.identifiability.not_determined) == OF_THE_AXIS | OF_THE_BASE
    true = dict(zip(truth.parameter_names, truth.parameters.tolist(), strict=True))
    for row in result.parameters:
        if row.name in OF_THE_AXIS | OF_THE_BASE:
            assert row.u is None
        else:
            assert row.u is not None
            assert abs(row.value - true[row.name]) < 4 * row.u, row.name


def test_the_truth_lies_within_what_is_stated() -> None:
    """The shares of errors within one and two standard uncertainties, over many calibrations."""
    ratios = []
    for seed in range(40):
        truth, result = calibrated(100 + seed)
        true = dict(zip(truth.parameter_names, truth.parameters.tolist(), strict=True))
        ratios += [abs(row.value - true[row.name]) / row.u for row in result.parameters if row.u]
    assert len(ratios) >= 40 * 16
    assert np.mean(np.array(ratios) < 2.0) == pytest.approx(0.954, abs=0.03)
    assert np.mean(np.array(ratios) < 1.0) == pytest.approx(0.683, abs=0.06)


def test_the_report_names_what_matters() -> None:
    _, result = calibrated(1)
    for direction in result.identifiability.lost:
        if direction["cause"] == "probe-on-axis":
            weights = direction["combination"]
            named = worth_naming(weights)
            assert set(named) < OF_THE_AXIS | {"joint.4.a", "joint.2.a", "joint.2.d"}
            assert f", and {len(weights) - len(named)} more by next to nothing" in combination(weights)
    assert "more by" not in combination({"joint.5.a": 1.0, "joint.5.theta0": -0.005})


@pytest.mark.parametrize("drawn_mm", [(0.0, 0.0, 190.0), (0.01, 0.01, 190.0)])
def test_a_tip_clearly_off_the_axis_is_told(drawn_mm: tuple[float, float, float]) -> None:
    """Touches some hundred times better: the readings speak, wherever the fit starts.

    All else starts at the truth, so that the sum of squares alone does not tell: what counts is how well it is seen.
    """
    rng = np.random.default_rng(5)
    truth = arm((0.5, 0.3, 190.0), 0.0, rng)
    q = rng.uniform(-2.5, 2.5, (300, 6))
    seen = truth.tip(q) + 1e-3 * rng.standard_normal((300, 3))
    artefact = Artefact("tracker", "points", {f"m{k}": tuple(p) for k, p in enumerate(seen.tolist())})
    zeros, labels = np.zeros(300, np.int64), np.array(["1"] * 300, dtype=object)
    readings = Readings(artefact, q, None, None, zeros, np.arange(300), labels, np.arange(300), zeros)
    drawn = replace(truth, probes={"target": Probe(*drawn_mm)})
    result = ulna.calibrate(Study(None, drawn, [readings], fit=FitOptions()))
    assert set(result.identifiability.not_determined) == OF_THE_BASE
    assert [row.name for row in result.parameters if row.u is None] == ["joint.1.theta0", "joint.1.d"]
