"""Verify: an acceptance test, from a verify file to decided figures."""

from __future__ import annotations

import json
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from ulna.arm.given import ArmLike
from ulna.formats.for_sheets import for_sheets
from ulna.formats.output import output_folder
from ulna.formats.units import MM_PER
from ulna.ground.arrays import Progress
from ulna.ground.errors import InputWarning, UlnaInputError, nearest
from ulna.ground.extras import need
from ulna.ground.shown import About, Shown, Table
from ulna.ground.worded import worded
from ulna.verification.decision import DecisionRule, Limit, Verdict, worst_verdict
from ulna.verification.departures import NOT_MEASURED
from ulna.verification.figures.figure import Definition
from ulna.verification.file import VerifyPlan, load_verify
from ulna.verification.kinds.registry import kind_of
from ulna.verification.limits import LimitTable, LimitValue
from ulna.verification.outcome import FigureResult, Judged, StateResult, TestResult
from ulna.verification.outcome_tables import verification_file
from ulna.verification.result_file import VerificationFile
from ulna.verification.risk import Process, conformity_of
from ulna.verification.tables import STATES, State
from ulna.verification.touches import Touches, joined

FILE = "verification.json"
TABLE = "values.csv"
PICTURES = ("lengths.svg", "lengths.png")


@dataclass(frozen=True, repr=False)
class Verification(Shown):
    """What an acceptance test found."""

    plan: VerifyPlan
    rule: DecisionRule
    states: list[StateResult]
    """as-found before as-left; those that were measured."""
    time: datetime

    @property
    def verdict(self) -> Verdict | None:
        """The worst of all; None where no limit was stated."""
        return worst_verdict([state.verdict for state in self.states])

    @property
    def standing(self) -> StateResult:
        """The state that the arm is in now: as left where it was tested so, else as found."""
        return max(self.states, key=lambda state: state.state == "as-left")

    @property
    def arm(self) -> str:
        """What reports call it."""
        named = self.plan.file.arm
        if named is not None:
            return named
        return self.plan.arms[0].arm.name if self.plan.arms else "not named"

    def about(self) -> About:
        """Each figure in each state, with its limit and verdict."""
        rows = [
            [
                state.state,
                figure.definition.key,
                figure.verdict or "no limit",
                f"{1000.0 * figure.worst.single.value_mm:.1f}",
                "–" if figure.worst.limit_mm is None else f"{1000.0 * figure.worst.limit_mm:.1f}",
            ]
            for state in self.states
            for figure in state.figures.values()
        ]
        return About(
            f"Verification of '{self.arm}' after {self.plan.profile.file.name}: {self.verdict or 'no limit stated'}",
            {},
            [Table(["state", "figure", "verdict", "worst / µm", "limit / µm"], rows, texts=3)],
        )

    def file(self) -> VerificationFile:
        """`verification.json`, lengths in mm."""
        return verification_file(self.plan, self.arm, self.rule, self.states, self.verdict, self.time)

    def as_dict(self) -> dict[str, Any]:
        """The same: JSON types only."""
        return self.file().model_dump(exclude_unset=True)

    def save(self, folder: str | Path, force: bool = False) -> None:
        """Write verification.json, values.csv and, where lengths were measured, lengths.svg and .png. Raises
        UlnaInputError."""
        from ulna.verification.values_table import values_table

        if len(self.files) > 2:
            need("the picture of lengths in the results", "matplotlib")

        with output_folder(folder, self.files, force) as staging:
            text = json.dumps(self.as_dict(), indent=1, ensure_ascii=False, allow_nan=False)
            (staging / FILE).write_text(text + "\n", encoding="utf-8")
            for_sheets(values_table(self.states)).write_csv(staging / TABLE)
            if len(self.files) > 2:
                from ulna.verification.plots import draw_lengths

                draw_lengths(self.states, staging)

    @property
    def files(self) -> tuple[str, ...]:
        """What `save` writes."""
        return (FILE, TABLE, *(PICTURES if has_lengths(self.states) else ()))


def has_lengths(states: list[StateResult]) -> bool:
    """Whether a length was measured."""
    return any(single.single.measured_mm is not None for state in states for single in lengths_of(state))


def lengths_of(state: StateResult) -> list[Judged]:
    """All lengths of a state."""
    return [judged for test in state.tests if kind_of(test.kind).length_errors for judged in test.figures[0].values]


def verify(plan: str | Path, arm: ArmLike | None = None, progress: Progress | None = None) -> Verification:
    """An acceptance test: `plan` a verify file; `arm`, for encoder readings, an arm, a result, or a path of one.

    Raises UlnaInputError for whatever cannot be used. Warns with InputWarning of what is used with a remark.
    """
    import warnings

    stated = load_verify(Path(plan), arm)
    for remark in stated.warnings:
        warnings.warn(remark, InputWarning, stacklevel=2)
    return evaluated(stated, progress)


