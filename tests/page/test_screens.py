"""Every screen, wide and narrow, light and dark, in each language: nothing overflows, axe finds nothing."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.conftest import ROOT
from tests.page.conftest import AXE, NARROW, WIDE
from tests.real_parts import lacking
from tests.serve.servers import Client, Process

SCREENS = re.findall(r'path: "(/[^"]*)"', (ROOT / "page" / "src" / "screens.ts").read_text(encoding="utf-8"))
LOOKS = {
    "wide": ("en", WIDE, "light"),
    "dark": ("en", WIDE, "dark"),
    "phone": ("en", NARROW, "light"),
    "german": ("de", NARROW, "light"),
    "chinese": ("zh", NARROW, "dark"),
}
OVERFLOWS = """() => [...document.querySelectorAll("body *")].filter(e => {
    const style = getComputedStyle(e), box = e.getBoundingClientRect();
    if (!box.width || style.visibility === "hidden" || style.position === "absolute" && box.width <= 1) return false;
    if (e.closest(".hidden, svg, canvas, dialog:not([open])")) return false;
    for (let up = e.parentElement; up; up = up.parentElement)
        if (/auto|scroll/.test(getComputedStyle(up).overflowX)) return false;
    return box.right > document.documentElement.clientWidth + 1
        || style.overflowX === "hidden" && e.scrollWidth > e.clientWidth + 1 && style.textOverflow !== "ellipsis";
}).map(e => `${e.tagName.toLowerCase()}.${e.className}: ${e.textContent.trim().slice(0, 60)}`)"""


def test_there_is_a_screen() -> None:
    assert "/" in SCREENS
    assert "/collect" in SCREENS


def test_licences_of_what_is_shipped_are_listed(client: Client) -> None:
    said = client.http.get("/licences.txt").text
    for name in ("svelte", "three", "uplot", "openapi-fetch"):
        assert re.search(rf"^{name} \d[\d.]*: (MIT|ISC)$", said, re.MULTILINE)


@pytest.mark.parametrize("look", LOOKS)
def test_every_screen(opened: Callable[..., Any], server: Process, pictures: Path, look: str) -> None:
    if not AXE.is_file():
        lacking("axe-core (npm ci in page/)")
    language, size, scheme = LOOKS[look]
    page, base = opened(language, size, color_scheme=scheme), server.address.partition("/#")[0]
    for screen in SCREENS:
        page.goto(base + screen)
        page.locator("main h1").first.wait_for(state="attached")
        page.wait_for_load_state("networkidle")
        name = screen.strip("/").replace("/", "-") or "bench"
        page.screenshot(path=str(pictures / f"{name}-{look}.png"), full_page=True)
        check(page, f"{screen} {look}")


def check(page: Any, where: str) -> None:
    """What holds of every screen in every state."""
    assert page.evaluate(OVERFLOWS) == [], where
    assert "[object Object]" not in page.locator("body").inner_text(), where  # a sentence that nobody said
    assert page.evaluate("document.documentElement.lang") in ("en", "de", "zh")
    # the policy lets no script in from outside the page; the test's own is no part of it
    found = page.evaluate(f"{AXE.read_text(encoding='utf-8')}; axe.run(document)")
    wrong = {each["id"]: [node["html"][:120] for node in each["nodes"]] for each in found["violations"]}
    assert wrong == {}, f"{where}: {json.dumps(wrong, indent=1)}"
