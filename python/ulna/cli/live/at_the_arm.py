"""How `ulna live touch` goes round: read, show, and do what is asked for by keys or by lines."""

from __future__ import annotations

import json
import os
import select
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import RenderableType

from ulna.cli.live.keys import pressed
from ulna.cli.live.watching import read_on
from ulna.cli.printed.touching import screen
from ulna.ground.errors import UlnaInputError
from ulna.live.events import Event, Happened, Meter
from ulna.live.faults import ORDINARY, Fault
from ulna.live.fresh import USUAL
from ulna.live.lacking_words import lacking_lines
from ulna.live.rounds import Round
from ulna.live.said import happened_lines, held_out_lines, meter_lines, record_of
from ulna.live.session import Session
from ulna.live.stream import Frames
from ulna.live.touches import present
from ulna.live.trigger import Refused

FRAMES_HZ = 20.0
"""A screen that is read while both hands are on an arm need not be faster; samples are, all the same."""
KEYS = {" ": "touch", "n": "moved", "w": "withdraw", "h": "hold-out", "t": "trust", "q": "end"}
"""Key → the word that does the same."""
LAST = 4
"""Sentences that stay on the screen."""


class Bench:
    """A session with somebody at it."""

    def __init__(
        self,
        session: Session,
        as_json: bool,
        touches: int | None,
        seconds: float | None,
        held_out: int | None = None,
    ) -> None:
        """held_out: fresh places with which it ends; None: they are offered."""
        self.session = session
        self.as_json, self.touches, self.seconds, self.held_out = as_json, touches, seconds, held_out
        self._offered = False
        """Whether the end was said."""
        self._begun = False
        """Whether anything was held out: what goes back to fitting is left there."""
        self.meter: Meter | None = None
        self.said: list[str] = []
        self.lacking: list[str] = []
        """What is not known, in words: made anew where it is not the same any more."""
        self._told: object = None
        self._ended = False

    def run(self) -> None:
        """Until it is ended: by a key or a word, after so many touches or seconds, by the source or by Ctrl-C."""
        self._look()
        at_terminal = sys.stdout.isatty() and not self.as_json
        with _asking() as words, _showing(at_terminal) as show:

            def each(known: Round, frames: Frames) -> None:
                for event in self.session.feed(frames):
                    self._event(event)
                for word in words():
                    self._do(word)

            def tick(known: Round) -> None:
                show(screen(self.session, self.meter, self.lacking, self.said))

            known = read_on(self.session.stream, self.seconds, each, tick, FRAMES_HZ, lambda: self._ended)
        if known.why is not None:
            self._tell([f"The source ended: {known.why}"])

    def _do(self, line: str) -> None:
        word, _, rest = line.strip().partition(" ")
        try:
            match word:
                case "":
                    return
                case "touch":
                    self._event(self.session.ask())
                case "moved":
                    self.session.moved()
                    self._known()
                case "withdraw":
                    self._withdraw(rest)
                case "hold-out":
                    self._hold_out(rest)
                case "trust":
                    self.session.trust()
                    self._tell(["The angles are taken for right again."])
                case "end":
                    self._ended = True
                case _:
                    words = ", ".join(KEYS.values())
                    self._tell([f"'{word}' is no word here; expected one of {words}."])
        except UlnaInputError as error:
            self._tell([str(error)])

    def _withdraw(self, rest: str) -> None:
        count = present(self.session.fit.touches)
        number, _, reason = rest.partition(" ")
        if not number and count:
            number = str(count[-1].number)
        if not number.isdecimal():
            raise UlnaInputError(f"withdraw: got '{rest}'; expected the number of a touch and a reason. Name one.")
        self.session.withdraw(int(number), reason or "withdrawn at the arm")
        self._tell([f"Touch {number} does not count any more."])
        self._known()

    def _event(self, event: Event) -> None:
        if self.as_json:
            print(json.dumps(record_of(event), ensure_ascii=False, allow_nan=False), flush=True)
        match event:
            case Fault():
                if event.kind not in ORDINARY:
                    self._tell([f"{event.kind}: {event.text}"], told=self.as_json)
            case Refused():
                _tone(False, self.as_json)
                self._tell([f"Not taken: {event.reason}."], told=self.as_json)
            case Happened():
                _tone(True, self.as_json)
                names = list(self.session.spec.artefact.features)
                self._tell(happened_lines(event, names), told=self.as_json)
                self._look()

    def _hold_out(self, rest: str) -> None:
        """Without a number it begins, and goes back to fitting where it has begun."""
        if rest and not rest.isdecimal():
            raise UlnaInputError(f"hold-out: got '{rest}'; expected how many fresh places, 0 to fit again. Name them.")
        usual = 0 if self.session.fresh_places else self.held_out or USUAL
        places = int(rest) if rest else usual
        self._begin(places)
        self._known()

    def _begin(self, places: int) -> None:
        self.session.hold_out(places)
        self._begun, self._offered = True, False
        self._tell(held_out_lines(places))

    def _look(self) -> None:
        """At the beginning, which may be the end of what was interrupted, and after each touch."""
        meter = self.session.meter()
        # whoever follows is told one thing to do next
        self._known(None if self._turn(meter) else meter)

    def _turn(self, meter: Meter) -> bool:
        """Whether that was enough, to fit or to judge by; whether another way of touching begins."""
        fresh, goal = meter.fresh, meter.goal_u_mm
        if fresh is not None:
            if fresh.done >= fresh.places:
                self._ended = self.held_out is not None
                self._offer(f"Fresh places touched: {fresh.done}, enough to judge by. q ends.")
            return False
        enough = self.touches is not None and len(self.session.fit.counting()) >= self.touches
        fitted = self.session.fit.fitted is not None
        reached = fitted and goal is not None and meter.worth.u_mm <= goal
        if self.held_out is not None and not self._begun and fitted and (enough or reached):
            self._begin(self.held_out)
            return True
        if enough:
            self._ended = True
        elif reached:
            self._offer(f"Enough. Now {USUAL} fresh places, not fitted, to judge by: h (hold-out). Or q ends.")
        return False

    def _offer(self, text: str) -> None:
        """Once."""
        if not self._offered:
            self._offered = True
            self._tell([text])

    def _known(self, meter: Meter | None = None) -> None:
        """What is known now, said."""
        self.meter = meter or self.session.meter()
        told = self.meter.lacking.told
        changed, self._told = told != self._told, told
        if changed:
            self.lacking = lacking_lines(self.meter.lacking)
        if self.as_json:
            print(json.dumps(record_of(self.meter), ensure_ascii=False, allow_nan=False), flush=True)
        elif not sys.stdout.isatty():
            for line in [*meter_lines(self.meter), *(self.lacking if changed else [])]:
                print(line, flush=True)

    def _tell(self, lines: list[str], told: bool = False) -> None:
        self.said = [*self.said, *lines][-LAST:]
        if not told and not sys.stdout.isatty():
            for line in lines:
                print(line, file=sys.stderr if self.as_json else sys.stdout, flush=True)


