"""An activity that runs: a thread that reads its stream, does what it is told, and tells everybody what happened."""

from __future__ import annotations

import queue
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import Future
from contextlib import ExitStack
from datetime import UTC, datetime

from ulna.ground.errors import UlnaInputError, for_people
from ulna.ground.worded import kept, worded
from ulna.live.registry import open_source
from ulna.live.rounds import Round
from ulna.live.source import SourceEnded
from ulna.live.sources.virtual import VirtualSource
from ulna.live.stream import Stream
from ulna.serve.activities.beginning import Kept, Place, begun, keep_asked, needs_angles
from ulna.serve.activities.opened import stated_source
from ulna.serve.contract import activities as wire
from ulna.serve.contract.activities import Begin
from ulna.serve.contract.live import EndedEvent, FaultEvent, LiveEvent, SaidEvent, StreamEvent
from ulna.serve.contract.model import shortened
from ulna.serve.contract.words import Do, DoEnd
from ulna.serve.frames import packed
from ulna.serve.hub import Hub
from ulna.serve.problems import NotNowError
from ulna.serve.sayings import fault

FRAMES_HZ, STREAM_HZ = 60.0, 2.0
READ_S = 0.5 / FRAMES_HZ
WAIT_S = 60.0
"""How long whoever says something waits for the answer."""
SENTENCES = 12
OVER = worded("it is over. Begin another.")


class Running:
    """One."""

    def __init__(self, name: str, asked: Begin, place: Place, hub: Hub) -> None:
        """Opens the source and begins. Raises UlnaInputError."""
        self.name, self._asked, self._place, self._hub = name, asked, place, hub
        self.begun_at = datetime.now(UTC).isoformat(timespec="seconds")
        self._words: queue.SimpleQueue[tuple[Callable[[], wire.Activity], Future[wire.Activity]]] = queue.SimpleQueue()
        self._said: deque[str] = deque(maxlen=SENTENCES)
        self._left: list[wire.Left] = []
        self._ended: str | None = None
        self._asked_to_end = self._interrupted = False
        self.running = True
        with ExitStack() as opening:
            stated = stated_source(place.desk, asked.source, place.allowed)
            source = open_source(stated)
            opening.callback(source.close)
            stream = Stream(source, stated, needs_angles(asked))
            self._doing = begun(asked, stream, place)
            if isinstance(asked, Kept):
                keep_asked(asked, place, self.begun_at)
            self._close = opening.pop_all()
        self._stream = stream
        self._round = Round(stream)
        self._thread = threading.Thread(target=self._run, name=f"activity {name}", daemon=True)
        self._thread.start()

    # ------------------------------------------------------------ from any thread

    def say(self, asked: Do) -> wire.Activity:
        """Does what is said, and then how it stands. Raises UlnaInputError."""
        if isinstance(asked, DoEnd):
            self._asked_to_end = True
            self._thread.join(WAIT_S)
            return self.activity()

        def work() -> wire.Activity:
            self._tell_all(self._doing.do(asked))
            return self._activity()

        return self._in_thread(work)

    def activity(self) -> wire.Activity:
        """How it stands."""
        return self._in_thread(self._activity) if self.running else self._activity()

    def stop(self) -> None:
        """Where the server ends: a session stays as it is, and can go on."""
        self._interrupted = self._asked_to_end = True
        self._thread.join(WAIT_S)

    def _in_thread(self, work: Callable[[], wire.Activity]) -> wire.Activity:
        if not self.running:
            raise NotNowError(OVER)
        answer: Future[wire.Activity] = Future()
        self._words.put((work, answer))
        try:
            return answer.result(WAIT_S)
        except TimeoutError:
            raise NotNowError(worded("it did not answer. Try again.")) from None

    # ------------------------------------------------------------ in its own thread

    def _run(self) -> None:
        try:
            with self._close:
                self._go()
                if not self._interrupted:
                    self._finish()
        except UlnaInputError as error:
            self._say(kept(error))
        except Exception as error:  # nobody else would hear of it
            self._say(fault(error))
        finally:
            self.running = False
            while not self._words.empty():
                self._words.get()[1].set_exception(NotNowError(OVER))
            self._hub.tell(EndedEvent(activity=self._activity()), self.name)

    def _go(self) -> None:
        self._tell_all(self._doing.begin())
        number, shown_s, told_s = 0, 0.0, 0.0
        while not self._asked_to_end and self._ended is None:
            try:
                frames = self._stream.read(READ_S)
            except SourceEnded as end:
                self._ended = kept(end)
                frames = self._stream.ended(self._ended)
            self._round.take(frames)
            self._tell_all(self._doing.feed(frames))
            self._do_what_was_said()
            now_s = time.monotonic()
            if now_s - shown_s >= 1.0 / FRAMES_HZ and self._hub.looked_at(self.name):
                newest = self._doing.newest()
                if newest is not None:
                    number += 1
                    self._hub.show(self.name, packed(number, newest))
                shown_s = now_s
            if now_s - told_s >= 1.0 / STREAM_HZ:
                self._hub.tell(StreamEvent(stream=self._stream_said()), self.name)
                told_s = now_s

    def _do_what_was_said(self) -> None:
        while True:
            try:
                work, answer = self._words.get_nowait()
            except queue.Empty:
                return
            try:
                answer.set_result(work())
            except Exception as error:  # whoever asked is told
                answer.set_exception(error)

    def _finish(self) -> None:
        left, said = self._doing.finish()
        for sentence in said:
            self._say(sentence)
        for role, path in left:
            info = self._place.desk.take(path)
            self._left.append(wire.Left(role=role, sha256=info.sha256, name=info.name))  # type: ignore[arg-type]

    def _tell_all(self, events: Iterable[LiveEvent]) -> None:
        for event in events:
            if isinstance(event, SaidEvent | FaultEvent):
                self._said.append(event.sentence)
            self._hub.tell(event, self.name)

    def _say(self, sentence: str) -> None:
        shown = shortened(for_people(sentence))
        self._said.append(shown)
        self._hub.tell(SaidEvent(sentence=shown), self.name)

    def _activity(self) -> wire.Activity:
        return wire.Activity(
            id=self.name,
            kind=self._asked.kind,
            arm=self._asked.arm,
            virtual=isinstance(self._stream.source, VirtualSource),
            running=self.running,
            begun=self.begun_at,
            who=self._place.who,
            stream=self._stream_said(),
            state=self._doing.state(),
            said=list(self._said),
            left=self._left,
        )

    def _stream_said(self) -> wire.Stream:
        known = self._round
        return wire.Stream(
            scheme=self._stream.stated.url.scheme,
            device=self._stream.source.hello.device,
            channels=list(self._stream.source.hello.channels),
            rate_hz=round(known.rate_hz, 1),
            silent_s=round(known.silent_s, 3),
            samples=known.count,
            faults=dict(known.counted),
            doubtful=self._stream.doubtful,
            ended=self._ended,
        )
