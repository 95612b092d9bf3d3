"""Checks and acceptance tests touched step by step: what the virtual hand touches is what the commands then find."""

from __future__ import annotations

import json
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from tests.cli_runs import run
from tests.serve.servers import FAST, Client, Process, Threaded, events

from ulna.live.by_list import touches_of
from ulna.live.ending import JOURNAL

Event = dict[str, Any]
pytestmark = pytest.mark.usefixtures("idle")


def ready(client: Client) -> dict[str, Any]:
    """A virtual arm ten times as fast as a hand, a protocol, a test."""
    said: dict[str, Any] = client.post("/tests/play")
    return {**said, "source": f"{said['source'].partition('?')[0]}?{FAST}"}


@pytest.fixture(scope="module")
def given(client: Client) -> dict[str, Any]:
    return ready(client)


def a_check(given: dict[str, Any], **more: object) -> dict[str, object]:
    asked = {"kind": "check", "source": given["source"], "arm": given["arm"], "protocol": given["protocol"]}
    return {**asked, **more}


def a_test(given: dict[str, Any], **more: object) -> dict[str, object]:
    asked = {"kind": "test", "source": given["source"], "arm": given["arm"], "test": given["test"]}
    return {**asked, "beside": given["beside"], **more}


def do(client: Client, name: str, word: str, **more: object) -> Any:
    return client.post(f"/activities/{name}/do", {"word": word, **more})


def done(count: int | None = None) -> Callable[[Event], bool]:
    """So many steps are touched; None: all."""
    return lambda event: (
        event["event"] == "state"
        and (event["state"]["present"] is None if count is None else event["state"]["done"] >= count)
    )


def played(client: Client, body: dict[str, object]) -> tuple[str, list[Event], dict[str, str]]:
    """To its end by the virtual hand: its name, what was told, and what it left by role."""
    name = str(client.post("/activities", body)["id"])
    with client.socket(name) as socket:
        do(client, name, "follow", follows=True)
        told = events(socket, done())
    left = do(client, name, "end")["left"]
    return name, told, {each["role"]: each["sha256"] for each in left}


def folder_of(server: Threaded, name: str) -> Path:
    return server.workshop.folder / "sessions" / name


@pytest.mark.parametrize("reads", ['arm = "arm.toml"', "ball = 0.0"], ids=["encoders", "points"])
def test_a_check_is_what_the_command_finds_in_the_table(
    client: Client, server: Threaded, given: dict[str, Any], tmp_path: Path, reads: str
) -> None:
    """Of a protocol that names an arm, and of one whose readings are x, y, z."""
    text = server.workshop.desk.path(given["protocol"]).read_text().replace('arm = "arm.toml"', reads)
    brought = client.ask("POST", "/files", params={"name": "before-work.toml"}, content=text.encode()).json()["sha256"]
    name, told, left = played(client, a_check({**given, "protocol": brought}, operator="Ann"))
    folder, out = folder_of(server, name), tmp_path / "check.json"
    command = run("check", folder / "before-work.toml", folder / "readings.csv", "-o", out)
    assert command.returncode == 0, command.stderr
    theirs, ours = json.loads(out.read_text()), json.loads((folder / "check.json").read_text())
    for key in ("figures", "verdict", "departures", "arm", "decision"):
        assert ours[key] == theirs[key], key
    assert (ours["operator"], ours["departures"]) == ("Ann", [])
    assert [each["sha256"] for each in ours["provenance"]["files"]] == [left["readings"]]
    found = client.get(f"/checks/{left['check']}")
    assert [each["value"]["value"] for each in found["figures"]] == [each["value"] for each in theirs["figures"]]
    state = told[-1]["state"]
    fallen = [each for part in state["parts"] for each in part["figures"]] + state["overall"]
    assert sorted((each["key"], each["value"]["value"], each["verdict"]) for each in fallen) == sorted(
        (each["key"], each["value"], each["verdict"]) for each in theirs["figures"]
    )
    assert name not in {each["id"] for each in client.get("/activities")["unfinished"]}


