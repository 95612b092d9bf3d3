"""How `ulna live commission` goes: a step is asked for, what comes is looked at, what was found is shown and asked."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeGuard

import typer
from rich.console import Console
from rich.text import Text

from ulna.cli import output
from ulna.cli.printed.commission import bars, document, findings_report
from ulna.formats.output import check_output
from ulna.ground.errors import UlnaInputError, for_people
from ulna.live.commission.commissioning import Commissioning, Found
from ulna.live.commission.counting import STATED
from ulna.live.commission.findings import FULL_TURN, Findings
from ulna.live.commission.geometry import geometry, ways
from ulna.live.commission.holding import Holding
from ulna.live.commission.posture import Posture, posture
from ulna.live.commission.standing import Stood
from ulna.live.commission.turning import Turned
from ulna.live.commission.writing import FILES, noise_text, write
from ulna.live.faults import RESET
from ulna.live.samples import Samples
from ulna.live.source import SourceEnded
from ulna.live.stream import Stream, streaming
from ulna.proposals.arms import Drawn

TRIES = 3
"""Of a step that nobody is asked about."""
SHOWN_HZ = 10.0


@dataclass(frozen=True)
class Asked:
    """What the command was given."""

    source: str
    out: Path
    joints: int | None
    arm: Path | None
    reach_mm: float | None
    unit: str | None
    counts_per_turn: tuple[float, ...]
    signs: str
    zeros: str | None
    posture_deg: tuple[float, ...] | None
    hold_s: float
    wait_s: float
    yes: bool
    force: bool


def commissioned(asked: Asked, as_json: bool) -> None:
    """`ulna live commission`."""
    if not asked.yes and not sys.stdin.isatty():
        raise UlnaInputError(
            "ulna live commission asks whether what it finds is so, and nobody can answer here; expected a terminal. "
            "Give --yes to take what is found."
        )
    check_output(asked.out, FILES, asked.force)
    drawn = geometry(asked.arm, asked.joints, asked.reach_mm, asked.source)
    how = ways(drawn, "the device" if asked.arm is None else asked.arm.name) if asked.signs == "turned" else []
    stands = _posture(drawn, asked)
    with streaming(asked.source, angles=False) as stream:
        table = stream.stated.file.map
        if asked.unit is not None:
            table = table.model_copy(update={"unit": asked.unit})
        hello, joints = stream.source.hello, drawn.arm.n
        work = Commissioning(hello, joints, table, ways=how, posture=stands, wait_s=asked.wait_s, hold_s=asked.hold_s)
        _Going(stream, work, asked.yes).go()
        stated = stream.stated
    findings = replace(_whole(work.findings(), asked), as_drawn=_zeros(drawn, asked) == "known")
    write(findings, stated, drawn, asked.out, asked.force)
    if as_json:
        output.print_json(document(findings, asked.out))
    else:
        output.print_renderable(*findings_report(findings))
        print(noise_text(findings))
    output.say(f"Written: {', '.join(str(asked.out / each) for each in FILES)}")
    arm, plan, source = (asked.out / name for name in ("arm.toml", "plan.toml", "source.toml"))
    output.say(f"Next: put the length of your bar into {plan}, then")
    output.say(f"ulna live touch {arm} {plan} {source} -o touched")


def _zeros(drawn: Drawn, asked: Asked) -> str:
    """From where the zeros are."""
    if asked.zeros is not None:
        return asked.zeros
    if drawn.guessed or asked.signs == "unknown":
        return "unknown"
    return "known" if asked.arm is None else "posture"


def _posture(drawn: Drawn, asked: Asked) -> Posture | None:
    """The posture that is asked for. Raises UlnaInputError where none can be said."""
    zeros = _zeros(drawn, asked)
    if zeros != "posture" and asked.posture_deg is not None:
        raise UlnaInputError(f"--posture: a posture is given, but --zeros {zeros}. Leave one of them out.")
    if zeros != "posture":
        return None
    if asked.signs == "unknown":
        raise UlnaInputError(
            "--zeros: got posture with --signs unknown; expected signs that are found too, as a zero means nothing "
            "without them. Leave one of them out."
        )
    stated = None if asked.posture_deg is None else [math.radians(each) for each in asked.posture_deg]
    return posture(drawn.arm, stated)


class _Going:
    """Goes through the steps."""

    def __init__(self, stream: Stream, work: Commissioning, yes: bool) -> None:
        self._stream, self._work, self._yes = stream, work, yes
        self._as_fast_as_can_be = stream.stated.url.options.get("speed") == "max"
        self._newest_s = self._from_s = -float("inf")

    def go(self) -> None:
        """Until all is done. Raises UlnaInputError where the source ends before."""
        tries = 0
        while (step := self._work.step) is not None:
            _print(f"\n{step.sentence}" if not tries else step.sentence)
            for line in step.lines:
                _print(f"    {line}")
            found = self._found(step.sentence)
            for line in found.said:
                _print(f"  {for_people(line)}")
            tries = self._answered(found, tries + 1)

    def _answered(self, found: Found, tries: int) -> int:
        """What becomes of it; how often this step was tried in vain."""
        work = self._work
        if found.why_not is None:
            if not self._says("Is that so?"):
                work.again()
                return tries
            if self._endless(found):
                work.endless.add(found.joint)
            work.accept()
            return 0
        if self._yes:
            again = tries < TRIES and not found.why_not.startswith("Nothing moved")
        else:
            again = self._says("Once more?")
        if again:
            work.again()
            return tries
        if isinstance(found, Holding):
            raise UlnaInputError(f"{found.why_not} Nothing was written. Begin again when the arm is held still.")
        _print("  It is left out." if isinstance(found, Stood) else f"  Joint {found.joint + 1} is left out.")
        work.skip()
        return 0

    def _endless(self, found: Found) -> TypeGuard[Turned]:
        """Whether somebody says so of a joint that turned all the way round."""
        full = isinstance(found, Turned) and found.turns >= FULL_TURN and not self._yes
        return full and self._says("Does it turn on and on, without a stop?")

    def _says(self, question: str) -> bool:
        """y or n; what comes meanwhile belongs to no step."""
        if self._yes:
            return True
        began = time.monotonic()
        said = typer.confirm(f"  {question}", default=True, err=True)
        if not self._as_fast_as_can_be:
            self._from_s = self._newest_s + (time.monotonic() - began)
            self._work.forget()
        return said

    def _found(self, sentence: str) -> Found:
        found = self._work.take(Samples.none(len(self._stream.source.hello.channels)))
        shown = time.monotonic()
        with _screen() as show:
            while found is None:
                try:
                    frames = self._stream.read(0.05)
                except SourceEnded as ended:
                    raise UlnaInputError(
                        f"{ended} It ended at: {sentence} Nothing was written. Begin again when it is there."
                    ) from None
                for fault in frames.faults:
                    if fault.kind == RESET:
                        raise UlnaInputError(f"{fault.text} Nothing was written. Begin again.")
                samples = frames.samples
                if len(samples):
                    self._newest_s = float(samples.t_host_s[-1])
                    samples = samples[int((samples.t_host_s < self._from_s).sum()) :]
                found = self._work.take(samples)
                if time.monotonic() - shown >= 1.0 / SHOWN_HZ:
                    show(self._work)
                    shown = time.monotonic()
        return found


def _whole(findings: Findings, asked: Asked) -> Findings:
    """With what the readings did not say. Raises UlnaInputError where nobody does."""
    counts = asked.counts_per_turn
    if counts:
        if len(counts) not in (1, len(findings.joints)):
            raise UlnaInputError(
                f"--counts-per-turn: got {len(counts)} numbers, expected one, or one for each of "
                f"{len(findings.joints)} joints. Correct it."
            )
        findings = findings.with_counts(counts[0] if len(counts) == 1 else counts)
    if asked.yes or findings.unit is None:
        return findings
    if findings.unit_why != STATED:
        _print(findings.unit_why)
        if not typer.confirm(f"Is the unit {findings.unit}?", default=True, err=True):
            raise UlnaInputError(f"the unit is not {findings.unit}. Nothing was written. Say it with --unit.")
    if findings.uncounted:
        which = ", ".join(str(k + 1) for k in findings.uncounted)
        _print(f"The encoder of joint {which} never began again, so that nothing says what a turn of it is.")
        said = 0.0
        while not 2.0 <= said < math.inf:
            said = float(typer.prompt("Counts per turn", default=findings.guessed_counts, type=float, err=True))
        findings = findings.with_counts(said)
    return findings


def _print(line: str) -> None:
    """On stderr, as wide as the terminal: stdout is for what was found."""
    Console(file=sys.stderr, highlight=False, emoji=False).print(Text(line))


@contextmanager
def _screen() -> Iterator[Callable[[Commissioning], None]]:
    """Bars in place on a terminal, nothing elsewhere."""
    if not sys.stderr.isatty():
        yield lambda _: None
        return
    from rich.live import Live

    with Live(console=Console(file=sys.stderr, highlight=False), auto_refresh=False, transient=True) as live:
        yield lambda work: live.update(bars(work.bars), refresh=True)
