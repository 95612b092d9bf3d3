"""The rerun as it is shown and kept: tables, JSON, pictures."""

from __future__ import annotations

import dataclasses
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import RenderableType

from ulna.formats.output import output_folder
from ulna.ground.extras import need
from ulna.reproduce.cheng2011.findings import Findings
from ulna.reproduce.cheng2011.tables import tables
from ulna.reproduce.claims import FORMAT
from ulna.reproduce.kept import table_files, write_tables

FILES = ("cheng2011.json", *(f"{name}.{form}" for name in ("bars", "convergence") for form in ("svg", "png", "pdf")))


@dataclass(frozen=True)
class Rerun(Findings):
    """All parts of the rerun, to be shown and kept."""

    def table(self) -> RenderableType:
        """The paper's numbers beside ours, then the parameters of the virtual experiment; 80 columns."""
        return tables(self)

    def as_dict(self) -> dict[str, Any]:
        """`cheng2011.json`: JSON types only."""
        return {
            "format": FORMAT,
            "study": "cheng2011",
            "agrees": self.agrees,
            "claims": [dataclasses.asdict(claim) for claim in self.claims()],
            "simulation": [dataclasses.asdict(part) for part in self.simulation],
            "convergence": [dataclasses.asdict(part) for part in self.convergence],
            "experiment": dataclasses.asdict(self.experiment),
            "repeated": dataclasses.asdict(self.repeated),
        }

    def save(self, folder: Path, force: bool = False) -> None:
        """Write pictures (SVG, PNG and PDF), tables (CSV and LaTeX) and `cheng2011.json` into a folder, all or none.
        Raises UlnaInputError."""
        need("the pictures of a rerun", "matplotlib")
        from ulna.reproduce.cheng2011.plots import draw_bars, draw_convergence

        shown = self.table()
        with output_folder(folder, (*FILES, *table_files(shown)), force) as staging:
            write_tables(shown, staging)
            text = json.dumps(self.as_dict(), indent=1, ensure_ascii=False, allow_nan=False)
            (staging / FILES[0]).write_text(text + "\n", encoding="utf-8")
            draw_bars(self.experiment, staging)
            draw_convergence(self.convergence, staging)
