"""How our tables look: heads with units, numbers to the right, no cell wrapped or cut."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rich import box
from rich.markup import escape
from rich.padding import Padding
from rich.table import Table
from rich.text import Text


def table(title: str, heads: Sequence[str], rows: Iterable[Sequence[str]], left: int = 1) -> Table:
    """A table; the first `left` columns hold words, the others numbers. A head may have several lines."""
    made = Table(
        title=Text(title, style="bold"),
        title_justify="left",
        box=box.SIMPLE_HEAD,
        show_edge=False,
        pad_edge=False,
        padding=(0, 1, 0, 0),
        header_style="",
    )
    for k, head in enumerate(heads):
        made.add_column(escape(head), justify="left" if k < left else "right", no_wrap=True, vertical="bottom")
    for row in rows:
        made.add_row(*(Text(cell) for cell in row))  # neither markup nor ":art:" for a picture
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
