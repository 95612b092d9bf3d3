"""Commissioning: a simulated home-built arm, whose truth is known, is found out."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.live.home_built import COUNTS, RATE_HZ, HomeBuilt
from tests.live.parts import pty

from ulna.arm.arm import Arm
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.ground.errors import UlnaInputError
from ulna.live.commission.commissioning import Commissioning
from ulna.live.commission.counting import step_of, wraps_of
from ulna.live.commission.findings import Findings
from ulna.live.commission.holding import Holding
from ulna.live.commission.turning import Turned, Way
from ulna.live.commission.writing import commissioned
from ulna.live.samples import Hello, Samples
from ulna.live.stream import streaming
from ulna.live.tables import MapTable


def played(arm: HomeBuilt, q_rad: np.ndarray, joints: int | None = None, **more: object) -> Commissioning:
    """Everything taken that is found, what is refused skipped."""
    ways = ["anticlockwise"] * arm.n
    work = Commissioning(arm.hello, joints or arm.n, ways=ways, **more)  # type: ignore[arg-type]
    samples = arm.samples(q_rad, 100.0)
    for begin in range(0, len(samples), 997):
        found = work.take(samples[begin : begin + 997])
        while found is not None and work.step is not None:
            if found.why_not is None:
                work.accept()
            else:
                work.skip()
            found = work.take(Samples.none(arm.channels))
    return work


def agree(findings: Findings, arm: HomeBuilt) -> None:
    """With the truth."""
    offset = arm.offset
    noise = np.sqrt(arm.noise**2 + 1 / 12)
    for k, joint in enumerate(findings.joints):
        assert joint.channel == f"c{arm.order[k] + 1}"
        assert joint.sign == arm.signs[k]
        assert joint.step == 1.0
        assert joint.noise == pytest.approx(noise, rel=0.1)
        low, high = arm.limits_rad[k]
        assert (joint.high - joint.low) / COUNTS == pytest.approx((high - low) / (2 * np.pi), abs=12 / COUNTS)
        truth = arm.signs[k] * np.array([low, high]) / (2 * np.pi) * COUNTS + offset[k]
        off = np.array([joint.low, joint.high]) - np.sort(truth)
        assert np.abs(off - COUNTS * np.round(off.mean() / COUNTS)).max() < 12


@settings(max_examples=12, deadline=None)
@given(st.permutations(range(7)), st.lists(st.sampled_from([1, -1]), min_size=6, max_size=6), st.integers(0, 999))
def test_any_order_and_any_signs_are_found(order: list[int], signs: list[int], seed: int) -> None:
    arm = HomeBuilt(order[:6], signs, 7, seed)
    findings = played(arm, arm.whole()).findings()
    agree(findings, arm)
    assert findings.unit == "counts"
    assert findings.unused == (f"c{order[6] + 1} never changed.",)
    wraps = [joint.wraps for joint in findings.joints]
    assert [joint.counts_per_turn for joint in findings.joints if joint.wraps] == [COUNTS] * sum(wraps)


def test_a_coupled_joint_is_said() -> None:
    arm = HomeBuilt([2, 0, 3, 1], [1, -1, 1, 1], 5, 3, coupled=(1, 2, 0.3))
    work = played(arm, arm.whole())
    assert [(each.name, pytest.approx(each.ratio, abs=0.02)) for each in work.turned[1].along] == [("c4", 0.3)]
    assert "hangs on it" in work.turned[1].said[-1]
    assert work.turned[2].along == ()
    agree(work.findings(), arm)
    assert any("coupling" in line for line in work.findings().remarks)


def test_two_joints_at_once_are_refused_in_words() -> None:
    arm = HomeBuilt([0, 1, 2, 3], [1, 1, -1, 1], 4, 5)
    here = np.zeros(4)
    work = Commissioning(arm.hello, 4)
    work.take(arm.samples(np.repeat(here[None], 900, axis=0), 0.0))
    work.accept()
    work.forget()
    found = work.take(arm.samples(arm.turn(here, [0, 2]), 10.0))
    assert isinstance(found, Turned)
    assert found.why_not is not None
    assert found.why_not.startswith("More than one joint was turned: c")
    with pytest.raises(ValueError, match="nothing was found"):
        work.accept()
    work.again()
    work.forget()
    found = work.take(arm.samples(arm.turn(here, [0]), 100.0))
    assert found is not None
    assert found.why_not is None
    work.accept()
    work.forget()
    found = work.take(arm.samples(arm.turn(here, [0]), 200.0))  # once more the first, instead of the second
    assert found is not None
    assert found.why_not == "c1 moved, which is joint 1 already. Turn joint 2 alone."


def test_a_joint_that_is_not_turned_is_said() -> None:
    arm = HomeBuilt([0, 1, 2, 3], [1, 1, -1, 1], 4, 5)
    work = played(arm, arm.whole(skipped=[2]))
    assert sorted(work.turned) == [0, 1, 3]
    with pytest.raises(UlnaInputError, match="joint 3: never turned"):
        work.findings()


def test_both_ways_is_no_direction() -> None:
    arm = HomeBuilt([0, 1, 2, 3], [1, 1, -1, 1], 4, 5)
    here = np.zeros(4)
    work = Commissioning(arm.hello, 4, ways=["anticlockwise"])
    work.take(arm.samples(np.repeat(here[None], 900, axis=0), 0.0))
    work.accept()
    for k in range(4):
        work.take(arm.samples(arm.turn(here, [k]), 10.0 + 20.0 * k))
        work.accept()
        work.forget()
    found = work.take(arm.samples(arm.turn(here, [0]), 100.0))
    assert isinstance(found, Way)
    assert found.why_not is not None
    assert "both ways" in found.why_not
    work.again()
    work.forget()
    found = work.take(arm.samples(arm.way(here, 1), 200.0))
    assert found is not None
    assert found.why_not is not None
    assert "c2 moved, not c1" in found.why_not


def test_an_arm_that_is_not_held_is_said() -> None:
    arm = HomeBuilt([0, 1, 2, 3], [1, 1, -1, 1], 4, 5)
    creeping = np.linspace(0.0, 0.05, 900)[:, None] * [0, 1, 0, 0]
    found = Commissioning(arm.hello, 4).take(arm.samples(creeping, 0.0))
    assert found is not None
    assert found.why_not is not None
    assert found.why_not.startswith("It was not still: c2 by ")
    swinging = 0.02 * np.sin(np.arange(900)[:, None] / 100) * [0, 0, 1, 0]
    found = Commissioning(arm.hello, 4).take(arm.samples(swinging, 0.0))
    assert found is not None
    assert "c3" in str(found.why_not)


def test_noise_where_an_encoder_begins_again() -> None:
    """Held where 4095 and 0 meet: the noise is the same as anywhere."""
    arm = HomeBuilt([0, 1, 2, 3], [1, 1, -1, 1], 4, 7)
    arm.offset[:] = 4095.6, 0.2, 4094.5, 2000.0
    found = Commissioning(arm.hello, 4).take(arm.samples(np.zeros((900, 4)), 0.0))
    assert isinstance(found, Holding)
    assert found.why_not is None
    assert [each.noise for each in found.channels] == pytest.approx([np.sqrt(1.5**2 + 1 / 12)] * 4, rel=0.1)


def test_a_clock_is_no_joint_and_noise_is_at_least_a_step() -> None:
    arm = HomeBuilt([0, 1, 2, 3], [1, -1, -1, 1], 4, 6, noise=0.0)
    samples = arm.samples(arm.whole(), 0.0)
    clocked = Samples(samples.t_host_s, None, np.column_stack([np.round(samples.t_host_s * 1000) + 5e6, samples.raw]))
    work = Commissioning(Hello(("ms", *arm.hello.channels), None, "with a clock"), 4, ways=["anticlockwise"] * 4)
    found = work.take(clocked)
    while found is not None:
        assert found.why_not is None, found.said
        work.accept()
        found = work.take(Samples.none(5))
    findings = work.findings()
    assert findings.unused == ("ms is a clock.",)
    assert findings.unit == "counts"
    assert [joint.noise for joint in findings.joints] == pytest.approx([1 / np.sqrt(12)] * 4)
    assert [joint.channel for joint in findings.joints] == ["c1", "c2", "c3", "c4"]


def test_steps_and_wraps_by_hand() -> None:
    assert step_of(np.array([3.0, 3.0])) is None
    assert step_of(np.round(np.arange(50) * 0.087890625, 3)) == pytest.approx(0.0879, abs=2e-4)
    assert step_of(np.random.default_rng(0).standard_normal(2000)) is None
    rising = (4000 + 3 * np.arange(100)) % 4096
    found, turn = wraps_of(rising.astype(float))
    assert [str(each) for each in found] == ["4093 → 0"]
    assert turn == 4096.0
    assert wraps_of(np.array([0.0, 1.0, 0.0, 5.0])) == ([], None)


def drawn(joints: int) -> Arm:
    links = [Joint(0.0, -np.pi / 2, 10.0 * k, 100.0) for k in range(1, joints)]
    return Arm("drawn", (*links, Joint()), {"tip": Probe(5.0, 0.0, 120.0)})


def test_a_joint_without_stops_and_counts_that_were_wrongly_stated() -> None:
    arm = HomeBuilt([0, 1, 2, 3], [1, 1, -1, 1], 4, 5)
    arm.limits_rad[3] = -4.5, 4.6
    table = MapTable(unit="counts", counts_per_turn=1024)
    work = Commissioning(arm.hello, 4, table)
    found = work.take(arm.samples(arm.whole(ways=[]), 0.0))
    while found is not None:
        assert found.why_not is None
        work.accept()
        found = work.take(Samples.none(4))
    assert work.turned[3].turns == pytest.approx(9.1 / (2 * np.pi), abs=0.01)
    work.endless.add(3)
    findings = work.findings()
    last = commissioned(findings, drawn(4)).joints[3]
    assert (last.endless, last.limits_rad, last.sign, last.counts_per_turn) == (True, None, 0, COUNTS)
    assert "1024 was stated" in findings.joints[3].counts_why
    assert any("1024 was stated" in line for line in work.turned[3].said)


def test_on_a_real_line() -> None:
    """The arm does what is asked for, in real time; it is turned fast and rests but shortly."""
    arm = HomeBuilt([3, 0, 4, 1], [1, -1, -1, 1], 5, 8, coupled=(1, 2, 0.4), speed_rad_s=6.0)
    with pty() as line:
        ended = threading.Event()
        asked: list[Commissioning] = []

        def play() -> None:
            here, last, rows = np.zeros(4), None, iter(np.empty((0, 4)))
            while not ended.wait(1 / RATE_HZ):
                step = asked[0].step if asked else None
                if step is not None and step != last:
                    last, joint = step, step.joint
                    if joint is not None:
                        script = arm.turn(here, [joint], 0.0) if step.kind == "turn" else arm.way(here, joint, 0.0)
                        rows, here = iter(script), script[-1]
                sent = arm.counts(np.array([next(rows, here)]))[0]
                line.send((",".join(f"{each:.0f}" for each in sent) + "\n").encode())

        thread = threading.Thread(target=play, daemon=True)
        thread.start()
        try:
            with streaming(f"serial:{line.path}", angles=False) as stream:
                work = Commissioning(stream.source.hello, 4, ways=["so"] * 4, hold_s=3.0, rest_s=0.6)
                asked.append(work)
                until = time.monotonic() + 90
                while work.step is not None:
                    assert time.monotonic() < until
                    found = work.take(stream.read(0.1).samples)
                    if found is not None:
                        assert found.why_not is None, found.said
                        work.accept()
                        work.forget()
        finally:
            ended.set()
            thread.join(timeout=10)
    findings = work.findings()
    agree(findings, arm)
    assert findings.unused == ("c3 never changed.",)
    assert [each.name for each in work.turned[1].along] == ["c5"]
