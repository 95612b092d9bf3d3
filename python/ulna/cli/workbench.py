"""`ulna workbench`: the page."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.running import guard

USUAL = Path("ulna-bench")


@guard
def workbench(
    bench: Annotated[
        Path | None,
        typer.Argument(
            metavar="BENCH",
            help="Bench folder with the record, files and sessions; made where it is not there. Default: the record's "
            "(ULNA_RECORDS or the settings file), else ulna-bench here.",
            show_default=False,
        ),
    ] = None,
    port: Annotated[
        int | None,
        typer.Option("--port", metavar="N", min=0, max=65535, help="Default: 8765, or another where that is taken."),
    ] = None,
    by: Annotated[
        str | None, typer.Option("--by", metavar="NAME", help="Who works; default: as for ulna record.")
    ] = None,
    open_it: Annotated[bool, typer.Option("--open/--no-open", help="Open it in the browser.")] = True,
) -> None:
    """Open the workbench in your browser: from an arm in the hand to a calibrated one, and what became of it.

    It serves this machine alone, at an address with a token that only this browser gets. Everything that it does, a
    command does too; all is kept in BENCH, which can be moved whole. Ctrl-C ends it: a session goes on later.

    Example: [bold]ulna workbench my-bench[/bold]
    """
    import webbrowser

    from ulna.cli import output
    from ulna.ground.extras import need
    from ulna.serve import page
    from ulna.serve.serving import serve

    need("ulna workbench", "fastapi", "uvicorn", "sqlalchemy", "alembic")
    folder = bench or _usual()
    if not page.there():
        output.say("This Ulna was built without its page: make page, with Node 20.19 or newer. The API is there.")

    def ready(address: str) -> None:
        output.say(f"{folder}: open {address} (Ctrl-C ends it)")
        if open_it and page.there():
            webbrowser.open(address)

    serve(folder, port, by, ready)
    output.say(f"{folder}: ended. A session that was going on goes on from here: ulna workbench {folder}")


def _usual() -> Path:
    from ulna.ground.errors import UlnaInputError
    from ulna.records.place import found

    try:
        return found(None)
    except UlnaInputError:
        return USUAL
