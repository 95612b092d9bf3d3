"""The running fit is the batch fit of the touches that count, whatever came, went and came again before."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import ulna
import ulna._core as _core
from ulna.artefacts.artefact import Artefact
from ulna.live import running
from ulna.live.running import RunningFit
from ulna.live.touches import Touch
from ulna.simulation.mover import Mover
from ulna.simulation.places import Standing, places
from ulna.study.assembly import assemble
from ulna.study.data import FitOptions, Noise

SEAT_MM = 0.01
ENCODER_RAD = 5e-6
BAR = Artefact("bar", "bar", features={"A": (0.0, 0.0, 0.0), "B": (400.0, 0.0, 0.0)}, length_mm=400.0, u_mm=0.002)


@pytest.fixture(scope="module")
def platinum() -> ulna.Arm:
    return ulna.Arm.load("examples/platinum/platinum.toml")


@pytest.fixture(scope="module")
def touches(platinum: ulna.Arm) -> list[Touch]:
    """A bar in fifteen places and a plate of four points in five, touched by an arm that is off its drawing."""
    rng = np.random.default_rng(5)
    units = np.array(platinum.parameter_units)
    off = np.where(units == "mm", 0.2, 0.001) * rng.standard_normal(len(units))
    truth = platinum.with_parameters(platinum.core.parameters + off)
    travel = np.tile([-3.0, 3.0], (platinum.n, 1))
    travel[1::2] = [0.5, 3.4]
    mover = Mover(truth, travel)
    found: list[Touch] = []
    for artefact, count, postures in ((BAR, 15, 3), (plate(), 5, 2)):
        features = np.array(list(artefact.features.values()))
        _, q_rad = places(Standing(features, artefact.name), mover, 0, count, postures, rng)
        for place in range(count):
            for feature in range(len(features)):
                for q in q_rad[place, feature]:
                    read = q + ENCODER_RAD * rng.standard_normal(platinum.n)
                    found.append(Touch(len(found) + 1, artefact.name, str(place), feature, 0, read))
    order = rng.permutation(len(found))
    return [replace(found[k], number=number) for number, k in enumerate(order.tolist(), start=1)]


def plate() -> Artefact:
    features = {"1": (0.0, 0.0, 0.0), "2": (200.0, 0.0, 0.0), "3": (0.0, 150.0, 0.0), "4": (210.0, 160.0, 20.0)}
    return Artefact("plate", "points", features=features, u_mm=0.001)


def begun(arm: ulna.Arm) -> RunningFit:
    noise = Noise(np.full(arm.n, ENCODER_RAD), SEAT_MM)
    return RunningFit(arm, [BAR, plate()], noise, FitOptions(hold=["joint.1.theta0", "joint.1.d"]))


def u_of(covariance: np.ndarray) -> np.ndarray:
    return np.sqrt(np.diag(covariance))


@pytest.mark.parametrize("seed", range(12))
def test_any_order_of_adds_and_withdrawals_ends_at_the_batch_fit(
    platinum: ulna.Arm, touches: list[Touch], seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(seed)
    monkeypatch.setattr(running, "FEW", 30 * (seed % 2))
    fit = begun(platinum)
    gone = set(rng.choice(len(touches), int(rng.integers(0, 26)), replace=False) + 1)
    when, fits_at = int(rng.integers(1, 40)), set(rng.integers(100, len(touches), 3))
    waiting: list[int] = []
    for done, touch in enumerate(touches, start=1):
        fit.add(touch)
        if touch.number in gone:
            waiting.append(touch.number)
        if done % when == 0:
            while waiting:
                fit.withdraw(waiting.pop(), "ball not seated")
        if done in fits_at:
            fit.refit()
    for number in waiting:
        fit.withdraw(number, "ball not seated")
    followed = fit.so_far()
    fit.refit()

    study = begun(platinum)
    study.touches = [touch for touch in touches if touch.number not in gone]
    assembled = assemble(study.study())
    batch = _core.fit(assembled.problem, assembled.hold)
    free = ~assembled.hold
    u = u_of(batch.covariance)
    assert batch.termination.startswith("converged")
    assert fit.fitted is not None
    off = (fit.fitted.parameters - batch.parameters)[free]
    assert np.abs(off / u).max() < 1e-6
    assert np.allclose(u_of(fit.fitted.covariance), u, rtol=1e-6)
    assert followed.touches == len(touches) - len(gone)

    # what was followed touch by touch, at the arm of the fit before, is nearly that of the fit after
    now = fit.so_far()
    assert now.determined == followed.determined == free.sum()
    assert np.allclose(u_of(now.covariance), u_of(followed.covariance), rtol=0.05)


def test_what_is_known_follows_exactly(
    platinum: ulna.Arm, touches: list[Touch], monkeypatch: pytest.MonkeyPatch
) -> None:
    """At one arm, rows added and taken away leave what all rows at once give."""
    monkeypatch.setattr(running, "FEW", 0)
    fit = begun(platinum)
    for touch in touches[:90]:
        fit.add(touch)
    fit.refit()
    for touch in touches[90:]:
        fit.add(touch)
    for number in (3, 50, 95, 101):
        fit.withdraw(number, "moved")
    followed = fit.so_far()
    fit._look()
    at_once = fit.so_far()
    assert followed.determined == at_once.determined
    size = np.abs(at_once.triangle).max()
    product = [found.triangle.T @ found.triangle for found in (followed, at_once)]
    assert np.abs(product[0] - product[1]).max() < 1e-12 * size**2
    assert np.allclose(u_of(followed.covariance), u_of(at_once.covariance), rtol=1e-9)


def test_a_gain_is_what_the_touch_then_gives(platinum: ulna.Arm, touches: list[Touch]) -> None:
    fit = begun(platinum)
    bars = [touch for touch in touches if touch.artefact == "bar"]
    last = [touch for touch in bars if touch.standing == "3"]
    for touch in bars:
        if touch not in last:
            fit.add(touch)
    fit.refit()
    before = fit.so_far()
    rng = np.random.default_rng(2)
    asked = rng.standard_normal((40, len(before.covariance))) * u_of(before.covariance)
    certain = replace(BAR, u_mm=0.0)
    from ulna.live.touches import readings_of

    rows = fit.rows_of(readings_of(last, certain))
    told = _core.gains(np.ascontiguousarray(rows[None]), before.triangle, asked)[0]

    def mean(triangle: np.ndarray) -> float:
        half = np.linalg.solve(triangle.T, asked.T)
        return float((half**2).sum(axis=0).mean())

    for touch in last:
        fit.add(touch)
    lost = mean(before.triangle) - mean(fit.so_far().triangle)
    assert told == pytest.approx(lost, rel=1e-9)


def test_a_withdrawn_touch_is_kept_and_cannot_be_withdrawn_twice(platinum: ulna.Arm, touches: list[Touch]) -> None:
    fit = begun(platinum)
    fit.add(touches[0])
    fit.withdraw(touches[0].number, "slipped")
    assert [touch.withdrawn for touch in fit.touches] == ["slipped"]
    assert fit.so_far().touches == 0
    with pytest.raises(ulna.UlnaInputError, match="expected one that counts"):
        fit.withdraw(touches[0].number, "again")
    with pytest.raises(ulna.UlnaInputError, match="Touch something"):
        fit.refit()
    with pytest.raises(ulna.UlnaInputError, match="expected one of 'bar', 'plate'"):
        fit.add(replace(touches[0], artefact="cone"))
