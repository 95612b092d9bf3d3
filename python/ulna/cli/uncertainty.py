"""`ulna uncertainty`: how sure a measurement is."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ulna.cli.options import Dask, Force, Json, Keep, OutFolder
from ulna.cli.running import guard

if TYPE_CHECKING:
    from ulna.study.study import Study

FILE = "uncertainty.json"


@guard
def uncertainty(
    result: Annotated[
        Path,
        typer.Argument(
            metavar="RESULT",
            help="The result.json of a calibration; an arm.toml with --performance.",
            show_default=False,
        ),
    ],
    task: Annotated[
        Path, typer.Argument(metavar="TASK", help="What is measured, and in which poses (TOML).", show_default=False)
    ],
    study: Annotated[
        Path | None,
        typer.Option("--study", metavar="STUDY", help="Of that calibration: repeat it whole on new noise, many times."),
    ] = None,
    performance: Annotated[
        Path | None,
        typer.Option("--performance", metavar="FILE", help="What a certificate says, where no calibration is at hand."),
    ] = None,
    trials: Annotated[
        int, typer.Option("--trials", metavar="N", help="At the most, of Monte Carlo; 0: none.")
    ] = 1_000_000,
    seed: Annotated[int, typer.Option("--seed", metavar="N", help="Of the random numbers.")] = 0,
    dask: Dask = None,
    keep: Keep = None,
    out: OutFolder = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Say how sure a measured point, length, ball, plane or form is, why, and what is not in the figure.

    First order after the GUM, and a Monte Carlo calculation after JCGM 101 that goes on until its figures are steady,
    and says whether the first order is good enough. With -o it writes uncertainty.json. Where TASK is a volume file
    (ulna-volume/1), a map of points and lengths all over the volume instead: tables, and with -o a picture. Exit code 1
    where a value is not determined.

    With --performance the arm's calibration need not be at hand: arms are drawn, and kept where their simulated
    performance test agrees with the certificate.

    Example: [bold]ulna uncertainty out/result.json length.toml[/bold]
    """
    from ulna.cli import output
    from ulna.formats.output import check_output, refuse_inputs
    from ulna.ground.errors import UlnaInputError
    from ulna.study.study import Study
    from ulna.uncertainties.kept import FILES as MAP_FILES
    from ulna.uncertainties.kept import check_pictures, save_volume
    from ulna.uncertainties.uncertainty import volume_uncertainty
    from ulna.uncertainties.volume_file import is_volume

    if trials < 0 or seed < 0:
        raise UlnaInputError("options --trials and --seed: expected numbers of 0 or more. Correct them.")
    everywhere = is_volume(task)
    names = MAP_FILES if everywhere else [FILE]
    if out is not None:
        if everywhere:
            check_pictures()  # before the long work
        check_output(out, names, force)
        refuse_inputs([out / name for name in names], [result, task, *([] if performance is None else [performance])])
    if not everywhere:
        repeated = None if study is None else Study.load(study)
        _measured(result, task, repeated, performance, trials, seed, dask, keep, out, force, as_json)
        return
    if study is not None or keep is not None:
        raise UlnaInputError(
            f"{task}: a map over the volume is of the first order and quick; expected it without --study and --keep. "
            "Leave them out."
        )
    from ulna.cli.printed.volume import volume_report
    from ulna.uncertainties.zones import as_dict
    from ulna.work.pieces import workers_at

    with workers_at(dask) as workers, output.progress_bar() as progress:
        found = volume_uncertainty(result, task, performance=performance, seed=seed, workers=workers, progress=progress)
    if out is not None:
        save_volume(found, out, force)
    if as_json:
        output.print_json(as_dict(found))
    else:
        output.print_renderable(*volume_report(found))
    if out is not None:
        output.say(f"Written to {out}: {', '.join(MAP_FILES)}")
    if not found.whole:
        output.say("Not everything is determined: see the list above.")
        raise typer.Exit(1)


def _measured(
    result: Path,
    task: Path,
    repeated: Study | None,
    performance: Path | None,
    trials: int,
    seed: int,
    dask: str | None,
    keep: Path | None,
    out: Path | None,
    force: bool,
    as_json: bool,
) -> None:
    """One measurement."""
    import json

    from ulna.cli import output
    from ulna.cli.printed.uncertainty import uncertainty_report
    from ulna.formats.output import output_folder
    from ulna.uncertainties.uncertainty import uncertainty as run_uncertainty
    from ulna.work.pieces import workers_at

    with workers_at(dask) as workers, output.progress_bar() as progress:
        found = run_uncertainty(
            result,
            task,
            study=repeated,
            performance=performance,
            seed=seed,
            most_trials=trials,
            workers=workers,
            keep=keep,
            progress=progress,
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
