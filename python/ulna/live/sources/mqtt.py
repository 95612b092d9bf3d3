"""`mqtt://host:1883/topic`: messages of a topic, from a broker. User and password may stand before the host."""

from __future__ import annotations

import threading
from typing import Any

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.source import SourceEnded
from ulna.live.source_file import StatedSource
from ulna.live.sources.mailbox import Mailbox
from ulna.live.sources.wire import WireSource
from ulna.live.tables import FieldsTable

PORT, PORT_TLS = 1883, 8883
_KEEPALIVE_S = 5
"""A cable that was pulled is noticed after one and a half of it."""


class MqttWire:
    """A topic. A broker that goes away ends the source: what it would have sent meanwhile is lost."""

    messages = True

    def __init__(self, stated: StatedSource) -> None:
        """Raises UlnaInputError where no broker answers, or it refuses."""
        from paho.mqtt.client import Client
        from paho.mqtt.enums import CallbackAPIVersion

        url = stated.url
        url.check(("wait", "qos"), host=True)
        self._topic = url.path.removeprefix("/")
        if not self._topic:
            raise UlnaInputError(f"source '{url.text}': expected a topic: mqtt://host/topic. Add it.")
        self._qos = int(url.number("qos", 1, 0, 2))
        tls = url.scheme == "mqtts"
        port = url.port or (PORT_TLS if tls else PORT)
        self.device = f"{url.scheme}://{url.host}:{port}/{self._topic}"
        self._mailbox, self._ready = Mailbox(), threading.Event()
        self._refused = list[str]()
        self._gone: str | None = None
        client: Any = Client(CallbackAPIVersion.VERSION2)
        if url.user is not None:
            client.username_pw_set(url.user, url.password)
        if tls:
            client.tls_set()
        client.on_connect, client.on_subscribe = self._connected, self._subscribed
        client.on_disconnect, client.on_message = self._left, self._message
        self._client = client
        try:
            client.connect(url.host, port, keepalive=_KEEPALIVE_S)
        except OSError as error:
            raise UlnaInputError(
                f"{self.device}: no broker answers ({error.strerror or error}); expected one. Check the address, and "
                "that it runs."
            ) from None
        client.loop_start()
        if not self._ready.wait(10.0):
            self._refused.append("no answer in 10 s")
        if self._refused:
            self.close()
            raise UlnaInputError(
                f"{self.device}: the broker refuses ({self._refused[0]}). Check user, password and topic."
            )

    def _connected(self, client: Any, _data: Any, _flags: Any, reason: Any, _properties: Any) -> None:
        if reason.is_failure:
            self._refused.append(str(reason))
            self._ready.set()
        elif self._gone is None:
            client.subscribe(self._topic, qos=self._qos)

    def _subscribed(self, _client: Any, _data: Any, _mid: Any, reasons: Any, _properties: Any) -> None:
        if any(reason.is_failure for reason in reasons):
            self._refused.append(f"topic '{self._topic}': {reasons[0]}")
        self._ready.set()

    def _left(self, _client: Any, _data: Any, _flags: Any, reason: Any, _properties: Any) -> None:
        self._gone = worded("{device}: the broker is gone ({why}).", device=self.device, why=str(reason))
        self._mailbox.wake()

    def _message(self, _client: Any, _data: Any, message: Any) -> None:
        self._mailbox.put(message.payload)

    def receive(self) -> list[bytes]:
        """As `Wire`."""
        found = self._mailbox.taken()
        if not found and self._gone is not None:
            raise SourceEnded(self._gone)
        return found

    def close(self) -> None:
        """As `Wire`."""
        self._client.disconnect()
        self._client.loop_stop()


def wire(stated: StatedSource) -> MqttWire:
    """The topic of a source."""
    return MqttWire(stated)


def open_source(stated: StatedSource) -> WireSource:
    """As the registry asks. Raises UlnaInputError."""
    decoder = stated.decoder(FieldsTable(), midway=False, messages=True)
    wait_s = stated.url.number("wait", 5, 0.1, 3600)
    return WireSource(wire(stated), decoder, stated.file.map.unit, wait_s)
