"""Which kinds of sources there are, by the scheme of their urls; each is loaded when it is opened."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, cast

from ulna.ground.errors import UlnaInputError, nearest
from ulna.ground.extras import need
from ulna.live.source_file import StatedSource, read_source

if TYPE_CHECKING:
    from ulna.live.source import Source
    from ulna.live.sources.wire import Wire
    from ulna.proposals.arms import Drawn


@dataclass(frozen=True)
class Kind:
    """A kind of source."""

    module: str
    """That has `open_source(stated)`, and `wire(stated)` where it brings bytes."""
    example: str
    what: str
    needs: tuple[str, ...] = ()
    """What is imported that an extra brings."""
    bytes: bool = True
    """Whether it brings bytes, which a decoder reads."""
    arm: bool = False
    """Whether the device tells its own geometry: the module has `device_arm(stated)`."""


KINDS: dict[str, Kind] = {
    "serial": Kind("ulna.live.sources.serial", "serial:/dev/ttyACM0?baud=115200", "a serial line"),
    "microscribe": Kind(
        "ulna.live.sources.microscribe", "microscribe:/dev/ttyUSB0", "a MicroScribe digitizer", bytes=False, arm=True
    ),
    "tcp": Kind("ulna.live.sources.tcp", "tcp://host:port", "a server that sends readings"),
    "udp": Kind("ulna.live.sources.udp", "udp://:9000", "datagrams that come to a port of this machine"),
    "ws": Kind("ulna.live.sources.ws", "ws://host:port/path", "a WebSocket server"),
    "wss": Kind("ulna.live.sources.ws", "wss://host/path", "a WebSocket server, encrypted"),
    "rosbridge": Kind("ulna.live.sources.rosbridge", "rosbridge://host:9090/joint_states", "a ROS topic, by rosbridge"),
    "push": Kind(
        "ulna.live.sources.push", "push://127.0.0.1:8765/?token=…", "whoever sends readings here, by WebSocket"
    ),
    "mqtt": Kind("ulna.live.sources.mqtt", "mqtt://host/topic", "messages of a broker's topic", ("paho",)),
    "mqtts": Kind("ulna.live.sources.mqtt", "mqtts://host/topic", "the same, encrypted", ("paho",)),
    "opc.tcp": Kind(
        "ulna.live.sources.opcua", "opc.tcp://host:4840/", "axes of an OPC UA server", ("asyncua",), bytes=False
    ),
    "bag": Kind(
        "ulna.live.sources.bag",
        "bag:run.mcap?topic=/joint_states",
        "a recording of ROS: MCAP, rosbag2, rosbag1",
        ("mcap", "mcap_ros2", "rosbags"),
        bytes=False,
    ),
    "file": Kind("ulna.live.sources.file", "file:run.journal?speed=10", "a recording, or a CSV file", bytes=False),
    "virtual": Kind(
        "ulna.live.sources.virtual", "virtual:arm.toml?rate=1000", "a virtual arm that moves by itself", bytes=False
    ),
}
"""Scheme → kind."""


def kind_of(stated: StatedSource) -> Kind:
    """Raises UlnaInputError for a scheme that nobody knows, or a package that is not installed."""
    kind = KINDS.get(stated.url.scheme)
    if kind is None:
        raise UlnaInputError(
            f"source '{stated.url.text}': unknown kind '{stated.url.scheme}:'.{nearest(stated.url.scheme, KINDS)} "
            "Correct it, or write file: before a path."
        )
    need(f"source {stated.url.scheme}:", *kind.needs)
    return kind


def open_source(stated: StatedSource) -> Source:
    """Opens a source. Raises UlnaInputError."""
    return cast("Source", importlib.import_module(kind_of(stated).module).open_source(stated))


def open_wire(stated: StatedSource) -> Wire:
    """What brings the bytes of a source, undecoded. Raises UlnaInputError where it brings none."""
    kind = kind_of(stated)
    if not kind.bytes:
        raise UlnaInputError(
            f"source '{stated.url.text}': brings readings, not bytes to be guessed at; expected a line, a connection "
            "or messages. Use ulna live watch."
        )
    return cast("Wire", importlib.import_module(kind.module).wire(stated))


def device_arm(stated: StatedSource) -> Drawn | None:
    """The arm as its device itself describes it; None of kinds whose devices do not. Raises UlnaInputError."""
    kind = kind_of(stated)
    if not kind.arm:
        return None
    return cast("Drawn", importlib.import_module(kind.module).device_arm(stated))


@contextmanager
def opened(source: str | Path) -> Iterator[Source]:
    """A source by its url, by a file of `ulna-source/1`, or a recording by its path. Raises UlnaInputError."""
    found = open_source(read_source(source))
    try:
        yield found
    finally:
        found.close()
