"""MQTT through Debian's mosquitto, OPC UA through a server of asyncua's, a relay into a push source."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import threading
import time
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from tests.live.parts import collected, in_thread

from ulna.ground.errors import UlnaInputError
from ulna.live.faults import ENDED
from ulna.live.registry import opened
from ulna.live.source import SourceEnded

if TYPE_CHECKING:
    from tests.live.conftest import Broker

N = 400
Q = np.round(np.random.default_rng(8).normal(size=(N, 6)).cumsum(axis=0), 4)


def publish(port: int, messages: list[bytes], after_s: float = 0.4) -> None:
    from paho.mqtt.client import Client
    from paho.mqtt.enums import CallbackAPIVersion

    time.sleep(after_s)
    client: Any = Client(CallbackAPIVersion.VERSION2)
    client.max_queued_messages_set(0)
    client.connect("127.0.0.1", port)
    client.loop_start()
    for each in [client.publish("arm/angles", message, qos=1) for message in messages]:
        each.wait_for_publish(timeout=10)
    client.disconnect()
    client.loop_stop()


def test_messages_through_a_broker_none_lost(broker: Broker, tmp_path: Path) -> None:
    messages = [json.dumps({"axes": list(row), "t": k / 100}).encode() for k, row in enumerate(Q)]
    toml = tmp_path / "source.toml"
    toml.write_text(
        f'format = "ulna-source/1"\nurl = "mqtt://127.0.0.1:{broker.port}/arm/angles"\n'
        '[decode]\nkind = "json"\nvalues = ["axes"]\ntime = "t"\ntime_unit = "s"\n'
    )
    with in_thread(lambda: publish(broker.port, messages)), opened(toml) as source:
        samples, faults, _ = collected(source, N)
    np.testing.assert_array_equal(samples.raw, Q)
    assert samples.t_device_s is not None
    assert faults == []


def test_a_broker_that_is_gone_is_named_once(broker: Broker) -> None:
    def send() -> None:
        publish(broker.port, [b"1,2,3"] * 10)
        time.sleep(0.3)
        broker.stop()

    with in_thread(send), opened(f"mqtt://127.0.0.1:{broker.port}/arm/angles") as source:
        samples, faults, why = collected(source, N)
        with pytest.raises(SourceEnded):
            source.read(0.1)
        assert source.faults() == []
    assert len(samples) == 10
    assert why is not None
    assert "the broker is gone" in why
    assert [fault.kind for fault in faults] == [ENDED]


def test_no_broker() -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    with pytest.raises(UlnaInputError, match="no broker answers"), opened(f"mqtt://127.0.0.1:{port}/arm"):
        pass
    with pytest.raises(UlnaInputError, match="expected a topic"), opened(f"mqtt://127.0.0.1:{port}"):
        pass


BEGIN = datetime(2100, 1, 1, tzinfo=UTC)
FIRST = round(BEGIN.timestamp()) * 100


class OpcUa:
    """A server with six axes, as OPC 40010 nests them, and a node that holds them all."""

    def __init__(self) -> None:
        from asyncua.sync import Server

        with socket.create_server(("127.0.0.1", 0)) as free:
            self.port = free.getsockname()[1]
        self.server: Any = Server()
        self.server.set_endpoint(f"opc.tcp://127.0.0.1:{self.port}/")
        self.server.set_security_policy([_no_security()])
        space = self.server.register_namespace("urn:ulna:test")
        axes = self.server.nodes.objects.add_object(space, "Robot").add_object(space, "Axes")
        self.axes = []
        for k in range(6):
            parameters = axes.add_object(space, f"Axis_{k + 1}").add_object(space, "ParameterSet")
            self.axes.append(parameters.add_variable(space, "ActualPosition", float(Q[0, k])))
        self.all = axes.add_variable(f"ns={space};s=Q", f"{space}:Q", [float(each) for each in Q[0]])
        self.server.start()

    def write(self, k: int) -> None:
        from asyncua import ua

        stamp = BEGIN + timedelta(seconds=k / 100)

        def value(of: Any) -> Any:
            return ua.DataValue(ua.Variant(of, ua.VariantType.Double), SourceTimestamp=stamp)

        for node, angle in zip(self.axes, Q[k].tolist(), strict=True):
            node.write_value(value(angle))
        self.all.write_value(value(Q[k].tolist()))

    def stop(self) -> None:
        self.server.stop()


def _no_security() -> Any:
    from asyncua import ua

    return ua.SecurityPolicyType.NoSecurity


@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ResourceWarning")
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("node", ["", "?node=ns=2;s=Q"])
def test_axes_of_an_opc_ua_server_are_found_and_none_is_lost(node: str) -> None:
    server = OpcUa()
    try:

        def write() -> None:
            time.sleep(0.5)
            for k in range(1, 150):
                server.write(k)
                time.sleep(0.002)

        last: dict[int, Any] = {}  # by hundredths of a second: on a busy machine axes of one time may come in two rows
        with opened(f"opc.tcp://127.0.0.1:{server.port}/{node}") as source:
            assert len(source.hello.channels) == 6
            with in_thread(write):
                until = time.monotonic() + 30
                while FIRST + 149 not in last or not np.array_equal(last[FIRST + 149], Q[149]):
                    assert time.monotonic() < until
                    samples = source.read(0.5)
                    stamps = np.empty(0) if samples.t_device_s is None else samples.t_device_s
                    last |= dict(zip(np.round(stamps * 100).astype(int).tolist(), samples.raw, strict=True))
            faults = source.faults()
        written = [stamp for stamp in sorted(last) if stamp >= FIRST]
        assert written == list(range(FIRST + 1, FIRST + 150))
        np.testing.assert_array_equal(np.array([last[stamp] for stamp in written]), Q[1:150])
        assert faults == []
    finally:
        server.stop()


@pytest.mark.filterwarnings("ignore::DeprecationWarning", "ignore::ResourceWarning")
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_no_opc_ua_server() -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    with pytest.raises(UlnaInputError, match="no OPC UA server answers"), opened(f"opc.tcp://127.0.0.1:{port}/"):
        pass


def test_a_relay_hands_on_every_sample(tmp_path: Path) -> None:
    csv = tmp_path / "run.csv"
    rows = [f"{1 + k / 400!r},{k / 100!r}," + ",".join(map(repr, row)) for k, row in enumerate(Q.tolist())]
    csv.write_text("\n".join(["t_host_s,t_device_s,a,b,c,d,e,f", *rows]) + "\n")
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    done: list[subprocess.CompletedProcess[str]] = []

    def relay() -> None:
        time.sleep(0.3)
        words = ["live", "relay", str(csv), f"ws://127.0.0.1:{port}/?token=x"]
        env = os.environ | {"TERM": "dumb"}
        done.append(
            subprocess.run(
                [sys.executable, "-m", "ulna", *words], check=False, capture_output=True, text=True, env=env, timeout=60
            )
        )

    thread = threading.Thread(target=relay)
    thread.start()
    with opened(f"push://127.0.0.1:{port}/?token=x&wait=30") as source:
        samples, faults, _ = collected(source, N, seconds=40)
        thread.join(timeout=60)
    assert done[0].returncode == 0, done[0].stderr
    assert source.hello.channels == tuple("abcdef")
    np.testing.assert_array_equal(samples.raw, Q)
    assert faults == []
