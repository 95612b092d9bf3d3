"""A session at the arm: from a stream to touches, and after each what is known, what was wrong and where to touch next.

It holds no screen and no keys: whoever shows it gives it the frames that came and what was asked for, and gets back
what happened. All that happened is in its journal before it is told.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.kinds import kind_of
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import kept, worded
from ulna.live.events import Event, Happened, Meter
from ulna.live.faults import DOUBTFUL
from ulna.live.fresh import Fresh, done, next_fresh, stands_still
from ulna.live.guide import Guide, Suggestion
from ulna.live.journal import Journal
from ulna.live.lacking import Lacking, lacking, never
from ulna.live.places import Expected, Tip, Told, tell
from ulna.live.postures import travel_of
from ulna.live.purpose import options_of
from ulna.live.resting import Rests
from ulna.live.ring import Ring
from ulna.live.running import RunningFit, SoFar
from ulna.live.stream import Frames, Stream
from ulna.live.touches import Touch, as_dict, held_out, present, tips
from ulna.live.trigger import Refused, Taken, same_pose
from ulna.live.worth import Worth
from ulna.planning.spec import PlanSpec
from ulna.study.data import FitOptions, Noise

AROUND_S = 1.0
"""Of the stream around each touch that its journal keeps."""
REFIT_TO = 500
"""Touches up to which the arm is fitted after each; with more after every tenth."""
SUSPICIOUS = 5.0
"""A touch that is off by so many times the scatter of the others is asked about."""


def _check_signs(arm: Arm) -> None:
    """Raises UlnaInputError where nobody knows which way an encoder counts: the tip would be anywhere."""
    unknown = ", ".join(str(k) for k, joint in enumerate(arm.joints, start=1) if joint.sign == 0)
    if unknown:
        raise UlnaInputError(
            f"arm '{arm.name}': sign = 0 of joint {unknown}: which way it counts is not known, and where the tip is "
            "follows from it; expected 1 or -1. Find it with ulna live commission and --zeros posture, or calibrate "
            "once from a table of readings (ulna new)."
        )


class Session:
    """Touches of one artefact by one arm.

    spec: what is touched, what the readings' noise is, where it can stand and what lengths the arm is for, as of a
    plan. fit: what is fitted, as of a study; without it all that the plan does not hold.
    """

    def __init__(
        self,
        arm: Arm,
        spec: PlanSpec,
        stream: Stream,
        journal: Journal | None = None,
        *,
        fit: FitOptions | None = None,
        goal_u_mm: float | None = None,
        by_itself: bool = True,
        keep_all: bool = False,
    ) -> None:
        """Raises UlnaInputError where the stream is not of this arm."""
        channels = len(stream.mapping.columns)
        if channels != arm.n:
            raise UlnaInputError(
                worded(
                    "{device}: {channels} channels are mapped to joints, arm '{arm}' has {joints}; expected one for "
                    "each. Say which they are: key 'map.channels' of a source file.",
                    device=stream.source.hello.device,
                    channels=channels,
                    arm=arm.name,
                    joints=arm.n,
                )
            )
        _check_signs(arm)
        self.arm, self.spec, self.stream, self.journal = arm, spec, stream, journal
        self.goal_u_mm, self.by_itself, self.keep_all = goal_u_mm, by_itself, keep_all
        noise = Noise(spec.encoder_rad, spec.seat_mm or None)
        self.fit = RunningFit(arm, [spec.artefact], noise, fit or options_of(spec))
        self.guide = Guide(self.fit, spec)
        self.determinable = self.guide.determinable
        self._never = never(self.fit, self.guide)
        self.place = 0
        """Number of the place where the artefact stands; 0 before the first touch."""
        self._against = 0
        self._probe = arm.probe_index(spec.probe)
        self._suggestion: Suggestion | None = None
        self._ring = Ring(len(stream.source.hello.channels), 1 << 15)
        self._sample_rad = spec.encoder_rad if stream.sample_rad is None else stream.sample_rad
        stream.mapping.begin_within(travel_of(arm))
        self._rests = Rests(
            stream, self._tips_mm, self._covariance_mm2, spec.seat_mm, travel_of(arm), by_itself, from_the_first=False
        )
        self.fresh_places = 0
        """Fresh places that are asked for: touches are held out; 0: they are fitted."""
        self.no_fit: str | None = None
        """Why the touches so far are not fitted, in words; None: they are, or there are none."""

    # ------------------------------------------------------------ what comes

    def feed(self, frames: Frames) -> Iterator[Event]:
        """What came, in order; what happened with it."""
        if any(fault.kind in DOUBTFUL for fault in frames.faults):
            self._rests.forget()
        for fault in frames.told:
            if self.journal is not None:
                self.journal.event({"fault": fault.as_dict()})
            yield fault
        samples = frames.samples
        if not len(samples):
            return
        if self.keep_all and self.journal is not None:
            self.journal.samples(samples)
        self._ring.push(samples)
        for window in self._rests.windows(samples, frames.q_rad):
            found = self._rests.ask(window) if window.button else self._rests.look(window)
            if found is not None:
                yield self._answer(found)

    def ask(self) -> Event:
        """A touch now, by a key or a pedal."""
        window = self._rests.newest()
        if self.journal is not None and window is not None:
            self.journal.event({"asked_s": float(window.t_s[-1])})
        return self._answer(self._rests.ask())

    def trust(self) -> None:
        """Who holds the arm says that the angles are right again."""
        if self.journal is not None:
            self.journal.event({"trusted": True})
        self.stream.plausible.trust()

    def moved(self) -> None:
        """The artefact was put elsewhere."""
        self.place += 1
        if self.journal is not None:
            self.journal.event({"place": self.place})
        self._suggestion = None

    def hold_out(self, places: int) -> None:
        """From now on touches are not fitted, but judge the fit, in so many fresh places; 0: they are fitted again.
        Raises UlnaInputError where there is nothing to judge."""
        if places and self.fit.fitted is None:
            raise UlnaInputError(
                worded(
                    "held out: {count} touches are too few for a fit; expected one to be judged. Touch on where it is "
                    "suggested, then hold out.",
                    count=len(self.fit.counting()),
                )
            )
        self.fresh_places = places
        if self.journal is not None:
            self.journal.event({"held_out": places})
        self.moved()
        if self.journal is not None:
            self.journal.flush()

    def withdraw(self, number: int, reason: str) -> None:
        """A touch shall not count; nothing of it is deleted. Raises UlnaInputError."""
        self.fit.withdraw(number, reason)
        if self.journal is not None:
            self.journal.withdraw({"number": number, "reason": reason})
        self._refit()

    def go_on(self, touches: list[Touch], fresh_places: int = 0) -> None:
        """With touches of a session that was interrupted; fresh_places: for how many it was holding out."""
        self.fresh_places = fresh_places
        for touch in touches:
            self.fit.add(replace(touch, withdrawn=None))
        for touch in touches:
            if touch.withdrawn is not None:
                self.fit.withdraw(touch.number, touch.withdrawn)
        self.place = max((int(touch.standing) for touch in touches), default=0)
        if any(each.held_out != bool(fresh_places) for each in self._own()):
            self.place += 1  # what judges stands in no place of what is fitted
        self._refit()

    # ------------------------------------------------------------ what is known

    def meter(self) -> Meter:
        """What is known now, and where to touch next."""
        so_far = self.fit.so_far()
        worth = self.guide.worth(so_far)
        if self.fresh_places:
            return self._holding_out(so_far, worth)
        suggestion = self.guide.next(so_far, str(self.place) if self.place else None)
        self._suggestion = suggestion
        more = None if self.goal_u_mm is None else self.guide.touches_more(so_far, self.goal_u_mm)
        return Meter(so_far, self.determinable, worth, self.goal_u_mm, more, suggestion, self._lacking(so_far))

    def _holding_out(self, so_far: SoFar, worth: Worth) -> Meter:
        held, place = held_out(self.fit.touches), max(self.place, 1)
        own = [touch for touch in held if touch.standing == str(place)]
        self._suggestion = suggestion = next_fresh(self.guide, place, own)
        fresh = Fresh(self.fresh_places, done(self.guide, held))
        known = self._lacking(so_far)
        return Meter(so_far, self.determinable, worth, self.goal_u_mm, None, suggestion, known, fresh)

    def _lacking(self, so_far: SoFar) -> Lacking:
        # of one touch in each place nothing can be said: no row of them is left
        return lacking(self.fit.tell(), self._never) if so_far.determined else Lacking(self._never)

    @property
    def rests(self) -> float:
        """For how much of the time for which it must the tip has been resting, 0 to 1."""
        return self._rests.share()

    @property
    def tip_mm(self) -> F64 | None:
        """(3,) where the tip is, by the arm as it is known; None where nothing came yet."""
        window = self._rests.newest()
        return None if window is None else self._tip_mm(window.q_rad[-1])

    @property
    def arm_now(self) -> Arm:
        """The arm as it is known."""
        return self.fit.arm

    # ------------------------------------------------------------ inside

    def _tips_mm(self, q_rad: F64) -> F64:
        """By the arm as it was at the beginning: whether a tip rests must not depend on how well the arm is known."""
        return self.arm.core.tip(q_rad, self._probe)

    def _covariance_mm2(self, q_rad: F64) -> F64:
        jacobian = self.arm.core.encoder_jacobian(q_rad[None], self._probe)[0]
        found: F64 = (jacobian * self._sample_rad**2) @ jacobian.T
        return found

    def _tip_mm(self, q_rad: F64) -> F64:
        found: F64 = self.arm_now.core.tip(np.ascontiguousarray(q_rad[None]), self._probe)[0]
        return found

    def _answer(self, found: Taken | Refused) -> Refused | Happened:
        """A rest as a touch, or why it is none; in the journal before it is told."""
        told = found if isinstance(found, Refused) else self._judged(found)
        if isinstance(told, Refused) and self.journal is not None:
            self.journal.event({"refused": told.reason})
        return told

    def _judged(self, found: Taken) -> Refused | Happened:
        if self.stream.doubtful:
            return Refused(
                worded("the angles are in doubt since a fault of the stream: check the arm, then say they are right")
            )
        next_one = self._suggestion
        expected = None if next_one is None else Expected(next_one.feature, next_one.here)
        told = tell(self.fit, self.spec.artefact, self._own(), Tip(found.q_rad, self._probe), expected)
        again = self._again(found, told)
        if again is not None:
            if self._suggestion is not None:
                self.guide.refused(self._suggestion)
            return Refused(
                worded("the same pose as touch {number}, which tells nothing new: take another posture", number=again)
            )
        if self.fresh_places and self._stands_still(found, told):
            return Refused(worded("it stands where it was touched before: put it in a fresh place, to judge by"))
        if expected is None or expected.here:
            self._against = self._against + 1 if told.moved else 0
        self.place = self.place + 1 if told.moved else max(self.place, 1)
        touch = self._touch(found, told.feature)
        self._keep(touch)
        self.fit.add(touch)
        if touch.held_out:
            return Happened(touch, told.moved, self._scatter(touch), None, None, told.apart_mm)
        self._refit()
        off_mm, times = self._off(touch)
        return Happened(touch, told.moved, self._scatter(touch), off_mm, times, told.apart_mm, self._against)

    def _touch(self, found: Taken, feature: int) -> Touch:
        return Touch(
            number=max((each.number for each in self.fit.touches), default=0) + 1,
            artefact=self.spec.artefact.name,
            standing=str(self.place),
            feature=feature,
            probe=self._probe,
            q_rad=found.q_rad,
            begun_s=found.begun_s,
            ended_s=found.ended_s,
            samples=found.stillness.samples,
            spread_mm=found.stillness.spread_mm,
            drift_mm=found.stillness.drift_mm,
            held_out=bool(self.fresh_places),
        )

    def _own(self) -> list[Touch]:
        name, place = self.spec.artefact.name, str(self.place)
        return [each for each in present(self.fit.touches) if (each.artefact, each.standing) == (name, place)]

    def _stands_still(self, found: Taken, told: Told) -> bool:
        """Whether what is to be a fresh place is none."""
        if self._own() and not told.moved:
            return False
        others = present(self.fit.touches)
        earlier_mm = tips(self.arm_now, others) if others else np.zeros((0, 3))
        return stands_still(self.spec.artefact, earlier_mm, self._tip_mm(found.q_rad))

    def _again(self, found: Taken, told: Told) -> int | None:
        own = [] if told.moved else [each for each in self._own() if each.feature == told.feature]
        if kind_of(self.spec.artefact).scattered or not own:
            return None
        which = same_pose(found.q_rad, np.array([each.q_rad for each in own]))
        return None if which is None else own[which].number

    def _keep(self, touch: Touch) -> None:
        """On the disk, with the stream around it, before anybody hears of it."""
        if self.journal is None:
            return
        if not self.keep_all:
            self.journal.samples(self._ring.last(AROUND_S))
        self.journal.touch(as_dict(touch))

    def _refit(self) -> None:
        count = len(self.fit.counting())
        if count == 0 or (count > REFIT_TO and count % 10):
            return
        try:
            self.fit.refit()
            self.no_fit = None
        except UlnaInputError as error:
            # too few, at first: what is known so far is told all the same
            self.no_fit = kept(error)

    def _scatter(self, touch: Touch) -> float | None:
        own = [each for each in self._own() if each.feature == touch.feature]
        if len(own) < 2 or self.fit.fitted is None or kind_of(self.spec.artefact).scattered:
            return None
        at_mm = tips(self.arm_now, own)
        return float(np.sqrt(((at_mm - at_mm.mean(axis=0)) ** 2).sum() / (len(own) - 1) / 3.0))

    def _off(self, touch: Touch) -> tuple[float | None, float | None]:
        fitted = self.fit.fitted
        count = self.fit.counting()
        if fitted is None or len(count) > REFIT_TO:
            return None, None
        row = [each.number for each in count].index(touch.number)
        residual = fitted.residuals(0)
        if row >= len(residual):
            return None, None
        return float(np.linalg.norm(residual[row])), float(fitted.lengths(0)[row])
