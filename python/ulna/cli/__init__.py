"""The command `ulna`: one file per command, each importing what it needs only when it runs."""

from __future__ import annotations

from typing import Annotated

import typer

from ulna.cli.batch import batch
from ulna.cli.calibrate import calibrate
from ulna.cli.certificate import certificate
from ulna.cli.cross_validate import cross_validate
from ulna.cli.evaluate import evaluate
from ulna.cli.exporting import app as exporting
from ulna.cli.identify import identify
from ulna.cli.importing import app as importing
from ulna.cli.interrupting import INTERRUPTED, leave_interrupted, say_interrupted
from ulna.cli.measure import measure
from ulna.cli.plan import plan
from ulna.cli.report import report
from ulna.cli.reproduce import reproduce
from ulna.cli.simulate import simulate
from ulna.cli.uncertainty import uncertainty
from ulna.cli.verify import verify

app = typer.Typer(
    name="ulna",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def _version(asked: bool) -> None:
    if asked:
        from ulna.ground.version import VERSION

        print(f"ulna {VERSION}")
        raise typer.Exit


@app.callback()
def ulna(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Calibration of articulated measuring arms: from encoder readings to a calibrated arm.

    Exit code: 0 done and good; 1 done, and the answer is no (did not converge); 2 bad input or usage; 130 interrupted.

    Example: [bold]ulna calibrate study.toml -o out[/bold]
    """


app.command("calibrate")(calibrate)
app.command("identify")(identify)
app.command("evaluate")(evaluate)
app.command("measure")(measure)
app.command("uncertainty")(uncertainty)
app.command("cross-validate")(cross_validate)
app.command("certificate")(certificate)
app.command("batch")(batch)
app.command("simulate")(simulate)
app.command("plan")(plan)
app.command("report")(report)
app.command("verify")(verify)
app.command("reproduce")(reproduce)
app.add_typer(importing, name="import")
app.add_typer(exporting, name="export")


def main() -> None:
    """The console script."""
    try:
        app(prog_name="ulna")
    except KeyboardInterrupt:
        say_interrupted()
        leave_interrupted()
    except SystemExit as end:
        if end.code == INTERRUPTED:
            leave_interrupted()
        raise
