"""Artefacts of a verify file, as their certificates state them."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, Literal

from ulna.formats.models import OneOf, Strict
from ulna.formats.numbers import Amount, Positive

Ends = Literal["seats", "balls", "faces", "opposite-faces"]


OFF_MM = 5.0
_OFF_OF_ENDS_MM: dict[Ends, float] = {"seats": OFF_MM, "balls": 100.0, "faces": 50.0, "opposite-faces": 50.0}
"""A seat is touched in one place; a ball all around, a face anywhere on it."""


class CertifiedTable(Strict):
    """What all of them have."""

    LENGTHS: ClassVar[tuple[str, ...]]
    """Its keys that hold lengths."""

    kind: str

    @property
    def off_mm(self) -> float:
        """By how much two touches of it may be nearer or farther than its size says before it is asked whether the
        right place was touched: more than any arm errs that is worth a test."""
        return OFF_MM

    def in_mm(self, mm: float) -> dict[str, Any]:
        """Keys that are given, lengths in mm; mm: in the file's length unit."""
        given = self.model_dump(exclude_none=True)
        return {key: value * mm if key in self.LENGTHS else value for key, value in given.items()}


class BallTable(CertifiedTable):
    """A calibrated ball, or a hollow."""

    LENGTHS: ClassVar[tuple[str, ...]] = ("diameter", "u", "form")

    kind: Literal["ball"]
    diameter: Positive
    u: Amount
    """Standard uncertainty of the diameter, from its certificate."""
    form: Amount | None = None
    """Its deviation from a ball, peak to valley."""
    inside: bool = False
    """A hollow, touched from within."""
    expansion: Amount | None = None
    """1/K"""
    u_expansion: Amount | None = None
    """Standard uncertainty of that, 1/K."""


class CalibratedLengthTable(CertifiedTable):
    """A calibrated length between two ends, A and B."""

    LENGTHS: ClassVar[tuple[str, ...]] = ("length", "u")

    kind: Literal["length"]
    length: Positive
    u: Amount
    """Standard uncertainty of the length, from its certificate."""
    ends: Ends
    """seats: cones or sockets for the probe's ball; balls, touched all around; faces, touched from the same direction;
    opposite-faces, as of a gauge block."""
    expansion: Amount | None = None
    """1/K"""
    u_expansion: Amount | None = None
    """Standard uncertainty of that, 1/K."""

    @property
    def off_mm(self) -> float:
        return _OFF_OF_ENDS_MM[self.ends]


ARTEFACTS: dict[str, type[CertifiedTable]] = {"ball": BallTable, "length": CalibratedLengthTable}
"""By kind."""

AnyArtefact = Annotated[CertifiedTable, OneOf(ARTEFACTS)]
