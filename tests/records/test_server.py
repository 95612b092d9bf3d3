"""A server that stops in the middle of work, is started anew, encrypts or does not, and how often it is asked."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest
from sqlalchemy import Connection, event
from sqlalchemy.dialects.postgresql.pg8000 import PGDialect_pg8000
from tests.cli_runs import assert_bad_input, run
from tests.real_parts import lacking
from tests.records.benches import RESULT, evaluation
from tests.records.serving import Server

from ulna import UlnaInputError
from ulna.records.bench import Bench
from ulna.records.database import PASSWORD
from ulna.records.records import Records


@pytest.fixture(scope="module")
def server() -> Iterator[Server]:
    """Of its own: other tests' must not stop."""
    before = os.environ.get(PASSWORD)
    server = Server()
    try:
        yield server
    finally:
        server.end()
        if before is None:
            os.environ.pop(PASSWORD, None)
        else:
            os.environ[PASSWORD] = before


@pytest.fixture
def kept(server: Server, tmp_path: Path) -> Iterator[Records]:
    """A record with an arm and a calibration. The server runs again afterwards."""
    records = Records.init(tmp_path / "bench", server.database(), by="Jan")
    records.register("P7")
    records.add(RESULT, arm="P7")
    yield records
    server.stop()
    server.start()


def chain(records: Records) -> tuple[int, str]:
    """How many entries and the last one's name, of a record with nothing wrong in it. The content of a file whose entry
    was refused may be kept: nothing says so."""
    found = records.verify()
    assert found.wrong == []
    return found.entries, found.head


def test_every_command_says_that_the_server_has_stopped(kept: Records, server: Server, tmp_path: Path) -> None:
    path = evaluation(tmp_path / "e.json", 0.02)
    before = chain(kept)
    server.stop()
    for words in (
        ["add", path, "--arm", "P7"],
        ["history", "P7"],
        ["verify"],
        ["export", "-o", tmp_path / "b.zip"],
        ["backup", tmp_path / "backups"],
        ["rebuild"],
    ):
        done = run("record", *words, ULNA_RECORDS=str(kept.bench.folder))
        assert_bad_input(done, "cannot be used (no server answers at 127.0.0.1")
        assert len(done.stderr.splitlines()) <= 4, done.stderr
    assert not (tmp_path / "b.zip").exists()
    assert not (tmp_path / "backups").exists() or not list((tmp_path / "backups").iterdir())
    server.start()
    assert chain(kept) == before
    kept.add(path, arm="P7")
    assert chain(kept)[0] == before[0] + 1


def _waiting(server: Server, database: str) -> bool:
    """Whether somebody waits for the lock of whoever writes."""
    connection = server.connected(database)
    try:
        ((count,),) = connection.run("SELECT count(*) FROM pg_locks WHERE locktype = 'advisory' AND NOT granted")
    finally:
        connection.close()
    return bool(count)


def test_a_command_at_work_says_that_the_server_has_stopped(kept: Records, server: Server, tmp_path: Path) -> None:
    path = evaluation(tmp_path / "e.json", 0.02)
    before = chain(kept)
    with ExitStack() as writing:
        writing.enter_context(kept.bench.writing())
        waiting = subprocess.Popen(
            [sys.executable, "-m", "ulna", "record", "add", path, "--arm", "P7", "--records", kept.bench.folder],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        )  # fmt: skip
        for _ in range(300):
            if _waiting(server, kept.bench.database.url.rsplit("/", 1)[-1]):
                break
            time.sleep(0.1)
        server.stop()
        with pytest.raises(UlnaInputError, match="connection was lost"):
            writing.close()
    out, said = waiting.communicate(timeout=60)
    assert (waiting.returncode, out) == (2, "")
    assert "Traceback" not in said
    assert "cannot be used" in said
    server.start()
    assert chain(kept) == before


def _stopping(bench: Bench, server: Server, when: str, after: bool) -> None:
    """The server stops before the statement that begins so reaches it, or before anything that comes behind it."""

    def stop(_c: Connection, _k: object, statement: str, *_: object) -> None:
        if statement.startswith(when):
            server.stop()

    event.listen(bench.database.engine, "after_cursor_execute" if after else "before_cursor_execute", stop)


@pytest.mark.parametrize(
    ("when", "after", "said"),
    [
        ("BEGIN", True, "cannot be used"),
        ("SELECT", True, "cannot be used"),
        ("INSERT INTO entry", True, "cannot be used"),
        ("INSERT INTO file", True, "connection was lost"),
        ("COMMIT", False, "connection was lost"),
    ],
)
def test_what_a_server_lost_is_not_there_at_all(
    kept: Records, server: Server, tmp_path: Path, when: str, after: bool, said: str, capfd: pytest.CaptureFixture[str]
) -> None:
    before = chain(kept)
    again = Records.open(kept.bench.folder, by="Jan")
    path = evaluation(tmp_path / "e.json", 0.02)
    _stopping(again.bench, server, when, after)
    with pytest.raises(UlnaInputError, match=said):
        again.add(path, arm="P7")
    assert capfd.readouterr().err == ""
    server.start()
    assert chain(kept) == before
    assert kept.add(path, arm="P7")[0].new
    assert kept.verify().good


def test_a_server_that_stops_after_the_write_has_it(kept: Records, server: Server, tmp_path: Path) -> None:
    before = chain(kept)
    again = Records.open(kept.bench.folder, by="Jan")
    _stopping(again.bench, server, "COMMIT", after=True)
    (filed,) = again.add(evaluation(tmp_path / "e.json", 0.02), arm="P7")
    assert filed.new
    server.start()
    assert chain(kept)[0] == before[0] + 1


def test_rows_are_not_sent_one_by_one(kept: Records, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(PGDialect_pg8000, "do_executemany", lambda *_, **__: pytest.fail("a way for each row"))
    count = []
    event.listen(kept.bench.database.engine, "before_cursor_execute", lambda *_: count.append(1))
    path = tmp_path / "result.json"
    path.write_text(RESULT.read_text() + " ")
    assert kept.add(path, arm="P7")[0].new
    assert len(count) <= 12


def _certified(folder: Path) -> None:
    """A key and a certificate of nobody, as Debian's packages make them."""
    if shutil.which("openssl") is None:
        lacking("openssl")
    key, made = folder / "server.key", folder / "server.crt"
    asked = ["-x509", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=nobody", "-keyout", key, "-out", made]
    subprocess.run(["openssl", "req", *asked], check=True, capture_output=True)
    for each in (key, made):
        each.chmod(0o600)
        os.chown(each, folder.stat().st_uid, folder.stat().st_gid)


@pytest.mark.parametrize("encrypts", [False, True])
def test_the_connection_is_encrypted_where_the_server_can(server: Server, encrypts: bool, tmp_path: Path) -> None:
    if encrypts:
        _certified(server.folder / "data")
    url = server.database()
    connection = server.connected(url.rsplit("/", 1)[-1])
    connection.run(f"ALTER SYSTEM SET ssl = {'on' if encrypts else 'off'}")
    connection.run("SELECT pg_reload_conf()")
    connection.close()
    server.stop()
    server.start()
    bench = Records.init(tmp_path / "bench", url, by="Jan").bench
    with bench.reading() as asking:
        from sqlalchemy import text

        assert asking.scalar(text("SELECT ssl FROM pg_stat_ssl WHERE pid = pg_backend_pid()")) is encrypts
