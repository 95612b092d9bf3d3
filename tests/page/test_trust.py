"""From a result to what is kept of it: filed, compared, certified, issued and withdrawn, through the page alone."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.conftest import ROOT
from tests.page.test_screens import check
from tests.real_parts import lacking
from tests.records.serving import Server
from tests.serve.servers import Client, Process

from ulna.records.records import Records
from ulna.serve.page import there

EXAMPLE = ROOT / "examples" / "platinum"


@pytest.fixture(scope="module", params=["sqlite", "postgresql"])
def server(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Process]:
    """A bench of its own, its index in SQLite and in PostgreSQL."""
    if not there():
        lacking("the built page (make page, with Node 20.19)")
    folder = tmp_path_factory.mktemp("trust") / "bench"
    postgresql = Server() if request.param == "postgresql" else None
    Records.init(folder, None if postgresql is None else postgresql.database(), by="Ann")
    running = Process(folder)
    yield running
    running.end()
    if postgresql is not None:
        postgresql.end()


@pytest.fixture
def results(client: Client, tmp_path: Path) -> list[str]:
    """Two calibrations of one arm."""
    named = [path for path in EXAMPLE.iterdir() if path.suffix == ".csv" or path.name == "platinum.toml"]
    beside = [client.bring(path) for path in named]
    found = []
    for k in range(2):
        study = tmp_path / f"study-{k}.toml"
        study.write_text(
            f"# the {k + 1}. time\n" + (EXAMPLE / "study.toml").read_text(encoding="utf-8"), encoding="utf-8"
        )
        asked = {"kind": "calibrate", "study": client.bring(study), "beside": beside}
        found.append(client.made(asked)["result"])
    return found


def test_filed_compared_issued_and_withdrawn(
    opened: Callable[..., Any], client: Client, server: Process, results: list[str], pictures: Path
) -> None:
    page, base = opened(), server.address.partition("/#")[0]
    for sha256 in results:
        page.goto(f"{base}/results/{sha256}")
        page.get_by_role("button", name="File in the record").click()
        page.get_by_text(re.compile("Filed in the record|It is in the record")).first.wait_for()
    arm = client.get(f"/results/{results[0]}")["arm"]

    page.goto(f"{base}/")
    page.get_by_role("heading", name=arm).first.wait_for()
    check(page, "bench with an arm")
    page.screenshot(path=str(pictures / "bench-kept.png"))

    page.goto(f"{base}/compare")
    boxes = page.get_by_role("checkbox", name=re.compile(re.escape(arm)))
    boxes.nth(1).wait_for()
    for box in boxes.all():
        box.check()
    page.get_by_role("button", name="Compare", exact=True).click()
    page.get_by_text(re.compile("both uncertainties")).nth(1).wait_for()
    check(page, "compare")
    page.screenshot(path=str(pictures / "compare-two.png"), full_page=True)

    page.goto(f"{base}/records")
    page.get_by_role("link", name=re.compile(re.escape(arm))).first.click()
    page.get_by_text(re.compile("calibrat", re.IGNORECASE)).first.wait_for()
    check(page, "an arm of the record")
    page.screenshot(path=str(pictures / "record-one.png"), full_page=True)

    page.goto(f"{base}/certificate")
    page.get_by_label("Arm", exact=True).select_option(arm)
    page.locator("input[type=file]").first.set_input_files(str(EXAMPLE / "laboratory.toml"))
    page.get_by_text("A laboratory file is missing").wait_for(state="detached")
    issue = page.get_by_role("button", name="Issue a certificate")
    issue.click()
    page.get_by_text(re.compile("is issued")).wait_for()
    check(page, "a certificate")
    page.evaluate("scrollTo(0, 0)")
    page.screenshot(path=str(pictures / "certificate.png"))
    (certificate,) = client.get("/records/certificates")["certificates"]
    content = client.ask("GET", f"/files/{certificate['sha256']}/content").content
    assert content.startswith(b"%PDF")
    page.get_by_role("button", name="Withdraw").first.click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("textbox").first.fill("the bar was of another length")
    dialog.get_by_role("button", name=re.compile("Withdraw")).click()
    page.get_by_text("the bar was of another length").wait_for()

    page.goto(f"{base}/records")
    page.get_by_role("button", name="Verify the record").click()
    page.get_by_text("as it was written", exact=False).first.wait_for()
