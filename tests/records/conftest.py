"""Records in both databases: SQLite in a folder, and a real PostgreSQL server."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from tests.records.benches import RESULT
from tests.records.serving import Server

from ulna.records.database import PASSWORD
from ulna.records.records import Records


@pytest.fixture(scope="session")
def postgresql() -> Iterator[Server]:
    """Alive for the session."""
    server = Server()
    try:
        yield server
    finally:
        server.end()
        os.environ.pop(PASSWORD, None)


@pytest.fixture(params=["sqlite", "postgresql"])
def database(request: pytest.FixtureRequest) -> Callable[[], str | None]:
    """Makes an empty database: its URL, None for SQLite in the bench's folder."""
    if request.param == "sqlite":
        return lambda: None
    server: Server = request.getfixturevalue("postgresql")
    return server.database


@pytest.fixture
def records(tmp_path: Path, database: Callable[[], str | None]) -> Records:
    """A record with an arm, a bar, a knock and a calibration."""
    records = Records.init(tmp_path / "bench", database(), by="Jan")
    records.register("P7", maker="Example Arms", serial="P07-0815")
    records.register("KB-443", "artefact")
    records.certify("KB-443", {"length": (443.172, 0.001)}, number="EX-1", valid_to="2099-01-01")
    records.event("P7", "knock", "fell against the table", at="2026-05-04")
    records.add(RESULT, arm="P7", at="2026-03-31", artefacts=["KB-443"])
    return records
