"""Touches by a list: what a check and an acceptance test have in common, for a page."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.worded import worded
from ulna.live.by_list import ByList, OfStep
from ulna.live.by_list import Happened as ListEvent
from ulna.live.ending import JOURNAL
from ulna.live.faults import ORDINARY, Fault
from ulna.live.list_playing import ListHand
from ulna.live.stream import Frames
from ulna.live.trigger import Refused
from ulna.serve.activities.activity import Doing, unknown
from ulna.serve.activities.seen import Seen, tip_covariance
from ulna.serve.activities.steps_said import fallen_lines, lines_of, parts_said, present_said, taken_said, touches_said
from ulna.serve.activities.touching import steer, virtual_of
from ulna.serve.contract.guided import NotYet
from ulna.serve.contract.live import FaultEvent, LiveEvent, RefusedEvent, SaidEvent, StateEvent, TouchEvent
from ulna.serve.contract.model import shortened
from ulna.serve.contract.words import Do, DoFollow, DoGo, DoTakeBack, DoTouch, DoTrust, DoWithdraw
from ulna.serve.frames import Newest
from ulna.serve.problems import NotNowError
from ulna.verification.as_it_falls import SoFar, so_far
from ulna.verification.file import VerifyPlan
from ulna.verification.tables import State
from ulna.verification.verify import rule_of_plan

TAKEN_BACK = "taken back by whoever touched"
DONE = worded("All that is asked for is touched: end it, and it is evaluated.")


class Stepwise(Doing):
    """One list. What a kind adds is where its touches are written, and what becomes of them."""

    def __init__(self, by_list: ByList, folder: Path, by: str, name: str, state: State) -> None:
        """name: of the protocol, or the profile; state: of the arm that is touched."""
        self.by_list, self.stream = by_list, by_list.stream
        self._folder, self._by, self._name, self._state = folder, by, name, state
        self._so_far = SoFar()
        self._hand: ListHand | None = None
        self._follows = False
        self._newest: tuple[float, F64] | None = None
        if by_list.counting:
            self._evaluate()

    @abstractmethod
    def _written(self) -> VerifyPlan:
        """Writes the touches that count as the table that the command reads, and reads it as the command does."""

    @abstractmethod
    def _outcome(self) -> tuple[list[tuple[str, Path]], list[str]]:
        """Of a list of which all is touched: what `finish` leaves."""

    @abstractmethod
    def _table(self) -> Path:
        """Where the touches are written."""

    def begin(self) -> Iterator[LiveEvent]:
        """What is asked for first."""
        for remark in self.by_list.arm.remarks:
            yield SaidEvent(sentence=remark)
        yield StateEvent(state=self.state())

    def feed(self, frames: Frames) -> Iterator[LiveEvent]:
        """Touches by themselves or by the arm's button, why there is none, and faults."""
        if len(frames.samples):
            self._newest = float(frames.samples.t_s[-1]), frames.q_rad[-1]
        for event in self.by_list.feed(frames):
            yield from self._event(event)

    def do(self, asked: Do) -> Iterator[LiveEvent]:
        """As elsewhere."""
        by_list = self.by_list
        match asked:
            case DoTouch():
                yield from self._event(by_list.ask())
            case DoTakeBack():
                last = by_list.last
                if last is None:
                    raise NotNowError(worded("nothing is touched that could be taken back. Touch what is asked for."))
                yield from self._withdraw(last.number, TAKEN_BACK)
            case DoWithdraw():
                yield from self._withdraw(asked.number, asked.reason)
            case DoTrust():
                by_list.trust()
                yield SaidEvent(sentence=worded("The angles are taken for right again."))
            case DoGo():
                steer(virtual_of(self.stream.source), asked)
                if self._follows:
                    self._follows = False
                    yield StateEvent(state=self.state())
            case DoFollow():
                source = virtual_of(self.stream.source)
                if asked.follows and self._hand is None:
                    self._hand = ListHand(source, by_list.work)
                self._follows = asked.follows
                yield StateEvent(state=self.state())
                self._play()
            case _:
                raise unknown(asked, self.kind)

    def newest(self) -> Newest | None:
        """The arm where it is, and how sure its tip is."""
        if self._newest is None:
            return None
        (t_s, q_rad), calibrated = self._newest, self.by_list.arm
        probe = calibrated.arm.probe_index(calibrated.probe)
        covariance_mm2 = tip_covariance(calibrated, q_rad)
        return Seen(calibrated.arm, probe).newest(t_s, q_rad, self.stream.doubtful, self.by_list.rests, covariance_mm2)

    def finish(self) -> tuple[list[tuple[str, Path]], list[str]]:
        """The table of touches, and what the command finds in it; of a list that is not done it is written only, and
        the session can go on."""
        journal = ("journal", self._folder / JOURNAL)
        if self.by_list.journal is not None:
            self.by_list.journal.close()
        done, steps = len(self.by_list.counting), len(self.by_list.work.listed)
        if not done:
            return [journal], [worded("Nothing was touched.")]
        self._written()
        if done < steps:
            left = [("readings", self._table()), journal]
            return left, [
                worded(
                    "{done} of {steps} are touched: it is evaluated when all are. It can go on.", done=done, steps=steps
                )
            ]
        left, said = self._outcome()
        return [*left, ("readings", self._table()), journal], said

    def _common(self) -> dict[str, Any]:
        by_list = self.by_list
        parts, overall = parts_said(by_list, self._so_far)
        return {
            "name": self._name,
            "decision": rule_of_plan(by_list.work.plan).text,
            "by": self._by,
            "steps": len(by_list.work.listed),
            "done": len(by_list.counting),
            "present": present_said(by_list),
            "parts": parts,
            "overall": overall,
            "not_yet": [NotYet(test=test, why=shortened(why)) for test, why in self._so_far.not_yet.items()],
            "touches": touches_said(by_list),
            "follows": self._follows,
        }

    def _event(self, event: ListEvent) -> Iterator[LiveEvent]:
        match event:
            case Fault():
                if event.kind not in ORDINARY:
                    yield FaultEvent(kind=event.kind, sentence=event.text)
            case Refused():
                yield RefusedEvent(sentence=worded("Not taken: {reason}.", reason=event.reason))
                self._play()
            case OfStep():
                # the tone before the figures: these take their time
                yield TouchEvent(touch=taken_said(self.by_list, event), sentences=lines_of(self.by_list, event))
                self._evaluate()
                yield StateEvent(state=self.state())
                for line in fallen_lines(self.by_list, event.step, self._so_far):
                    yield SaidEvent(sentence=line)
                if self.by_list.step is None:
                    yield SaidEvent(sentence=DONE)
                self._play()

    def _withdraw(self, number: int, reason: str) -> Iterator[LiveEvent]:
        self.by_list.withdraw(number, reason)
        self._evaluate()
        yield SaidEvent(sentence=worded("Touch {number} does not count any more.", number=number))
        yield StateEvent(state=self.state())
        self._play()

    def _evaluate(self) -> None:
        touched = list(self.by_list.counting)
        self._so_far = SoFar() if not touched else so_far(self._written(), self._state, self.by_list.work, touched)

    def _play(self) -> None:
        """The virtual hand goes on, unless all is touched."""
        step = self.by_list.step
        if self._follows and self._hand is not None and step is not None:
            self._hand.follow(step)

    def _readings(self) -> tuple[list[tuple[int, Any]], F64]:
        """Steps that are touched, by their indices, and (N, n) angles of each."""
        counting = self.by_list.counting
        steps = self.by_list.work.steps
        q_rad = np.array([each.q_rad for each in counting.values()], dtype=np.float64)
        return [(k, steps[k]) for k in counting], q_rad
