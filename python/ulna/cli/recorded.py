"""The option `--record`: what a command wrote is filed in the record as well."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from ulna.records.outcomes import Recording

Record = Annotated[
    str | None,
    typer.Option("--record", metavar="ARM", help="File what -o writes in the record, as of that arm."),
]


def recording(arm: str | None, out: Path | None) -> Recording | None:
    """Where the outcome goes, asked before the long work; None where nobody asked. Raises UlnaInputError."""
    from ulna.ground.errors import UlnaInputError

    if arm is None:
        return None
    if out is None:
        raise UlnaInputError("option --record: files what -o writes; expected that too. Add -o.")
    from ulna.records.outcomes import Recording

    return Recording.of(arm)


def record(
    where: Recording | None,
    path: Path,
    with_it: Mapping[str, Path] | None = None,
    artefacts: Sequence[str] = (),
    at: str | None = None,
) -> None:
    """File what was written, and say so."""
    if where is None:
        return
    from ulna.cli import output

    filed = where.keep(path, with_it, artefacts, at)
    was = "filed" if filed.new else "was there already"
    output.say(f"{filed.kind} of {filed.arm}: {was} ({filed.sha256[:12]}…). Entry {filed.seq}.")
