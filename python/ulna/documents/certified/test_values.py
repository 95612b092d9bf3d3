"""Test values as a certificate states them, and what they say of conformity.

A test value is compared with its limit in the manner of ISO 14253-1: pass where |value| + g ≤ limit, fail where
|value| - g > limit, else undecided. What a certificate calls these:

=========================================  =================
|value| ≤ limit - g                        pass
limit - g < |value| ≤ limit                conditionalPass
limit < |value| ≤ limit + g                conditionalFail
|value| > limit + g                        fail
=========================================  =================

The two in the middle are the words of ILAC-G8:09/2019, 4.2.3, for a rule with a guard band that is not binary: neither
conformity nor its contrary is shown, and the word keeps on which side of the limit the value lies. `noPass` is said of
a whole where a value has a limit but could not be decided at all: conformity is not shown.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from ulna.verification.decision import DecisionRule
from ulna.verification.lifted import Lifted
from ulna.verification.result_file import RiskTable

State = Literal["as-found", "as-left"]
Decision = Literal["pass", "fail", "undecided"]
Conformity = Literal["pass", "conditionalPass", "conditionalFail", "fail", "noPass"]

_WORSE: tuple[Conformity, ...] = ("pass", "conditionalPass", "noPass", "conditionalFail", "fail")


@dataclass(frozen=True)
class SingleValue:
    """One measurement of a figure that has many."""

    label: str
    """Which one: artefact, position, orientation, repeat."""
    value: float
    expanded: float | None
    limit: float | None
    decision: Decision | None
    probability: float | None = None
    """That the true value keeps the limit; None where it is not known."""

    @property
    def conformity(self) -> Conformity | None:
        """The word for it; None where nothing can be said."""
        return _word(self.value, self.limit, self.decision)


@dataclass(frozen=True)
class StatedTest:
    """One figure: its worst value, and all of them."""

    name: str
    """As the standard calls it: `P_Size.Sph.1x25:Tact.AArm`."""
    test: str
    """The test that it comes from."""
    formula: str
    """How it is computed, in words."""
    value: float
    unit: str
    """"mm"."""
    expanded: float | None
    """U = k u of the test value; None where it is not known."""
    k: float
    p: float
    limit: float | None
    """What |value| may be at the most; None where nothing is specified."""
    guard: float | None
    """g; None where the rule needs an uncertainty that is not known."""
    decision: Decision | None
    """None where there is no limit, or no guard band is known."""
    budget: Sequence[tuple[str, float]] = ()
    """Contributors to the uncertainty with their standard uncertainties, in `unit`."""
    left_out: Sequence[str] = ()
    """What is not among them."""
    singles: Sequence[SingleValue] = ()
    """In `unit`, with `k` and `p`."""
    risk: RiskTable | None = None
    """Of the decision; None where it is not known."""

    @property
    def conformity(self) -> Conformity | None:
        """The word for it; None where nothing can be said."""
        return _word(self.value, self.limit, self.decision)


@dataclass(frozen=True)
class Temperature:
    """Of the artefacts while they were measured."""

    value_c: float
    u_k: float


@dataclass(frozen=True)
class StatedTests:
    """All figures of the arm in one state."""

    profile: str
    """Name of the list of what is measured."""
    state: State
    manner: str
    """In the manner of which standard."""
    statement: str
    """What the profile says of that."""
    rule: DecisionRule
    version: str
    """Of the Ulna that computed the values."""
    values: Sequence[StatedTest]
    departures: Sequence[str] = ()
    """Where what was measured is not what the profile counts."""
    temperature: Temperature | None = None
    files: Sequence[tuple[str, str]] = ()
    """path and SHA-256 of what the figures come from."""
    lifted: Sequence[Lifted] = ()
    """Figures whose U was below the laboratory's CMC."""
    without: Sequence[str] = ()
    """Short names of figures of which an accredited laboratory states no CMC."""
    accredited: bool = False
    """Whether U has two digits here, and values its place."""
    scanner: str | None = None
    """What the arm carries beside its probe, and was not tested."""

    @property
    def source(self) -> str:
        """The file that the figures stand in."""
        return self.files[0][0] if self.files else "tests in memory"

    @property
    def title(self) -> str:
        """In English: `iso-10360-12, as left`."""
        return f"{self.profile}, {self.state.replace('-', ' ')}"

    @property
    def conformity(self) -> Conformity | None:
        """The worst of all; None where no value has a limit. A value with a limit that was not decided makes `noPass`
        of a pass."""
        words = [value.conformity or "noPass" for value in self.values if value.limit is not None]
        return max(words, key=_WORSE.index) if words else None


def _word(value: float, limit: float | None, decision: Decision | None) -> Conformity | None:
    if limit is None or decision is None:
        return None
    if decision != "undecided":
        return decision
    return "conditionalPass" if abs(value) <= limit else "conditionalFail"
