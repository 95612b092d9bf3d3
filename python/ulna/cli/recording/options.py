"""Options that the commands of `ulna record` share."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from ulna.records.records import Records

Where = Annotated[
    Path | None,
    typer.Option("--records", metavar="DIR", help="The record's folder; else ULNA_RECORDS, or your settings file."),
]
By = Annotated[
    str | None, typer.Option("--by", metavar="NAME", help="Who does it; else ULNA_BY, your settings, your login.")
]
At = Annotated[str | None, typer.Option("--at", metavar="TIME", help="When it was, such as 2026-11-30; else now.")]
Name = Annotated[str, typer.Argument(metavar="NAME", help="As registered.", show_default=False)]
Arm = Annotated[str, typer.Argument(metavar="ARM", help="As registered.", show_default=False)]


def opened(where: Path | None, by: str | None = None) -> Records:
    """The record. Raises UlnaInputError."""
    from ulna.records.records import Records

    return Records.open(where, by)
