"""The notebooks of the docs, run: a hook of MkDocs makes a page of each, with what its cells show today.

A notebook is committed without outputs. It is run here with plain Python, cell by cell, in a folder with a copy of
examples/; its last expression is shown as a notebook would show it: as HTML, as a drawing, or as text.
"""

from __future__ import annotations

import ast
import base64
import contextlib
import html
import io
import json
import re
import sys
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parent))

from docs_running import ROOT, reader_folder

NOTEBOOKS = ROOT / "docs" / "notebooks"


@dataclass
class Cell:
    """One cell, and what came of it."""

    kind: str
    """"markdown" or "code"."""
    source: str
    printed: str = ""
    shown: list[str] = field(default_factory=list)
    """HTML."""


def cells_of(path: Path) -> list[Cell]:
    """As they stand in the file."""
    document = json.loads(path.read_text(encoding="utf-8"))
    return [Cell(each["cell_type"], "".join(each["source"])) for each in document["cells"]]


def run_notebook(path: Path) -> tuple[list[Cell], dict[str, Any]]:
    """The cells with what they show, and the names at the end. Raises whatever a cell raises."""
    import matplotlib as mpl

    mpl.use("Agg")
    cells, names = cells_of(path), {"__name__": "__main__"}
    with reader_folder() as folder, contextlib.chdir(folder):
        for number, cell in enumerate(cells, start=1):
            if cell.kind == "code":
                _run(cell, f"{path.name}, cell {number}", names)
    return cells, names


def _run(cell: Cell, label: str, names: dict[str, Any]) -> None:
    tree = ast.parse(cell.source, label)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        exec(compile(tree, label, "exec"), names)
        value = eval(compile(ast.Expression(last.value), label, "eval"), names) if isinstance(last, ast.Expr) else None
    cell.printed = out.getvalue()
    figures = list(_figures())
    cell.shown = figures or ([] if value is None else [_shown(value)])


def _figures() -> Iterator[str]:
    """Those that the cell has drawn, as pictures."""
    import matplotlib.pyplot as plt

    for number in plt.get_fignums():
        file = io.BytesIO()
        plt.figure(number).savefig(file, format="png", dpi=110)
        content = base64.b64encode(file.getvalue()).decode()
        yield f'<img src="data:image/png;base64,{content}" alt="drawing">'
    plt.close("all")


def _shown(value: Any) -> str:
    page = getattr(value, "_repr_html_", None)
    if page is None:
        return f"<pre><code>{html.escape(repr(value))}</code></pre>"
    # a page of Markdown ends raw HTML at a blank line, and styles of its own break in the dark
    text = re.sub(r"<style.*?</style>", "", page(), flags=re.DOTALL)
    return re.sub(r"\n\s*", "", text).replace(' border="1"', "")


def page_of(path: Path) -> str:
    """The notebook as a page of Markdown."""
    cells, _ = run_notebook(path)
    parts = []
    for cell in cells:
        if cell.kind == "markdown":
            parts.append(cell.source)
            continue
        parts.append(f"```python\n{cell.source}\n```")
        parts += [f"```text\n{cell.printed.rstrip()}\n```"] if cell.printed else []
        parts += [f'<div class="shown">{each}</div>' for each in cell.shown]
    note = (
        f"This page is a notebook, run when the docs were built: [{path.name}]({path.name}) runs as it is in Jupyter."
    )
    head, _, rest = parts[0].partition("\n")
    return "\n\n".join([head, note, rest.strip(), *parts[1:]]) + "\n"


def on_files(files: Any, config: Any) -> Any:
    """Called by MkDocs: a page for each notebook, beside it."""
    from mkdocs.structure.files import File

    for path in sorted(NOTEBOOKS.glob("*.ipynb")):
        files.append(File.generated(config, f"notebooks/{path.stem}.md", content=page_of(path)))
    return files
