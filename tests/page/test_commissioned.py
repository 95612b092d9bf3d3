"""Encoders that nobody knows yet: joint by joint through the page, by keys, while somebody moves the arm."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.page.test_keys import push, reach
from tests.page.test_screens import check
from tests.serve.servers import Client, Process, wait_for
from tests.serve.test_commission import COUNTS, FAST, answerable, counting, state, turn

from ulna.arm.arm import Arm
from ulna.reproduce.cheng2011.arms import BENT_PROBE, platinum


@pytest.mark.slow
def test_an_arm_is_commissioned(
    opened: Callable[..., Any], client: Client, server: Process, tmp_path: Path, pictures: Path
) -> None:
    drawing, true = (client.bring(path) for path in counting(tmp_path))
    assert drawing != true
    page = opened()
    page.goto(f"{server.address.partition('/#')[0]}/arm")
    reach(page, page.get_by_role("radio", name="drawing.toml"))
    page.keyboard.press("Space")
    reach(page, page.get_by_label("Port, address or source file"))
    page.keyboard.type(f"virtual:{true}?{FAST}")
    page.keyboard.press("Tab")
    page.get_by_role("radio", name="as drawn").check()
    reach(page, page.get_by_label("Counts per turn"))
    page.keyboard.type(str(int(COUNTS)))
    push(page, "Find the channels")
    page.get_by_role("progressbar").or_(page.locator("progress")).first.wait_for()
    (running,) = client.get("/activities")["running"]
    name, at = running["id"], np.zeros(7)
    shown = False
    while (question := state(client, name)["question"]) is not None:
        turn(client, name, at, question)
        answerable(client, name)
        yes = page.get_by_role("button", name="That is right")
        yes.wait_for()
        if question["step"] == "turn" and not shown:
            check(page, "a joint that was turned")
            page.screenshot(path=str(pictures / "commission.png"), full_page=True)
            shown = True
        yes.press("Enter")
        _answered(client, name, question)
    push(page, "Write the files")
    page.get_by_text("The files are written").wait_for()
    push(page, "Use this arm and source")
    check(page, "a commissioned arm")
    left = {each["role"]: each["sha256"] for each in client.get(f"/activities/{name}")["left"]}
    (tmp_path / "arm.toml").write_bytes(client.ask("GET", f"/files/{left['arm']}/content").content)
    arm = Arm.load(tmp_path / "arm.toml")
    assert [joint.sign for joint in arm.joints] == [joint.sign for joint in platinum(BENT_PROBE).joints]
    assert [joint.counts_per_turn for joint in arm.joints] == [COUNTS] * 7


def _answered(client: Client, name: str, question: dict[str, Any]) -> None:
    """Once the next question stands, or none does."""
    asked = question["step"], question["joint"]

    def next_one() -> bool:
        found = state(client, name)["question"]
        return found is None or (found["step"], found["joint"]) != asked

    wait_for(next_one, "the next question")
