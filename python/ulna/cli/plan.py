"""`ulna plan`: where to put the artefact and which poses to take, and what became of it."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.options import Dask, Force, Json, Keep, OutFolder, one_of
from ulna.cli.running import guard


@guard
def plan(
    files: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="ARM SPEC",
            help="The nominal arm and the plan file (TOML). With --check: the folder of a plan.",
            show_default=False,
        ),
    ] = None,
    check: Annotated[
        Path | None,
        typer.Option("--check", metavar="STUDY", help="What was measured, beside the plan whose folder is named."),
    ] = None,
    make_plan: Annotated[
        Path | None,
        typer.Option("--make-plan", metavar="SPEC", help="Write a plan file for ARM, filled in as far as it says."),
    ] = None,
    study: Annotated[
        Path | None,
        typer.Option("--study", metavar="STUDY", help="With --make-plan: its artefact, noise and hold are taken."),
    ] = None,
    anywhere: Annotated[
        bool, typer.Option("--anywhere", help="Wherever the arm reaches: below the table and overhead too.")
    ] = False,
    language: Annotated[
        str, typer.Option("--language", metavar="CODE", help="Of the work sheet: en, de or zh.")
    ] = "en",
    fonts: Annotated[
        Path | None,
        typer.Option("--fonts", metavar="FOLDER", help="Fonts for the work sheet, looked at before the machine's."),
    ] = None,
    dask: Dask = None,
    keep: Keep = None,
    out: OutFolder = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Choose where to put the artefact and which poses to take, before anything is measured.

    Prints what is expected of the calibrated arm beside random choice and beside 101 random measurements, what a
    simulation of it gains, and the observability indices O1 to O5. The artefact stands where a person can put it, on
    or above the table of the base. With -o it writes a work sheet to print (PDF), plan.csv (the list to follow),
    plan.json, an arm and a study that wait for the readings, and pictures. Readings taken already are completed where
    the file names their study.

    With --check it says which planned placements are missing, which touches are far from the plan, and what the
    readings tell of the parameters beside what the plan promised. Exit code 1 where placements are missing.

    Example: [bold]ulna plan arm.toml plan.toml -o planned[/bold]

    Example: [bold]ulna plan planned --check planned/study.toml[/bold]
    """
    from ulna.documents.languages.languages import LANGUAGES
    from ulna.ground.errors import UlnaInputError

    one_of("--language", language, tuple(LANGUAGES))
    given = files or []
    if check is not None and make_plan is not None:
        raise UlnaInputError("options --check and --make-plan: got both; expected one of them. Remove one.")
    if study is not None and make_plan is None:
        raise UlnaInputError("option --study: there is no plan file to fill in; expected --make-plan as well. Add it.")
    if check is not None:
        _check(_one(given, "--check", "the folder of a plan"), check, as_json)
    elif make_plan is not None:
        _make(_one(given, "--make-plan", "the arm"), make_plan, study, force)
    elif len(given) != 2:
        raise UlnaInputError(
            f"ulna plan: got {len(given)} files; expected ARM SPEC. Name them, or make a plan file with --make-plan."
        )
    else:
        _plan(given[0], given[1], anywhere, (language, fonts), (dask, keep), out, force, as_json)


def _plan(
    arm: Path,
    spec: Path,
    anywhere: bool,
    paper: tuple[str, Path | None],
    work: tuple[str | None, Path | None],
    out: Path | None,
    force: bool,
    as_json: bool,
) -> None:
    from dataclasses import replace

    from ulna.arm.arm import Arm
    from ulna.cli import output
    from ulna.cli.printed.plan import plan_report
    from ulna.formats.output import check_output, refuse_inputs
    from ulna.ground.extras import need
    from ulna.planning.file import load_plan_spec
    from ulna.planning.folder import NEEDS_PICTURES, WORK_SHEET, files_of
    from ulna.planning.plan import plan as run_plan
    from ulna.work.pieces import workers_at

    nominal = Arm.load(arm)
    asked = load_plan_spec(spec, nominal)
    if anywhere:
        asked = replace(asked, within=None)
    names = [*files_of(asked.artefact), WORK_SHEET]
    if out is not None:  # before the long work
        need(NEEDS_PICTURES, "matplotlib", "typst", "fontTools")
        from ulna.documents.work_sheet.sheet import check_paper

        check_output(out, names, force)
        refuse_inputs((out / name for name in names), [arm, *asked.files])
        check_paper(nominal, asked, *paper)
    dask, keep = work
    with workers_at(dask) as workers, output.progress_bar() as progress:
        found = run_plan(nominal, asked, progress, workers=workers, keep=keep)
    if out is not None:
        from ulna.documents.work_sheet.sheet import work_sheet

        found.save(out, force, {WORK_SHEET: work_sheet(found, *paper)})
    if as_json:
        output.print_json(found.as_dict())
    else:
        output.print_renderable(*plan_report(found))
    if out is not None:
        output.say(f"Written to {out}: {', '.join(names)}")
    elif not as_json:
        output.say("Nothing was written: give -o DIR to keep the plan.")


def _one(files: list[Path], option: str, what: str) -> Path:
    from ulna.ground.errors import UlnaInputError

    if len(files) != 1:
        raise UlnaInputError(f"option {option}: got {len(files)} files; expected {what}. Name it alone.")
    return files[0]


def _check(planned: Path, study: Path, as_json: bool) -> None:
    from ulna.cli import output
    from ulna.cli.printed.plan_check import check_report
    from ulna.planning.checking import check_study
    from ulna.planning.planned import load_planned
    from ulna.study.study import Study

    found = check_study(load_planned(planned), Study.load(study, "all"))
    if as_json:
        output.print_json(found.as_dict())
    else:
        output.print_renderable(*check_report(found))
    if found.missing:
        raise typer.Exit(1)


def _make(arm: Path, spec: Path, study: Path | None, force: bool) -> None:
    from ulna.arm.arm import Arm
    from ulna.cli import output
    from ulna.formats.output import refuse_inputs, write_file
    from ulna.planning.making import plan_toml
    from ulna.study.study import Study

    readings = None if study is None else Study.load(study)
    text = plan_toml(Arm.load(arm), readings, spec.parent)
    refuse_inputs([spec], [arm, *([] if readings is None else [each.path for each in readings.files])])
    write_file(spec, text, force)
    output.say(f"Written: {spec}")
    output.say(f"Next: look at what stands behind '#' there, then ulna plan {arm} {spec} -o planned")
