"""A home-built arm at the end of a serial line, simulated: six magnetic encoders of 14 bits, an Arduino that prints
them two hundred times a second, and a hand that moves it. What the arm truly is only this file knows.

The line is a pseudo-terminal, as real as one can be without a cable. Needs Linux or macOS.
"""

from __future__ import annotations

import os
import threading
import time
import tty
from collections import deque
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import ulna
from ulna.arm.arm import Arm
from ulna.ground.arrays import F64
from ulna.simulation.mover import Mover

COUNTS = 16384
RATE_HZ = 200.0
NOISE_COUNTS = 0.6
ORDER = (2, 0, 5, 1, 3, 4)
"""The joint of each channel: cables were plugged in as they came."""
SIGNS = (1, -1, -1, 1, 1, -1)
TURNS_DEG = ((-160, 160), (-75, 100), (-150, 140), (-125, 130), (-165, 150), (-120, 115))
"""How far the joints turn about where the drawing has them, from stop to stop."""
SPEED_RAD_S = 1.6
SEAT_MM = 0.01


@dataclass(frozen=True)
class Built:
    """An arm as it was built, in angles of its own encoders."""

    arm: Arm
    zeros_rad: F64
    """(n,) `turn = sign * encoder - zero`, turns from where the drawing has the joints."""

    @classmethod
    def of(cls, drawing: Arm, seed: int = 7) -> Built:
        """With what no ruler shows: links some tenths of a millimetre off, twists some tenths of a degree, encoders
        wherever their magnets were glued."""
        rng, n = np.random.default_rng(seed), drawing.n
        zeros = rng.uniform(-np.pi, np.pi, n)
        off_mm, off_rad = rng.normal(0.0, 0.7, (2, n)), rng.normal(0.0, 0.004, n)
        off_mm[:, -1] = off_rad[-1] = 0.0  # the last joint carries the probe
        (name, probe), (x, y, z) = next(iter(drawing.probes.items())), rng.normal(0.0, 0.5, 3)
        # where the last magnet was glued is in the probe: a turn about the last axis
        tip = complex(probe.x_mm + x, probe.y_mm + y) * np.exp(-1j * zeros[-1])
        joints = [
            replace(
                joint,
                sign=sign,
                theta0_rad=float(zeros[k]) if k < n - 1 else 0.0,
                alpha_rad=joint.alpha_rad + float(off_rad[k]),
                a_mm=float(off_mm[0, k]),
                d_mm=joint.d_mm + float(off_mm[1, k]),
                counts_per_turn=COUNTS,
                limits_rad=_stops(sign, float(zeros[k]), *TURNS_DEG[k]),
            )
            for k, (joint, sign) in enumerate(zip(drawing.joints, SIGNS, strict=True))
        ]
        probes = {name: replace(probe, x_mm=tip.real, y_mm=tip.imag, z_mm=probe.z_mm + z)}
        return cls(replace(drawing, joints=tuple(joints), probes=probes), zeros)

    @property
    def travel_rad(self) -> F64:
        """(n, 2) from stop to stop."""
        return np.array([joint.limits_rad for joint in self.arm.joints])

    def encoders(self, turned_rad: F64) -> F64:
        """(n,) turns → encoder angles, between the stops."""
        angles = np.array(SIGNS) * (turned_rad + self.zeros_rad)
        whole = np.round((self.travel_rad.mean(axis=1) - angles) / (2.0 * np.pi))
        found: F64 = angles + 2.0 * np.pi * whole
        return found


def _stops(sign: int, zero_rad: float, low_deg: float, high_deg: float) -> tuple[float, float]:
    """Encoder angles; an encoder counts from nought."""
    one, other = (sign * (np.radians(each) + zero_rad) for each in (low_deg, high_deg))
    away = 2.0 * np.pi * np.floor((one + other) / (4.0 * np.pi))
    return float(min(one, other) - away), float(max(one, other) - away)


