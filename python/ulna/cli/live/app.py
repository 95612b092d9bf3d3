"""`ulna live`: an arm that talks."""

from __future__ import annotations

from typing import Any

import typer

from ulna.cli.help import Command, Group
from ulna.cli.live import commission, geometry, looking, measuring, recording, touching

app = typer.Typer(
    cls=Group,
    rich_markup_mode=None,
    name="live",
    help="Read an arm as it is turned: find its port, see what it sends, touch and measure with it, record it.\n\n"
    "A SOURCE is a url such as serial:/dev/ttyACM0, a source file (ulna-source/1, .toml), or a recording.",
    no_args_is_help=True,
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
TOPICS: tuple[dict[str, Any], ...] = (
    looking.COMMANDS,
    geometry.COMMANDS,
    commission.COMMANDS,
    touching.COMMANDS,
    measuring.COMMANDS,
    recording.COMMANDS,
)
for topic in TOPICS:
    for name, function in topic.items():
        app.command(name, cls=Command)(function)