def _tone(taken: bool, as_json: bool) -> None:
    """One bell for a touch, none for a refusal: terminals have one tone."""
    if taken and not as_json and sys.stdout.isatty():
        sys.stderr.write("\a")
        sys.stderr.flush()


@contextmanager
def _asking() -> Iterator[Callable[[], list[str]]]:
    """Words that came since the last call: keys of a terminal, lines of anything else."""
    if sys.stdin.isatty():
        with pressed() as keys:
            yield lambda: [KEYS[key] for key in keys() if key in KEYS]
        return
    rest = ""

    def lines() -> list[str]:
        nonlocal rest
        rest += _waiting()
        *whole, rest = rest.split("\n")
        return whole

    yield lines


def _waiting() -> str:
    """What can be read without waiting."""
    try:
        file = sys.stdin.fileno()
        if not select.select([file], [], [], 0.0)[0]:
            return ""
        return os.read(file, 4096).decode("utf-8", "replace")
    except (OSError, ValueError):  # nobody is there to say anything
        return ""


@contextmanager
def _showing(at_terminal: bool) -> Iterator[Callable[[RenderableType], None]]:
    if not at_terminal:
        yield lambda parts: None
        return
    from rich.console import Console
    from rich.live import Live

    with Live(console=Console(highlight=False), auto_refresh=False, transient=True) as live:
        yield lambda parts: live.update(parts, refresh=True)
