"""What `ulna calibrate` prints unless all of it is asked for: one screen of a fit that ended well, half of one that did
not, and the verdict once more at the end, where the eye is."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from io import StringIO
from typing import Any

from rich.console import Console, RenderableType
from rich.table import Table
from rich.text import Text

from ulna.arm.directions import combination
from ulna.arm.effects.effects import extra_of
from ulna.artefacts.quantities import QUANTITIES
from ulna.calibration.placements import Figures
from ulna.calibration.result import Result
from ulna.calibration.summary import Parameter
from ulna.calibration.suspects import Suspicion
from ulna.cli.printed.calibration import ending, equations, parameter_tables, signs_found
from ulna.cli.printed.chosen import chosen_model
from ulna.cli.printed.extras import judged_extras
from ulna.cli.printed.figures import before_after
from ulna.cli.printed.hints import what_to_try
from ulna.cli.printed.identification import cause_in_words, determined_in_words
from ulna.cli.printed.mapped import mapped
from ulna.cli.printed.scale import common_factor
from ulna.cli.printed.scatter import scatter
from ulna.cli.printed.signs import signs_in_lines
from ulna.cli.printed.tables import table
from ulna.ground.digits import figure_mm, uncertainty

#: lines of a fit that ended well, those of what was written included
MOST_LINES = 60
_WRITTEN = 3
#: with fewer parameters a table says nothing
_FEWEST_ROWS = 8
#: of what was lost, what is weak, what fits worst
_FEW = 4
#: of what is far off: who has a few bad rows sees all of them
_FEW_FAR_OFF = 8
#: a table of parameters has no room for their start in less
_NARROW = 72


def brief_report(result: Result, width: int, suspected: Suspicion | None = None) -> list[RenderableType]:
    """Of `width` columns; suspected: what would explain readings that a fit has not."""
    return _well(result, width) if result.fit.converged else _badly(result, suspected)


def _well(result: Result, width: int) -> list[RenderableType]:
    before: list[RenderableType] = [Text(f"{result.arm.name}, {result.arm.n} joints. {ending(result.fit)}")]
    before += signs_in_lines(result.fit, width)
    before.append(Text(equations(result.fit)))
    before += [Text(said) for said in filter(None, [scatter(result), common_factor(result)])]
    rms = ["reading to fit, rms", figure_mm(result.fit.rms_start_mm), figure_mm(result.fit.rms_mm)]
    figures = before_after(
        "Before and after, on the fitted readings",
        _few(result.before),
        _few(result.after),
        [rms],
        without=_few(result.without_far_off) if result.without_far_off is not None else None,
        far_off=len(result.outliers),
    )
    before += ["", figures, ""]
    after = [*signs_found(result.fit), *_open(result, width), *judged_extras(result.extras)]
    after += [*chosen_model(result.chosen, all_of_it=False), *mapped(result.residual_map, all_of_it=False)]
    after += [*_far_off(result, width), "", _verdict(result)]
    room = MOST_LINES - _WRITTEN - sum(_lines(part, width) for part in [*before, *after])
    return [*before, *_parameters(result.parameters, width, room), *after]


def _few(figures: Figures) -> Figures:
    """Root mean square and largest of each quantity; its only figure where it has one."""
    kept = {name for quantity in QUANTITIES for name in quantity.names() if not quantity.distributed or _tells(name)}
    return {name: value for name, value in figures.items() if name in kept}


def _tells(name: str) -> bool:
    return name.endswith(("_rms_mm", "_max_mm", "_max_abs_mm"))


def _parameters(rows: Sequence[Parameter], width: int, room: int) -> list[RenderableType]:
    """As many as there is room for: what is beyond geometry goes first, then what is held, from the last on."""
    with_start = width >= _NARROW
    kept = list(rows)

    def fits() -> bool:
        lines = sum(_lines(part, width) for part in parameter_tables(kept, with_start))
        return lines + (len(kept) < len(rows)) <= room

    for _, row in sorted(enumerate(rows), key=lambda numbered: (_stays(numbered[1]), -numbered[0])):
        if len(kept) <= _FEWEST_ROWS or fits():
            break
        kept.remove(row)
    parts = parameter_tables(kept, with_start)
    left = len(rows) - len(kept)
    return [*parts, Text(f"… and {left} more: --all shows them.")] if left else parts


def _stays(row: Parameter) -> int:
    """The later, the longer it stays."""
    return 0 if extra_of(row.name) is not None else 1 if row.status == "held" else 2


def _open(result: Result, width: int) -> list[RenderableType]:
    """What was lost and what is weak, a line each."""
    found = result.identifiability
    parts: list[RenderableType] = []
    if found.lost:
        parts += ["", Text(f"{determined_in_words(found).capitalize()} Why, and what helps: --all.")]
        for direction in found.lost[:_FEW]:
            cause = cause_in_words(str(direction.get("cause", "")))
            parts.append(_cut(f" {combination(direction['combination'])}{f'   ({cause})' if cause else ''}", width))
        if len(found.lost) > _FEW:
            parts.append(Text(f" … and {len(found.lost) - _FEW} more"))
    if found.weak:
        parts += ["", Text("Known worse than from a drawing:")]
        for direction in found.weak[:_FEW]:
            u = f"u = {uncertainty(direction['u'])} {direction['unit']}"
            parts.append(_cut(f" {combination(direction['combination'])}   ({u})", width))
        if len(found.weak) > _FEW:
            parts.append(Text(f" … and {len(found.weak) - _FEW} more"))
    return parts


def _far_off(result: Result, width: int) -> list[RenderableType]:
    if not result.outliers:
        return []
    more = len(result.outliers) - _FEW_FAR_OFF
    counted = "They counted in full." if result.fit.loss == "none" else "The loss let them count less."
    parts: list[RenderableType] = [
        "",
        Text(f"Far off the rest: {len(result.outliers)} of {result.fit.readings} readings. {counted} Look at them:"),
        *(_cut(f" {_off(entry)}", width) for entry in result.outliers[:_FEW_FAR_OFF]),
    ]
    return [*parts, Text(f" … and {more} more: --all, result.json")] if more > 0 else parts


def _off(entry: Mapping[str, Any]) -> str:
    place = f" ({entry['place']})" if "place" in entry else ""
    names = f"{entry['artefact']}, placement {entry['placement']}"
    return f"{figure_mm(entry['norm_mm'])} mm: row {entry['row']}{place} of {entry['file']} ({names})"


def _verdict(result: Result) -> Text:
    fit, found = result.fit, result.identifiability
    far = f", {len(result.outliers)} far off" if result.outliers else ""
    determined = f"{found.determined} of {found.parameters} parameters determined"
    text = f"Converged: {figure_mm(fit.rms_mm)} mm rms, {determined}{far}."
    if fit.common_factor is not None or fit.mirrored_signs:
        return Text(f"{text} Read what is asked above.", style="bold yellow")
    return Text(text, style="bold green")


def _badly(result: Result, suspected: Suspicion | None) -> list[RenderableType]:
    """The verdict, the worst rows, one thing to try: nothing that only holds of an arm that was found."""
    fit = result.fit
    parts: list[RenderableType] = [
        Text(f"{result.arm.name}, {result.arm.n} joints. {ending(fit)}"),
        Text(f"Left: reading to fit, rms {figure_mm(fit.rms_mm)} mm; before {figure_mm(fit.rms_start_mm)} mm."),
    ]
    worst = result.residuals.sort("norm_mm", descending=True).head(_FEW)
    if len(worst):
        rows = [
            (str(row["row"]), row["file"], row["artefact"], row["placement"], figure_mm(row["norm_mm"]))
            for row in worst.iter_rows(named=True)
        ]
        parts += ["", table("Worst met", ("row", "of", "artefact", "placement", "mm"), rows, left=4)]
    tries = [common_factor(result), what_to_try(result, suspected)]
    parts += ["", *(Text(said) for said in tries if said)]
    parts.append(
        Text(f"NOT converged ({fit.termination}): do not use these numbers. --all shows them.", style="bold red")
    )
    return parts


def _cut(text: str, width: int) -> Text:
    """In one line."""
    cut = Text(text)
    cut.truncate(width, overflow="ellipsis")
    return cut


def _lines(part: RenderableType, width: int) -> int:
    """That it takes on a terminal; tables are as wide as they are."""
    printed = StringIO()
    Console(file=printed, width=10_000 if isinstance(part, Table) else width).print(part)
    return printed.getvalue().count("\n")
