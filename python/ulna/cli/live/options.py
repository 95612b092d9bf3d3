"""Options that the commands of `ulna live` share."""

from __future__ import annotations

from typing import Annotated

import typer

Source = Annotated[
    str, typer.Argument(metavar="SOURCE", help="A url, a source file, or a recording.", show_default=False)
]
Seconds = Annotated[
    float | None, typer.Option("--seconds", metavar="S", min=0.0, help="Ends after so many seconds; else with Ctrl-C.")
]
