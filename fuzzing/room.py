"""The folder that every input lies over: valid documents of every format, old and new, of a small arm."""

from __future__ import annotations

import contextlib
import io
import json
import os
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

FOSSILS = Path(__file__).resolve().parents[1] / "tests" / "data" / "fossils"

ARM = """\
format = "ulna-arm/1"
name = "small"
units = { length = "mm", angle = "rad" }
joint = [
    { name = "shoulder", theta0 = 0.1, alpha = -1.5708, a = 40.0, d = 250.0, counts_per_turn = 4096, limits = [-3, 3] },
    { theta0 = 0.2, alpha = 1.57, a = 260.0, d = 1.5, limits = [-1.5, 1.5], counts_per_turn = 4096 },
    { theta0 = 0.3, alpha = 1.5, a = 220.0, d = -3.5, limits = [-2.0, 2.0], counts_per_turn = 4096 },
    { name = "wrist", limits = [-3.0, 3.0], counts_per_turn = 4096 },
]

[probe.bent]
tip = { theta0 = 0.4, r = 39.0, h = 123.0 }
ball = 6.0
"""
SIMULATION = """\
format = "ulna-simulation/1"
arm = "arm.toml"
units = { length = "mm", angle = "rad" }
seed = 3
missed = { share = 0.05, size = 0.1 }
volume = { low = [-900.0, -900.0, -300.0], high = [900.0, 900.0, 900.0] }
drawing = { offset = 0.02, length = 1.0, twist = 0.01 }
travel = { limits = [[-2.9, 2.9], [-1.4, 1.4], [-1.9, 1.9], [-2.9, 2.9]] }
noise = { encoder = 1e-5, seat = 0.01 }

[artefact.bar]
kind = "bar"
length = 200.0
u = 0.001
placements = 6
touches = 2

[artefact.cone]
kind = "seat"
placements = 1
touches = 12

[artefact.ball]
kind = "sphere"
diameter = 25.0
placements = 1
touches = 12
"""
PLAN = """\
format = "ulna-plan/1"
units = { length = "mm", angle = "rad" }
artefact = { bar = { kind = "bar", length = 200.0 } }
noise = { encoder = 1e-5, seat = 0.01 }
plan = { choose = 24, placements = 3, candidates = 1000, trials = 2 }
"""
TASK = """\
format = "ulna-task/1"
kind = "length"
units = { length = "mm", angle = "rad" }
readings = { file = "task.csv", angle = "counts" }
noise = { encoder = 1e-5, seat = 0.01 }
temperature = { value = 20.5, u = 0.5 }
p = 0.95
"""
READINGS = """\
placement,feature,q1,q2,q3,q4,temperature,id
1,A,-1503,-173,-230,-657,20.1,r1
1,A,-1447,-158,-332,-104,20.1,r2
1,B,-1411,-133,-131,-912,20.2,r3
2,A,903,-73,210,127,20.2,r4
2,B,847,58,-302,804,20.3,r5
2,B,811,-233,431,-12,20.4,r6
"""
"""All tables are spoilt from this one."""
VOLUME = """\
format = "ulna-volume/1"
units = { length = "mm", angle = "rad" }
points = 100
bars = 100
lengths = [300]
"""
PERFORMANCE = """\
format = "ulna-performance/1"
units = { length = "mm", angle = "rad" }
spread = { angle = 1e-5, length = 0.01 }
noise = { encoder = 5e-6, seat = 0.008 }
test = [{ kind = "length", lengths = [300], places = 4, two_sigma = 0.055 }]
"""
VERIFY = FOSSILS.joinpath("verify-1.toml").read_text(encoding="utf-8").replace("a fossil of every key", "arm S-1")
DH = """\
joint,theta0 (rad),alpha (rad),a (mm),d (mm)
shoulder,0.1,-1.5708,40,250
elbow,0.2,1.57,260,1.5
roll,0.3,1.5,220,-3.5
wrist,0,0,0,100
"""
URDF = """\
<?xml version="1.0"?>
<robot name="made">
  <link name="root"/>
  <link name="l0"><visual><origin xyz="1 2 3"/></visual></link>
  <joint name="j0" type="continuous">
    <parent link="root"/><child link="l0"/>
    <origin xyz="0 0 0.25" rpy="0 0.1 0"/><axis xyz="0 0 1"/>
  </joint>
  <link name="l1"/>
  <joint name="j1" type="revolute">
    <parent link="l0"/><child link="l1"/>
    <origin xyz="0.26 0.01 0" rpy="1.57 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-1.5" upper="1.5"/>
  </joint>
  <link name="l2"/>
  <joint name="j2" type="continuous">
    <parent link="l1"/><child link="l2"/>
    <origin xyz="0.22 0 0.01" rpy="1.5 0 0.2"/><axis xyz="0 1 0"/>
  </joint>
  <link name="l3"/>
  <joint name="j3" type="continuous">
    <parent link="l2"/><child link="l3"/>
    <origin xyz="0.05 0 0.1" rpy="0 1.5 0"/><axis xyz="0 0 -1"/>
  </joint>
  <link name="tip"/>
  <joint name="hand" type="fixed">
    <parent link="l3"/><child link="tip"/>
    <origin xyz="0.03 -0.02 0.1" rpy="0 0.3 0"/>
  </joint>
</robot>
"""
_UR10 = "shoulder_pan_joint;shoulder_lift_joint;elbow_joint;wrist_1_joint;wrist_2_joint;wrist_3_joint"
_HEAD = ";".join(f"measurement_{name}" for name in ("temperature", "x", "y", "z", "rx", "ry", "rz"))
IPA = f"{_UR10};{_HEAD}\n" + "".join(
    f"0,{k};-1,1;1,{k};-0,5;0,2;0,{k};21,5;10{k},5;200;300,25;1;2;{k}\n" for k in range(6)
)
SERIAL = "step_order,x_t,y_t,z_t,x_dif,y_dif,z_dif,joint_1,joint_2,joint_3,joint_4,joint_5,joint_6\n" + "".join(
    f"{k},10{k},200,300,0.1,-0.{k},0.2,1{k},-20,30,{k},5,6\n" for k in range(1, 6)
)
MUKCA = "".join(f"{k / 9},0.1,-0.2,-1.{k},0.0,1.{k},0.{k}\n" for k in range(1, 5))
TEXTS = {
    "arm.toml": ARM,
    "simulation.toml": SIMULATION,
    "plan.toml": PLAN,
    "task.toml": TASK,
    "volume.toml": VOLUME,
    "performance.toml": PERFORMANCE,
    "task.csv": READINGS,
    "fossils/verify-own.toml": VERIFY,
    "dh.csv": DH,
    "robot.urdf": URDF,
    "ipa.csv": IPA,
    "serial.csv": SERIAL,
    **{f"panda_9/{place}/hole_{hole}.csv": MUKCA for place in ("front", "back") for hole in (0, 1)},
}
COMMANDS = [
    "simulate simulation.toml -o made",
    "calibrate made/study.toml -o out",
    "evaluate out/result.json made/study.toml -o judged",
    "cross-validate made/study.toml --by artefact -o crossed",
    "batch made -o batched",
    "plan arm.toml plan.toml -o planned",
    "verify fossils/verify-own.toml -o tested",
    "record init bench",
    "record arm small --records bench",
    "record person Ann --role admin --records bench",
    "record account Ann --sign-in ann --records bench",
]
"""What makes the other documents."""
WHEN = "2026-01-01T00:00:00+00:00"


