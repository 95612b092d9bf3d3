"""The whole way by keys alone: a virtual arm touched, calibrated, filed, certified; no mouse and no pedal."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest
from tests.conftest import ROOT
from tests.page.test_whole import begin
from tests.serve.servers import Client

LABORATORY = ROOT / "examples" / "platinum" / "laboratory.toml"
MOST_TABS = 150


def reach(page: Any, target: Any) -> None:
    """By Tab, as somebody without a mouse does: to what the locator means, or nowhere."""
    target.first.wait_for()
    for _ in range(MOST_TABS):
        if target.first.evaluate("element => element === document.activeElement"):
            return
        page.keyboard.press("Tab")
    raise AssertionError(f"{target} is not reached by Tab")


def push(page: Any, name: str | re.Pattern[str], role: str = "button") -> None:
    """A button or a link, by Tab and Enter."""
    reach(page, page.get_by_role(role, name=name))
    page.keyboard.press("Enter")


@pytest.mark.slow
def test_from_a_virtual_arm_to_a_certificate_by_keys_alone(
    opened: Callable[..., Any], client: Client, play: dict[str, Any]
) -> None:
    client.bring(LABORATORY)
    begin(client, play)
    page = opened()
    push(page, "Collect", "link")
    page.wait_for_url("**/collect")
    push(page, "Do what is asked for")
    page.get_by_text(re.compile(r"Touches: ([3-9]|\d\d)")).wait_for()
    push(page, re.compile("stop"))  # else it could be at its goal before the touch is withdrawn
    page.keyboard.press("w")  # the last touch shall not count: why is asked for, and typed
    page.get_by_role("dialog").get_by_role("textbox").wait_for()
    page.keyboard.type("the ball was not seated")
    page.keyboard.press("Enter")
    page.get_by_role("dialog").wait_for(state="detached")
    push(page, "Do what is asked for")
    page.get_by_text(re.compile("goal .* reached|is reached|Enough")).first.wait_for()
    page.keyboard.press("q")
    reach(page, page.get_by_role("dialog").get_by_role("button", name="End"))
    page.keyboard.press("Enter")
    push(page, re.compile("result", re.IGNORECASE))
    page.wait_for_url("**/results/*")
    arm = client.get(f"/results/{page.url.rsplit('/', 1)[1]}")["arm"]
    push(page, "File in the record")
    page.get_by_text(re.compile("Filed in the record")).first.wait_for()
    push(page, "Certificate", "link")
    page.wait_for_url("**/certificate")
    reach(page, page.get_by_label("Arm", exact=True))
    page.keyboard.type(arm)
    page.keyboard.press("Enter")
    reach(page, page.get_by_role("radio", name=re.compile("laboratory.toml")))
    page.keyboard.press("Space")
    push(page, "Issue a certificate")
    page.get_by_text(re.compile("is issued")).wait_for()
    assert arm in {each["arm"] for each in client.get("/records/certificates")["certificates"]}
