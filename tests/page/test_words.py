"""A page in another language: what the server says is said in it too, wherever somebody works."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.conftest import ROOT
from tests.page.conftest import NARROW
from tests.page.test_screens import check
from tests.page.test_whole import _until_reached, begin
from tests.serve.servers import Client, Process, wait_for
from tests.serve.test_commission import COUNTS, FAST, answerable, counting, state, turn
from tests.serve.test_guided import a_check, a_test, ready

PLATINUM = ROOT / "examples" / "platinum"
LANGUAGES = ("de", "zh")


def english(page: Any) -> list[str]:
    """What is marked as English."""
    found: list[str] = page.locator("main [lang=en]").all_inner_texts()
    return found


def looked_at(page: Any, pictures: Path, name: str) -> None:
    page.evaluate("scrollTo(0, 0)")
    page.screenshot(path=str(pictures / f"{name}.png"), full_page=True)
    check(page, name)
    assert english(page) == [], name
    assert "[object" not in page.locator("body").inner_text(), name


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_session(
    opened: Callable[..., Any],
    client: Client,
    server: Process,
    play: dict[str, Any],
    pictures: Path,
    language: str,
) -> None:
    name = begin(client, play, goal_mm=0.2)
    page, base = opened(language), server.address.partition("/#")[0]
    page.goto(f"{base}/collect")
    page.locator("section.known").wait_for()
    for word in ("touch", "touch"):
        client.post(f"/activities/{name}/do", {"word": word})
    page.locator("ul.said").wait_for()
    looked_at(page, pictures, f"said-refused-{language}")
    client.post(f"/activities/{name}/do", {"word": "follow", "follows": True})
    _until_reached(client, name)
    client.post(f"/activities/{name}/do", {"word": "withdraw", "number": 3, "reason": "7"})
    client.post(f"/activities/{name}/do", {"word": "hold-out", "places": 2})
    page.set_viewport_size(NARROW)
    looked_at(page, pictures, f"said-collect-{language}")
    client.post(f"/activities/{name}/do", {"word": "end"})


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_commissioning(
    opened: Callable[..., Any], client: Client, server: Process, tmp_path: Path, pictures: Path, language: str
) -> None:
    drawing, true = (client.bring(path) for path in counting(tmp_path))
    asked = {"kind": "commission", "source": f"virtual:{true}?{FAST}", "arm": drawing}
    name = client.post("/activities", {**asked, "counts_per_turn": COUNTS, "zeros": "posture"})["id"]
    page, base = opened(language), server.address.partition("/#")[0]
    page.goto(f"{base}/arm")
    at = np.zeros(7)
    for k in range(3):
        turn(client, name, at, state(client, name)["question"])
        answerable(client, name)
        page.get_by_role("button", name=re.compile("Das stimmt|正确")).first.wait_for()
        looked_at(page, pictures, f"said-commission-{k}-{language}")
        client.post(f"/activities/{name}/do", {"word": "answer", "answer": "yes"})
    client.post(f"/activities/{name}/do", {"word": "end"})


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_check_and_files(
    opened: Callable[..., Any], client: Client, server: Process, pictures: Path, language: str
) -> None:
    brought = {
        name: client.bring(PLATINUM / name) for name in ("protocol.toml", "truth.toml", "morning-11-11.csv", "bars.csv")
    }
    body = {"kind": "check", "protocol": brought["protocol.toml"], "beside": [brought["truth.toml"]]}
    made = client.made({**body, "readings": brought["morning-11-11.csv"]})["check"]
    page, base = opened(language), server.address.partition("/#")[0]
    page.goto(f"{base}/check/{made}")
    page.locator("table").first.wait_for()
    looked_at(page, pictures, f"said-check-{language}")
    page.goto(f"{base}/file")
    page.locator("table").first.wait_for()
    looked_at(page, pictures, f"said-file-{language}")


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("begin", [a_check, a_test], ids=["check", "test"])
def test_what_is_touched_step_by_step(
    opened: Callable[..., Any],
    client: Client,
    server: Process,
    pictures: Path,
    begin: Callable[..., dict[str, object]],
    language: str,
) -> None:
    body = begin(ready(client))
    kind, name = body["kind"], client.post("/activities", body)["id"]

    def do(word: str, **more: object) -> None:
        client.post(f"/activities/{name}/do", {"word": word, **more})

    page, base = opened(language), server.address.partition("/#")[0]
    page.goto(f"{base}/{kind}")
    page.locator("section.known").wait_for()
    do("follow", follows=True)
    wait_for(lambda: client.get(f"/activities/{name}")["state"]["done"] >= 3, "three touches")
    do("follow", follows=False)

    def refused() -> bool:
        do("touch")  # in the same pose
        return bool(client.get(f"/activities/{name}")["said"])

    wait_for(refused, "a refusal")
    page.locator("ul.said").wait_for()
    looked_at(page, pictures, f"said-{kind}-refused-{language}")
    do("follow", follows=True)
    wait_for(lambda: client.get(f"/activities/{name}")["state"]["present"] is None, "all is touched")
    page.set_viewport_size(NARROW)
    looked_at(page, pictures, f"said-{kind}-touched-{language}")
    do("end")
    page.get_by_role("heading", name=re.compile("Das Antasten ist beendet|触测已结束")).wait_for()
    looked_at(page, pictures, f"said-{kind}-over-{language}")


@pytest.mark.parametrize("language", LANGUAGES)
def test_a_test_is_made(
    opened: Callable[..., Any], client: Client, server: Process, pictures: Path, language: str
) -> None:
    page, base = opened(language), server.address.partition("/#")[0]
    page.goto(f"{base}/test")
    page.get_by_role("button", name=re.compile("Mit einem virtuellen Arm|用虚拟测量臂")).click()
    page.locator("section.known").wait_for()
    page.keyboard.press("q")
    page.get_by_role("dialog").get_by_role("button", name=re.compile("^(Beenden|结束)$")).click()
    page.get_by_text(re.compile("Eine Abnahme aus einem Profil|由规范生成检定")).click()
    page.get_by_role("button", name=re.compile("^(Abnahme machen|生成检定)")).click()
    page.locator("main .alert.warn").wait_for()
    looked_at(page, pictures, f"said-test-made-{language}")