def test_steps_come_in_order_and_values_as_soon_as_they_are_known(client: Client, given: dict[str, Any]) -> None:
    _, told, _ = played(client, a_check(given))
    states = [event["state"] for event in told if event["event"] == "state"]
    by_done = {state["done"]: state for state in states}
    asked = [by_done[k]["present"] for k in range(9)]
    assert [(each["test"], each["position"], each["feature"], each["now"], each["all"]) for each in asked] == [
        *(("seat", "1", "", k, 5) for k in range(1, 6)),
        *(("bar", place, end, 1, 1) for place in "12" for end in "AB"),
    ]
    keys = {k: [each["key"] for part in state["parts"] for each in part["figures"]] for k, state in by_done.items()}
    assert [keys[1], keys[2], keys[6], keys[7]] == [
        [], ["SPAT_max", "SPAT_2S"], ["SPAT_max", "SPAT_2S"], ["SPAT_max", "SPAT_2S", "E_Uni"],
    ]  # fmt: skip
    scatter = [state["touches"][-1]["scatter"] for k, state in sorted(by_done.items()) if k]
    assert scatter[0] is None
    assert all(each["value"] > 0.0 for each in scatter[1:5])
    second = [event["sentences"][1] for event in told if event.get("touch", {}).get("number") == 2]
    assert all("Scatter in its seat" in each["text"] for each in second)
    said = [event["sentence"]["text"] for event in told if event["event"] == "said"]
    assert any(line.startswith("SPAT_max") and line.endswith("of 0.0600 mm: pass.") for line in said)


def test_an_arm_as_found_then_as_left(client: Client, server: Threaded, given: dict[str, Any], tmp_path: Path) -> None:
    text = server.workshop.desk.path(given["test"]).read_text()
    both = text.replace(
        'file = "as-left.csv"\n', 'file = "as-found.csv"\nstate = "as-found"\n\n[[readings]]\nfile = "as-left.csv"\n'
    )
    listed = client.ask("POST", "/files", params={"name": "both.toml"}, content=both.encode()).json()["sha256"]
    early = client.refused(400, "POST", "/activities", json=a_test({**given, "test": listed}, state="as-left"))
    assert "the arm as found comes before the arm as left, and is not touched yet" in early
    first, told, left = played(client, a_test({**given, "test": listed}, state="as-found"))
    assert told[-1]["state"]["state"] == "as-found"
    again = {**given, "test": left["test"], "beside": []}
    second, told, last = played(client, a_test(again, state="as-left"))
    assert told[-1]["state"]["steps"] == 18
    late = client.refused(400, "POST", "/activities", json=a_test({**again, "test": last["test"]}, state="as-found"))
    assert "which is touched already" in late
    for name, states in ((first, ["as-found"]), (second, ["as-found", "as-left"])):
        folder = folder_of(server, name)
        command = run("verify", folder / "test.toml", "-o", tmp_path / name)
        assert command.returncode == 0, command.stderr
        theirs = json.loads((tmp_path / name / "verification.json").read_text())
        ours = json.loads((folder / "verification" / "verification.json").read_text())
        assert [each["state"] for each in ours["states"]] == states
        assert (ours["states"], ours["verdict"]) == (theirs["states"], theirs["verdict"])
    found = client.get(f"/verifications/{last['verification']}")
    assert [each["state"] for each in found["states"]] == ["as-found", "as-left"]
    fallen = {(each["key"], each["value"]["value"]) for part in told[-1]["state"]["parts"] for each in part["figures"]}
    singles = {
        (figure["key"], one["value"])
        for test in ours["states"][1]["tests"]
        for figure in test["figures"]
        for one in figure.get("individual") or [figure]
    }
    assert fallen == singles
    before = set((server.workshop.folder / "sessions").iterdir())
    assert {first, second} <= {each.name for each in before}, "a refusal leaves no folder"


