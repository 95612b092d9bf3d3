"""What has moved between calibrations of one arm: what it does to lengths, whether both uncertainties explain it, and
which parameters it is. Lengths mm."""

from __future__ import annotations

import os
from dataclasses import asdict, dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from ulna.arm.directions import unit_of
from ulna.arm.given import ArmLike
from ulna.comparison.determined import Determined, determined
from ulna.comparison.extreme import p_of_largest
from ulna.comparison.pair import Pair, calibrated, pair
from ulna.comparison.poses import Lengths, lengths
from ulna.ground.arrays import F64, I64, Bool
from ulna.ground.errors import UlnaInputError
from ulna.ground.quantiles import normal, student
from ulna.ground.version import VERSION

FORMAT = "ulna-comparison/1"
LENGTHS = 2000
"""Compared, all over the volume."""
BANDS = 4
"""Of lengths, of which figures are told."""
MOST = 6
"""Calibrations in one comparison."""
_EXACT = 1e-12
"""Of a length, or of what a drawing leaves open: a smaller u is that of something that was held."""
SURE = 0.05
"""A difference that chance makes less often is one."""


@dataclass(frozen=True)
class Band:
    """Lengths of a like size."""

    least_mm: float
    most_mm: float
    count: int
    rms_mm: float
    """Of the differences, later less earlier."""
    largest_mm: float
    """Of the differences, with its sign."""
    u_mm: float
    """Standard uncertainty of that difference."""
    expanded_mm: float
    """U = k u for 95 %."""
    at_mm: list[float]
    """Its middle, in the earlier base frame."""
    length_mm: float
    en: float
    """The most that |difference| / U is in this band: E_n as of ISO/IEC 17043; of some lengths in twenty it is above 1
    by chance."""


@dataclass(frozen=True)
class Moved:
    """A parameter, without what nobody determined and without moves of the base."""

    name: str
    unit: str
    delta: float
    u: float
    """Standard uncertainty."""


@dataclass(frozen=True)
class Changes:
    """The lengths that both determined."""

    middle_mm: F64
    """(K, 3) of each, earlier base frame."""
    change_mm: F64
    """(K,) later less earlier."""


@dataclass(frozen=True)
class Compared:
    """Two calibrations."""

    before: str
    after: str
    probe: str
    shared_u: float
    chi2: float
    rank: int
    """Combinations of parameters that both determined, of which χ² is."""
    degrees_of_freedom: float | None
    """Of the noise, where a calibration estimated it; None: both knew it."""
    p_value: float
    """How often the uncertainties alone make as large a χ²."""
    p_of_largest: float
    """How often they make as large a change of any length, by its u."""
    not_determined: int
    bands: list[Band]
    parameters: list[Moved]
    """Those of which a difference is known, the surest difference first."""
    k: float
    """U = k u for 95 %."""
    changes: Changes = field(compare=False, repr=False)
    """For pictures; the machine form has the bands."""
    between: list[str] = field(default_factory=list)
    """What was done to the arm between them, where a record knows it: then the earlier is as found, the later as
    left."""

    @property
    def moved(self) -> bool:
        """By more than both uncertainties explain."""
        return 2.0 * min(self.p_value, self.p_of_largest) < SURE  # two looks, each at half

    @property
    def largest(self) -> Band | None:
        """With the largest difference of all lengths; None where no length is determined by both."""
        return max(self.bands, key=lambda band: abs(band.largest_mm), default=None)


@dataclass(frozen=True)
class Comparison:
    """Calibrations one after the other."""

    steps: list[Compared]

    def as_dict(self) -> dict[str, Any]:
        """The machine form."""
        return {
            "format": FORMAT,
            "steps": [_numbers(step) | {"moved": step.moved} for step in self.steps],
            "provenance": {"program": "ulna", "version": VERSION},
        }


