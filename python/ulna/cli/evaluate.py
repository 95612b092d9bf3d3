"""`ulna evaluate`: apply an arm, unchanged, to readings."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from ulna.cli.options import ArmFile, Force, Json, OutFolder, StudyArgument
from ulna.cli.recorded import Record, record, recording
from ulna.cli.running import guard


@guard
def evaluate(
    arm: ArmFile,
    study: StudyArgument,
    rows: Annotated[
        str | None,
        typer.Option(
            "--rows",
            metavar="fit|check|all",
            help="Of a study with a split; default: check. Else all.",
            show_default=False,
        ),
    ] = None,
    out: OutFolder = None,
    force: Force = False,
    as_json: Json = False,
    to_record: Record = None,
) -> None:
    """Judge an arm, unchanged, on a study's readings: seat scatter, length error, coordinate error, form.

    The figures come from the readings alone; where artefacts stand is fitted, the arm is not. The study's own arm only
    tells its probes' names. Where the study keeps rows to check a fit (key split), those are judged. With -o it writes
    evaluation.json and residuals.csv.

    Example: [bold]ulna evaluate out/result.json fresh.toml[/bold]
    """
    from ulna.arm.arm import Arm
    from ulna.calibration.evaluate import FILES
    from ulna.calibration.evaluate import evaluate as run_evaluate
    from ulna.cli import output
    from ulna.cli.printed.evaluation import evaluation_report, were_fitted
    from ulna.formats.output import check_output, refuse_inputs
    from ulna.study.file import rows_to_judge
    from ulna.study.study import Study

    if out is not None:
        check_output(out, FILES, force)
    kept = recording(to_record, out)
    Arm.load(arm)  # what is wrong with it is said before the study is read
    wanted: Any = rows or rows_to_judge(study)
    loaded = Study.load(study, wanted)
    if out is not None:
        refuse_inputs((out / name for name in FILES), [arm, *(file.path for file in loaded.files)])
    with output.progress_bar() as progress:
        evaluation = run_evaluate(arm, loaded, progress)
    if out is not None:
        evaluation.save(out, force)
    if as_json:
        output.print_json(evaluation.as_dict())
    else:
        output.print_renderable(*evaluation_report(evaluation, were_fitted(arm, evaluation)))
    if out is not None:
        output.say(f"Written: {', '.join(str(out / name) for name in FILES)}")
        if kept is not None:
            from ulna.records.outcomes import inputs_of, lent_by_record

            record(kept, out / "evaluation.json", inputs_of(loaded), lent_by_record(loaded))
