"""Ceres in C++ with automatic derivatives: ceres.cpp beside this file, compiled here against libceres-dev."""

import json
import tempfile
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.lengths import Lengths
from benchmarks.peers import Contender, MissingPeerError, Times
from benchmarks.peers.native import FLAGS, compile_to, run
from benchmarks.readings import START, TRUTH, lengths, noisy
from benchmarks.tasks import (
    FIT_LENGTHS,
    FORWARD_POSES,
    REPEATED_FITS,
    REPEATED_LENGTHS,
    RESIDUAL_LENGTHS,
    check_found,
    fit_sizes,
)

EIGEN = Path("/usr/include/eigen3")


def _table(data: Lengths) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return np.column_stack([data.q_rad, data.p_rad, data.length_mm])


def contender() -> Contender:
    folder = tempfile.TemporaryDirectory()
    program = Path(folder.name) / "ceres"
    # The library was compiled without wide vectors; Eigen's objects must have its alignment.
    flags = ["-std=c++17", "-DNDEBUG", "-DEIGEN_MAX_ALIGN_BYTES=16", f"-I{EIGEN}", "-lceres", "-lglog"]
    compile_to(program, Path(__file__).with_suffix(".cpp"), flags, cxx=True)

    def solve(sets: list[Lengths]) -> dict[str, Any]:
        readings, start = Path(folder.name) / "readings", Path(folder.name) / "start"
        np.concatenate([_table(data) for data in sets]).tofile(readings)
        START.tofile(start)
        rows = len(sets[0].length_mm)
        answer: dict[str, Any] = json.loads(run(program, [str(readings), str(rows), str(len(sets)), str(start)]))
        return answer

    version = str(solve([lengths(101)])["version"])

    def measure(quick: bool) -> Times:
        times: Times = {}
        for rows in fit_sizes(quick):
            repeats = 20 if rows < 1000 else 1
            many = solve([lengths(rows)] * repeats)
            answers = [solve([lengths(rows)]) for _ in range(3 if rows < 100_000 else 0)]
            check_found(np.array(many["x"]), f"Ceres, {rows} lengths")
            times[f"fit_{rows}"] = min([many["fit_s"] / repeats, *(answer["fit_s"] for answer in answers)])
            if rows == RESIDUAL_LENGTHS:
                times["residual_jacobian"] = min(answer["residual_jacobian_s"] for answer in answers)
                times["forward"] = min(answer["forward_s"] for answer in answers) * FORWARD_POSES / rows
            if rows == FIT_LENGTHS[-1]:
                times["forward"] = many["forward_s"]
                times["peak_1000000_mb"] = many["peak_kb"] / 1024 - rows * 15 * 8 / 2**20
        exact = lengths(REPEATED_LENGTHS)
        sets = [noisy(exact, seed) for seed in range(REPEATED_FITS)]
        found = solve(sets)
        if np.max(np.abs(np.array(found["x"]) - TRUTH)) > 1.0:
            raise MissingPeerError("a repeated fit did not converge")
        times["recalibrate"] = found["fit_s"]
        return times

    return Contender(
        "Ceres",
        f"Ceres {version}",
        f"C++ with automatic derivatives (jets), compiled with {' '.join(FLAGS)}; DENSE_QR to 1000 rows, "
        "DENSE_NORMAL_CHOLESKY above, building the problem included",
        measure,
    )
