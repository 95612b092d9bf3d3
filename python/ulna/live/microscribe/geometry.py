"""The arm that a MicroScribe itself describes, "Format DH0.5".

Six rows, `Rx(alpha_i) · Tx(a_i) · Rz(theta_i) · Tz(d_i)`, i = 0 … 5, in the third `Ry(beta)` before Rz (Hayati 1983);
theta is 2π count / counts per turn. The sixth turns only where the device has a sixth encoder; the tip is the origin of
the last.
"""

from __future__ import annotations

import math
import struct

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.frames.links import hayati_where_parallel, moved
from ulna.arm.frames.rigid import pose, turn
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.live.microscribe.talking import MORE_PARAMETERS, PARAMETERS, Talk, Told
from ulna.proposals.arms import Drawn

FORM = "Format DH0.5"
_ROWS = 6
_BLOCK, _BETA = struct.Struct(">18h"), struct.Struct(">h")
_RAD = math.pi / 32768
_MM = 0.0254
"""A thousandth of an inch."""
_TILTED = 2
"""The row with a beta."""


def drawn(talk: Talk, told: Told, device: str) -> Drawn:
    """Asks for it. Raises UlnaInputError where it comes in a form that is not known, SourceEnded where the line is
    gone."""
    if told.form != FORM:
        raise UlnaInputError(
            f"{device}: gives its geometry as '{told.form}'; expected '{FORM}'. Give the geometry with --arm."
        )
    if len(told.counts_per_turn) not in (5, 6):
        raise UlnaInputError(
            f"{device}: has {len(told.counts_per_turn)} encoders; expected 5 or 6. Give the geometry with --arm."
        )
    block = talk.block("its parameters", PARAMETERS, _BLOCK.size)
    beta = talk.block("its parameter beta", MORE_PARAMETERS, _BETA.size) if "Beta" in told.comment else bytes(2)
    said = f"as {told.name} itself tells it ({told.form}, firmware {told.firmware})"
    first = _BLOCK.unpack(block)
    if first[0] or first[_ROWS]:
        said += (
            "; its base frame stands on axis 1, and in the device's own frame at x = "
            f"{first[_ROWS] * _MM:.6g} mm, turned about x by {first[0] * _RAD:.6g} rad"
        )
    return Drawn(arm_of(told, block, beta), said, joint_names=(None,) * len(told.counts_per_turn))


def arm_of(told: Told, block: bytes, beta: bytes) -> Arm:
    """The arm of its two blocks; its base frame is the device's, where that is on axis 1 (no alpha and a in row 0)."""
    numbers = _BLOCK.unpack(block)
    alpha = [each * _RAD for each in numbers[:_ROWS]]
    a = [each * _MM for each in numbers[_ROWS : 2 * _ROWS]]
    d = [each * _MM for each in numbers[2 * _ROWS :]]
    tilt = _BETA.unpack(beta)[0] * _RAD
    n = len(told.counts_per_turn)
    joints = [
        Joint(
            0.0, alpha[k + 1], a[k + 1], d[k],
            beta_rad=tilt if k + 1 == _TILTED else 0.0, model="hayati" if k + 1 == _TILTED else "dh",
            counts_per_turn=counts,
        )
        for k, counts in enumerate(told.counts_per_turn)
        if k + 1 < n
    ]  # fmt: skip
    end = pose(np.eye(3), np.array([0.0, 0.0, d[n - 1]]))
    for k in range(n, _ROWS):
        end = end @ _row(alpha[k], a[k], d[k])
    tips = moved({"tip": Probe(0.0, 0.0, 0.0)}, end)
    made, probes, _ = hayati_where_parallel((*joints, Joint(counts_per_turn=told.counts_per_turn[-1])), tips)
    return Arm(told.name or "MicroScribe", made, probes)


def _row(alpha_rad: float, a_mm: float, d_mm: float) -> F64:
    """A row that nothing turns."""
    return pose(turn("x", alpha_rad), np.array([a_mm, 0.0, 0.0])) @ pose(np.eye(3), np.array([0.0, 0.0, d_mm]))
