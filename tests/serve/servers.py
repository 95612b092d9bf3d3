"""Real servers for tests: one in a thread, to be looked into, and one as a process, to be killed."""

from __future__ import annotations

import http.client
import json
import os
import re
import signal
import socket
import ssl
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import httpx
import uvicorn
from tests.conftest import ROOT
from websockets.sync.client import ClientConnection, connect

from ulna.serve import serving
from ulna.serve.guarding import Guard
from ulna.serve.guests import Guests
from ulna.serve.workshop import Workshop

FAST = "moves=told&noise=5e-6&rate=200&hand=10&speed=10"
"""Of a virtual source: ten times as fast as a hand, and never by itself."""
PATIENCE_S = 60.0


class Client:
    """Somebody's browser."""

    def __init__(self, address: str, trusted: ssl.SSLContext | None = None) -> None:
        """address: as `ulna workbench` prints it. trusted: whose certificate is taken, of a laboratory's server."""
        self.base, _, self.token = address.partition("/#token=")
        self._trusted = trusted
        verify: ssl.SSLContext | bool = True if trusted is None else trusted
        self.http = httpx.Client(base_url=self.base, headers={"Origin": self.base}, timeout=PATIENCE_S, verify=verify)

    def sign_in(self) -> Client:
        self.post("/login", {"way": "token", "token": self.token})
        return self

    def sign_in_as(self, name: str, password: str) -> Client:
        self.post("/login", {"way": "password", "name": name, "password": password})
        return self

    @property
    def cookie(self) -> str:
        return "; ".join(f"{name}={value}" for name, value in self.http.cookies.items())

    def ask(self, method: str, path: str, **more: Any) -> httpx.Response:
        """path: below /api/v1."""
        return self.http.request(method, f"/api/v1{path}", **more)

    def get(self, path: str, **params: Any) -> Any:
        return said(self.ask("GET", path, params=params))

    def post(self, path: str, body: Any = None, **more: Any) -> Any:
        return said(self.ask("POST", path, json=body, **more))

    def refused(self, status: int, method: str, path: str, **more: Any) -> str:
        """In which words."""
        answer = self.ask(method, path, **more)
        assert answer.status_code == status, answer.text
        assert answer.headers["content-type"] == "application/problem+json"
        return str(answer.json()["detail"])

    def bring(self, path: Path, name: str | None = None) -> str:
        """A file onto the desk: its SHA-256."""
        made = self.ask("POST", "/files", params={"name": name or path.name}, content=path.read_bytes())
        return str(said(made)["sha256"])

    def done(self, body: dict[str, Any]) -> dict[str, Any]:
        """A job, begun and waited for."""
        return self.waited(self.post("/jobs", body)["id"])

    def waited(self, job: str) -> dict[str, Any]:
        found: dict[str, Any] = {}

        def over() -> bool:
            found.update(self.get(f"/jobs/{job}"))
            return found["state"] not in ("waiting", "running")

        wait_for(over, f"job {job}")
        return found

    def made(self, body: dict[str, Any]) -> dict[str, str]:
        """The same of a job that must succeed: SHA-256 of what it made, by role."""
        job = self.done(body)
        assert job["state"] == "done", job
        return {each["role"]: each["sha256"] for each in job["made"]}

    def socket(self, activity: str | None = None, **more: Any) -> ClientConnection:
        """The live socket, signed in as this browser is."""
        path = "/api/v1/live" + ("" if activity is None else f"?activity={activity}")
        headers = {"Cookie": self.cookie} | more.pop("headers", {})
        origin = more.pop("origin", self.base)
        url = self.base.replace("http", "ws") + path
        # whoever leaves with messages unread does not wait for the other side's goodbye behind them
        return connect(url, origin=origin, additional_headers=headers, close_timeout=0.1, ssl=self._trusted, **more)

    def raw(self, method: str, target: str, headers: dict[str, str] | None = None) -> http.client.HTTPResponse:
        """A request whose path no library tidies up."""
        host, _, port = self.base.removeprefix("http://").partition(":")
        connection = http.client.HTTPConnection(host, int(port), timeout=PATIENCE_S)
        try:
            connection.putrequest(method, target, skip_host=headers is not None and "Host" in headers)
            for name, value in ({"Cookie": self.cookie, "Origin": self.base} | (headers or {})).items():
                connection.putheader(name, value)
            connection.endheaders()
            answer = connection.getresponse()
            answer.text = answer.read().decode(errors="replace")  # type: ignore[attr-defined]
            return answer
        finally:
            connection.close()

    def close(self) -> None:
        self.http.close()


