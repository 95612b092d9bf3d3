"""The tables of a rerun as files: each as CSV, all of them as LaTeX (package booktabs), as they are printed."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from pathlib import Path

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

LATEX = "tables.tex"
#: what LaTeX reads as its own
_ESCAPED = {
    "\\": r"\textbackslash{}",
    "&": r"\&",
    "%": r"\%",
    "$": r"\$",
    "#": r"\#",
    "_": r"\_",
    "{": r"\{",
    "}": r"\}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
}


def table_files(shown: RenderableType) -> list[str]:
    """Names of the files that `write_tables` writes."""
    return [LATEX, *(f"table-{number}.csv" for number, _ in enumerate(_tables(shown), start=1))]


def write_tables(shown: RenderableType, folder: Path) -> None:
    """Every table of what is shown, in its order, into a folder that is there."""
    found = list(_tables(shown))
    for number, table in enumerate(found, start=1):
        with (folder / f"table-{number}.csv").open("w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows(_rows(table))
    head = "% Written by Ulna: \\usepackage{booktabs}, and an engine that reads UTF-8.\n"
    (folder / LATEX).write_text(head + "\n".join(map(_latex, found)), encoding="utf-8")


def _tables(shown: RenderableType) -> Iterator[Table]:
    if isinstance(shown, Table):
        yield shown
    elif isinstance(shown, Group):
        for part in shown.renderables:
            yield from _tables(part)


def _rows(table: Table) -> list[list[str]]:
    heads = [_plain(column.header) for column in table.columns]
    cells = [[_plain(cell) for cell in column.cells] for column in table.columns]
    return [heads, *map(list, zip(*cells, strict=True))]


def _plain(cell: RenderableType) -> str:
    text = cell.plain if isinstance(cell, Text) else Text.from_markup(str(cell)).plain
    return " ".join(text.split())


def _latex(table: Table) -> str:
    heads, *rows = [[_escaped(cell) for cell in row] for row in _rows(table)]
    align = "".join("r" if column.justify == "right" else "l" for column in table.columns)
    title = "" if table.title is None else f"% {_plain(table.title)}\n"
    body = "".join(f"{' & '.join(row)} \\\\\n" for row in rows)
    return (
        f"{title}\\begin{{tabular}}{{{align}}}\n\\toprule\n{' & '.join(heads)} \\\\\n\\midrule\n{body}"
        "\\bottomrule\n\\end{tabular}\n"
    )


def _escaped(text: str) -> str:
    return "".join(_ESCAPED.get(letter, letter) for letter in text)