def make_room(folder: Path) -> Path:
    """All documents, in a folder that is not there yet. The same for the same Ulna."""
    folder.mkdir(parents=True)
    for path in FOSSILS.rglob("*"):
        if path.is_file():
            (folder / "fossils" / path.relative_to(FOSSILS)).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(path, folder / "fossils" / path.relative_to(FOSSILS))
    for name, text in TEXTS.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    from ulna.cli import app

    with inside(folder):
        for command in COMMANDS:
            said = io.StringIO()
            with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
                try:
                    app(command.split(), prog_name="ulna")
                except SystemExit as end:
                    if end.code:
                        raise RuntimeError(f"ulna {command}: {said.getvalue()}") from None
    for path in folder.rglob("*.json"):
        text = path.read_text(encoding="utf-8")
        if "fossils" not in path.parts:
            path.write_text(json.dumps(_timeless(json.loads(text)), ensure_ascii=False), encoding="utf-8")
    return folder


def _timeless(value: Any) -> Any:
    """Without the time of the day, so that inputs are the same tomorrow."""
    if isinstance(value, dict):
        return {name: WHEN if name in ("created", "time", "when") else _timeless(each) for name, each in value.items()}
    return [_timeless(each) for each in value] if isinstance(value, list) else value


@contextlib.contextmanager
def inside(folder: Path) -> Iterator[None]:
    """In this folder."""
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


class Room:
    """The room, to read from by doors and to put trials into."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._content = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
        self._folders = {path for path in folder.rglob("*") if path.is_dir()}
        self._marks = {path: _mark(path) for path in self._content}

    def read(self, name: str) -> bytes:
        """A document as it was made, whatever lies over it now."""
        return self._content[self.folder / name]

    def lay(self, files: dict[str, bytes]) -> None:
        for name, content in files.items():
            path = self.folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)

    def clear(self) -> None:
        """As it was, whatever was laid, written over or taken away."""
        for path in sorted(set(self.folder.rglob("*")) - self._content.keys() - self._folders, reverse=True):
            path.rmdir() if path.is_dir() and not path.is_symlink() else path.unlink()
        for path, mark in self._marks.items():
            if _mark(path) != mark:
                path.parent.mkdir(parents=True, exist_ok=True)
                path.unlink(missing_ok=True)
                path.write_bytes(self._content[path])
                self._marks[path] = _mark(path)


def _mark(path: Path) -> tuple[int, ...]:
    """What changes when a file does; () where there is none."""
    if path.is_symlink() or not path.is_file():
        return ()
    state = path.stat()
    return state.st_ino, state.st_size, state.st_mtime_ns
