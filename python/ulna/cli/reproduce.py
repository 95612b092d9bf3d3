"""`ulna reproduce`: a study of the literature rerun, its numbers beside ours.

The studies live in `ulna.reproduce`, one module each. The registry `ulna.reproduce.STUDIES` maps a name to
``(one-line description, module name)``; that module has ``run(out, progress) -> Reproduction``, where the two protocols
below say what is meant.
"""

from __future__ import annotations

import importlib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Protocol, cast

import typer

from ulna.cli.completing import studies
from ulna.cli.running import guard

if TYPE_CHECKING:
    from rich.console import RenderableType

    #: called with (stage, done, total) as the work goes on, as the core does
    Progress = Callable[[str, int, int], None]


class Reproduction(Protocol):
    """What a rerun study found."""

    @property
    def agrees(self) -> bool:
        """Whether every number that the study claims came out within its stated tolerance (exit code 0, else 1)."""

    def table(self) -> RenderableType:
        """What `rich` prints: published and found side by side, no wider than 80 columns."""

    def as_dict(self) -> dict[str, Any]:
        """The same for `--json`: JSON types only, no NaN."""


class ReproductionModule(Protocol):
    """A module that the registry names."""

    def run(self, out: Path | None, progress: Progress | None, *, force: bool = True) -> Reproduction:
        """Rerun the study; where `out` is given, write its pictures and tables into that folder (made whole or not
        at all), over what has appeared there only by `force`. `progress` is called as in the core. Raises
        KeyboardInterrupt when interrupted."""


@guard
def reproduce(
    name: Annotated[
        str | None,
        typer.Argument(help="Which study; none: list them.", show_default=False, autocompletion=studies),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("-o", "--out", help="Folder for pictures and numbers.", show_default=False)
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite what is in the folder.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print the machine form on stdout.")] = False,
) -> None:
    """Rerun a study of the literature and print its numbers beside ours.

    Without a name: list the studies. Exit code 1 where a number does not come out as published.

    Example: [bold]ulna reproduce cheng2011 -o out/cheng2011[/bold]
    """
    from ulna.cli import output
    from ulna.ground.errors import UlnaInputError, nearest
    from ulna.reproduce import STUDIES

    if name is None:
        if as_json:
            output.print_json({"studies": {key: description for key, (description, _) in STUDIES.items()}})
        else:
            output.print_names("study", {key: description for key, (description, _) in STUDIES.items()})
            output.say("Run one with `ulna reproduce NAME`.")
        return
    if name not in STUDIES:
        raise UlnaInputError(f"ulna reproduce: there is no study '{name}'.{nearest(name, STUDIES)}")
    if out is not None and out.exists() and not force:
        raise UlnaInputError(f"{out}: exists already and is not overwritten. Name another folder, or give --force.")
    module = cast("ReproductionModule", importlib.import_module(STUDIES[name][1]))
    with output.progress_bar() as progress:
        found = module.run(out, progress, force=force)
    if as_json:
        output.print_json(found.as_dict())
    else:
        output.print_renderable(found.table())
    if not found.agrees:
        output.say("The numbers do not all agree with the published ones.")
        raise typer.Exit(1)
