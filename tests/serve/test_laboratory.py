"""A laboratory: who gets in, what each may do, and in whose name it is written down. A real server, over TLS."""

from __future__ import annotations

import json
import logging
import re
import ssl
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import get_args

import httpx
import pytest
from tests.serve.laboratories import PEOPLE, Laboratory, laboratory, password_of, people_in
from tests.serve.servers import untold
from websockets.exceptions import ConnectionClosed, InvalidStatus

from ulna.serve.laboratory import entrance
from ulna.serve.laboratory.accounts import Accounts
from ulna.serve.laboratory.throttle import FREE, FREE_OF_ADDRESS, LONGEST_S, Throttle
from ulna.serve.people import Role
from ulna.serve.rights import LOOKS, OPEN, PREFIX, RIGHTS, needed
from ulna.serve.routes import live


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Laboratory]:
    """One for the module."""
    with laboratory(
        tmp_path_factory.mktemp("laboratory"), '[sources]\nhosts = ["127.0.0.1", "169.254.169.254"]\n'
    ) as one:
        yield one


@pytest.fixture
def standing(monkeypatch: pytest.MonkeyPatch) -> None:
    """No time goes by for whoever must wait."""
    monkeypatch.setattr(entrance, "Throttle", partial(Throttle, lambda: 0.0))


@pytest.fixture
def unforgetful(monkeypatch: pytest.MonkeyPatch) -> None:
    """What the record says of somebody counts at once."""
    monkeypatch.setattr(entrance, "FRESH_S", 0.0)


# ---------------------------------------------------------------- signing in


def test_somebody_signs_in_and_out(lab: Laboratory) -> None:
    stranger = lab.client()
    about = stranger.get("/about")
    assert (about["mode"], about["ways"]) == ("laboratory", ["password"])
    assert stranger.refused(401, "GET", "/me") == "Sign in."
    answer = stranger.ask("POST", "/login", json={"way": "password", "name": "Lea", "password": password_of("Lea")})
    cookie = answer.headers["set-cookie"]
    assert cookie.startswith("__Host-")
    for word in ("HttpOnly", "SameSite=strict", "Secure", "Path=/", "Max-Age=43200"):
        assert word in cookie
    assert "Domain" not in cookie
    assert "max-age" in answer.headers["strict-transport-security"]
    assert stranger.get("/me") == {"name": "Lea", "roles": ["reader"], "password": True}
    stranger.post("/logout")
    stranger.refused(401, "GET", "/me")
    stranger.http.headers["Cookie"] = cookie.partition(";")[0]
    stranger.refused(401, "GET", "/me")


def test_nobody_learns_whose_name_it_was(lab: Laboratory, caplog: pytest.LogCaptureFixture) -> None:
    stranger = lab.client()
    with caplog.at_level(logging.INFO, "ulna.workbench"):
        said = {
            stranger.refused(401, "POST", "/login", json={"way": "password", "name": name, "password": password})
            for name, password in (("Lea", "wrong"), ("Nobody\n\x1b[31m", "wrong"), ("Lea", password_of("Ann")))
        }
    assert len(said) == 1
    assert not stranger.http.cookies
    assert "refused: Lea from 127.0.0.1" in caplog.text
    assert "\x1b" not in caplog.text
    assert "wrong\n" not in caplog.text.replace("wrong name", "")
    assert "token" in stranger.refused(401, "POST", "/login", json={"way": "token", "token": "x"})


def test_whoever_guesses_waits(tmp_path: Path, standing: None) -> None:
    people_in(tmp_path / "bench", {"Lea": ("reader",)})
    with laboratory(tmp_path) as own:
        guessing = own.client()
        for _ in range(FREE):
            guessing.refused(401, "POST", "/login", json={"way": "password", "name": "Lea", "password": "guess"})
        right = {"way": "password", "name": "Lea", "password": password_of("Lea")}
        assert "Try again in" in guessing.refused(429, "POST", "/login", json=right)


