"""The command `ulna`: one file per command, each importing what it needs only when it runs."""

from __future__ import annotations

from typing import Annotated

import typer

from ulna.cli.commands import Commands
from ulna.cli.completing import get_ready
from ulna.cli.interrupting import ENDING, leave_interrupted, say_interrupted
from ulna.cli.streams import open_streams

app = typer.Typer(
    name="ulna",
    cls=Commands,
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
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

    Exit code: 0 done and good; 1 done, and the answer is no (did not converge); 2 bad input or usage; 3 a fault of
    Ulna's; 130 interrupted; 143 told to end.

    Example: [bold]ulna calibrate study.toml -o out[/bold]
    """


def main() -> None:
    """The console script."""
    open_streams()
    get_ready()
    try:
        app(prog_name="ulna")
    except KeyboardInterrupt:
        say_interrupted()
        leave_interrupted()
    except SystemExit as end:
        if end.code in ENDING.values():
            leave_interrupted()
        raise
