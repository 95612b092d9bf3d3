"""A real PostgreSQL server, from Debian's package, that a test may stop and start."""

from __future__ import annotations

import os
import pwd
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

from tests.real_parts import lacking

from ulna.records.database import PASSWORD

PASSWORD_OF_TESTS = "of tests"


def _program(name: str) -> str | None:
    """Debian keeps those of a server beside each other, by version."""
    found = sorted(Path("/usr/lib/postgresql").glob(f"*/bin/{name}"), key=lambda path: int(path.parts[4]))
    return str(found[-1]) if found else shutil.which(name)


class Server:
    """It listens on this machine alone."""

    def __init__(self, *options: str) -> None:
        """options: of `postgres`, such as "ssl=on". Skips the test where there is no PostgreSQL."""
        initdb, server = _program("initdb"), _program("postgres")
        if initdb is None or server is None:
            lacking("PostgreSQL")
        self.folder = Path(tempfile.mkdtemp(prefix="ulna-postgresql-"))
        as_user: dict[str, object] = {}
        if os.getuid() == 0:  # a server refuses to be root
            try:
                user = pwd.getpwnam("postgres")
            except KeyError:
                lacking("the user postgres, as whom root starts PostgreSQL,")
            os.chown(self.folder, user.pw_uid, user.pw_gid)
            as_user = {"user": user.pw_uid, "group": user.pw_gid, "extra_groups": []}
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port: int = probe.getsockname()[1]
        self._how: Any = {
            "cwd": self.folder, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, **as_user
        }  # fmt: skip
        data = self.folder / "data"
        secret = self.folder / "password"
        secret.write_text(PASSWORD_OF_TESTS)
        secret.chmod(0o644)
        asked = ["-A", "scram-sha-256", f"--pwfile={secret}", "-U", "ulna", "-E", "UTF8"]
        subprocess.run([initdb, "-D", data, *asked], check=True, **self._how)
        settings = ("listen_addresses=127.0.0.1", "fsync=off", *options)
        self._words = [server, "-D", data, "-p", str(self.port), "-k", self.folder]
        self._words += [word for each in settings for word in ("-c", each)]
        self._running: subprocess.Popen[bytes] | None = None
        self.start()

    @property
    def url(self) -> str:
        """Without a database's name."""
        return f"postgresql://ulna@127.0.0.1:{self.port}"

    def start(self) -> None:
        """Until it answers."""
        os.environ[PASSWORD] = PASSWORD_OF_TESTS
        self._running = subprocess.Popen(self._words, **self._how)
        for _ in range(300):
            assert self._running.poll() is None, "PostgreSQL ended at once"
            try:
                self.connected().close()
                return
            except Exception:
                time.sleep(0.1)
        raise AssertionError("PostgreSQL did not answer in 30 s")

    def stop(self) -> None:
        """At once, whoever is connected, as `pg_ctl stop -m immediate` does."""
        if self._running is not None:
            self._running.send_signal(signal.SIGQUIT)
            self._running.wait(timeout=30)
        self._running = None

    def end(self) -> None:
        """Nothing is left of it."""
        self.stop()
        shutil.rmtree(self.folder, ignore_errors=True)

    def connected(self, database: str = "postgres") -> Any:
        """By the driver itself."""
        import pg8000.native

        return pg8000.native.Connection(
            "ulna", host="127.0.0.1", port=self.port, database=database, password=PASSWORD_OF_TESTS, timeout=10
        )

    def database(self) -> str:
        """URL of a new one."""
        name = f"t{os.urandom(6).hex()}"
        connection = self.connected()
        connection.run(f"CREATE DATABASE {name}")
        connection.close()
        return f"{self.url}/{name}"
