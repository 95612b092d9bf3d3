"""What an acceptance test owes: its table in a profile, figures, artefacts and steps, and how touches are evaluated.

A new test is one file beside this one, which makes a `TestKind`, and its row in `registry.py`; nobody else asks of what
kind a test is. `tests/contract/test_acceptance_tests.py` holds every row to what is written here.
"""

from __future__ import annotations

import typing
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from ulna.formats.models import Strict
from ulna.verification.bench import Bench, Found
from ulna.verification.figures.figure import Definition
from ulna.verification.kinds.steps import Step
from ulna.verification.kinds.wanted import Wanted
from ulna.verification.touches import Touches


class TestTable(Strict):
    """What a profile says of one test."""

    kind: str  # each kind has a table of its own, where this is a Literal of its name


Table = TypeVar("Table", bound=TestTable)


@dataclass(frozen=True, kw_only=True)
class TestKind(Generic[Table]):
    """One kind of acceptance test. Nothing here has a default: what a kind has nothing of, it says."""

    table: type[Table]
    """Its table in a profile; keys have docstrings, which become the JSON Schema's."""
    figures: Callable[[Table], list[Definition]]
    """What it gives, in the order of reports."""
    artefacts: Callable[[Table], Sequence[Wanted]]
    """What is touched; a virtual arm touches it in the same way."""
    steps: Callable[[str, Table], Iterable[Step]]
    """(the test's name, table) → what the operator does, touch by touch."""
    evaluate: Callable[[str, Table, Touches, Bench], Found]
    """(the test's name, table, touches, what they stand on) → figures with their single values, and departures from the
    profile. Raises UlnaInputError where touches determine no figure."""
    limits: Mapping[str, float | Mapping[str, float]]
    """Examples of limits by the short name of a figure, mm, of no maker: they stand in plans, and in those that a
    virtual arm plays. {a, b} of one that grows with the length."""
    growing: int | None
    """From how many touches of a measurement on its figures are known, and grow with each further one, where it is
    touched step by step; None: of a measurement of which all is touched."""
    moved: bool
    """Whether elbow and wrist are to move between touches of a measurement: the same posture again tells nothing."""
    length_errors: bool
    """Whether its first figure is of errors of lengths, which are drawn over the length."""
    again: str
    """What to measure again first, where a check before work finds one of its figures out."""
    look: str
    """And what to look at then."""
    words: tuple[str, ...]
    """Keys of the reports' words that only its part of a report needs."""
    examples: Callable[[], Sequence[Table]]
    """Small tables, one of each variant: what the contract suite plays."""

    @property
    def name(self) -> str:
        """What a profile calls it: the one text that its table's key `kind` may be."""
        return str(typing.get_args(self.table.model_fields["kind"].annotation)[0])

    def __post_init__(self) -> None:
        """Raises TypeError with all that a kind falls short of."""
        missing = list(self._missing())
        if missing:
            raise TypeError(f"acceptance test {self.table.__name__}: {'; '.join(missing)}")

    def _missing(self) -> Iterable[str]:
        if typing.get_origin(self.table.model_fields["kind"].annotation) is not typing.Literal:
            yield "its table has no name: write kind: Literal[…], the word for it in a profile"
        if not (self.table.__doc__ or "").strip():
            yield "its table has no docstring: say which figures it gives, and of what"
        if not (self.again and self.look):
            yield "it does not say what to measure again, and what to look at, where a check finds it out"
        if self.length_errors and not self.words:
            yield "it draws errors over lengths, but names no words for that: name their keys"

    def check(self) -> None:
        """Whether examples have figures and steps, and limits are of figures. Raises TypeError with all that is not."""
        missing = list(self._unfit(self.examples()))
        if missing:
            raise TypeError(f"acceptance test '{self.name}': {'; '.join(missing)}")

    def _unfit(self, examples: Sequence[Table]) -> Iterable[str]:
        if not examples:
            yield "it has no examples: give a small table of each variant, which the contract suite plays"
        for table in examples:
            if not self.figures(table):
                yield "it has no figures: name what it gives, with a formula and a source"
            self.listed("example", table)
        known = {figure.key for table in examples for figure in self.figures(table)}
        for key in self.limits.keys() - known:
            yield f"it has an example of a limit for '{key}', which no example gives: name that figure, or remove it"

    def listed(self, name: str, table: Any) -> list[Step]:
        """All its steps. Raises TypeError where there are none, or where one touches what the kind does not want."""
        steps = list(self.steps(name, table))
        wanted = {each.name for each in self.artefacts(table)}
        if not steps:
            raise TypeError(f"acceptance test '{self.name}': it has no steps: say what the operator touches")
        for step in steps:
            if step.artefact not in wanted:
                raise TypeError(
                    f"acceptance test '{self.name}': a step touches '{step.artefact}', which is not among its "
                    "artefacts: name it there, so that plans list it"
                )
        return steps

    def evaluated(self, name: str, table: Any, touches: Touches, bench: Bench) -> Found:
        """As `evaluate`; a figure that the kind does not own to is nobody's. Raises TypeError for one."""
        found = self.evaluate(name, table, touches, bench)
        known = self.figures(table)
        for definition, _ in found.figures:
            if definition not in known:
                raise TypeError(
                    f"acceptance test '{self.name}': it gives '{definition.key}', which is not among its figures: name "
                    "it there, so that limits for it are known"
                )
        return found
