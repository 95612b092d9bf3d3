"""Touches by a list: each for the next step that is open; a wrong one is asked about; whatever is killed goes on."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.cli_runs import platinum

from ulna.arm.arm import Arm
from ulna.checking.protocol import load_protocol, plan_of
from ulna.ground.errors import UlnaInputError
from ulna.live.by_list import DONE, ByList, OfStep, touches_of
from ulna.live.ending import JOURNAL, begin
from ulna.live.figures import Calibrated
from ulna.live.list_playing import ListHand
from ulna.live.sources.virtual import VirtualSource
from ulna.live.stream import Stream
from ulna.live.trigger import Refused
from ulna.serve.play_tests import PROTOCOL
from ulna.verification.to_touch import WorkList, work_list

SEAT, BARS = 5, 4
READ_S = 0.0


def known_arm() -> Arm:
    """With joints that end somewhere."""
    drawn = platinum()
    ends = ((-3.14, 3.14), (0.49, 3.49)) * 3 + ((-3.14, 3.14),)
    return replace(
        drawn, joints=tuple(replace(joint, limits_rad=end) for joint, end in zip(drawn.joints, ends, strict=True))
    )


@contextmanager
def touching(folder: Path, by_itself: bool = True, noise_rad: float = 5e-6) -> Iterator[tuple[ByList, VirtualSource]]:
    """A list with a journal, at a virtual arm that waits."""
    arm = known_arm()
    work = the_list(folder, arm)
    source = VirtualSource(arm, rate_hz=200.0, noise_rad=noise_rad, speed=None, wanders=False, hand_rad_s=10.0)
    from ulna.live.source_file import read_source

    stream = Stream(source, read_source("virtual:"), True)
    by_list = ByList(stream, Calibrated(arm), work, by_itself=by_itself)
    path = folder / "session" / JOURNAL
    if path.exists():
        by_list.go_on(*touches_of(path))
    by_list.journal, _, _ = begin(folder / "session", source.hello)
    yield by_list, source
    by_list.journal.close()
    source.close()


def the_list(folder: Path, arm: Arm) -> WorkList:
    arm.save(folder / "arm.toml", force=True)
    (folder / "p.toml").write_text(PROTOCOL)
    (folder / "t.csv").write_text("test," + ",".join(f"q{k + 1}" for k in range(7)) + "\nseat" + ",0.1" * 7 + "\n")
    return work_list(plan_of(load_protocol(folder / "p.toml"), folder / "t.csv"), None)


def next_of(by_list: ByList) -> Refused | OfStep:
    """The next touch, or why there is none."""
    for _ in range(100):
        for event in by_list.feed(by_list.stream.read(READ_S)):
            if isinstance(event, Refused | OfStep):
                return event
    raise AssertionError("nothing was touched")


def test_a_hand_that_follows_touches_all_of_it(tmp_path: Path) -> None:
    with touching(tmp_path) as (by_list, source):
        hand = ListHand(source, by_list.work)
        scatter = []
        for k in range(SEAT + BARS):
            assert by_list.step == k
            hand.follow(k)
            told = next_of(by_list)
            assert isinstance(told, OfStep)
            assert (told.step, told.touch.number) == (k, k + 1)
            scatter.append(by_list.scatter_mm(k))
        assert by_list.step is None
        assert scatter[0] is None
        assert all(each is not None and 0.001 < each < 0.02 for each in scatter[1:SEAT]), "5 µm of each touch"
        hand.follow(0)
        assert next_of(by_list) == Refused(DONE)


def test_a_touch_of_another_end_is_asked_about_and_taken_the_second_time(tmp_path: Path) -> None:
    with touching(tmp_path) as (by_list, source):
        hand = ListHand(source, by_list.work)
        for k in range(SEAT + 1):
            hand.follow(k)
            assert isinstance(next_of(by_list), OfStep)
        hand.follow(SEAT)  # end A once more, with another elbow, where B is asked for
        told = next_of(by_list)
        assert isinstance(told, Refused)
        assert "from what was touched at A in this place, where 443.2 mm is expected" in told.reason
        assert by_list.step == SEAT + 1
        hand.follow(SEAT)
        again = next_of(by_list)
        assert isinstance(again, OfStep), "whoever insists is believed"
        assert again.step == SEAT + 1
        by_list.withdraw(again.touch.number, "it was A")
        with pytest.raises(UlnaInputError, match="touch 7: there is none that counts"):
            by_list.withdraw(again.touch.number, "once more")
        hand.follow(SEAT + 1)
        right = next_of(by_list)
        assert isinstance(right, OfStep)
        assert (right.step, right.touch.number) == (SEAT + 1, 8), "no number is given twice"


def test_a_journal_goes_on_with_the_same_steps(tmp_path: Path) -> None:
    with touching(tmp_path) as (by_list, source):
        hand = ListHand(source, by_list.work)
        for k in range(3):
            hand.follow(k)
            next_of(by_list)
        by_list.withdraw(2, "slipped")
        first = {k: each.q_rad.tolist() for k, each in by_list.counting.items()}
    with touching(tmp_path) as (by_list, source):
        assert {k: each.q_rad.tolist() for k, each in by_list.counting.items()} == first
        assert by_list.step == 1
        ListHand(source, by_list.work).follow(1)
        told = next_of(by_list)
        assert isinstance(told, OfStep), "the seat stands where it stood"
        assert (told.step, told.touch.number) == (1, 4)
        with pytest.raises(UlnaInputError, match="of another list"):
            by_list.go_on(by_list.touches, {})


def test_by_a_key_a_touch_is_taken_where_it_is_asked_for(tmp_path: Path) -> None:
    with touching(tmp_path, by_itself=False) as (by_list, source):
        ListHand(source, by_list.work).follow(0)
        for _ in range(20):
            assert list(by_list.feed(by_list.stream.read(READ_S))) == []
        told = by_list.ask()
        assert isinstance(told, OfStep)
        assert told.step == 0
        same = by_list.ask()
        assert same == Refused("the same posture as touch 1: move elbow and wrist between touches")
        by_list.stream.plausible.doubtful = True  # as after a reset
        doubted = by_list.ask()
        assert isinstance(doubted, Refused)
        assert "in doubt" in doubted.reason
        by_list.trust()
        assert by_list.ask() == same


def test_an_arm_that_nothing_tells_from_rest_is_refused(tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError, match="how its encoders scatter is not known"):  # noqa: SIM117
        with touching(tmp_path, noise_rad=0.0):
            pass
    with touching(tmp_path, by_itself=False, noise_rad=0.0) as (by_list, _):
        assert isinstance(by_list.ask(), Refused)


def test_postures_of_the_hand_are_in_place(tmp_path: Path) -> None:
    """Where the true arm is, the bar is as long as its certificate says, within the noise of a touch."""
    with touching(tmp_path) as (by_list, source):
        hand = ListHand(source, by_list.work)
        for k in range(SEAT + BARS):
            hand.follow(k)
        at_mm = source.arm.core.tip(np.array([hand._postures[k] for k in range(SEAT + BARS)]), 0)
        lengths = np.linalg.norm(np.diff(at_mm[SEAT:], axis=0)[::2], axis=1)
        assert np.abs(lengths - 443.172).max() < 0.04
        assert np.linalg.norm(at_mm[:SEAT] - at_mm[:SEAT].mean(axis=0), axis=1).max() < 0.03
