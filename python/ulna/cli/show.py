"""`ulna show`: a picture of an arm, with a slider for each joint."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.options import Force, one_of
from ulna.cli.running import guard

_DRAWING = "Of a URDF or a DH table"


@guard
def show(
    arm: Annotated[
        Path,
        typer.Argument(
            metavar="ARM",
            help="An arm.toml, a result.json or its folder, a URDF, a DH table (CSV).",
            show_default=False,
        ),
    ],
    out: Annotated[
        Path | None,
        typer.Option("-o", "--out", metavar="FILE", help="Page to write; default: the arm file's name, .html, here."),
    ] = None,
    pose: Annotated[
        str | None,
        typer.Option("--pose", metavar="ANGLES", help='Encoder angles to begin with, degrees: "0,30,-45".'),
    ] = None,
    probe: Annotated[
        str | None, typer.Option("--probe", metavar="NAME", help="Which probe is on; default: the first.")
    ] = None,
    open_it: Annotated[bool, typer.Option("--open", help="Open it in the browser.")] = False,
    language: Annotated[str, typer.Option("--language", metavar="CODE", help="en, de or zh.")] = "en",
    convention: Annotated[
        str | None,
        typer.Option(metavar="WORD", help="Of a table: dh or modified-dh.", rich_help_panel=_DRAWING),
    ] = None,
    length_unit: Annotated[
        str | None, typer.Option(metavar="UNIT", help="mm, m or in, where it is not said.", rich_help_panel=_DRAWING)
    ] = None,
    angle_unit: Annotated[
        str | None, typer.Option(metavar="UNIT", help="rad or deg, where it is not said.", rich_help_panel=_DRAWING)
    ] = None,
    tip: Annotated[
        tuple[float, float, float] | None,
        typer.Option(metavar="X Y Z", help="Of a table: the tip in its last frame.", rich_help_panel=_DRAWING),
    ] = None,
    tip_link: Annotated[
        str | None, typer.Option(metavar="LINK", help="Of a URDF: its origin is the ball.", rich_help_panel=_DRAWING)
    ] = None,
    base_link: Annotated[
        str | None, typer.Option(metavar="LINK", help="Of a URDF: the arm stands on it.", rich_help_panel=_DRAWING)
    ] = None,
    force: Force = False,
) -> None:
    """Draw an arm in a page with a slider for each joint, so that a wrong twist is seen before anything is measured.

    Axes, the frames at the ends of the links, the sense in which each encoder counts, and the tip's x, y, z for the
    angles of the sliders. One HTML file that needs no network; nothing is measured and nothing is fitted.

    Example: [bold]ulna show arm.toml --pose "0,30,-45,0,60,0" --open[/bold]
    """
    from ulna.cli import output
    from ulna.cli.endings import by_ending
    from ulna.cli.printed.show import lines
    from ulna.documents.arm_page.page import render
    from ulna.documents.languages.languages import LANGUAGES
    from ulna.exchange.drawings import Asked, read_drawing
    from ulna.formats.output import refuse_inputs, write_file
    from ulna.pictures.poses import pose_of, start_pose
    from ulna.pictures.scene import scene

    one_of("--language", language, tuple(LANGUAGES))
    for option, value, known in (
        ("--convention", convention, ("dh", "modified-dh")),
        ("--length-unit", length_unit, ("mm", "m", "in")),
        ("--angle-unit", angle_unit, ("rad", "deg")),
    ):
        if value is not None:
            one_of(option, value, known)
    found = read_drawing(arm, Asked(convention, length_unit, angle_unit, tip, tip_link, base_link))
    found.arm.check_turns(arm, "pages with sliders")
    q_rad = start_pose(found.arm) if pose is None else pose_of(pose, found.arm)
    if out is not None:
        by_ending(out, {".html": "html", ".htm": "html"}, [], folder=False)
    target = out or Path(f"{(arm.resolve().name if arm.is_dir() else arm.stem)}.html")
    refuse_inputs([target], [found.file])
    drawn = scene(found.arm, probe)
    write_file(target, render(drawn, q_rad, language), force)
    for line in lines(target, drawn, q_rad, found.remarks):
        output.say(line)
    if open_it:
        import webbrowser

        if not webbrowser.open(target.resolve().as_uri()):
            output.say(f"No browser was found. Open {target} yourself.")
