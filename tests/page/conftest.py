"""The page in a real browser, Debian's Chromium, at a real server."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.conftest import ROOT
from tests.real_parts import lacking
from tests.serve.servers import FAST, Client, Process

from ulna.serve.page import there

playwright = pytest.importorskip("playwright.sync_api", reason="Playwright is not installed: make build")
WIDE, NARROW = {"width": 1280, "height": 800}, {"width": 390, "height": 844}
AXE = ROOT / "page" / "node_modules" / "axe-core" / "axe.min.js"
PATIENCE_MS = 60_000


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Process]:
    """A process of its own, as a user starts it."""
    if not there():
        lacking("the built page (make page, with Node 20.19)")
    running = Process(tmp_path_factory.mktemp("page") / "bench")
    yield running
    running.end()


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """One for a module: as long as it is open a loop of asyncio runs in this thread, and others can begin none."""
    program = shutil.which("chromium") or shutil.which("google-chrome")
    if program is None:
        lacking("Chromium")
    with playwright.sync_playwright() as started:
        opened = started.chromium.launch(executable_path=program, args=["--no-sandbox"])
        yield opened
        opened.close()


@pytest.fixture
def opened(browser: Any, server: Process) -> Iterator[Callable[..., Any]]:
    """Pages that are signed in. Whatever asks another host, or says that something is wrong, fails the test."""
    contexts, wrong = [], []

    def one(language: str = "en", size: dict[str, int] = WIDE, **more: Any) -> Any:
        context = browser.new_context(viewport=size, locale=language, reduced_motion="reduce", **more)
        contexts.append(context)
        context.set_default_timeout(PATIENCE_MS)
        context.on("request", lambda request: wrong.append(request.url) if not _ours(request.url, server) else None)
        page = context.new_page()
        page.on("pageerror", lambda error: wrong.append(str(error)))
        page.goto(server.address)
        page.locator("main h1").first.wait_for()
        return page

    yield one
    for context in contexts:
        context.close()
    assert wrong == []


def _ours(url: str, server: Process) -> bool:
    own = server.address.partition("/#")[0]
    return url.startswith((own, own.replace("http", "ws"), "data:", "blob:"))


@pytest.fixture
def client(server: Process) -> Iterator[Client]:
    """The same server without a browser."""
    made = Client(server.address).sign_in()
    yield made
    for each in made.get("/activities")["running"]:
        made.post(f"/activities/{each['id']}/do", {"word": "end"})
    made.close()


@pytest.fixture
def play(client: Client) -> dict[str, Any]:
    """A virtual arm ten times as fast as a hand."""
    said: dict[str, Any] = client.post("/play")
    return {**said, "source": f"{said['source'].partition('?')[0]}?{FAST}"}


@pytest.fixture(scope="session")
def pictures(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where pictures of screens go, to be looked at: ULNA_PICTURES, or nowhere that lasts."""
    import os

    folder = Path(os.environ.get("ULNA_PICTURES") or tmp_path_factory.mktemp("pictures"))
    folder.mkdir(parents=True, exist_ok=True)
    return folder
