"""What is wrong with a stream is named, each thing once, and nothing is named of a stream that is well."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.live.faults import CLOCK_JUMP, GAP, JUMP, REPEAT, RESET, SWAP, WRAP
from ulna.live.mapping import Mapping
from ulna.live.plausible import Plausible
from ulna.live.samples import Hello, Samples
from ulna.live.tables import LimitsTable, MapTable

HELLO = Hello(("a", "b", "c"), None, "a double")
RATE_HZ = 100.0


def turning(n: int = 400) -> tuple[F64, F64, F64]:
    """(N,) host and device times, (N, 3) counts of 4096: a hand moves three joints, each on its own part of the
    turn."""
    t = np.arange(n) / RATE_HZ
    counts = np.stack([1000 + 300 * np.sin(t), 2500 + 400 * np.sin(0.7 * t), 3300 + 300 * np.cos(1.3 * t)], axis=1)
    jitter = np.random.default_rng(1).uniform(0, 0.004, n)
    return 50.0 + t + jitter, 7.0 + t, np.round(counts)


def looked(
    t_host_s: F64, t_device_s: F64 | None, raw: F64, pieces: int = 7, unit: str = "counts"
) -> tuple[list[str], F64, bool]:
    """Kinds of what was named, angles, and whether it is doubtful in the end; read in pieces."""
    table = MapTable(unit="counts", counts_per_turn=4096.0) if unit == "counts" else MapTable(unit="deg")
    mapping = Mapping(table, HELLO)
    plausible = Plausible(mapping, LimitsTable())
    kinds: list[str] = []
    angles = []
    for begin in range(0, len(raw), pieces):
        which = slice(begin, begin + pieces)
        samples = Samples(t_host_s[which], None if t_device_s is None else t_device_s[which], raw[which])
        faults, resets = plausible.look(samples)
        angles.append(mapping.q_rad(samples, resets))
        kinds += [fault.kind for fault in (*faults, *mapping.faults())]
    return kinds, np.concatenate(angles), plausible.doubtful


@pytest.mark.parametrize("pieces", [1, 7, 400])
@pytest.mark.parametrize("clock", [True, False])
def test_a_good_stream_has_nothing(pieces: int, clock: bool) -> None:
    host, device, raw = turning()
    kinds, q, doubtful = looked(host, device if clock else None, raw, pieces)
    assert kinds == []
    assert not doubtful
    np.testing.assert_allclose(q, raw * 2 * math.pi / 4096, rtol=1e-12)


@pytest.mark.parametrize("pieces", [1, 7, 400])
def test_a_wrap_is_named_and_the_turn_counted(pieces: int) -> None:
    host, device, raw = turning()
    true = raw.copy()
    true[:, 1] += 1400 + np.arange(len(raw))
    kinds, q, doubtful = looked(host, device, true % 4096, pieces)
    assert kinds == [WRAP]
    assert not doubtful
    np.testing.assert_allclose(q, true * 2 * math.pi / 4096, rtol=1e-12)


def test_turns_are_counted_down_too() -> None:
    host, device, raw = turning()
    true = raw.copy()
    true[:, 0] -= 5 * np.arange(len(raw))
    kinds, q, _ = looked(host, device, true % 4096)
    assert kinds == [WRAP]
    np.testing.assert_allclose(q, true * 2 * math.pi / 4096, rtol=1e-12)


@pytest.mark.parametrize("pieces", [1, 7, 400])
def test_a_reset_is_named_once_with_its_clock(pieces: int) -> None:
    host, device, raw = turning()
    raw[200:] -= raw[200]
    device[200:] -= device[200]
    kinds, q, doubtful = looked(host, device, raw, pieces)
    assert kinds == [RESET]
    assert doubtful
    np.testing.assert_allclose(q[200:], raw[200:] * 2 * math.pi / 4096, rtol=1e-12)  # turns begin from none


def test_a_swap_is_named_once() -> None:
    host, device, raw = turning()
    raw[200:] = raw[200:][:, [1, 0, 2]]
    kinds, _, doubtful = looked(host, device, raw)
    assert kinds == [SWAP]
    assert doubtful


def test_a_jump_is_named_once() -> None:
    host, device, raw = turning()
    raw[200:, 1] += 700
    kinds, _, doubtful = looked(host, device, raw)
    assert kinds == [JUMP]
    assert doubtful


@pytest.mark.parametrize("clock", [True, False])
def test_a_gap_is_named_once(clock: bool) -> None:
    host, device, raw = turning()
    keep = np.r_[0:200, 212:400]
    kinds, _, doubtful = looked(host[keep], device[keep] if clock else None, raw[keep])
    assert kinds == [GAP]
    assert not doubtful


def test_samples_that_come_late_together_are_no_gap_where_the_device_has_a_clock() -> None:
    host, device, raw = turning()
    host[200:208] = host[208]  # held up for 80 ms on their way, none lost
    assert looked(host, device, raw, 1)[0] == []
    assert looked(host, None, raw, 1)[0] == [GAP]
    host, device, raw = turning()
    host[200:320] = host[320]  # what is shown was old for more than a second
    assert looked(host, device, raw, 1)[0] == [GAP]
    host, device, raw = turning()
    host[200:203] = host[203]  # 30 ms is what a USB adapter does
    assert looked(host, None, raw, 1)[0] == []


@pytest.mark.parametrize("clock", [True, False])
def test_readings_lost_while_a_joint_turns_fast_are_no_jump(clock: bool) -> None:
    """Three of 100 a second lost, too few for a gap, of a joint at 8 rad/s: it moved by 18°."""
    host, device, raw = turning()
    raw[:, 1] = np.round(8.0 * np.arange(400) / RATE_HZ * 4096 / (2 * math.pi)) % 4096
    keep = np.r_[0:200, 203:400]
    kinds, _, doubtful = looked(host[keep], device[keep] if clock else None, raw[keep])
    assert set(kinds) == {WRAP}
    assert not doubtful


@pytest.mark.parametrize(("by", "word"), [(-3.0, "back"), (3600.0, "ahead")])
def test_a_clock_jump_is_named_once(by: float, word: str) -> None:
    host, device, raw = turning()
    device[200:] += by
    assert looked(host, device, raw)[0] == [CLOCK_JUMP]


def test_a_clock_of_32_bits_that_begins_again_goes_on() -> None:
    host, device, raw = turning()
    device += 2.0**32 * 1e-6 - device[200]
    assert looked(host, device % (2.0**32 * 1e-6), raw)[0] == [WRAP]


def test_repeats_are_named_once_a_run() -> None:
    host, device, raw = turning()
    device[200:220], raw[200:220] = device[200], raw[200]
    kinds, _, _ = looked(host, device, raw)
    assert kinds.count(REPEAT) == 1
    assert set(kinds) == {REPEAT, GAP}  # the device was silent meanwhile
    assert kinds.count(GAP) == 1


def test_degrees_wrap_at_a_turn() -> None:
    host, device, raw = turning()
    degrees = raw / 10.0
    degrees[:, 0] = (degrees[:, 0] + np.arange(400)) % 360
    kinds, q, _ = looked(host, device, degrees, unit="deg")
    assert kinds == [WRAP]
    assert np.all(np.abs(np.diff(q[:, 0])) < 0.1)


def test_channels_are_chosen_and_ordered_by_name() -> None:
    mapping = Mapping(MapTable(channels=["c", "a"], unit="rad"), HELLO)
    samples = Samples(np.zeros(1), None, np.array([[1.0, 2.0, 3.0]]))
    np.testing.assert_array_equal(mapping.q_rad(samples), [[3.0, 1.0]])
    with pytest.raises(UlnaInputError, match="got 'd', which a double does not send"):
        Mapping(MapTable(channels=["d"], unit="rad"), HELLO)
    with pytest.raises(UlnaInputError, match=r"map\.unit.* is missing"):
        Mapping(MapTable(), HELLO)


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 10**6), st.floats(0.3, 6.2), st.floats(-6.0, 6.0), st.sampled_from(["counts", "deg"]))
def test_limits_tell_the_turn_in_which_a_stream_begins(seed: int, span: float, low: float, unit: str) -> None:
    """Wherever in its travel of less than a turn each joint is as the stream begins, and wherever its encoder begins
    again, the angles are those between its limits; where no limit is known they are as sent."""
    rng = np.random.default_rng(seed)
    travel = np.array([[low, low + span], [np.nan, np.nan], [low, low + span]])
    wander = np.cumsum(rng.normal(0.0, 0.01, (300, 3)), axis=0) + rng.uniform(0.0, 1.0, 3)
    truth = low + span * np.clip(wander, 0.0, 1.0)
    turn = 4096.0 if unit == "counts" else 360.0
    raw = np.remainder(truth / (2 * np.pi) * turn, turn)
    table = MapTable(unit="counts", counts_per_turn=turn) if unit == "counts" else MapTable(unit="deg")
    mapping = Mapping(table, HELLO)
    mapping.begin_within(travel)
    found = mapping.q_rad(Samples(np.arange(300) / 100, None, raw))
    np.testing.assert_allclose(found[:, [0, 2]], truth[:, [0, 2]], atol=1e-9)
    assert found[0, 1] == pytest.approx(raw[0, 1] / turn * 2 * np.pi)


def test_a_joint_of_several_turns_that_is_within_its_limits_stays_there() -> None:
    mapping = Mapping(MapTable(unit="rad"), HELLO)
    mapping.begin_within(np.array([[-20.0, 20.0], [-1.0, 1.0], [5.0, 5.5]]))
    sent = np.array([[12.0, 2.0, 0.1]])  # within; outside, and in no turn inside; the same
    np.testing.assert_array_equal(mapping.q_rad(Samples(np.zeros(1), None, sent)), sent)
