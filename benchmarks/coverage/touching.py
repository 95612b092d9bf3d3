"""How true arms touch what stands somewhere: postures, and readings with noise drawn anew. Lengths mm, angles rad.

A place is looked for once; from there each calibration's touches are a few steps of Newton away.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from benchmarks.coverage.arms import Array, TrueArm


@dataclass(frozen=True)
class Errors:
    """How readings err: standard deviations."""

    encoder_rad: float
    touch_mm: float
    """Of each coordinate."""
    missed: float = 0.0
    """Share of touches that miss."""
    missed_mm: float = 0.5
    """By how much in each coordinate, standard deviation."""

    def beside(self, count: int, rng: np.random.Generator) -> Array:
        """(count, 3) how far touches are off."""
        off_mm = np.where(rng.random((count, 1)) < self.missed, self.missed_mm, self.touch_mm)
        found: Array = off_mm * rng.standard_normal((count, 3))
        return found


@dataclass(frozen=True)
class Placed:
    """An artefact that stands, and exact postures that touch it."""

    true: TrueArm
    name: str
    table: dict[str, Any]
    """As a study states it."""
    columns: dict[str, Any]
    """Of each row, beside the angles."""
    poses: int
    """Of a row: 1, or 2 of rows of lengths."""
    points_mm: Array
    """(poses N, 3) where the tip is; first poses first."""
    readings: Array
    """(poses N, n or 3 n)"""
    moves_mm: Array
    """(poses N, K, 3) how these are moved by each standard uncertainty of the artefact."""

    @cached_property
    def back(self) -> Array:
        """(poses N, n, 3) rad/mm: the least motion of the joints that moves the tip."""
        j = self.true.by_encoder(self.readings)
        found: Array = np.einsum("nki,nkl->nil", j, np.linalg.inv(j @ j.transpose(0, 2, 1)))
        return found

    def drawn(self, errors: Errors, rng: np.random.Generator) -> list[Array]:
        """(N, n or 3 n) of each pose of a row: the artefact as it may be, touched and read with noise."""
        artefact = rng.standard_normal(self.moves_mm.shape[1])
        at_mm = self.points_mm + np.einsum("nkj,k->nj", self.moves_mm, artefact)
        at_mm = at_mm + errors.beside(len(at_mm), rng)
        readings, n = self.settled(at_mm), self.true.n
        readings[:, :n] += errors.encoder_rad * rng.standard_normal((len(readings), n))
        return np.split(readings, self.poses)

    def settled(self, points_mm: Array) -> Array:
        """(poses N, n or 3 n) postures with the tip on points that are near its own; the derivative there is good for
        all steps."""
        readings = self.readings.copy()
        for _ in range(12):
            miss = points_mm - self.true.tips.tip(readings)
            if np.abs(miss).max() < 1e-9:
                return readings
            readings[:, : self.true.n] += np.einsum("nik,nk->ni", self.back, miss)
        raise AssertionError(f"a touch was not reached by {np.abs(miss).max():g} mm")


class Artefact(Protocol):
    """Something that may be placed."""

    def place(self, true: TrueArm, rng: np.random.Generator) -> Placed:
        """Somewhere within reach."""


def found(true: TrueArm, points_mm: Array, rng: np.random.Generator, tries: int = 3) -> Array:
    """(N, n or 3 n) postures within the travel, anyhow, with the tip on (N, 3) points; NaN where none was found."""
    low, high = np.broadcast_to(true.travel_rad, (true.n, 2)).T
    out = np.full((len(points_mm), true.random(1, rng).shape[1]), np.nan)
    for _ in range(tries):
        rest = np.flatnonzero(np.isnan(out[:, 0]))
        r = true.random(len(rest), rng)
        for _ in range(20):
            if not len(rest):
                break
            miss = points_mm[rest] - true.tips.tip(r)
            there = np.abs(miss).max(axis=1) < 1e-10
            good = there & ((r[:, : true.n] >= low) & (r[:, : true.n] <= high)).all(axis=1)
            out[rest[good]] = r[good]
            rest, r, miss = rest[~there], r[~there], miss[~there]
            j = true.about_by_encoder(r)
            damping = (1e-3 * (miss**2).sum(axis=1))[:, None, None] * np.eye(3)
            pull = np.linalg.solve(j @ j.transpose(0, 2, 1) + damping, miss[..., None])[..., 0]
            step = np.einsum("nki,nk->ni", j, pull)
            r[:, : true.n] += step / np.maximum(1.0, np.abs(step).max(axis=1, keepdims=True) / 0.5)
    return out


def somewhere(true: TrueArm, count: int, rng: np.random.Generator) -> Array:
    """(count, 3) points that the arm reaches, not too near its column and not at its end."""
    points = true.tips.tip(true.random(20 * count, rng))
    far = np.linalg.norm(points, axis=1)
    return np.asarray(points[(far > 300.0) & (far < 0.85 * far.max())][:count])


def turns(count: int, rng: np.random.Generator) -> Array:
    """(count, 3, 3) random rotations, columns the artefact's axes."""
    q, _ = np.linalg.qr(rng.standard_normal((count, 3, 3)))
    return np.asarray(q * np.linalg.det(q)[:, None, None])


def rows_of(placed: Placed, readings: Sequence[Array]) -> dict[str, Any]:
    """The frame of a study."""
    true = placed.true
    columns = {"qp"[k] + str(i + 1): r[:, i] for k, r in enumerate(readings) for i in range(true.n)}
    said = true.said(readings[0])
    columns |= {"temperature": said["temperature_c"]} if "temperature_c" in said else {}
    columns |= {f"approach{i + 1}": said["approach"][:, i] for i in range(true.n) if "approach" in said}
    return columns | placed.columns
