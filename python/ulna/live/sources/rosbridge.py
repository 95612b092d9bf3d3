"""`rosbridge://host:9090/joint_states`: a topic of ROS 1 or 2, by rosbridge's protocol (version 2, JSON).

Of the protocol: {"op": "subscribe", "topic": …} asks for a topic; what comes is {"op": "publish", "topic": …, "msg":
…}; {"op": "status", "level": "error", "msg": …} says what went wrong. A JointState has `name`, `position` (rad) and
`header.stamp`.
"""

from __future__ import annotations

import json

from ulna.ground.errors import UlnaInputError
from ulna.live.source import SourceEnded
from ulna.live.source_file import StatedSource
from ulna.live.sources.wire import WireSource
from ulna.live.sources.ws import WsWire
from ulna.live.tables import JsonTable

JOINT_STATE = JsonTable(kind="json", values=["msg.position"], joints="msg.name", time="msg.header.stamp", time_unit="s")
PORT = 9090


class RosbridgeWire(WsWire):
    """A topic."""

    def __init__(self, address: str, topic: str) -> None:
        """Raises UlnaInputError where nobody answers."""
        super().__init__(address, f"{address} {topic}")
        self.connection.send(json.dumps({"op": "subscribe", "topic": topic, "queue_length": 0, "throttle_rate": 0}))

    def receive(self) -> list[bytes]:
        """As `Wire`."""
        message = self.message()
        if message is None:
            return []
        try:
            document = json.loads(message)
        except (ValueError, RecursionError):
            return [message]  # the decoder says that it is none
        if isinstance(document, dict) and document.get("op") == "status":
            if document.get("level") == "error":
                raise SourceEnded(f"{self.device}: rosbridge says: {str(document.get('msg'))[:200]}")
            return []
        return [message]


def wire(stated: StatedSource) -> RosbridgeWire:
    """The topic of a source."""
    url = stated.url
    url.check(("wait",), host=True)
    if url.path in ("", "/"):
        raise UlnaInputError(f"source '{url.text}': expected a topic: rosbridge://host:9090/joint_states. Add it.")
    return RosbridgeWire(f"ws://{url.host}:{url.port or PORT}", url.path)


def open_source(stated: StatedSource) -> WireSource:
    """As the registry asks. Raises UlnaInputError."""
    decoder = stated.decoder(JOINT_STATE, midway=False, messages=True)
    unit = stated.file.map.unit or "rad"
    wait_s = stated.url.number("wait", 5, 0.1, 3600)
    return WireSource(wire(stated), decoder, unit, wait_s)
