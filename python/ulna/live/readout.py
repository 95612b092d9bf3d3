"""What is read out of a stream with a calibrated arm: where its tip is, how sure that is, and points that are taken.

Lengths mm, angles rad, times s of the stream's own clock.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.faults import DOUBTFUL
from ulna.live.features import Feature, Notebook, Point
from ulna.live.figures import LENGTH, Calibrated, Figure
from ulna.live.postures import folded, near_stops, travel_of
from ulna.live.recent import HOP_S, Window
from ulna.live.resting import Rests
from ulna.live.still import StillLimits, Stillness
from ulna.live.stream import Frames, Stream
from ulna.live.trigger import Refused, Taken

TIP_S = 0.1
"""So often a program is told where the tip is."""
UNSURE = worded(
    "how its encoders scatter is not known, so nothing tells rest from motion. State --encoder-u, or give a result"
)


@dataclass(frozen=True)
class Tip:
    """Where the tip is now."""

    t_s: float
    q_rad: F64
    """(n,) the newest angles."""
    figures: tuple[Figure, ...]
    """x, y, z; without values where the place is not determined."""
    stillness: Stillness | None
    """Over the last moments; None as long as they are too few, or nothing tells."""
    warnings: tuple[str, ...]
    to: str | None
    """Name of the point that the distance is to."""
    distance: Figure | None

    def as_dict(self) -> dict[str, Any]:
        """As JSON has it."""
        found: dict[str, Any] = {"t_s": self.t_s} | {each.name: each.as_dict() for each in self.figures}
        found["still"] = None if self.stillness is None else self.stillness.still
        if self.distance is not None:
            found["distance"] = {"to": self.to} | self.distance.as_dict()
        return found | {"q_rad": self.q_rad.tolist(), "warnings": list(self.warnings)}


@dataclass(frozen=True)
class Set:
    """A point that was taken, and what it became part of."""

    point: Point
    feature: Feature


Said = Tip | Set | Refused


class ReadOut:
    """Reads one stream with one arm."""

    def __init__(
        self, stream: Stream, arm: Calibrated, notebook: Notebook, by_itself: bool = False, to: str | None = None
    ) -> None:
        """by_itself: rests of the tip are touches. to: name of the point to which distances are shown; the last one
        where it is not given. Raises UlnaInputError where the stream is not of such an arm, or rest cannot be told."""
        self.stream, self.arm, self.notebook, self.to = stream, arm, notebook, to
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
        self._sample_rad = sample_noise(stream, arm)
        if self._sample_rad is None and arm.noise.variance_mm2 == 0.0 and by_itself:
            raise UlnaInputError(worded("arm '{arm}': {why}.", arm=arm.arm.name, why=UNSURE))
        self._by_itself = by_itself
        stops, seat_mm = travel_of(arm.arm), math.sqrt(arm.noise.variance_mm2)
        stream.mapping.begin_within(stops)
        self._rests = Rests(stream, arm.tips_mm, self._covariance_mm2, seat_mm, stops, by_itself)
        self._newest: tuple[float, F64] | None = None
        self._tip_s = -math.inf
        self._known: dict[tuple[str, str, tuple[float, ...]], list[Figure]] = {}
        self.doubt: str | None = None
        """Why the angles may be wrong; None: nothing says so."""

    @property
    def limits(self) -> StillLimits | None:
        """How long, and how still, a touch is; None as long as the stream's rate is not known."""
        return self._rests.limits

    def take(self, frames: Frames, tips: bool = False) -> Iterator[Said]:
        """What came, and what follows from it: touches by themselves or by the arm's button, why there is none; with
        `tips` each `TIP_S` where the tip is."""
        for fault in frames.faults:
            if fault.kind in DOUBTFUL:
                self.doubt = fault.text
                self._forget()
        if not len(frames.samples):
            return
        for window in self._rests.windows(frames.samples, frames.q_rad):
            self._newest = float(window.t_s[-1]), window.q_rad[-1]
            if tips and not 0.0 <= window.t_s[-1] - self._tip_s < TIP_S - 0.5 * HOP_S:
                self._tip_s = float(window.t_s[-1])
                yield self._tip(window)
            yield from self._looked(window)
        self._newest = float(frames.samples.t_s[-1]), frames.q_rad[-1]

    def ask(self) -> Set | Refused:
        """A touch, now."""
        if self.doubt is not None:
            return Refused(worded("the angles may be wrong: {doubt}", doubt=self.doubt))
        if self._rests.newest() is not None and not self._tells:
            return Refused(UNSURE)
        return self._answer(self._rests.ask())

    def trust(self) -> None:
        """Somebody looked, and says that the angles are right."""
        self.stream.plausible.trust()
        self.doubt = None

    def now(self) -> Tip | None:
        """Where the tip is; None where nothing came yet."""
        if self._newest is None:
            return None
        window = self._rests.newest()
        return self._tip(window or Window(np.array([self._newest[0]]), self._newest[1][None], False))

    def figures(self, feature: Feature) -> list[Figure]:
        """A feature's values, found once as long as its points are the same."""
        key = feature.name, feature.kind, tuple(point.begun_s for point in feature.points)
        if key not in self._known:
            self._known[key] = feature.figures(self.arm)
        return self._known[key]

    @property
    def _tells(self) -> bool:
        """Whether something is known by which rest is told from motion."""
        return self._sample_rad is not None or self.arm.noise.variance_mm2 > 0.0

    def _forget(self) -> None:
        self._newest = None
        self._rests.forget()

    def _looked(self, window: Window) -> Iterator[Said]:
        if self.doubt is not None or not (self._by_itself or window.button):
            return
        if window.button:
            yield self._answer(self._rests.ask(window)) if self._tells else Refused(UNSURE)
            return
        found = self._rests.look(window)
        if found is not None:
            yield self._answer(found)

    def _answer(self, found: Taken | Refused) -> Set | Refused:
        if isinstance(found, Refused):
            return found
        name, rest = self.notebook.next_name(), found.stillness
        figures = tuple(self.arm.point(found.q_rad, name))
        times = found.begun_s, found.ended_s
        point = Point(name, found.q_rad, rest.samples, rest.spread_mm, rest.drift_mm, *times, figures)
        return Set(point, self.notebook.take(point))

    def _covariance_mm2(self, q_rad: F64) -> F64:
        """(3, 3) of one sample, from its encoders; where nothing is known of them, as a touch scatters."""
        if self._sample_rad is None:
            return self.arm.noise.variance_mm2 * np.eye(3)
        by_angle = self.arm.by_angle(q_rad)
        found: F64 = (by_angle * self._sample_rad**2) @ by_angle.T
        return found

    def _tip(self, window: Window) -> Tip:
        t_s, q_rad = float(window.t_s[-1]), window.q_rad[-1]
        rest = self._rests.stillness(window) if self._tells else None
        figures = tuple(self.arm.point(q_rad, "the tip"))
        if self.doubt is not None:
            why = worded("the angles may be wrong: {doubt}", doubt=self.doubt)
            figures = tuple(Figure(each.name, each.unit, None, None, None, why) for each in figures)
        warned = (*near_stops(self.arm.arm, q_rad), *folded(self.arm, q_rad))
        target = self._target()
        if target is None or self.doubt is not None:
            return Tip(t_s, q_rad, figures, rest, warned, None, None)
        (distance,) = self.arm.figures(LENGTH, [target.q_rad, q_rad], f"from {target.name}")
        return Tip(t_s, q_rad, figures, rest, warned, target.name, distance)

    def _target(self) -> Point | None:
        points = self.notebook.points
        if self.to is None:
            return points[-1] if points else None
        return next((point for point in points if point.name == self.to), None)


def sample_noise(stream: Stream, arm: Calibrated) -> F64 | None:
    """(n,) standard deviation of one sample of each encoder: as source file, calibration or somebody states it, never
    less than what whole counts leave open; None where nobody knows."""
    mapping = stream.mapping
    counts = mapping.turn if mapping.unit == "counts" else None
    if counts is None and all(joint.counts_per_turn is not None for joint in arm.arm.joints):
        counts = np.array([joint.counts_per_turn for joint in arm.arm.joints], dtype=np.float64)
    rounding = None if counts is None else 2.0 * np.pi / counts / np.sqrt(12.0)
    stated = arm.sample_rad if stream.sample_rad is None else stream.sample_rad
    if stated is None or rounding is None:
        return stated if rounding is None else rounding
    found: F64 = np.maximum(stated, rounding)
    return found
