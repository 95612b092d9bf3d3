"""A work of the literature: its ways of calibrating, what it reports, and what we find; printed and saved."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from ulna.formats.output import output_folder
from ulna.ground.arrays import Progress
from ulna.ground.terminal import plain_table
from ulna.reproduce.cheng2011.arms import ENCODER_RAD, SEAT_MM
from ulna.reproduce.claims import FORMAT, Claim, claims_table
from ulna.reproduce.kept import table_files, write_tables
from ulna.reproduce.ways.arms import ARMS, SEVEN, SIX
from ulna.reproduce.ways.outcome import Outcome, Way, outcomes_of
from ulna.reproduce.ways.trial import FRESH_BARS, WRONG_MM, WRONG_RAD

REPEATS = 10

UNKNOWN = "not known to us"
ERRORS_BELOW = Claim("errors of the calibrated arm", UNKNOWN, "in the table below", None)
REPORTED = "Facts as Cheng, Yu, Fei 2011 report them."
"""Where we have the figures of older works from."""

SAME = 1e-6
"""Relative: two fits whose sums of squares are closer than this are at the same optimum."""

#: way → its outcome on one of the arms
Found = Callable[[Way, str], Outcome]


@dataclass(frozen=True)
class Work:
    """What is rerun of it."""

    name: str
    title: str
    source: str
    """Where it was published, and where we have its figures from."""
    chosen: str
    """What the work does not tell us and we chose."""
    ways: tuple[Way, ...]
    claims: Callable[[Found], list[Claim]]
    checks: tuple[Way, ...] = ()
    """Carried out for the claims alone."""

    def run(self, out: Path | None, progress: Progress | None, *, repeats: int = REPEATS, force: bool = True) -> Rerun:
        """Carry out the ways, and save what was found where a folder is given.

        As `ulna.cli.reproduce.ReproductionModule` has it; more repeats make the medians steadier.
        """
        outcomes = outcomes_of((*self.ways, *self.checks), repeats, progress)
        shown = len(outcomes) - len(self.checks) * len(ARMS)
        found = Rerun(self, outcomes[:shown], outcomes[shown:])
        if out is not None:
            found.save(out, force=force)
        return found


@dataclass(frozen=True)
class Rerun:
    """What was found."""

    work: Work
    outcomes: list[Outcome]
    checked: list[Outcome]

    def claims(self) -> list[Claim]:
        """The work's numbers beside ours."""
        by = {(outcome.way, outcome.arm): outcome for outcome in (*self.outcomes, *self.checked)}
        return self.work.claims(lambda way, arm: by[way.label, arm])

    @property
    def agrees(self) -> bool:
        """Whether everything the work reports, and that should come out, did."""
        return all(claim.agrees is not False for claim in self.claims())

    def table(self) -> RenderableType:
        """80 columns."""
        blank = Text("")
        return Group(
            Text(self.work.title, style="bold"),
            Text(f"{self.work.source} {self.work.chosen}"),
            blank,
            claims_table("What the work reports, and what we find", self.claims(), theirs="the work"),
            blank,
            outcomes_table(self.outcomes),
        )

    def as_dict(self) -> dict[str, Any]:
        """`NAME.json`: JSON types only."""
        return {
            "format": FORMAT,
            "study": self.work.name,
            "agrees": self.agrees,
            "source": self.work.source,
            "chosen": self.work.chosen,
            "claims": [dataclasses.asdict(claim) for claim in self.claims()],
            "outcomes": outcome_dicts(self.outcomes),
        }

    def save(self, folder: Path, force: bool = False) -> None:
        """Write `NAME.json` and the tables (CSV and LaTeX) into a folder. Raises UlnaInputError."""
        name, shown = f"{self.work.name}.json", self.table()
        with output_folder(folder, (name, *table_files(shown)), force) as staging:
            write_tables(shown, staging)
            write_json(staging / name, self.as_dict())


def same_optimum(found: Found, one: Way, other: Way) -> bool:
    """Whether the first fits of two ways end with the same sum of squares, on both arms."""
    for arm in ARMS:
        results = [found(way, arm).first.result for way in (one, other)]
        costs = [result.fit.cost for result in results if result is not None]
        if len(costs) < 2 or abs(costs[1] / costs[0] - 1.0) > SAME:
            return False
    return True


def outcome_dicts(outcomes: list[Outcome]) -> list[dict[str, Any]]:
    """JSON types only."""
    fields = [field.name for field in dataclasses.fields(Outcome) if field.name != "first"]
    return [{name: getattr(outcome, name) for name in fields} for outcome in outcomes]


def write_json(path: Path, content: dict[str, Any]) -> None:
    """As the program writes all its JSON."""
    path.write_text(json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")


def outcomes_table(outcomes: list[Outcome]) -> Table:
    """One line for each way and arm."""
    most = max(outcome.repeats for outcome in outcomes)
    table = plain_table(
        "On the same two arms, with the same noise",
        f"Virtual arms of seven and of six axes, encoders {ENCODER_RAD:g} rad, a touch {SEAT_MM:g} mm; from a drawing "
        f"whose zero offsets are off by up to {WRONG_RAD:g} rad and lengths by up to {WRONG_MM:g} mm. known: "
        f"determined of the parameters. Length errors of {FRESH_BARS} fresh bars, rms: as read, and what the arm "
        f"contributes. point: the worst anywhere. Medians of {most} repeats; of a search without derivatives one only.",
    )
    table.width = 80
    table.add_column("way", ratio=1)
    for head in ("axes", "touches", "known", "bars\nµm", "by arm\nµm", "point\nµm", "time\nms"):
        table.add_column(head, justify="right", no_wrap=True)
    for outcome in outcomes:
        known = "–" if outcome.determined is None else f"{outcome.determined}/{outcome.parameters}"
        micrometres = (outcome.bars_rms_mm, outcome.bars_by_arm_rms_mm, outcome.worst_point_mm)
        table.add_row(
            outcome.way,
            {SEVEN: "7", SIX: "6"}[outcome.arm],
            str(outcome.touches) if outcome.touches else "–",
            known,
            *(_micrometres(value) for value in micrometres),
            _milliseconds(outcome.seconds) if outcome.seconds else "–",
        )
    return table


def _micrometres(value_mm: float) -> str:
    value = 1000 * value_mm
    return f"{value:.1f}" if value < 100 else f"{value:.0f}"


def _milliseconds(value_s: float) -> str:
    value = 1000 * value_s
    return f"{value:.1f}" if value < 10 else f"{value:.0f}"
