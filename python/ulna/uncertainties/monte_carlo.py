"""Monte Carlo propagation of distributions: JCGM 101:2008 (GUM Supplement 1), clauses 7 and 8.

In the units of y. Trials are the caller's: this room only counts, sorts and decides when there are enough.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ulna.ground.arrays import F64, Progress
from ulna.ground.errors import UlnaInputError

Draw = Callable[[int, int], F64]


@dataclass(frozen=True)
class MonteCarlo:
    """What the trials say about y."""

    y: float
    """Mean of the trials (7.6)."""
    u: float
    """Standard deviation of the trials, divided by trials - 1 (7.6)."""
    p: float
    """Coverage probability of the intervals."""
    symmetric: tuple[float, float]
    """Probabilistically symmetric interval: as much probability below it as above (7.7.2)."""
    shortest: tuple[float, float]
    """Shortest interval of all that hold the share p of the trials (7.7.2, 5.3.4)."""
    trials: int
    settled: bool
    """Whether the adaptive procedure ended by its own rule (7.9.4); False where the trials were merely given."""
    tolerance: float
    """δ, half a unit of the last significant digit of u (7.9.2)."""


def tolerance(u: float, digits: int = 2) -> float:
    """δ = ½·10^l, where u is written with `digits` significant digits as c·10^l, c whole (7.9.2). 0 for u = 0."""
    if u == 0.0:
        return 0.0
    # the exponent after rounding: 0.0996 is 0.10 in two digits
    exponent = int(f"{u:.{digits - 1}e}".split("e")[1])
    return 0.5 * 10.0 ** (exponent - digits + 1)


def summarize(values: F64, p: float = 0.95, digits: int = 2) -> MonteCarlo:
    """From given trials (M,): mean, standard deviation, and intervals from the sorted trials (7.5 to 7.7).

    Refuses trials that are not finite, and fewer than the intervals need, with UlnaInputError.
    """
    ordered = _sorted(values, first=0, p=p)
    u = float(np.std(ordered, ddof=1))
    return MonteCarlo(
        y=float(np.mean(ordered)),
        u=u,
        p=p,
        symmetric=_symmetric(ordered, p),
        shortest=_shortest(ordered, p),
        trials=len(ordered),
        settled=False,
        tolerance=tolerance(u, digits),
    )


def adaptive(
    draw: Draw, p: float = 0.95, digits: int = 2, most: int = 10_000_000, progress: Progress | None = None
) -> MonteCarlo:
    """Batches of trials until the figures are steady to `digits` digits of u (7.9.4), or `most` trials are reached.

    draw(first, count) → (count,): the values of trials first … first + count - 1. Where the value of a trial depends on
    its number alone, so does the result. A batch has max(10⁴, 100/(1 - p)) trials, fewer only if `most` is smaller; the
    total never exceeds `most`. From the second batch on: steady is where twice the standard error, over the batches, of
    each of y, u and the two ends of the symmetric interval is at most δ. The result is from all trials together.

    The rule judges by standard errors that are themselves random, of two batches at first: each figure is then within δ
    about 19 times in 20, not always. It looks at the symmetric interval; the ends of the shortest vary more.

    progress("trials", done, expected): expected is a forecast by the slowest of the four figures.
    """
    size = min(max(10_000, math.ceil(100.0 / (1.0 - p))), most)
    batches: list[F64] = []
    figures: list[tuple[float, float, float, float]] = []
    expected, settled = 2 * size, False
    while not settled and (len(batches) + 1) * size <= most:
        if progress:
            progress("trials", len(batches) * size, min(expected, most))
        values = np.asarray(draw(len(batches) * size, size), dtype=np.float64)
        ordered = _sorted(values, len(batches) * size, p)
        batches.append(values)
        figures.append((float(ordered.mean()), float(ordered.std(ddof=1)), *_symmetric(ordered, p)))
        if len(batches) > 1:
            limit = tolerance(_u_of_all(np.array(figures), size), digits)
            spread = 2.0 * float((np.std(figures, axis=0, ddof=1) / math.sqrt(len(figures))).max())
            settled = spread <= limit
            if not settled:
                # the standard error falls with the root of the number of batches
                expected = size * max(len(batches) + 1, math.ceil(len(batches) * (spread / limit) ** 2))
    if progress:
        progress("trials", len(batches) * size, len(batches) * size)
    return replace(summarize(np.concatenate(batches), p, digits), settled=settled)


def agrees(
    y: float, expanded: float, found: MonteCarlo, digits: int = 2, shortest: bool = False
) -> tuple[bool, float, float]:
    """Whether first order agrees with the trials to `digits` digits of u, and d_low, d_high (clause 8).

    y, expanded: the estimate and U_p of the law of propagation, at found.p. Agreement: d_low = |y - U - y_low| and
    d_high = |y + U - y_high| are both at most δ of found.u. `shortest` compares with the shortest interval instead of
    the symmetric one.
    """
    low, high = found.shortest if shortest else found.symmetric
    d_low, d_high = abs(y - expanded - low), abs(y + expanded - high)
    return max(d_low, d_high) <= tolerance(found.u, digits), d_low, d_high


def _sorted(values: F64, first: int, p: float) -> F64:
    bad = np.flatnonzero(~np.isfinite(values))
    if len(bad):
        raise UlnaInputError(
            f"Monte Carlo trial {first + bad[0]} gave {values[bad[0]]}, one of {len(bad)} in {len(values)} trials that "
            "are not finite; expected a finite value of every trial. State smaller uncertainties, or a measurand that "
            "is defined all over them."
        )
    if len(values) - _inside(len(values), p) < 1:
        needed = math.floor(0.5 / (1.0 - p)) + 1
        raise UlnaInputError(
            f"{len(values)} Monte Carlo trials are too few for an interval of p = {p}; expected at least {needed}, "
            f"and for steady ends {math.ceil(100.0 / (1.0 - p))}. Allow more trials."
        )
    ordered: F64 = np.sort(values)
    return ordered


def _inside(trials: int, p: float) -> int:
    """q of 7.7.2: pM, rounded to the nearest whole number."""
    return math.floor(p * trials + 0.5)


def _symmetric(ordered: F64, p: float) -> tuple[float, float]:
    """7.7.2: from the r-th smallest to the (r + q)-th, r = (M - q)/2 rounded up at one half."""
    q = _inside(len(ordered), p)
    r = (len(ordered) - q + 1) // 2
    return float(ordered[r - 1]), float(ordered[r + q - 1])


def _shortest(ordered: F64, p: float) -> tuple[float, float]:
    """7.7.2: of all intervals from the r-th smallest to the (r + q)-th, the shortest."""
    q = _inside(len(ordered), p)
    r = int(np.argmin(ordered[q:] - ordered[:-q]))
    return float(ordered[r]), float(ordered[r + q])


def _u_of_all(figures: F64, size: int) -> float:
    """Standard deviation of all trials from the means and standard deviations of batches of one size."""
    within = (size - 1) * (figures[:, 1] ** 2).sum()
    between = size * ((figures[:, 0] - figures[:, 0].mean()) ** 2).sum()
    return math.sqrt((within + between) / (len(figures) * size - 1))
