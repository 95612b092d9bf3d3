"""Fresh places: held out from the fit, also after a crash, and judged as `ulna evaluate` judges them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.live.guided_hand import Hand
from tests.live.test_guide import ARTEFACTS, begun
from tests.live.test_session import hand_of, played, session_of

import ulna
from ulna.artefacts.artefact import Artefact
from ulna.cli.live.at_the_arm import Bench
from ulna.cli.printed.fresh import fresh_lines
from ulna.live.ending import JOURNAL, begin, fresh_places_in, touches_in, write_result, write_study
from ulna.live.events import Event, Happened
from ulna.live.fresh import done, next_fresh
from ulna.live.judging import judge
from ulna.live.session import Session
from ulna.live.touches import Touch
from ulna.live.trigger import Refused

FITTED = 14


def followed(session: Session, hand: Hand, times: int) -> list[Event]:
    """Does what is suggested."""
    found: list[Event] = []
    for _ in range(times):
        assert hand.follow(session.meter().next)
        found += played(session)
    return found


def test_what_is_held_out_is_not_fitted_survives_a_crash_and_judges(tmp_path: Path) -> None:
    arm, hand = hand_of(3)
    folder = tmp_path / "evening"
    journal, _, _ = begin(folder, hand.hello)
    session = session_of(arm, hand, journal)
    followed(session, hand, FITTED)
    fitted = session.arm_now.core.parameters.tobytes()
    known = session.fit.so_far()
    session.hold_out(3)
    events = followed(session, hand, 3)
    assert [event.touch.held_out for event in events if isinstance(event, Happened)] == [True] * 3
    assert all(event.off_mm is None for event in events if isinstance(event, Happened))
    assert session.arm_now.core.parameters.tobytes() == fitted
    assert np.array_equal(session.fit.so_far().covariance, known.covariance)
    meter = session.meter()
    assert meter.fresh is not None
    assert (meter.fresh.done, meter.fresh.places) == (1, 3)
    assert meter.next.here
    # the power goes between the ends of the second bar
    journal.close()
    path = folder / JOURNAL
    path.write_bytes(path.read_bytes() + b"half a record")
    other, touches, _ = begin(folder, hand.hello)
    resumed = session_of(arm, hand, other)
    resumed.go_on(touches, fresh_places_in(path))
    assert [touch.q_rad.tobytes() for touch in touches] == [touch.q_rad.tobytes() for touch in session.fit.touches]
    assert [touch.held_out for touch in touches] == [False] * FITTED + [True] * 3
    assert resumed.place == session.place
    again = resumed.meter()
    assert again.fresh == meter.fresh
    assert again.next.q_rad.tobytes() == meter.next.q_rad.tobytes()
    followed(resumed, hand, 3)
    now = resumed.meter().fresh
    assert now is not None
    assert now.done == 3
    other.close()

    study, left_out = write_study(resumed.fit, folder)
    assert left_out == []
    result = write_result(study)
    off = np.array(list(result.arm.core.parameters)) - resumed.arm_now.core.parameters
    assert np.abs(off).max() < 1e-6  # it is the arm that was fitted to the others
    assert sum(map(len, ulna.Study.load(study).readings)) == FITTED
    found = judge(result, study, arm)
    assert found is not None
    alone = ulna.evaluate(result, ulna.Study.load(study, rows="check"))
    assert found.evaluation.overall == alone.overall
    assert (found.places, found.evaluation.readings) == (3, 6)
    assert (folder / "held-out" / "evaluation.json").is_file()
    rms = found.evaluation.overall["length_error_rms_mm"]
    assert found.expected_mm is not None
    assert 0.1 * found.expected_mm < rms < 3.0 * found.expected_mm
    assert found.before["length_error_rms_mm"] > 10.0 * rms
    lines = fresh_lines(found)
    assert lines[0] == "3 fresh places, not fitted: 6 touches"
    assert lines[1].startswith(f"  length error: rms {rms:.4f} mm, largest ")
    assert "3 of 3 lengths inside their stated 95 % intervals" in lines[-1]
    # truth: the held-out bars are judged about as fresh bars by the arm that the hand holds
    true = ulna.evaluate(hand.truth, ulna.Study.load(study, rows="check")).overall["length_error_rms_mm"]
    assert true < 0.03


def test_without_held_out_touches_a_study_has_no_split(tmp_path: Path) -> None:
    arm, hand = hand_of(3)
    session = session_of(arm, hand)
    followed(session, hand, FITTED)
    session.hold_out(1)
    followed(session, hand, 2)
    for touch in session.fit.touches[FITTED:]:
        session.withdraw(touch.number, "the bar slipped")
    study, _ = write_study(session.fit, tmp_path / "s")
    assert "split" not in study.read_text(encoding="utf-8")
    assert judge(write_result(study), study, arm) is None


def test_a_place_touched_by_half_judges_nothing_and_is_named(tmp_path: Path) -> None:
    arm, hand = hand_of(3)
    session = session_of(arm, hand)
    followed(session, hand, FITTED)
    session.hold_out(2)
    followed(session, hand, 3)
    study, left_out = write_study(session.fit, tmp_path / "s")
    assert len(left_out) == 1
    assert f"does without touch {FITTED + 3}" in left_out[0]
    assert sum(map(len, ulna.Study.load(study, rows="check").readings)) == 2


def test_there_must_be_a_fit_and_the_bar_must_be_moved() -> None:
    arm, hand = hand_of(3)
    session = session_of(arm, hand)
    followed(session, hand, 4)
    with pytest.raises(ulna.UlnaInputError, match="4 touches are too few for a fit"):
        session.hold_out(10)
    assert session.fresh_places == 0
    followed(session, hand, FITTED - 4)
    last, place = session.fit.touches[-1], session.place
    session.hold_out(2)
    assert session.place == place + 1
    assert hand.bar_mm is not None
    assert hand.q_rad is not None
    hand.go(hand.q_rad + 0.3)
    hand.touch(hand.bar_mm[last.feature], last.q_rad + 0.3)
    (refused,) = played(session)
    assert isinstance(refused, Refused)
    assert "where it was touched before" in refused.reason
    followed(session, hand, 2)
    fitted = len(session.fit.counting())
    session.hold_out(0)
    (event,) = followed(session, hand, 1)
    assert isinstance(event, Happened)
    assert not event.touch.held_out
    assert int(event.touch.standing) > place + 1
    assert len(session.fit.counting()) == fitted + 1


def test_a_crash_before_the_first_held_out_touch_leaves_no_fitted_place_to_judge_by(tmp_path: Path) -> None:
    arm, hand = hand_of(3)
    journal, _, _ = begin(tmp_path / "s", hand.hello)
    session = session_of(arm, hand, journal)
    followed(session, hand, FITTED)
    session.hold_out(2)
    # killed: what was not flushed is lost, the journal is never closed
    other, touches, _ = begin(tmp_path / "s", hand.hello)
    path = tmp_path / "s" / JOURNAL
    assert fresh_places_in(path) == 2
    resumed = session_of(arm, hand, other)
    resumed.go_on(touches, 2)
    assert not resumed.meter().next.here
    followed(resumed, hand, 1)
    standings = {touch.held_out: set() for touch in resumed.fit.touches}  # type: ignore[var-annotated]
    for touch in resumed.fit.touches:
        standings[touch.held_out].add(touch.standing)
    assert not standings[True] & standings[False]
    other.close()
    assert [touch.held_out for touch in touches_in(path)] == [False] * FITTED + [True]
    journal.close()


@pytest.mark.parametrize("artefact", ARTEFACTS, ids=lambda artefact: artefact.name)
def test_fresh_places_are_different_ones_whatever_is_touched(artefact: Artefact) -> None:
    _, fit, guide = begun(artefact)
    touches: list[Touch] = []
    place, places_mm = 1, []
    for number in range(1, 200):
        own = [touch for touch in touches if touch.standing == str(place)]
        suggestion = next_fresh(guide, place, own)
        if own and not suggestion.here:
            place += 1
        if not suggestion.here or not own:
            places_mm.append(suggestion.stand.points_mm)
        feature = suggestion.feature if artefact.features else 0
        touch = Touch(number, artefact.name, str(place), feature, 0, suggestion.q_rad, held_out=True)
        touches.append(touch)
        fit.add(touch)
        if done(guide, touches) == 4:
            break
    assert fit.counting() == []
    if artefact.frame == "arm":
        assert len(touches) == 4
        return
    assert place == 4
    each = len(touches) / 4
    assert each == {"bar": 2, "plate": 3, "cone": 4, "ball": 12}[artefact.name]
    for k in range(4):
        for other in range(k):
            gaps = np.linalg.norm(places_mm[k][:, None] - places_mm[other][None], axis=-1)
            assert gaps.min() > (0.0 if artefact.kind == "sphere" else 30.0)


def test_at_the_goal_it_is_offered_once_begun_by_a_word_and_left_by_it(capsys: pytest.CaptureFixture[str]) -> None:
    arm, hand = hand_of(3)
    session = session_of(arm, hand)
    session.goal_u_mm = 10.0
    bench = Bench(session, False, None, None)
    bench._do("hold-out")
    assert "too few for a fit" in bench.said[-1]
    for _ in range(FITTED):
        hand.follow(session.meter().next)
        for event in played(session):
            bench._event(event)
    offers = [line for line in capsys.readouterr().out.splitlines() if line.startswith("Enough. Now 10 fresh places")]
    assert len(offers) == 1
    assert not bench._ended
    bench._do("hold-out many")
    assert "got 'many'; expected how many fresh places" in bench.said[-1]
    bench._do("hold-out 1")
    assert session.fresh_places == 1
    for _ in range(2):
        assert bench.meter is not None
        hand.follow(bench.meter.next)
        for event in played(session):
            bench._event(event)
    assert "1 fresh places" not in bench.said[-1]
    assert "enough to judge by" in bench.said[-1]
    assert not bench._ended  # nobody said beforehand that it ends with them
    bench._do("withdraw")
    assert session.fit.touches[-1].withdrawn is not None
    bench._do("hold-out")
    assert session.fresh_places == 0
    assert "fitted again" in bench.said[-1]


def test_with_a_number_it_begins_at_the_goal_and_ends_with_the_last() -> None:
    arm, hand = hand_of(3)
    session = session_of(arm, hand)
    bench = Bench(session, True, FITTED, None, 2)
    for _ in range(FITTED + 4):
        assert not bench._ended
        hand.follow(session.meter().next)
        for event in played(session):
            bench._event(event)
    assert bench._ended
    assert [touch.held_out for touch in session.fit.touches] == [False] * FITTED + [True] * 4


def test_what_was_interrupted_after_its_last_fresh_place_ends_at_once() -> None:
    arm, hand = hand_of(3)
    session = session_of(arm, hand)
    followed(session, hand, FITTED)
    session.hold_out(1)
    followed(session, hand, 2)
    for held_out, ends in ((None, False), (1, True)):
        resumed = session_of(arm, hand)
        resumed.go_on(session.fit.touches, 1)
        bench = Bench(resumed, True, None, None, held_out)
        bench._look()
        assert bench._ended is ends
