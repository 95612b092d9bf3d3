"""`virtual:arm.toml?rate=1000&noise=5e-6&seed=0`: a virtual arm that a hand moves, in real time or faster."""

from __future__ import annotations

import math
import time
from collections import deque
from contextlib import suppress
from pathlib import Path
from queue import Empty, SimpleQueue

import numpy as np
from numpy.typing import ArrayLike

from ulna.arm.arm import Arm
from ulna.arm.given import as_arm
from ulna.formats.table import read_header, read_table
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.faults import ENDED, Fault
from ulna.live.hand import ALL_WELL, Chances, Hand
from ulna.live.mapping import TURN
from ulna.live.samples import Hello, Samples
from ulna.live.source import SourceEnded
from ulna.live.source_file import StatedSource
from ulna.live.url import Url

KNOWN = (
    *("rate", "noise", "seed", "speed", "unit", "moves", "poses"),
    *("hand", "rest", "seconds", "knocks", "gaps", "resets"),
)
AT_ONCE = 4096
"""Samples that a read gives at most."""
UNSAID_RAD = (-math.pi / 2, math.pi / 2)
"""How far a joint turns of which nobody has said it."""
WHAT = "a table of postures: columns q1, q2, … in rad, as ulna plan writes plan.csv"


class VirtualSource:
    """A virtual arm. A program steers it by `go_to`, from any thread; the first such call ends its own wandering."""

    def __init__(
        self,
        arm: Arm,
        *,
        rate_hz: float = 1000.0,
        noise_rad: float = 5e-6,
        seed: int = 0,
        speed: float | None = 1.0,
        unit: str = "rad",
        poses_rad: F64 | None = None,
        wanders: bool = True,
        hand_rad_s: float = 1.0,
        rest_s: float = 1.0,
        chances: Chances = ALL_WELL,
        seconds: float = math.inf,
    ) -> None:
        """speed: 1 in real time, None as fast as can be; unit: rad, deg or counts; poses_rad: (N, n) to be gone through
        once; wanders: whether it moves before it is told to; seconds: after which it ends. Raises UlnaInputError for an
        arm with joints that slide, or for counts where the arm does not say them."""
        arm.check_turns("virtual:", "virtual sources")
        turns = [joint.counts_per_turn for joint in arm.joints]
        if unit == "counts" and None in turns:
            raise UlnaInputError(
                f"virtual: joint {turns.index(None) + 1} of arm '{arm.name}' has no counts_per_turn; expected it for "
                "unit=counts. Add it to the arm file."
            )
        told = unit if unit != "counts" else None  # a device that sends counts does not say so
        self.arm = arm
        self.hello = Hello(
            tuple(f"q{k + 1}" for k in range(arm.n)), told, worded("virtual arm '{arm}'", arm=arm.name), rate_hz
        )
        self._turn: F64 = np.array([float(n or 0) if unit == "counts" else TURN[unit] for n in turns])
        self._counts = unit == "counts"
        self._rate_hz, self._speed, self._seconds = rate_hz, speed, seconds
        self.noise_rad = noise_rad
        """Standard deviation of each encoder in one sample."""
        self._noise, self._rng = np.random.default_rng([seed, 0]), np.random.default_rng([seed, 2])
        self._wanders, self._told = wanders, SimpleQueue[F64]()
        self._poses: deque[F64] | None = None if poses_rad is None else deque(poses_rad)
        travel = np.array([joint.travel_rad or UNSAID_RAD for joint in arm.joints])
        self.travel_rad: F64 = travel
        """(n, 2) how far its joints turn."""
        first = travel.mean(axis=1) if self._poses is None else self._poses.popleft()
        self._hand = Hand(first, self._next, hand_rad_s, rest_s, chances, seed)
        self._began_s: float | None = None
        self._given = 0
        self._here_rad = first
        self._faults: list[Fault] = []
        self._closed = False

    def go_to(self, q_rad: ArrayLike) -> None:
        """Move there, (n,) rad, and rest; several are gone to one after another, with a rest at each.

        Raises ValueError for anything else.
        """
        there = np.array(q_rad, dtype=np.float64)
        if there.shape != (self.arm.n,) or not np.isfinite(there).all():
            raise ValueError(f"q_rad: expected ({self.arm.n},) encoder angles in rad, got {there.tolist()}")
        self._told.put(there)

    def steer(self, q_rad: ArrayLike) -> None:
        """The same, in place of all that was asked for and not begun: a slider that is being moved. Raises
        ValueError."""
        with suppress(Empty):
            while True:
                self._told.get_nowait()
        self.go_to(q_rad)

    @property
    def here_rad(self) -> F64:
        """(n,) where the joints truly were at the last sample that was read."""
        return self._here_rad

    def _next(self) -> F64 | None:
        try:
            there = self._told.get_nowait()
        except Empty:
            pass
        else:
            self._wanders = False
            return there
        if self._poses:
            return self._poses.popleft()
        if self._poses is not None and self._wanders:
            raise StopIteration
        if not self._wanders:
            return None
        low, high = self.travel_rad.T
        anywhere: F64 = self._rng.uniform(low, high)
        return anywhere

    def read(self, timeout_s: float) -> Samples:
        """As `Source`."""
        n = self._due(timeout_s)
        if self._given >= self._seconds * self._rate_hz or self._closed:
            raise self._ended(worded("it was closed.") if self._closed else worded("its time is over."))
        n = int(min(n, self._seconds * self._rate_hz - self._given))
        t_s = (self._given + np.arange(n)) / self._rate_hz
        if not n:
            return Samples.none(self.arm.n)
        if self._wanders and not self._told.empty():
            self._hand.hurry(float(t_s[0]))
        try:
            q_rad, zero_rad, comes = self._hand.at(t_s)
        except StopIteration:
            raise self._ended(worded("the last posture was read.")) from None
        self._given += n
        read = q_rad - zero_rad + self.noise_rad * self._noise.standard_normal(q_rad.shape)
        if comes.any():
            self._here_rad = q_rad[comes][-1]
        raw = (read * (self._turn / (2 * math.pi)))[comes]
        if self._counts:
            raw = np.floor(raw) % self._turn
        return Samples((self._began_s or 0.0) + t_s[comes], t_s[comes], raw)

    def _due(self, timeout_s: float) -> int:
        """How many samples are to be given now; waits for the first."""
        if self._began_s is None:
            self._began_s = time.monotonic()
        if self._speed is None:
            return AT_ONCE
        each_s = 1.0 / (self._rate_hz * self._speed)
        first_s = self._began_s + self._given * each_s
        time.sleep(max(0.0, min(first_s - time.monotonic(), timeout_s)))
        return min(max(int((time.monotonic() - first_s) / each_s) + 1, 0), AT_ONCE)

    def _ended(self, why: str) -> SourceEnded:
        said = worded("{device}: {why}", device=self.hello.device, why=why)
        self._faults.append(Fault(ENDED, time.monotonic(), said))
        return SourceEnded(said)

    def faults(self) -> list[Fault]:
        """As `Source`."""
        found, self._faults = self._faults, []
        return found

    def close(self) -> None:
        """As `Source`."""
        self._closed = True


