"""Touching an artefact: what `ulna live touch` does, for a page."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from ulna.arm.arm import Arm
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.ending import JOURNAL, RESULT, write_result, write_study
from ulna.live.events import Event, Happened, Meter
from ulna.live.faults import ORDINARY, Fault
from ulna.live.judging import FILE, FOLDER, judge
from ulna.live.playing import Player
from ulna.live.said import happened_lines, held_out_lines
from ulna.live.session import Session
from ulna.live.sources.virtual import VirtualSource
from ulna.live.stream import Frames
from ulna.live.trigger import Refused
from ulna.serve.activities.activity import Doing, unknown
from ulna.serve.activities.metered import meter_said, next_said, touch_said
from ulna.serve.activities.seen import Seen, from_degrees
from ulna.serve.contract.activities import TouchState
from ulna.serve.contract.live import FaultEvent, KnownEvent, LiveEvent, RefusedEvent, SaidEvent, StateEvent, TouchEvent
from ulna.serve.contract.words import Do, DoFollow, DoGo, DoHoldOut, DoMoved, DoTouch, DoTrust, DoWithdraw
from ulna.serve.frames import Newest
from ulna.serve.problems import NotNowError
from ulna.serve.sayings import not_converged

TRIES = 20
"""Suggestions that a virtual hand may not reach, one after another."""


class Touching(Doing):
    """One session."""

    kind = "touch"

    def __init__(self, session: Session, folder: Path, by: str, begun: Arm) -> None:
        self.session, self.stream = session, session.stream
        self._folder, self._by, self._begun = folder, by, begun
        self._meter: Meter | None = None
        self._told: dict[int, Happened] = {}
        self._player: Player | None = None
        self._follows = False
        self._covariance: tuple[np.ndarray, F64] | None = None
        self._newest: tuple[float, F64] | None = None

    def begin(self) -> Iterator[LiveEvent]:
        """What is known before the first touch of this sitting."""
        yield self._known()

    def feed(self, frames: Frames) -> Iterator[LiveEvent]:
        """Touches by themselves or by the arm's button, why there is none, and faults."""
        if len(frames.samples):
            self._newest = float(frames.samples.t_s[-1]), frames.q_rad[-1]
        for event in self.session.feed(frames):
            yield from self._event(event)

    def do(self, asked: Do) -> Iterator[LiveEvent]:
        """As the keys of `ulna live touch` do."""
        session = self.session
        match asked:
            case DoTouch():
                yield from self._event(session.ask())
            case DoMoved():
                session.moved()
                yield self._known()
            case DoWithdraw():
                session.withdraw(asked.number, asked.reason)
                yield SaidEvent(sentence=worded("Touch {number} does not count any more.", number=asked.number))
                yield self._known()
                yield StateEvent(state=self.state())
            case DoHoldOut():
                session.hold_out(asked.places)
                for line in held_out_lines(asked.places):
                    yield SaidEvent(sentence=line)
                yield self._known()
            case DoTrust():
                session.trust()
                yield SaidEvent(sentence=worded("The angles are taken for right again."))
            case DoGo():
                self._follows = False
                steer(self.virtual, asked)
            case DoFollow():
                if asked.follows and self._player is None:
                    self._player = Player(self.virtual, session.spec)
                    if session.place:  # where it stood, a hand that comes does not know: it puts it anew
                        session.moved()
                        yield self._known()
                self._follows = asked.follows
                yield from self._play()
            case _:
                raise unknown(asked, self.kind)

    @property
    def virtual(self) -> VirtualSource:
        """The source where it is one that goes where it is told. Raises NotNowError."""
        return virtual_of(self.stream.source)

    def state(self) -> TouchState:
        """All of it."""
        session = self.session
        return TouchState(
            kind="touch",
            artefact=session.spec.artefact.name,
            features=list(session.spec.artefact.features),
            by=self._by,
            place=session.place,
            held_out=bool(session.fresh_places),
            touches=[touch_said(session, touch, self._told.get(touch.number)) for touch in session.fit.touches],
            meter=None if self._meter is None else meter_said(session.fit, self._meter),
            next=None if self._meter is None else next_said(session.arm_now, self._meter),
            why_no_fit=session.no_fit,
        )

    def newest(self) -> Newest | None:
        """The arm as it is known, where it is, and how sure its tip is."""
        if self._newest is None:
            return None
        arm, (t_s, q_rad) = self.session.arm_now, self._newest
        probe, known = arm.probe_index(self.session.spec.probe), self._covariance
        pose = np.ascontiguousarray(q_rad[None])
        covariance_mm2 = None if known is None else arm.core.tip_covariance(pose, probe, *known)[0]
        return Seen(arm, probe).newest(t_s, q_rad, self.stream.doubtful, self.session.rests, covariance_mm2)

    def finish(self) -> tuple[list[tuple[str, Path]], list[str]]:
        """The study, its readings, and the arm that was calibrated with them; the journal alone where they are too few
        for a fit."""
        journal = ("journal", self._folder / JOURNAL)
        session = self.session
        if session.journal is not None:
            session.journal.close()
        if session.fit.fitted is None:
            why = session.no_fit or worded("nothing was touched")
            count = len(session.fit.counting())
            return [journal], [worded("{count} touches are too few for a fit ({why}).", count=count, why=why)]
        study, said = write_study(session.fit, self._folder)
        result = write_result(study)
        left = [("study", study), ("arm", self._folder / "arm.toml"), ("result", study.parent / RESULT / "result.json")]
        if judge(result, study, self._begun) is not None:
            left.append(("evaluation", study.parent / FOLDER / FILE))
        if not result.fit.converged:
            said = [not_converged(result.fit.termination), *said]
        return [*left, journal], said

    def _event(self, event: Event) -> Iterator[LiveEvent]:
        match event:
            case Fault():
                if event.kind not in ORDINARY:
                    yield FaultEvent(kind=event.kind, sentence=event.text)
            case Refused():
                yield RefusedEvent(sentence=worded("Not taken: {reason}.", reason=event.reason))
                if self._follows:
                    yield self._known()
                    yield from self._play()
            case Happened():
                self._told[event.touch.number] = event
                names = list(self.session.spec.artefact.features)
                said = touch_said(self.session, event.touch, event)
                yield TouchEvent(touch=said, sentences=happened_lines(event, names))
                yield self._known()
                yield from self._play()

    def _known(self) -> KnownEvent:
        session = self.session
        self._meter = meter = session.meter()
        free = session.fit.free()
        own = np.flatnonzero(free < len(session.arm_now.parameter_names))
        self._covariance = free[own], np.ascontiguousarray(meter.so_far.covariance[np.ix_(own, own)])
        return KnownEvent(meter=meter_said(session.fit, meter), next=next_said(session.arm_now, meter))

    def _play(self) -> Iterator[LiveEvent]:
        """The virtual hand goes on, unless there is nothing more to reach."""
        for _ in range(TRIES):
            if not self._follows or self._player is None or self._meter is None or self._reached():
                return
            if self._player.follow(self._meter.next):
                return
            self.session.guide.refused(self._meter.next)
            self.session.moved()
            yield self._known()
        raise UlnaInputError(
            worded("the virtual arm does not reach what it is to touch: nothing more is touched by itself.")
        )

    def _reached(self) -> bool:
        meter = self._meter
        assert meter is not None
        if meter.fresh is not None:
            return meter.fresh.done >= meter.fresh.places
        return meter.goal_u_mm is not None and meter.worth.u_mm <= meter.goal_u_mm


def virtual_of(source: object) -> VirtualSource:
    """Raises NotNowError for an arm that only a hand can move."""
    if not isinstance(source, VirtualSource):
        raise NotNowError(worded("this arm is no virtual one: move it with your hand."))
    return source


def steer(source: VirtualSource, asked: DoGo) -> None:
    """A virtual arm goes where it is told. Raises UlnaInputError for a posture of another arm."""
    postures = [asked.q_deg, *asked.then_deg]
    for q_deg in postures:
        if len(q_deg) != source.arm.n:
            raise UlnaInputError(f"q_deg: got {len(q_deg)} angles; expected {source.arm.n}. Give one for each joint.")
    first, *others = (from_degrees(source.arm, q_deg) for q_deg in postures)
    source.steer(first)
    for each in others:
        source.go_to(each)
