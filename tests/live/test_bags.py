"""Recordings of ROS: MCAP written by mcap and read by both libraries, rosbag2 and rosbag1 written by rosbags."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.live.parts import collected

from ulna.ground.errors import UlnaInputError
from ulna.live.faults import ENDED, GARBAGE
from ulna.live.registry import opened

N = 120
Q = np.random.default_rng(2).uniform(-3, 3, (N, 4))
NAMES = ["base", "shoulder", "elbow", "wrist"]
JOINT_STATE = """\
std_msgs/Header header
string[] name
float64[] position
float64[] velocity
float64[] effort
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
"""


def state(k: int) -> dict[str, Any]:
    order = [0, 1, 2, 3] if k % 2 == 0 else [3, 1, 0, 2]
    return {
        "header": {"stamp": {"sec": 50 + k // 100, "nanosec": (k % 100) * 10_000_000}, "frame_id": ""},
        "name": [NAMES[j] for j in order],
        "position": [float(Q[k, j]) for j in order],
        "velocity": [],
        "effort": [],
    }


def by_mcap(path: Path) -> str:
    from mcap_ros2.writer import Writer

    with path.open("wb") as stream:
        writer = Writer(stream)
        schema = writer.register_msgdef("sensor_msgs/msg/JointState", JOINT_STATE)
        for k in range(N):
            writer.write_message("/joint_states", schema, state(k), log_time=10**9 + k * 10**7, publish_time=10**9)
        writer.finish()
    return str(path)


def by_mcap_as_json(path: Path) -> str:
    from mcap.writer import Writer

    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        schema = writer.register_schema("sensor_msgs/msg/JointState", "jsonschema", b"{}")
        channel = writer.register_channel("/joint_states", "json", schema)
        for k in range(N):
            log_time = 10**9 + k * 10**7
            writer.add_message(channel, log_time, json.dumps(state(k)).encode(), log_time)
        writer.finish()
    return str(path)


def by_rosbags(path: Path, version: int, storage: str | None) -> str:
    from rosbags.rosbag1 import Writer as Writer1
    from rosbags.rosbag2 import StoragePlugin
    from rosbags.rosbag2 import Writer as Writer2
    from rosbags.typesys import Stores, get_typestore

    types = get_typestore(Stores.ROS2_HUMBLE if version == 2 else Stores.ROS1_NOETIC)
    kinds: Any = types.types
    time_of, header = kinds["builtin_interfaces/msg/Time"], kinds["std_msgs/msg/Header"]
    joints = kinds["sensor_msgs/msg/JointState"]
    empty = np.empty(0)

    def message(k: int) -> Any:
        said = state(k)
        stamp = time_of(said["header"]["stamp"]["sec"], said["header"]["stamp"]["nanosec"])
        head = header(stamp, "") if version == 2 else header(k, stamp, "")
        return joints(head, said["name"], np.array(said["position"]), empty, empty)

    if version == 2:
        plugin = StoragePlugin.MCAP if storage == "mcap" else StoragePlugin.SQLITE3
        with Writer2(path, version=9, storage_plugin=plugin) as writer:
            to = writer.add_connection("/joint_states", joints.__msgtype__, typestore=types)
            for k in range(N):
                writer.write(to, 10**9 + k * 10**7, types.serialize_cdr(message(k), joints.__msgtype__))
    else:
        with Writer1(path) as old:
            channel = old.add_connection("/joint_states", joints.__msgtype__, typestore=types)
            for k in range(N):
                old.write(channel, 10**9 + k * 10**7, types.serialize_ros1(message(k), joints.__msgtype__))
    return str(path)


WRITTEN = {
    "mcap": lambda folder: by_mcap(folder / "run.mcap"),
    "mcap as JSON": lambda folder: by_mcap_as_json(folder / "run.mcap"),
    "rosbag2 of mcap": lambda folder: by_rosbags(folder / "run", 2, "mcap"),
    "rosbag2 of mcap, its file, by mcap": lambda folder: f"{by_rosbags(folder / 'run', 2, 'mcap')}/run.mcap",
    "rosbag2 of sqlite": lambda folder: by_rosbags(folder / "run", 2, None),
    "rosbag2 of sqlite, its file": lambda folder: f"{by_rosbags(folder / 'run', 2, None)}/run.db3",
    "rosbag1": lambda folder: by_rosbags(folder / "run.bag", 1, None),
}


@pytest.mark.parametrize("way", WRITTEN)
def test_what_one_library_writes_comes_back(way: str, tmp_path: Path) -> None:
    path = WRITTEN[way](tmp_path)
    with opened(f"bag:{path}?speed=max") as source:
        samples, faults, _ = collected(source, N + 1)
    assert source.hello.channels == tuple(NAMES)
    assert source.hello.unit == "rad"
    np.testing.assert_array_equal(samples.raw, Q)
    np.testing.assert_allclose(samples.t_host_s, 1 + np.arange(N) / 100, rtol=1e-12)
    assert samples.t_device_s is not None
    np.testing.assert_allclose(samples.t_device_s, 50 + np.arange(N) / 100, rtol=1e-12)
    assert [fault.kind for fault in faults] == [ENDED]


def test_mcap_of_ours_is_read_by_rosbags_too(tmp_path: Path) -> None:
    """What the tests write is what others read: rosbags reads the file of mcap's own writer."""
    from rosbags.highlevel import AnyReader
    from rosbags.typesys import Stores, get_typestore

    folder = tmp_path / "run"
    by_rosbags(folder, 2, "mcap")
    (folder / "run.mcap").unlink()
    by_mcap(folder / "run.mcap")
    with AnyReader([folder], default_typestore=get_typestore(Stores.ROS2_HUMBLE)) as reader:
        assert sum(1 for _ in reader.messages()) == N
    with opened(f"bag:{folder}?speed=max") as source:
        samples, _, _ = collected(source, N + 1)
    np.testing.assert_array_equal(samples.raw, Q)


