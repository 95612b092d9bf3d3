"""`ulna record account`: how somebody signs in to a laboratory's workbench."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from ulna.cli.recording.options import Where, opened
from ulna.cli.running import guard
from ulna.ground.errors import UlnaInputError


@guard
def account(
    name: Annotated[str, typer.Argument(metavar="NAME", help="As ulna record person has it.", show_default=False)],
    sign_in: Annotated[
        str | None,
        typer.Option("--sign-in", metavar="TEXT", help="What the OpenID provider calls them, such as their address."),
    ] = None,
    from_stdin: Annotated[
        bool, typer.Option("--password-stdin", help="The password is the first line of standard input.")
    ] = False,
    remove: Annotated[bool, typer.Option("--remove", help="They sign in no more.")] = False,
    where: Where = None,
) -> None:
    """Say how somebody signs in to the laboratory's workbench: by a password, which is asked for, or at its provider.

    What they may do there is what their roles say: ulna record person.

    Example: [bold]ulna record account "Erika Muster"[/bold]
    """
    from ulna.cli import output
    from ulna.ground.extras import need

    need("ulna record account", "argon2")
    from ulna.serve.laboratory.accounts import Accounts

    if sum((sign_in is not None, from_stdin, remove)) > 1:
        raise UlnaInputError("options --sign-in, --password-stdin, --remove: got more than one; expected one. Choose.")
    record = opened(where)
    accounts = Accounts(record.bench.folder)
    if remove:
        accounts.remove(name)
        output.say(f"{name}: signs in no more.")
        return
    if not record.people().get(name):
        raise UlnaInputError(
            f"record: '{name}' has no role; expected somebody who has. First: ulna record person {name!r} --role "
            "operator."
        )
    if sign_in is not None:
        accounts.set_sign_in(name, sign_in.strip() or None)
        output.say(f"{name}: signs in at the provider as {sign_in}.")
        return
    accounts.set_password(name, _line() if from_stdin else _asked(name))
    output.say(f"{name}: signs in with the new password.")


def _line() -> str:
    return sys.stdin.readline().rstrip("\r\n")


def _asked(name: str) -> str:
    from getpass import getpass

    if not sys.stdin.isatty():
        raise UlnaInputError("password: nobody can be asked here; expected a terminal, or --password-stdin.")
    first = getpass(f"Password of {name}: ")
    if getpass("Once more: ") != first:
        raise UlnaInputError("password: it was not the same twice; nothing was changed. Begin anew.")
    return first


COMMANDS = {"account": account}