def test_who_is_not_let_in_is_told_with_templates(tmp_path: Path, standing: None) -> None:
    people_in(tmp_path / "bench", {"Lea": ("reader",)})
    with laboratory(tmp_path) as own:
        lea, guessing = own.of("Lea"), own.client()
        wrong = {"way": "password", "name": "Lea", "password": "guess"}
        told = [lea.ask("POST", "/play"), lea.ask("POST", "/nothing"), guessing.ask("GET", "/me")]
        told += [guessing.ask("POST", "/login", json=wrong) for _ in range(FREE + 1)]
    assert [each.status_code for each in told] == [403, 405, *[401] * (FREE + 1), 429]
    assert untold([each.json() for each in told]) == []


def test_waiting_doubles_is_bounded_and_is_forgotten() -> None:
    now_s = 0.0
    throttle = Throttle(lambda: now_s)
    waits = []
    for _ in range(FREE + 14):
        now_s += throttle.wait_s("Lea", "a")
        throttle.failed("Lea", "a")
        waits.append(throttle.wait_s("Lea", "a"))
    assert waits[: FREE - 1] == [0.0] * (FREE - 1)
    assert waits[FREE - 1 : FREE + 9] == [2.0**k for k in range(10)][: len(waits[FREE - 1 : FREE + 9])]
    assert max(waits) == LONGEST_S
    assert throttle.wait_s("Lea", "b") == 0.0
    throttle.good("Lea", "a")
    assert throttle.wait_s("Lea", "a") == 0.0
    for k in range(FREE_OF_ADDRESS):
        throttle.failed(f"name {k}", "c")
    assert throttle.wait_s("anybody", "c") > 0.0
    now_s += 4000.0
    assert throttle.wait_s("anybody", "c") == 0.0
    throttle.failed("anybody", "c")
    assert throttle.wait_s("anybody", "c") == 0.0


def test_another_password_ends_what_was_signed_in_elsewhere(tmp_path: Path, unforgetful: None) -> None:
    with laboratory(tmp_path) as own:
        here, there = own.of("Otto"), own.of("Otto")
        asked = {"now": "wrong", "new": "another long password"}
        here.refused(401, "POST", "/me/password", json=asked)
        assert "12" in here.refused(400, "POST", "/me/password", json={"now": password_of("Otto"), "new": "short"})
        here.post("/me/password", {**asked, "now": password_of("Otto")})
        assert here.get("/me")["name"] == "Otto"
        there.refused(401, "GET", "/me")
        again = {"way": "password", "name": "Otto", "password": password_of("Otto")}
        there.refused(401, "POST", "/login", json=again)
        there.sign_in_as("Otto", "another long password")


def test_whoever_is_gone_is_gone_at_once(tmp_path: Path, unforgetful: None) -> None:
    with laboratory(tmp_path) as own:
        ann, otto, rita = own.of("Ann"), own.of("Otto"), own.of("Rita")
        assert otto.ask("POST", "/play").status_code == 200
        ann.post("/people", {"name": "Otto", "roles": ["reader"]})
        otto.refused(403, "POST", "/play")
        assert otto.get("/me")["roles"] == ["reader"]
        ann.post("/people", {"name": "Otto", "roles": []})
        otto.refused(401, "GET", "/me")
        Accounts(tmp_path / "bench").remove("Rita")
        rita.refused(401, "GET", "/files")
        assert "another" in ann.refused(409, "POST", "/people", json={"name": "Ann", "roles": ["reader"]})


