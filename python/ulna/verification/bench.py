"""What a test stands on: artefacts as they were at the test's temperature, the tip, what counts were asked for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

import numpy as np

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import listed, recalled, worded
from ulna.verification.budget import Budget, Surroundings
from ulna.verification.certified import BallTable, CalibratedLengthTable, CertifiedTable
from ulna.verification.departures import COUNTED, COUNTED_EACH, COUNTED_SOME, COUNTS, EACH, WITHIN
from ulna.verification.figures.figure import Definition
from ulna.verification.outcome import Single
from ulna.verification.touches import Touches

Table = TypeVar("Table", bound=CertifiedTable)


@dataclass(frozen=True)
class Found:
    """What one test gives: the single values of its figures, and where it departs from the profile."""

    figures: list[tuple[Definition, list[Single]]]
    departures: list[str] = field(default_factory=list)


@dataclass(frozen=True)
class Bench:
    """Artefacts and surroundings of a verify file."""

    path: Path
    artefacts: Mapping[str, CertifiedTable]
    mm: float
    """In the file's length unit."""
    surroundings: Surroundings
    range_mm: float | None = None

    def ball(self, name: str, test: str) -> Ball:
        """By name, or the only one. Raises UlnaInputError."""
        name, table = self._only(name, test, BallTable, "ball")
        return Ball(name, table, self)

    def length(self, name: str, test: str) -> Length:
        """By name, or the only one. Raises UlnaInputError."""
        name, table = self._only(name, test, CalibratedLengthTable, "length")
        return Length(name, table, self)

    def _only(self, name: str, test: str, kind: type[Table], word: str) -> tuple[str, Table]:
        own = [each for each, table in self.artefacts.items() if isinstance(table, kind)]
        if not name:
            if len(own) != 1:
                raise UlnaInputError(
                    f"{self.path}: test '{test}': which {word} was touched is not said, and there are {len(own)} of "
                    f"kind '{word}'; expected its name in the column 'artefact', or one [artefact.NAME]. Add it."
                )
            name = own[0]
        table = self.artefacts[name]
        if not isinstance(table, kind):
            raise UlnaInputError(
                f"{self.path}: test '{test}': artefact '{name}' is of kind '{table.kind}', expected a {word}. Name "
                "another in the column 'artefact', or correct its kind."
            )
        return name, table


@dataclass(frozen=True)
class Ball:
    """A calibrated ball."""

    name: str
    table: BallTable
    bench: Bench

    @property
    def diameter_mm(self) -> float:
        """At the temperature of the test."""
        return self.bench.surroundings.length_at_mm(self.table.diameter * self.bench.mm, self.table.expansion)

    @property
    def size_budget(self) -> Budget:
        """Of its diameter."""
        mm, table = self.bench.mm, self.table
        return self.bench.surroundings.of_length(
            table.diameter * mm, table.u * mm, table.expansion, table.u_expansion, fixture=False
        )

    @property
    def form_budget(self) -> Budget:
        """Of its form."""
        form = self.table.form
        return self.bench.surroundings.of_form(None if form is None else form * self.bench.mm)


@dataclass(frozen=True)
class Length:
    """A calibrated length."""

    name: str
    table: CalibratedLengthTable
    bench: Bench

    @property
    def calibrated_mm(self) -> float:
        """At the temperature of the test."""
        return self.bench.surroundings.length_at_mm(self.table.length * self.bench.mm, self.table.expansion)

    @property
    def budget(self) -> Budget:
        """Of that."""
        mm, table = self.bench.mm, self.table
        return self.bench.surroundings.of_length(
            table.length * mm, table.u * mm, table.expansion, table.u_expansion, fixture=True
        )


def tip_mm(touches: Touches, path: Path, test: str) -> float:
    """Diameter of the probe's ball. Raises UlnaInputError where it is not known, or where there are several."""
    balls = np.unique(touches.ball_mm[~np.isnan(touches.ball_mm)])
    if np.isnan(touches.ball_mm).any():
        where = f"ball = … in {path}, its diameter" if touches.source == "xyz" else "ball = … in the arm file's probe"
        raise UlnaInputError(
            f"{touches.path}: test '{test}': the diameter of the probe's ball is not known; expected it, because it is "
            f"taken off. State {where}"
            + (" (0: the points are those of the surface)." if touches.source == "xyz" else ".")
        )
    if len(balls) > 1:
        raise UlnaInputError(
            f"{touches.path}: test '{test}': {len(balls)} probes' balls in one measurement ({balls[0]:g} and "
            f"{balls[1]:g} mm); expected one. Measure with one probe."
        )
    return float(balls[0])


def counted(what: str, found: int, expected: int) -> list[str]:
    """A departure in words; [] where the count is that of the profile."""
    if found == expected:
        return []
    return [worded(COUNTED, what=recalled(what, COUNTS), found=found, expected=expected)]


def counted_each(what: str, found: Mapping[str, int], expected: int) -> list[str]:
    """The same of several: those that differ are named together."""
    off = {name: count for name, count in found.items() if count != expected}
    if not off:
        return []
    shown = listed([worded(EACH, count=count, name=name) for name, count in list(off.items())[:4]])
    of = recalled(what, COUNTS)
    if len(off) > 4:
        return [worded(COUNTED_SOME, what=of, found=shown, count=len(off), expected=expected)]
    return [worded(COUNTED_EACH, what=of, found=shown, expected=expected)]


def within_shares(
    what: str, lengths_mm: Mapping[str, float], shares: Sequence[Sequence[float]], range_mm: float
) -> list[str]:
    """Departures of lengths, the shortest first, from the shares of the reach (half the range) that a profile asks."""
    departures = []
    ordered = sorted(lengths_mm.items(), key=lambda each: each[1])
    for (name, length_mm), (least, most) in zip(ordered, shares, strict=False):
        share = length_mm / (0.5 * range_mm)
        if not least <= share <= most:
            departures.append(
                worded(
                    WITHIN,
                    what=recalled(what, COUNTS),
                    name=name,
                    length=f"{length_mm:.1f}",
                    share=f"{100 * share:.0f}",
                    least=f"{100 * least:g}",
                    most=f"{100 * most:g}",
                )
            )
    return departures


def called(**labels: str) -> str:
    """How a message calls a measurement: `artefact ball, position 2`."""
    return ", ".join(f"{name} {label}" for name, label in labels.items() if label) or "the only one"
