"""Rules about figures in a row, which single limits do not see.

Western Electric, Statistical Quality Control Handbook (1956), 23-28; Nelson, Journal of Quality Technology 16 (1984)
237, with 8 on one side as Western Electric has it. Each rule finds something by chance: one of 370 figures is beyond
3 s, one in 92 is found by the first four rules together (Champ and Woodall, Technometrics 29 (1987) 393).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ulna.control.basis import Basis, basis, figures
from ulna.ground.arrays import F64, Bool
from ulna.ground.errors import UlnaInputError, nearest
from ulna.ground.worded import worded


@dataclass(frozen=True)
class Rule:
    """One of them."""

    name: str
    words: str
    length: int
    """Figures that it looks at."""
    found: Callable[[F64], Bool]
    """(N, length) figures in s from the centre, each row of some that follow each other → (N,) whether it is so."""
    upward: Callable[[F64], bool] = lambda z: z.mean() > 0.0
    """(M,) figures of a run → whether it is above the centre, or rising."""


def _sides(some: int, beyond: float) -> Callable[[F64], Bool]:
    """At least `some` of a row beyond so many s, all on the same side."""
    return lambda z: np.asarray(((z > beyond).sum(axis=1) >= some) | ((z < -beyond).sum(axis=1) >= some))


def _rising(z: F64) -> Bool:
    step = np.diff(z, axis=1)
    return np.asarray((step > 0.0).all(axis=1) | (step < 0.0).all(axis=1))


def _alternating(z: F64) -> Bool:
    step = np.sign(np.diff(z, axis=1))
    return np.asarray((step[:, 1:] * step[:, :-1] < 0.0).all(axis=1))


RULES = {
    rule.name: rule
    for rule in (
        Rule("beyond-3s", worded("one beyond 3 s"), 1, _sides(1, 3.0)),
        Rule("two-of-three", worded("two of three beyond 2 s, on one side"), 3, _sides(2, 2.0)),
        Rule("four-of-five", worded("four of five beyond 1 s, on one side"), 5, _sides(4, 1.0)),
        Rule("eight-on-one-side", worded("eight in a row on one side of the mean"), 8, _sides(8, 0.0)),
        Rule("six-rising", worded("six in a row steadily rising or falling"), 6, _rising, lambda z: z[-1] > z[0]),
        Rule("fourteen-alternating", worded("fourteen in a row by turns up and down"), 14, _alternating),
        Rule(
            "fifteen-near",
            worded("fifteen in a row within 1 s"),
            15,
            lambda z: np.asarray((np.abs(z) < 1.0).all(axis=1)),
        ),
        Rule(
            "eight-apart", worded("eight in a row beyond 1 s"), 8, lambda z: np.asarray((np.abs(z) > 1.0).all(axis=1))
        ),
    )
}
USUAL = ("beyond-3s", "two-of-three", "four-of-five", "eight-on-one-side", "six-rising")


@dataclass(frozen=True)
class Run:
    """What a rule found."""

    rule: str
    words: str
    first: int
    """Place of the first figure that belongs to it, from 0."""
    last: int
    upward: bool
    """Above the centre on the whole, or rising."""


@dataclass(frozen=True)
class Runs:
    """All that was found, in the order of rules and figures."""

    basis: Basis
    rules: tuple[str, ...]
    """Those that were asked."""
    not_asked: tuple[str, ...]
    """Of them those that look at more figures than there are."""
    found: tuple[Run, ...]

    def ending(self, last: int) -> tuple[Run, ...]:
        """Those that go on to a figure."""
        return tuple(run for run in self.found if run.last == last)


def runs(new: Sequence[float] | F64, centre: float, s: float, rules: Sequence[str] = USUAL) -> Runs:
    """(N,) figures in order against a centre and s > 0 of a baseline. Rows that overlap are one run.

    Raises UlnaInputError for rules that nobody knows, and for what are no numbers.
    """
    values = figures(new, "figures")
    if not s > 0.0:
        raise UlnaInputError(f"run rules: got s {s:g}; expected a standard deviation above 0.")
    for name in rules:
        if name not in RULES:
            raise UlnaInputError(f"run rules: got '{name}', no rule.{nearest(name, RULES)} Correct it.")
    asked = [RULES[name] for name in rules]
    z = (values - centre) / s
    found = [run for rule in asked for run in _of(rule, z)]
    late = tuple(rule.name for rule in asked if rule.length > len(z))
    return Runs(basis("run rules", len(z), 1), tuple(rules), late, tuple(found))


def _of(rule: Rule, z: F64) -> list[Run]:
    if len(z) < rule.length:
        return []
    rows = np.lib.stride_tricks.sliding_window_view(z, rule.length)
    found: list[Run] = []
    for first in np.flatnonzero(rule.found(rows)).tolist():
        last = first + rule.length - 1
        if found and first <= found[-1].last:
            first = found.pop().first
        found.append(Run(rule.name, rule.words, first, last, bool(rule.upward(z[first : last + 1]))))
    return found
