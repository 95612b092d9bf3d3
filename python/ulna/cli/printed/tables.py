"""How our tables look: heads with units, numbers to the right, no cell wrapped or cut."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rich.markup import escape
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from ulna.ground.terminal import plain_table


def table(title: str, heads: Sequence[str], rows: Iterable[Sequence[str]], left: int = 1) -> Table:
    """A table; the first `left` columns hold words, the others numbers. A head may have several lines."""
    made = plain_table(title)
    for k, head in enumerate(heads):
        made.add_column(escape(head), justify="left" if k < left else "right", no_wrap=True, vertical="bottom")
    # Lines of one row: rich measures and draws cell by cell, which for 30 parameters takes longer than to fit them.
    # A Text is neither markup nor has it ":art:" for a picture.
    columns = [Text("\n".join(cell.replace("\n", " ") for cell in column)) for column in zip(*rows, strict=True)]
    if columns:
        made.add_row(*columns)
    return made


def heading(text: str) -> Text:
    """The title of something that is no table."""
    return Text(text, style="bold")


def listed(items: Iterable[Sequence[str]]) -> Padding:
    """Numbered paragraphs; each item's further texts stand below its first."""
    grid = Table.grid(padding=(0, 1))
    grid.add_column(justify="right")
    grid.add_column()
    for number, (first, *more) in enumerate(items, start=1):
        grid.add_row(f"{number}.", Text(first))
        for text in more:
            grid.add_row("", Text(text))
    return Padding(grid, (0, 0, 0, 1))
