"""`ulna new`: an arm file and a study from a table that somebody keeps."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.options import Force
from ulna.cli.running import guard

_TOUCHED, _ARM, _FILE = "What was touched", "The arm", "How the file is written, where it is not seen"


@guard
def new(
    readings: Annotated[
        list[Path] | None,
        typer.Option(metavar="FILE", help="CSV, Excel, Parquet, MAT or HDF5; again for another artefact."),
    ] = None,
    out: Annotated[Path, typer.Option("-o", "--out", metavar="DIR", help="Folder to write to.")] = Path("study"),
    artefact: Annotated[
        list[str] | None,
        typer.Option(
            metavar="KIND",
            help="bar, seat, points, sphere, plane, …; with its size: bar:443.172, points:plate.csv. Repeat it.",
            rich_help_panel=_TOUCHED,
        ),
    ] = None,
    length: Annotated[float | None, typer.Option(metavar="MM", help="Of the bar.", rich_help_panel=_TOUCHED)] = None,
    diameter: Annotated[
        float | None, typer.Option(metavar="MM", help="Of the sphere or cylinder.", rich_help_panel=_TOUCHED)
    ] = None,
    features: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Of points (a plate): table of feature, x, y, z.", rich_help_panel=_TOUCHED),
    ] = None,
    u: Annotated[
        float | None,
        typer.Option("--u", metavar="MM", help="Standard uncertainty, as certified.", rich_help_panel=_TOUCHED),
    ] = None,
    one_standing: Annotated[
        bool, typer.Option("--one-standing", help="The artefact was never moved.", rich_help_panel=_TOUCHED)
    ] = False,
    reach: Annotated[
        float | None,
        typer.Option(metavar="MM", help="From base to tip, where there is no drawing.", rich_help_panel=_ARM),
    ] = None,
    parallel: Annotated[
        list[str] | None,
        typer.Option(
            metavar="N", help="With --reach: an axis parallel to the next; repeat it, or none.", rich_help_panel=_ARM
        ),
    ] = None,
    dh: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Table of DH parameters, as import dh reads it.", rich_help_panel=_ARM),
    ] = None,
    urdf: Annotated[Path | None, typer.Option(metavar="FILE", help="Drawing (URDF).", rich_help_panel=_ARM)] = None,
    arm: Annotated[
        Path | None, typer.Option(metavar="FILE", help="An arm.toml, or a result.json.", rich_help_panel=_ARM)
    ] = None,
    zeros: Annotated[
        str | None,
        typer.Option(metavar="WORD", help="known: as drawn; unknown: searched for.", rich_help_panel=_ARM),
    ] = None,
    signs: Annotated[
        str | None, typer.Option(metavar="WORD", help="known or unknown: which way they count.", rich_help_panel=_ARM)
    ] = None,
    counts_per_turn: Annotated[
        list[float] | None,
        typer.Option(metavar="N", help="Of the encoders: once, or for each axis.", rich_help_panel=_ARM),
    ] = None,
    ball: Annotated[
        float | None, typer.Option(metavar="MM", help="Diameter of the probe's ball.", rich_help_panel=_ARM)
    ] = None,
    convention: Annotated[
        str | None, typer.Option(metavar="WORD", help="Of --dh: dh or modified-dh.", rich_help_panel=_ARM)
    ] = None,
    length_unit: Annotated[
        str | None,
        typer.Option(metavar="UNIT", help="mm, m or in: of tables that do not say it.", rich_help_panel=_ARM),
    ] = None,
    angle_unit: Annotated[
        str | None, typer.Option(metavar="UNIT", help="rad or deg: the same of --dh.", rich_help_panel=_ARM)
    ] = None,
    tip: Annotated[
        tuple[float, float, float] | None,
        typer.Option(metavar="X Y Z", help="The tip in the last row's frame of --dh.", rich_help_panel=_ARM),
    ] = None,
    tip_link: Annotated[
        str | None, typer.Option(metavar="LINK", help="Of --urdf: its origin is the ball.", rich_help_panel=_ARM)
    ] = None,
    base_link: Annotated[
        str | None, typer.Option(metavar="LINK", help="Of --urdf: the arm stands on it.", rich_help_panel=_ARM)
    ] = None,
    angle: Annotated[
        str | None, typer.Option(metavar="UNIT", help="rad, deg or counts, of the readings.", rich_help_panel=_FILE)
    ] = None,
    column: Annotated[
        list[str] | None,
        typer.Option(metavar="OURS=THEIRS", help="q1='Achse 1': what a column is.", rich_help_panel=_FILE),
    ] = None,
    name: Annotated[
        list[str] | None,
        typer.Option(metavar="COLUMN.OURS=LABEL", help="'feature.A=links': what a label is.", rich_help_panel=_FILE),
    ] = None,
    skip_bad: Annotated[
        bool, typer.Option("--skip-bad", help="Leave out rows without a number.", rich_help_panel=_FILE)
    ] = False,
    sheet: Annotated[str | None, typer.Option(help="Of a workbook.", rich_help_panel=_FILE)] = None,
    dataset: Annotated[str | None, typer.Option(help="HDF5: group; MAT: struct.", rich_help_panel=_FILE)] = None,
    separator: Annotated[str | None, typer.Option(help="Between columns.", rich_help_panel=_FILE)] = None,
    decimal: Annotated[str | None, typer.Option(help="'.' or ','.", rich_help_panel=_FILE)] = None,
    thousands: Annotated[str | None, typer.Option(help="Between thousands.", rich_help_panel=_FILE)] = None,
    encoding: Annotated[str | None, typer.Option(help="cp1252, gbk, …", rich_help_panel=_FILE)] = None,
    comment: Annotated[
        str | None, typer.Option(help="Sign before rows that are no readings.", rich_help_panel=_FILE)
    ] = None,
    header: Annotated[
        int | None, typer.Option(min=1, metavar="LINE", help="Line with the columns' names.", rich_help_panel=_FILE)
    ] = None,
    units_row: Annotated[
        bool | None,
        typer.Option("--units-row/--no-units-row", help="Whether a row of units is below it.", rich_help_panel=_FILE),
    ] = None,
    force: Force = False,
) -> None:
    """Write an arm file and a study from a table of readings as you keep it.

    Columns are recognised by their headings (English, German, Chinese and others) and by what stands in them, and every
    one is shown with what it is taken for and why. What the file does not say is asked for: on a terminal one by one,
    elsewhere in one message that names the options. Zeros and signs of encoders that nobody knows are searched for, and
    an arm without a drawing is found from its reach. The readings stay where they are; nothing is overwritten.

    Several artefacts make one study: say --readings and --artefact for each, in the same order, with the size behind
    the kind and a standard uncertainty behind that, all in mm (bar:443.172:0.001). One file that names the artefact of
    each row is enough: --artefact 'Stab=bar:443.172' --artefact 'Kugel=sphere:25.4'.

    Example: [bold]ulna new --readings Messung.xlsx --artefact bar --length 443.172 --reach 1200 --parallel none[/bold]
    """
    from ulna.calibration.identify import identify
    from ulna.cli import output
    from ulna.cli.asking import proposed
    from ulna.cli.printed.identification import identification_report
    from ulna.cli.printed.proposal import proposal_report
    from ulna.formats.output import check_output
    from ulna.proposals.answers import Answers
    from ulna.proposals.several import touched
    from ulna.proposals.write import FILES, write_proposal
    from ulna.study.study import Study

    check_output(out, FILES, force)
    answers = Answers(
        length=length,
        diameter=diameter,
        features=features,
        u=u,
        angle=angle,
        counts_per_turn=tuple(counts_per_turn or ()),
        one_standing=one_standing,
        skip_bad=skip_bad,
        reach=reach,
        parallel=tuple(parallel or ()),
        dh=dh,
        convention=convention,
        length_unit=length_unit,
        angle_unit=angle_unit,
        tip=tip,
        urdf=urdf,
        tip_link=tip_link,
        base_link=base_link,
        arm=arm,
        ball=ball,
        zeros=zeros,
        signs=signs,
        columns=tuple(column or ()),
        names=tuple(name or ()),
        sheet=sheet,
        dataset=dataset,
        separator=separator,
        decimal=decimal,
        thousands=thousands,
        encoding=encoding,
        comment=comment,
        header=True if header is None else header,
        units_row=units_row,
    )
    proposal = proposed(answers, readings or [], [touched(each) for each in artefact or []])
    write_proposal(proposal, out, force)
    output.print_renderable(*proposal_report(proposal))
    study = Study.load(out / "study.toml")
    output.print_renderable(*identification_report(identify(study), study.arm))
    output.say(f"Written: {', '.join(str(out / each) for each in FILES)}")
    output.say(f"Next: ulna calibrate {out / 'study.toml'} -o {out / 'result'}")