def evaluated(stated: VerifyPlan, progress: Progress | None = None) -> Verification:
    """What was read, evaluated. Raises UlnaInputError for whatever cannot be."""
    rule, limits = rule_of_plan(stated), _limits(stated)
    processes = _processes(stated)
    states = [state for state in STATES if state in stated.touches]
    found = []
    for number, state in enumerate(states):
        found.append(_state(state, joined(stated.touches[state]), stated, rule, limits, processes))
        if progress is not None:
            progress("evaluating", number + 1, len(states))
    return Verification(stated, rule, found, datetime.now().astimezone())


def _state(
    state: State,
    touches: Touches,
    plan: VerifyPlan,
    rule: DecisionRule,
    limits: dict[str, Limit],
    processes: dict[str, Process],
) -> StateResult:
    bench = plan.bench
    parts = {name: own for (name,), own in touches.groups(("test",))}
    tests, departures = [], []
    for name, table in plan.profile.file.test.items():
        kind = kind_of(table.kind)
        if name not in parts:
            figures = ", ".join(figure.key for figure in kind.figures(table))
            departures.append(worded(NOT_MEASURED, test=name, figures=figures))
            continue
        found = kind.evaluated(name, table, parts[name], bench)
        judged = []
        for definition, singles in found.figures:
            limit = limits.get(definition.key)
            values = []
            for single in singles:
                limit_mm = None if limit is None else limit.at_mm(single.calibrated_mm)
                u_mm = single.budget.u_mm
                conformity = conformity_of(single.value_mm, u_mm, limit_mm, definition.signed)
                values.append(Judged(single, limit_mm, rule.decide(single.value_mm, limit_mm, u_mm), conformity))
            process = processes.get(definition.key)
            judged.append(FigureResult(definition, limit, values, rule.k, rule.p, process))
        tests.append(TestResult(name, kind.name, len(parts[name].row), judged, found.departures))
    return StateResult(state, tests, departures)


def rule_of_plan(plan: VerifyPlan) -> DecisionRule:
    """As the profile says, or the verify file in its place. Raises UlnaInputError for "rU" without its r."""
    table, file = plan.profile.file.decision, plan.file
    own = file.rule is not None
    rule, r = (file.rule or table.rule), (file.r if file.r is not None else table.r)
    if rule == "rU" and r is None:
        path, key = (plan.path, "r") if own else (plan.profile.path, "decision.r")
        raise UlnaInputError(
            f"{path}: key '{key}' is missing: the rule is \"rU\", a guard band that is a part r of U; expected r, a "
            "number above 0. Add it."
        )
    if rule != "rU" and file.r is not None:
        raise UlnaInputError(
            f'{plan.path}: key \'r\': got {file.r:g}, but the rule is "{rule}"; expected it with rule = "rU" only. '
            "Remove it, or change the rule."
        )
    return DecisionRule(rule, table.k, table.p, r if rule == "rU" else None)


def _figures(plan: VerifyPlan) -> dict[str, Definition]:
    """All that the profile's tests give, by the short name."""
    tests = plan.profile.file.test.values()
    return {figure.key: figure for table in tests for figure in kind_of(table.kind).figures(table)}


def _processes(plan: VerifyPlan) -> dict[str, Process]:
    """What is made, by the short name of a figure. Raises UlnaInputError for what cannot be."""
    known = _figures(plan)
    found = {}
    for name, table in plan.file.process.items():
        where = f"{plan.path}: key 'process.{name}'"
        if name not in known:
            raise UlnaInputError(
                f"{where}: no test of profile '{plan.profile.file.name}' gives it.{nearest(name, known)} Correct it."
            )
        found[name] = Process.of(table, plan.file.units.mm, known[name].signed, where)
    return found


def _limits(plan: VerifyPlan) -> dict[str, Limit]:
    """By the short name of a figure. Raises UlnaInputError for names that no test gives."""
    profile = plan.profile.file
    known = _figures(plan)
    found: dict[str, Limit] = {}
    unit = 1.0 if profile.unit is None else MM_PER[profile.unit]
    for limits, mm, path, key in (
        (profile.limit, unit, plan.profile.path, "limit"),
        (plan.file.mpe, plan.file.units.mm, plan.path, "mpe"),
    ):
        for name, value in limits.items():
            if name not in known:
                raise UlnaInputError(
                    f"{path}: key '{key}.{name}': no test of profile '{profile.name}' gives it."
                    f"{nearest(name, known)} Correct it."
                )
            found[name] = _limit(value, mm)
    return found


def _limit(value: LimitValue, mm: float) -> Limit:
    return Limit(value.a * mm, value.b) if isinstance(value, LimitTable) else Limit(value * mm)
