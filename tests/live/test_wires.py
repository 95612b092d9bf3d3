"""Serial lines, connections, datagrams, WebSockets: real ones, with both ends here."""

from __future__ import annotations

import json
import random
import shutil
import socket
import subprocess
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.live.parts import collected, in_thread, pty
from tests.real_parts import lacking

from ulna.ground.errors import UlnaInputError
from ulna.live.faults import ENDED, GARBAGE, TOO_LONG
from ulna.live.registry import opened
from ulna.live.source import SourceEnded
from ulna.live.source_file import read_source

N = 300
Q = np.round(np.random.default_rng(3).normal(size=(N, 7)).cumsum(axis=0), 4)
LINES = [(",".join(map(repr, map(float, row))) + "\n").encode() for row in Q]


def test_a_serial_line_cut_at_will_with_garbage_between() -> None:
    source_of = random.Random(5)
    with pty() as line:

        def send() -> None:
            time.sleep(0.2)
            stream = b"half a line,3\n" + b"".join(
                each + (b"\xff\x00noise\n" if k in (50, 51, 200) else b"") for k, each in enumerate(LINES)
            )
            while stream:
                n = source_of.randrange(1, 90)
                line.send(stream[:n])
                stream = stream[n:]

        with in_thread(send), opened(f"serial:{line.path}") as source:
            samples, faults, _ = collected(source, N)
    np.testing.assert_array_equal(samples.raw, Q)
    assert np.all(np.diff(samples.t_host_s) >= 0)
    assert [fault.kind for fault in faults] == [GARBAGE] * 4
    assert source.hello.channels == ("c1", "c2", "c3", "c4", "c5", "c6", "c7")


def test_a_pulled_cable_is_named_once() -> None:
    with pty() as line:

        def send() -> None:
            time.sleep(0.2)
            line.send(b"x\n" + b"".join(LINES[:20]))
            time.sleep(0.3)
            line.pull()

        with in_thread(send), opened(f"serial:{line.path}") as source:
            samples, faults, why = collected(source, N)
            with pytest.raises(SourceEnded):
                source.read(0.1)
    np.testing.assert_array_equal(samples.raw, Q[:20])
    assert why is not None
    assert "cable was pulled" in why
    assert [fault.kind for fault in faults if fault.kind != GARBAGE] == [ENDED]


def test_two_ports_joined_by_socat(tmp_path: Path) -> None:
    if shutil.which("socat") is None:
        lacking("socat")
    here, there = tmp_path / "here", tmp_path / "there"
    process = subprocess.Popen(
        ["socat", f"pty,raw,echo=0,link={here}", f"pty,raw,echo=0,link={there}"], stderr=subprocess.DEVNULL
    )
    try:
        until = time.monotonic() + 10
        while not (here.exists() and there.exists()):
            assert time.monotonic() < until
            time.sleep(0.02)

        def send() -> None:
            time.sleep(0.3)
            with here.open("wb", buffering=0) as port:
                port.write(b"\n" + b"".join(LINES))

        with in_thread(send), opened(f"serial:{there}?baud=921600") as source:
            samples, _, _ = collected(source, N)
    finally:
        process.terminate()
        process.wait(timeout=10)
    np.testing.assert_array_equal(samples.raw, Q)


def test_what_is_no_reading_for_long_is_said(tmp_path: Path) -> None:
    def send() -> None:
        time.sleep(0.2)
        line.send(b"Marlin 2.1\nok\n")

    with (
        pty() as line,
        in_thread(send),
        pytest.raises(UlnaInputError, match=r"no reading in 0\.6 s; 1\d bytes came that are none"),
        opened(f"serial:{line.path}?wait=0.6"),
    ):
        pass


def test_too_long_lines_end_a_source_with_a_sentence() -> None:
    with server(b"1,2\n" + b"1," * 2500) as port, opened(f"tcp://127.0.0.1:{port}") as source:
        samples, faults, why = collected(source, 10)
    assert len(samples) == 1
    assert why is not None
    assert "more than 4096 bytes" in why
    assert [fault.kind for fault in faults] == [TOO_LONG]


