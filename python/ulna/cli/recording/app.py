"""`ulna record`: what became of every arm."""

from __future__ import annotations

from typing import Any

import typer

from ulna.cli.help import Command, Group
from ulna.cli.recording import account, asking, filing, keeping, registering

app = typer.Typer(
    cls=Group,
    rich_markup_mode=None,
    name="record",
    help="Keep what became of every arm, over the years: results, tests, equipment, events, certificates.\n\n"
    'A record is a folder, named with --records DIR, by ULNA_RECORDS, or by folder = "DIR" below [record] in your '
    "settings file. Nothing in it is ever changed or deleted, and every act says who did it, when.",
    no_args_is_help=True,
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
TOPICS: tuple[dict[str, Any], ...] = (
    keeping.FIRST,
    registering.COMMANDS,
    filing.COMMANDS,
    asking.COMMANDS,
    keeping.COMMANDS,
    account.COMMANDS,
)
for topic in TOPICS:
    for name, function in topic.items():
        app.command(name, cls=Command)(function)
