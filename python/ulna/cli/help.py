"""What `ulna --help` and `ulna COMMAND --help` print, as plain text of the terminal's width.

Laid out here and not by Typer: its pages load renderers of Markdown and of source code, which takes longer than all
else that `ulna --help` does.
"""

from __future__ import annotations

import os
import re
import shutil
import sys
import textwrap
from collections.abc import Iterable
from typing import Any

from typer import BadParameter
from typer.core import TyperCommand, TyperGroup

WIDEST, NARROWEST = 100, 40
_NAMES_AT_MOST = 30
"""Columns for names; what is longer stands on a line of its own."""
_BOLD = re.compile(r"\[/?bold\]")


class Command(TyperCommand):
    """A command with a help page of ours."""

    def format_help(self, ctx: Any, formatter: Any) -> None:
        formatter.write(page(self, ctx))

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        try:
            return super().parse_args(ctx, args)
        except BadParameter as error:
            from ulna.cli.wrong_values import in_words

            in_words(error)
            raise

    def get_help_option(self, ctx: Any) -> Any:
        return _no_is_no(super().get_help_option(ctx))


class Group(TyperGroup):
    """What has commands of its own, with a help page of ours."""

    def format_help(self, ctx: Any, formatter: Any) -> None:
        formatter.write(page(self, ctx))

    def get_help_option(self, ctx: Any) -> Any:
        return _no_is_no(super().get_help_option(ctx))

    def listed(self, ctx: Any) -> list[tuple[str, str]]:
        """Each command, and what it is for."""
        commands = [(name, self.get_command(ctx, name)) for name in self.list_commands(ctx)]
        return [(name, first_paragraph(each.help)) for name, each in commands if each and not each.hidden]


def _no_is_no(option: Any) -> Any:
    """The option `--help`, False where it is not given: of None Typer asks Pydantic, which takes longer to load than
    the rest of a help page or of a completion."""
    if option is not None:
        option.default = False
    return option


def page(command: Any, ctx: Any) -> str:
    """The help page of a command or group."""
    width = max(min(shutil.get_terminal_size().columns, WIDEST), NARROWEST)
    usage = " ".join(command.collect_usage_pieces(ctx))
    parts = [_wrapped(f"Usage: {ctx.command_path} {usage}", width, "       ")]
    parts += [_wrapped(paragraph, width) for paragraph in (command.help or "").split("\n\n")]
    panels: dict[str, list[tuple[str, str]]] = {}
    for parameter in command.get_params(ctx):
        if not getattr(parameter, "hidden", False):
            own = "Arguments" if parameter.param_type_name == "argument" else "Options"
            heading = getattr(parameter, "rich_help_panel", None) or own
            panels.setdefault(heading, []).append((_name(parameter), _said(parameter, ctx)))
    if isinstance(command, Group):
        panels["Commands"] = command.listed(ctx)
    parts += [_heading(heading) + "\n" + _listed(rows, width) for heading, rows in panels.items()]
    return "\n\n".join(part for part in parts if part) + "\n"


def _name(parameter: Any) -> str:
    """`-o, --out DIR`; flags have no value."""
    value = parameter.metavar or parameter.bare_type().upper()
    if parameter.param_type_name == "argument":
        return str(parameter.metavar or parameter.name.upper())
    names = ", ".join(sorted(parameter.opts, key=len) + parameter.secondary_opts)
    return names if getattr(parameter, "is_flag", False) else f"{names} {value}"


def _said(parameter: Any, ctx: Any) -> str:
    """What it is, with its default."""
    record = parameter.get_help_record(ctx)
    return " ".join(record[1].split()) if record else ""


def first_paragraph(said: str | None) -> str:
    """On one line."""
    return " ".join((said or "").split("\n\n")[0].split())


def _listed(rows: Iterable[tuple[str, str]], width: int) -> str:
    """Names on the left, what they are on the right."""
    rows = list(rows)
    left = min(max(len(name) for name, _ in rows), _NAMES_AT_MOST, width // 2 - 4) + 4
    lines = []
    for name, said in rows:
        told = textwrap.wrap(said, width - left, break_on_hyphens=False) or [""]
        if len(name) > left - 4:
            lines.append(f"  {name}")
        else:
            lines.append(f"  {name}".ljust(left) + told.pop(0))
        lines += [" " * left + each for each in told]
    return "\n".join(line.rstrip() for line in lines)


def _wrapped(paragraph: str, width: int, indent: str = "") -> str:
    text = " ".join(_BOLD.sub("", paragraph).split())
    lines = textwrap.wrap(text, width, subsequent_indent=indent, break_on_hyphens=False, break_long_words=False)
    return "\n".join(lines)


def _heading(text: str) -> str:
    return f"\x1b[1m{text}\x1b[0m" if sys.stdout.isatty() and os.environ.get("TERM") != "dumb" else text
