"""Who gets in, and what nobody may do: a real server, and requests as browsers and worse make them."""

from __future__ import annotations

import json
import socket
from collections.abc import Iterator
from urllib.parse import quote

import pytest
from tests.serve.servers import Client, Threaded
from websockets.exceptions import InvalidStatus

from ulna.ground.worded import worded
from ulna.serve import guarding
from ulna.serve.contract.live import SaidEvent
from ulna.serve.desk import LONGEST, plain_name
from ulna.serve.problems import problem

HOSTILE = (
    "/api/v1/files/../../bench.toml",
    "/api/v1/files/%2e%2e/%2e%2e/bench.toml",
    "/api/v1/files/..%2f..%2fbench.toml/content",
    "/../bench.toml",
    "/%2e%2e/%2e%2e/%2e%2e/etc/passwd",
    "/assets/../../app.py",
    "/assets/%2e%2e/%2e%2e/app.py",
    "//etc/passwd",
    "/..\\..\\etc\\passwd",
    "/etc/passwd%00.html",
)
NAMES = {
    "../../etc/passwd": "passwd",
    "..\\..\\windows\\win.ini": "win.ini",
    "/absolute/arm.toml": "arm.toml",
    ".hidden.toml": "hidden.toml",
    "arm\x00\n\r\x1b[31m.toml": "arm____[31m.toml",
    "\u202egnp.exe.toml": "_gnp.exe.toml",
    "..": "file",
    "   ": "file",
    "<script>alert(1)</script>.toml": "script>.toml",
    "臂.toml": "臂.toml",
}


def test_a_host_that_is_not_ours_is_refused(client: Client) -> None:
    """Rebinding: a name of somebody else's that resolves to this machine."""
    port = client.base.rpartition(":")[2]
    for host in ("evil.example", f"evil.example:{port}", "127.0.0.1:1", f"127.0.0.1.evil.example:{port}", ""):
        for method, path in (("GET", "/api/v1/me"), ("POST", "/api/v1/logout"), ("GET", "/")):
            answer = client.raw(method, path, {"Host": host})
            assert answer.status == 403, host
    assert (
        client.raw("GET", "/api/v1/me", {"Host": f"localhost:{port}", "Origin": f"http://localhost:{port}"}).status
        == 200
    )


@pytest.mark.parametrize("origin", ["https://evil.example", "null", "http://127.0.0.1:1", "", None])
def test_what_another_site_sends_is_refused(client: Client, origin: str | None) -> None:
    headers = {} if origin is None else {"Origin": origin}
    host = client.base.removeprefix("http://")
    with socket.create_connection(tuple(host.split(":"))) as wire:  # type: ignore[arg-type]
        lines = [f"POST /api/v1/play HTTP/1.1\r\nHost: {host}", f"Cookie: {client.cookie}", "Content-Length: 0"]
        lines += [f"{name}: {value}" for name, value in headers.items()]
        wire.sendall("\r\n".join([*lines, "Connection: close", "", ""]).encode())
        assert wire.recv(100).startswith(b"HTTP/1.1 403")


@pytest.mark.parametrize("origin", ["https://evil.example", "null", None])
def test_a_socket_of_another_site_is_refused(client: Client, origin: str | None) -> None:
    with pytest.raises(InvalidStatus) as refused, client.socket(origin=origin):
        pass
    assert refused.value.response.status_code == 403


def test_who_is_not_signed_in_gets_the_page_and_nothing_else(stranger: Client) -> None:
    assert "Sign in" in stranger.ask("GET", "/me").json()["title"]
    for method, path in (("GET", "/files"), ("POST", "/jobs"), ("GET", "/openapi.json"), ("GET", "/no/such/thing")):
        assert "ulna workbench" in stranger.refused(401, method, path)
    with pytest.raises(InvalidStatus) as refused, stranger.socket():
        pass
    assert refused.value.response.status_code == 401
    assert stranger.ask("GET", "/about").status_code == 200
    assert stranger.http.get("/collect").status_code in (200, 503)  # the page, or that it was not built


def test_a_wrong_token_opens_nothing(stranger: Client) -> None:
    for token in ("x", stranger.token[:-1], stranger.token + "x", "ü" * 40):
        assert "token" in stranger.refused(401, "POST", "/login", json={"way": "token", "token": token})
    assert not stranger.http.cookies
    stranger.refused(
        422,
        "POST",
        "/login",
        content=b'{"way": "token", "token": "\\ud800"}',
        headers={"Content-Type": "application/json"},
    )


def test_a_cookie_no_script_and_no_other_site_gets(stranger: Client) -> None:
    cookie = stranger.ask("POST", "/login", json={"way": "token", "token": stranger.token}).headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=strict" in cookie
    stranger.get("/me")
    stranger.post("/logout")
    stranger.refused(401, "GET", "/me")
    stranger.http.headers["Cookie"] = cookie.partition(";")[0]  # somebody kept it
    stranger.refused(401, "GET", "/me")