def test_a_touch_is_taken_back_and_its_step_asked_for_again(
    client: Client, server: Threaded, given: dict[str, Any]
) -> None:
    name = str(client.post("/activities", a_check(given))["id"])
    nothing = client.refused(409, "POST", f"/activities/{name}/do", json={"word": "take-back"})
    assert "nothing is touched" in nothing
    client.refused(409, "POST", f"/activities/{name}/do", json={"word": "moved"})
    client.refused(409, "POST", "/activities", json=a_check(given))
    with client.socket(name) as socket:
        do(client, name, "follow", follows=True)
        events(socket, done(7))
        do(client, name, "follow", follows=False)
        state = do(client, name, "take-back")["state"]
        last = max(each["number"] for each in state["touches"])
        assert [each["number"] for each in state["touches"] if each["withdrawn"] is not None] == [last]
        step = next(each["step"] for each in state["touches"] if each["number"] == last)
        assert state["present"]["number"] == step
        do(client, name, "withdraw", number=2, reason="slipped")
        state = client.get(f"/activities/{name}")["state"]
        assert (state["present"]["number"], state["present"]["now"]) == (2, 2)
        do(client, name, "follow", follows=True)
        events(socket, done())
    ended = do(client, name, "end")
    assert "check" in {each["role"] for each in ended["left"]}
    touches, steps = touches_of(folder_of(server, name) / JOURNAL)
    assert {each.number: each.withdrawn for each in touches}[2] == "slipped"
    counting = [steps[each.number] for each in touches if each.withdrawn is None]
    assert sorted(counting) == list(range(9))


def test_one_that_ends_early_is_written_and_goes_on(client: Client, server: Threaded, given: dict[str, Any]) -> None:
    name = str(client.post("/activities", a_check(given))["id"])
    with client.socket(name) as socket:
        do(client, name, "follow", follows=True)
        events(socket, done(3))
    ended = do(client, name, "end")
    assert [each["role"] for each in ended["left"]] == ["readings", "journal"]
    assert "of 9 are touched" in ended["said"][-1]["text"]
    (unfinished,) = [each for each in client.get("/activities")["unfinished"] if each["id"] == name]
    assert (unfinished["kind"], unfinished["plan"]) == ("check", given["protocol"])
    client.refused(404, "POST", "/activities", json=a_test(given, go_on=name))
    _, told, left = played(client, a_check(given, go_on=name))
    assert told[0]["event"] == "hello"
    assert told[0]["activity"]["state"]["done"] >= 3
    assert "check" in left


def test_killed_in_the_middle_it_goes_on(tmp_path: Path) -> None:
    first = Process(tmp_path / "bench")
    client = Client(first.address).sign_in()
    given = ready(client)
    name = str(client.post("/activities", a_test(given, state="as-left"))["id"])
    with client.socket(name) as socket:
        do(client, name, "follow", follows=True)
        told = events(socket, done(8))
    first.end(signal.SIGKILL)
    client.close()
    taken = [event["touch"] for event in told if event["event"] == "touch"]

    again = Process(tmp_path / "bench")
    client = Client(again.address).sign_in()
    try:
        (unfinished,) = client.get("/activities")["unfinished"]
        assert (unfinished["id"], unfinished["kind"]) == (name, "test")
        assert unfinished["touches"] >= len(taken) == 8
        body = {"kind": "test", "source": given["source"], "arm": given["arm"], "test": given["test"], "go_on": name}
        going = client.post("/activities", body)
        for one, other in zip(taken, going["state"]["touches"], strict=False):
            assert [one[key] for key in ("number", "feature", "place", "spread")] == [
                other[key] for key in ("number", "feature", "place", "spread")
            ]
        assert going["state"]["parts"][0]["figures"], "values that were known are known again"
        with client.socket(name) as socket:
            do(client, name, "follow", follows=True)
            told = events(socket, done())
        assert not [each for each in told if each["event"] == "refused"], "everything stands where it stood"
        left = {each["role"]: each["sha256"] for each in do(client, name, "end")["left"]}
        folder = tmp_path / "bench" / "sessions" / name
        command = run("verify", folder / "test.toml", "-o", tmp_path / "out")
        assert command.returncode == 0, command.stderr
        theirs = json.loads((tmp_path / "out" / "verification.json").read_text())
        assert client.get(f"/verifications/{left['verification']}")["verdict"] == theirs["verdict"] == "pass"
        assert name not in {each["id"] for each in client.get("/activities")["unfinished"]}
    finally:
        client.close()
        again.end()


