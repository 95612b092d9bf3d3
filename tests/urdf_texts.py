"""URDF descriptions of serial chains, made up for tests: axes at random, parallel, antiparallel, crossing, one line."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from hypothesis import strategies as st
from numpy.typing import NDArray

from ulna.arm.arm import Arm


@dataclass(frozen=True)
class Made:
    """One joint: fixed, or turning about an axis, or sliding along it."""

    xyz_m: tuple[float, float, float]
    rpy: tuple[float, float, float]
    axis: tuple[float, float, float] | None
    slides: bool = False


def urdf(joints: list[Made], base: str = "root") -> str:
    """The text of a chain; its tip is the link `tip`, behind a fixed joint."""
    lines = [
        '<?xml version="1.0"?>',
        '<robot name="made">',
        "  <!-- made up for a test -->",
        f'  <link name="{base}"/>',
    ]
    parent = base
    for k, joint in enumerate([*joints, Made((0.03, -0.02, 0.1), (0.0, 0.3, 0.0), None)]):
        child = f"l{k}" if k < len(joints) else "tip"
        kind = "fixed" if joint.axis is None else "prismatic" if joint.slides else "continuous"
        lines += [
            f'  <link name="{child}"><visual><origin xyz="1 2 3"/></visual></link>',
            f'  <joint name="j{k}" type="{kind}">',
            f'    <parent link="{parent}"/><child link="{child}"/>',
            f"    <origin xyz='{_text(joint.xyz_m)}'   rpy=\"{_text(joint.rpy)}\" />",
        ]
        lines += [] if joint.axis is None else [f'    <axis xyz="{_text(joint.axis)}"/>']
        lines += ['    <limit lower="-0.1" upper="0.4"/>'] if joint.slides else []
        lines += ["  </joint>"]
        parent = child
    return "\n".join([*lines, "</robot>"]) + "\n"


def _text(values: tuple[float, ...]) -> str:
    return " ".join(repr(float(value)) for value in values)


quarter = st.sampled_from([k * math.pi / 2 for k in range(-2, 3)])
nearly = st.builds(lambda a, b: a + b, quarter, st.sampled_from([1e-12, -1e-9, 1e-6, -1e-4, 0.01, 0.049, 0.051]))
angle = quarter | nearly | st.floats(-math.pi, math.pi)
length = st.just(0.0) | st.sampled_from([0.1, -0.4]) | st.floats(-0.5, 0.5)
along = st.sampled_from([(0.0, 0.0, 1.0), (0.0, 0.0, -1.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0)])
somewhere = st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: np.linalg.norm(v) > 0.1)
xyz, rpy = st.tuples(length, length, length), st.tuples(angle, angle, angle)
turning = st.builds(Made, xyz, rpy, along | somewhere)
sliding = st.builds(Made, xyz, rpy, along | somewhere, st.just(True))
fixed = st.builds(Made, xyz, rpy, st.none())


def _interleaved(turns: list[Made], stills: list[Made], where: list[int]) -> list[Made]:
    out = list(turns)
    for still, at in zip(stills, where, strict=False):
        out.insert(at % (len(out) + 1), still)
    return out


#: chains of 2 to 7 rotary joints with up to 3 fixed ones anywhere between
chains = st.builds(
    _interleaved,
    st.lists(turning, min_size=2, max_size=7),
    st.lists(fixed, max_size=3),
    st.lists(st.integers(0, 9), min_size=3, max_size=3),
)


#: the same with prismatic joints, at least one; at the end as well
chains_that_slide = st.builds(
    lambda made, slides, where: _interleaved(made, slides, where),
    chains,
    st.lists(sliding, min_size=1, max_size=3),
    st.lists(st.integers(0, 12), min_size=3, max_size=3),
)


def tips_in_root(arm: Arm, t_root_base: NDArray[np.float64], q_rad: NDArray[np.float64], probe: str | None = None):
    """(N, 3) mm: where an arm has its tip, in the frame of the description."""
    return arm.tip(q_rad, probe) @ t_root_base[:3, :3].T + t_root_base[:3, 3]


def poses(n: int, count: int = 200) -> NDArray[np.float64]:
    """(count, n) rad."""
    return np.random.default_rng(n).uniform(-3, 3, (count, n))


def write(folder: Path, text: str, name: str = "made.urdf") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path
