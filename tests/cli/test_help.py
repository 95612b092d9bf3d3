"""Help as a reader sees it: Rich takes [words] for styles, and what it does not know vanishes."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import pytest
from typer.main import get_command
from typer.testing import CliRunner

from ulna.cli import app

STYLES = {"[bold]", "[/bold]"}


def commands(command: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[tuple[str, ...], Any]]:
    yield path, command
    for name in getattr(command, "commands", {}):
        yield from commands(command.commands[name], (*path, name))


ALL = list(commands(get_command(app)))


def bracketed(command: Any) -> set[str]:
    """Words in brackets of a command's text and of its arguments and options, as they should be read."""
    texts = [command.help or "", *(getattr(each, "help", None) or "" for each in command.params)]
    found = {word for text in texts for word in re.findall(r"\\?\[+\\?\[?[a-z/][^\[\]]*\]+", text)}
    return {word.replace("\\", "") for word in found} - STYLES


def test_the_check_sees_what_is_written() -> None:
    assert len(ALL) > 20
    assert {word for _, command in ALL for word in bracketed(command)} >= {"[[readings]]"}


@pytest.mark.parametrize(("path", "command"), ALL, ids=[" ".join(path) or "ulna" for path, _ in ALL])
def test_every_word_in_brackets_is_in_the_help(path: tuple[str, ...], command: Any) -> None:
    runner = CliRunner(env={"COLUMNS": "300", "NO_COLOR": "1", "TERM": "dumb"})
    shown = runner.invoke(app, [*path, "--help"]).stdout
    assert sorted(word for word in bracketed(command) if word not in shown) == []
    # and no style or mark of escape is left over
    assert "[bold]" not in shown
    assert "\\[" not in shown


def test_what_rich_would_eat_is_found() -> None:
    import typer

    probe = typer.Typer(rich_markup_mode="rich")

    @probe.command()
    def one() -> None:
        """Reads [fit] of a study."""

    command = get_command(probe)
    assert bracketed(command) == {"[fit]"}
    shown = CliRunner(env={"COLUMNS": "300", "TERM": "dumb"}).invoke(probe, ["--help"]).stdout
    assert "[fit]" not in shown, "Rich no longer eats it: the escapes can go"
