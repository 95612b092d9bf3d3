"""A home-built arm, simulated: channels in any order, encoders of 12 bits that count either way and begin again, one
channel dead, one joint that takes another along. The truth is known."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ulna.ground.arrays import F64
from ulna.live.hand import FASTEST
from ulna.live.samples import Hello, Samples

COUNTS = 4096
RATE_HZ = 200.0


class HomeBuilt:
    """order[k]: the channel of joint k; signs; offset and noise in counts; coupled: (joint, its follower, ratio)."""

    def __init__(
        self,
        order: Sequence[int],
        signs: Sequence[int],
        channels: int,
        seed: int = 0,
        noise: float = 1.5,
        coupled: tuple[int, int, float] | None = None,
        speed_rad_s: float = 2.0,
    ) -> None:
        self.order, self.signs, self.noise, self.coupled = list(order), np.array(signs), noise, coupled
        self.rng = np.random.default_rng(seed)
        self.n, self.channels, self.speed_rad_s = len(order), channels, speed_rad_s
        self.offset = self.rng.uniform(0.0, COUNTS, self.n)
        middle = self.rng.uniform(-0.3, 0.3, self.n)
        half = self.rng.uniform(0.7, 1.6, self.n)
        self.limits_rad = np.stack([middle - half, middle + half], axis=1)
        self.hello = Hello(tuple(f"c{k + 1}" for k in range(channels)), None, "a home-built arm")

    def counts(self, q_rad: F64) -> F64:
        """(N, n) joint turns → (N, channels) what it sends."""
        read = self.signs * q_rad
        if self.coupled is not None:
            joint, other, ratio = self.coupled
            read[:, other] += ratio * read[:, joint]
        own = read / (2 * np.pi) * COUNTS + self.offset + self.noise * self.rng.standard_normal(read.shape)
        sent = np.full((len(q_rad), self.channels), 2047.0)  # a dead channel
        sent[:, self.order] = np.floor(own) % COUNTS
        return sent

    def move(self, a_rad: F64, b_rad: F64, rest_s: float) -> F64:
        """(N, n) from one posture to another, and a rest."""
        seconds = FASTEST * float(np.abs(b_rad - a_rad).max()) / self.speed_rad_s
        part = np.linspace(0.0, 1.0, max(int(seconds * RATE_HZ), 1))[:, None]
        way = a_rad + (10 * part**3 - 15 * part**4 + 6 * part**5) * (b_rad - a_rad)
        return np.vstack([way, np.repeat(b_rad[None], int(rest_s * RATE_HZ), axis=0)])

    def turn(self, q_rad: F64, joints: Sequence[int], rest_s: float = 2.3) -> F64:
        """Joints to their stops and back; several at times of their own."""
        out = [q_rad]
        low, high = q_rad.copy(), q_rad.copy()
        for k in joints:
            low[k], high[k] = self.limits_rad[k]
        pieces, here = [], q_rad
        if len(joints) == 1:
            steps = [low, high, q_rad]
        else:
            mixed = low.copy()
            mixed[joints[1]] = high[joints[1]]
            steps = [low, mixed, high, q_rad]
        for k, there in enumerate(steps):
            pieces.append(self.move(here, there, rest_s if k == len(steps) - 1 else 0.1))
            here = there
        return np.vstack([*out, *pieces])

    def way(self, q_rad: F64, joint: int, rest_s: float = 2.3) -> F64:
        """A joint by 40° in the direction that counts as positive."""
        there = q_rad.copy()
        there[joint] += np.radians(40.0)
        return self.move(q_rad, there, rest_s)

    def samples(self, q_rad: F64, t_s: float) -> Samples:
        """What comes of these postures, from a time on."""
        t = t_s + np.arange(len(q_rad)) / RATE_HZ
        return Samples(t, None, self.counts(q_rad))

    def whole(
        self, ways: Sequence[int] | None = None, skipped: Sequence[int] = (), posture_rad: F64 | None = None
    ) -> F64:
        """(N, n) an arm commissioned: held still, each joint turned, put in a posture, then each turned in its
        direction, the last one first. ways: of which joints; skipped: never turned, only waited for."""
        here = np.zeros(self.n)
        pieces = [np.repeat(here[None], int(4.3 * RATE_HZ), axis=0)]
        for k in range(self.n):
            waits = np.repeat(here[None], int(30.5 * RATE_HZ), axis=0)
            pieces.append(waits if k in skipped else self.turn(here, [k]))
        if posture_rad is not None:
            pieces.append(self.move(here, posture_rad, 2.3))
            here = posture_rad
        for k in reversed(range(self.n) if ways is None else sorted(ways)):
            if k not in skipped:
                pieces.append(self.way(here, k))
                here = pieces[-1][-1]
        return np.vstack(pieces)
