"""What an acceptance test found: figures with their single values, decided. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ulna.verification.budget import Budget
from ulna.verification.decision import Decided, Limit, Verdict, worst_verdict
from ulna.verification.figures.figure import Definition

FORMAT = "ulna-verification/1"


@dataclass(frozen=True)
class Labels:
    """Which measurement it is; "" where nothing needs to be said."""

    artefact: str = ""
    position: str = ""
    orientation: str = ""
    repeat: str = ""

    def as_dict(self) -> dict[str, str]:
        """Only what is said."""
        said = {
            "artefact": self.artefact,
            "position": self.position,
            "orientation": self.orientation,
            "repeat": self.repeat,
        }
        return {name: label for name, label in said.items() if label}


@dataclass(frozen=True)
class Single:
    """One value of a figure, before any limit."""

    labels: Labels
    value_mm: float
    budget: Budget
    calibrated_mm: float | None = None
    """At the temperature of the test."""
    measured_mm: float | None = None


@dataclass(frozen=True)
class Judged:
    """The same with its limit and what the decision rule says."""

    single: Single
    limit_mm: float | None
    decided: Decided

    def as_dict(self) -> dict[str, Any]:
        """JSON types only."""
        single = self.single
        return {
            **single.labels.as_dict(),
            **({} if single.calibrated_mm is None else {"calibrated": single.calibrated_mm}),
            **({} if single.measured_mm is None else {"measured": single.measured_mm}),
            "value": single.value_mm,
            "limit": self.limit_mm,
            "u": single.budget.u_mm,
            "guard": self.decided.guard_mm,
            "verdict": self.decided.verdict,
        }


@dataclass(frozen=True)
class FigureResult:
    """A figure: its worst value stands for it, all are kept."""

    definition: Definition
    limit: Limit | None
    values: list[Judged]
    k: float
    p: float

    @property
    def worst(self) -> Judged:
        """The value that decides: a fail before all, then what is nearest to its limit or farthest beyond it."""
        order = {"fail": 3, "undecided": 2, "pass": 1, None: 0}

        def rank(judged: Judged) -> tuple[int, float]:
            size = abs(judged.single.value_mm)
            return order[judged.decided.verdict], size if judged.limit_mm is None else size - judged.limit_mm

        return max(self.values, key=rank)

    @property
    def verdict(self) -> Verdict | None:
        """Of the worst."""
        return self.worst.decided.verdict

    def as_dict(self) -> dict[str, Any]:
        """As in verification.json."""
        worst = self.worst
        u_mm = worst.single.budget.u_mm
        return {
            "name": self.definition.name,
            "key": self.definition.key,
            "formula": self.definition.formula,
            "standard": self.definition.standard,
            "unit": self.definition.unit,
            "value": worst.single.value_mm,
            "of": worst.single.labels.as_dict(),
            "limit": worst.limit_mm,
            "limit_formula": None if self.limit is None else self.limit.text,
            "limit_terms": None if self.limit is None else {"a": self.limit.a_mm, "b": self.limit.b},
            "u": u_mm,
            "k": self.k,
            "p": self.p,
            "expanded": None if u_mm is None else self.k * u_mm,
            "guard": worst.decided.guard_mm,
            "verdict": self.verdict,
            "why": worst.decided.why,
            "budget": [
                {"name": each.name, "u": each.u_mm, "formula": each.formula}
                for each in worst.single.budget.contributors
            ],
            "left_out": worst.single.budget.left_out,
            "individual": [each.as_dict() for each in self.values],
        }


@dataclass(frozen=True)
class TestResult:
    """One test of the profile in one state of the arm."""

    __test__ = False  # no test of pytest's

    name: str
    kind: str
    readings: int
    figures: list[FigureResult]
    departures: list[str] = field(default_factory=list)
    """In words: where what was measured is not what the profile counts."""

    @property
    def verdict(self) -> Verdict | None:
        """The worst of its figures."""
        return worst_verdict([figure.verdict for figure in self.figures])

    def as_dict(self) -> dict[str, Any]:
        """As in verification.json."""
        return {
            "name": self.name,
            "kind": self.kind,
            "readings": self.readings,
            "verdict": self.verdict,
            "departures": self.departures,
            "figures": [figure.as_dict() for figure in self.figures],
        }


@dataclass(frozen=True)
class StateResult:
    """All tests in one state of the arm."""

    state: str
    tests: list[TestResult]
    departures: list[str]
    """Tests of the profile that were not measured."""

    @property
    def verdict(self) -> Verdict | None:
        """The worst of its tests."""
        return worst_verdict([test.verdict for test in self.tests])

    @property
    def figures(self) -> dict[str, FigureResult]:
        """By name, in order."""
        return {figure.definition.name: figure for test in self.tests for figure in test.figures}

    def as_dict(self) -> dict[str, Any]:
        """As in verification.json."""
        return {
            "state": self.state,
            "verdict": self.verdict,
            "departures": self.departures,
            "tests": [test.as_dict() for test in self.tests],
        }
