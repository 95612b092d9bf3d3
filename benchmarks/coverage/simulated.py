"""``python -m benchmarks.coverage simulated``: stated 95 % intervals against the truth of simulated arms.

The truth is the chain of tests/oracle, apart from Ulna, and readings have noise that is drawn anew for each
calibration. What is judged: `benchmarks.coverage.judging`.
"""

import argparse
import dataclasses
import sys
import warnings
import zlib
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from fnmatch import fnmatchcase
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

import ulna
from benchmarks.coverage.cases import CASES
from benchmarks.coverage.designs import design, drawing
from benchmarks.coverage.judging import JUDGES, Counted
from benchmarks.coverage.statistics import share_of_clusters

DESIGNS = 4
"""Sets of places of each case, in turn."""
CHUNK = 25
"""Calibrations that a process takes at a time."""


@dataclasses.dataclass(frozen=True)
class Calibrated:
    """What one calibration says."""

    held: dict[str, Counted]
    """By the columns of the table."""
    chi2_per_dof: float | None
    failed: str = ""
    """Why there is nothing to judge."""


def calibrated(name: str, number: int) -> Calibrated:
    """One calibration of a case, judged."""
    case, here = CASES[name], design(name, number % DESIGNS)
    rng = np.random.default_rng([zlib.crc32(name.encode()), number])
    groups = []
    for placed, group in zip(here.placed, here.study.readings, strict=True):
        n = here.true.n
        poses = [readings[group.row - 1, :n] for readings in placed.drawn(case.errors, rng)]
        second: dict[str, Any] = {"p_rad": poses[1]} if len(poses) > 1 else {}
        groups.append(dataclasses.replace(group, q_rad=np.ascontiguousarray(poses[0]), **second))
    start = drawing(case, here.told, rng)
    try:
        result = ulna.calibrate(dataclasses.replace(here.study, arm=start, readings=groups))
    except ulna.UlnaInputError as error:
        return Calibrated({}, None, str(error))
    if not result.fit.converged:
        return Calibrated({}, result.fit.chi2_per_dof, result.fit.termination)
    held = {what: JUDGES[what](case, here, result, rng) for what in case.judged}
    return Calibrated(held, result.fit.chi2_per_dof)


def some(name: str, first: int, count: int) -> list[Calibrated]:
    """Calibrations `first` … of a case."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ulna.InputWarning)
        return [calibrated(name, number) for number in range(first, first + count)]


def row(name: str, found: Sequence[Calibrated]) -> str:
    """Of the table."""
    good = [each for each in found if not each.failed]
    for why in sorted({each.failed for each in found} - {""}):
        print(f"{name}: {sum(each.failed == why for each in found)} of {len(found)}: {why}", file=sys.stderr)
    chi2 = [each.chi2_per_dof for each in good if each.chi2_per_dof is not None]
    cells = [name, f"{np.mean(chi2):.2f}" if chi2 else "–"]
    for what in JUDGES:
        counted = [each.held[what] for each in good if what in each.held]
        cells.append(share_of_clusters([c[0] for c in counted], [c[1] for c in counted]).percent())
    lengths = [each.held[what] for each in good for what in list(JUDGES)[1:] if what in each.held]
    without, all_of_them = sum(c[2] for c in lengths), sum(c[1] + c[2] for c in lengths)
    cells.append(f"{100 * without / all_of_them:.0f}" if without else "")
    cells.append(str(len(found) - len(good)) if len(good) < len(found) else "")
    return f"| {' | '.join(cells)} |"


def table(names: Sequence[str], calibrations: int, jobs: int) -> Iterator[str]:
    """Lines of Markdown, each as soon as it is known."""
    yield f"Holds, % ± standard error, of {calibrations} calibrations of each case:"
    yield ""
    yield "| case | chi² | parameters | lengths of the arm | lengths measured | lengths without u, % | failed |"
    yield "|---|---:|---:|---:|---:|---:|---:|"
    pieces = [(first, min(CHUNK, calibrations - first)) for first in range(0, calibrations, CHUNK)]
    if jobs == 1:
        for name in names:
            yield row(name, [each for piece in pieces for each in some(name, *piece)])
        return
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        waiting = {name: [pool.submit(some, name, *piece) for piece in pieces] for name in names}
        for name in names:
            yield row(name, [each for piece in waiting[name] for each in piece.result()])


def main(arguments: Sequence[str]) -> None:
    """Print the table, and write it where that is asked for."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.coverage simulated", description=(__doc__ or "").splitlines()[0]
    )
    parser.add_argument("--calibrations", type=int, default=300, help="of each case")
    parser.add_argument("--cases", help="names, or shell-style patterns of them, with commas between; all")
    parser.add_argument("--jobs", type=int, default=1, choices=(1, 2), help="processes")
    parser.add_argument("--output", type=Path, help="file for the table, beside the screen")
    given = parser.parse_args(arguments)
    patterns = (given.cases or "*").split(",")
    names = [name for name in CASES if any(fnmatchcase(name, pattern.strip()) for pattern in patterns)]
    if not names:
        sys.exit(f"no case is called {given.cases!r}; there are: {', '.join(CASES)}")
    lines = []
    for line in table(names, given.calibrations, given.jobs):
        print(line, flush=True)
        lines.append(line)
    if given.output is not None:
        given.output.write_text("\n".join(lines) + "\n", encoding="utf-8")


__all__ = ["calibrated", "main", "table"]
