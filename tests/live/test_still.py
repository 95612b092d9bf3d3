"""Hands with known truth: those that rest are taken, those that creep, tremble, knock or slip are not."""

from __future__ import annotations

import numpy as np
import pytest

from ulna.ground.arrays import F64
from ulna.live.still import StillLimits, stillness
from ulna.live.trigger import Taken, Trigger, same_pose

SEAT_MM = 0.008
HANDS = 200


def moved(kind: str, size: float, t_s: F64, rng: np.random.Generator) -> F64:
    """(N, 3) where the tip truly is."""
    along = rng.standard_normal(3)
    along /= np.linalg.norm(along)
    beat = 0.25 * np.arange(int(t_s[-1] / 0.25) + 2)
    match kind:
        case "rest":
            way = np.zeros(len(t_s))
        case "creep":  # mm/s
            way = size * t_s
        case "tremor":  # amplitude, at 6 to 12 Hz as hands do
            way = size * np.sin(2 * np.pi * rng.uniform(6, 12) * t_s + rng.uniform(0, 6))
        case "knock":
            since = t_s[:, None] - beat - rng.uniform(0, 0.1)
            ring = np.exp(-np.clip(since, 0, None) / 0.05) * np.sin(2 * np.pi * 15 * since)
            way = size * np.where(since > 0, ring, 0.0).sum(axis=1)
        case "slip":
            way = size * (t_s[:, None] > beat + rng.uniform(0, 0.1, len(beat))).sum(axis=1)
        case _:
            raise AssertionError(kind)
    return way[:, None] * along


def hand(kind: str, size: float, rate_hz: float, noise_mm: float, rng: np.random.Generator) -> Taken | None:
    """What the trigger takes of four seconds."""
    t_s = np.arange(int(4.0 * rate_hz)) / rate_hz
    p_mm = moved(kind, size, t_s, rng) + noise_mm * rng.standard_normal((len(t_s), 3))
    limits = StillLimits.of(noise_mm, rate_hz, SEAT_MM)
    assert limits.sees
    trigger = Trigger(limits)
    keep = limits.samples + 2
    for end in range(1, len(t_s) + 1, max(1, int(rate_hz / 50))):
        window = slice(max(0, end - keep), end)
        found = trigger.look(t_s[window], p_mm[window], p_mm[window], noise_mm**2 * np.eye(3))
        if isinstance(found, Taken):
            return found
    return None


@pytest.mark.parametrize(("rate_hz", "noise_mm"), [(1000.0, 0.006), (200.0, 0.006), (100.0, 0.003)])
def test_a_hand_that_rests_is_taken_and_the_mean_is_its_place(rate_hz: float, noise_mm: float) -> None:
    rng = np.random.default_rng(1)
    found = [hand("rest", 0.0, rate_hz, noise_mm, rng) for _ in range(HANDS)]
    taken = [each for each in found if each is not None]
    assert len(taken) >= 0.98 * HANDS
    means = np.array([each.stillness.mean_mm for each in taken])
    assert np.abs(means.mean(axis=0)).max() < 0.1 * SEAT_MM
    assert np.sqrt((means**2).mean()) < 0.1 * SEAT_MM


@pytest.mark.parametrize(
    ("kind", "size"),
    [
        *(("creep", size) for size in (0.02, 0.05, 0.2)),
        *(("tremor", size) for size in (0.01, 0.03, 0.2)),
        ("knock", 0.05),
        ("slip", 0.03),
    ],
)
@pytest.mark.parametrize(("rate_hz", "noise_mm"), [(1000.0, 0.006), (100.0, 0.003)])
def test_a_hand_that_moves_is_not_taken(kind: str, size: float, rate_hz: float, noise_mm: float) -> None:
    rng = np.random.default_rng(2)
    taken = sum(hand(kind, size, rate_hz, noise_mm, rng) is not None for _ in range(HANDS))
    assert taken <= 0.005 * HANDS


def test_where_rate_and_noise_do_not_tell_it_is_said() -> None:
    assert not StillLimits.of(0.05, 20.0, SEAT_MM).sees
    assert StillLimits.of(0.0, 20.0, SEAT_MM).sees


@pytest.mark.parametrize(("armed", "touches"), [(True, 2), (False, 1)])
def test_an_arm_is_taken_again_after_it_has_been_away(armed: bool, touches: int) -> None:
    """And not where it lies when somebody begins, unless that is asked for."""
    limits = StillLimits.of(0.006, 1000.0, SEAT_MM)
    rng = np.random.default_rng(3)
    trigger, taken = Trigger(limits, armed=armed), []
    t_s = np.arange(6000) / 1000.0
    way = np.zeros((6000, 3))
    way[2000:4000, 0] = 1.0  # not far enough
    way[4000:, 0] = 5.0
    p_mm = way + 0.006 * rng.standard_normal(way.shape)
    for end in range(20, 6001, 20):
        window = slice(max(0, end - 510), end)
        if trigger.look(t_s[window], p_mm[window], p_mm[window], 0.006**2 * np.eye(3)) is not None:
            taken.append(t_s[end - 1])
    assert len(taken) == touches
    assert 4.4 < taken[-1] < 4.7
    assert all(each < 0.6 for each in taken[:-1])


def test_drift_and_spread_are_those_of_the_window() -> None:
    t_s = np.linspace(0.0, 1.0, 501)
    p_mm = np.stack([0.03 * t_s, 0.02 * np.sin(40.0 * t_s), np.zeros(501)], axis=1)
    found = stillness(t_s, p_mm, 1e-6 * np.eye(3), StillLimits.of(0.001, 500.0, SEAT_MM))
    assert found.drift_mm == pytest.approx(0.03, rel=0.05)
    assert found.spread_mm == pytest.approx(0.02 / np.sqrt(2.0), rel=0.1)
    assert not found.still


def test_a_turn_of_a_joint_is_the_same_pose() -> None:
    others = np.array([[0.0, 1.0], [3.0, -1.0]])
    assert same_pose(np.array([3.0 - 2.0 * np.pi, -1.0005]), others) == 1
    assert same_pose(np.array([3.0, -1.01]), others) is None
    assert same_pose(np.array([3.0, -1.0]), np.zeros((0, 2))) is None
