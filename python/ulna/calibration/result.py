"""The result of a calibration, in memory and as files: `result.json` (`ulna-result/1`), `arm.toml`, `residuals.csv`."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from ulna.arm.arm import Arm
from ulna.arm.covariance import ParameterCovariance
from ulna.arm.covariance_file import covariance_of_result
from ulna.arm.file import arm_document, arm_toml
from ulna.arm.probes import ProbeView, probe_views
from ulna.calibration.extras import JudgedExtra
from ulna.calibration.identify import Identification
from ulna.calibration.placements import Figures, PlacementFigures
from ulna.calibration.residuals import from_json_rows, json_rows
from ulna.calibration.summary import FitSummary, Parameter
from ulna.formats.output import output_folder
from ulna.formats.toml import check_format, read_json
from ulna.ground.errors import UlnaInputError
from ulna.ground.on_demand import OnDemand

FORMAT = "ulna-result/1"
FILES = ("result.json", "arm.toml", "residuals.csv")


@dataclass
class Result(OnDemand):
    """A calibrated arm and everything that is known about it."""

    arm: Arm
    """The calibrated arm, its `uncertainty` set."""
    parameters: list[Parameter]
    covariance: ParameterCovariance
    identifiability: Identification
    fit: FitSummary
    residuals: pl.DataFrame
    """One row per reading, columns as in `ulna.calibration.residuals.SCHEMA`."""
    artefacts: Sequence[PlacementFigures]
    """What a metrologist reads, of the calibrated arm, from the fitted readings alone."""
    before: Figures
    """The same over all placements, of the arm that the fit started from."""
    after: Figures
    """The same over all placements, of the calibrated arm."""
    provenance: dict[str, Any]
    outliers: list[dict[str, Any]] = field(default_factory=list)
    """Readings far off the rest of their artefact's, the farthest first: see `ulna.calibration.outliers`."""
    extras: list[JudgedExtra] = field(default_factory=list)
    """Blocks beyond geometry, each judged by readings left out."""

    @property
    def probes(self) -> list[ProbeView]:
        """Each probe's tip as x, y, z and as theta0, r, h, with standard uncertainties."""
        return probe_views(self.arm, {row.name: row.status for row in self.parameters}, self.covariance)

    def head(self) -> dict[str, Any]:
        """`result.json` without the residuals: JSON types only, no NaN."""
        return {
            "format": FORMAT,
            "arm": arm_document(self.arm),
            "parameters": [row.as_dict() for row in self.parameters],
            "probes": {view.name: view.as_dict() for view in self.probes},
            "covariance": {"names": self.covariance.names, "matrix": _json_matrix(self.covariance.matrix)},
            "identifiability": self.identifiability.as_dict(),
            "fit": self.fit.as_dict(),
            "outliers": self.outliers,
            "extras": [entry.as_dict() for entry in self.extras],
            "artefacts": [entry.as_dict() for entry in self.artefacts],
            "overall": {"before": self.before, "after": self.after},
            "provenance": self.provenance,
        }

    def write_json(self, write: Any) -> None:
        """Hand `result.json` piece by piece to `write`; memory stays bounded for any number of readings."""
        text = json.dumps(self.head(), indent=1, ensure_ascii=False, allow_nan=False)
        write(text.removesuffix("\n}") + ',\n "residuals": [\n')
        for piece in json_rows(self.residuals):
            write(piece)
        write("\n ]\n}\n")

    def save(self, folder: str | Path, force: bool = False) -> None:
        """Write `result.json`, `arm.toml` and `residuals.csv` into a folder: all of them or none.

        Raises UlnaInputError where one of them exists and `force` is not given, or the folder cannot be written.
        """
        with output_folder(folder, FILES, force) as staging:
            with (staging / "result.json").open("w", encoding="utf-8") as file:
                self.write_json(file.write)
            (staging / "arm.toml").write_text(arm_toml(self.arm), encoding="utf-8")
            self.residuals.write_csv(staging / "residuals.csv")

    @classmethod
    def load(cls, path: str | Path) -> Result:
        """Read a `result.json`, or the one in a folder. Raises UlnaInputError."""
        path = Path(path)
        path = path / "result.json" if path.is_dir() else path
        document, _ = read_json(path, "a result.json")
        check_format(document, path, "ulna-result")
        arm = Arm.of_result(document, path)
        try:
            return cls(
                arm=arm,
                parameters=[Parameter(**entry) for entry in document["parameters"]],
                covariance=covariance_of_result(document, arm, path),
                identifiability=Identification.from_dict(document["identifiability"]),
                fit=FitSummary.from_dict(document["fit"]),
                residuals=from_json_rows(document["residuals"]),
                artefacts=[PlacementFigures.from_dict(entry) for entry in document["artefacts"]],
                before=document["overall"]["before"],
                after=document["overall"]["after"],
                provenance=document["provenance"],
                outliers=document.get("outliers", []),
                extras=[JudgedExtra(**entry) for entry in document.get("extras", [])],
            )
        except (KeyError, TypeError, ValueError, OverflowError, pl.exceptions.PolarsError) as error:
            raise UlnaInputError(
                f"{path}: not as {FORMAT} says ({type(error).__name__}: {error}); expected the file as `ulna "
                "calibrate` wrote it. Calibrate again."
            ) from None


def _json_matrix(matrix: Any) -> list[list[float | None]]:
    """JSON knows no NaN: null stands for what is not known."""
    return [[value if math.isfinite(value) else None for value in row] for row in np.asarray(matrix).tolist()]
