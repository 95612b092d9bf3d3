"""A calibration: how the fit ended, its parameters, its figures before and after."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from ulna.calibration.result import Result
from ulna.formats.toml import read_json
from ulna.records.acts.act import Row
from ulna.records.filed.kind import About, FiledKind, Read, figures_mm
from ulna.records.tables import CALIBRATION, PARAMETER


class ResultKind(FiledKind):
    """`ulna-result/1`."""

    name = "calibration"
    format = "ulna-result"

    def read(self, path: Path) -> Read:
        """Tables beside it belong to it."""
        result = Result.load(path)
        document, _ = read_json(path, "a result.json")
        tables = [document.get(key) for key in ("residuals_file", "artefacts_file")]
        # only whoever asks for residuals reads their table: now, so that no other file is kept in its place
        _ = result.residuals
        beside = {table["file"]: path.parent / table["file"] for table in tables if table}
        return Read(result.arm.name, result.provenance.get("time"), beside)

    def rows(self, content: bytes, about: About) -> Iterator[Row]:
        """One calibration, its parameters, and the figures of the arm that it began from and of the one that it
        found."""
        document = json.loads(content)
        fit = document["fit"]
        common = {"arm": about.arm, "sha256": about.sha256, "at": about.at}
        yield (
            CALIBRATION,
            {
                **common,
                "termination": fit["termination"],
                "converged": fit["converged"],
                "cost": fit.get("cost"),
                "degrees_of_freedom": fit.get("degrees_of_freedom"),
                "version": document["provenance"].get("version"),
            },
        )
        for row in document["parameters"]:
            yield PARAMETER, {**common, **{key: row.get(key) for key in ("name", "unit", "status", "value", "u")}}
        yield from figures_mm(about, self.name, "before", document["overall"]["before"])
        yield from figures_mm(about, self.name, "after", document["overall"]["after"])
