"""What `ulna live touch` shows: one line of what is known, what to do next, what happened."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.text import Text

from ulna.live.events import Meter
from ulna.live.lacking_words import LINES
from ulna.live.said import meter_line, next_lines

if TYPE_CHECKING:
    from ulna.live.session import Session

_BAR = 10
_KEYS = "space touch · n moved · w withdraw · h hold out · t angles right · q end"


def screen(session: Session, meter: Meter | None, lacking: list[str], said: list[str]) -> RenderableType:
    """80 columns, always as many lines."""
    tip_mm, place = session.tip_mm, Text("nothing has come yet")
    if tip_mm is not None:
        x, y, z = tip_mm
        bar = "█" * round(_BAR * session.rests)
        place = Text(f"x {x:8.2f}  y {y:8.2f}  z {z:8.2f} mm  still {bar:<{_BAR}}", style="bold")
    if session.stream.doubtful:
        place.append("  DOUBTFUL (t)", style="bold reverse")
    rows: list[RenderableType] = [place]
    if meter is not None:
        lines = next_lines(meter)
        rows += [
            Text(meter_line(meter), style="bold"),
            *(Text(line) for line in lines),
            *([Text("")] * (2 - len(lines))),
            Text(""),
            *(Text(line, style="yellow") for line in lacking),
            *([Text("")] * (LINES - len(lacking))),
        ]
    rows += [Text(""), *(Text(line) for line in said)]
    rows += [Text(""), Text(_KEYS, style="dim")]
    return Group(*rows)
