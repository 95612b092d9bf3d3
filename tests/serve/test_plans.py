"""Plans: stated in the page, the same as the command makes; planned, and what was found as data."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from tests.cli_runs import run
from tests.serve.servers import Client, Threaded

from ulna.arm.given import as_arm
from ulna.planning.file import load_plan_spec

HALF, FULL = [30.0, 202.0], [-180.0, 180.0]
TRAVEL = [FULL, HALF, FULL, HALF, FULL, HALF, FULL]


def asked(play: dict[str, str], artefact: dict[str, Any], **more: object) -> dict[str, Any]:
    small = {"measurements": 40, "places": 3, "trials": 0, "encoder_rad": [5e-6], "seat_mm": 0.01}
    return {"arm": play["arm"], "artefact": artefact, "travel_deg": TRAVEL, **small, **more}


@pytest.mark.parametrize(
    ("artefact", "stated"),
    [
        ({"kind": "bar", "length_mm": 443.172, "u_mm": 0.001}, "443.172 mm, u 0.001 mm"),
        ({"kind": "seat", "name": "cone"}, "–"),
        (
            {"kind": "points", "features": [{"name": n, "point_mm": [100.0 * k, 0, 0]} for k, n in enumerate("ABC")]},
            "3 features",
        ),
    ],
)
def test_a_plan_file_of_what_is_stated(
    client: Client, server: Threaded, play: dict[str, str], artefact: dict[str, Any], stated: str
) -> None:
    made = client.post("/plans", asked(play, artefact, test_length_mm=300.0))
    assert (made["kind"], made["stated"], made["file"]["kind"]) == (artefact["kind"], stated, "plan")
    assert (made["measurements"], made["places"]) == (40, 3)
    assert made["test_length"]["value"] == 300.0
    assert [list(each) for each in made["travel_deg"]] == [pytest.approx(each) for each in TRAVEL]
    assert client.get(f"/plans/{made['file']['sha256']}", arm=play["arm"]) == made
    desk = server.workshop.desk
    spec = load_plan_spec(desk.path(made["file"]["sha256"]), as_arm(desk.path(play["arm"])))
    assert spec.artefact.name == artefact.get("name", artefact["kind"])
    assert spec.seat_mm == 0.01


def test_an_artefact_of_the_record(client: Client, server: Threaded, play: dict[str, str]) -> None:
    records = server.workshop.records
    records.register("KB-1", "artefact")
    records.certify("KB-1", {"length": (500.123, 0.002)}, number="C-9", valid_to="2099-01-01")
    made = client.post("/plans", asked(play, {"record": "KB-1"}))
    assert (made["artefact"], made["kind"], made["stated"]) == ("KB-1", "bar", "500.123 mm, u 0.002 mm")
    assert "certificate C-9" in made["text"]
    records.register("KB-2", "artefact")
    records.certify("KB-2", {"length": (250.4, 0.001)}, number="C-1", valid_to="2020-01-01")
    assert "was valid to 2020-01-01" in client.refused(400, "POST", "/plans", json=asked(play, {"record": "KB-2"}))
    late = client.post("/plans", asked(play, {"record": "KB-2", "expired_because": "the new one is on its way"}))
    assert late["stated"] == "250.4 mm, u 0.001 mm"
    assert "the new one is on its way" in late["text"]
    assert "not registered" in client.refused(400, "POST", "/plans", json=asked(play, {"record": "KB-3"}))


@pytest.mark.parametrize(
    ("artefact", "more", "said"),
    [
        ({"kind": "bar"}, {}, "length"),
        ({"kind": "no-such"}, {}, "no-such"),
        ({}, {}, "Name one"),
        ({"kind": "bar", "length_mm": 400.0, "name": "a/b"}, {}, "Rename it"),
        ({"kind": "bar", "length_mm": 400.0}, {"travel_deg": [[1.0, 0.0]]}, "Turn them"),
        ({"kind": "bar", "length_mm": 400.0}, {"travel_deg": [[0.0, 1.0]] * 2}, "plan.toml"),
        ({"kind": "sphere", "diameter_mm": 25.4}, {}, "ball"),
        ({"kind": "bar", "length_mm": 400.0}, {"probe": "no-such"}, "no-such"),
        ({"kind": "bar", "length_mm": 400.0}, {"encoder_rad": [1e-6, 1e-6]}, "encoder"),
    ],
)
def test_what_cannot_be_planned_leaves_nothing(
    client: Client, play: dict[str, str], artefact: dict[str, Any], more: dict[str, Any], said: str
) -> None:
    before = client.get("/files", kind="plan")
    message = client.refused(400, "POST", "/plans", json=asked(play, artefact, **more))
    assert said in message
    assert "/tmp" not in message
    assert client.get("/files", kind="plan") == before


@pytest.mark.slow
def test_planned_as_the_command_plans(client: Client, server: Threaded, play: dict[str, str], tmp_path: Path) -> None:
    text = client.post("/plans", asked(play, {"kind": "bar", "length_mm": 443.172}))["text"]
    few = text.replace("[plan]", "[plan]\ncandidates = 3000").encode()
    plan = client.ask("POST", "/files", params={"name": "few.toml"}, content=few).json()["sha256"]
    made = client.made({"kind": "plan", "arm": play["arm"], "plan": plan, "language": "de"})
    assert set(made) == {"planned", "study", "arm", "table", "work-sheet"}
    found = client.get(f"/plans/{made['planned']}/outcome")
    desk = server.workshop.desk
    done = run("plan", desk.path(play["arm"]), desk.path(plan), "-o", tmp_path / "planned")
    assert done.returncode == 0, done.stderr
    theirs = json.loads((tmp_path / "planned" / "plan.json").read_text())
    assert [each["points_mm"] for each in found["places"]] == [each["points_mm"] for each in theirs["places"]]
    assert [each["q_deg"] for each in found["steps"]] == [
        [step[f"q{k}_deg"] for k in range(1, 8)] for step in theirs["steps"]
    ]
    assert found["expected"][-1]["planned"]["value"] == 2.0 * theirs["planned"]["u_length_mm"]
    assert found["gain"] == theirs["gain"]
    assert len(found["steps"]) == 2 * 40
    assert client.ask("GET", f"/files/{made['work-sheet']}/content").content.startswith(b"%PDF")
    assert client.get(f"/files/{made['study']}")["kind"] == "study"
    client.refused(400, "GET", f"/plans/{plan}/outcome")
