"""`ulna compare`: what has moved between calibrations of one arm."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ulna.cli.options import All, Force, Json
from ulna.cli.running import guard

if TYPE_CHECKING:
    from ulna.comparison.compare import Comparison


@guard
def compare(
    results: Annotated[
        list[Path],
        typer.Argument(metavar="RESULT", help="Two to six results, the earliest first.", show_default=False),
    ],
    probe: Annotated[
        str | None,
        typer.Option("--probe", metavar="NAME", help="With which lengths are compared; default: the first of both."),
    ] = None,
    shared_u: Annotated[
        float,
        typer.Option(
            "--shared-u",
            metavar="RATIO",
            help="u of the artefact on which all rest, as their studies state it, over its length; 0: none such.",
        ),
    ] = 0.0,
    everything: All = False,
    picture: Annotated[
        Path | None,
        typer.Option("--picture", metavar="FILE", help="Where lengths changed, and which parameters: PNG, SVG or PDF."),
    ] = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Say what has moved between calibrations of one arm, and whether their uncertainties explain it.

    Each is compared with the next: first what it does to lengths all over the volume, then chi² of the difference over
    what both determined, then each parameter. What neither determined and how the base stands make no difference. Exit
    code 1 where it moved by more than both uncertainties explain.

    Example: [bold]ulna compare out-2025 out-2026[/bold]
    """
    from ulna.cli import output
    from ulna.cli.printed.comparison import comparison_report
    from ulna.comparison.compare import compare as run_compare

    form = "" if picture is None else picture_form(picture, results, force)
    found = run_compare(*results, probe=probe, shared_u=shared_u)
    if as_json:
        output.print_json(found.as_dict())
    else:
        output.print_renderable(*comparison_report(found, everything))
    if picture is not None:
        write_picture(picture, found, form, force)
    raise typer.Exit(int(any(step.moved for step in found.steps)))


def picture_form(picture: Path, inputs: Sequence[Path], force: bool) -> str:
    """By its ending, asked before the long work. Raises UlnaInputError for a place where it cannot be written."""
    from ulna.cli.endings import by_ending
    from ulna.formats.output import check_output, refuse_inputs
    from ulna.ground.extras import need

    need("option --picture", "matplotlib")
    (form,) = by_ending(picture, {".png": "png", ".svg": "svg", ".pdf": "pdf"}, [], folder=False)
    refuse_inputs([picture], inputs)
    check_output(picture.parent, [picture.name], force)
    return form


def write_picture(picture: Path, found: Comparison, form: str, force: bool) -> None:
    """Draw it, and say so."""
    from ulna.cli import output
    from ulna.documents.drawn.comparison import drawn
    from ulna.formats.output import write_file

    write_file(picture, drawn(found, form), force)
    output.say(f"Written: {picture}")
