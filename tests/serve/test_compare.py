"""What has moved, as `ulna compare` finds it."""

from __future__ import annotations

import json

import pytest
from tests.cli_runs import run
from tests.serve.conftest import begin_touch
from tests.serve.servers import Client, Threaded, events


@pytest.fixture(scope="module")
def later(client: Client, play: dict[str, str], touched: dict[str, str]) -> str:
    """Another calibration of the same arm, with other readings."""
    source = f"{play['source']}&seed=7"
    begun = client.post("/activities", begin_touch({**play, "source": source}))
    with client.socket(begun["id"]) as socket:
        client.post(f"/activities/{begun['id']}/do", {"word": "follow", "follows": True})
        events(socket, lambda event: event["event"] == "known" and event["meter"]["reached"])
    ended = client.post(f"/activities/{begun['id']}/do", {"word": "end"})
    return next(each["sha256"] for each in ended["left"] if each["role"] == "result")


def test_the_same_as_the_command_says(client: Client, server: Threaded, touched: dict[str, str], later: str) -> None:
    results = [touched["result"], later]
    (step,) = client.post("/compare", {"results": results, "language": "de"})["steps"]
    done = run("compare", *(server.workshop.desk.path(each) for each in results), "--json")
    (theirs,) = json.loads(done.stdout)["steps"]
    assert done.returncode == int(step["moved"])
    for key in ("moved", "p_value", "p_of_largest", "chi2", "rank", "not_determined"):
        assert step[key] == theirs[key]
    assert [each["largest"]["value"] for each in step["bands"]] == [each["largest_mm"] for each in theirs["bands"]]
    assert [(each["name"], each["change"]["value"]) for each in step["parameters"]] == [
        (each["name"], each["delta"]) for each in theirs["parameters"]
    ]
    assert results[0][:8] in step["before"]
    assert [each["block"] for each in step["blocks"]].count("table") == 2
    assert "Unsicherheit" in json.dumps(step["blocks"])


def test_the_last_of_an_arm_of_the_record(client: Client, touched: dict[str, str], later: str) -> None:
    files = [touched["result"], later]
    (first, _) = client.post("/records/add", {"files": files, "register_arm": True})["filed"]
    (step,) = client.post("/compare", {"arm": first["arm"]})["steps"]
    (own,) = client.post("/compare", {"results": files})["steps"]
    assert step["chi2"] == own["chi2"]


def test_what_cannot_be_compared(client: Client, play: dict[str, str], touched: dict[str, str]) -> None:
    for body in ({}, {"results": [touched["result"]] * 2, "arm": "x"}):
        assert "Name one" in client.refused(400, "POST", "/compare", json=body)
    assert "expected 2 to 6" in client.refused(400, "POST", "/compare", json={"results": [touched["result"]]})
    client.refused(400, "POST", "/compare", json={"results": [touched["result"], play["arm"]]})
    client.refused(400, "POST", "/compare", json={"results": [touched["result"]] * 2, "probe": "no-such"})
    assert "not registered" in client.refused(400, "POST", "/compare", json={"arm": "no-such"})
