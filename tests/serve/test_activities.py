"""What is done with a stream: a virtual arm in the hand of the server, and what becomes of it."""

from __future__ import annotations

import json
import signal
import time
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from tests.cli_runs import run
from tests.serve.conftest import begin_touch
from tests.serve.servers import FAST, PATIENCE_S, Client, Process, Threaded, events, wait_for
from websockets.exceptions import ConnectionClosed

from ulna.arm.given import as_arm
from ulna.calibration.result import Result
from ulna.live.ending import JOURNAL, touches_in
from ulna.serve.contract.live import SaidEvent
from ulna.serve.hub import MOST_WAITING

Event = dict[str, Any]


def begun(client: Client, body: dict[str, object]) -> str:
    return str(client.post("/activities", body)["id"])


def do(client: Client, name: str, word: str, **more: object) -> Any:
    return client.post(f"/activities/{name}/do", {"word": word, **more})


def said(event: Event) -> str:
    return str(event.get("sentence", {"text": ""})["text"])


def touches(count: int) -> Any:
    return lambda event: event["event"] == "known" and event["meter"]["touches"] >= count


def test_a_session_leaves_what_ulna_calibrate_finds(
    client: Client, server: Threaded, touched: dict[str, str], tmp_path: Path
) -> None:
    study = server.workshop.desk.path(touched["study"])
    done = run("calibrate", study, "-o", tmp_path / "again")
    assert done.returncode == 0, done.stderr
    ours, theirs = Result.load(server.workshop.desk.path(touched["result"])), Result.load(tmp_path / "again")
    assert ours.arm.core.parameters.tolist() == theirs.arm.core.parameters.tolist()
    said = {each["name"]: each["value"]["value"] for each in client.get(f"/arms/{touched['result']}")["parameters"]}
    assert said == dict(zip(theirs.arm.parameter_names, theirs.arm.core.parameters.tolist(), strict=True))
    uncertainty = theirs.arm.uncertainty
    assert uncertainty is not None
    u = {each["name"]: each["value"]["u"] for each in client.get(f"/arms/{touched['result']}")["parameters"]}
    for k, name in enumerate(uncertainty.names):
        assert u[name] == pytest.approx(float(uncertainty.matrix[k, k]) ** 0.5, rel=1e-15)
    whole = client.get(f"/results/{touched['result']}", language="de")
    assert whole["converged"]
    assert "Zusammenfassung" in {each["title"] for each in whole["sections"]}
    off = [each["off"]["value"] for each in whole["residuals"]]
    assert off == sorted(ours.residuals["norm_mm"].to_list(), reverse=True)


def test_what_is_known_is_what_the_session_knows(
    client: Client, server: Threaded, touched: dict[str, str], play: dict[str, str]
) -> None:
    """The same touches in a Session of this process, with nothing of a server around it."""
    from ulna.live.purpose import purpose_of
    from ulna.live.registry import open_source
    from ulna.live.said import length_said
    from ulna.live.session import Session
    from ulna.live.stream import Stream
    from ulna.serve.activities.opened import stated_source
    from ulna.serve.sources import allow_all

    desk = server.workshop.desk
    arm = as_arm(desk.path(play["arm"]))
    purpose = purpose_of(desk.path(play["plan"]), arm, None, 500.0)
    stated = stated_source(desk, play["source"], allow_all)
    source = open_source(stated)
    session = Session(arm, purpose.spec, Stream(source, stated, True), fit=purpose.fit, goal_u_mm=0.03)
    session.go_on(touches_in(server.workshop.folder / "sessions" / touched["id"] / JOURNAL), None)
    meter, said = session.meter(), client.get(f"/activities/{touched['id']}")["state"]["meter"]
    source.close()
    assert said["u_length"]["value"] == pytest.approx(2.0 * meter.worth.u_mm, rel=1e-5)  # the fit began elsewhere
    assert f"{said['u_length']['text']} {said['u_length']['unit']}" == length_said(said["u_length"]["value"])
    assert (said["touches"], said["determined"]) == (meter.so_far.touches, meter.determinable)
    assert said["reached"]


