"""`ulna export`: an arm in the form that another program takes."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from ulna.cli.help import Command, Group
from ulna.cli.options import ArmFile, Force, one_of
from ulna.cli.running import guard

app = typer.Typer(
    cls=Group,
    rich_markup_mode=None,
    name="export",
    help="Write an arm, calibrated or not, in the form that another program takes.",
    no_args_is_help=True,
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


@app.command("urdf", cls=Command)
@guard
def urdf(
    arm: ArmFile,
    out: Annotated[Path, typer.Option("--out", "-o", metavar="FILE", help="URDF to write.", show_default=False)],
    template: Annotated[
        Path | None,
        typer.Option("--template", metavar="FILE", help="The robot's own URDF, to get the arm's numbers."),
    ] = None,
    tip_link: Annotated[
        str | None, typer.Option("--tip-link", metavar="NAME", help="Its link that ends in the probe's tip.")
    ] = None,
    base_link: Annotated[
        str | None, typer.Option("--base-link", metavar="NAME", help="Its link that the arm stands on.")
    ] = None,
    probe: Annotated[
        str | None, typer.Option("--probe", metavar="NAME", help="The probe at that link, where there are several.")
    ] = None,
    force: Force = False,
) -> None:
    """Write an arm as a URDF for ROS. Fed with what the encoders read, its tip stands where Ulna measures it.

    With --template it is the robot's own URDF with other origins of the joints up to the tip and nothing else changed:
    meshes, inertias, comments and layout stay. Without, it is the arm alone: joints, links, and one link for each
    probe's tip. Signs and zero offsets are in it.

    Example: [bold]ulna export urdf out/result.json -o calibrated.urdf --template robot.urdf[/bold]
    """
    from ulna.cli import output
    from ulna.exchange.export.source import chosen_probe, read_source
    from ulna.exchange.export.template import export_template, remarks, summary
    from ulna.exchange.export.urdf import urdf_text
    from ulna.formats.output import refuse_inputs, write_file
    from ulna.ground.errors import UlnaInputError

    for option, value in (("--tip-link", tip_link), ("--base-link", base_link), ("--probe", probe)):
        if template is None and value is not None:
            raise UlnaInputError(
                f"option {option}: got '{value}' without --template; expected it with one, for else the arm's base and "
                "each probe get links of their own. Leave it out, or name the robot's URDF with --template."
            )
    refuse_inputs([out], [arm, *([template] if template else [])])
    source = read_source(arm, "a URDF", has_base=True)
    if template is None:
        write_file(out, urdf_text(source.arm), force)
        output.say(f"{out}: '{source.arm.name}', {source.arm.n} joints, {_listed(source.arm.probes)}.")
    else:
        name = chosen_probe(source.arm, probe, arm)
        filled = export_template(template, source.arm, name, tip_link, base_link)
        write_file(out, filled.content, force)
        output.say(f"{out}: {summary(filled, name)}")
        source.remarks.extend(f"{out}: {remark}" for remark in remarks(filled))
    for remark in source.remarks:
        output.say(f"warning: {remark}")


@app.command("dh", cls=Command)
@guard
def dh(
    arm: ArmFile,
    out: Annotated[Path, typer.Option("--out", "-o", metavar="FILE", help="CSV to write.", show_default=False)],
    convention: Annotated[
        str, typer.Option("--convention", help="dh (upper-joint, Ulna's own) or modified-dh (Craig).")
    ] = "dh",
    length_unit: Annotated[str, typer.Option("--length-unit", help="mm, m or in.")] = "mm",
    angle_unit: Annotated[str, typer.Option("--angle-unit", help="rad or deg.")] = "rad",
    hayati: Annotated[
        bool, typer.Option("--hayati", help="A column beta for Hayati joints, in place of large offsets d.")
    ] = False,
    force: Force = False,
) -> None:
    """Write an arm as a table of Denavit–Hartenberg parameters: a row for each joint, then one for each probe's tip.

    turn = sign * encoder - theta0; an offset, as many controllers call it, is -theta0. The tips' rows are frames that
    no encoder turns. Units stand in the names of the columns. Hayati joints become DH joints where the axes have a
    common normal, so that controllers take them.

    Example: [bold]ulna export dh out/result.json -o table.csv --convention modified-dh --angle-unit deg[/bold]
    """
    from ulna.cli import output
    from ulna.exchange.export.dh import dh_table, without_beta
    from ulna.exchange.export.source import read_source
    from ulna.formats.output import refuse_inputs, write_file

    one_of("--convention", convention, ("dh", "modified-dh"))
    one_of("--length-unit", length_unit, ("mm", "m", "in"))
    one_of("--angle-unit", angle_unit, ("rad", "deg"))
    refuse_inputs([out], [arm])
    source = read_source(arm, "a table", has_base=False)
    choices: Any = {"convention": convention, "length": length_unit, "angle": angle_unit}
    written, said = (source.arm, []) if hayati else without_beta(source.arm)
    source.remarks.extend(f"{out}: {remark}" for remark in said)
    write_file(out, dh_table(written, path=arm, **choices), force)
    output.say(f"{out}: '{source.arm.name}', {source.arm.n} joints, {_listed(source.arm.probes)}.")
    for name, probe in written.probes.items():
        x, y, z = (f"{value:.4f}" for value in probe.tip_mm)
        where = f"x = {x}, y = {y}, z = {z} mm in the frame that turns with joint {source.arm.n}"
        output.say(f"Probe '{name}' is at {where}: a controller's tool.")
    for remark in source.remarks:
        output.say(f"warning: {remark}")


def _listed(probes: dict[str, Any]) -> str:
    return f"probe{'s' * (len(probes) > 1)} {', '.join(repr(name) for name in probes)}"
