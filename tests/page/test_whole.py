"""From a virtual arm to a calibrated one through the page alone, and what it shows is what commands say."""

from __future__ import annotations

import json
import re
import signal
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.cli_runs import run
from tests.page.test_screens import check
from tests.serve.servers import FAST, Client, Process, wait_for


def begin(client: Client, play: dict[str, Any], **more: Any) -> str:
    """A session with a fast virtual arm."""
    asked = {"kind": "touch", "source": play["source"], "arm": play["arm"], "plan": play["plan"]}
    name = client.post("/activities", {**asked, "goal_mm": 0.06, "length_mm": 500.0, **more})["id"]
    return str(name)


def test_the_virtual_arm_is_played_with_at_a_click(opened: Callable[..., Any], client: Client) -> None:
    page = opened()
    page.get_by_role("button", name="Try it").click()
    page.wait_for_url("**/collect")
    page.get_by_role("button", name="Do what is asked for").click()
    page.get_by_text(re.compile("Touches: 1")).wait_for()
    check(page, "collect, at a click")


def test_from_touches_to_a_result(
    opened: Callable[..., Any], client: Client, server: Process, play: dict[str, Any], pictures: Path
) -> None:
    name = begin(client, play)
    page, base = opened(), server.address.partition("/#")[0]
    page.goto(f"{base}/collect")
    page.get_by_role("button", name="Do what is asked for").click()
    page.get_by_text(re.compile("goal .* reached|is reached|Enough")).first.wait_for()
    page.evaluate("scrollTo(0, 0)")
    page.screenshot(path=str(pictures / "collect.png"))
    check(page, "collect, at its goal")
    state = client.get(f"/activities/{name}")["state"]
    assert state["meter"]["u_length"]["text"] in page.locator("section.known").inner_text()
    page.keyboard.press("q")
    page.get_by_role("dialog").get_by_role("button", name="End").click()
    page.get_by_role("button", name=re.compile("result", re.IGNORECASE)).click()
    page.wait_for_url("**/results/*")
    page.get_by_role("heading", name="Parameters").first.wait_for()
    page.evaluate("scrollTo(0, 0)")
    page.screenshot(path=str(pictures / "results.png"))
    check(page, "results")
    sha256 = page.url.rsplit("/", 1)[1]
    shown = page.locator("main").inner_text()
    for section in client.get(f"/results/{sha256}")["sections"]:
        for block in section["blocks"]:
            for tile in block.get("tiles", []):
                assert "".join(piece["text"] for piece in tile["value"]) in shown


def test_what_is_shown_is_what_the_command_makes_of_the_same_study(
    client: Client, server: Process, play: dict[str, Any], tmp_path_factory: Any, tmp_path: Path
) -> None:
    name = begin(client, play)
    client.post(f"/activities/{name}/do", {"word": "follow", "follows": True})
    _until_reached(client, name)
    client.post(f"/activities/{name}/do", {"word": "end"})
    folder = next(tmp_path_factory.getbasetemp().glob(f"page*/bench/sessions/{name}"))
    done = run("calibrate", folder / "study.toml", "-o", tmp_path / "out")
    assert done.returncode == 0, done.stderr
    by_page, by_command = (
        json.loads(path.read_text(encoding="utf-8"))
        for path in (folder / "result" / "result.json", tmp_path / "out" / "result.json")
    )
    for key in ("parameters", "covariance", "arm", "overall", "residuals"):
        assert by_page.get(key) == by_command.get(key), key


def test_a_server_that_is_killed_is_said_and_a_session_goes_on(browser: Any, tmp_path: Path) -> None:
    server = Process(tmp_path / "bench")
    client = Client(server.address).sign_in()
    closing = [client]
    said = client.post("/play")
    play = {**said, "source": f"{said['source'].partition('?')[0]}?{FAST}"}
    name = begin(client, play)
    client.post(f"/activities/{name}/do", {"word": "follow", "follows": True})
    context = browser.new_context()
    page = context.new_page()
    page.goto(server.address)
    page.goto(f"{server.address.partition('/#')[0]}/collect")
    page.get_by_text(re.compile("Touches: [3-9]")).wait_for()
    server.end(signal.SIGKILL)
    page.get_by_text(re.compile("line to the server is lost|server does not answer")).first.wait_for()
    again = Process(tmp_path / "bench")
    try:
        page.goto(again.address)
        page.get_by_role("button", name="Go on").click()
        page.wait_for_url("**/collect")
        page.get_by_text(re.compile(r"Touches: \d+")).wait_for()
        closing.append(Client(again.address).sign_in())
        assert len(closing[-1].get(f"/activities/{name}")["state"]["touches"]) >= 3
    finally:
        for each in closing:
            each.close()
        context.close()
        again.end()


def test_two_pages_see_one_session(
    opened: Callable[..., Any], client: Client, server: Process, play: dict[str, Any]
) -> None:
    name, base = begin(client, play), server.address.partition("/#")[0]
    pages = [opened(), opened("de")]
    for page in pages:
        page.goto(f"{base}/collect")
    pages[0].get_by_role("button", name="Do what is asked for").click()
    for page, word in zip(pages, ("Touches", "Antastungen"), strict=True):
        page.get_by_text(re.compile(f"{word}: ([2-9]|[1-9][0-9])")).wait_for()
    assert client.get(f"/activities/{name}")["running"]


def test_the_keyboard_alone(opened: Callable[..., Any], client: Client, play: dict[str, Any], server: Process) -> None:
    name, base = begin(client, play, by="key"), server.address.partition("/#")[0]
    page = opened()
    page.goto(f"{base}/collect")
    page.get_by_text("Touches: 0").wait_for()
    hand = page.get_by_role("button", name="Go to the suggested posture")
    for _ in range(60):
        page.keyboard.press("Tab")
        if hand.evaluate("e => e === document.activeElement"):
            break
    else:
        raise AssertionError("no way there by the keyboard")
    page.keyboard.press("Enter")
    _still(client, name)
    page.locator("body").press("Shift+Tab")
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("Space")
    page.get_by_text("Touches: 1").wait_for()
    page.keyboard.press("w")
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("textbox").first.fill("ball not seated")
    page.keyboard.press("Enter")
    page.get_by_text("ball not seated").first.wait_for()
    assert client.get(f"/activities/{name}")["state"]["touches"][0]["withdrawn"] == "ball not seated"


def _until_reached(client: Client, name: str) -> None:
    wait_for(lambda: bool(client.get(f"/activities/{name}")["state"]["meter"]["reached"]), "the goal")


def _still(client: Client, name: str) -> None:
    time.sleep(1.0)  # ten times as fast as a hand: it is there, and has rested
    assert client.get(f"/activities/{name}")["running"]