def test_killed_in_mid_session_nothing_is_lost(tmp_path: Path) -> None:
    first = Process(tmp_path / "bench")
    client = Client(first.address).sign_in()
    play = client.post("/play")
    play["source"] = f"{play['source'].partition('?')[0]}?{FAST}"
    name = begun(client, begin_touch(play))
    with client.socket(name) as socket:
        do(client, name, "follow", follows=True)
        told = events(socket, touches(5))
    first.end(signal.SIGKILL)
    client.close()
    said = [event["touch"] for event in told if event["event"] == "touch"]

    again = Process(tmp_path / "bench")
    client = Client(again.address).sign_in()
    try:
        (unfinished,) = client.get("/activities")["unfinished"]
        assert (unfinished["id"], unfinished["kind"]) == (name, "touch")
        assert unfinished["touches"] >= len(said) == 5
        assert client.get("/bench")["unfinished"] == [unfinished]
        asked = {key: unfinished[key] for key in ("source", "arm", "plan")}
        going = client.post("/activities", begin_touch(asked, go_on=name))
        assert going["id"] == name
        there = going["state"]["touches"]
        for one, other in zip(said, there, strict=False):
            assert [one[key] for key in ("number", "feature", "place", "spread")] == [
                other[key] for key in ("number", "feature", "place", "spread")
            ]
        assert going["state"]["meter"]["touches"] == unfinished["touches"]
        assert client.get("/activities")["unfinished"] == []
        with client.socket(name) as socket:
            do(client, name, "follow", follows=True)
            events(socket, lambda event: event["event"] == "known" and event["meter"]["reached"])
        left = {each["role"]: each["sha256"] for each in do(client, name, "end")["left"]}
        assert client.get(f"/results/{left['result']}")["converged"]
        assert client.get("/activities")["unfinished"] == []
        client.refused(404, "POST", "/activities", json=begin_touch(asked, go_on=name))
    finally:
        client.close()
        again.end()


@pytest.mark.usefixtures("idle")
def test_two_who_look_see_the_same(client: Client, play: dict[str, str]) -> None:
    name = begun(client, begin_touch(play))
    over = lambda event: event["event"] == "ended"  # noqa: E731
    with client.socket(name) as one, client.socket(name) as other:
        hello = [json.loads(each.recv(timeout=PATIENCE_S)) for each in (one, other)]
        assert [each["event"] for each in hello] == ["hello", "hello"]
        assert hello[0]["contract"] == client.get("/about")["contract"]
        do(client, name, "follow", follows=True)
        wait_for(lambda: bool(client.get(f"/activities/{name}")["state"]["touches"]), "a touch")
        do(client, name, "end")
        first, second = events(one, over), events(other, over)
    words = [[each for each in told if each["event"] not in ("stream", "hello")] for told in (first, second)]
    assert words[0] == words[1]
    assert {"touch", "known", "ended"} <= {each["event"] for each in words[0]}
    with client.socket(name) as late:
        assert json.loads(late.recv(timeout=PATIENCE_S))["activity"]["running"] is False


@pytest.mark.usefixtures("idle")
def test_who_does_not_read_is_let_go_and_others_go_on(client: Client, server: Threaded, play: dict[str, str]) -> None:
    name = begun(client, {"kind": "watch", "source": play["source"], "arm": play["arm"]})
    hub = server.workshop.hub
    sentence, batch = "x" * 4000, 200
    with client.socket(name, compression=None) as good, client.socket(name, compression=None) as idler:
        wait_for(lambda: len(hub._those(name)) == 2, "both are there")
        told = 0
        while len(hub._those(name)) == 2:
            for _ in range(batch):
                told += 1
                hub.tell(SaidEvent(sentence=f"{told} {sentence}"[:4000]), name)
            wanted = f"{told} "
            events(good, lambda event: said(event).startswith(wanted))  # noqa: B023
            assert told < 40 * MOST_WAITING, "nobody let it go"
        heard = 0
        with suppress(ConnectionClosed):
            while heard <= told:
                heard += isinstance(idler.recv(timeout=PATIENCE_S), str)
        assert heard < told
        hub.tell(SaidEvent(sentence="still there"), name)
        assert events(good, lambda event: said(event) == "still there")
        assert len(hub._those(name)) == 1


