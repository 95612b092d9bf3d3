"""Records in both databases: SQLite in a folder, and a real PostgreSQL server, started here from Debian's package."""

from __future__ import annotations

import os
import pwd
import shutil
import signal
import socket
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.real_parts import lacking
from tests.records.benches import RESULT

from ulna.records.database import PASSWORD
from ulna.records.records import Records

PASSWORD_OF_TESTS = "of tests"


def _program(name: str) -> str | None:
    """Debian keeps those of a server beside each other, by version."""
    found = sorted(Path("/usr/lib/postgresql").glob(f"*/bin/{name}"), key=lambda path: int(path.parts[4]))
    return str(found[-1]) if found else shutil.which(name)


@pytest.fixture(scope="session")
def postgresql() -> Iterator[str]:
    """URL of a server without a database's name, alive for the session; it listens on this machine alone."""
    initdb, server = _program("initdb"), _program("postgres")
    if initdb is None or server is None:
        lacking("PostgreSQL")
    folder = Path(tempfile.mkdtemp(prefix="ulna-postgresql-"))
    as_user: dict[str, object] = {}
    if os.getuid() == 0:  # a server refuses to be root
        try:
            user = pwd.getpwnam("postgres")
        except KeyError:
            lacking("the user postgres, as whom root starts PostgreSQL,")
        os.chown(folder, user.pw_uid, user.pw_gid)
        as_user = {"user": user.pw_uid, "group": user.pw_gid, "extra_groups": []}
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    common = {"cwd": folder, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, **as_user}
    data = folder / "data"
    secret = folder / "password"
    secret.write_text(PASSWORD_OF_TESTS)
    secret.chmod(0o644)
    asked = ["-A", "scram-sha-256", f"--pwfile={secret}", "-U", "ulna", "-E", "UTF8"]
    subprocess.run([initdb, "-D", data, *asked], check=True, **common)
    os.environ[PASSWORD] = PASSWORD_OF_TESTS
    running = subprocess.Popen(
        [server, "-D", data, "-p", str(port), "-k", folder, "-c", "listen_addresses=127.0.0.1", "-c", "fsync=off"],
        **common,
    )
    try:
        _wait(port, running)
        yield f"postgresql://ulna@127.0.0.1:{port}"
    finally:
        running.send_signal(signal.SIGQUIT)  # ends it at once, whoever is connected
        running.wait(timeout=30)
        os.environ.pop(PASSWORD, None)
        shutil.rmtree(folder, ignore_errors=True)


def _connected(host: str, port: int) -> Any:
    import pg8000.native

    return pg8000.native.Connection(
        "ulna", host=host, port=port, database="postgres", password=PASSWORD_OF_TESTS, timeout=10
    )


def _wait(port: int, running: subprocess.Popen[bytes]) -> None:
    import time

    for _ in range(300):
        assert running.poll() is None, "PostgreSQL ended at once"
        try:
            _connected("127.0.0.1", port).close()
            return
        except Exception:
            time.sleep(0.1)
    raise AssertionError("PostgreSQL did not answer in 30 s")


@pytest.fixture(params=["sqlite", "postgresql"])
def database(request: pytest.FixtureRequest) -> Callable[[], str | None]:
    """Makes an empty database: its URL, None for SQLite in the bench's folder."""
    if request.param == "sqlite":
        return lambda: None
    server = request.getfixturevalue("postgresql")

    def make() -> str:
        host, port = server.removeprefix("postgresql://ulna@").split(":")
        name = f"t{os.urandom(6).hex()}"
        connection = _connected(host, int(port))
        connection.run(f"CREATE DATABASE {name}")
        connection.close()
        return f"{server}/{name}"

    return make


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
