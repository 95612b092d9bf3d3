"""What `ulna live` prints."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from ulna.ground.errors import for_people
from ulna.ground.terminal import plain_table

if TYPE_CHECKING:
    from ulna.live.guessing import Proposal
    from ulna.live.listening import Heard
    from ulna.live.ports import Port
    from ulna.live.registry import Kind
    from ulna.live.rounds import Round

RAW_LINES = 8


def ports_report(ports: Sequence[Port], kinds: Mapping[str, Kind]) -> list[RenderableType]:
    """Ports, and the kinds of sources."""
    there: RenderableType = Text("Serial ports: none. Plug the arm in, and look again.")
    if ports:
        there = plain_table("Serial ports")
        there.add_column("source", no_wrap=True)
        there.add_column("what is there")
        for port in ports:
            there.add_row(for_people(port.url), for_people(port.what))
    others = plain_table("Kinds of sources")
    others.add_column("source", no_wrap=True)
    others.add_column("what it reads")
    for kind in kinds.values():
        others.add_row(Text(kind.example), kind.what)
    return [there, Text(), others]


def guess_report(heard: Heard, found: Proposal, text: str | None) -> list[RenderableType]:
    """Raw lines, what they may be and why, and the file that says it."""
    shown: list[RenderableType] = [
        Text(f"{heard.device}: {heard.bytes} bytes in {heard.seconds:.1f} s." + (f" {heard.why}" if heard.why else ""))
    ]
    raw = b"".join(piece + (b"\n" if heard.messages else b"") for _, piece in heard.pieces[-200:])
    lines = [line for line in raw.splitlines() if line][-RAW_LINES - 1 : -1] or [raw[:200]]
    shown += [Text("  " + for_people(line[:74].decode("ascii", "backslashreplace"))) for line in lines if line]
    shown += [Text(), Text("What it may be", style="bold"), *(Text(f"- {reason}") for reason in found.reasons)]
    if found.fields:
        table = plain_table("")
        for name in ("field", "what", "why"):
            table.add_column(name)
        for each in found.fields:
            table.add_row(for_people(each.name), each.role, each.why)
        shown.append(table)
    if text is not None:
        shown += [Text(), Text("A source file that says so; look at it, and put it right", style="bold"), Text(text)]
    return shown


def watched(known: Round) -> RenderableType:
    """A screen of 80 columns."""
    stream = known.stream
    hello, mapping = stream.source.hello, stream.mapping
    head = Text(f"{for_people(hello.device)[:44]}  {known.rate_hz:.0f}/s  {known.count} samples")
    if known.silent_s > 1.0 and known.why is None:
        head.append(f"  silent for {known.silent_s:.0f} s", style="bold")
    if stream.doubtful:
        head.append("  DOUBTFUL", style="bold reverse")
    table = Table(box=None, pad_edge=False, show_header=True, header_style="")
    for name in ("joint", "channel", "sent", "angle"):
        table.add_column(name, justify="left" if name in ("joint", "channel") else "right", no_wrap=True, min_width=10)
    if known.newest is not None:
        raw, q_rad = known.newest.samples.raw[-1], known.newest.q_rad
        for k, (name, column) in enumerate(zip(mapping.names, mapping.columns, strict=True)):
            angle = f"{math.degrees(q_rad[-1, k]):.3f}°" if q_rad.shape[1] else "–"
            table.add_row(f"q{k + 1}", for_people(name)[:24], f"{raw[column]:.10g}", angle)
    faults = [
        Text(f"{fault.kind}: {for_people(fault.text)[:100]}", overflow="ellipsis", no_wrap=True) for fault in known.last
    ]
    told = ", ".join(f"{kind} {count}" for kind, count in known.counted.items()) or "none"
    return Group(head, table, Text(f"faults: {told}"), *faults)


def one_line(known: Round) -> str:
    """The newest, where no terminal is there."""
    assert known.newest is not None
    values = " ".join(f"{value:.6g}" for value in known.newest.samples.raw[-1])
    doubtful = " DOUBTFUL" if known.stream.doubtful else ""
    return f"{known.count} samples, {known.rate_hz:.0f}/s: {values}{doubtful}"


def ended_line(known: Round) -> str:
    """What it came to."""
    told = ", ".join(f"{kind} {count}" for kind, count in known.counted.items() if kind != "ended") or "none"
    doubtful = " Doubtful: a reset, a swap or a jump came." if known.stream.doubtful else ""
    why = f" {for_people(known.why)}" if known.why else ""
    return f"{known.count} samples; faults: {told}.{doubtful}{why}"