def said(answer: httpx.Response) -> Any:
    """What a good answer says."""
    assert answer.is_success, f"{answer.status_code}: {answer.text}"
    return answer.json() if answer.content else None


def untold(document: Any) -> list[str]:
    """Sentences of what was answered, or told, that no catalogue can know. What has no blank is a name or a symbol."""
    if isinstance(document, list):
        return [each for one in document for each in untold(one)]
    if not isinstance(document, dict):
        return []
    if set(document) == {"text", "template", "values"}:
        own = [document["text"]] if document["template"] is None and " " in document["text"] else []
        return own + untold(list(document["values"].values()))
    return untold(list(document.values()))


def wait_for(condition: Callable[[], bool], what: str) -> None:
    end = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < end, f"waited in vain: {what}"
        time.sleep(0.02)


def events(socket: ClientConnection, until: Callable[[dict[str, Any]], bool]) -> list[dict[str, Any]]:
    """What a socket tells, up to some event; frames are left out."""
    found: list[dict[str, Any]] = []
    while not (found and until(found[-1])):
        message = socket.recv(timeout=PATIENCE_S)
        if isinstance(message, str):
            found.append(json.loads(message))
    return found


class Threaded:
    """A server in a thread of this process."""

    def __init__(self, folder: Path) -> None:
        self._serve(Workshop(folder, "Ann"), serving.listening_at(serving.HOST, [0], "port"), serving.server_of)

    def _serve(self, workshop: Workshop, listening: socket.socket, made: Callable[..., uvicorn.Server]) -> None:
        self.workshop, self._listening = workshop, listening
        there = threading.Event()
        self.address = ""

        def ready(address: str) -> None:
            self.address = address
            there.set()

        self._server = made(self.workshop, self._listening, ready)
        self._thread = threading.Thread(target=self._server.run, kwargs={"sockets": [self._listening]})
        self._thread.start()
        assert there.wait(PATIENCE_S)

    @property
    def guests(self) -> Guests:
        """Who is signed in."""
        app = self._server.config.app
        assert isinstance(app, Guard)
        return app.guests

    def end(self) -> None:
        self._server.should_exit = True
        self._thread.join(PATIENCE_S)
        self._listening.close()
        self.workshop.close()


@contextmanager
def apart(folder: Path) -> Iterator[tuple[Client, Threaded]]:
    """A bench of one module's own, for what is entered and never taken out; and somebody who is signed in."""
    server = Threaded(folder / "bench")
    client = Client(server.address).sign_in()
    yield client, server
    client.close()
    server.end()


class Process:
    """`ulna workbench` as somebody starts it."""

    def __init__(self, folder: Path) -> None:
        command = [sys.executable, "-m", "ulna", "workbench", str(folder), "--port", "0", "--no-open", "--by", "Ann"]
        environment = os.environ | {"PYTHONPATH": str(ROOT / "python"), "PYTHONUNBUFFERED": "1"}
        self._process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment)
        assert self._process.stdout is not None
        heard = b""
        while (line := self._process.stdout.readline()) and (
            found := re.search(rb"open (http://\S+)", heard := heard + line)
        ) is None:
            pass
        assert found is not None, heard.decode()
        self.address = found[1].decode()

    @property
    def pid(self) -> int:
        """Of the server."""
        return self._process.pid

    def end(self, how: signal.Signals = signal.SIGTERM) -> None:
        self._process.send_signal(how)
        self._process.wait(PATIENCE_S)
        assert self._process.stdout is not None
        self._process.stdout.close()
