"""How each kind of activity begins: a row a kind."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ulna.arm.given import as_arm
from ulna.formats.output import write_file
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.commission.commissioning import Commissioning as Work
from ulna.live.commission.geometry import geometry, ways
from ulna.live.commission.posture import posture
from ulna.live.ending import JOURNAL, begin, fresh_places_in
from ulna.live.features import Notebook
from ulna.live.figures import Calibrated
from ulna.live.purpose import purpose_of
from ulna.live.readout import ReadOut
from ulna.live.session import Session
from ulna.live.stream import Stream
from ulna.records.bench import Bench
from ulna.serve.activities.activity import Doing
from ulna.serve.activities.checking import begun_check
from ulna.serve.activities.commissioning import Commissioning
from ulna.serve.activities.measuring import Measuring
from ulna.serve.activities.testing import begun_test
from ulna.serve.activities.touching import Touching
from ulna.serve.activities.watching import Watching
from ulna.serve.beside import usable
from ulna.serve.contract.activities import Begin, BeginCommission, BeginMeasure, BeginTouch, BeginWatch
from ulna.serve.contract.guided import BeginCheckTouches, BeginTestTouches
from ulna.serve.desk import Desk
from ulna.serve.sources import Allowed

ABOUT = "session.json"
"""In the folder of a session: how it was asked for, so that it can go on."""


@dataclass(frozen=True)
class Place:
    """Where an activity works."""

    desk: Desk
    bench: Bench
    """The record."""
    folder: Path
    """Its own; made when something is kept."""
    who: str
    """Who works."""
    allowed: Allowed
    """Which sources may be opened."""


def _watch(asked: BeginWatch, stream: Stream, place: Place) -> Doing:
    return Watching(stream, None if asked.arm is None else as_arm(place.desk.path(asked.arm)))


def _commission(asked: BeginCommission, stream: Stream, place: Place) -> Doing:
    path = None if asked.arm is None else place.desk.path(asked.arm)
    drawn = geometry(path, asked.joints, asked.reach_mm, None)
    zeros = asked.zeros or ("unknown" if drawn.guessed else "posture")
    how = ways(drawn, worded("the device") if path is None else path.name)
    stands = posture(drawn.arm, None) if zeros == "posture" else None
    hello, table = stream.source.hello, stream.stated.file.map
    work = Work(hello, drawn.arm.n, table, ways=how, posture=stands)
    return Commissioning(stream, work, drawn, place.folder, zeros == "known", asked.counts_per_turn)


def _touch(asked: BeginTouch, stream: Stream, place: Place) -> Doing:
    arm_path, plan_path = place.desk.path(asked.arm), usable(place.desk, asked.plan)
    arm = as_arm(arm_path)
    purpose = purpose_of(plan_path, arm, None, asked.length_mm)
    goal = None if asked.goal_mm is None else 0.5 * asked.goal_mm
    session = Session(arm, purpose.spec, stream, fit=purpose.fit, goal_u_mm=goal, by_itself=asked.by == "still")
    stated = stream.stated.file.model_dump(mode="json", exclude_none=True)
    head: dict[str, Any] = {"source": stated, "arm": arm.name, "artefact": purpose.spec.artefact.name}
    head |= {"operator": place.who}
    journal, known, _ = begin(place.folder, stream.source.hello, **head)
    session.journal = journal
    if known:
        session.go_on(known, fresh_places_in(place.folder / JOURNAL))
    return Touching(session, place.folder, asked.by, arm)


def _measure(asked: BeginMeasure, stream: Stream, place: Place) -> Doing:
    calibrated = Calibrated(place.desk.path(asked.arm), asked.probe)
    out = ReadOut(stream, calibrated, Notebook(), asked.by == "still")
    return Measuring(out, place.folder, asked.by)


def _check(asked: BeginCheckTouches, stream: Stream, place: Place) -> Doing:
    return begun_check(asked, stream, place.desk, place.bench, place.folder)


def _test(asked: BeginTestTouches, stream: Stream, place: Place) -> Doing:
    return begun_test(asked, stream, place.desk, place.folder)


BEGINNINGS: dict[type, Callable[[Any, Stream, Place], Doing]] = {
    BeginWatch: _watch,
    BeginCommission: _commission,
    BeginTouch: _touch,
    BeginMeasure: _measure,
    BeginCheckTouches: _check,
    BeginTestTouches: _test,
}
"""What was asked → who begins it."""


Kept = BeginTouch | BeginCheckTouches | BeginTestTouches
"""What goes on after anything."""


def needs_angles(asked: Begin) -> bool:
    """Whether a stream without a unit is of no use."""
    return isinstance(asked, Kept | BeginMeasure)


def begun(asked: Begin, stream: Stream, place: Place) -> Doing:
    """Raises UlnaInputError."""
    return BEGINNINGS[type(asked)](asked, stream, place)


def keep_asked(asked: Kept, place: Place, at: str) -> None:
    """How a session was asked for, so that it can go on after anything."""
    if not place.folder.is_dir():
        raise UlnaInputError(worded("{session}: its folder is gone. Begin another session.", session=place.folder.name))
    text = asked.model_copy(update={"go_on": None}).model_dump_json(indent=2)
    write_file(place.folder / ABOUT, f'{{"begun": "{at}", "asked": {text}}}\n', force=True)
