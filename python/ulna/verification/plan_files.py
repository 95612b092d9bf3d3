"""A plan on disk: the verify file to fill in, and the list of touches in order."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import polars as pl

from ulna.formats.toml_text import toml_key, toml_value
from ulna.verification.kinds.registry import kind_of
from ulna.verification.kinds.steps import Step
from ulna.verification.own_readings import table_of
from ulna.verification.profile import Profile, shipped
from ulna.verification.steps import artefacts_of, steps_of
from ulna.verification.tables import State

PLAN = "plan.toml"
TOUCHES = "touches.csv"


@dataclass(frozen=True)
class Filled:
    """What is known of a plan already; keys of the tables as in a verify file, mm."""

    arm: str | None = None
    ball_mm: float | None = None
    range_mm: float | None = None
    artefacts: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    mpe: Mapping[str, Any] = field(default_factory=dict)
    temperature: Mapping[str, float] | None = None
    fixture_mm: float | None = None


EMPTY = Filled()


def plan_toml(
    profile: Profile, filled: Filled, encoders: bool, folder: Path, states: Sequence[State] | None = None
) -> str:
    """The text of a verify file in a folder: what is known filled in, the rest to be filled in where a '#' stands.

    states: with a table of touches of each, by its name; None: one table, of the list.
    """
    own = profile.path not in shipped().values()
    name = _path_from(folder, profile.path) if own else profile.file.name
    lines = [
        f"# An acceptance test to be measured as {TOUCHES} lists it, then evaluated by",
        f"# ulna verify {'ARM ' if encoders else ''}{PLAN}",
        "# Fill in what is missing; keys are explained in the reference of files.",
        'format = "ulna-verify/1"',
        f"profile = {toml_value(name)}",
        'units = { length = "mm", angle = "rad" }',
        _line("arm", filled.arm, '"maker, type, serial number"'),
    ]
    if not encoders:
        lines.append(_line("ball", filled.ball_mm, "6.0              # diameter of the probe's ball"))
    lines.append(_line("range", filled.range_mm, "2400.0          # diameter of the measuring range"))
    lines += ["", "[mpe]               # maximum permissible errors; a figure without one gets no verdict"]
    for table in profile.file.test.values():
        kind = kind_of(table.kind)
        for figure in kind.figures(table):
            grows = isinstance(kind.limits.get(figure.key), Mapping)
            example = "{ a = 0.030, b = 40000 }     # a + L / b" if grows else "0.030"
            lines.append(_line(toml_key(figure.key), filled.mpe.get(figure.key), example))
    lines += [
        "",
        '# rule = "rU"       # above the tables: a decision rule in place of the profile\'s, with r = 0.8',
        '# scanner = "…"     # above the tables: what the arm carries beside its probe; it is not tested',
        "# [process.KEY]     # what is made, by the name of a figure: global risks of the decisions",
        "# mean = 0.0",
        "# deviation = 0.010",
    ]
    for artefact in artefacts_of(profile.file):
        known = filled.artefacts.get(artefact.name, {})
        keys = artefact.keys(filled.range_mm)
        lines += ["", f"[artefact.{toml_key(artefact.name)}]"] if keys else []
        lines += [_line(key.name, known.get(key.name, key.value), key.example) for key in keys]
    temperature = filled.temperature or {}
    lines += [
        "",
        _head("temperature", temperature, "of the artefacts, °C and K"),
        _line("value", temperature.get("value"), "20.4"),
        _line("u", temperature.get("u"), "0.1"),
        "",
        _head("fixture", filled.fixture_mm, "how still the artefacts stand: standard uncertainty"),
        _line("u", filled.fixture_mm, "0.001"),
    ]
    for state in states or ():
        lines += ["", "[[readings]]", f"file = {toml_value(table_of(state))}", f"state = {toml_value(state)}"]
    if states is None:
        lines += [
            "",
            "[[readings]]",
            f"file = {toml_value(TOUCHES)}",
            'state = "as-left"   # or "as-found"; both may be in one plan',
        ]
    return "\n".join(lines) + "\n"


def touches_table(profile: Profile, columns: Mapping[str, list[Any]]) -> pl.DataFrame:
    """One row a touch: labels, what to do, then the columns of the readings, empty where nothing was measured."""
    steps: list[Step] = steps_of(profile.file)
    labels = {
        "step": list(range(1, len(steps) + 1)),
        "test": [step.test for step in steps],
        "artefact": [step.artefact for step in steps],
        "position": [step.position for step in steps],
        "orientation": [step.orientation for step in steps],
        "repeat": [step.repeat for step in steps],
        "feature": [step.feature for step in steps],
        "what to do": [str(step.what) for step in steps],
    }
    return pl.DataFrame({**labels, **columns}, strict=False)


def _path_from(folder: Path, path: Path) -> str:
    """Relative where there is such a path, with the slashes of every system."""
    try:
        return Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()
    except ValueError:  # on another drive
        return str(path.resolve())


def _line(key: str, value: Any, example: str) -> str:
    return f"# {key} = {example}" if value is None else f"{key} = {toml_value(value)}"


def _head(name: str, known: Any, what: str) -> str:
    return f"[{name}]" if known else f"# [{name}]       # {what}"
