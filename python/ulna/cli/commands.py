"""Which commands there are, in the order of `ulna --help`; each is loaded, and its options are read, when it is asked
for."""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping
from typing import Any

import typer
from typer.core import TyperCommand, TyperGroup
from typer.main import get_command

from ulna.cli.help import Command, Group, first_paragraph

#: command → the module that has it, as a function of the same name
COMMANDS = {
    "demo": "ulna.cli.demo",
    "workbench": "ulna.cli.workbench",
    "new": "ulna.cli.new",
    "show": "ulna.cli.show",
    "calibrate": "ulna.cli.calibrate",
    "identify": "ulna.cli.identify",
    "evaluate": "ulna.cli.evaluate",
    "measure": "ulna.cli.measure",
    "uncertainty": "ulna.cli.uncertainty",
    "cross-validate": "ulna.cli.cross_validate",
    "check": "ulna.cli.check",
    "compare": "ulna.cli.compare",
    "certificate": "ulna.cli.certificate",
    "batch": "ulna.cli.batch",
    "simulate": "ulna.cli.simulate",
    "plan": "ulna.cli.plan",
    "report": "ulna.cli.report",
    "verify": "ulna.cli.verify",
    "reproduce": "ulna.cli.reproduce",
    "completion": "ulna.cli.completion",
}
#: what has commands of its own → the module that has them, as `app`
GROUPS = {
    "import": "ulna.cli.importing",
    "export": "ulna.cli.exporting",
    "live": "ulna.cli.live.app",
    "record": "ulna.cli.recording.app",
}


class _Loading(Mapping[str, TyperCommand | TyperGroup]):
    """The commands by name, each made once."""

    def __init__(self) -> None:
        self._made: dict[str, TyperCommand | TyperGroup] = {}

    def __getitem__(self, name: str) -> TyperCommand | TyperGroup:
        if name not in self._made:
            self._made[name] = _group(GROUPS[name]) if name in GROUPS else _command(name, COMMANDS[name])
        return self._made[name]

    def __iter__(self) -> Iterator[str]:
        return iter([*COMMANDS, *GROUPS])

    def __len__(self) -> int:
        return len(COMMANDS) + len(GROUPS)


def _command(name: str, module: str) -> TyperCommand | TyperGroup:
    app = typer.Typer(add_completion=False, rich_markup_mode=None)
    app.command(name, cls=Command)(_function(name, module))
    made: Any = get_command(app)  # typer's own name of the type is private
    return made  # type: ignore[no-any-return]


def _function(name: str, module: str) -> Any:
    return getattr(importlib.import_module(module), name.replace("-", "_"))


def _group(module: str) -> TyperCommand | TyperGroup:
    made: Any = get_command(importlib.import_module(module).app)
    return made  # type: ignore[no-any-return]


class Commands(Group):
    """The group `ulna`: its commands are those of the two tables above."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.commands: Any = _Loading()

    def list_commands(self, ctx: Any) -> list[str]:
        return [*COMMANDS, *GROUPS]

    def listed(self, ctx: Any) -> list[tuple[str, str]]:
        """From what is written in the modules: making all commands takes as long as all else that `--help` does."""
        written = {name: _function(name, module).__doc__ for name, module in COMMANDS.items()}
        written |= {name: importlib.import_module(module).app.info.help for name, module in GROUPS.items()}
        return [(name, first_paragraph(said)) for name, said in written.items()]
