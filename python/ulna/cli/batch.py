"""`ulna batch`: calibrate every study in a folder."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.options import Dask, Force, Json
from ulna.cli.running import guard


@guard
def batch(
    folder: Annotated[
        Path, typer.Argument(metavar="FOLDER", help="Folder with studies in it, at any depth.", show_default=False)
    ],
    out: Annotated[
        Path, typer.Option("-o", "--out", metavar="DIR", help="Folder for the results, one for each study.")
    ],
    only: Annotated[
        str, typer.Option("--only", metavar="PATTERN", help="Which studies, by names such as press/*/study.")
    ] = "*",
    dask: Dask = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Calibrate every study in a folder, several at once.

    A study that cannot be calibrated stops no other and is listed with its message. Results that are there already,
    made from the same files in the same way, are kept: what was interrupted goes on where it stopped. Exit code 1
    where a study was refused or its fit did not converge.

    Example: [bold]ulna batch arms -o out/arms[/bold]
    """
    from ulna.calibration.batch import batch as run_batch
    from ulna.cli import output
    from ulna.cli.printed.batch import batch_report
    from ulna.work.pieces import workers_at

    with workers_at(dask) as workers, output.progress_bar() as progress:
        found = run_batch(folder, out, only=only, workers=workers, force=force, progress=progress)
    if as_json:
        output.print_json(found.as_dict())
    else:
        output.print_renderable(*batch_report(found))
    output.say(f"Written: {out / 'batch.json'}, and a folder for each result.")
    if not found.converged:
        raise typer.Exit(1)
