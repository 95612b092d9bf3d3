"""`ulna workbench`: the page."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.running import guard
from ulna.ground.errors import UlnaInputError

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
    laboratory: Annotated[
        Path | None,
        typer.Option(
            "--laboratory",
            metavar="FILE",
            help="Serve people who sign in, also on other machines, as this file says (ulna-workbench/1).",
        ),
    ] = None,
    check: Annotated[bool, typer.Option("--check", help="With --laboratory: look whether it could, and end.")] = False,
) -> None:
    """Open the workbench in your browser: from an arm in the hand to a calibrated one, and what became of it.

    It serves this machine alone, at an address with a token that only this browser gets. Everything that it does, a
    command does too; all is kept in BENCH, which can be moved whole. Ctrl-C ends it: a session goes on later.

    With --laboratory others reach it: over TLS or behind a proxy that speaks it, with a password or an OpenID provider,
    each in the roles that the record gives them (ulna record person, ulna record account).

    Example: [bold]ulna workbench my-bench[/bold]
    """
    import webbrowser

    from ulna.cli import output
    from ulna.cli.interrupting import asked_to_end
    from ulna.ground.extras import need

    need("ulna workbench", "fastapi", "uvicorn", "sqlalchemy", "alembic")
    from ulna.serve import page
    from ulna.serve.serving import serve

    folder = bench or _usual()
    if laboratory is not None:
        _laboratory(folder, laboratory, port, by, check)
        return
    if check:
        raise UlnaInputError("option --check: looks at a laboratory's file; expected --laboratory FILE. Give it.")

    def ready(address: str) -> None:
        if not page.there():
            output.say("This Ulna was built without its page: make page, with Node 20.19 or newer. The API is there.")
        output.say(f"{folder}: open {address} (Ctrl-C ends it)")
        if open_it and page.there():
            webbrowser.open(address)

    with asked_to_end():  # the server itself answers Ctrl-C
        serve(folder, port, by, ready)
    output.say(f"{folder}: ended. A session that was going on goes on from here: ulna workbench {folder}")


def _laboratory(folder: Path, file: Path, port: int | None, by: str | None, check: bool) -> None:
    import logging

    from ulna.cli import output
    from ulna.cli.interrupting import asked_to_end
    from ulna.ground.extras import need

    need("ulna workbench --laboratory", "argon2", "authlib", "httpx2")
    from ulna.serve import page
    from ulna.serve.laboratory.checking import remarks
    from ulna.serve.laboratory.settings_file import read_settings
    from ulna.serve.serving import laboratory_workshop, serve_laboratory

    if port is not None:
        raise UlnaInputError(f"option --port: {file.name} says where it listens ([listen] port). Leave it out.")
    settings = read_settings(file)
    if check:
        workshop = laboratory_workshop(folder, settings, by)
        try:
            for each in remarks(workshop, settings):
                output.say(each)
        finally:
            workshop.close()
        output.say(f"{file}: good. It would serve {folder} at {settings.origin}.")
        return
    logging.basicConfig(level=logging.WARNING, format="%(asctime)s %(message)s")
    logging.getLogger("ulna.workbench").setLevel(logging.INFO)

    def ready(address: str) -> None:
        if not page.there():
            output.say("This Ulna was built without its page: make page, with Node 20.19 or newer. The API is there.")
        stated = settings.file.listen
        output.say(f"{folder}: serves {address} at {stated.address}, port {stated.port} (Ctrl-C ends it)")

    with asked_to_end():
        serve_laboratory(folder, settings, by, ready)
    output.say(f"{folder}: ended. A session that was going on goes on from here.")


def _usual() -> Path:
    from ulna.records.place import found

    try:
        return found(None)
    except UlnaInputError:
        return USUAL
