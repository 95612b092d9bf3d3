"""The tasks, their sizes, and how a contender that is a set of Python functions is timed at them."""

import contextlib
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.lengths import F64, Lengths
from benchmarks.peers import Times
from benchmarks.readings import FOUND, START, TRUTH, lengths, noisy, poses

FORWARD_POSES = 1_000_000
#: what a touch costs by what is touched; on the bars, by what the arm does beyond its geometry
TOUCHED = ("bar", "plate", "seat", "sphere", "cylinder", "plane", "distance")
EFFECTS = ("harmonics 1", "harmonics 1, 2", "expansion", "compliance")
#: as many lengths as stay in the caches: what a kernel does, not what the memory bus does
RESIDUAL_LENGTHS = 10_000
FIT_LENGTHS = (101, 10_000, 1_000_000)
REPEATED_FITS = 1000
REPEATED_LENGTHS = 101

TASKS: dict[str, str] = {
    "forward": f"forward map of {FORWARD_POSES:,} poses",
    "residual_jacobian": f"residuals and Jacobian of {RESIDUAL_LENGTHS:,} lengths ({2 * RESIDUAL_LENGTHS:,} poses)",
    "fit_101": "whole fit, 101 lengths",
    "fit_10000": "whole fit, 10,000 lengths",
    "fit_1000000": "whole fit, 1,000,000 lengths",
    "judged_101": "… with covariance and what is determined, 101 lengths",
    "judged_10000": "… with covariance and what is determined, 10,000 lengths",
    "judged_1000000": "… with covariance and what is determined, 1,000,000 lengths",
    "cold_101": "cold start: zero offsets and signs of 7 joints unknown, 101 lengths, the slowest of 20",
    "recalibrate": f"{REPEATED_FITS:,} fits of {REPEATED_LENGTHS} lengths, new noise each, one thread",
    "recalibrate_2": f"{REPEATED_FITS:,} fits of {REPEATED_LENGTHS} lengths, new noise each, two threads",
    "peak_1000000_mb": "memory beyond the readings at the peak of the fit to 1,000,000 lengths",
}
KINDS: dict[str, str] = {
    **{f"touch_{kind}": f"a touch of a {kind}" for kind in TOUCHED},
    **{f"touch_{effect}": f"a touch of a bar, {effect} in the model" for effect in EFFECTS},
}


def fit_sizes(quick: bool) -> tuple[int, ...]:
    return FIT_LENGTHS[:2] if quick else FIT_LENGTHS


def best_of(work: Callable[[], object], repeats: int = 5, enough_s: float = 2.0) -> float:
    """Seconds of the fastest of some repeats, after one to warm up; stops repeating after `enough_s`."""
    begin = time.perf_counter()
    work()
    if time.perf_counter() - begin > enough_s:
        return time.perf_counter() - begin
    best = np.inf
    while repeats > 0 and time.perf_counter() - begin < enough_s:
        since = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - since)
        repeats -= 1 if best > 0.01 else 0
    return best


def check_found(parameters: F64, what: str) -> None:
    """Raises RuntimeError where a noise-free fit did not come back with the truth."""
    worst = float(np.max(np.abs(parameters - TRUTH)))
    if not worst < FOUND:
        raise RuntimeError(f"{what}: the fit ended {worst:.3g} away from the truth")


def resident_mb(key: str) -> float:
    """VmRSS or VmHWM of this process, MB; NaN where the system does not tell."""
    try:
        status = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
    except OSError:
        return float("nan")
    return next(int(line.split()[1]) / 1024 for line in status if line.startswith(key))


def _reset_peak() -> None:
    """Let VmHWM start again from what is resident now (Linux)."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")


def measure_functions(
    forward: Callable[[F64, F64], F64] | None,
    residual_jacobian: Callable[[F64, Lengths], object] | None,
    fit: Callable[[F64, Lengths], F64] | None,
    quick: bool,
    repeat: bool = True,
    judged: bool = False,
) -> Times:
    """Times of a contender given as functions of (27,) parameters and angles or lengths.

    repeat: the 1000 fits too. judged: a fit brings covariance and what is determined along.
    """
    from benchmarks.peers.numpy_map import tips

    times: Times = {}
    if forward is not None:
        q_rad = poses(FORWARD_POSES, seed=7)
        worst = float(np.max(np.abs(forward(TRUTH, q_rad[:1000]) - tips(TRUTH, q_rad[:1000]))))
        if not worst < 1e-9:
            raise RuntimeError(f"forward map: off by {worst:.3g} mm")
        times["forward"] = best_of(lambda: forward(TRUTH, q_rad))
    if residual_jacobian is not None:
        data = lengths(RESIDUAL_LENGTHS)
        times["residual_jacobian"] = best_of(lambda: residual_jacobian(START, data))
    if fit is not None:
        for rows in fit_sizes(quick):
            data = lengths(rows)
            before = resident_mb("VmRSS")
            _reset_peak()
            check_found(fit(START, data), f"{rows} lengths")
            if rows == FIT_LENGTHS[-1]:
                times["peak_1000000_mb"] = resident_mb("VmHWM") - before
            times[f"{'judged' if judged else 'fit'}_{rows}"] = best_of(lambda data=data: fit(START, data))  # type: ignore[misc]
        if repeat:
            exact = lengths(REPEATED_LENGTHS)
            sets = [noisy(exact, seed) for seed in range(REPEATED_FITS)]
            since = time.perf_counter()
            for data in sets:
                fit(START, data)
            times["recalibrate"] = time.perf_counter() - since
    return times
