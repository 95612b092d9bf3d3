"""A hand that holds a virtual arm: what its encoders read, and a source file of it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from ulna.ground.arrays import F64

NOISE_RAD = 5e-6
RATE_HZ = 100.0
DWELL, TRAVEL = 250, 60
"""Samples."""


def hand(poses: Sequence[F64], seed: int = 1, dwell: int = DWELL) -> F64:
    """(N, n) what encoders read while a hand rests in each of the poses and travels in between."""
    rows = [np.tile(poses[0], (dwell, 1))]
    for before, after in pairwise(poses):
        part = np.linspace(0.0, 1.0, TRAVEL)[:, None]
        rows += [before + (after - before) * part, np.tile(after, (dwell, 1))]
    q_rad = np.concatenate(rows)
    return q_rad + np.random.default_rng(seed).normal(0.0, NOISE_RAD, q_rad.shape)


def near(count: int, seed: int = 5) -> list[F64]:
    """Poses a hand's breadth from each other."""
    rng = np.random.default_rng(seed)
    first = rng.uniform(-1.5, 1.5, 7)
    return [first + rng.normal(0.0, 0.05, 7) for _ in range(count)]


def source(folder: Path, q_rad: F64, speed: str = "max") -> Path:
    """A source file of a recording."""
    names = ",".join(f"q{k + 1}" for k in range(q_rad.shape[1]))
    rows = "\n".join(",".join(map(repr, row)) for row in q_rad.tolist())
    (folder / "run.csv").write_text(f"{names}\n{rows}\n")
    path = folder / "source.toml"
    path.write_text(
        f'format = "ulna-source/1"\nurl = "file:{folder}/run.csv?speed={speed}&rate={RATE_HZ:g}"\n[map]\nunit = "rad"\n'
    )
    return path
