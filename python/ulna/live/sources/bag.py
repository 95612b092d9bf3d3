"""`bag:run.mcap?topic=/joint_states`: JointState messages of a recording of ROS: MCAP, rosbag2 (a folder), rosbag1
(.bag)."""

from __future__ import annotations

import json
import time
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from ulna.formats.toml import read_bytes
from ulna.ground.errors import UlnaInputError, nearest
from ulna.ground.worded import worded
from ulna.live.decode.decoder import Row
from ulna.live.faults import GARBAGE, Fault
from ulna.live.samples import MOST_CHANNELS, Hello, Samples
from ulna.live.source_file import StatedSource
from ulna.live.sources.file import FileSource
from ulna.live.sources.wire import as_samples

TYPES = ("sensor_msgs/msg/JointState", "sensor_msgs/JointState")
AT_ONCE = 1024
State = tuple[float, float | None, list[str], list[float]]
"""Time of the recording and of the message's header, s; names and positions."""


class BagBlocks:
    """The joint states of a topic."""

    def __init__(self, path: Path, topic: str | None) -> None:
        """Raises UlnaInputError where there is no such topic, or no message in it."""
        self._path, self._topic = path, topic
        self.faults: list[Fault] = []
        first = next(self._states(), None)
        if first is None:
            raise UlnaInputError(f"{path}: no joint state with positions in it; expected some. Check the topic.")
        self.hello = Hello(tuple(first[2]), "rad", str(path), None)
        if not 0 < len(self.hello.channels) <= MOST_CHANNELS:
            raise UlnaInputError(f"{path}: {len(self.hello.channels)} joints; expected 1 to {MOST_CHANNELS}.")

    def _states(self) -> Iterator[State]:
        if self._path.is_dir() or self._path.suffix == ".bag":
            return _by_rosbags(self._path, self._topic)
        read_bytes(self._path, "a recording of ROS (.mcap, .bag, or a folder of rosbag2)", 8)
        if self._path.suffix == ".db3":
            return _by_rosbags(self._path.parent, self._topic)
        return _by_mcap(self._path, self._topic)

    def __iter__(self) -> Iterator[Samples]:
        names, rows, skipped = self.hello.channels, list[Row](), 0
        for t_host_s, t_device_s, said, positions in self._states():
            by_name = dict(zip(said, positions, strict=False))
            if not set(names) <= by_name.keys():
                skipped += 1
                continue
            rows.append(Row(t_host_s, t_device_s, tuple(by_name[name] for name in names), None))
            if len(rows) == AT_ONCE:
                yield as_samples(rows, len(names))
                rows = []
        yield as_samples(rows, len(names))
        if skipped:
            text = worded(
                "{count} messages skipped, in which not all joints are: {names}.",
                count=skipped,
                names=", ".join(names)[:80],
            )
            self.faults.append(Fault(GARBAGE, time.monotonic(), text))


def _chosen(path: Path, topics: Mapping[str, str], topic: str | None) -> str:
    """The topic, or the only one of joint states. Raises UlnaInputError."""
    states = sorted(name for name, kind in topics.items() if kind in TYPES)
    if topic is None and len(states) == 1:
        return states[0]
    if topic is None:
        there = f"there are {', '.join(states)}" if states else "there is none"
        raise UlnaInputError(f"{path}: expected one topic of {TYPES[0]}, but {there}. Say which with ?topic=/NAME.")
    if topic not in topics:
        raise UlnaInputError(f"{path}: no topic '{topic}' in it.{nearest(topic, topics)} Correct it.")
    if topic not in states:
        raise UlnaInputError(f"{path}: topic '{topic}' is of {topics[topic]}; expected {TYPES[0]}. Name another.")
    return topic


def _by_mcap(path: Path, topic: str | None) -> Iterator[State]:
    """An MCAP file with messages as ROS 2 has them (CDR), or as JSON. Raises UlnaInputError."""
    from mcap.reader import make_reader
    from mcap_ros2.decoder import DecoderFactory

    try:
        with path.open("rb") as stream:
            reader = make_reader(stream)
            summary = reader.get_summary()
            channels = summary.channels.values() if summary else ()
            schemas = summary.schemas if summary else {}
            topics = {each.topic: schemas[each.schema_id].name for each in channels if each.schema_id in schemas}
            chosen = _chosen(path, topics, topic)
            factory = DecoderFactory()
            for schema, channel, message in reader.iter_messages(topics=[chosen]):
                if channel.message_encoding == "json":
                    yield _of_json(message.log_time, json.loads(message.data))
                    continue
                decode = factory.decoder_for(channel.message_encoding, schema)
                if decode is None:
                    raise UlnaInputError(f"{path}: messages as '{channel.message_encoding}'; expected cdr or json.")
                yield _of_message(message.log_time, decode(message.data))
    except UlnaInputError:
        raise
    except Exception as error:  # of damaged bytes its parts raise what they like
        raise UlnaInputError(f"{path}: cannot be read as MCAP ({_said(error)}). It was cut, or damaged.") from None


def _by_rosbags(path: Path, topic: str | None) -> Iterator[State]:
    """A folder of rosbag2, or a rosbag1. Raises UlnaInputError."""
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    try:
        with AnyReader([path], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
            topics = {each.topic: str(each.msgtype) for each in reader.connections}
            chosen = _chosen(path, topics, topic)
            of_it = [each for each in reader.connections if each.topic == chosen]
            for connection, log_time, data in reader.messages(of_it):
                yield _of_message(log_time, reader.deserialize(data, connection.msgtype))
    except UlnaInputError:
        raise
    except Exception as error:  # of damaged bytes its parts raise what they like
        raise UlnaInputError(
            f"{path}: cannot be read as a recording of ROS ({_said(error)}); expected rosbag2 or rosbag1. Check the "
            f"path."
        ) from None


def _of_message(log_time: int, message: Any) -> State:
    stamp = message.header.stamp
    nanoseconds = stamp.nanosec if hasattr(stamp, "nanosec") else stamp.nsec
    return _state(log_time, stamp.sec + 1e-9 * nanoseconds, message.name, message.position)


def _of_json(log_time: int, message: Any) -> State:
    stamp = message.get("header", {}).get("stamp")
    device = None if stamp is None else stamp["sec"] + 1e-9 * stamp.get("nanosec", stamp.get("nsec", 0))
    return _state(log_time, device, message["name"], message["position"])


def _state(log_time: int, device: float | None, names: Iterable[str], positions: Iterable[float]) -> State:
    return log_time * 1e-9, device, [str(name) for name in names], [float(each) for each in positions]


def _said(error: Exception) -> str:
    return str(error).splitlines()[0][:120] if str(error) else type(error).__name__


def open_source(stated: StatedSource) -> FileSource:
    """As the registry asks. Raises UlnaInputError."""
    url = stated.url
    url.check(("speed", "topic"))
    speed = None if url.options.get("speed") == "max" else url.number("speed", 1.0, 1e-3, 1e6)
    return FileSource(BagBlocks(stated.folder / url.path, url.options.get("topic")), speed)
