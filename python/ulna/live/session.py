"""A session at the arm: from a stream to touches, and after each what is known, what was wrong and where to touch next.

It holds no screen and no keys: whoever shows it gives it the frames that came and what was asked for, and gets back
what happened. All that happened is in its journal before it is told.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.kinds import kind_of
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.live.faults import DOUBTFUL, Fault
from ulna.live.guide import Guide, Suggestion, Worth
from ulna.live.journal import Journal
from ulna.live.places import tell
from ulna.live.recent import Recent, Window
from ulna.live.ring import Ring
from ulna.live.running import RunningFit, SoFar
from ulna.live.samples import Samples
from ulna.live.still import StillLimits, stillness
from ulna.live.stream import Frames, Stream
from ulna.live.touches import Touch, tips
from ulna.live.trigger import Refused, Taken, Trigger, same_pose
from ulna.planning.spec import PlanSpec
from ulna.study.data import FitOptions, Noise

AROUND_S = 1.0
"""Of the stream around each touch that its journal keeps."""
RATE_S = 1.0
"""Of a stream that does not say its rate, so much is looked at."""
REFIT_TO = 500
"""Touches up to which the arm is fitted after each; with more after every tenth."""
SUSPICIOUS = 5.0
"""A touch that is off by so many times the scatter of the others is asked about."""


@dataclass(frozen=True)
class Meter:
    """What is known after a touch."""

    so_far: SoFar
    determinable: int
    """Combinations of parameters that touches of this artefact can determine."""
    worth: Worth
    goal_u_mm: float | None
    touches_more: int | None
    """About how many to the goal."""
    next: Suggestion


@dataclass(frozen=True)
class Happened:
    """A touch that was taken."""

    touch: Touch
    moved: bool
    """Whether the artefact was taken for moved."""
    scatter_mm: float | None
    """Standard deviation of the touches of this feature in this place about their mean; None for one alone."""
    off_mm: float | None
    """What the fit leaves of it; None before there is a fit."""
    times: float | None
    """The same in units of the scatter of all."""


Event = Fault | Refused | Happened


class Session:
    """Touches of one artefact by one arm.

    spec: what is touched, what the readings' noise is, where it can stand and what lengths the arm is for, as of a
    plan.
    """

    def __init__(
        self,
        arm: Arm,
        spec: PlanSpec,
        stream: Stream,
        journal: Journal | None = None,
        *,
        goal_u_mm: float | None = None,
        by_itself: bool = True,
        keep_all: bool = False,
    ) -> None:
        """Raises UlnaInputError where the stream is not of this arm."""
        channels = len(stream.mapping.columns)
        if channels != arm.n:
            raise UlnaInputError(
                f"{stream.source.hello.device}: {channels} channels are mapped to joints, arm '{arm.name}' has "
                f"{arm.n}; expected one for each. Say which they are: key 'map.channels' of a source file."
            )
        self.arm, self.spec, self.stream, self.journal = arm, spec, stream, journal
        self.goal_u_mm, self.by_itself, self.keep_all = goal_u_mm, by_itself, keep_all
        noise = Noise(spec.encoder_rad, spec.seat_mm or None)
        self.fit = RunningFit(arm, [spec.artefact], noise, FitOptions(hold=list(spec.hold)))
        self.guide = Guide(self.fit, spec)
        self.determinable = self.guide.determinable
        self.place = 0
        """Number of the place where the artefact stands; 0 before the first touch."""
        self._probe = arm.probe_index(spec.probe)
        self._suggestion: Suggestion | None = None
        self._ring = Ring(len(stream.source.hello.channels), 1 << 15)
        self._recent: Recent | None = None
        self._early: list[tuple[Samples, F64]] = []
        """What came before the rate was known."""
        self._trigger: Trigger | None = None
        self._covariance_mm2: F64 = np.eye(3)
        self.window: Window | None = None
        """The newest that was looked at."""

    # ------------------------------------------------------------ what comes

    def feed(self, frames: Frames) -> Iterator[Event]:
        """What came, in order; what happened with it."""
        for fault in frames.faults:
            if self.journal is not None:
                self.journal.event({"fault": fault.as_dict()})
            if fault.kind in DOUBTFUL and self._recent is not None:
                self._recent.forget()
            yield fault
        samples = frames.samples
        if not len(samples):
            return
        if self.keep_all and self.journal is not None:
            self.journal.samples(samples)
        self._ring.push(samples)
        if self._recent is None:
            self._early.append((samples, frames.q_rad))
            rate_hz = self._rate_hz()
            if rate_hz is None:
                return
            recent = self._begin(frames, rate_hz)
            waiting, self._early = self._early, []
        else:
            recent, waiting = self._recent, [(samples, frames.q_rad)]
        for some, q_rad in waiting:
            for window in recent.push(some, q_rad):
                self.window = window
                yield from self._look(window)

    def ask(self) -> Iterator[Event]:
        """A touch now, by a key or a pedal."""
        if self.journal is not None and self.window is not None:
            self.journal.event({"asked_s": float(self.window.t_s[-1])})
        if self.window is None or self._trigger is None:
            yield Refused("nothing has come yet")
            return
        yield from self._asked(self.window)

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

    def withdraw(self, number: int, reason: str) -> None:
        """A touch shall not count; nothing of it is deleted. Raises UlnaInputError."""
        self.fit.withdraw(number, reason)
        if self.journal is not None:
            self.journal.withdraw({"number": number, "reason": reason})
        self._refit()

    def go_on(self, touches: list[Touch]) -> None:
        """With touches of a session that was interrupted."""
        for touch in touches:
            self.fit.add(replace(touch, withdrawn=None))
        for touch in touches:
            if touch.withdrawn is not None:
                self.fit.withdraw(touch.number, touch.withdrawn)
        self.place = max((int(touch.standing) for touch in touches), default=0)
        self._refit()

    # ------------------------------------------------------------ what is known

    def meter(self) -> Meter:
        """What is known now, and where to touch next."""
        so_far = self.fit.so_far()
        worth = self.guide.worth(so_far)
        suggestion = self.guide.next(so_far, str(self.place) if self.place else None)
        self._suggestion = suggestion
        more = None if self.goal_u_mm is None else self.guide.touches_more(so_far, self.goal_u_mm)
        return Meter(so_far, self.determinable, worth, self.goal_u_mm, more, suggestion)

    @property
    def rests(self) -> float:
        """How much of the time has passed for which the tip must rest, 0 to 1: 0 while it moves."""
        if self.window is None or self._trigger is None or len(self.window.t_s) < 4:
            return 0.0
        t_s = self.window.t_s
        p_mm = self.arm_now.core.tip(self.window.q_rad, self._probe)
        # the longest end of the window that rests, by halves
        for part in (1.0, 0.5, 0.25):
            first = int(np.searchsorted(t_s, t_s[-1] - part * self._trigger.limits.window_s))
            if len(t_s) - first >= 4 and t_s[-1] - t_s[0] >= part * self._trigger.limits.window_s * 0.999:
                found = stillness(t_s[first:], p_mm[first:], self._covariance_mm2, self._trigger.limits)
                if found.still:
                    return part
        return 0.0

    @property
    def arm_now(self) -> Arm:
        """The arm as it is known."""
        return self.fit.arm

    # ------------------------------------------------------------ inside

    def _rate_hz(self) -> float | None:
        """As the source says, or as its first second shows; None until then. By the samples' own times: the same
        however they came in."""
        stated = self.stream.source.hello.rate_hz
        if stated:
            return stated
        t_s = np.concatenate([samples.t_s for samples, _ in self._early])
        over = np.flatnonzero(t_s - t_s[0] >= RATE_S)
        return None if not len(over) else float(over[0] / (t_s[over[0]] - t_s[0]))

    def _begin(self, frames: Frames, rate_hz: float) -> Recent:
        """Limits for this stream's rate and noise."""
        q_rad = frames.q_rad[-1]
        jacobian = self.arm.core.encoder_jacobian(np.ascontiguousarray(q_rad[None]), self._probe)[0]
        covariance = (jacobian * self.spec.encoder_rad**2) @ jacobian.T
        noise_mm = float(np.sqrt(max(np.trace(covariance) / 3.0, 0.0)))
        limits = StillLimits.of(noise_mm, rate_hz, self.spec.seat_mm)
        limits = limits.stated_by(self.stream.stated.file.still, rate_hz)
        # an endless joint has no stop
        stops = [joint.limits_rad or (np.nan, np.nan) for joint in self.arm.joints]
        self._trigger = Trigger(limits, np.array(stops, dtype=np.float64), self.by_itself)
        self._recent = Recent(self.arm.n, limits.window_s * 1.05)
        return self._recent

    def _look(self, window: Window) -> Iterator[Event]:
        assert self._trigger is not None
        if window.button:
            yield from self._asked(window)
            return
        p_mm = self._tips(window)
        found = self._trigger.look(window.t_s, window.q_rad, p_mm, self._covariance_mm2)
        if found is not None:
            yield from self._taken(found, p_mm)

    def _asked(self, window: Window) -> Iterator[Event]:
        assert self._trigger is not None
        p_mm = self._tips(window)
        yield from self._taken(self._trigger.ask(window.t_s, window.q_rad, p_mm, self._covariance_mm2), p_mm)

    def _tips(self, window: Window) -> F64:
        core = self.arm.core
        last = np.ascontiguousarray(window.q_rad[-1:])
        jacobian = core.encoder_jacobian(last, self._probe)[0]
        self._covariance_mm2 = (jacobian * self.spec.encoder_rad**2) @ jacobian.T
        return core.tip(np.ascontiguousarray(window.q_rad), self._probe)

    def _taken(self, found: Taken | Refused, p_mm: F64) -> Iterator[Event]:
        if isinstance(found, Taken):
            found = self._doubt(found)
        if isinstance(found, Refused):
            if self.journal is not None:
                self.journal.event({"refused": found.reason})
            yield found
            return
        tip_mm = self.arm_now.core.tip(found.q_rad[None], self._probe)[0]
        expected = None if self._suggestion is None else self._suggestion.feature
        told = tell(self.arm_now, self.spec.artefact, self._own(), tip_mm, expected)
        again = self._again(found, told.feature, told.moved)
        if again is not None:
            yield Refused(f"the same pose as touch {again}, which tells nothing new: take another posture")
            return
        if told.moved or not self.place:
            self.place += 1
        touch = Touch(
            number=max((each.number for each in self.fit.touches), default=0) + 1,
            artefact=self.spec.artefact.name,
            standing=str(self.place),
            feature=told.feature,
            probe=self._probe,
            q_rad=found.q_rad,
            begun_s=found.begun_s,
            ended_s=found.ended_s,
            samples=found.stillness.samples,
            spread_mm=found.stillness.spread_mm,
            drift_mm=found.stillness.drift_mm,
        )
        self._keep(touch)
        self.fit.add(touch)
        self._refit()
        off_mm, times = self._off(touch)
        yield Happened(touch, told.moved and self.place > 1, self._scatter(touch), off_mm, times)

    def _doubt(self, found: Taken) -> Taken | Refused:
        if self.stream.doubtful:
            return Refused(
                "the angles are in doubt since a fault of the stream: check the arm, then say they are right"
            )
        return found

    def _own(self) -> list[Touch]:
        name, place = self.spec.artefact.name, str(self.place)
        return [each for each in self.fit.counting() if (each.artefact, each.standing) == (name, place)]

    def _again(self, found: Taken, feature: int, moved: bool) -> int | None:
        own = [] if moved else [each for each in self._own() if each.feature == feature]
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
        except UlnaInputError:
            # too few for a fit: what is known so far is told all the same
            return

    def _scatter(self, touch: Touch) -> float | None:
        own = [each for each in self._own() if each.feature == touch.feature]
        if len(own) < 2 or kind_of(self.spec.artefact).scattered:
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


def as_dict(touch: Touch) -> dict[str, Any]:
    """As a journal has it: JSON types, every digit."""
    return asdict(touch) | {"q_rad": touch.q_rad.tolist()}


def from_dict(record: dict[str, Any]) -> Touch:
    """What `as_dict` made."""
    return Touch(**{**record, "q_rad": np.array(record["q_rad"], dtype=np.float64)})
