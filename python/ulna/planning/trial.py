"""The plan put to the test: calibrations on its readings and on random ones, noise drawn anew, fresh bars measured."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.file import arm_toml
from ulna.ground.arrays import F64, I64, Arrays, Bool, Progress
from ulna.planning.measurements import problem_of
from ulna.planning.spec import PlanSpec
from ulna.work.kept import each_once, sha256_of
from ulna.work.ledger import Ledger
from ulna.work.pieces import Workers

if TYPE_CHECKING:
    import ulna._core as _core


PIECE_RUNS = 50
"""Calibrations in a piece: some tenths of a second where bars are touched at both ends."""


@dataclass(frozen=True)
class Trial:
    """Errors of the lengths of fresh bars, read without noise by calibrated arms: what the arm contributes."""

    runs: int
    """Calibrations on the plan, and as many on random measurements."""
    planned_mm: float
    """Root mean square over calibrations and bars."""
    random_mm: float
    converged: int
    """Of twice as many runs."""

    @property
    def gain(self) -> float:
        """By which part the errors are smaller."""
        return 1.0 - self.planned_mm / self.random_mm


def carry_out(
    arm: Arm,
    spec: PlanSpec,
    probe: int,
    free: I64,
    sets: list[F64],
    bars_rad: F64,
    workers: Workers,
    keep: str | Path | None,
    told: Progress,
) -> Trial:
    """`spec.trials` calibrations on the first set of poses (count, K, t, n), and as many on the others in turn; each
    measures the (B, 2, n) bars.

    keep: folder for finished pieces. Raises UlnaInputError where it cannot be used; KeyboardInterrupt.
    """
    hold = np.ones(len(arm.parameter_names), dtype=bool)
    hold[free] = False
    others = len(sets) - 1
    shares = [spec.trials, *(spec.trials // others + (k < spec.trials % others) for k in range(others))]
    pieces = [
        (number, first, min(PIECE_RUNS, share - first))
        for number, share in enumerate(shares)
        for first in range(0, share, PIECE_RUNS)
    ]
    work = partial(_piece, arm, spec, probe, hold, sets, np.ascontiguousarray(bars_rad.reshape(-1, arm.n)))
    ledger = None
    if keep is not None:
        noise = repr((spec.encoder_rad.tolist(), spec.seat_mm, spec.artefact, probe))
        job = {
            "trials": spec.trials,
            "seed": spec.seed,
            "sha256": sha256_of(arm_toml(arm), noise, hold, bars_rad, *sets),
        }
        ledger = Ledger(Path(keep), {"job": "trial of a plan", **job})
    found: dict[int, Arrays] = {}
    told("trial", 0, 2 * spec.trials)
    for number, arrays in each_once(workers, work, pieces, ledger):
        found[number] = arrays
        told("trial", sum(len(arrays["squares"]) for arrays in found.values()), 2 * spec.trials)
    squares: dict[bool, list[F64]] = {True: [], False: []}
    for number in range(len(pieces)):
        squares[pieces[number][0] == 0].append(found[number]["squares"])
    own, by_chance = (float(np.sqrt(np.mean(np.concatenate(squares[planned])))) for planned in (True, False))
    good = sum(int(arrays["converged"].sum()) for arrays in found.values())
    return Trial(spec.trials, own, by_chance, good)


def _piece(
    arm: Arm,
    spec: PlanSpec,
    probe: int,
    hold: Bool,
    sets: list[F64],
    bars_rad: F64,
    piece: tuple[int, int, int],
) -> Arrays:
    """Which set, and runs (first, count): the mean square error (mm²) of the bars' lengths by each calibrated arm."""
    import ulna._core as _core

    number, first, count = piece

    def lengths(core: _core.Arm) -> F64:
        ends = core.tip(bars_rad, probe).reshape(-1, 2, 3)
        distance: F64 = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        return distance

    true_mm = lengths(arm.core)
    parameters, _, converged = _core.recalibrate(
        problem_of(arm, spec, probe, sets[number]),
        hold,
        arm.core,
        count,
        seed=spec.seed + number,
        threads=1,
        uncertainties=False,
        first=first,
    )
    squares = [np.mean((lengths(arm.core.with_parameters(row)) - true_mm) ** 2) for row in parameters]
    return {"squares": np.array(squares), "converged": converged}