def test_messages_in_which_joints_lack_are_skipped_and_counted(tmp_path: Path) -> None:
    from mcap.writer import Writer

    path = tmp_path / "run.mcap"
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        schema = writer.register_schema("sensor_msgs/msg/JointState", "jsonschema", b"{}")
        channel = writer.register_channel("/joint_states", "json", schema)
        for k in range(10):
            said = state(0) if k % 3 == 0 else {"name": ["gripper"], "position": [0.1]}
            writer.add_message(channel, k, json.dumps(said).encode(), k)
        writer.finish()
    with opened(f"bag:{path}?speed=max") as source:
        samples, faults, _ = collected(source, 11)
    assert len(samples) == 4
    assert [fault.kind for fault in faults] == [GARBAGE, ENDED]
    assert "6 messages skipped" in faults[0].text


@pytest.mark.parametrize("way", ["mcap", "rosbag2 of sqlite, its file", "rosbag1"])
def test_damaged_recordings_are_refused_or_read_and_never_a_fault(way: str, tmp_path: Path) -> None:
    path = Path(WRITTEN[way](tmp_path))
    content = path.read_bytes()
    rng = np.random.default_rng(6)
    for k in range(20):
        spoilt = bytearray(content[: int(rng.integers(0, len(content)))] if k % 2 else content)
        for at in rng.integers(0, max(len(spoilt), 1), 20):
            if len(spoilt):
                spoilt[at] ^= 0x5A
        path.write_bytes(spoilt)
        with suppress(UlnaInputError), opened(f"bag:{path}?speed=max") as source:
            collected(source, N + 1)


def test_topics_are_asked_for(tmp_path: Path) -> None:
    path = by_mcap(tmp_path / "run.mcap")
    with pytest.raises(UlnaInputError, match="Did you mean '/joint_states'"), opened(f"bag:{path}?topic=/joint_state"):
        pass
    with pytest.raises(UlnaInputError, match="no such file"), opened(f"bag:{tmp_path}/none.mcap"):
        pass
