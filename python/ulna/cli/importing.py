"""`ulna import`: readings that others have measured, and drawings of robots, as files of Ulna."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Any

import typer

from ulna.cli.help import Command, Group
from ulna.cli.options import one_of
from ulna.cli.running import guard

app = typer.Typer(
    cls=Group,
    rich_markup_mode=None,
    name="import",
    help="Turn readings in somebody else's layout into a study folder: arm.toml, study.toml and the readings.\n\n"
    "Any other table is named in a study as it is (keys separator, decimal, sheet, dataset, columns of "
    "[[readings]]); describe the arm in an arm file (import urdf makes one of a robot's drawing, import dh of a "
    "table).",
    no_args_is_help=True,
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

Out = Annotated[Path, typer.Option("--out", "-o", help="Folder to write the study to.")]
Force = Annotated[bool, typer.Option("--force", help="Overwrite files that exist.")]
AsParquet = Annotated[bool, typer.Option("--parquet", help="Write the readings as Parquet, not CSV.")]


@app.command("mukca", cls=Command)
@guard
def mukca(
    folder: Annotated[
        Path, typer.Argument(help="A robot's folder: one folder per place of the tool, with hole_0.csv.")
    ],
    out: Out,
    urdf: Annotated[
        Path | None, typer.Option(help="The robot's drawing, where the folder's name says nothing.")
    ] = None,
    tip_link: Annotated[str | None, typer.Option(help="The link of the drawing whose origin is the ball.")] = None,
    length: Annotated[float, typer.Option(min=1e-6, help="Distance between the two sockets, mm.")] = 50.0,
    parquet: AsParquet = False,
    drop_copies: Annotated[bool, typer.Option("--drop-copies", help="Leave out rows that repeat another.")] = False,
    force: Force = False,
) -> None:
    """A robot that touched two sockets a known distance apart, in several places.

    Example: ulna import mukca kinematics_calibration/panda_1 -o panda_1
    """
    from ulna.exchange.importers.mukca import import_mukca

    counts = import_mukca(folder, out, urdf, tip_link, length, parquet, drop_copies, force)
    places = ", ".join(f"{name} {count}" for name, count in counts.items())
    _say(f"{out}: {sum(counts.values())} readings in {len(counts)} placements ({places}).")
    _say(f"Next: ulna cross-validate {out / 'study.toml'} --by placement")


@app.command("ipa-ur10", cls=Command)
@guard
def ipa_ur10(
    file: Annotated[
        Path, typer.Argument(help="The table: semicolons, decimal commas, joint angles and tracker positions.")
    ],
    out: Out,
    fit: Annotated[
        int | None, typer.Option(min=1, help="How many rows to fit; the rest is held out. Default: all.")
    ] = None,
    every: Annotated[int, typer.Option(min=1, help="Choose among every k-th row only.")] = 1,
    spread: Annotated[bool, typer.Option("--spread", help="Spread the rows to fit over the file.")] = False,
    standings: Annotated[
        int, typer.Option(min=1, help="Take the tracker's place as new in each of so many parts of the file.")
    ] = 1,
    orientations: Annotated[
        bool, typer.Option("--orientations", help="Read how the target was turned as well as where it was.")
    ] = False,
    parquet: AsParquet = False,
    force: Force = False,
) -> None:
    """A UR10 whose flange a laser tracker followed; rows that are not fitted become held-out.toml.

    Example: ulna import ipa-ur10 Series_B/measurements_joint_configurations.csv -o ur10 --fit 300 --spread
    """
    from ulna.exchange.importers.ipa import import_ipa_ur10

    fitted, held_out = import_ipa_ur10(file, out, fit, every, spread, standings, parquet, orientations, force)
    _say(f"{out}: {fitted} readings to fit (study.toml), {held_out} held out{' (held-out.toml)' * bool(held_out)}.")
    _say(f"Next: ulna calibrate {out / 'study.toml'} -o {out / 'result'}")


@app.command("serial-robots", cls=Command)
@guard
def serial_robots(
    file: Annotated[Path, typer.Argument(help="The table to fit: targets, differences and joint angles.")],
    out: Out,
    robot: Annotated[str, typer.Option(metavar="ur5|wam", help="Which robot.")],
    held_out: Annotated[Path | None, typer.Option(help="Another table of it, to check the fit.")] = None,
    parquet: AsParquet = False,
    force: Force = False,
) -> None:
    """A UR5 or a Barrett WAM whose targets a laser tracker measured; another table becomes held-out.toml.

    Example: ulna import serial-robots 3D_UR5_uncalibrated_grid_cleaned.csv -o ur5 --robot ur5
    """
    from ulna.exchange.importers.serial_robots import import_serial_robots

    fitted, held = import_serial_robots(file, out, robot, held_out, parquet, force)
    _say(f"{out}: {fitted} readings to fit (study.toml), {held} held out{' (held-out.toml)' * bool(held)}.")
    _say(f"Next: ulna calibrate {out / 'study.toml'} -o {out / 'result'}")


@app.command("urdf", cls=Command)
@guard
def urdf(
    file: Annotated[Path, typer.Argument(help="The robot's drawing (URDF).")],
    out: Annotated[Path, typer.Option("--out", "-o", help="Arm file to write.")],
    tip_link: Annotated[
        str | None, typer.Option(help="The link whose origin is the ball; default: ball_link, or the last one.")
    ] = None,
    base_link: Annotated[
        str | None, typer.Option(help="The link that the arm stands on; default: the root of the drawing.")
    ] = None,
    length_unit: Annotated[
        str | None, typer.Option("--length-unit", help="mm, m or in, where the drawing is not in m.")
    ] = None,
    angle_unit: Annotated[
        str | None, typer.Option("--angle-unit", help="rad or deg: of the joints' limits, where they are not in rad.")
    ] = None,
    force: Force = False,
) -> None:
    """A robot's drawing as an arm file, to be named in a study of your own readings.

    Example: ulna import urdf iiwa14.urdf -o arm.toml --tip-link tool0
    """
    from ulna.exchange.importers.urdf import import_urdf

    _check_units(length_unit, angle_unit)
    found = import_urdf(file, out, tip_link, base_link, force, length_unit, angle_unit)
    _say(f"{out}: '{found.arm.name}', {found.arm.n} joints, probe 'ball' at link '{found.chain.tip_link}'.")
    _say(found.remark)
    for remark in found.chain.remarks:
        _say(remark)


@app.command("dh", cls=Command)
@guard
def dh(
    file: Annotated[
        Path, typer.Argument(help="The table (CSV): a row for each joint; columns theta0 or offset, alpha, a, d.")
    ],
    out: Annotated[Path, typer.Option("--out", "-o", help="Arm file to write.")],
    convention: Annotated[
        str, typer.Option("--convention", help="dh (alpha and a after the joint) or modified-dh (before it; Craig).")
    ],
    length_unit: Annotated[
        str | None, typer.Option("--length-unit", help="mm, m or in, where the columns' names do not say.")
    ] = None,
    angle_unit: Annotated[
        str | None, typer.Option("--angle-unit", help="rad or deg, where the columns' names do not say.")
    ] = None,
    tip: Annotated[
        tuple[float, float, float] | None,
        typer.Option("--tip", metavar="X Y Z", help="The probe's tip in the last row's frame; default: its origin."),
    ] = None,
    force: Force = False,
) -> None:
    """A table of Denavit–Hartenberg parameters as an arm file, to be named in a study of your own readings.

    turn = sign * encoder - theta0, so a column offset (turn = sign * encoder + offset) is -theta0. Units and convention
    are never guessed.

    Example: ulna import dh maker.csv -o arm.toml --convention modified-dh --length-unit mm --angle-unit deg
    """
    from ulna.exchange.importers.dh import import_dh

    one_of("--convention", convention, ("dh", "modified-dh"))
    _check_units(length_unit, angle_unit)
    chosen: Any = convention
    found = import_dh(file, out, chosen, length_unit, angle_unit, tip, force)
    probes = ", ".join(f"'{name}'" for name in found.arm.probes)
    _say(f"{out}: '{found.arm.name}', {found.arm.n} joints, probe{'s' * (len(found.arm.probes) > 1)} {probes}.")
    _say(found.taken)
    for remark in found.remarks:
        _say(remark)


def _check_units(length_unit: str | None, angle_unit: str | None) -> None:
    for option, unit, known in (
        ("--length-unit", length_unit, ("mm", "m", "in")),
        ("--angle-unit", angle_unit, ("rad", "deg")),
    ):
        if unit is not None:
            one_of(option, unit, known)


def _say(line: str) -> None:
    from ulna.ground.errors import for_people

    print(for_people(line), file=sys.stderr)
