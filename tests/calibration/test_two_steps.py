"""An arm calibrated once, then a second probe against a seat, joints held: the first uncertainty must come along."""

import dataclasses

import numpy as np
import pytest
from tests.oracle import virtual
from tests.oracle.chain import cylindrical_tip
from tests.oracle.published import STRAIGHT_4, table_4

import ulna
from ulna.arm.covariance import ParameterCovariance
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.readings import Readings
from ulna.study.data import FitOptions, Noise
from ulna.study.study import Study

ENCODER_RAD, SEAT_MM = 5e-6, 0.008
RUNS = 400


def _rows(artefact: Artefact, q_rad, probe: int, p_rad=None, length_mm=None) -> Readings:
    count = len(q_rad)
    zeros = np.zeros(count, dtype=np.int64)
    labels = np.full(count, "1", dtype=object)
    return Readings(
        artefact, q_rad, p_rad, length_mm, np.full(count, probe), zeros, labels, np.arange(1, count + 1), zeros
    )


def _study(arm: ulna.Arm, readings: Readings, hold: list[str]) -> Study:
    noise = Noise(np.full(arm.n, ENCODER_RAD), SEAT_MM)
    return Study(None, arm, [readings], noise, dataclasses.replace(FitOptions(), hold=hold), [], [])


def _touched(q_rad, rng: np.random.Generator, core, probe: int):
    """Encoder angles as read, for touches that were off by the seat's noise."""
    off_mm = SEAT_MM * rng.standard_normal((len(q_rad), 3))
    step = np.linalg.pinv(core.encoder_jacobian(q_rad, probe)) @ off_mm[:, :, None]
    return q_rad + step[:, :, 0] + ENCODER_RAD * rng.standard_normal(q_rad.shape)


@pytest.mark.timeout(300)
def test_a_second_probes_uncertainty_has_the_first_calibration_in_it() -> None:
    """Both steps drawn 400 times: the straight tip errs as its u says, and by more than its own readings would say."""
    chain = table_4()
    rng = np.random.default_rng(8)
    straight = np.array(cylindrical_tip(*STRAIGHT_4))
    links = zip(chain.theta0_rad, chain.alpha_rad, chain.a_mm, chain.last, strict=True)
    joints = [ulna.Joint(*map(float, link)) for link in links]
    probes = {"bent": ulna.Probe(*map(float, chain.tips_mm[0])), "straight": ulna.Probe(*map(float, straight))}
    truth = ulna.Arm("virtual", (*joints, ulna.Joint(0.0, 0.0, 0.0, 0.0)), probes)
    bars = virtual.random_lengths(chain, rng, 101)
    limits = np.tile([-2.5, 2.5], (7, 1))
    seat_at = np.tile([450.0, 200.0, 300.0], (32, 1))
    in_seat, reached = truth.core.pose_for_points(seat_at, limits, 4, 1)
    assert reached.all()
    bar = Artefact("bar", "length", {}, None, 0.0)
    seat = Artefact("seat", "seat", {"seat": (0.0, 0.0, 0.0)})
    errors, own, both = [], [], []
    for _ in range(RUNS):
        first = _rows(
            bar, _touched(bars.q_rad, rng, truth.core, 0), 0, _touched(bars.p_rad, rng, truth.core, 0), bars.length_mm
        )
        calibrated = ulna.calibrate(_study(truth, first, ["joint.1.theta0", "joint.1.d", "probe.straight.*"])).arm
        second = _study(calibrated, _rows(seat, _touched(in_seat, rng, truth.core, 1), 1), ["joint.*", "probe.bent.*"])
        result = ulna.calibrate(second)
        alone = ulna.calibrate(dataclasses.replace(second, arm=dataclasses.replace(calibrated, uncertainty=None)))
        rows = {row.name: row for row in result.parameters}
        tip = [rows[f"probe.straight.{axis}"] for axis in "xyz"]
        errors.append([row.value - true for row, true in zip(tip, straight, strict=True)])
        both.append([row.u for row in tip])
        own.append([row.u for row in alone.parameters if row.name.startswith("probe.straight.")])
        assert isinstance(result.covariance, ParameterCovariance)
        assert set(result.covariance.names) >= {"joint.3.d", "probe.bent.x", "probe.straight.z"}
        np.testing.assert_allclose(result.covariance.matrix, result.covariance.matrix.T, rtol=1e-9, atol=1e-18)
    spread = np.sqrt(np.mean(np.square(errors), axis=0))
    stated = np.mean(both, axis=0)
    # the root mean square of 400 has a standard uncertainty of 3.5 %
    np.testing.assert_allclose(spread, stated, rtol=0.12)
    assert (stated > 1.2 * np.mean(own, axis=0)).any()
