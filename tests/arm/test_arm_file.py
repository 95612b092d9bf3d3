"""Arm files: units, both views of a tip, round trips."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.small_study import ARM

from ulna import Arm, Joint, Probe, UlnaInputError
from ulna.arm.file import arm_toml


def _load(tmp_path: Path, text: str) -> Arm:
    path = tmp_path / "arm.toml"
    path.write_bytes(text.encode())
    return Arm.load(path)


def test_what_an_arm_file_says_arrives(tmp_path: Path) -> None:
    arm = _load(tmp_path, ARM)
    assert (arm.name, arm.n) == ("three axes", 3)
    assert arm.joints[0] == Joint(0.1, -1.5708, 40.0, 250.0, 0.0, 1, "dh", "shoulder", (-3.0, 3.0), 4096.0)
    assert arm.joints[2] == Joint(name="wrist roll", counts_per_turn=4096.0)
    assert list(arm.probes) == ["bent", "straight"]
    assert arm.probes["straight"] == Probe(0.0, 0.0, 238.0)
    assert arm.probes["bent"].ball_mm == 6.0


def test_the_cylindrical_view_is_the_same_point() -> None:
    # Cheng 2011, Table 4: theta0_7, r, h of the bent probe; x = r cos theta0, y = -r sin theta0, z = h.
    probe = Probe.from_cylindrical(0.431148, 39.4321, 223.8773)
    assert probe.x_mm == pytest.approx(35.8235, abs=1e-4)
    assert probe.y_mm == pytest.approx(-16.4793, abs=1e-4)
    assert probe.cylindrical == pytest.approx((0.431148, 39.4321, 223.8773), abs=1e-12)
    assert Probe(0.0, 0.0, 5.0).cylindrical == (0.0, 0.0, 5.0)


def test_units_are_converted_at_the_door(tmp_path: Path) -> None:
    mm = _load(tmp_path, ARM)
    text = ARM.replace('length = "mm", angle = "rad"', 'length = "in", angle = "deg"')
    inches = _load(tmp_path, text)
    assert inches.joints[0].a_mm == pytest.approx(40 * 25.4)
    assert inches.joints[0].theta0_rad == pytest.approx(0.1 * math.pi / 180)
    assert inches.joints[0].limits_rad == pytest.approx((-3 * math.pi / 180, 3 * math.pi / 180))
    assert inches.probes["straight"].z_mm == pytest.approx(238 * 25.4)
    assert inches.probes["bent"].ball_mm == pytest.approx(6 * 25.4)
    metres = _load(tmp_path, ARM.replace('"mm"', '"m"'))
    assert metres.joints[1].d_mm == pytest.approx(1000 * mm.joints[1].d_mm)


def test_a_byte_order_mark_and_windows_line_ends_are_harmless(tmp_path: Path) -> None:
    assert _load(tmp_path, "\ufeff" + ARM.replace("\n", "\r\n")) == _load(tmp_path, ARM)


numbers = st.floats(-1e4, 1e4, allow_nan=False)
names = st.text(st.characters(codec="utf-8", exclude_characters="\x00"), min_size=1, max_size=12)


@given(
    links=st.lists(st.tuples(numbers, numbers, numbers, numbers, st.booleans()), min_size=1, max_size=7),
    name=names,
    tip=st.tuples(numbers, numbers, numbers),
    limits=st.none() | st.tuples(st.floats(-7, -1), st.floats(1, 7)),
)
def test_an_arm_written_and_read_is_the_same_to_the_last_bit(
    tmp_path_factory: pytest.TempPathFactory,
    links: list[tuple[float, float, float, float, bool]],
    name: str,
    tip: tuple[float, float, float],
    limits: tuple[float, float] | None,
) -> None:
    joints = [
        Joint(
            theta0_rad=theta0,
            alpha_rad=alpha,
            a_mm=a,
            d_mm=0.0 if hayati else fourth,
            beta_rad=fourth if hayati else 0.0,
            sign=-1 if hayati else 1,
            model="hayati" if hayati else "dh",
            name=name,
            limits_rad=limits,
        )
        for theta0, alpha, a, fourth, hayati in links
    ]
    arm = Arm(name, (*joints, Joint(sign=-1)), {"p 1": Probe(*tip), "q": Probe(1.0, 2.0, 3.0, 4.0)})
    path = tmp_path_factory.mktemp("arm") / "arm.toml"
    path.write_bytes(arm_toml(arm).encode())
    assert Arm.load(path) == arm


def test_saving_does_not_overwrite_unless_told(tmp_path: Path) -> None:
    arm = _load(tmp_path, ARM)
    path = tmp_path / "arm.toml"
    with pytest.raises(UlnaInputError, match="exists already"):
        arm.save(path)
    assert path.read_text() == ARM
    arm.save(path, force=True)
    assert Arm.load(path) == arm


def test_new_numbers_keep_everything_else(tmp_path: Path) -> None:
    arm = _load(tmp_path, ARM)
    names, x = arm.parameter_names, arm.parameters
    assert len(names) == len(x) == 4 * 2 + 3 * 2
    moved = arm.with_parameters(x + np.arange(len(x)))
    assert moved.parameters == pytest.approx(x + np.arange(len(x)))
    assert moved.joints[0].limits_rad == arm.joints[0].limits_rad
    assert moved.probes["bent"].ball_mm == 6.0
    k = names.index("joint.2.a")
    assert replace(moved.joints[1], a_mm=arm.joints[1].a_mm + k).a_mm == moved.joints[1].a_mm
    with pytest.raises(ValueError, match=r"expected shape \(14,\), got \(3,\)"):
        arm.with_parameters(np.zeros(3))


def test_shapes_of_angles(tmp_path: Path) -> None:
    arm = _load(tmp_path, ARM)
    assert arm.tip(np.zeros((5, 3)), "bent").shape == (5, 3)
    assert arm.tip([0.0, 0.1, 0.2], "bent").shape == (3,)
    with pytest.raises(ValueError, match=r"expected \(N, 3\) encoder angles in rad, got \(5, 2\)"):
        arm.tip(np.zeros((5, 2)), "bent")
    with pytest.raises(UlnaInputError, match="2 probes"):
        arm.tip(np.zeros((5, 3)))


def test_a_number_that_a_joint_does_not_use_is_not_left_out_quietly(tmp_path: Path) -> None:
    """A Hayati joint has no place for a d in the file: what was read again would be another arm."""
    joints = (Joint(0.1, 0.01, 300.0, 5.0, 0.02, model="hayati"), Joint())
    with pytest.raises(UlnaInputError, match=r"joint 1 has d = 5, which its model does not use; expected 0"):
        Arm("odd", joints, {"p": Probe(1.0, 2.0, 3.0)}).save(tmp_path / "arm.toml")
    assert not (tmp_path / "arm.toml").exists()
