"""What a cluster that is none, or that is lost, is told as: one message, within seconds."""

from __future__ import annotations

import http.server
import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from tests.small_study import says

from ulna.ground.errors import UlnaInputError
from ulna.work import dask_scheduler, on_dask
from ulna.work.pieces import workers_at

pytestmark = [
    # connections that are cut on purpose stay open at the end
    pytest.mark.filterwarnings("ignore::ResourceWarning"),
    pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning"),
]


@pytest.fixture
def impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    """As Ulna is, with less patience where nobody will answer."""
    assert dask_scheduler.CONNECT_S + dask_scheduler.ANSWER_S <= 10.0
    assert on_dask.SILENT_S + dask_scheduler.WORKERS_S <= 10.0
    for room, name in ((dask_scheduler, "CONNECT_S"), (dask_scheduler, "ANSWER_S"), (on_dask, "SILENT_S")):
        monkeypatch.setattr(room, name, getattr(room, name) / 2.0)


def slowly(piece: int) -> int:
    time.sleep(0.2)
    return piece


def deadly(piece: int) -> int:
    os.kill(os.getpid(), signal.SIGKILL)
    return piece


def told(address: str, work: Callable[[Any], Any] = abs, then: Callable[[], None] = lambda: None) -> str:
    """The message; nothing else may come of it. `then` happens when the first piece is there."""

    def ask() -> None:
        with workers_at(address) as workers:
            for number, _ in enumerate(workers.each(work, list(range(200)))):
                if number == 0:
                    then()

    with pytest.raises(UlnaInputError) as caught:
        ask()
    says(str(caught.value), f"--dask {address}")
    return str(caught.value)


@contextmanager
def process(*arguments: str, failures: str = "3") -> Iterator[tuple[subprocess.Popen[str], str]]:
    """Part of a cluster in a process of its own, and the address that it printed."""
    with subprocess.Popen(
        [sys.executable, "-m", "distributed.cli." + arguments[0], *arguments[1:]],
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ | {"DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": failures},
    ) as started:
        try:
            assert started.stderr is not None
            for line in started.stderr:
                found = re.search(r"(?:Scheduler|Start worker) at: +(\S+)", line)
                if found:
                    threading.Thread(target=started.stderr.read, daemon=True).start()
                    yield started, found.group(1)
                    break
        finally:
            started.send_signal(signal.SIGCONT)
            started.kill()


@contextmanager
def cluster(
    folder: Path, nanny: bool = False, failures: str = "3"
) -> Iterator[tuple[subprocess.Popen[str], subprocess.Popen[str], str]]:
    """A scheduler, a worker, and the address."""
    scheduler = ("dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--no-show")
    with process(*scheduler, failures=failures) as (first, address):
        worker = (
            "dask_worker", address, "--nthreads", "1", "--no-dashboard", "--nanny" if nanny else "--no-nanny",
            "--local-directory", str(folder),
        )  # fmt: skip
        with process(*worker) as (second, _):
            yield first, second, address


@pytest.mark.parametrize(
    "address", ["cluster", "", "tcp://127.0.0.1", "http://127.0.0.1:8786", "tcp://:8786", "tcp://h:99999", "ucx://h:5"]
)
def test_what_is_no_address_is_told(address: str) -> None:
    says(told(address), "is no address of a scheduler", "tcp://10.0.0.7:8786")


def test_tls_without_certificates_is_told() -> None:
    says(told("tls://127.0.0.1:8786"), "TLS without certificates", "ca-file")


@pytest.mark.usefixtures("impatient")
def test_nobody_there_is_told() -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    says(told(f"tcp://127.0.0.1:{port}"), "no scheduler answers there", "Start it")


@pytest.mark.usefixtures("impatient")
def test_another_service_is_told() -> None:
    """One that waits for a word, and one that speaks another language."""
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen()
        says(told(f"tcp://127.0.0.1:{silent.getsockname()[1]}"), "is no scheduler")

    class Quiet(http.server.BaseHTTPRequestHandler):
        def log_message(self, *_args: Any) -> None:
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Quiet) as web:
        threading.Thread(target=web.serve_forever, daemon=True).start()
        says(told(f"tcp://127.0.0.1:{web.server_port}"), "is no scheduler")
        web.shutdown()


def test_a_scheduler_without_workers_and_a_worker_for_a_scheduler(tmp_path: Path) -> None:
    with process("dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--no-show") as (_, address):
        says(told(address), "no workers", f"dask worker {address}")
        worker = ("dask_worker", address, "--no-nanny", "--no-dashboard", "--local-directory", str(tmp_path))
        with process(*worker) as (_, other):
            says(told(other), "is a worker, not a scheduler", address)


@pytest.mark.usefixtures("impatient")
@pytest.mark.parametrize("lost", ["scheduler killed", "scheduler stopped", "worker killed"])
def test_what_is_lost_midway_is_told(lost: str, tmp_path: Path) -> None:
    with cluster(tmp_path) as (scheduler, worker, address):
        gone = worker if lost == "worker killed" else scheduler
        sign = signal.SIGSTOP if lost == "scheduler stopped" else signal.SIGKILL
        said = told(address, slowly, then=lambda: gone.send_signal(sign))
    says(said, "no workers" if gone is worker else "scheduler")


def test_work_that_kills_its_workers_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(on_dask, "RETRIES", 0)
    with cluster(tmp_path, nanny=True, failures="0") as (_, _, address):
        says(told(address, deadly), "ended every worker that took it", "memory")


def test_another_version_on_a_worker_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(on_dask, "VERSION", "99.0")
    with cluster(tmp_path) as (_, _, address):
        says(told(address), "a worker has Ulna ", "expected Ulna 99.0", "Install that one")
