"""A spreadsheet as somebody keeps it, counts and German headings, dropped onto the page: a calibrated arm."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.cli_runs import run
from tests.home_built import COUNTS, LENGTH_MM, Kept, measured, workbook
from tests.page.test_screens import check
from tests.serve.servers import Client, Process

DROP = """([name, bytes]) => {
    const data = new DataTransfer();
    data.items.add(new File([new Uint8Array(bytes)], name));
    const target = document.querySelector(".drop");
    for (const kind of ["dragover", "drop"])
        target.dispatchEvent(new DragEvent(kind, { dataTransfer: data, bubbles: true, cancelable: true }));
}"""


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Kept:
    return measured(tmp_path_factory.mktemp("kept"), seed=2)


def test_a_german_workbook_is_dropped_and_calibrated(
    opened: Callable[..., Any], client: Client, server: Process, kept: Kept, tmp_path: Path, pictures: Path
) -> None:
    book = tmp_path / "Messung.xlsx"
    workbook(kept, book)
    page = opened("de")
    page.goto(f"{server.address.partition('/#')[0]}/file")
    page.locator(".drop").first.wait_for()
    page.evaluate(DROP, [book.name, list(book.read_bytes())])
    page.get_by_role("status").filter(has_text=book.name).get_by_role("button", name="Ansehen").click()
    page.get_by_role("heading", name=book.name).wait_for()
    page.get_by_label("Länge zwischen den Sitzen, mm").fill(str(LENGTH_MM))
    page.get_by_label("Was vom Arm bekannt ist").select_option("reach")
    page.get_by_label("Reichweite, mm").fill("1000")
    page.get_by_label("counts_per_turn").fill(str(COUNTS))
    page.get_by_label("counts_per_turn").press("Tab")
    page.get_by_label("parallel").fill("none")
    page.get_by_label("parallel").press("Tab")
    page.get_by_text("sind brauchbar").wait_for()
    check(page, "a German workbook")
    page.screenshot(path=str(pictures / "brought.png"), full_page=True)
    page.get_by_role("button", name="Eine Studie daraus machen").click()
    page.get_by_role("button", name="Kalibrieren").click()
    page.wait_for_url("**/results/*")
    page.get_by_role("heading", name="Parameter").first.wait_for()
    check(page, "what a German workbook gave")
    shown = client.get(f"/results/{page.url.rsplit('/', 1)[1]}")
    assert shown["converged"]
    options = ["--artefact", "bar", "--length", str(LENGTH_MM), "--reach", "1000", "--parallel", "none"]
    new = tmp_path / "new"
    done = run("new", "--readings", book, *options, "--counts-per-turn", str(COUNTS), "-o", new)
    assert done.returncode == 0, done.stderr
    done = run("calibrate", new / "study.toml", "-o", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    theirs = client.bring(tmp_path / "out" / "result.json", "by-the-command.json")
    assert figures(client.get(f"/results/{theirs}")) == figures(shown)


def figures(result: dict[str, Any]) -> list[dict[str, Any]]:
    """Every section but when and of which file it was made."""
    return [section for section in result["sections"] if section["key"] != "provenance"]
