"""Commissioning: channels, signs, ranges, noise, joint by joint, as `ulna live commission` finds them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Literal

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.commission.commissioning import Commissioning as Work
from ulna.live.commission.commissioning import Found
from ulna.live.commission.findings import FULL_TURN
from ulna.live.commission.holding import Holding
from ulna.live.commission.turning import Turned
from ulna.live.commission.writing import FILES, write
from ulna.live.faults import ORDINARY, RESET
from ulna.live.stream import Frames, Stream
from ulna.proposals.arms import Drawn
from ulna.serve.activities.activity import Doing, unknown
from ulna.serve.activities.seen import Seen
from ulna.serve.activities.touching import steer, virtual_of
from ulna.serve.contract import activities as wire
from ulna.serve.contract.live import FaultEvent, LiveEvent, SaidEvent, StateEvent
from ulna.serve.contract.words import Do, DoAnswer, DoGo
from ulna.serve.frames import Newest
from ulna.serve.problems import NotNowError

BARS_S = 0.1
"""Of the stream's time: how often bars are told."""
ROLES = ("source", "arm", "noise", "plan")
Answer = Literal["yes", "again", "skip", "endless"]


class Commissioning(Doing):
    """Of one arm."""

    kind = "commission"

    def __init__(
        self, stream: Stream, work: Work, drawn: Drawn, folder: Path, as_drawn: bool, counts: float | None
    ) -> None:
        """as_drawn: the encoders' zeros are the drawing's; counts: per turn, where they are stated."""
        self.stream = stream
        self._work, self._drawn, self._folder = work, drawn, folder
        self._as_drawn, self._counts = as_drawn, counts
        self._found: Found | None = None
        self._steps = 1 + work.joints
        self._told_s = 0.0
        self._newest: tuple[float, Frames] | None = None

    def begin(self) -> Iterator[LiveEvent]:
        """The first step."""
        yield StateEvent(state=self.state())

    def feed(self, frames: Frames) -> Iterator[LiveEvent]:
        """What came; what was found is asked about."""
        for fault in frames.faults:
            if fault.kind == RESET:
                raise UlnaInputError(worded("{what} Nothing was written. Begin again.", what=fault.text))
        for fault in frames.told:
            if fault.kind not in ORDINARY:
                yield FaultEvent(kind=fault.kind, sentence=fault.text)
        if not len(frames.samples):
            return
        t_s = float(frames.samples.t_s[-1])
        self._newest = t_s, frames
        if self._found is None and self._work.step is not None:
            self._found = self._work.take(frames.samples)
            if self._found is not None:
                yield StateEvent(state=self.state())
                return
        if abs(t_s - self._told_s) >= BARS_S:
            self._told_s = t_s
            yield StateEvent(state=self.state())

    def do(self, asked: Do) -> Iterator[LiveEvent]:
        """An answer, or where a virtual arm goes."""
        match asked:
            case DoAnswer():
                self._answer(asked.answer)
                yield StateEvent(state=self.state())
                if self._work.step is None:
                    yield SaidEvent(sentence=worded("All is found: end it, and the files are written."))
            case DoGo():
                steer(virtual_of(self.stream.source), asked)
            case _:
                raise unknown(asked, self.kind)

    def _answer(self, answer: Answer) -> None:
        found = self._found
        if found is None or answer not in self._answers(found):
            raise NotNowError(worded("nothing is asked that this answers. Do what the step says."))
        if answer == "endless":
            assert isinstance(found, Turned)
            self._work.endless.add(found.joint)
        if answer in ("yes", "endless"):
            self._work.accept()
        elif answer == "again":
            self._work.again()
        else:
            self._work.skip()
        self._found = None
        self._work.forget()

    def _answers(self, found: Found) -> list[Answer]:
        if found.why_not is not None:
            return ["again"] if isinstance(found, Holding) else ["again", "skip"]
        endless: list[Answer] = ["endless"] if isinstance(found, Turned) and found.turns >= FULL_TURN else []
        return ["yes", *endless, "again"]

    def state(self) -> wire.CommissionState:
        """The step, what was found, the channels."""
        work, found = self._work, self._found
        step = work.step
        self._steps = max(self._steps, work.left)
        return wire.CommissionState(
            kind="commission",
            question=None
            if step is None
            else wire.Question(
                step=step.kind,
                sentence=step.sentence,
                lines=list(step.lines),
                joint=None if step.joint is None else step.joint + 1,
                found=[] if found is None else list(found.said),
                answers=[] if found is None else self._answers(found),
            ),
            steps=self._steps,
            steps_done=self._steps - work.left,
            bars=[wire.Bar(channel=name, raw=raw, moved_deg=moved) for name, raw, moved in work.bars],
        )

    def newest(self) -> Newest | None:
        """The readings; where the arm is nobody knows yet."""
        if self._newest is None:
            return None
        t_s, frames = self._newest
        raw = frames.samples.raw[-1]
        return Seen(None).newest(t_s, raw, self.stream.doubtful)

    def finish(self) -> tuple[list[tuple[str, Path]], list[str]]:
        """arm.toml, source.toml, plan.toml and noise.toml; nothing where a joint was not found."""
        if self._work.step is not None and not self._work.turned:
            return [], [worded("Nothing was found: nothing is written.")]
        findings = self._work.findings()
        if self._counts is not None:
            findings = findings.with_counts(self._counts)
        write(replace(findings, as_drawn=self._as_drawn), self.stream.stated, self._drawn, self._folder)
        names = dict(zip(ROLES, ("source.toml", "arm.toml", "noise.toml", "plan.toml"), strict=True))
        assert set(names.values()) == set(FILES)
        return [(role, self._folder / name) for role, name in names.items()], []
