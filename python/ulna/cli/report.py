"""`ulna report`: the report of a calibration."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.completing import languages
from ulna.cli.options import Force, Json, one_of
from ulna.cli.recorded import Record, record, recording
from ulna.cli.running import guard


@guard
def report(
    result: Annotated[
        Path, typer.Argument(metavar="RESULT", help="The result.json of a calibration.", show_default=False)
    ],
    out: Annotated[
        Path,
        typer.Option(
            "-o",
            "--out",
            metavar="PATH",
            help="File to write, its form by its ending, or a folder for report.html, report.pdf.",
            show_default=False,
        ),
    ],
    as_html: Annotated[bool, typer.Option("--html", help="One HTML file; of a folder meant without another.")] = False,
    as_pdf: Annotated[
        bool, typer.Option("--pdf", help="A calibration certificate on paper (PDF); what --lab names is on it.")
    ] = False,
    study: Annotated[
        Path | None,
        typer.Option("--study", metavar="STUDY", help="Of that calibration, where it is not found by itself."),
    ] = None,
    cross_validation: Annotated[
        Path | None,
        typer.Option("--cross-validation", metavar="FILE", help="A cross-validation.json: readings held out."),
    ] = None,
    evaluation: Annotated[
        Path | None, typer.Option("--evaluation", metavar="FILE", help="An evaluation.json: readings held out.")
    ] = None,
    verification: Annotated[
        list[Path] | None,
        typer.Option("--verification", metavar="FILE", help="A verification.json: the test, MPE; may be repeated."),
    ] = None,
    earlier: Annotated[
        Path | None,
        typer.Option("--earlier", metavar="RESULT", help="A calibration of the same arm: what has moved since."),
    ] = None,
    laboratory: Annotated[
        Path | None,
        typer.Option("--lab", metavar="LAB", help="The laboratory file (TOML): see ulna certificate --make-lab."),
    ] = None,
    language: Annotated[
        str, typer.Option("--language", metavar="CODE", help="en, de or zh.", autocompletion=languages)
    ] = "en",
    fonts: Annotated[
        Path | None,
        typer.Option(
            "--fonts",
            metavar="FOLDER",
            help="Fonts for the PDF, such as Chinese ones, looked at before the machine's.",
        ),
    ] = None,
    force: Force = False,
    as_json: Json = False,
    to_record: Record = None,
) -> None:
    """Write the report of a calibration: what a metrologist wants to see before trusting it.

    Figures before and after, on fitted and held-out readings; distribution of the residuals; residuals over each joint
    angle, reach and temperature, reading by reading and in space; parameters with their uncertainties and correlations;
    observability; artefacts, environment, outliers, provenance. What the data do not give is said in words.

    With --json it prints which files were written and what is missing.

    Example: [bold]ulna report out/result.json -o report.html[/bold]
    """
    from ulna.cli import output
    from ulna.cli.endings import by_ending
    from ulna.documents.gather import gather
    from ulna.documents.languages.languages import LANGUAGES
    from ulna.documents.write import targets, write_report

    one_of("--language", language, tuple(LANGUAGES))
    asked = [name for name, given in (("html", as_html), ("pdf", as_pdf)) if given]
    formats = by_ending(out, {".html": "html", ".pdf": "pdf"}, asked, folder=True)
    wanted = targets(out, formats or ["html"], force)
    kept = recording(to_record, out)
    with output.progress_bar() as progress:
        content = gather(
            result, study, cross_validation, evaluation, laboratory, verification, progress, earlier=earlier
        )
    files = [result / "result.json" if result.is_dir() else result]
    files += [path for path in (study, cross_validation, evaluation, earlier, laboratory) if path is not None]
    files += verification or []
    write_report(content, wanted, language, files, force, fonts)
    if as_json:
        output.print_json(
            {
                "files": {each: str(path) for each, path in wanted.items()},
                "missing": {section: said.key for section, said in content.missing.items()},
            }
        )
    for said in content.missing.values():
        if said.key == "study.changed":
            output.say(f"The study has changed since the calibration ({said.values['files']}): not used.")
        elif said.key == "study.absent":
            output.say(f"The study {said.values['study']} was not found: give it with --study.")
    output.say(f"Written: {', '.join(str(path) for path in wanted.values())}")
    for path in wanted.values():
        record(kept, path)