def test_what_lacks_is_said_before_anything_is_touched(client: Client, server: Threaded, given: dict[str, Any]) -> None:
    sessions = server.workshop.folder / "sessions"
    before = set(sessions.iterdir())
    made = client.post("/tests", {"profile": "iso-10360-12", "arm": given["arm"]})
    assert made["touches"] == 915
    assert len(made["lacks"]) == 11
    bare = a_test({**given, "test": made["test"], "beside": []})
    assert "key 'artefact.ball.diameter' is missing" in client.refused(400, "POST", "/activities", json=bare)

    def protocol(old: str, new: str) -> dict[str, object]:
        text = server.workshop.desk.path(given["protocol"]).read_text()
        assert old in text
        changed = client.ask("POST", "/files", params={"name": "p.toml"}, content=text.replace(old, new).encode())
        return a_check({**given, "protocol": changed.json()["sha256"]})

    for old, new, said in (
        ("SPAT_max = 0.060", "SPAT_mox = 0.060", "no test of profile 'before work' gives it"),
        ('rule = "simple"', 'rule = "rU"', "key 'decision.r' is missing"),
        ("lengths = 1", "lengths = 2", "2 artefacts of kind 'length' are to be touched"),
        ("[fixture]", '[readings]\nsheet = "S"\n[fixture]', "key 'readings.sheet'"),
        ("[fixture]", '[readings]\nangle = "counts"\n[fixture]', "counts_per_turn"),
        ("[fixture]", '[readings]\nprobe = "stylus"\n[fixture]', "stylus"),
    ):
        assert said in client.refused(400, "POST", "/activities", json=protocol(old, new))
    assert set(sessions.iterdir()) == before
    assert client.get("/activities")["running"] == []


def test_what_a_profile_asks_for_makes_a_plan_that_can_be_touched(client: Client, given: dict[str, Any]) -> None:
    names = [each["name"] for each in client.get("/tests/profiles")["profiles"]]
    assert names == ["asme-b89-4-22", "iso-10360-12", "vdi-2617-9"]
    for profile in [*names, given["beside"][0]]:
        wants = client.get("/tests/wants", profile=profile, arm=given["arm"])
        made = client.post(
            "/tests",
            {
                "profile": profile,
                "arm": given["arm"],
                "as_found": True,
                "limits": [
                    {"figure": each["figure"], "a_mm": each["a_mm"], "b": each["b"]}
                    for each in wants["limits"]
                    if each["a_mm"] is not None
                ],
                "artefacts": [{key: each[key] for key in each if key != "kind"} for each in wants["artefacts"]],
                "temperature_c": 20.4,
                "u_temperature_k": 0.1,
                "fixture_mm": 0.001,
            },
        )
        assert made["lacks"] == []
        begun = client.post(
            "/activities", a_test({**given, "test": made["test"], "beside": made["beside"]}, state="as-found")
        )
        assert begun["state"]["steps"] == wants["touches"] == made["touches"]
        assert "Pass where" in begun["state"]["decision"]["text"]
        do(client, begun["id"], "end")
    wrong = {
        "profile": "iso-10360-12",
        "arm": given["arm"],
        "artefacts": [{"name": "bell", "size_mm": 1.0, "u_mm": 0.0}],
    }
    assert "Did you mean 'ball'" in client.refused(400, "POST", "/tests", json=wrong)
    assert "none that comes with Ulna" in client.refused(400, "POST", "/tests", json={**wrong, "profile": "iso"})


def test_a_history_names_places_and_judges(client: Client, server: Threaded, given: dict[str, Any]) -> None:
    """Places are called as in the newest check of the record."""
    client.post("/records/equipment", {"name": "V1", "kind": "arm"})
    text = server.workshop.desk.path(given["protocol"]).read_text().replace("before work", "with a history")
    brought = client.ask("POST", "/files", params={"name": "h.toml"}, content=text.encode()).json()["sha256"]
    own = {**given, "protocol": brought}
    name, _, _ = played(client, a_check(own, of="V1"))
    table = (folder_of(server, name) / "readings.csv").read_text().replace("bar,bar,1,", "bar,bar,left,")
    readings = client.ask("POST", "/files", params={"name": "left.csv"}, content=table.encode()).json()["sha256"]
    job = {"kind": "check", "protocol": brought, "arm": given["arm"], "readings": readings, "of": "V1"}
    filed = client.made(job)["check"]
    client.post("/records/add", {"files": [filed], "arm": "V1"})
    _, told, left = played(client, a_check({**own, "source": f"{given['source']}&seed=5"}, of="V1"))
    places = [part["position"] for part in told[-1]["state"]["parts"] if part["test"] == "bar"]
    assert places == ["left", "2"]
    found = client.get(f"/checks/{left['check']}")
    assert all(each["history"]["text"].startswith("too few: 1 ") for each in found["figures"])
