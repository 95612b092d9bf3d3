"""Candidates and their rows, drawn in pieces by whoever works."""

from __future__ import annotations

from functools import partial

import numpy as np

from ulna.arm.arm import Arm
from ulna.ground.arrays import F64, I64, Progress
from ulna.planning.candidates import Candidates, draw, joined, places_of
from ulna.planning.information import candidate_rows
from ulna.planning.spec import PlanSpec
from ulna.simulation.mover import Mover
from ulna.work.pieces import Workers

PIECE_PLACES = 50
"""Places in a piece: some tens of milliseconds, and a megabyte of rows."""


def draw_all(
    spec: PlanSpec, arm: Arm, mover: Mover, probe: int, free: I64, workers: Workers, told: Progress
) -> tuple[Candidates, F64]:
    """All candidates and their (N, k, free) rows. Piece k draws from (seed, 43, k), whoever does it.

    Raises UlnaInputError where no places are found.
    """
    total = places_of(spec)
    pieces = [(number, min(PIECE_PLACES, total - first)) for number, first in enumerate(range(0, total, PIECE_PLACES))]
    found: dict[int, tuple[Candidates, F64]] = {}
    told("candidates", 0, total)
    mover.near_reach(np.zeros((1, 3)), probe)  # surveyed once, not by each who works
    for number, drawn in workers.each(partial(_piece, spec, arm, mover, probe, free), pieces):
        found[number] = drawn
        told("candidates", sum(len(candidates.features_mm) for candidates, _ in found.values()), total)
    in_order = [found[number] for number in range(len(pieces))]
    return joined([candidates for candidates, _ in in_order]), np.concatenate([rows for _, rows in in_order])


def _piece(
    spec: PlanSpec, arm: Arm, mover: Mover, probe: int, free: I64, piece: tuple[int, int]
) -> tuple[Candidates, F64]:
    """Number of the piece, and how many places."""
    number, count = piece
    candidates = draw(spec, mover, probe, np.random.default_rng([spec.seed, 43, number]), count)
    return candidates, candidate_rows(spec, arm, probe, free, candidates)