def test_a_session_expires(stranger: Client, server: Threaded, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server.guests, "session_s", 0.0)
    stranger.post("/login", {"way": "token", "token": stranger.token})
    assert stranger.cookie
    assert "ulna workbench" in stranger.refused(401, "GET", "/me")


@pytest.mark.parametrize("cookie", ["ulna-session=", "ulna-session=../x", "ulna-session=a;;=;", "=", "\x7f"])
def test_made_up_cookies(stranger: Client, cookie: str) -> None:
    assert stranger.raw("GET", "/api/v1/me", {"Cookie": cookie}).status == 401


@pytest.mark.parametrize("path", HOSTILE)
def test_no_path_leads_out(client: Client, path: str) -> None:
    answer = client.raw("GET", path)
    assert answer.status in (200, 404, 405, 422, 503)
    assert not any(word in answer.text for word in ("ulna-bench/1", "root:x", "ROUTERS"))  # type: ignore[attr-defined]


def test_names_are_names_and_nothing_else(client: Client, server: Threaded) -> None:
    for number, (given, kept) in enumerate(NAMES.items()):
        content = f"# {number}\n".encode()
        made = client.ask("POST", f"/files?name={quote(given)}", content=content).json()
        assert made["name"] == kept
        path = server.workshop.desk.path(made["sha256"])
        assert path.parent == server.workshop.folder / "desk" / made["sha256"]
        back = client.ask("GET", f"/files/{made['sha256']}/content")
        assert back.content == content
        assert back.headers["content-disposition"].startswith("attachment")
    assert len(plain_name("x" * 500 + ".toml").encode()) <= LONGEST
    assert len(plain_name("臂" * 500).encode()) <= LONGEST


def test_too_much_is_refused(client: Client, stranger: Client, monkeypatch: pytest.MonkeyPatch) -> None:
    large = {"Content-Length": str(guarding.MOST_BODY + 1)}
    assert client.raw("POST", "/api/v1/files?name=x", large).status == 413
    assert stranger.raw("POST", "/api/v1/login", {"Content-Length": str(guarding.MOST_WORDS + 1)}).status == 413

    def endless(megabytes: int) -> Iterator[bytes]:
        for _ in range(megabytes):
            yield b" " * (1 << 20)

    json_ = {"Content-Type": "application/json"}
    assert "Cut it" in stranger.refused(413, "POST", "/login", content=endless(3), headers=json_)
    monkeypatch.setattr("ulna.serve.routes.files.MOST_BYTES", 1 << 20)
    assert "Cut it" in client.refused(413, "POST", "/files?name=x.csv", content=endless(3))


def test_headers(client: Client) -> None:
    for path in ("/", "/collect", "/api/v1/me", "/api/v1/no-such", "/assets/no-such.js"):
        headers = client.http.get(path).headers
        assert "default-src 'self'" in headers["content-security-policy"]
        assert "unsafe" not in headers["content-security-policy"]
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["referrer-policy"] == "no-referrer"
        assert "frame-ancestors 'none'" in headers["content-security-policy"]
        assert "access-control-allow-origin" not in headers
    assert client.http.get("/api/v1/me").headers["cache-control"] == "no-store"


def test_errors_are_problems_in_words(client: Client) -> None:
    assert "there is no such thing" in client.refused(404, "GET", "/no-such")
    assert "not on this desk" in client.refused(404, "GET", f"/files/{'0' * 64}")
    assert "sha256" in client.refused(422, "GET", "/files/xyz")
    assert "kind" in client.refused(422, "POST", "/jobs", json={"kind": "no-such"})
    body, json_ = b"{" * 5000, {"Content-Type": "application/json"}
    client.refused(422, "POST", "/jobs", content=body, headers=json_)
    client.refused(422, "POST", "/jobs", content=b'{"kind": NaN}', headers=json_)
    client.refused(422, "POST", "/jobs", content=json.dumps("\ud800").encode(), headers=json_)
    client.refused(405, "DELETE", "/files")


def test_messages_name_files_as_they_came() -> None:
    at = "/srv/ulna-bench"
    said = f"{at}/desk/{'a' * 64}/plan.toml: wrong; see '{at}/sessions/2026-11-30-1/study.toml' and {at}/other/x.toml."
    shown = f"plan.toml: wrong; see 'study.toml' and {at}/other/x.toml."
    assert problem(400, said).detail == shown
    for sentence in (said, worded("{file}: wrong; see '{other}' and {third}.", **_parts(at))):
        on_the_wire = json.loads(SaidEvent(sentence=sentence).model_dump_json())["sentence"]
        assert on_the_wire["text"] == shown
        assert "desk/" not in json.dumps(on_the_wire)


def _parts(at: str) -> dict[str, str]:
    return {
        "file": f"{at}/desk/{'a' * 64}/plan.toml",
        "other": f"{at}/sessions/2026-11-30-1/study.toml",
        "third": f"{at}/other/x.toml",
    }