class HomeBuilt:
    """The arm and the hand that holds it. Movements are queued; after them it rests."""

    def __init__(self, drawing: Path, seed: int = 1) -> None:
        self.drawing = ulna.Arm.load(drawing)
        self.built = Built.of(self.drawing)
        self.rng = np.random.default_rng(seed)
        self.travel_rad = self.built.travel_rad
        self.mover = Mover(self.built.arm, self.travel_rad + np.array([0.15, -0.15]))
        self.middle_rad = self.travel_rad.mean(axis=1)
        self.end_rad = self._here_rad = self.middle_rad
        self._path: deque[F64] = deque()
        self._sent = 0

    def go(self, q_rad: F64, rest_s: float = 0.0) -> None:
        """Moves there as people do, with the least jerk, and rests."""
        seconds = max(15.0 / 8.0 * float(np.abs(q_rad - self.end_rad).max()) / SPEED_RAD_S, 0.05)
        part = np.linspace(0.0, 1.0, max(int(seconds * RATE_HZ), 2))[:, None]
        way = self.end_rad + (10 * part**3 - 15 * part**4 + 6 * part**5) * (q_rad - self.end_rad)
        self._path.extend([*way, *np.repeat(q_rad[None], int(rest_s * RATE_HZ), axis=0)])
        self.end_rad = q_rad

    def turn(self, joint: int, *angles_rad: float) -> None:
        """Turns one joint alone, from angle to angle."""
        for angle in angles_rad:
            there = self.end_rad.copy()
            there[joint] = angle
            self.go(there)

    def postures(self, point_mm: F64, count: int) -> F64:
        """(N, n) postures with the ball in a seat, elbow and wrist at random; none where the arm cannot reach it."""
        at = np.repeat((point_mm + self.rng.normal(0.0, SEAT_MM, 3))[None], count, axis=0)
        seed = int(self.rng.integers(2**60))
        q_rad, reached = self.mover.on_points(at, np.zeros(count, dtype=np.int64), {}, seed)
        found: F64 = q_rad[reached]
        return found

    @property
    def moves(self) -> bool:
        """Whether it has not yet done all that it was told."""
        return bool(self._path)

    def line(self) -> str:
        """The next that its Arduino prints: milliseconds, then counts, as the cables were plugged in."""
        if self._path:
            self._here_rad = self._path.popleft()
        read = self._here_rad / (2.0 * np.pi) * COUNTS + NOISE_COUNTS * self.rng.standard_normal(len(SIGNS))
        counts = np.floor(read).astype(int) % COUNTS
        self._sent += 1
        return f"{self._sent * 1000 / RATE_HZ:.0f}," + ",".join(str(counts[joint]) for joint in ORDER) + "\r\n"


class Line:
    """The serial line: a pseudo-terminal, and the Arduino that prints on it in real time."""

    def __init__(self, arm: HomeBuilt, link: Path) -> None:
        """link: a name that the line is given, as a system gives /dev/ttyACM0."""
        self.arm = arm
        self._ours, self._theirs = os.openpty()
        tty.setraw(self._theirs)
        os.set_blocking(self._ours, False)
        link.unlink(missing_ok=True)
        link.symlink_to(os.ttyname(self._theirs))
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._send, daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Pulls the cable."""
        self._over.set()
        self._thread.join()
        os.close(self._ours)
        os.close(self._theirs)

    def wait(self) -> None:
        """Until the hand has done what it was told."""
        while self.arm.moves:
            time.sleep(0.05)

    def _send(self) -> None:
        began, sent = time.monotonic(), 0
        while not self._over.wait(0.004):
            due = int((time.monotonic() - began) * RATE_HZ)
            lines = "".join(self.arm.line() for _ in range(sent, due))
            sent = due
            try:
                os.write(self._ours, lines.encode())
            except BlockingIOError:
                continue  # nobody reads: a real line loses it too
