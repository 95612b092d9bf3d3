"""All ways on the same two arms: one table, one picture."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.console import RenderableType

from ulna.formats.output import output_folder
from ulna.ground.arrays import Progress
from ulna.ground.extras import need
from ulna.reproduce.claims import FORMAT
from ulna.reproduce.kept import table_files, write_tables
from ulna.reproduce.ways import cheng2010, gao2009, readings, santolaria2010, shimojima2002, wang2007, wang2010
from ulna.reproduce.ways.outcome import Outcome, Way, outcomes_of
from ulna.reproduce.ways.trial import Trial, start_of
from ulna.reproduce.ways.work import REPEATS, outcome_dicts, outcomes_table, write_json
from ulna.simulation.virtual_arm import VirtualArm

WORKS = (shimojima2002, santolaria2010, wang2007, gao2009, wang2010, cheng2010)

FILES = ("all.json", "ways.svg", "ways.png", "ways.pdf")


def _nothing(truth: VirtualArm, seed: int) -> Trial:
    """The true arm itself: what noise alone leaves."""
    untouched = readings.bars(truth, seed).select(np.zeros(0, np.int64))
    return Trial(truth, start_of(truth, seed), untouched, truth.arm, 0.0, None)


TRUE_ARM = Way("the true arm", places=0, carry_out=_nothing)


@dataclass(frozen=True)
class Comparison:
    """What every way gave."""

    outcomes: list[Outcome]

    @property
    def agrees(self) -> bool:
        """Nothing is claimed here."""
        return True

    def table(self) -> RenderableType:
        """80 columns."""
        return outcomes_table(self.outcomes)

    def as_dict(self) -> dict[str, Any]:
        """`all.json`: JSON types only."""
        return {"format": FORMAT, "study": "all", "agrees": True, "outcomes": outcome_dicts(self.outcomes)}

    def save(self, folder: Path, force: bool = False) -> None:
        """Write `all.json`, the tables (CSV and LaTeX) and the picture (SVG, PNG and PDF) into a folder, all or none.
        Raises UlnaInputError."""
        need("the picture of all ways", "matplotlib")
        from ulna.reproduce.ways.plot import draw_ways

        shown = self.table()
        with output_folder(folder, (*FILES, *table_files(shown)), force) as staging:
            write_tables(shown, staging)
            write_json(staging / FILES[0], self.as_dict())
            draw_ways(self.outcomes, staging)


def all_ways() -> tuple[Way, ...]:
    """Each way once, in the order of the works, after the true arm."""
    ways = [TRUE_ARM, *(way for work in WORKS for way in work.WORK.ways)]
    return tuple(dict.fromkeys(ways))


def run(out: Path | None, progress: Progress | None, *, repeats: int = REPEATS, force: bool = True) -> Comparison:
    """Carry out every way: see `ulna.cli.reproduce.ReproductionModule`."""
    if out is not None:
        need("the picture of all ways", "matplotlib")
    found = Comparison(outcomes_of(all_ways(), repeats, progress))
    if out is not None:
        found.save(out, force=force)
    return found
