"""Real parts: a broker started for the tests; and a calibrated arm."""

from __future__ import annotations

import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.cli_runs import BENT, STRAIGHT, run, write_lengths
from tests.live.hands import NOISE_RAD
from tests.real_parts import lacking


class Broker:
    """Debian's mosquitto, on this machine alone."""

    def __init__(self, folder: Path, program: str, password: str | None = None) -> None:
        with socket.create_server(("127.0.0.1", 0)) as free:
            self.port = free.getsockname()[1]
        lines = [f"listener {self.port} 127.0.0.1", "persistence false", "max_queued_messages 100000"]
        if password is None:
            lines.append("allow_anonymous true")
        else:
            users = folder / "users"
            subprocess.run(
                [str(Path(shutil.which("mosquitto_passwd") or "mosquitto_passwd")), "-b", "-c", users, "jan", password],
                check=True,
                capture_output=True,
            )
            lines += ["allow_anonymous false", f"password_file {users}"]
        config = folder / "mosquitto.conf"
        config.write_text("\n".join(lines) + "\n")
        self._process = subprocess.Popen([program, "-c", config], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        until = time.monotonic() + 20
        while True:
            try:
                socket.create_connection(("127.0.0.1", self.port), timeout=1).close()
                return
            except OSError:
                assert time.monotonic() < until, "mosquitto did not answer in 20 s"
                assert self._process.poll() is None, "mosquitto ended at once"
                time.sleep(0.05)

    def stop(self) -> None:
        self._process.kill()
        self._process.wait(timeout=20)


@pytest.fixture
def broker(tmp_path: Path) -> Iterator[Broker]:
    program = shutil.which("mosquitto") or shutil.which("/usr/sbin/mosquitto")
    if program is None:
        lacking("mosquitto")
    started = Broker(tmp_path, program)
    try:
        yield started
    finally:
        started.stop()


@pytest.fixture(scope="session")
def result(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A calibration of probe bent; of probe straight nothing was measured."""
    folder = tmp_path_factory.mktemp("calibrated")
    probes = {"bent": BENT, "straight": STRAIGHT}
    study = write_lengths(folder, probes=probes, noise=f"[noise]\nencoder = {NOISE_RAD}\nseat = 0.01\n")
    done = run("calibrate", study, "-o", folder / "out")
    assert done.returncode == 0, done.stderr
    return folder / "out"
