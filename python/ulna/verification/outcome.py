"""What an acceptance test found: figures with their single values, decided. Lengths mm."""

from __future__ import annotations

from dataclasses import dataclass, field

from ulna.verification.budget import Budget
from ulna.verification.decision import Decided, Limit, Verdict, severity, worst_verdict
from ulna.verification.figures.figure import Definition
from ulna.verification.risk import Decision, Process, Risk, risk_of
from ulna.verification.tables import State


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
    conformity: float | None
    """Probability that the true value keeps the limit; None where there is no limit or no uncertainty."""


@dataclass(frozen=True)
class FigureResult:
    """A figure: its worst value stands for it, all are kept."""

    definition: Definition
    limit: Limit | None
    values: list[Judged]
    k: float
    p: float
    process: Process | None = None
    """What is made, where it was stated."""

    @property
    def worst(self) -> Judged:
        """The value that decides: a fail before all, then what is nearest to its limit or farthest beyond it."""

        def rank(judged: Judged) -> tuple[int, float]:
            return severity(judged.decided.verdict, judged.single.value_mm, judged.limit_mm)

        return max(self.values, key=rank)

    @property
    def verdict(self) -> Verdict | None:
        """Of the worst."""
        return self.worst.decided.verdict

    @property
    def risk(self) -> Risk | None:
        """Of the decision on the worst value; None where there is no limit or no uncertainty."""
        worst = self.worst
        u_mm, limit_mm, guard_mm = worst.single.budget.u_mm, worst.limit_mm, worst.decided.guard_mm
        if u_mm is None or limit_mm is None or guard_mm is None:
            return None
        decision = Decision(worst.single.value_mm, u_mm, limit_mm, guard_mm, worst.decided.verdict)
        return risk_of(decision, self.definition.signed, self.process)


@dataclass(frozen=True)
class TestResult:
    """One test of the profile in one state of the arm."""

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


@dataclass(frozen=True)
class StateResult:
    """All tests in one state of the arm."""

    state: State
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
