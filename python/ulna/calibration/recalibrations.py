"""Calibrations repeated on new noise, cut into pieces: what a study's uncertainties are worth."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ulna.arm.arm import Arm
from ulna.arm.file import arm_toml
from ulna.ground.arrays import Arrays
from ulna.ground.errors import UlnaInputError
from ulna.study.assembly import assemble
from ulna.study.study import Study
from ulna.work.kept import each_once, sha256_of
from ulna.work.ledger import Ledger
from ulna.work.pieces import Threads, Workers

F64 = NDArray[np.float64]
Progress = Callable[[str, int, int], None]

PIECE_RUNS = 500
"""Calibrations in a piece: some tens of milliseconds, next to which handing it over costs little."""


@dataclass(frozen=True)
class Recalibrations:
    """Parameters of calibrations on new noise each."""

    names: list[str]
    parameters: F64
    """(runs, P), rad and mm."""
    u: F64
    """(runs, P) standard uncertainties that each stated; NaN where held or not determined."""
    converged: NDArray[np.bool_]
    """(runs,)"""


def recalibrations(
    study: Study,
    truth: Arm,
    runs: int,
    seed: int = 0,
    *,
    workers: Workers | None = None,
    ledger: Ledger | None = None,
    progress: Progress | None = None,
    piece_runs: int = PIECE_RUNS,
) -> Recalibrations:
    """Calibrate `runs` times on readings that are exact for `truth` plus newly drawn noise as the study states it.

    Run k draws from (seed, k), so the numbers depend neither on the workers nor on how the work is cut. With a ledger,
    pieces finished earlier are not done again. Raises UlnaInputError without stated noise; KeyboardInterrupt.
    """
    if study.noise is None:
        raise UlnaInputError(
            f"{study.label}: calibrations are repeated on noise drawn anew, but no noise is stated; expected [noise]. "
            "State it."
        )
    pieces = [(first, min(piece_runs, runs - first)) for first in range(0, runs, piece_runs)]
    told = progress if progress is not None else lambda *_: None
    told("calibrations", 0, runs)
    found: dict[int, Arrays] = {}
    for number, arrays in each_once(workers or Threads(), partial(_piece, study, truth, seed), pieces, ledger):
        found[number] = arrays
        told("calibrations", sum(pieces[number][1] for number in found), runs)
    in_order = [found[number] for number in range(len(pieces))]
    parameters, u, converged = (
        np.concatenate([arrays[name] for arrays in in_order]) for name in ("parameters", "u", "converged")
    )
    return Recalibrations(assemble(study).names, parameters, u, converged)


def job_of(study: Study, truth: Arm, runs: int, seed: int, piece_runs: int = PIECE_RUNS) -> dict[str, Any]:
    """What a ledger must know of such a job: everything that its numbers depend on."""
    parts: list[str | NDArray[Any] | None] = [arm_toml(arm) for arm in (study.arm, truth)]
    parts.append(repr((study.noise, study.fit)))
    for group in study.readings:
        parts.append(repr((group.artefact, group.placement.tolist())))
        parts += [group.q_rad, group.p_rad, group.length_mm, group.probe, group.feature]
        parts += [said for _, _, said in group.conditions()]
    content = {"runs": runs, "seed": seed, "piece_runs": piece_runs, "study_sha256": sha256_of(*parts)}
    return {"job": "recalibrations", **content}


def recalibrated(
    study: Study, truth: Arm, seed: int, first: int, count: int, workers: Workers, ledger: Ledger | None = None
) -> Arrays:
    """parameters, u and converged of runs first … first + count - 1, which a job of any length has in common.

    first is a multiple of PIECE_RUNS. With a ledger, of `job_of` this study, finished pieces are kept.
    """
    pieces = [(k, min(PIECE_RUNS, first + count - k)) for k in range(first, first + count, PIECE_RUNS)]
    numbers = [k // PIECE_RUNS for k, _ in pieces]
    found = dict(each_once(workers, partial(_piece, study, truth, seed), pieces, ledger, numbers))
    return {name: np.concatenate([found[k][name] for k in range(len(pieces))]) for name in found[0]}


def _piece(study: Study, truth: Arm, seed: int, piece: tuple[int, int]) -> Arrays:
    """One piece: runs (first, count)."""
    import ulna._core as _core

    first, count = piece
    assembled = assemble(study.with_arm(study.arm.with_signs(truth.signs)))
    parameters, u, converged = _core.recalibrate(
        assembled.problem, assembled.hold, truth.core, count, seed=seed, threads=1, first=first
    )
    return {"parameters": parameters, "u": u, "converged": converged}
