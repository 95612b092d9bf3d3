"""The verify file of a test that is being touched: as found before as left, each state's touches beside it."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path
from typing import Any

import polars as pl

from ulna.arm.arm import Arm
from ulna.formats.toml_text import toml_value
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import kept, worded
from ulna.verification.file import load_verify
from ulna.verification.kinds.steps import Step
from ulna.verification.tables import STATES, State
from ulna.verification.touches import LABELS

_BLOCK = re.compile(r"(?ms)^\s*\[\[readings\]\].*?(?=^\s*\[(?!\[?readings[.\]])|^\s*\[\[readings\]\]|\Z)")

_STATES: dict[State, str] = {"as-found": worded("the arm as found"), "as-left": worded("the arm as left")}


def table_of(state: State) -> str:
    """The name of the table of touches of a state."""
    return f"{state}.csv"


def arm_of(state: State, suffix: str) -> str:
    """The name of the arm that turns them into points."""
    return f"arm-{state}{suffix}"


def split(text: str, path: Path) -> tuple[str, list[tuple[State, str]]]:
    """A verify file without its readings, and the text of each of these with its state. Raises UlnaInputError."""
    blocks = [match[0].strip() + "\n" for match in _BLOCK.finditer(text)]
    head = _BLOCK.sub("", text).rstrip() + "\n"
    try:
        known, left = tomllib.loads(text), tomllib.loads(head)
        found = [tomllib.loads(block)["readings"][0] for block in blocks]
    except (tomllib.TOMLDecodeError, KeyError, IndexError):
        found = []
        known, left = {"readings": None}, {}
    if {**left, "readings": found} != known:
        raise UlnaInputError(
            worded(
                "{path}: key 'readings' is not written as tables of its own; expected [[readings]] before each. Write "
                "it so.",
                path=str(path),
            )
        )
    return head, [(each.get("state", "as-left"), block) for each, block in zip(found, blocks, strict=True)]


def begun(text: str, path: Path, state: State, arm: str, beside: Path) -> str:
    """The same file with the touches of a state that are yet to be taken, and of earlier states those that were.

    beside: where its tables are. Raises UlnaInputError where a state comes before another one that is not touched yet,
    or after one that is.
    """
    head, blocks = split(text, path)
    earlier: list[str] = []
    for other in STATES:
        own = [block for each, block in blocks if each == other]
        if other == state or not own:
            continue
        before = STATES.index(other) < STATES.index(state)
        touched = _touched(head, own, beside)
        if before and touched is not None:
            raise UlnaInputError(
                worded(
                    "{path}: {first} comes before {second}, and is not touched yet ({why}); expected its touches. "
                    "Touch it first, or take its [[readings]] out of the file.",
                    path=str(path),
                    first=_STATES[other],
                    second=_STATES[state],
                    why=touched,
                )
            )
        if not before and touched is None:
            raise UlnaInputError(
                worded(
                    "{path}: {first} comes before {second}, which is touched already; expected a test that begins. "
                    "Begin another.",
                    path=str(path),
                    first=_STATES[state],
                    second=_STATES[other],
                )
            )
        earlier += own if before else []
    mine = (
        f"[[readings]]\nfile = {toml_value(table_of(state))}\nstate = {toml_value(state)}\n"
        f'angle = "rad"\narm = {toml_value(arm)}\n'
    )
    return "\n".join([head, *earlier, mine])


def _touched(head: str, blocks: list[str], beside: Path) -> str | None:
    """Why the touches of these tables cannot be read; None: they can."""
    trial = beside / "trial.toml"
    trial.write_text("\n".join([head, *blocks]), encoding="utf-8")
    try:
        load_verify(trial)
    except UlnaInputError as error:
        return kept(error)
    finally:
        trial.unlink()
    return None


def touched_table(steps: list[tuple[int, Step]], columns: dict[str, list[Any]]) -> pl.DataFrame:
    """Touches that were taken, as `make_test_plan` lists them: step (from 1), labels, what was to be done, readings."""
    return pl.DataFrame(
        {
            "step": [number + 1 for number, _ in steps],
            **{name: [getattr(step, name) for _, step in steps] for name in LABELS},
            "what to do": [str(step.what) for _, step in steps],
            **columns,
        },
        strict=False,
    )


def probe_column(arm: Arm, probe: str, count: int) -> dict[str, list[Any]]:
    """Which probe was on, of an arm with several."""
    return {"probe": [probe] * count} if len(arm.probes) > 1 else {}


def angles_table(steps: list[tuple[int, Step]], q_rad: F64, arm: Arm, probe: str) -> pl.DataFrame:
    """The same with (N, n) encoder angles, rad, exact to the last digit."""
    columns: dict[str, list[Any]] = {f"q{k + 1}": column.tolist() for k, column in enumerate(q_rad.T)}
    return touched_table(steps, columns | probe_column(arm, probe, len(steps)))