def test_too_many_channels_are_refused() -> None:
    with (
        server(b",".join([b"1"] * 33) + b"\n") as port,
        pytest.raises(UlnaInputError, match="33 fields"),
        opened(f"tcp://127.0.0.1:{port}"),
    ):
        pass


class server:  # noqa: N801 (a context manager that reads as a function)
    """Sends bytes to whoever connects, in small pieces, and ends."""

    def __init__(self, data: bytes, pieces: int = 23) -> None:
        self._data, self._pieces = data, pieces
        self._socket = socket.create_server(("127.0.0.1", 0))

    def __enter__(self) -> int:
        threading.Thread(target=self._serve, daemon=True).start()
        return int(self._socket.getsockname()[1])

    def _serve(self) -> None:
        try:
            connection, _ = self._socket.accept()
            with connection:
                for at in range(0, len(self._data), self._pieces):
                    connection.sendall(self._data[at : at + self._pieces])
                time.sleep(0.1)
        except OSError:
            pass  # whoever read has seen enough

    def __exit__(self, *_: object) -> None:
        self._socket.close()


def test_tcp_cut_at_will_to_its_end() -> None:
    with server(b"".join(LINES)) as port, opened(f"tcp://127.0.0.1:{port}") as source:
        samples, faults, why = collected(source, N + 1)
    np.testing.assert_array_equal(samples.raw, Q)
    assert why == f"tcp://127.0.0.1:{port}: the other side ended the connection."
    assert [fault.kind for fault in faults] == [ENDED]


def test_nobody_there() -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    for url, words in (
        (f"tcp://127.0.0.1:{port}", "nobody answers"),
        (f"ws://127.0.0.1:{port}", "nobody answers as a WebSocket"),
        (f"rosbridge://127.0.0.1:{port}/joint_states", "nobody answers as a WebSocket"),
        ("serial:/dev/nowhere", "cannot be opened"),
    ):
        with pytest.raises(UlnaInputError, match=words), opened(url):
            pass


def test_datagrams() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]

    def send() -> None:
        time.sleep(0.3)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as out:
            for each in LINES:
                out.sendto(each.rstrip(), ("127.0.0.1", port))  # a datagram is a line, end or no end

    with in_thread(send), opened(f"udp://127.0.0.1:{port}") as source:
        samples, faults, _ = collected(source, N)
    np.testing.assert_array_equal(samples.raw, Q)
    assert faults == []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        with (
            pytest.raises(UlnaInputError, match="expected a free port"),
            opened(f"udp://127.0.0.1:{taken.getsockname()[1]}"),
        ):
            pass


class websocket_server:  # noqa: N801 (a context manager that reads as a function)
    """A server that does with each connection what it is told."""

    def __init__(self, work: Any) -> None:
        self._work = work

    def __enter__(self) -> int:
        from websockets.sync.server import serve

        self._server = serve(self._work, "127.0.0.1", 0)
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)
        self._thread.start()
        return int(self._server.socket.getsockname()[1])

    def __exit__(self, *_: object) -> None:
        self._server.shutdown()
        self._thread.join(timeout=10)


def test_websocket_of_json(tmp_path: Path) -> None:
    def work(connection: Any) -> None:
        for k, row in enumerate(Q):
            connection.send(json.dumps({"arm": {"angles": list(row), "ms": 10 * k, "pressed": k == 7}}))
        connection.send("no json")

    with websocket_server(work) as port:
        toml = tmp_path / "source.toml"
        toml.write_text(
            f'format = "ulna-source/1"\nurl = "ws://127.0.0.1:{port}/arm"\n'
            '[decode]\nkind = "json"\nvalues = ["arm.angles"]\ntime = "arm.ms"\nbutton = "arm.pressed"\n'
        )
        with opened(toml) as source:
            samples, faults, why = collected(source, N + 1)
    np.testing.assert_array_equal(samples.raw, Q)
    assert samples.t_device_s is not None
    np.testing.assert_allclose(samples.t_device_s, np.arange(N) / 100, rtol=1e-12)
    assert samples.button is not None
    assert list(np.flatnonzero(samples.button)) == [7]
    assert why is not None
    assert [fault.kind for fault in faults] == [GARBAGE, ENDED]


