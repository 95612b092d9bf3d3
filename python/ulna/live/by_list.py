"""Touches by a list: of a check or an acceptance test, each taken for the next step that is still to be touched.

It holds no screen and no keys, as a `Session` holds none. What happened is in its journal before it is told: before
each touch an event says which step it is, so that whatever is killed goes on.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.ending import touches_in
from ulna.live.faults import DOUBTFUL, Fault
from ulna.live.figures import Calibrated
from ulna.live.journal import EVENT, Journal, Reading
from ulna.live.postures import travel_of
from ulna.live.readout import UNSURE, sample_noise
from ulna.live.resting import Rests
from ulna.live.ring import Ring
from ulna.live.sources.virtual import VirtualSource
from ulna.live.stream import Frames, Stream
from ulna.live.touches import Touch, as_dict, present
from ulna.live.trigger import Refused, Taken, same_pose
from ulna.verification.to_touch import WorkList

AROUND_S = 1.0
"""Of the stream around each touch that the journal keeps."""
DONE = worded("all that is asked for is touched: end it, or take a touch back")


@dataclass(frozen=True)
class OfStep:
    """A touch that was taken."""

    touch: Touch
    step: int
    """Its index in the list."""


Happened = Fault | Refused | OfStep


class ByList:
    """One list, touched with one arm."""

    def __init__(
        self, stream: Stream, arm: Calibrated, work: WorkList, journal: Journal | None = None, by_itself: bool = True
    ) -> None:
        """by_itself: rests of the tip are touches. Raises UlnaInputError where the stream is not of such an arm, or
        rest cannot be told."""
        self.stream, self.arm, self.work, self.journal = stream, arm, work, journal
        channels = len(stream.mapping.names)
        if channels != arm.arm.n:
            raise UlnaInputError(
                worded(
                    "{path}: key 'map.channels': {channels} channels, but arm '{arm}' has {joints} joints; expected "
                    "one for each, q1 first. Name them in a source file.",
                    path=str(stream.stated.path),
                    channels=channels,
                    arm=arm.arm.name,
                    joints=arm.arm.n,
                )
            )
        self._sample_rad = _sample_rad(stream, arm)
        self._tells = self._sample_rad is not None or arm.noise.variance_mm2 > 0.0
        if by_itself and not self._tells:
            raise UlnaInputError(worded("arm '{arm}': {why}.", arm=arm.arm.name, why=UNSURE))
        stops = travel_of(arm.arm)
        stream.mapping.begin_within(stops)
        seat_mm = math.sqrt(arm.noise.variance_mm2)
        self._rests = Rests(stream, arm.tips_mm, self._covariance_mm2, seat_mm, stops, by_itself, from_the_first=False)
        self._ring = Ring(len(stream.source.hello.channels), 1 << 15)
        self._by_itself = by_itself
        self._doubtful_step: int | None = None
        self.touches: list[Touch] = []
        """All that were taken, those that do not count with their reason."""
        self.steps: dict[int, int] = {}
        """Number of a touch → index of its step."""

    # ------------------------------------------------------------ what comes

    def feed(self, frames: Frames) -> Iterator[Happened]:
        """What came, in order; what happened with it."""
        if any(fault.kind in DOUBTFUL for fault in frames.faults):
            self._rests.forget()
        for fault in frames.told:
            self._note({"fault": fault.as_dict()})
            yield fault
        if not len(frames.samples):
            return
        self._ring.push(frames.samples)
        for window in self._rests.windows(frames.samples, frames.q_rad):
            if window.button:
                yield self._answer(self._rests.ask(window) if self._tells else Refused(UNSURE))
            elif self._by_itself:
                found = self._rests.look(window)
                if found is not None:
                    yield self._answer(found)

    def ask(self) -> Happened:
        """A touch now, by a key or a pedal."""
        return self._answer(self._rests.ask() if self._tells else Refused(UNSURE))

    def trust(self) -> None:
        """Who holds the arm says that the angles are right again."""
        self._note({"trusted": True})
        self.stream.plausible.trust()

    def withdraw(self, number: int, reason: str) -> None:
        """A touch shall not count: its step is to be touched again. Nothing is deleted. Raises UlnaInputError."""
        own = next((k for k, each in enumerate(self.touches) if each.number == number), None)
        if own is None or self.touches[own].withdrawn is not None:
            raise UlnaInputError(worded("touch {number}: there is none that counts. Name another.", number=number))
        if self.journal is not None:
            self.journal.withdraw({"number": number, "reason": reason})
        self.touches[own] = replace(self.touches[own], withdrawn=reason)
        self._doubtful_step = None

    def go_on(self, touches: list[Touch], steps: Mapping[int, int]) -> None:
        """With those of a journal. Raises UlnaInputError where they are of another list."""
        if any(each.number not in steps or steps[each.number] >= len(self.work.listed) for each in touches):
            raise UlnaInputError(worded("the journal is of touches of another list; expected the same. Begin another."))
        self.touches, self.steps = list(touches), {each.number: steps[each.number] for each in touches}

    # ------------------------------------------------------------ what is known

    @property
    def counting(self) -> dict[int, Touch]:
        """The touches that count, by their steps, in the list's order."""
        found = {self.steps[each.number]: each for each in present(self.touches)}
        return dict(sorted(found.items()))

    @property
    def step(self) -> int | None:
        """The step that is to be touched; None where all is."""
        there = self.counting
        return next((k for k in range(len(self.work.listed)) if k not in there), None)

    @property
    def last(self) -> Touch | None:
        """The newest that counts."""
        return next((each for each in reversed(self.touches) if each.withdrawn is None), None)

    @property
    def rests(self) -> float:
        """For how much of the time for which it must the tip has been resting, 0 to 1."""
        return self._rests.share()

    def scatter_mm(self, step: int) -> float | None:
        """Standard deviation, per coordinate, of the touches at one place of an artefact about their mean; None of one
        alone, and where they need not be in one place."""
        listed = self.work.listed[step]
        own = [
            each.q_rad
            for k, each in self.counting.items()
            if self.work.listed[k].measurement == listed.measurement
            and self.work.listed[k].step.feature == listed.step.feature
        ]
        if len(own) < 2 or listed.wanted.apart(listed.step, listed.step, listed.true_mm, self.work.tip_mm)[1] > 0.0:
            return None
        at_mm = self.arm.tips_mm(np.array(own))
        return float(np.sqrt(((at_mm - at_mm.mean(axis=0)) ** 2).sum() / (len(own) - 1) / 3.0))

    # ------------------------------------------------------------ inside

    def _covariance_mm2(self, q_rad: F64) -> F64:
        if self._sample_rad is None:
            return self.arm.noise.variance_mm2 * np.eye(3)
        by_angle = self.arm.by_angle(q_rad)
        found: F64 = (by_angle * self._sample_rad**2) @ by_angle.T
        return found

    def _answer(self, found: Taken | Refused) -> Refused | OfStep:
        told = found if isinstance(found, Refused) else self._judged(found)
        if isinstance(told, Refused):
            self._note({"refused": told.reason})
        return told

    def _judged(self, found: Taken) -> Refused | OfStep:
        if self.stream.doubtful:
            return Refused(
                worded("the angles are in doubt since a fault of the stream: check the arm, then say they are right")
            )
        step = self.step
        if step is None:
            return Refused(DONE)
        again = self._again(found.q_rad, step)
        if again is not None:
            return Refused(
                worded("the same posture as touch {number}: move elbow and wrist between touches", number=again)
            )
        poses = np.array([found.q_rad, *(each.q_rad for each in self.counting.values())])
        at_mm, *others_mm = self.arm.tips_mm(poses)
        why = self.work.unlikely(step, at_mm, dict(zip(self.counting, others_mm, strict=True)))
        if why is not None and self._doubtful_step != step:
            self._doubtful_step = step
            return Refused(worded("{why}: touch what is asked for, or the same once more, and it is taken", why=why))
        self._doubtful_step = None
        touch = self._touch(found, step)
        self._keep(touch, step)
        self.touches.append(touch)
        self.steps[touch.number] = step
        return OfStep(touch, step)

    def _again(self, q_rad: F64, step: int) -> int | None:
        """Which touch of the same measurement has this posture, where none should."""
        listed = self.work.listed[step]
        own = [each for k, each in self.counting.items() if self.work.listed[k].measurement == listed.measurement]
        if not (listed.moved and own):
            return None
        which = same_pose(q_rad, np.array([each.q_rad for each in own]))
        return None if which is None else own[which].number

    def _touch(self, found: Taken, step: int) -> Touch:
        own = self.work.listed[step].step
        return Touch(
            number=max((each.number for each in self.touches), default=0) + 1,
            artefact=own.artefact or own.test,
            standing=own.position,
            feature="AB".find(own.feature) if own.feature else 0,
            probe=self.arm.arm.probe_index(self.arm.probe),
            q_rad=found.q_rad,
            begun_s=found.begun_s,
            ended_s=found.ended_s,
            samples=found.stillness.samples,
            spread_mm=found.stillness.spread_mm,
            drift_mm=found.stillness.drift_mm,
        )

    def _keep(self, touch: Touch, step: int) -> None:
        """On the disk, with the stream around it, before anybody hears of it."""
        if self.journal is None:
            return
        self.journal.samples(self._ring.last(AROUND_S))
        self.journal.event({"step": step, "of": touch.number})
        self.journal.touch(as_dict(touch))

    def _note(self, event: Mapping[str, object]) -> None:
        if self.journal is not None:
            self.journal.event(event)


def steps_in(path: Path) -> dict[int, int]:
    """Number of a touch of a journal → index of its step. Raises UlnaInputError."""
    found = {}
    for record in Reading(path):
        if record.kind == EVENT and "step" in record.content:
            found[int(record.content["of"])] = int(record.content["step"])
    return found


def touches_of(path: Path) -> tuple[list[Touch], dict[int, int]]:
    """Both, as `ByList.go_on` takes them. Raises UlnaInputError."""
    return touches_in(path), steps_in(path)


def _sample_rad(stream: Stream, arm: Calibrated) -> F64 | None:
    """(n,) noise of a sample of each encoder, as a read-out has it; of a virtual arm, where nobody states it, what it
    is played with."""
    known = sample_noise(stream, arm)
    source = stream.source
    if known is None and isinstance(source, VirtualSource) and source.noise_rad > 0.0:
        return np.full(arm.arm.n, source.noise_rad)
    return known