def read_poses(path: Path, joints: int) -> F64:
    """(N, n) rad: the columns q1 to qn of a table. Raises UlnaInputError."""
    names = [f"q{k + 1}" for k in range(joints)]
    header = read_header(path, WHAT)
    lacking = [name for name in names if name not in header.columns]
    if lacking:
        raise UlnaInputError(f"{path}: there is no column '{lacking[0]}'; expected {WHAT}. Add it.")
    poses: F64 = read_table(header, lambda _: True, names).to_numpy()
    if not len(poses):
        raise UlnaInputError(f"{path}: no row in it; expected {WHAT}. Add some.")
    return poses


def _arm(url: Url, folder: Path) -> Arm:
    if url.path:
        return as_arm(folder / url.path)
    from ulna.reproduce.cheng2011.arms import BENT_PROBE, platinum

    return platinum(BENT_PROBE)


def open_source(stated: StatedSource) -> VirtualSource:
    """As the registry asks. Raises UlnaInputError."""
    url = stated.url
    url.check(KNOWN)
    arm = _arm(url, stated.folder)
    poses = url.options.get("poses")
    return VirtualSource(
        arm,
        rate_hz=url.number("rate", 1000.0, 1.0, 1e5),
        noise_rad=url.number("noise", 5e-6, 0.0, 1.0),
        seed=int(url.number("seed", 0, 0, 2**32)),
        speed=None if url.options.get("speed") == "max" else url.number("speed", 1.0, 1e-3, 1e6),
        unit=url.word("unit", "rad", ("rad", "deg", "counts")),
        poses_rad=None if poses is None else read_poses(stated.folder / poses, arm.n),
        wanders=url.word("moves", "alone", ("alone", "told")) == "alone",
        hand_rad_s=url.number("hand", 1.0, 1e-2, 10.0),
        rest_s=url.number("rest", 1.0, 0.0, 60.0),
        chances=Chances(*(url.number(name, 0.0, 0.0, 1.0) for name in ("knocks", "gaps", "resets"))),
        seconds=url.number("seconds", math.inf, 1e-3, 1e9),
    )
