"""What commands print: tables and machine forms on stdout, messages and progress on stderr."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from rich.console import Console, RenderableType
from rich.table import Table

from ulna.cli.streams import knows_all

if TYPE_CHECKING:
    from ulna.ground.arrays import Progress  # loads NumPy, which a list of names does not need

_PROGRESS_AFTER_S = 1.0
_AS_WIDE_AS_IT_IS = 10_000
"""Room for any table; one that does not expand takes what it needs."""


class _Out(Console):
    def on_broken_pipe(self) -> None:
        """A reader who has seen enough is no failure; `guard` knows."""
        raise BrokenPipeError


def say(message: str) -> None:
    """A message for the user, on stderr; what files put into it as a terminal may have it."""
    from ulna.ground.errors import for_people

    print("\n".join(map(for_people, message.split("\n"))), file=sys.stderr)


def print_json(document: Mapping[str, Any]) -> None:
    """The machine form, on stdout."""
    for piece in json.JSONEncoder(indent=1, ensure_ascii=False, allow_nan=False).iterencode(document):
        write_json(piece)
    sys.stdout.write("\n")


def write_json(piece: str) -> None:
    """A piece of the machine form, on stdout: letters that it does not know are written as ASCII, as JSON can."""
    if not (piece.isascii() or knows_all(sys.stdout)):
        piece = "".join(each if each.isascii() else json.dumps(each)[1:-1] for each in piece)
    sys.stdout.write(piece)


def print_renderable(*parts: RenderableType) -> None:
    """On stdout. Where a table is wider than the terminal its lines run over: no number is ever cut or broken."""
    narrow = _Out(file=sys.stdout, highlight=False, emoji=False)
    wide = _Out(file=sys.stdout, highlight=False, emoji=False, width=_AS_WIDE_AS_IT_IS)
    for part in parts:
        whole = isinstance(part, Table) and all(column.no_wrap for column in part.columns)
        (wide if whole else narrow).print(part, crop=False)


def columns() -> int:
    """Of the terminal; 80 where there is none."""
    return _Out(file=sys.stdout).width


def print_names(what: str, descriptions: Mapping[str, str]) -> None:
    """A list of names, each with what it is."""
    table = Table(what, "what it is", box=None, pad_edge=False)
    table.columns[0].no_wrap = True
    for name, description in descriptions.items():
        table.add_row(name, description)
    print_renderable(table)


@contextmanager
def progress_bar() -> Iterator[Progress | None]:
    """A bar on stderr for work that takes more than a second, where a terminal is there; else None."""
    console = Console(file=sys.stderr)
    if not console.is_terminal:
        yield None
        return
    bar = _Bar(console)
    try:
        yield bar
    finally:
        bar.close()


class _Bar:
    def __init__(self, console: Console) -> None:
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

        self._began = time.monotonic()
        self._progress = Progress(
            TextColumn("{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            console=console,
            transient=True,
        )
        self._tasks: dict[str, Any] = {}

    def __call__(self, stage: str, done: int, total: int) -> None:
        if not self._progress.live.is_started:
            if time.monotonic() - self._began < _PROGRESS_AFTER_S:
                return
            self._progress.start()
        if stage not in self._tasks:
            for other in self._tasks.values():  # one line: the stage that is under way
                self._progress.update(other, visible=False)
            self._tasks[stage] = self._progress.add_task(stage, total=total or None)
        self._progress.update(self._tasks[stage], completed=done, total=total or None)

    def close(self) -> None:
        """Leave the terminal as it was."""
        if self._progress.live.is_started:
            self._progress.stop()
