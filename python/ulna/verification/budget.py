"""The uncertainty of a test value, not of the arm: artefact, expansion, temperature, fixture. Lengths mm.

The contributors are those that ISO 23165 names, as secondary sources describe it; they are independent, and their
squares add up.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

REFERENCE_C = 20.0
_IN_COMMON = "temperature"
"""Of the contributors to lengths: the same for all artefacts of a test."""
_OF_LENGTHS = ("calibration", _IN_COMMON, "expansion")


@dataclass(frozen=True)
class Contributor:
    """One of them."""

    name: str
    u_mm: float
    formula: str


@dataclass(frozen=True)
class Budget:
    """All of them, and what is not among them."""

    contributors: list[Contributor] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)

    @property
    def u_mm(self) -> float | None:
        """Standard uncertainty; None where nothing is stated."""
        if not self.contributors:
            return None
        return math.sqrt(sum(each.u_mm**2 for each in self.contributors))

    def and_(self, other: Budget) -> Budget:
        """Both; what is left out is said once."""
        return Budget([*self.contributors, *other.contributors], list(dict.fromkeys([*self.left_out, *other.left_out])))

    def times(self, factor: float, why: str) -> Budget:
        """Of a value that changes by so much when a length does."""
        scaled = [
            Contributor(each.name, factor * each.u_mm, f"{factor:g} · ({each.formula}), {why}")
            for each in self.contributors
        ]
        return Budget(scaled, self.left_out)


@dataclass(frozen=True)
class Share:
    """How a figure of several artefacts changes with one of them."""

    artefact: str
    per_mm: float
    """The figure's change for each mm that this artefact is longer than its certificate says."""
    budget: Budget


def of_several(shares: Sequence[Share]) -> Budget:
    """What artefacts do to one figure, to first order: each has a certificate and an expansion of its own, all have the
    same temperature. What is not of an artefact's length does not count here."""
    found = []
    for name in _OF_LENGTHS:
        own = [(share, each.u_mm) for share in shares for each in share.budget.contributors if each.name == name]
        if not own:
            continue
        moved = [share.per_mm * u_mm for share, u_mm in own]
        u_mm = abs(math.fsum(moved)) if name == _IN_COMMON else math.hypot(*moved)
        terms = " + ".join(f"{share.per_mm:.3g} · {share.artefact}" for share, _ in own)
        how = "as one, its sign kept" if name == _IN_COMMON else "each by itself"
        found.append(Contributor(name, u_mm, f"u({name}) of {terms}, {how}"))
    left_out = [said for share in shares for said in share.budget.left_out]
    return Budget(found, list(dict.fromkeys(left_out)))


@dataclass(frozen=True)
class Surroundings:
    """What holds for all artefacts of a test."""

    temperature_c: float | None = None
    u_temperature_k: float | None = None
    fixture_mm: float | None = None

    def length_at_mm(self, length_mm: float, expansion: float | None) -> float:
        """A calibrated length at the temperature that it had; as calibrated where nothing is stated."""
        if self.temperature_c is None or expansion is None:
            return length_mm
        return length_mm * (1.0 + expansion * (self.temperature_c - REFERENCE_C))

    def of_length(
        self, length_mm: float, u_mm: float, expansion: float | None, u_expansion: float | None, fixture: bool
    ) -> Budget:
        """Of a calibrated length or diameter; fixture: whether the artefact's standing still counts."""
        found = [Contributor("calibration", u_mm, "u of the artefact's certificate")]
        left_out = []
        if self.temperature_c is None:
            left_out.append("the temperature of the artefact: not stated")
        if expansion is None:
            left_out.append("the expansion of the artefact: not stated")
        if self.temperature_c is not None and expansion is not None:
            warm_k = abs(self.temperature_c - REFERENCE_C)
            found.append(
                Contributor("temperature", length_mm * expansion * (self.u_temperature_k or 0.0), "L · α · u(T)")
            )
            if u_expansion is None:
                left_out.append("the uncertainty of the artefact's expansion: not stated")
            else:
                found.append(Contributor("expansion", length_mm * warm_k * u_expansion, "L · |T - 20 °C| · u(α)"))
        if fixture:
            standing = self.standing()
            found += standing.contributors
            left_out += standing.left_out
        return Budget(found, left_out)

    def of_form(self, form_mm: float | None) -> Budget:
        """Of a ball's form."""
        if form_mm is None:
            return Budget([], ["the form of the ball: not stated"])
        return Budget([Contributor("form of the ball", 0.5 * form_mm, "half of the certified form deviation")])

    def standing(self) -> Budget:
        """Of the place of something that ought to stand still."""
        if self.fixture_mm is None:
            return Budget([], ["how still the artefact stands (fixture): not stated"])
        return Budget([Contributor("fixture", self.fixture_mm, "u of the fixture, as stated")])
