"""The notebooks of the docs run as they stand, hold no output of yesterday, and end where their story says."""

import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.ipynb"))


@pytest.fixture(scope="module")
def run(root: Path) -> Any:
    """`run_notebook` of tools/, which is no package."""
    sys.path.insert(0, str(root / "tools"))
    try:
        import docs_notebooks

        yield docs_notebooks
    finally:
        sys.path.remove(str(root / "tools"))


def test_there_are_some() -> None:
    assert [path.stem for path in NOTEBOOKS] == ["from-a-table-to-a-length"]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_no_output_is_kept_by_hand(path: Path) -> None:
    document = json.loads(path.read_text(encoding="utf-8"))
    assert document["nbformat"] == 4
    for cell in document["cells"]:
        assert cell["cell_type"] in ("markdown", "code")
        if cell["cell_type"] == "code":
            assert cell["outputs"] == []
            assert cell["execution_count"] is None
    ids = [cell["id"] for cell in document["cells"]]
    assert len(set(ids)) == len(ids)
    nav = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    assert f"notebooks/{path.stem}.md" in nav


def test_from_a_table_to_a_length(run: Any) -> None:
    cells, names = run.run_notebook(NOTEBOOKS[0])
    result, measured, length = names["result"], names["measured"], names["length"]
    assert result.fit.converged
    assert abs(length.value_mm - 443.172) < 3 * length.u_mm  # the bar that was touched
    np.testing.assert_allclose(result.parameters[2].value, 42.4753, atol=5e-4)  # as `ulna calibrate` finds it
    assert len(measured) == 2
    code = [cell for cell in cells if cell.kind == "code"]
    shown = "".join(each for cell in code for each in cell.shown)
    assert shown.count("<img") == 3
    assert "Achse 7 [rad]" in shown
    page = run.page_of(NOTEBOOKS[0])
    assert page.startswith("# From a table to a measured length\n")
    assert page.count("```python") == len(code)
    for cell in code:
        assert cell.source in page


def test_a_cell_that_fails_is_not_passed_over(run: Any, tmp_path: Path) -> None:
    def notebook(source: str) -> Path:
        cell = {
            "cell_type": "code",
            "source": [source],
            "metadata": {},
            "outputs": [],
            "id": "a",
            "execution_count": None,
        }
        (tmp_path / "n.ipynb").write_text(json.dumps({"cells": [cell], "nbformat": 4, "nbformat_minor": 5}))
        return tmp_path / "n.ipynb"

    with pytest.raises(ZeroDivisionError):
        run.run_notebook(notebook("1 / 0"))
    (cell,), names = run.run_notebook(notebook("x = 2\nprint('a')\nx + 1"))
    assert (cell.printed, cell.shown, names["x"]) == ("a\n", ["<pre><code>3</code></pre>"], 2)
