"""`ulna-verification/1`: what an acceptance test found, as JSON. Lengths mm.

These models write the file (`ulna.verification.outcome_tables` fills them) and read it, in reports and certificates.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

from pydantic import BaseModel, ConfigDict

from ulna.formats.models import fill
from ulna.formats.numbers import Amount
from ulna.formats.toml import check_format, read_json
from ulna.verification.conformity import Distribution
from ulna.verification.decision import Verdict
from ulna.verification.limits import Rule
from ulna.verification.risk import Sides
from ulna.verification.tables import State

FORMAT: Literal["ulna-verification/1"] = "ulna-verification/1"
WHAT = f'a verification.json (format = "{FORMAT}")'


class Written(BaseModel):
    """A table that Ulna wrote: unknown keys of later versions are kept out of the way."""

    model_config = ConfigDict(strict=True, frozen=True, allow_inf_nan=False, defer_build=True)


class ValueTable(Written):
    """One measured value of a figure."""

    artefact: str | None = None
    position: str | None = None
    orientation: str | None = None
    repeat: str | None = None
    calibrated: float | None = None
    """Length or diameter at the temperature of the test."""
    measured: float | None = None
    value: float
    limit: float | None
    """What the size of the value may be at the most; null where none is stated."""
    u: float | None
    """Standard uncertainty of the value."""
    guard: float | None
    verdict: Verdict | None
    """null where nothing can be said."""
    conformity: float | None = None
    """Probability that the true value keeps the limit; null where there is no limit or no uncertainty."""


class ContributorTable(Written):
    """Part of an uncertainty."""

    name: str
    u: float
    formula: str


class TermsTable(Written):
    """limit = a + L / b; of a constant limit b is null."""

    a: float
    b: float | None


class ProcessTable(Written):
    """What is made, as the verify file states it."""

    mean: float
    deviation: float
    """Standard deviation."""
    distribution: Distribution


class GlobalRiskTable(Written):
    """Shares of all that are made and measured so."""

    process: ProcessTable
    consumer: float
    """Passes and does not conform."""
    producer: float
    """Fails and conforms."""
    withheld: float
    """Does not pass and conforms."""
    undecided: float


class RiskTable(Written):
    """What the decision on a figure's worst value risks, after JCGM 106:2012."""

    sides: Sides
    """Whether the limit is one of the size (two-sided) or, of what cannot be negative, from above alone."""
    conformity: float
    """Probability that the true value keeps the limit."""
    specific: float | None
    """Risk that this verdict is wrong; null where nothing was decided."""
    consumer_at_most: float | None
    """Specific risk of the consumer of a value that only just passes; null where none can."""
    producer_at_most: float
    """Specific risk of the producer of a value that only just fails."""
    of_all: GlobalRiskTable | None
    """Global risks; null where it was not stated what is made."""


class FigureTable(Written):
    """A figure: what stands here is its worst value."""

    name: str
    """As the standard calls it."""
    key: str
    """Its short name."""
    formula: str
    standard: str
    unit: Literal["mm"]
    value: float
    of: dict[str, str]
    """Labels of the measurement with that value: artefact, position, orientation, repeat."""
    limit: float | None
    limit_formula: str | None
    limit_terms: TermsTable | None
    u: float | None
    k: float
    p: float
    expanded: float | None
    """U = k u"""
    guard: float | None
    verdict: Verdict | None
    why: str | None
    """Why there is no verdict."""
    risk: RiskTable | None = None
    """null where there is no limit or no uncertainty."""
    budget: list[ContributorTable]
    left_out: list[str]
    """What the uncertainty does not hold."""
    individual: list[ValueTable]


class TestedTable(Written):
    """One test."""

    name: str
    kind: str
    readings: int
    verdict: Verdict | None
    departures: list[str]
    """In words: where what was measured is not what the profile counts."""
    figures: list[FigureTable]


class StateTable(Written):
    """All tests in one state of the arm."""

    state: State
    verdict: Verdict | None
    departures: list[str]
    """Tests that were not measured."""
    tests: list[TestedTable]


class UsedProfile(Written):
    """Which profile."""

    name: str
    standard: str
    statement: str
    path: str
    sha256: str


class UsedDecision(Written):
    """Which decision rule."""

    rule: Rule
    text: str
    k: float
    p: float
    r: float | None = None
    """The guard band as a part of U: w = r U."""


class TemperatureTable(Written):
    """Of the artefacts."""

    value: float
    """°C"""
    u: Amount
    """Standard uncertainty, K."""


class StandingTable(Written):
    """How still artefacts stood."""

    u: Amount
    """Standard uncertainty."""


class EnvironmentTable(Written):
    """What holds for all tests; null where it was not stated."""

    temperature: TemperatureTable | None
    fixture: StandingTable | None
    range: float | None
    """Diameter of the measuring range."""


class SourceTable(Written):
    """A file that figures come from."""

    path: str
    sha256: str


class TouchesTable(Written):
    """A file of touches."""

    state: State
    path: str
    sha256: str
    rows: int
    points: Literal["encoders", "xyz"]
    """What the rows are: encoder readings, or coordinates."""
    arm_sha256: str | None = None
    """Of the file of the arm that made points of encoder readings."""


class ProvenanceTable(Written):
    """From what and with what figures were made."""

    program: str
    version: str
    plan: SourceTable
    """The verify file."""
    arms: list[SourceTable]
    """Arm files that made points of encoder readings; that of the command first."""
    files: list[TouchesTable]
    warnings: list[str]
    time: str
    """ISO 8601"""


class VerificationFile(Written):
    """What an acceptance test found: `ulna-verification/1`."""

    format: Literal["ulna-verification/1"]
    arm: str
    verdict: Verdict | None
    """The worst of all states."""
    profile: UsedProfile
    decision: UsedDecision
    scanner: str | None = None
    """What the arm carries beside its probe; it was not tested."""
    environment: EnvironmentTable
    artefacts: list[dict[str, Any]]
    """name, then the keys of a verify file's table of it."""
    states: list[StateTable]
    """as-found before as-left."""
    provenance: ProvenanceTable


def load_verification(path: Path) -> tuple[VerificationFile, str]:
    """A verification.json and its SHA-256. Raises UlnaInputError."""
    document, digest = read_json(path, WHAT)
    check_format(document, path, "ulna-verification")
    return fill(VerificationFile, document, path), digest
