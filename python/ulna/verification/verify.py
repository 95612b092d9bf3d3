"""Verify: an acceptance test, from a verify file to decided figures."""

from __future__ import annotations

import json
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from ulna.formats.output import output_folder
from ulna.formats.units import MM_PER
from ulna.ground.arrays import Progress
from ulna.ground.errors import InputWarning, UlnaInputError, nearest
from ulna.ground.version import VERSION
from ulna.verification.bench import Bench
from ulna.verification.budget import Surroundings
from ulna.verification.decision import DecisionRule, Limit, Verdict, worst_verdict
from ulna.verification.file import VerifyPlan, load_verify
from ulna.verification.kinds.registry import evaluate, figures_of
from ulna.verification.outcome import FORMAT, FigureResult, Judged, StateResult, TestResult
from ulna.verification.profile_tables import LimitTable, LimitValue
from ulna.verification.tables import STATES
from ulna.verification.touches import Touches, joined

FILE = "verification.json"
TABLE = "values.csv"
PICTURES = ("lengths.svg", "lengths.png")


@dataclass(frozen=True)
class Verification:
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
    def arm(self) -> str:
        """What reports call it."""
        named = self.plan.file.arm
        if named is not None:
            return named
        return self.plan.arms[0].arm.name if self.plan.arms else "not named"

    def as_dict(self) -> dict[str, Any]:
        """`verification.json`: JSON types only, lengths in mm."""
        plan, profile = self.plan, self.plan.profile
        temperature, fixture, mm = plan.file.temperature, plan.file.fixture, plan.file.units.mm
        return {
            "format": FORMAT,
            "arm": self.arm,
            "verdict": self.verdict,
            "profile": {
                "name": profile.file.name,
                "standard": profile.file.standard,
                "statement": profile.file.statement,
                "path": str(profile.path),
                "sha256": profile.sha256,
            },
            "decision": {"rule": self.rule.rule, "text": self.rule.text, "k": self.rule.k, "p": self.rule.p},
            "environment": {
                "temperature": None if temperature is None else {"value": temperature.value, "u": temperature.u},
                "fixture": None if fixture is None else {"u": fixture.u * mm},
                "range": None if plan.file.range is None else plan.file.range * mm,
            },
            "artefacts": [
                {"name": name, **_in_mm(table.model_dump(exclude_none=True), mm)}
                for name, table in plan.file.artefact.items()
            ],
            "states": [state.as_dict() for state in self.states],
            "provenance": {
                "program": "ulna",
                "version": VERSION,
                "plan": {"path": str(plan.path), "sha256": plan.sha256},
                "arms": [{"path": str(each.path), "sha256": each.sha256} for each in plan.arms],
                "files": [
                    {
                        "state": state,
                        "path": str(each.path),
                        "sha256": each.sha256,
                        "rows": len(each.row),
                        "points": each.source,
                        "arm_sha256": each.arm_sha256,
                    }
                    for state, parts in plan.touches.items()
                    for each in parts
                ],
                "warnings": list(plan.warnings),
                "time": self.time.isoformat(timespec="seconds"),
            },
        }

    def save(self, folder: str | Path, force: bool = False) -> None:
        """Write verification.json, values.csv and, where lengths were measured, lengths.svg and .png. Raises
        UlnaInputError."""
        from ulna.verification.plots import draw_lengths
        from ulna.verification.values_table import values_table

        with output_folder(folder, self.files, force) as staging:
            text = json.dumps(self.as_dict(), indent=1, ensure_ascii=False, allow_nan=False)
            (staging / FILE).write_text(text + "\n", encoding="utf-8")
            values_table(self.states).write_csv(staging / TABLE)
            if len(self.files) > 2:
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
    return [
        judged for test in state.tests if test.kind in ("length", "volumetric") for judged in test.figures[0].values
    ]


def verify(plan: str | Path, arm: str | Path | None = None, progress: Progress | None = None) -> Verification:
    """An acceptance test: `plan` a verify file; `arm` an arm file or a result, for encoder readings.

    Raises UlnaInputError for whatever cannot be used. Warns with InputWarning of what is used with a remark.
    """
    import warnings

    stated = load_verify(Path(plan), None if arm is None else Path(arm))
    for remark in stated.warnings:
        warnings.warn(remark, InputWarning, stacklevel=2)
    rule = DecisionRule.of(stated.profile.file.decision, stated.file.rule)
    limits = _limits(stated)
    states = [state for state in STATES if state in stated.touches]
    found = []
    for number, state in enumerate(states):
        found.append(_state(state, joined(stated.touches[state]), stated, rule, limits))
        if progress is not None:
            progress("evaluating", number + 1, len(states))
    return Verification(stated, rule, found, datetime.now().astimezone())


def _state(state: str, touches: Touches, plan: VerifyPlan, rule: DecisionRule, limits: dict[str, Limit]) -> StateResult:
    bench = _bench(plan)
    parts = {name: own for (name,), own in touches.groups(("test",))}
    tests, departures = [], []
    for name, table in plan.profile.file.test.items():
        if name not in parts:
            figures = ", ".join(figure.key for figure in figures_of(table))
            departures.append(f"test '{name}' ({figures}) was not measured.")
            continue
        found = evaluate(name, table, parts[name], bench)
        judged = []
        for definition, singles in found.figures:
            limit = limits.get(definition.key)
            values = []
            for single in singles:
                limit_mm = None if limit is None else limit.at_mm(single.calibrated_mm)
                values.append(Judged(single, limit_mm, rule.decide(single.value_mm, limit_mm, single.budget.u_mm)))
            judged.append(FigureResult(definition, limit, values, rule.k, rule.p))
        tests.append(TestResult(name, table.kind, len(parts[name].row), judged, found.departures))
    return StateResult(state, tests, departures)


def _bench(plan: VerifyPlan) -> Bench:
    file, mm = plan.file, plan.file.units.mm
    temperature = file.temperature
    surroundings = Surroundings(
        None if temperature is None else temperature.value,
        None if temperature is None else temperature.u,
        None if file.fixture is None else file.fixture.u * mm,
    )
    return Bench(plan.path, file.artefact, mm, surroundings, None if file.range is None else file.range * mm)


def _limits(plan: VerifyPlan) -> dict[str, Limit]:
    """By the short name of a figure. Raises UlnaInputError for names that no test gives."""
    profile = plan.profile.file
    known = [figure.key for table in profile.test.values() for figure in figures_of(table)]
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


def _in_mm(table: dict[str, Any], mm: float) -> dict[str, Any]:
    lengths = ("diameter", "length", "u", "form")
    return {key: value * mm if key in lengths else value for key, value in table.items()}