def compare(*calibrations: ArmLike, probe: str | None = None, shared_u: float = 0.0, seed: int = 0) -> Comparison:
    """Two to six calibrations of one arm, results or their paths, the earliest first; each is compared with the next.

    probe: with which lengths are compared; None: the first that both have. shared_u: relative standard uncertainty of
    the length of the artefact on which both rest (u / length), as their studies state it; 0 where they had others, or
    state none.

    Raises UlnaInputError for what is no calibration, has no uncertainty, is another arm, or cannot share such a u.
    """
    if not 2 <= len(calibrations) <= MOST:
        raise UlnaInputError(
            f"compare: got {len(calibrations)} calibration{'s' * (len(calibrations) != 1)}; expected 2 to {MOST}, the "
            "earliest first. Name them."
        )
    if not 0.0 <= shared_u < 0.01:
        raise UlnaInputError(
            f"compare: shared u {shared_u:g}; expected u of the artefact's length over its length, such as 2e-6. "
            "Correct it."
        )
    labels = [_label(given, number) for number, given in enumerate(calibrations, start=1)]
    known = [calibrated(given, label) for given, label in zip(calibrations, labels, strict=True)]
    pairs = [pair(one, other, probe, shared_u) for one, other in pairwise(known)]
    return Comparison([_compared(each, lengths(each, LENGTHS, seed)) for each in pairs])


def _numbers(step: Compared) -> dict[str, Any]:
    """All but what pictures are made of."""
    return {name: value for name, value in asdict(step).items() if name != "changes"}


def _label(given: ArmLike, number: int) -> str:
    return str(given) if isinstance(given, str | os.PathLike) else f"calibration {number}"


def _compared(both: Pair, found: Lengths) -> Compared:
    what = determined(both, found)
    freedom = both.degrees_of_freedom
    k = normal(0.975) if np.isinf(freedom) else float(np.ravel(student(freedom, 0.975))[0])
    by_kept = found.by_parameter @ what.kept
    u = what.u_of(by_kept)
    rows = np.flatnonzero(_known(both, found) & (u > _EXACT * found.before_mm))
    beyond = 1.0
    if len(rows):
        largest = float((np.abs(found.change_mm[rows]) / u[rows]).max())
        beyond = p_of_largest(by_kept[rows] / u[rows, None], what.covariance, largest, freedom)
    return Compared(
        both.before.label,
        both.after.label,
        both.probe,
        both.shared_u,
        what.chi2,
        what.rank,
        freedom if np.isfinite(freedom) else None,
        what.p_value,
        beyond,
        what.lost,
        _bands(found, k * u, u, rows),
        _moved(both, what),
        k,
        Changes(found.middle_mm[rows], found.change_mm[rows]),
    )


def _known(both: Pair, found: Lengths) -> Bool:
    """(K,) lengths that neither calibration left open."""
    open_mm = np.abs(found.by_parameter @ (both.lost * both.scale).T).max(axis=1, initial=0.0)
    return np.asarray(open_mm <= max(both.before.noise.moves_mm, both.after.noise.moves_mm))


def _bands(found: Lengths, expanded: F64, u: F64, sure: I64) -> list[Band]:
    edges = np.linspace(0.0, float(found.before_mm.max()), BANDS + 1)
    bands = []
    for low, high in pairwise(edges.tolist()):
        rows = sure[(found.before_mm[sure] > low) & (found.before_mm[sure] <= high)]
        if len(rows):
            bands.append(_band(low, high, rows, expanded, u, found))
    return bands


def _band(low: float, high: float, rows: I64, expanded: F64, u: F64, found: Lengths) -> Band:
    change = found.change_mm
    at = rows[int(np.abs(change[rows]).argmax())]
    return Band(
        low,
        high,
        len(rows),
        float(np.sqrt((change[rows] ** 2).mean())),
        float(change[at]),
        float(u[at]),
        float(expanded[at]),
        found.middle_mm[at].tolist(),
        float(found.before_mm[at]),
        float((np.abs(change[rows]) / expanded[rows]).max()),
    )


def _moved(both: Pair, what: Determined) -> list[Moved]:
    rows = zip(both.names, what.delta.tolist(), what.u.tolist(), (_EXACT * both.scale).tolist(), strict=True)
    known = [Moved(name, unit_of(name), delta, u) for name, delta, u, least in rows if u > least]
    return sorted(known, key=lambda each: -abs(each.delta) / each.u)
