"""`ulna demo`: an example, copied and calibrated before one's eyes."""

from __future__ import annotations

import contextlib
import io
import shutil
import sys
import textwrap
from pathlib import Path
from typing import Annotated, Any

import typer

from ulna.cli.completing import demos
from ulna.cli.demos import Demo, Step
from ulna.cli.running import guard

_WIDEST = 100


@guard
def demo(
    context: typer.Context,
    name: Annotated[
        str, typer.Argument(metavar="NAME", help="Which example; see --list.", autocompletion=demos)
    ] = "bars",
    list_them: Annotated[bool, typer.Option("--list", help="Say which examples there are.")] = False,
    into: Annotated[Path, typer.Option("-o", "--into", metavar="FOLDER", help="Where to copy it to, and work.")] = Path(
        "ulna-demo"
    ),
    force: Annotated[bool, typer.Option("--force", help="Overwrite an earlier demo in that folder.")] = False,
) -> None:
    """Copy an example that comes with Ulna into a folder, calibrate it and say what came out.

    The commands are shown as they are run: they work as well when you type them yourself, and with files of your own.

    Example: [bold]ulna demo[/bold]
    """
    from ulna.cli import output
    from ulna.cli.demos import DEMOS, examples_folder
    from ulna.formats.output import check_output, output_folder
    from ulna.ground.errors import UlnaInputError, nearest

    if list_them:
        output.print_names("example", {key: each.about for key, each in DEMOS.items()})
        output.say("Play one with `ulna demo NAME`.")
        return
    if name not in DEMOS:
        raise UlnaInputError(f"ulna demo: there is no example '{name}'.{nearest(name, DEMOS)}")
    played, source = DEMOS[name], examples_folder()
    names = [Path(file).name for file in played.files]
    if into.is_dir() and any(into.iterdir()) and not force:
        raise UlnaInputError(f"{into}: is not empty. Name another folder with --into, or give --force.")
    check_output(into, names, force)
    with output_folder(into, names, force) as staging:
        for file in played.files:
            shutil.copyfile(source / file, staging / Path(file).name)
    _say(f"{played.about} Copied to {into}: {', '.join(names)}.")
    for number, step in enumerate(played.steps, start=1):
        print(f"\n{number}. {step.title} (printed in part)")
        _run(context, step, into, force)
    _closing(played, into)


def _run(context: typer.Context, step: Step, into: Path, force: bool) -> None:
    """Show a command, run it, show the paragraphs that matter. Raises typer.Exit with its code where it fails."""
    words = step.command.split() + (["--force"] if force and step.makes else [])
    print("$ ulna " + _typed(" ".join(words), into), flush=True)
    printed = io.StringIO()
    program: Any = context.find_root().command
    with contextlib.redirect_stdout(printed):
        code = program.main([word.replace("{}", str(into)) for word in words], "ulna", standalone_mode=False)
    if code:
        sys.stdout.write(printed.getvalue())
        raise typer.Exit(int(code))
    paragraphs = [part.strip("\n") for part in printed.getvalue().split("\n\n") if part.strip()]
    shown = [part for k, part in enumerate(paragraphs) if any(part.startswith(s) if s else k == 0 for s in step.shows)]
    print("\n\n".join("\n".join(line.rstrip() for line in part.splitlines()) for part in shown))


def _closing(played: Demo, into: Path) -> None:
    print("\nWhat is there now")
    _columns([(str(into / file), what) for file, what in played.results])
    print("What to try next")
    _columns([("ulna " + _typed(command, into), what) for command, what in played.next])


def _columns(rows: list[tuple[str, str]]) -> None:
    left = max(len(name) for name, _ in rows)
    for row, what in rows:
        print(f"  {row.ljust(left)}  {what}")


def _typed(command: str, into: Path) -> str:
    """As one would type it: a folder with a space in quotation marks."""
    folder = str(into)
    return " ".join(
        f'"{word.replace("{}", folder)}"' if " " in folder and "{}" in word else word.replace("{}", folder)
        for word in command.split()
    )


def _say(text: str) -> None:
    print(textwrap.fill(text, min(shutil.get_terminal_size().columns, _WIDEST), break_on_hyphens=False), flush=True)
