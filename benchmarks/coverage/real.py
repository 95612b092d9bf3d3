"""``python -m benchmarks.coverage real``: stated 95 % intervals against real readings that the fit has not seen.

Points are judged by what of their errors is the arm's: after the rigid motion that fits the tracker best, or about the
centre of their socket, with the covariance of just that. Lengths are those between two of the points, none of which is
in two lengths. All of it is what `ulna.measure` states.
"""

import argparse
import math
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tests.oracle.observed import rigid_fit, turned

import ulna
from benchmarks.coverage.cases import RECIPE
from benchmarks.coverage.judging import factor, freedom
from benchmarks.coverage.real_sets import SETS, Fold, stated_mm
from benchmarks.coverage.statistics import inside, squared_radius, wilson

Array = NDArray[np.float64]

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT.parent / "shared" / "data"
SHORTEST_MM = 100.0
"""Of lengths between tracked points."""
TOGETHER = 300
"""Tracked points whose rigid motion is taken off together: their covariance is a matrix of 900 × 900."""


def _harmonics(most: int, u_rad: float) -> dict[str, Any]:
    prior = dict(RECIPE) | {"joint.*.beta": 0.01, "joint.*.[cs][0-9]*": u_rad}
    return {"extras": ["encoder-harmonics"], "harmonics": list(range(1, most + 1)), "prior": prior}


FITS: dict[str, dict[str, Any]] = {
    "geometry": {},
    "harmonics 1-4": _harmonics(4, 5e-4),
    "harmonics 1-40": _harmonics(40, 1e-4),
    "auto": {"extras": "auto"},
}
"""By name; priors are standard uncertainties, of those patterns that an arm has parameters for."""


@dataclass
class Judged:
    """What a row of the table is made of, of all of its folds."""

    error_mm: list[Array] = field(default_factory=list)
    """(N, 3) of points."""
    covariance_mm2: list[Array] = field(default_factory=list)
    """(N, 3, 3), NaN where none is stated."""
    point_inside: list[NDArray[np.bool_]] = field(default_factory=list)
    """(N,) of points with a covariance."""
    length_error_mm: list[Array] = field(default_factory=list)
    length_u_mm: list[Array] = field(default_factory=list)
    length_inside: list[NDArray[np.bool_]] = field(default_factory=list)
    poor: int = 0
    """Fits that did not end well."""

    def add_points(self, error_mm: Array, covariance_mm2: Array, squared: float) -> None:
        """squared: radius of the region."""
        known = np.isfinite(covariance_mm2).all(axis=(1, 2))
        self.error_mm.append(error_mm)
        self.covariance_mm2.append(covariance_mm2)
        self.point_inside.append(inside(error_mm[known], covariance_mm2[known], squared))

    def add_lengths(self, error_mm: Array, u_mm: Array, k: float) -> None:
        """u_mm (N,), NaN where none is stated."""
        known = np.isfinite(u_mm)
        self.length_error_mm.append(error_mm)
        self.length_u_mm.append(u_mm)
        self.length_inside.append(np.abs(error_mm[known]) <= k * u_mm[known])

    def cells(self) -> list[str]:
        """Of the table."""
        points, covariance = np.concatenate(self.error_mm), np.concatenate(self.covariance_mm2)
        lengths, u_mm = np.concatenate(self.length_error_mm), np.concatenate(self.length_u_mm)
        of_points = np.sqrt(np.trace(covariance, axis1=1, axis2=2))
        cells = []
        for error_mm, u, hit in (
            (np.linalg.norm(points, axis=1), of_points, np.concatenate(self.point_inside)),
            (np.abs(lengths), u_mm, np.concatenate(self.length_inside)),
        ):
            low, high = wilson(int(hit.sum()), len(hit))
            known = u[np.isfinite(u)]
            cells += [str(len(error_mm)), f"{_rms(error_mm):.3f}", f"{_rms(known):.3f}" if len(known) else "–"]
            cells.append(f"**{100 * hit.mean():.1f}** ({100 * low:.1f}–{100 * high:.1f})" if len(hit) else "–")
            cells[-1] += f", {len(u) - len(known)} without" if len(known) < len(u) else ""
        return cells


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))


def measured(result: ulna.Result, group: ulna.Readings) -> ulna.Measured:
    """The points of readings."""
    names = list(result.arm.probes)
    probes = [names[k] for k in group.probe.tolist()]
    found = ulna.measure(result, group.q_rad, probes, temperature_c=group.temperature_c, approach=group.approach)
    assert isinstance(found, ulna.Measured)
    return found


def left_over(found: ulna.Measured, rows: NDArray[np.int64], error_mm: Array, taken: Array) -> tuple[Array, Array]:
    """(k, 3) errors of points and (k, 3, 3) their covariances, without what lies in the columns of `taken` (3k, m)."""
    basis, _ = np.linalg.qr(taken)
    flat = error_mm.reshape(-1)
    rest = (flat - basis @ (basis.T @ flat)).reshape(-1, 3)
    own = found.covariance_mm2
    together = found.joint_covariance_mm2(rows)
    gaps = np.isnan(own[rows]).any(axis=(1, 2)) if own is not None else np.ones(len(rows), bool)
    together[np.repeat(gaps, 3)] = 0.0
    together[:, np.repeat(gaps, 3)] = 0.0
    half = together - basis @ (basis.T @ together)
    whole = half - (half @ basis) @ basis.T
    k = np.arange(len(rows))
    blocks = whole.reshape(len(rows), 3, len(rows), 3)[k, :, k].copy()
    blocks[gaps] = np.nan
    return rest, blocks