def test_a_double_of_rosbridge() -> None:
    asked = []

    def work(connection: Any) -> None:
        asked.append(json.loads(connection.recv(timeout=5)))
        connection.send(json.dumps({"op": "status", "level": "info", "msg": "hello"}))
        for k, row in enumerate(Q):
            order = list(range(7)) if k % 2 == 0 else [6, 5, 4, 3, 2, 1, 0]
            message = {
                "header": {"stamp": {"sec": 100 + k // 10, "nanosec": (k % 10) * 100_000_000}, "frame_id": ""},
                "name": [f"joint_{j}" for j in order],
                "position": [row[j] for j in order],
                "velocity": [],
            }
            connection.send(json.dumps({"op": "publish", "topic": "/joint_states", "msg": message}))
        connection.send(json.dumps({"op": "status", "level": "error", "msg": "topic gone"}))
        time.sleep(0.5)

    with websocket_server(work) as port, opened(f"rosbridge://127.0.0.1:{port}/joint_states") as source:
        samples, _, why = collected(source, N + 1)
    assert asked[0]["op"] == "subscribe"
    assert asked[0]["topic"] == "/joint_states"
    assert source.hello.channels == tuple(f"joint_{j}" for j in range(7))
    assert source.hello.unit == "rad"
    np.testing.assert_array_equal(samples.raw, Q)
    assert samples.t_device_s is not None
    np.testing.assert_allclose(samples.t_device_s, 100 + np.arange(N) / 10, rtol=1e-12)
    assert why is not None
    assert "topic gone" in why


def test_somebody_pushes_with_a_token() -> None:
    from websockets.exceptions import InvalidStatus
    from websockets.sync.client import connect

    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    refused = []

    def send() -> None:
        time.sleep(0.4)
        try:
            connect(f"ws://127.0.0.1:{port}/?token=wrong")
        except InvalidStatus as error:
            refused.append(error.response.status_code)
        with connect(f"ws://127.0.0.1:{port}/", additional_headers={"Authorization": "Bearer a secret"}) as out:
            for k, row in enumerate(Q[:150]):
                out.send(json.dumps({"q": list(row), "t": k / 100}))
        time.sleep(0.1)
        with connect(f"ws://127.0.0.1:{port}/?token=a%20secret") as out:  # it comes again
            for k, row in enumerate(Q[150:], start=150):
                out.send(json.dumps({"q": list(row), "t": k / 100}))

    with in_thread(send), opened(f"push://127.0.0.1:{port}/?token=a%20secret") as source:
        samples, _, _ = collected(source, N)
        assert "secret" not in source.hello.device
    assert refused == [401]
    np.testing.assert_array_equal(samples.raw, Q)
    assert samples.t_device_s is not None


def test_a_push_server_for_others_needs_a_token() -> None:
    with pytest.raises(UlnaInputError, match="expected a token"), opened("push://0.0.0.0:0"):
        pass


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("seriell:/dev/x", r"unknown kind 'seriell:'\. Did you mean 'serial'"),
        ("tcp://host", "expected tcp://host:port"),
        ("tcp://host:99999", "not a url"),
        ("serial:/dev/x?bauds=9600", "unknown option 'bauds'.*Did you mean 'baud'"),
        ("serial:/dev/x?baud=fast", "option 'baud': got 'fast', expected a number"),
        ("serial:/dev/x?parity=sometimes", "expected none or even or odd"),
        ("serial:", "expected serial:PORT"),
        ("rosbridge://h:1", "expected a topic"),
        ("tcp://a:1?wait=1&wait=2", "says wait twice"),
    ],
)
def test_urls_that_are_wrong(url: str, words: str) -> None:
    with pytest.raises(UlnaInputError, match=words), opened(url):
        pass


def test_passwords_and_tokens_are_not_shown() -> None:
    assert "pw" not in read_source("mqtt://jan:pwpw@host/topic").url.text
    assert "tktk" not in read_source("push://host:1/?token=tktk").url.text
