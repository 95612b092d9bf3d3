"""The tables of a work sheet: a row for each stand, then a table of touches for each stand, with boxes to tick."""

from __future__ import annotations

from collections import Counter

import numpy as np

from ulna.documents.languages.text import Name, Text, joined
from ulna.documents.languages.words import Words
from ulna.documents.pdf import blocks
from ulna.documents.pdf.text import Cell, cell, line
from ulna.ground.arrays import F64
from ulna.planning.outcome import Plan
from ulna.planning.stands import Stand, elbow_sides, probe_from, runs
from ulna.planning.touchable import Touchable, touchable

BOX = "☐"
ROOMY_PT, TIGHT_PT = 6.0, 2.6
"""Above and below the text of a row: room to write, or just to tick."""


def stands(plan: Plan, words: Words) -> blocks.Block:
    """A row for each place: its number, where the artefact goes, how it lies, what is measured there."""
    what = _what(plan)
    heads = ["stand", "place", "height", "direction", "placements", "touch", "done", "remarks"]
    rows = [
        [
            f"{stand.number}",
            _place(stand, what, words),
            _height(plan, stand),
            cell(_direction(stand, words), words.language),
            runs(stand.measurements.tolist()),
            cell(_touches(plan, stand, what, words), words.language),
            BOX,
            "",
        ]
        for stand in plan.stands
    ]
    widths = [0.0, 0.0, 0.0, 1.5, 1.1, 1.3, 0.0, 2.2]
    table = blocks.table(_heads(heads, words), rows, widths, len(heads), 9.0)
    return table | {"inset": ROOMY_PT}


def touches(plan: Plan, words: Words) -> list[blocks.Block]:
    """Stand by stand: a row for each touch, with the angles to come near to."""
    what, language = _what(plan), words.language
    q_rad = plan.q_rad
    _, places, often, n = q_rad.shape
    flat = q_rad.reshape(-1, n)
    probe = plan.arm.probe_index(plan.spec.probe)
    tip_mm = plan.arm.core.tip(np.ascontiguousarray(flat), probe)
    elbows, comes = elbow_sides(plan.arm, flat, tip_mm), probe_from(plan.arm, flat, tip_mm)
    per = places * often
    names = [name for name in what.names for _ in range(often)]
    head = ["step", "placement", "feature" if what.outward is None else "touch-number"]
    heads = [*_heads(head, words), *(f"q{k + 1} / °" for k in range(n)), *_heads(["elbow", "from", "done"], words)]
    widths = [0.0, 0.0, 0.0, *[1.0] * n, 1.4, 1.4, 0.0]
    found: list[blocks.Block] = []
    for stand in plan.stands:
        rows = [
            _touch(row, names[row % per], row // per + 1, flat[row], elbows[row], comes[row], words)
            for number in stand.measurements.tolist()
            for row in range((number - 1) * per, number * per)
        ]
        found.append(blocks.heading(line(words("sheet.stand-of", number=stand.number), language), 2))
        found.append(blocks.table(heads, rows, widths, 3, 8.0) | {"inset": TIGHT_PT})
    return found


def _touch(row: int, name: str, placement: int, q_rad: F64, elbow: str | None, comes: str, words: Words) -> list[Cell]:
    side = "–" if elbow is None else line(words(f"sheet.elbow-{elbow}"), words.language)
    return [
        f"{row + 1}",
        f"{placement}",
        cell((Name(name),), words.language),
        *(_number(float(angle)) for angle in np.degrees(q_rad)),
        side,
        line(words(f"sheet.from-{comes}"), words.language),
        BOX,
    ]


def _place(stand: Stand, what: Touchable, words: Words) -> Cell:
    """A line for each feature; of a surface the middle of its touches."""
    if what.outward is not None:
        return _xyz(stand.points_mm.mean(axis=0))
    lines: list[Text] = []
    for name, point in zip(what.names, stand.points_mm, strict=True):
        lines.append((Name(name), ": ", _xyz(point)))
    return cell(joined(lines, "\n"), words.language)


def _height(plan: Plan, stand: Stand) -> str:
    """Of the lowest and the highest point above the table, mm."""
    table_mm = 0.0 if plan.spec.within is None else plan.spec.within.table_mm
    height = stand.points_mm[:, 2] - table_mm
    low, high = _number(float(height.min()), 0), _number(float(height.max()), 0)
    return low if low == high else f"{low} … {high}"


def _direction(stand: Stand, words: Words) -> Text:
    """In words and degrees, from the first feature to the last."""
    return (
        words(f"sheet.lies-{stand.lies}", azimuth=(f"{stand.azimuth_deg:.0f}",), slope=(f"{abs(stand.slope_deg):.0f}",))
        if stand.lies in ("rising", "falling")
        else (
            words(f"sheet.lies-{stand.lies}", azimuth=(f"{stand.azimuth_deg:.0f}",))
            if stand.lies == "level"
            else words(f"sheet.lies-{stand.lies}")
        )
    )


def _touches(plan: Plan, stand: Stand, what: Touchable, words: Words) -> Text:
    """Which features how often."""
    each = len(stand.measurements) * plan.spec.touches
    if what.outward is not None:
        return words("sheet.spread", times=len(stand.measurements) * len(what.names))
    counts = Counter(dict.fromkeys(what.names, each))
    return joined([(Name(name), f" {times} ×") for name, times in counts.items()], "\n")


def _xyz(point_mm: F64) -> str:
    return "  ".join(_number(float(value), 0) for value in point_mm)


def _number(value: float, digits: int = 1) -> str:
    """With a true minus, and no minus before zero."""
    text = f"{value:.{digits}f}"
    return text.replace("-", "−") if float(text) else text.replace("-", "")


def _heads(keys: list[str], words: Words) -> list[str]:
    return [line(words(f"sheet.head-{key}"), words.language) for key in keys]


def _what(plan: Plan) -> Touchable:
    return touchable(plan.spec, plan.arm, plan.arm.probe_index(plan.spec.probe))
