"""`ulna calibrate`: fit the arm to the readings."""

from __future__ import annotations

import typer

from ulna.cli.options import All, Force, Json, Judge, OutFolder, StudyArgument
from ulna.cli.recorded import Record, record, recording
from ulna.cli.running import guard


@guard
def calibrate(
    study: StudyArgument,
    out: OutFolder = None,
    force: Force = False,
    as_json: Json = False,
    everything: All = False,
    judge: Judge = False,
    to_record: Record = None,
) -> None:
    """Fit an arm to readings: from encoder readings to a calibrated arm.

    Prints the figures before and after, the parameters with their standard uncertainties, what the readings could
    not determine, whether blocks beyond geometry earned their place, and readings far off, on one screen; with --all
    every figure and parameter, why something was not determined, and what would help. Of a fit that ended badly: the
    rows that are met worst, and what to try. With -o it writes result.json, arm.toml (the calibrated arm, ready to
    use) and residuals.csv (residuals.parquet of more than 20 000 readings). With --judge it says whether residuals
    still follow the turn of a joint, so that a block is missing. Exit code 1 where the fit did not converge.

    Example: [bold]ulna calibrate study.toml -o out[/bold]
    """
    from ulna.calibration.calibrate import calibrate as run_calibration
    from ulna.calibration.result import FILES
    from ulna.calibration.suspects import suspicion
    from ulna.cli import output
    from ulna.cli.printed.brief import brief_report
    from ulna.cli.printed.calibration import calibration_report
    from ulna.cli.printed.hints import where_to_look
    from ulna.formats.output import check_output, refuse_inputs
    from ulna.ground.extras import need
    from ulna.study.study import Study

    if out is not None:
        check_output(out, FILES, force)  # before the long work
    kept = recording(to_record, out)
    loaded = Study.load(study)
    if judge:
        need("option --judge", "sklearn")
    if out is not None:
        refuse_inputs((out / name for name in FILES), (file.path for file in loaded.files))
    with output.progress_bar() as progress:
        result = run_calibration(loaded, progress, **({"judge": True} if judge else {}))
    if out is not None:
        result.save(out, force)
    suspected = None if result.fit.converged else suspicion(loaded, result)
    if as_json:
        result.write_json(output.write_json)
    elif everything:
        output.print_renderable(*calibration_report(result))
    else:
        output.print_renderable(*brief_report(result, output.columns(), suspected))
    if out is not None:
        output.say(f"Written: {', '.join(str(out / name) for name in FILES if (out / name).exists())}")
        if kept is not None:
            from ulna.records.outcomes import inputs_of, lent_by_record

            record(kept, out / "result.json", inputs_of(loaded), lent_by_record(loaded))
    elif not as_json:
        output.say("Nothing was written: give -o DIR to keep the result.")
    if not result.fit.converged:
        output.say(f"The fit did not converge ({result.fit.termination}): do not use these numbers.")
        if everything or as_json:
            hint = where_to_look(result, suspected)
            if hint:
                output.say(hint)
        raise typer.Exit(1)
