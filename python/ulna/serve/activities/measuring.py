"""Reading out: where the tip is ± U, points and features, as `ulna live measure` has them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from ulna.ground.errors import UlnaInputError, nearest
from ulna.ground.worded import worded
from ulna.live.faults import ORDINARY
from ulna.live.features import FEATURES
from ulna.live.figures import Figure
from ulna.live.points import write_points
from ulna.live.readout import ReadOut, Said, Set, Tip
from ulna.live.stream import Frames
from ulna.live.trigger import Refused
from ulna.serve.activities.activity import Doing, unknown
from ulna.serve.activities.seen import Seen, tip_covariance
from ulna.serve.activities.touching import steer, virtual_of
from ulna.serve.contract import activities as wire
from ulna.serve.contract.live import FaultEvent, LiveEvent, RefusedEvent, SaidEvent, StateEvent, TipEvent
from ulna.serve.contract.model import Value
from ulna.serve.contract.words import Do, DoFeature, DoGo, DoTakeBack, DoTouch, DoTrust
from ulna.serve.frames import Newest
from ulna.serve.texts import valued

POINTS = "points.csv"
KINDS = {
    "point": worded("point"),
    "length": worded("length"),
    "ball": worded("ball"),
    "circle": worded("circle"),
    "plane": worded("plane"),
    "distance": worded("distance"),
}
"""What touches can be made into, in words."""


class Measuring(Doing):
    """One read-out."""

    kind = "measure"

    def __init__(self, out: ReadOut, folder: Path, by: str) -> None:
        self.out, self.stream = out, out.stream
        self._folder, self._by = folder, by
        self._tip: Tip | None = None

    def begin(self) -> Iterator[LiveEvent]:
        """What is to be known of conditions."""
        for remark in self.out.arm.remarks:
            yield SaidEvent(sentence=remark)

    def feed(self, frames: Frames) -> Iterator[LiveEvent]:
        """Where the tip is, touches, why there is none, faults."""
        for fault in frames.told:
            if fault.kind not in ORDINARY:
                yield FaultEvent(kind=fault.kind, sentence=fault.text)
        for said in self.out.take(frames, tips=True):
            yield from self._event(said)

    def do(self, asked: Do) -> Iterator[LiveEvent]:
        """As the keys of `ulna live measure` do."""
        notebook = self.out.notebook
        match asked:
            case DoTouch():
                yield from self._event(self.out.ask())
                return
            case DoFeature():
                if asked.kind not in FEATURES:
                    raise UlnaInputError(
                        f"feature: got '{asked.kind}'; expected one of them.{nearest(asked.kind, FEATURES)}"
                    )
                notebook.new()
                notebook.current.kind = asked.kind
            case DoTakeBack():
                point = notebook.take_back()
                if point is None:
                    yield SaidEvent(sentence=worded("There is no point."))
                else:
                    yield SaidEvent(sentence=worded("{point} taken back.", point=point.name))
            case DoTrust():
                self.out.trust()
            case DoGo():
                steer(virtual_of(self.stream.source), asked)
                return
            case _:
                raise unknown(asked, self.kind)
        yield StateEvent(state=self.state())

    def state(self) -> wire.MeasureState:
        """All of it."""
        notebook = self.out.notebook
        return wire.MeasureState(
            kind="measure",
            points=[
                wire.Point(name=point.name, values=[figure_said(each) for each in point.figures])
                for point in notebook.points
            ],
            features=[self._feature(k) for k in range(len(notebook.features))],
            kinds=list(FEATURES),
            by=self._by,
            tip=None if self._tip is None else tip_said(self._tip),
            remarks=list(self.out.arm.remarks),
        )

    def newest(self) -> Newest | None:
        """The arm where it is."""
        if self._tip is None:
            return None
        calibrated = self.out.arm
        probe = calibrated.arm.probe_index(calibrated.probe)
        rests = 1.0 if self._tip.stillness is not None and self._tip.stillness.still else 0.0
        lost = any(each.why is not None for each in self._tip.figures)
        doubtful, known = self.out.doubt is not None, None if lost else tip_covariance(calibrated, self._tip.q_rad)
        return Seen(calibrated.arm, probe).newest(self._tip.t_s, self._tip.q_rad, doubtful, rests, known)

    def finish(self) -> tuple[list[tuple[str, Path]], list[str]]:
        """The points as a table, where there are any."""
        if not self.out.notebook.points:
            return [], [worded("No point was taken.")]
        self._folder.mkdir(parents=True, exist_ok=True)
        path = self._folder / POINTS
        write_points(path, self.out.arm, self.out.notebook, False)
        return [("readings", path)], []

    def _event(self, said: Said) -> Iterator[LiveEvent]:
        match said:
            case Tip():
                self._tip = said
                yield TipEvent(tip=tip_said(said))
            case Refused():
                yield RefusedEvent(sentence=worded("Not taken: {reason}.", reason=said.reason))
            case Set():
                yield SaidEvent(
                    sentence=worded(
                        "{point}: taken, part of {feature}, a {kind}.",
                        point=said.point.name,
                        feature=said.feature.name,
                        kind=KINDS[said.feature.kind],
                    )
                )
                yield StateEvent(state=self.state())

    def _feature(self, number: int) -> wire.Feature:
        feature = self.out.notebook.features[number]
        figures = self.out.figures(feature)
        lacking = next((each.why for each in figures if each.why is not None), None)
        return wire.Feature(
            name=feature.name,
            kind=feature.kind,
            points=[point.name for point in feature.points],
            wants=feature.lacking,
            values=[(each.name, figure_said(each)) for each in figures],
            why_not=lacking,
        )


def figure_said(figure: Figure) -> Value:
    """A value ± U, as it was computed and as it is read."""
    return valued(figure.value, figure.unit, figure.u, figure.expanded)


def tip_said(tip: Tip) -> wire.TipNow:
    """Where the tip is."""
    return wire.TipNow(
        values=[figure_said(each) for each in tip.figures],
        why_not=_first(each.why for each in tip.figures),
        distance=None if tip.distance is None else figure_said(tip.distance),
        to=tip.to,
        still=None if tip.stillness is None else tip.stillness.still,
        warnings=list(tip.warnings),
    )


def _first(whys: Iterator[str | None] | Sequence[str | None]) -> str | None:
    return next((why for why in whys if why is not None), None)
