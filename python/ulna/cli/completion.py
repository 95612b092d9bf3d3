"""`ulna completion`: the script by which a shell completes commands, options, names and files."""

from __future__ import annotations

import sys
from typing import Annotated, Any

import typer

from ulna.cli.completing import SHELLS, VARIABLE, shells
from ulna.cli.running import guard


@guard
def completion(
    shell: Annotated[
        str | None,
        typer.Argument(
            metavar="SHELL",
            help="bash, zsh, fish or powershell; without it the shell that you are in.",
            show_default=False,
            autocompletion=shells,
        ),
    ] = None,
    install: Annotated[
        bool, typer.Option("--install", help="Put it where that shell finds it, instead of printing it.")
    ] = False,
) -> None:
    """Let a shell complete Ulna's commands, options, names and files with the tab key.

    Prints the script, to be read by the shell's start file or put where the system keeps such scripts. With --install
    it is written for you, and the shell's start file names it.

    Example: [bold]ulna completion --install[/bold]
    """
    import typer.completion

    scripts: Any = typer.completion  # what it hands on is unsaid

    from ulna.cli import output
    from ulna.ground.errors import UlnaInputError, nearest

    known = shell or _this_shell()
    if known not in SHELLS:
        got = "the shell is not recognised" if shell is None else f"got '{shell}'"
        hint = nearest(shell or "", SHELLS)
        raise UlnaInputError(
            f"argument SHELL: {got}; expected {', '.join(SHELLS[:-1])} or {SHELLS[-1]}."
            + (hint if "Did you mean" in hint else " Name it: ulna completion bash.")
        )
    if not install:
        print(scripts.get_completion_script(prog_name="ulna", complete_var=VARIABLE, shell=known))
        if sys.stdout.isatty():
            output.say(f"Nothing was written: ulna completion {known} --install puts it where {known} finds it.")
        return
    _, path = scripts.install(known, "ulna", VARIABLE)
    output.say(f"Written: {path}. It works in every {known} that is opened from now on.")


def _this_shell() -> str:
    """The shell that runs the program, or "" where nobody knows."""
    import shellingham

    try:
        name: str = shellingham.detect_shell()[0]
    except shellingham.ShellDetectionFailure:
        return ""
    return name
