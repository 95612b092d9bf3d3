"""What `ulna live measure` shows: a screen of 60 columns or more, and lines where there is no terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from rich.console import Group, RenderableType
from rich.text import Text

from ulna.ground.digits import decimals, fixed
from ulna.ground.errors import for_people

if TYPE_CHECKING:
    from ulna.live.features import Feature, Point
    from ulna.live.figures import Figure
    from ulna.live.readout import ReadOut, Tip
    from ulna.live.rounds import Round

KEYS = "space point · n new · k kind · u back · q end"
TRUST = "t: the angles are right, I looked"
_POINTS, _FEATURES, _FAULTS = 4, 2, 1
"""So many, the last ones, are on the screen."""
_NAMES = 5
"""From so many on the names of a feature's points are not all told."""
NOT_DETERMINED = "not determined"

_DOTS = {
    "0": "###|#.#|#.#|#.#|###",
    "1": ".#.|##.|.#.|.#.|###",
    "2": "###|..#|###|#..|###",
    "3": "###|..#|###|..#|###",
    "4": "#.#|#.#|###|..#|..#",
    "5": "###|#..|###|..#|###",
    "6": "###|#..|###|#.#|###",
    "7": "###|..#|..#|..#|..#",
    "8": "###|#.#|###|#.#|###",
    "9": "###|#.#|###|..#|###",
    "-": "...|...|###|...|...",
    ".": ".|.|.|.|#",
}
"""Signs of a number, five dots high."""
_HALVES = {"..": " ", "#.": "▀", ".#": "▄", "##": "█"}
"""Two dots above each other in one letter."""


def large(number: str) -> tuple[str, str, str]:
    """A number in three lines."""
    signs = [_DOTS[sign].split("|") for sign in number]
    lines = []
    for above, below in ((0, 1), (2, 3), (4, None)):
        parts = []
        for rows in signs:
            under = "." * len(rows[0]) if below is None else rows[below]
            parts.append("".join(_HALVES[two[0] + two[1]] for two in zip(rows[above], under, strict=True)))
        lines.append(" ".join(parts))
    return lines[0], lines[1], lines[2]


def amount(figure: Figure) -> str:
    """12.345 ± 0.012; with the digits that U bears."""
    if figure.value is None:
        return NOT_DETERMINED
    places = decimals(figure.expanded, figure.unit)
    with_u = "" if figure.expanded is None else f" ± {fixed(figure.expanded, places)}"
    return fixed(figure.value, places) + with_u


def factor(figures: Sequence[Figure]) -> str:
    """(k = 2); the largest of them, nothing where there is none."""
    known = [figure.k for figure in figures if figure.k is not None]
    return f" (k = {max(known):.3g})" if known else ""


def in_line(figures: Sequence[Figure]) -> str:
    """x 1.234 ± 0.012, y …, z … mm (k = 2); once why they are not determined."""
    if figures and all(figure.value is None for figure in figures):
        return _why(figures)
    alike = all(figure.unit == "mm" for figure in figures)
    each = [f"{figure.name} {amount(figure)}{'' if alike or figure.unit == '1' else ' mm'}" for figure in figures]
    lost = _why(figures)
    return ", ".join(each) + (" mm" if alike else "") + factor(figures) + (f". {lost}" if lost else "")


def _why(figures: Sequence[Figure]) -> str:
    why = next((figure.why for figure in figures if figure.why is not None), None)
    return "" if why is None else f"{NOT_DETERMINED}: {for_people(why).rstrip('.')}"


def point_line(point: Point) -> str:
    """A point that was taken."""
    return f"{point.name}: {in_line(point.figures)}"


def feature_line(feature: Feature, figures: Sequence[Figure]) -> str:
    """A feature, or how many touches it lacks."""
    names = [point.name for point in feature.points]
    shown = " ".join(names if len(names) < _NAMES else [names[0], "…", names[-1]])
    head = f"{feature.name} {feature.kind}" + (f" ({shown})" if shown else "")
    head = feature.name if feature.name.startswith(feature.kind) else head
    if feature.lacking:
        return f"{head}: {feature.lacking} more touch{'es' * (feature.lacking > 1)}"
    return f"{head}: {in_line(figures)}"


def tip_line(tip: Tip) -> str:
    """Where the tip is, in a line."""
    parts = [in_line(tip.figures)]
    if tip.stillness is not None:
        parts.append("still" if tip.stillness.still else "moving")
    if tip.distance is not None:
        parts.append(_apart(tip))
    return "; ".join([*parts, *tip.warnings])


