"""What touches do not tell: as many directions as the counts say, apart from what no touch tells, in lines that fit."""

from __future__ import annotations

import io
import json
from dataclasses import replace

import numpy as np
import pytest
from tests.live.test_guide import ARTEFACTS, begun
from tests.live.test_session import hand_of, played, session_of

import ulna
from ulna.artefacts.artefact import Artefact
from ulna.cli.printed.touching import screen
from ulna.live.lacking import Lacking, lacking, never
from ulna.live.lacking_words import LINES, in_words, lacking_lines
from ulna.live.said import held_out_lines, record_of
from ulna.live.touches import Touch


@pytest.mark.parametrize("artefact", ARTEFACTS, ids=lambda artefact: artefact.name)
def test_what_no_touch_tells_is_what_is_free_and_not_determinable(artefact: Artefact) -> None:
    _, fit, guide = begun(artefact)
    lost = never(fit, guide)
    assert len(lost) == len(fit.free()) - guide.determinable
    causes = [each["cause"] for each in lost]
    # a cone knows no length: that is the artefact's fault, and no number of touches mends it
    assert ("scale" in causes) == (artefact.kind == "seat")
    assert causes.count("base-frame") == (0 if artefact.frame == "arm" else 2)
    lines = lacking_lines(Lacking(lost))
    assert bool(lines) == (artefact.kind == "seat")
    assert all("Never by touching this" in line for line in lines[:1])


def test_with_each_touch_there_are_as_many_as_lack_and_in_the_end_none() -> None:
    arm, hand = hand_of(3)
    session = session_of(arm, hand)
    counts, said = [], []
    for _ in range(14):
        meter = session.meter()
        found = meter.lacking
        if meter.so_far.determined:
            assert len(found.not_yet) == max(meter.determinable - meter.so_far.determined, 0)
        counts.append(len(found.not_yet))
        said.append(lacking_lines(found))
        known = json.loads(json.dumps(record_of(meter), allow_nan=False))["known"]["lacking"]
        assert len(known["not_yet"]) == len(found.not_yet)
        assert all(each["because"] and each["remedy"] for each in known["not_yet"] + known["never"])
        hand.follow(meter.next)
        played(session)
    assert max(counts) > 15
    assert counts[-1] == 0
    assert said[-1] == []
    assert said[3][0].startswith(f"Not known yet ({counts[3]} combinations): ")


def test_a_joint_that_never_moved_is_named() -> None:
    _, fit, guide = begun(ARTEFACTS[2])
    rng = np.random.default_rng(4)
    for number in range(1, 8):
        q_rad = rng.uniform(-1.0, 1.0, 7)
        q_rad[2] = 0.4
        fit.add(Touch(number, "grid", "0", number % 4, 0, q_rad))
    found = lacking(fit.tell(), never(fit, guide))
    assert {each["cause"] for each in found.not_yet} == {"joint-still"}
    first = lacking_lines(found)[0]
    assert first.startswith("Not known yet")
    assert "joint 3" in first
    assert "joint 3 was never moved" in " ".join(lacking_lines(found))


def test_after_a_withdrawal_that_leaves_too_few_what_was_fitted_is_not_told() -> None:
    arm, hand = hand_of(3)
    session = session_of(arm, hand)
    for _ in range(12):
        hand.follow(session.meter().next)
        played(session)
    assert session.meter().lacking.not_yet == []
    for number in range(5, 13):
        session.withdraw(number, "wrong ball")
    assert session.no_fit is not None
    meter = session.meter()
    assert meter.so_far.touches == 4
    assert len(meter.lacking.not_yet) == meter.determinable - meter.so_far.determined > 10


def direction(name: str, because: str, **more: object) -> dict[str, object]:
    return {"combination": {name: 1.0}, "because": because, "remedy": "turn it", "frame": False, **more}


def test_lines_fit_and_what_does_not_is_counted() -> None:
    reason = "it moves the tip, but not in anything that was read: the poses are too few or too much alike"
    lost = [direction(f"joint.{k}.alpha", f"{reason} ({k})") for k in range(1, 6)]
    weak = [direction("joint.4.d", "only to 3 mm", u=3.0, unit="mm")]
    lines = lacking_lines(Lacking(not_yet=lost, weak=weak))
    assert len(lines) <= LINES
    assert max(map(len, lines)) <= 80
    assert lines[0].startswith("Not known yet: twist of joint 1: it moves")
    told = sum(line.startswith("Not known yet") for line in lines)
    assert lines[-1] == f"… and {6 - told} more causes: --json has all."
    # what lengths do not depend on asks nothing of anybody
    assert lacking_lines(Lacking(never=[direction("joint.1.d", "frame") | {"frame": True}])) == []
    assert lacking_lines(Lacking(weak=weak)) == ["Hardly known: offset of joint 4: only to 3 mm. Turn it."]


def test_what_is_known_worst_is_said_first() -> None:
    found = replace(
        ulna.identify("examples/platinum/study.toml"),
        lost=[],
        weak=[
            direction("joint.3.d", "a", u=2.0, unit="mm"),
            direction("joint.3.alpha", "b", u=0.05, unit="rad"),  # five times what a drawing leaves
            direction("joint.4.d", "c", u=4.0, unit="mm"),
        ],
    )
    assert [each["because"] for each in lacking(found, []).weak] == ["b", "c", "a"]


def test_what_more_touches_mend_by_themselves_is_said_last() -> None:
    few, still = direction("joint.3.d", "few", cause="coverage"), direction("joint.4.d", "still", cause="joint-still")
    found = replace(ulna.identify("examples/platinum/study.toml"), lost=[few, still], weak=[])
    assert [each["because"] for each in lacking(found, []).not_yet] == ["still", "few"]
    # what no touch tells is not asked for, whatever the sign and size it is given with
    assert [each["because"] for each in lacking(found, [direction("joint.3.d", "x")]).not_yet] == ["still"]


def test_parameters_have_words() -> None:
    assert in_words("joint.6.theta0") == "zero of joint 6"
    assert in_words("probe.bent.z") == "z of probe bent"
    assert in_words("joint.2.sin1") == "joint.2.sin1"


def test_a_screen_has_80_columns_and_always_as_many_lines() -> None:
    from rich.console import Console

    arm, hand = hand_of(3)
    session = session_of(arm, hand)
    for _ in range(3):
        hand.follow(session.meter().next)
        played(session)
    meter = session.meter()
    words = lacking_lines(meter.lacking)
    assert 1 < len(words) <= LINES
    heights = set()
    for lines in (words, [], words[:1] * LINES):
        console = Console(width=80, file=io.StringIO())
        console.print(screen(session, meter, lines, held_out_lines(10)))
        text = console.file.getvalue().splitlines()  # type: ignore[attr-defined]
        assert max(map(len, text)) <= 80
        heights.add(len(text))
        # nothing was broken: each sentence stands in a line of its own
        assert any(line.rstrip() == held_out_lines(10)[0] for line in text)
        assert "h hold out" in text[-1]
    assert len(heights) == 1