def by_tracker(result: ulna.Result, group: ulna.Readings, into: Judged) -> None:
    """Points whose coordinates a tracker gives, in a frame of its own."""
    found, known_mm = measured(result, group), stated_mm(group)
    squared, count = squared_radius(freedom(result)), len(group)
    pieces = max(1, round(count / TOGETHER))
    for piece in range(pieces):
        rows = np.arange(piece, count, pieces)
        pose = rigid_fit(known_mm[rows], found.points_mm[rows])
        over_mm = turned(np.repeat(pose[None, 3:], len(rows), axis=0), known_mm[rows]) + pose[:3]
        about = over_mm - over_mm.mean(axis=0)
        motion = np.zeros((len(rows), 3, 6))
        motion[:, :, :3] = np.eye(3)
        motion[:, :, 3:] = np.stack([np.cross(axis, about) for axis in np.eye(3)], axis=2) / 1000.0
        rest = left_over(found, rows, found.points_mm[rows] - over_mm, motion.reshape(-1, 6))
        into.add_points(*rest, squared)
    order = np.random.default_rng(count).permutation(count)
    first, second = order[: count // 2], order[count // 2 : 2 * (count // 2)]
    true_mm = np.linalg.norm(known_mm[second] - known_mm[first], axis=1)
    long = true_mm > SHORTEST_MM
    _add_lengths(result, found, first[long], second[long], true_mm[long], into)


def by_sockets(result: ulna.Result, group: ulna.Readings, into: Judged) -> None:
    """Touches of two sockets a known distance apart, one standing of both."""
    found, squared = measured(result, group), squared_radius(freedom(result))
    ends = [np.flatnonzero(group.feature == k) for k in range(2)]
    for rows in ends:
        about_mm = found.points_mm[rows] - found.points_mm[rows].mean(axis=0)
        shift = np.tile(np.eye(3), (len(rows), 1))
        into.add_points(*left_over(found, rows, about_mm, shift), squared)
    rng, count = np.random.default_rng(len(group)), min(map(len, ends))
    first, second = (rng.permutation(rows)[:count] for rows in ends)
    _add_lengths(result, found, first, second, np.full(count, group.artefact.length_mm or math.nan), into)


def _add_lengths(
    result: ulna.Result,
    found: ulna.Measured,
    first: NDArray[np.int64],
    second: NDArray[np.int64],
    true_mm: Array,
    into: Judged,
) -> None:
    value_mm, u_mm = found.lengths(first, second)
    assert u_mm is not None
    into.add_lengths(value_mm - true_mm, u_mm, factor(result))


JUDGES: dict[str, Callable[[ulna.Result, ulna.Readings, Judged], None]] = {"points": by_tracker, "bar": by_sockets}
"""By the kind of artefact."""


def options(arm: ulna.Arm, fit: Mapping[str, Any]) -> dict[str, Any]:
    """Fields of `ulna.FitOptions`, with the priors of those patterns that match something: effects always do."""
    prior = {
        pattern: ulna.Prior(u)
        for pattern, u in fit.get("prior", {}).items()
        if "[" in pattern or any(fnmatchcase(name, pattern) for name in arm.parameter_names)
    }
    return dict(fit) | {"prior": prior, "judge_extras": False}


def judged(folds: Sequence[Fold], fit: Mapping[str, Any]) -> dict[str, Judged]:
    """By the rows of the table. Raises UlnaInputError for a fit that cannot be asked."""
    rows: dict[str, Judged] = {}
    for fold in folds:
        result = ulna.calibrate(fold.fitted, **options(fold.fitted.arm, fit))
        for row, group in fold.held_out.items():
            into = rows.setdefault(row, Judged())
            into.poor += not result.fit.converged
            JUDGES[group.artefact.kind](result, group, into)
    return rows


def table(data: Path, sets: Sequence[str], fits: Sequence[str]) -> Iterator[str]:
    """Lines of Markdown, each as soon as it is known."""
    yield "| held out | fitted | points | rms error / mm | stated u / mm | holds, % | lengths | rms error / mm |" + (
        " stated u / mm | holds, % | poor fits |"
    )
    yield "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|"
    for name in sets:
        folder, folds_of = SETS[name]
        if not (data / folder).is_dir():
            yield f"| {name} | skipped: there is no folder {folder} in that of the data |" + " |" * 9
            continue
        folds = folds_of(data)
        for fit in fits:
            try:
                found = judged(folds, FITS[fit])
            except ulna.UlnaInputError as error:
                yield f"| {name} | {fit}: skipped: {error} |" + " |" * 9
                continue
            for row, each in found.items():
                yield f"| {row} | {fit} | {' | '.join(each.cells())} | {each.poor or ''} |"


def main(arguments: Sequence[str]) -> None:
    """Print the table, and write it where that is asked for."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.coverage real", description=(__doc__ or "").splitlines()[0]
    )
    parser.add_argument("--data", type=Path, default=DATA, help="folder with ipa_ur10 and mukca (../shared/data)")
    parser.add_argument("--sets", default="*", help=f"with commas: {', '.join(SETS)}")
    parser.add_argument("--fits", default="*", help=f"with commas: {', '.join(FITS)}")
    parser.add_argument("--output", type=Path, help="file for the table, beside the screen")
    given = parser.parse_args(arguments)
    sets, fits = (
        [name for name in names if any(fnmatchcase(name, pattern.strip()) for pattern in said.split(","))]
        for names, said in ((SETS, given.sets), (FITS, given.fits))
    )
    if not (sets and fits):
        sys.exit(f"nothing to judge; sets: {', '.join(SETS)}; fits: {', '.join(FITS)}")
    lines = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ulna.InputWarning)
        for line in table(given.data, sets, fits):
            print(line, flush=True)
            lines.append(line)
    if given.output is not None:
        given.output.write_text("\n".join(lines) + "\n", encoding="utf-8")
