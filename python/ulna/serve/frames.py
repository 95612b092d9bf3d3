"""The newest of a stream as bytes: what a page draws sixty times a second.

Little-endian: kind u8 (1), joints u8, flags u16, number u32, time f64 s; q f64[n] rad (of joints that slide, mm);
tip f64[3] mm; covariance of the tip f32[6] mm² (xx, xy, xz, yy, yz, zz; zeros where none is known); for how much of
the time for which it must the tip has been resting f32, 0 to 1; bodies f32[12 (n + 1)], the base first, each the upper
three rows of its 4 × 4 frame, mm.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from enum import IntFlag

import numpy as np

from ulna.ground.arrays import F64

KIND = 1


class Flag(IntFlag):
    """What is so now."""

    STILL = 1
    DOUBTFUL = 2
    AT_STOP = 4
    NOT_DETERMINED = 8
    ARM = 16
    """Whether the tip and the bodies are there: of a stream without an arm they are zeros."""


@dataclass(frozen=True)
class Newest:
    """What is packed."""

    t_s: float
    q_rad: F64
    """(n,)"""
    tip_mm: F64
    """(3,)"""
    covariance_mm2: F64
    """(6,)"""
    rests: float
    bodies: F64
    """(n + 1, 3, 4)"""
    flags: Flag


def packed(number: int, newest: Newest) -> bytes:
    """As the page reads it."""
    n = len(newest.q_rad)
    head = struct.pack("<BBHId", KIND, n, int(newest.flags), number & 0xFFFFFFFF, newest.t_s)
    doubles = np.concatenate([newest.q_rad, newest.tip_mm]).astype("<f8").tobytes()
    rest = np.concatenate([newest.covariance_mm2, [newest.rests], newest.bodies.ravel()]).astype("<f4").tobytes()
    return head + doubles + rest
