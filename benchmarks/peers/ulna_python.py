"""Ulna from Python: NumPy arrays in, NumPy arrays out, through the compiled module."""

import os
import time

import numpy as np

import ulna._core as _core
from benchmarks.lengths import F64, HELD, Lengths
from benchmarks.peers import Contender, Times
from benchmarks.readings import ENCODER_NOISE_RAD, FOUND, START, TRUTH, lengths
from benchmarks.tasks import REPEATED_FITS, REPEATED_LENGTHS, measure_functions


def _arm(x: F64) -> _core.Arm:
    links = np.append(x[:24].reshape(6, 4), np.zeros((1, 4)), axis=0)
    theta0, alpha, a, d = (np.ascontiguousarray(column) for column in links.T)
    hayati = np.zeros(7, dtype=np.bool_)
    return _core.Arm(theta0, alpha, a, d, np.zeros(7), np.ones(7), hayati, ["bent"], x[24:].reshape(1, 3))


def _problem(x: F64, data: Lengths, encoder_u_rad: F64 | None = None) -> _core.Problem:
    problem = _core.Problem(_arm(x), encoder_u_rad, None)
    probe = np.zeros(len(data.length_mm), np.int64)
    problem.add("length", "lengths", q_rad=data.q_rad, p_rad=data.p_rad, probe=probe, measured_mm=data.length_mm)
    return problem


HOLD = np.isin(np.arange(27), HELD)


def _forward(x: F64, q_rad: F64) -> F64:
    return _arm(x).tip(q_rad)


def _fit(start: F64, data: Lengths) -> F64:
    return _core.fit(_problem(start, data), HOLD).parameters


def _recalibrate_s(threads: int) -> float:
    problem = _problem(START, lengths(REPEATED_LENGTHS), np.full(7, ENCODER_NOISE_RAD))
    since = time.perf_counter()
    _, _, converged = _core.recalibrate(problem, HOLD, _arm(TRUTH), REPEATED_FITS, seed=1, threads=threads)
    spent = time.perf_counter() - since
    if not np.all(converged):
        raise RuntimeError(f"{np.sum(~converged)} of {REPEATED_FITS} repeated fits did not converge")
    return spent


def _cold_start_s(starts: int = 20) -> float:
    """Slowest of some fits that know neither the zero offsets nor which way any encoder counts."""
    data, slowest = lengths(REPEATED_LENGTHS), 0.0
    offsets = 4 * np.arange(6)
    for seed in range(starts):
        rng = np.random.default_rng(seed)
        counts = rng.choice([-1.0, 1.0], 7)
        start = TRUTH + np.where(np.arange(27) % 4 > 1, 1.0, 0.0) * rng.uniform(-100.0, 100.0, 27)
        start[offsets] = rng.uniform(-np.pi, np.pi, 6)
        problem = _problem(start, Lengths(data.q_rad * counts, data.p_rad * counts, data.length_mm))
        since = time.perf_counter()
        fitted = _core.fit(problem, HOLD, start="search", seed=seed, unknown_signs=np.ones(7, dtype=np.bool_))
        slowest = max(slowest, time.perf_counter() - since)
        if not fitted.rms_mm < FOUND:
            raise RuntimeError(f"cold start {seed}: ended with an rms of {fitted.rms_mm:.3g} mm")
    return slowest


def contender() -> Contender:
    def measure(quick: bool) -> Times:
        times = measure_functions(_forward, None, _fit, quick, repeat=False, judged=True)
        times["cold_101"] = _cold_start_s()
        times["recalibrate"] = min(_recalibrate_s(1) for _ in range(3))
        if hasattr(os, "sched_setaffinity"):
            os.sched_setaffinity(0, range(os.cpu_count() or 1))
        times["recalibrate_2"] = min(_recalibrate_s(2) for _ in range(3))
        return times

    return Contender(
        "Ulna, from Python",
        f"ulna {_core.__version__}, kernels {_core.simd_level()}",
        "NumPy arrays to NumPy arrays; a fit counts copying the arrays into the core, fitting, and judging the result, "
        "and its memory counts that copy of the readings; the repeated fits bring the uncertainty of each parameter",
        measure,
    )