def _apart(tip: Tip) -> str:
    """How far it is from the point that was named."""
    assert tip.distance is not None
    return f"to {tip.to}: {in_line([tip.distance]).removeprefix(f'{tip.distance.name} ')}"


def notes(out: ReadOut) -> list[str]:
    """What holds for all that is shown, once."""
    arm = out.arm
    found = [] if arm.without is None else [f"No U: {arm.without}."]
    if arm.without is None and not arm.noise.known:
        found.append("How readings scatter is not in U: nobody stated it. State --encoder-u.")
    if arm.ball_mm:
        found.append(
            f"Points and planes are of the centre of the probe's ball, {arm.ball_mm / 2.0:g} mm off what it touches."
        )
    else:
        found.append(
            "Points, and diameters, are of the centre of the probe's ball, whose size the arm file does not say."
        )
    found += arm.remarks
    limits = out.limits
    if limits is not None and not limits.sees:
        found.append("At this rate and noise the slowest hand cannot be told from one that rests.")
    return found


def screen(out: ReadOut, known: Round, said: str, keys: bool, blocks: bool = True) -> RenderableType:
    """All of it; keys: whether somebody can press them; blocks: whether the terminal knows letters to draw with."""
    tip = out.now()
    parts: list[RenderableType] = [_head(out, known, tip)]
    if tip is None:
        parts.append(Text("Nothing came yet."))
    else:
        parts += _place(tip, blocks)
        if tip.distance is not None:
            parts.append(Text(_apart(tip)))
        parts += [Text(f"! {warning}", style="bold") for warning in tip.warnings]
    parts += [_one(point_line(point)) for point in out.notebook.points[-_POINTS:]]
    # a reason is told whole at the tip, and at the end
    lines = _features(out)[-_FEATURES:]
    parts += [_one(line) if f": {NOT_DETERMINED}: " in line else Text(line) for line in lines]
    parts += [_one(f"{fault.kind}: {for_people(fault.text)}") for fault in list(known.last)[-_FAULTS:]]
    if said:
        parts.append(Text(said, style="bold"))
    if keys:
        parts += [_one(line) for line in ([] if out.doubt is None else [TRUST]) + [KEYS]]
    return Group(*parts)


def _head(out: ReadOut, known: Round, tip: Tip | None) -> Text:
    name = for_people(out.arm.arm.name or "arm")[:24]
    head = Text(f"{name} · probe {for_people(out.arm.probe)[:12]} · {known.rate_hz:.0f}/s")
    if tip is not None and tip.stillness is not None:
        head.append(" · still" if tip.stillness.still else " · moving")
    if known.silent_s > 1.0 and known.why is None:
        head.append(f" · silent for {known.silent_s:.0f} s", style="bold")
    if out.doubt is not None:
        head.append(" · DOUBTFUL", style="bold reverse")
    return head


def _place(tip: Tip, blocks: bool) -> list[RenderableType]:
    """The coordinates, large."""
    if any(figure.value is None for figure in tip.figures):
        return [Text(), Text(_why(tip.figures), style="bold"), Text()]
    shown = [amount(figure).split(" ± ") for figure in tip.figures]
    widest = max(len(value) for value, *_ in shown)
    lines: list[RenderableType] = []
    for figure, (value, *u) in zip(tip.figures, shown, strict=True):
        with_u = f" ± {u[0]} mm{factor([figure])}" if u else " mm"
        if not blocks:
            lines.append(Text(f"{figure.name.upper()}  {value:>{widest}}{with_u}", style="bold", no_wrap=True))
            continue
        above, middle, below = large(value)
        blank = " " * (4 * (widest - len(value)))
        rows = f"   {blank}{above}", f"{figure.name.upper()}  {blank}{middle}", f"   {blank}{below}{with_u}"
        lines += [Text(row, no_wrap=True) for row in rows]
    return lines


def _features(out: ReadOut) -> list[str]:
    asked = [each for each in (one.of(out.notebook.points) for one in out.notebook.asked) if each is not None]
    features = [each for each in out.notebook.features if each.kind != "point" or len(each.points) > 1]
    if out.notebook.current.kind != "point" and out.notebook.current not in features:
        features.append(out.notebook.current)
    return [feature_line(each, out.figures(each)) for each in [*asked, *features]]


def _one(line: str) -> Text:
    return Text(line, overflow="ellipsis", no_wrap=True)


def summary(out: ReadOut) -> list[str]:
    """What was taken, at the end."""
    return [*(point_line(point) for point in out.notebook.points), *_features(out)]
