"""A workbench that runs, on a bench of its own, and a browser that is signed in."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.serve.servers import FAST, Client, Threaded


@pytest.fixture(scope="session")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Threaded]:
    """One for the session."""
    running = Threaded(tmp_path_factory.mktemp("serve") / "bench")
    try:
        yield running
    finally:
        running.end()


@pytest.fixture(scope="session")
def client(server: Threaded) -> Iterator[Client]:
    """Signed in."""
    made = Client(server.address).sign_in()
    yield made
    made.close()


@pytest.fixture
def stranger(server: Threaded) -> Iterator[Client]:
    """Not signed in."""
    made = Client(server.address)
    yield made
    made.close()


@pytest.fixture(scope="session")
def play(client: Client) -> dict[str, str]:
    """A virtual arm that is faster than any hand: drawing, plan, source."""
    said: dict[str, str] = client.post("/play")
    return {**said, "source": f"{said['source'].partition('?')[0]}?{FAST}"}


@pytest.fixture
def idle(client: Client) -> Iterator[None]:
    """Nothing goes on, before and after."""
    yield
    for each in client.get("/activities")["running"]:
        client.post(f"/activities/{each['id']}/do", {"word": "end"})


@pytest.fixture(scope="session")
def touched(client: Client, play: dict[str, str]) -> dict[str, str]:
    """A session that came to its goal: what it left, SHA-256 by role, and its name."""
    from tests.serve.servers import events

    begun = client.post("/activities", begin_touch(play))
    with client.socket(begun["id"]) as socket:
        client.post(f"/activities/{begun['id']}/do", {"word": "follow", "follows": True})
        events(socket, lambda event: event["event"] == "known" and event["meter"]["reached"])
    ended = client.post(f"/activities/{begun['id']}/do", {"word": "end"})
    return {each["role"]: each["sha256"] for each in ended["left"]} | {"id": begun["id"]}


def begin_touch(play: dict[str, str], **more: object) -> dict[str, object]:
    """A session towards 60 µm."""
    asked = {"kind": "touch", "source": play["source"], "arm": play["arm"], "plan": play["plan"]}
    return {**asked, "goal_mm": 0.06, "length_mm": 500.0, **more}


@pytest.fixture(scope="session")
def bench(server: Threaded) -> Path:
    """The folder."""
    return server.workshop.folder
