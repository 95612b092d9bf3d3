"""Arguments and options that several commands share."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

StudyArgument = Annotated[Path, typer.Argument(metavar="STUDY", help="The study file (TOML).", show_default=False)]
ArmFile = Annotated[
    Path, typer.Argument(metavar="ARM", help="An arm.toml, or the result.json of a calibration.", show_default=False)
]
OutFolder = Annotated[
    Path | None,
    typer.Option("-o", "--out", metavar="DIR", help="Folder to write to; without it nothing is written."),
]
Dask = Annotated[
    str | None,
    typer.Option("--dask", metavar="ADDRESS", help="Scheduler of a Dask cluster whose workers do it."),
]
Keep = Annotated[
    Path | None,
    typer.Option("--keep", metavar="DIR", help="Keep finished work there; the same command goes on from it."),
]
Force = Annotated[bool, typer.Option("--force", help="Overwrite earlier results; never an input.")]
Json = Annotated[bool, typer.Option("--json", help="Print the machine form on stdout.")]
Judge = Annotated[bool, typer.Option("--judge", help="Say whether residuals still follow the turn of a joint.")]
All = Annotated[bool, typer.Option("--all", help="Print all there is, not just one screen of it.")]


def one_of(option: str, value: str, known: tuple[str, ...]) -> None:
    """Raises UlnaInputError for a word that an option does not know."""
    from ulna.ground.errors import UlnaInputError, nearest

    if value not in known:
        hint = nearest(value, known)
        raise UlnaInputError(
            f"option {option}: got '{value}', expected {', '.join(known[:-1])} or {known[-1]}."
            + (hint if "Did you mean" in hint else " Correct it.")
        )


def numbers(option: str, value: str) -> tuple[float, ...]:
    """Of a list with commas. Raises UlnaInputError."""
    import math

    from ulna.ground.errors import UlnaInputError

    try:
        found = tuple(float(each) for each in value.split(","))
    except ValueError:
        found = ()
    if not found or not all(math.isfinite(each) for each in found):
        raise UlnaInputError(f"option {option}: got '{value}', expected numbers with commas between them. Correct it.")
    return found
