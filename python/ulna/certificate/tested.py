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

Conformity = Literal["pass", "conditionalPass", "conditionalFail", "fail", "noPass"]

_WORSE: tuple[Conformity, ...] = ("pass", "conditionalPass", "noPass", "conditionalFail", "fail")


@dataclass(frozen=True)
class StatedTest:
    """One test value."""

    name: str
    """As the standard calls it: `P_Size.Sph.1x25:Tact.AArm`."""
    formula: str
    """How it is computed, in words."""
    value: float
    unit: str
    """"mm"."""
    expanded: float | None
    """U = k u of the test value; None where it is not known."""
    k: float | None
    p: float | None
    limit: float | None
    """What |value| may be at the most; None where nothing is specified."""
    guard: float | None
    """g; None where the rule needs an uncertainty that is not known."""
    decision: Literal["pass", "fail", "undecided"] | None
    """None where there is no limit, or no guard band is known."""

    @property
    def conformity(self) -> Conformity | None:
        """The word for it; None where nothing can be said."""
        if self.limit is None or self.decision is None:
            return None
        if self.decision != "undecided":
            return self.decision
        return "conditionalPass" if abs(self.value) <= self.limit else "conditionalFail"


@dataclass(frozen=True)
class StatedTests:
    """All values of one test in one state of the arm."""

    title: str
    """What was tested and how."""
    manner: str
    """In the manner of which standard."""
    rule: str
    """The decision rule in words."""
    version: str
    """Of the Ulna that computed the values."""
    values: Sequence[StatedTest]

    @property
    def conformity(self) -> Conformity | None:
        """The worst of all; None where no value has a limit. A value with a limit that was not decided makes `noPass`
        of a pass."""
        words = [value.conformity or "noPass" for value in self.values if value.limit is not None]
        return max(words, key=_WORSE.index) if words else None
