"""A check and a test, touched step by step by the virtual hand through the page alone."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.conftest import ROOT
from tests.page.conftest import NARROW
from tests.page.test_screens import check
from tests.serve.servers import FAST, Client, Process, wait_for

from ulna.verification.kinds.registry import KINDS


@pytest.fixture
def fast(client: Client) -> dict[str, Any]:
    """A virtual arm ten times as fast as a hand, a protocol and a test."""
    said: dict[str, Any] = client.post("/tests/play")
    return {**said, "source": f"{said['source'].partition('?')[0]}?{FAST}"}


def test_a_check_touched_to_its_end(
    opened: Callable[..., Any], client: Client, server: Process, fast: dict[str, Any], pictures: Path
) -> None:
    page, base = opened(), server.address.partition("/#")[0]
    asked = {"kind": "check", "source": fast["source"], "arm": fast["arm"], "protocol": fast["protocol"]}
    name = client.post("/activities", {**asked, "operator": "Ann"})["id"]
    page.goto(f"{base}/check")
    page.get_by_text("Touch the seat").wait_for()
    size = page.locator("section.do b").evaluate("e => parseFloat(getComputedStyle(e).fontSize)")
    assert size >= 60.0, "legible from three metres"
    page.get_by_role("button", name="Do what is asked for").click()
    page.get_by_text(re.compile("Touch end")).first.wait_for()
    page.locator("details.card button[aria-pressed=true]").click()
    page.evaluate("scrollTo(0, 0)")
    page.screenshot(path=str(pictures / "check.png"))
    check(page, "check, while it is touched")
    page.get_by_role("button", name="Do what is asked for").click()
    page.get_by_text("All is touched").first.wait_for()
    page.get_by_text("E_Uni").nth(1).wait_for()
    page.keyboard.press("w")
    page.get_by_text("8 of 9 touched").first.wait_for()
    page.get_by_text("All is touched").first.wait_for()
    page.keyboard.press("q")
    page.wait_for_url("**/check/*")
    page.get_by_text("E_Uni", exact=False).first.wait_for()
    check(page, "what a check found")
    found = client.get(f"/checks/{page.url.rsplit('/', 1)[1]}")
    assert (found["operator"], found["verdict"], found["departures"]) == ("Ann", "pass", [])
    shown = page.locator("main").inner_text()
    assert all(each["value"]["text"] in shown for each in found["figures"])
    assert not client.get(f"/activities/{name}")["running"]


def test_one_that_was_interrupted_goes_on_from_the_bench(
    opened: Callable[..., Any], client: Client, server: Process, fast: dict[str, Any]
) -> None:
    asked = {"kind": "check", "source": fast["source"], "arm": fast["arm"], "protocol": fast["protocol"]}
    name = client.post("/activities", asked)["id"]
    client.post(f"/activities/{name}/do", {"word": "follow", "follows": True})
    wait_for(lambda: client.get(f"/activities/{name}")["state"]["done"] >= 2, "two touches")
    client.post(f"/activities/{name}/do", {"word": "end"})
    page = opened("zh")
    page.goto(f"{server.address.partition('/#')[0]}/")
    page.get_by_role("button", name="继续").first.click()
    page.wait_for_url("**/check")
    page.get_by_text(re.compile(r"已触测 [2-9] / 9")).first.wait_for()
    assert client.get("/activities")["running"][0]["id"] == name


def test_the_page_has_words_for_each_kind_of_test() -> None:
    text = (ROOT / "page" / "src" / "widgets" / "steps.ts").read_text(encoding="utf-8")
    rows = text[text.index("const DO") : text.index("export function toDo")]
    assert set(re.findall(r'^\t"?([\w-]+)"?: \(', rows, re.MULTILINE)) == set(KINDS)


def test_a_test_touched_to_its_end_on_a_phone_in_german(
    opened: Callable[..., Any], client: Client, server: Process, fast: dict[str, Any], pictures: Path
) -> None:
    page, base = opened("de", NARROW), server.address.partition("/#")[0]
    asked = {"kind": "test", "source": fast["source"], "arm": fast["arm"], "test": fast["test"]}
    client.post("/activities", {**asked, "beside": fast["beside"], "state": "as-found"})
    page.goto(f"{base}/test")
    page.get_by_text("Die Kugel antasten").wait_for()
    page.get_by_text("Wie vorgefunden").wait_for()
    page.get_by_role("button", name="Tun, was verlangt wird").click()
    page.get_by_text(re.compile(r"\b([7-9]|1\d) von 18 angetastet")).first.wait_for()
    page.get_by_text("P_Size").first.wait_for()
    check(page, "test, while it is touched")
    page.screenshot(path=str(pictures / "test-touched-phone.png"), full_page=True)
    page.get_by_text("Alles ist angetastet").first.wait_for()
    page.get_by_role("button", name="Auswerten").click()
    page.wait_for_url("**/test/*")
    page.get_by_role("heading", name="Wie vorgefunden").first.wait_for()
    check(page, "what a test found")
    found = client.get(f"/verifications/{page.url.rsplit('/', 1)[1]}")
    assert [each["state"] for each in found["states"]] == ["as-found"]
    assert found["verdict"] == "pass"


def test_a_test_is_made_of_a_profile_and_begun(
    opened: Callable[..., Any], client: Client, server: Process, fast: dict[str, Any], pictures: Path
) -> None:
    page, base = opened(), server.address.partition("/#")[0]
    page.goto(f"{base}/test")
    page.get_by_role("button", name="Try it with a virtual arm").click()
    page.get_by_text("Touch the ball").wait_for()
    page.keyboard.press("q")
    page.get_by_role("dialog").get_by_role("button", name="End").click()
    page.get_by_text("The touching is over").wait_for()
    page.get_by_text("Make a test of a profile").click()
    page.get_by_role("button", name="Fill in examples").click()
    page.get_by_role("checkbox", name="tested as found").check()
    page.get_by_role("button", name="Make the test").click()
    page.get_by_text(re.compile(r"915 touches in each state")).wait_for()
    check(page, "a test is made")
    page.screenshot(path=str(pictures / "test-made.png"), full_page=True)
    page.get_by_role("button", name="Begin to touch").click()
    page.get_by_text("the arm as found comes before the arm as left").wait_for()
    page.get_by_role("radio", name=re.compile("As found")).check()
    page.get_by_role("button", name="Begin to touch").click()
    page.get_by_text("0 of 915 touched").first.wait_for()
    assert client.get("/activities")["running"][0]["state"]["state"] == "as-found"