def test_whoever_is_gone_hears_nothing_more(tmp_path: Path, unforgetful: None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(live, "LOOK_S", 0.05)
    with laboratory(tmp_path) as own:
        ann, lea = own.of("Ann"), own.of("Lea")
        with ann.socket() as staying, lea.socket() as going:
            assert json.loads(going.recv(timeout=10))["event"] == "hello"
            ann.post("/people", {"name": "Lea", "roles": []})
            with pytest.raises(ConnectionClosed) as closed:
                going.recv(timeout=10)
            assert closed.value.rcvd is not None
            assert closed.value.rcvd.code == live.NOT_KNOWN
            assert json.loads(staying.recv(timeout=10))["event"] == "hello"
            staying.ping().wait(10)


def test_sessions_end(tmp_path: Path) -> None:
    with laboratory(tmp_path, "[sign_in]\nhours = 1e-9\n") as own:
        own.of("Ann").refused(401, "GET", "/me")


# ---------------------------------------------------------------- what each may do


def test_every_request_that_changes_anything_has_a_row(root: Path) -> None:
    paths = json.loads((root / "page" / "openapi.json").read_text(encoding="utf-8"))["paths"]
    asked = {
        (method.upper(), path.removeprefix(PREFIX))
        for path, methods in paths.items()
        for method in methods
        if method.upper() not in ("GET", "HEAD", "OPTIONS")
    }
    assert asked - {("POST", path) for path in OPEN} == {(row.method, row.path) for row in RIGHTS}
    assert {("GET", row.path) for row in LOOKS} <= {
        (m.upper(), p.removeprefix(PREFIX)) for p in paths for m in paths[p]
    }
    assert needed("DELETE", "/files") is None
    assert needed("POST", "/no/such") is None
    assert needed("POST", "/records/equipment/a/b/events") is None


@pytest.mark.parametrize("name", PEOPLE)
def test_each_may_do_what_their_roles_say_and_nothing_else(lab: Laboratory, name: str) -> None:
    client = lab.of(name)
    for row in (*RIGHTS, *LOOKS):
        if row.path in ("/logout", "/play"):
            continue
        path = row.path.replace("{name}", "no-such")
        answer = client.ask(row.method, path, json={"no": "such"} if row.method == "POST" else None)
        may = row.role == "reader" or row.role in PEOPLE[name]
        assert (answer.status_code == 403) == (not may), (row.path, answer.text)
    client.refused(405, "DELETE", "/files")
    client.refused(405, "POST", "/no/such")
    for path in ("/files", "/activities", "/records/equipment", "/bench", "/settings", "/records/proposals"):
        assert client.ask("GET", path).status_code == 200
    with client.socket() as socket:
        assert json.loads(socket.recv(timeout=10))["event"] == "hello"


def test_roles_are_those_of_the_record() -> None:
    from ulna.records.acts.person import ROLES

    assert set(ROLES) == set(get_args(Role))


def test_what_is_done_is_written_down_in_the_name_of_who_did_it(lab: Laboratory) -> None:
    for name in ("Otto", "Rita"):
        lab.of(name).post("/records/equipment", {"name": f"arm of {name}", "kind": "arm"})
    ann = lab.of("Ann")
    for name in ("Otto", "Rita"):
        (entry,) = ann.get(f"/records/equipment/arm of {name}")["history"]
        assert entry["by"] == name


def test_several_look_at_one_session_and_it_is_said_whose_it_is(lab: Laboratory) -> None:
    otto, lea = lab.of("Otto"), lab.of("Lea")
    play = otto.post("/play")
    begun = otto.post("/activities", {"kind": "watch", "source": play["source"], "arm": play["arm"]})
    assert begun["who"] == "Otto"
    with lea.socket(begun["id"]) as socket:
        hello = json.loads(socket.recv(timeout=10))
        assert hello["activity"]["who"] == "Otto"
    lea.refused(403, "POST", f"/activities/{begun['id']}/do", json={"word": "end"})
    otto.post(f"/activities/{begun['id']}/do", {"word": "end"})


@pytest.mark.parametrize(
    "source",
    [
        "tcp://192.0.2.1:9000",
        "tcp://169.254.169.254:80",
        "ws://internal.example/x",
        "mqtt://broker.example/x",
        "opc.tcp://192.0.2.1:4840/",
        "udp://:9000",
        "push://0.0.0.0:9999/?token=x",
        "rosbridge://192.0.2.1:9090/x",
    ],
)
def test_the_server_connects_only_to_what_its_file_lists(lab: Laboratory, source: str, tmp_path: Path) -> None:
    otto = lab.of("Otto")
    assert "[sources]" in otto.refused(403, "POST", "/sources/guess", json={"source": source, "seconds": 1.0})
    assert "[sources]" in otto.refused(403, "POST", "/activities", json={"kind": "watch", "source": source})
    file = tmp_path / "source.toml"
    file.write_text(f'format = "ulna-source/1"\nurl = "{source}"\n', encoding="utf-8")
    brought = otto.bring(file)
    assert "[sources]" in otto.refused(403, "POST", "/activities", json={"kind": "watch", "source": brought})


def test_what_its_file_lists_is_tried(lab: Laboratory) -> None:
    said = lab.of("Otto").refused(400, "POST", "/activities", json={"kind": "watch", "source": "tcp://127.0.0.1:1"})
    assert "127.0.0.1:1" in said


# ---------------------------------------------------------------- from where


def test_only_its_own_name_and_page_over_tls(lab: Laboratory) -> None:
    client = lab.of("Ann")
    for headers in ({"Origin": client.base.replace("https", "http")}, {"Origin": "https://evil.example"}):
        assert "Origin" in client.refused(403, "POST", "/logout", headers=headers)
        with pytest.raises(InvalidStatus):
            client.socket(origin=headers["Origin"])
    assert client.ask("GET", "/me", headers={"Host": "evil.example"}).status_code == 403
    with pytest.raises(httpx.HTTPError):
        httpx.get(client.base.replace("https", "http"))
    with pytest.raises(httpx.ConnectError), httpx.Client(verify=ssl.create_default_context()) as untrusting:
        untrusting.get(client.base)


def test_behind_a_proxy_nobody_else_is_answered(tmp_path: Path, standing: None) -> None:
    with laboratory(tmp_path, proxy="192.0.2.7", names='"arms.example"') as own:
        answer = httpx.get(f"http://127.0.0.1:{own.port}/", headers={"Host": "arms.example"})
        assert answer.status_code == 403
        assert "proxy" in answer.json()["detail"]
    with laboratory(tmp_path, proxy="127.0.0.1", names='"arms.example"') as own:
        base, named = f"http://127.0.0.1:{own.port}", {"Host": "arms.example", "Origin": "https://arms.example"}
        plain = httpx.get(f"{base}/api/v1/about", headers={**named, "X-Forwarded-Proto": "http"})
        assert "https" in plain.json()["detail"]
        assert plain.status_code == 403
        told = {**named, "X-Forwarded-Proto": "https"}
        assert httpx.get(f"{base}/api/v1/about", headers=told).status_code == 200
        wrong = {"way": "password", "name": "Lea", "password": "guess"}
        for tried in range(FREE + 1):  # what a client itself says before the proxy's own word does not count
            headers = {**told, "X-Forwarded-For": f"198.51.100.{tried}, 203.0.113.9"}
            answer = httpx.post(f"{base}/api/v1/login", json=wrong, headers=headers)
        assert answer.status_code == 429
        other = httpx.post(f"{base}/api/v1/login", json=wrong, headers={**told, "X-Forwarded-For": "203.0.113.10"})
        assert other.status_code == 401


def test_a_damaged_file_of_accounts_lets_nobody_in_and_is_not_overwritten(tmp_path: Path) -> None:
    people_in(tmp_path / "bench", {"Ann": ("admin",)})
    with laboratory(tmp_path) as own:
        client = own.of("Ann")
        path = tmp_path / "bench" / "accounts.json"
        path.write_text("{", encoding="utf-8")
        own.guests.out("nobody")
        answer = own.client().ask(
            "POST", "/login", json={"way": "password", "name": "Ann", "password": password_of("Ann")}
        )
        assert answer.status_code == 400
        assert re.search("accounts", answer.json()["detail"])
        asked = {"name": "Ann", "password": "another long password"}
        assert client.ask("POST", "/people/Ann/account", json={"password": asked["password"]}).status_code == 400
        assert path.read_text(encoding="utf-8") == "{"
