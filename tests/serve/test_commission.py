"""An arm commissioned through the API alone: somebody does what is asked for, joint by joint."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from tests.serve.servers import PATIENCE_S, Client

from ulna.arm.arm import Arm
from ulna.live.source_file import load_source
from ulna.reproduce.cheng2011.arms import BENT_PROBE, platinum

COUNTS = 65536.0
FAST = "moves=told&noise=1e-5&rate=200&hand=10&speed=10&rest=0&unit=counts"
LIMITS_RAD = (-2.0, 2.0)


def counting(tmp_path: Path) -> tuple[Path, Path]:
    """A drawing, and the same arm as it is: encoders that count, and stops."""
    drawing = platinum(BENT_PROBE)
    drawing.save(tmp_path / "drawing.toml")
    joints = [replace(joint, counts_per_turn=COUNTS, limits_rad=LIMITS_RAD) for joint in drawing.joints]
    replace(drawing, joints=tuple(joints)).save(tmp_path / "true.toml")
    return tmp_path / "drawing.toml", tmp_path / "true.toml"


def test_joint_by_joint(client: Client, idle: None, tmp_path: Path) -> None:
    drawing, true = (client.bring(path) for path in counting(tmp_path))
    asked = {"kind": "commission", "source": f"virtual:{true}?{FAST}", "arm": drawing, "zeros": "known"}
    name = client.post("/activities", {**asked, "counts_per_turn": COUNTS})["id"]
    at = np.zeros(7)
    asked_for = []
    while (question := state(client, name)["question"]) is not None:
        asked_for.append((question["step"], question["joint"]))
        turn(client, name, at, question)
        found = answerable(client, name)
        assert "yes" in found["answers"], found
        client.post(f"/activities/{name}/do", {"word": "answer", "answer": "yes"})
    assert asked_for[:8] == [("hold", None), *(("turn", k + 1) for k in range(7))]
    ended = client.post(f"/activities/{name}/do", {"word": "end"})
    left = {each["role"]: client.ask("GET", f"/files/{each['sha256']}/content").content for each in ended["left"]}
    assert set(left) == {"arm", "source", "noise", "plan"}, ended["said"]
    (tmp_path / "arm.toml").write_bytes(left["arm"])
    (tmp_path / "source.toml").write_bytes(left["source"])
    arm = Arm.load(tmp_path / "arm.toml")
    assert [joint.sign for joint in arm.joints] == [joint.sign for joint in platinum(BENT_PROBE).joints]
    assert [joint.counts_per_turn for joint in arm.joints] == [COUNTS] * 7
    low, high = np.array([joint.limits_rad for joint in arm.joints]).T
    np.testing.assert_allclose(high - low, LIMITS_RAD[1] - LIMITS_RAD[0], atol=0.02)
    # counts in a turn do not say in which turn a joint is
    np.testing.assert_allclose(np.remainder(low - LIMITS_RAD[0] + 1.0, 2.0 * np.pi), 1.0, atol=0.02)
    assert load_source(tmp_path / "source.toml").file.map.channels == [f"q{k + 1}" for k in range(7)]


def turn(client: Client, name: str, at: np.ndarray, question: dict[str, Any]) -> None:
    """What is asked for, as a hand does it."""
    joint = None if question["joint"] is None else question["joint"] - 1
    ways = {"hold": [], "turn": [*np.degrees(LIMITS_RAD), 0.0], "way": [30.0]}[question["step"]]
    postures = []
    for degrees in ways:
        assert joint is not None
        at[joint] = degrees
        postures.append(at.tolist())
    if postures:
        go = {"word": "go", "q_deg": postures[0], "then_deg": postures[1:]}
        client.post(f"/activities/{name}/do", go)


def state(client: Client, name: str) -> dict[str, Any]:
    found: dict[str, Any] = client.get(f"/activities/{name}")["state"]
    return found


def answerable(client: Client, name: str) -> dict[str, Any]:
    """The question, once it has an answer."""
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        question: dict[str, Any] | None = state(client, name)["question"]
        assert question is not None
        if question["answers"]:
            return question
        time.sleep(0.05)
    raise AssertionError(state(client, name))
