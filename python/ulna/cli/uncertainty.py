"""`ulna uncertainty`: how sure a measurement is."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.options import Dask, Force, Json, OutFolder
from ulna.cli.running import guard

FILE = "uncertainty.json"


@guard
def uncertainty(
    result: Annotated[
        Path, typer.Argument(metavar="RESULT", help="The result.json of a calibration.", show_default=False)
    ],
    task: Annotated[
        Path, typer.Argument(metavar="TASK", help="What is measured, and in which poses (TOML).", show_default=False)
    ],
    study: Annotated[
        Path | None,
        typer.Option("--study", metavar="STUDY", help="Of that calibration: repeat it whole on new noise, many times."),
    ] = None,
    trials: Annotated[
        int, typer.Option("--trials", metavar="N", help="At the most, of Monte Carlo; 0: none.")
    ] = 1_000_000,
    seed: Annotated[int, typer.Option("--seed", metavar="N", help="Of the random numbers.")] = 0,
    dask: Dask = None,
    out: OutFolder = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Say how sure a measured point, length, ball or distance is, why, and what is not in the figure.

    First order after the GUM, and a Monte Carlo calculation after JCGM 101 that goes on until its figures are steady,
    and says whether the first order is good enough. With -o it writes uncertainty.json. Exit code 1 where a value is
    not determined.

    Example: [bold]ulna uncertainty out/result.json length.toml[/bold]
    """
    import json

    import ulna
    from ulna.cli import output
    from ulna.errors import UlnaInputError
    from ulna.files.output import check_output, output_folder, refuse_inputs
    from ulna.report.uncertainty import uncertainty_report
    from ulna.work.pieces import workers_at

    if trials < 0 or seed < 0:
        raise UlnaInputError("options --trials and --seed: expected numbers of 0 or more. Correct them.")
    if out is not None:
        check_output(out, (FILE,), force)
        refuse_inputs([out / FILE], [result, task])
    repeated = None if study is None else ulna.Study.load(study)
    with workers_at(dask) as workers, output.progress_bar() as progress:
        found = ulna.uncertainty(
            result, task, study=repeated, seed=seed, most_trials=trials, workers=workers, progress=progress
        )
    if out is not None:
        with output_folder(out, (FILE,), force) as staging:
            text = json.dumps(found.as_dict(), indent=1, ensure_ascii=False, allow_nan=False)
            (staging / FILE).write_text(text + "\n", encoding="utf-8")
    if as_json:
        output.print_json(found.as_dict())
    else:
        output.print_renderable(*uncertainty_report(found))
    if out is not None:
        output.say(f"Written: {out / FILE}")
    if any(value.not_determined for value in found.values):
        output.say("Not everything is determined: see the list above.")
        raise typer.Exit(1)