@pytest.mark.usefixtures("idle")
def test_words_of_a_session(client: Client, play: dict[str, str]) -> None:
    name = begun(client, begin_touch(play, by="key"))
    assert "still going on" in client.refused(409, "POST", "/activities", json=begin_touch(play))
    client.refused(409, "POST", f"/activities/{name}/do", json={"word": "feature", "kind": "ball"})
    client.refused(400, "POST", f"/activities/{name}/do", json={"word": "go", "q_deg": [1.0]})
    client.refused(400, "POST", f"/activities/{name}/do", json={"word": "withdraw", "number": 7, "reason": "no"})
    client.refused(422, "POST", f"/activities/{name}/do", json={"word": "no-such"})
    client.refused(404, "POST", "/activities/no-such/do", json={"word": "touch"})
    with client.socket(name) as socket:
        state = client.get(f"/activities/{name}")["state"]
        do(client, name, "go", q_deg=state["next"]["q_deg"])
        for _ in range(100):
            do(client, name, "touch")
            told = events(socket, lambda event: event["event"] in ("touch", "refused"))
            if told[-1]["event"] == "touch":
                break
            time.sleep(0.1)
        assert told[-1]["event"] == "touch"
        told = do(client, name, "withdraw", number=1, reason="slipped")
        assert [each["withdrawn"] for each in told["state"]["touches"]] == ["slipped"]
        held = client.refused(400, "POST", f"/activities/{name}/do", json={"word": "hold-out", "places": 3})
        assert "too few" in held
        assert do(client, name, "moved")["state"]["place"] == told["state"]["place"] + 1
        ended = do(client, name, "end")
    assert [each["role"] for each in ended["left"]] == ["journal"]
    assert "too few" in ended["said"][-1]["text"]
    assert name in {each["id"] for each in client.get("/activities")["unfinished"]}
    client.refused(409, "POST", f"/activities/{name}/do", json={"word": "touch"})


@pytest.mark.usefixtures("idle")
def test_reading_out_with_the_calibrated_arm(client: Client, touched: dict[str, str], play: dict[str, str]) -> None:
    name = begun(client, {"kind": "measure", "source": play["source"], "arm": touched["result"], "by": "key"})
    with client.socket(name) as socket:
        told = events(socket, lambda event: event["event"] == "tip" and event["tip"]["still"])
        values = told[-1]["tip"]["values"]
        assert [each["unit"] for each in values] == ["mm"] * 3
        assert all(each["u"] > 0 for each in values)
        do(client, name, "touch")
        state = client.get(f"/activities/{name}")["state"]
    assert [len(point["values"]) for point in state["points"]] == [3]
    left = do(client, name, "end")["left"]
    assert [each["role"] for each in left] == ["readings"]
    assert client.get(f"/files/{left[0]['sha256']}")["kind"] == "table"


@pytest.mark.usefixtures("idle")
def test_a_source_is_a_url_or_a_file_of_the_desk_never_a_path(
    client: Client, play: dict[str, str], bench: Path
) -> None:
    arm = {"kind": "watch", "arm": None}
    for source in ("file:/etc/passwd", f"virtual:{bench / 'bench.toml'}", "/etc/passwd", "../bench.toml", "bag:x"):
        client.refused(404, "POST", "/activities", json={**arm, "source": source})
    for source in ("no-such:1", "virtual:" + play["source"].partition(":")[2] + "&poses=/etc/passwd"):
        client.refused(400, "POST", "/activities", json={**arm, "source": source})
    assert client.get("/activities")["running"] == []
