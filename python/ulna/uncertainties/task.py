"""A measurement to be judged: what is measured, in which poses, and what is known of the readings."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.reading_noise import ReadingNoise
from ulna.ground.arrays import F64
from ulna.uncertainties.measurands import Touched

BLOCK = 1000
"""Trials that share one generator: trial k draws from (seed, k // BLOCK), so the cut does not matter."""

UNSTATED_BALL = "the probe's ball: the arm file does not state its diameter, so that of its centres is given"


@dataclass(frozen=True)
class Task:
    """Poses at the features of a measurand."""

    touched: Touched
    q_rad: F64
    """(N, n)"""
    probe: str
    label: str
    """What messages call it."""
    noise: ReadingNoise
    """How its readings scatter."""
    temperature_c: float | None = None
    """Of the links, where they grow with it."""
    approach: F64 | None = None
    """(N, n) from which side joints were approached, where that matters."""
    payload: F64 | None = None
    """(N, 4) what was carried, where that matters: kg and mm."""
    u_temperature_k: float = 0.0
    """Standard uncertainty of that, the same for all touches."""
    inside: bool = False
    """Of a ball, a hollow, of a circle a hole: touched from within."""
    p: float = 0.95
    """Coverage probability."""
    digits: int = 2
    """Significant digits of an uncertainty, by which a Monte Carlo calculation stops."""

    def tips_mm(self, arm: Arm, q_rad: F64, warmer_k: float = 0.0) -> F64:
        """(N, 3) tips at (N, n) encoder angles, links warmer than stated by so much."""
        return arm.tip(q_rad, self.probe, **self.said(warmer_k))

    def said(self, warmer_k: float = 0.0) -> dict[str, Any]:
        """What `Arm.tip` asks for beside angles and probe, links warmer than stated by so much."""
        warm = None if self.temperature_c is None else self.temperature_c + warmer_k
        return {"temperature_c": warm, "approach": self.approach, "payload": self.payload}

    def values(self, arm: Arm, tips_mm: F64, like_mm: F64 | None = None) -> F64:
        """(T, N, 3) tips → (T, values): the measurand's, of a diameter with the probe's own ball taken off. like_mm: as
        `Touched.values` has it."""
        values = self.touched.values(tips_mm, like_mm)
        measurand = self.touched.measurand
        if measurand.diameter is not None:
            own = arm.probes[self.probe].ball_mm or 0.0
            values[:, list(measurand.units).index(measurand.diameter)] += own if self.inside else -own
        return values

    def left_out(self, arm: Arm) -> tuple[str, ...]:
        """What the uncertainty of what is measured never has, in words."""
        measurand = self.touched.measurand
        bare = measurand.diameter is not None and not arm.probes[self.probe].ball_mm
        return (*measurand.left_out, *((UNSTATED_BALL,) if bare else ()))

    def drawn(self, arm: Arm, parameters: F64, first: int, seed: int) -> F64:
        """(T, values) of trials first … first + T − 1, each with its own row of parameters (T, P) and with encoders,
        touches and temperature drawn anew."""
        blocks = (slice(start, start + BLOCK) for start in range(0, len(parameters), BLOCK))
        return np.concatenate([self._block(arm, parameters[rows], first + rows.start, seed) for rows in blocks])

    def _block(self, arm: Arm, parameters: F64, first: int, seed: int) -> F64:
        """Some of them, few enough that memory stays bounded."""
        count, poses = len(parameters), len(self.q_rad)
        noise = self._noise(first, count, seed)
        core, probe = arm.core, arm.probe_index(self.probe)
        tips = np.empty((count, poses, 3))
        encoder_rad = self.noise.encoder_rad
        q_rad = self.q_rad + noise[:, :, : arm.n] * (0.0 if encoder_rad is None else encoder_rad)
        for k in range(count):
            at = arm.conditions(poses, **self.said(self.u_temperature_k * noise[k, 0, -1]))
            tips[k] = core.with_parameters(parameters[k]).tip(q_rad[k], probe, **at)
        more = self.inflated(first, count, seed)
        own_mm = np.sqrt(self.noise.estimated_mm2 * more**2 + self.noise.stated_mm2)
        tips += own_mm[:, None, None] * noise[:, :, arm.n : arm.n + 3]
        return self.values(arm, tips, self.tips_mm(arm, self.q_rad))

    def inflated(self, first: int, count: int, seed: int) -> F64:
        """(count,) by how much what the calibration estimated from its residuals is larger in each trial, √(ν / χ²_ν):
        with it normal numbers become Student's t (JCGM 101 6.4.9), of parameters and touches alike, for it is one
        estimate."""
        freedom = self.noise.degrees_of_freedom
        if math.isinf(freedom):
            return np.ones(count)
        found: F64 = np.sqrt(freedom / chi_squared_in_blocks(first, count, seed, 3, freedom))
        return found

    def _noise(self, first: int, count: int, seed: int) -> F64:
        """(count, N, n + 4) standard normals: encoders, three coordinates, and one (of the first pose) for the
        temperature."""
        shape = (len(self.q_rad), self.q_rad.shape[1] + 4)
        return in_blocks(first, count, seed, 1, shape)


def in_blocks(first: int, count: int, seed: int, stream: int, shape: tuple[int, ...]) -> F64:
    """(count, *shape) standard normals of trials first … first + count − 1, whatever piece is asked for."""
    return _in_blocks(first, count, seed, stream, lambda rng: rng.standard_normal((BLOCK, *shape)))


def chi_squared_in_blocks(first: int, count: int, seed: int, stream: int, degrees_of_freedom: float) -> F64:
    """(count,) chi-squared numbers in the same way."""
    return _in_blocks(first, count, seed, stream, lambda rng: rng.chisquare(degrees_of_freedom, BLOCK))


def _in_blocks(first: int, count: int, seed: int, stream: int, draw: Callable[[np.random.Generator], F64]) -> F64:
    pieces = []
    for block in range(first // BLOCK, (first + count - 1) // BLOCK + 1):
        start = block * BLOCK
        pieces.append(draw(np.random.default_rng([seed, stream, block]))[max(first - start, 0) : first + count - start])
    return np.concatenate(pieces)
