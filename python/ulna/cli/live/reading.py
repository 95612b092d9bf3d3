"""How `ulna live measure` goes round: what is read, what keys do, and what is said of it."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ulna.cli.live.watching import FRAMES_HZ, LINES_HZ, go_round
from ulna.live.faults import ORDINARY
from ulna.live.features import Feature, Notebook
from ulna.live.figures import Calibrated
from ulna.live.readout import ReadOut, Set, Tip
from ulna.live.rounds import Round
from ulna.live.stream import Frames
from ulna.live.trigger import Refused

if TYPE_CHECKING:
    from rich.live import Live

STILL = "still"
"""`trigger.by` of a source file by which rests are touches."""


class Reading:
    """One read-out, whose stream is known once it is open."""

    def __init__(self, arm: Calibrated, notebook: Notebook, still: bool, to: str | None) -> None:
        """still: each rest is a touch, whatever the source file says."""
        self.arm, self.notebook = arm, notebook
        self._still, self._to = still, to
        self.out: ReadOut | None = None
        self.said = ""
        """The last answer to who holds the arm."""
        self.ended = False

    def of(self, known: Round) -> ReadOut:
        """Raises UlnaInputError where the stream is not of such an arm."""
        if self.out is None:
            by_itself = self._still or known.stream.stated.file.trigger.by == STILL
            self.out = ReadOut(known.stream, self.arm, self.notebook, by_itself, self._to)
        return self.out

    def press(self, keys: str) -> Iterator[Set | Refused]:
        """What keys do."""
        out = self.out
        if out is None:
            return
        for key in keys:
            if key == " ":
                yield out.ask()
            elif key in _KEYS:
                _KEYS[key](self, out)

    def new(self, out: ReadOut) -> None:
        """Another feature."""
        self.notebook.new()
        self.said = f"{self.notebook.current.name}: a new {self.notebook.current.kind}"

    def turn_kind(self, out: ReadOut) -> None:
        """Another kind of it."""
        self.notebook.turn_kind()
        self.said = f"{self.notebook.current.name} is a {self.notebook.current.kind}"

    def take_back(self, out: ReadOut) -> None:
        """The last point."""
        point = self.notebook.take_back()
        self.said = "there is no point" if point is None else f"{point.name} taken back"

    def trust(self, out: ReadOut) -> None:
        """The angles."""
        if out.doubt is not None:
            out.trust()
            self.said = "the angles are right, you say"

    def end(self, out: ReadOut) -> None:
        """All."""
        self.ended = True


_KEYS: dict[str, Callable[[Reading, ReadOut], None]] = {
    "n": Reading.new,
    "k": Reading.turn_kind,
    "u": Reading.take_back,
    "t": Reading.trust,
    "q": Reading.end,
}
"""What each key does, beside space."""


def show(reading: Reading, source: str, seconds: float | None, as_json: bool, out: Path | None, force: bool) -> None:
    """Until it ends; then the points are written."""
    from ulna.cli.output import say
    from ulna.cli.printed.live import ended_line
    from ulna.cli.printed.readout import summary
    from ulna.live.points import write_points

    if as_json:
        known = _as_json(reading, source, seconds)
    elif sys.stdout.isatty():
        known = _on_screen(reading, source, seconds)
    else:
        known = _in_lines(reading, source, seconds)
    points = reading.notebook.points
    if as_json:
        _json("end", known.as_dict() | {"points": len(points)})
    else:
        if sys.stdout.isatty() and reading.out is not None:
            print("\n".join(summary(reading.out)))
        print(ended_line(known), flush=True)
    if out is not None:
        if points:
            write_points(out, reading.arm, reading.notebook, force)
        say(f"{out}: {len(points)} points." if points else f"{out}: not written, for no point was taken.")


def _as_json(reading: Reading, source: str, seconds: float | None) -> Round:
    told: set[str] = set()

    def each(known: Round, frames: Frames) -> None:
        out = reading.of(known)
        for fault in frames.told:
            _json("fault", fault.as_dict())
        _notes(out, told, lambda note: _json("note", {"text": note}))
        for said in out.take(frames, tips=True):
            if isinstance(said, Tip):
                _json("tip", said.as_dict())
            elif isinstance(said, Refused):
                _json("refused", {"reason": said.reason})
            else:
                _json("taken", said.point.as_dict())
                for made in _features_of(out, said):
                    if not made.lacking:
                        figures = {figure.name: figure.as_dict() for figure in out.figures(made)}
                        _json("feature", {"name": made.name, "kind": made.kind} | figures)

    return go_round(source, seconds, each, lambda _: None, LINES_HZ, angles=True)


def _features_of(out: ReadOut, said: Set) -> Iterator[Feature]:
    """Those that a point belongs to; a point alone is none."""
    if said.feature.kind != "point" or len(said.feature.points) > 1:
        yield said.feature
    for asked in out.notebook.asked:
        found = asked.of(out.notebook.points) if said.point.name in asked.names else None
        if found is not None:
            yield found


def _in_lines(reading: Reading, source: str, seconds: float | None) -> Round:
    from ulna.cli.output import say
    from ulna.cli.printed.readout import feature_line, point_line, tip_line

    told: set[str] = set()

    def each(known: Round, frames: Frames) -> None:
        out = reading.of(known)
        for fault in frames.told:
            if fault.kind not in ORDINARY:
                say(f"{fault.kind}: {fault.text}")
        for said in out.take(frames):
            if isinstance(said, Refused):
                print(f"not taken: {said.reason}", flush=True)
            elif isinstance(said, Set):
                lines = [feature_line(made, out.figures(made)) for made in _features_of(out, said)]
                print("\n".join([point_line(said.point), *lines]), flush=True)
        _notes(out, told, lambda note: say(f"note: {note}"))

    def tick(known: Round) -> None:
        tip = reading.of(known).now()
        if tip is not None:
            print(tip_line(tip), flush=True)

    return go_round(source, seconds, each, tick, LINES_HZ, angles=True)


def _on_screen(reading: Reading, source: str, seconds: float | None) -> Round:
    from ulna.cli.live.keys import pressed
    from ulna.cli.output import say
    from ulna.cli.printed.readout import screen
    from ulna.cli.streams import knows_all

    keyed, large = sys.stdin.isatty(), knows_all(sys.stdout)
    told: set[str] = set()
    with pressed() as keys, _live() as live:

        def each(known: Round, frames: Frames) -> None:
            out = reading.of(known)
            for said in chain(out.take(frames), reading.press(keys())):  # one by one, so that the last answer stays
                reading.said = f"not taken: {said.reason}" if isinstance(said, Refused) else _taken(said)
                if isinstance(said, Set):
                    live.console.bell()
            _notes(out, told, lambda note: say(f"note: {note}"))

        def tick(known: Round) -> None:
            live.update(screen(reading.of(known), known, reading.said, keyed, large), refresh=True)

        return go_round(source, seconds, each, tick, FRAMES_HZ, angles=True, ended=lambda: reading.ended)


def _taken(said: Any) -> str:
    return f"{said.point.name} taken, {said.feature.name}" if isinstance(said, Set) else ""


def _live() -> Live:
    """A screen in place, which leaves nothing behind."""
    from rich.console import Console
    from rich.live import Live

    return Live(console=Console(highlight=False), auto_refresh=False, transient=True)


def _notes(out: ReadOut, told: set[str], tell: Callable[[str], None]) -> None:
    """What holds for all that is shown, once."""
    from ulna.cli.printed.readout import notes

    for note in notes(out):
        if note not in told:
            told.add(note)
            tell(note)


def _json(kind: str, document: dict[str, Any]) -> None:
    from ulna.cli.output import write_json

    write_json(json.dumps({kind: document}, ensure_ascii=False, allow_nan=False) + "\n")
    sys.stdout.flush()
