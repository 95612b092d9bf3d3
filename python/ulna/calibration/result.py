"""The result of a calibration, in memory and as files: `result.json` (`ulna-result/1`), `arm.toml`, residuals."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
import polars as pl

from ulna.arm.arm import Arm
from ulna.arm.covariance import ParameterCovariance
from ulna.arm.covariance_file import covariance_of_result
from ulna.arm.file import arm_document, arm_toml
from ulna.arm.given import StandsForArm
from ulna.arm.probes import ProbeView, probe_views
from ulna.arm.reading_noise import ReadingNoise, noise_of
from ulna.calibration.about import about_result
from ulna.calibration.choosing.tried import ChosenModel
from ulna.calibration.extras import JudgedExtra
from ulna.calibration.identify import Identification
from ulna.calibration.placements import SCHEMA as PLACEMENT_SCHEMA
from ulna.calibration.placements import FigureEntry, Figures, PlacementFigures, Placements, figures_of
from ulna.calibration.plots import Plots
from ulna.calibration.poses import PlacementPose
from ulna.calibration.residual_map import ResidualMap
from ulna.calibration.residuals import SCHEMA, from_json_rows, json_rows
from ulna.calibration.summary import FitSummary, Parameter
from ulna.formats.for_sheets import for_sheets
from ulna.formats.models import fill_json
from ulna.formats.output import output_folder
from ulna.formats.toml import check_format, read_json
from ulna.ground.errors import UlnaInputError
from ulna.ground.extras import need
from ulna.ground.on_demand import OnDemand
from ulna.ground.provided import provided
from ulna.ground.shown import About, Shown
from ulna.study.given import StandsForStudy
from ulna.study.study import Study

if TYPE_CHECKING:
    from ulna.calibration.result_file import ResultFile

# The files' models are loaded where there is a file: making them takes longer than many a fit.

FORMAT: Literal["ulna-result/1"] = "ulna-result/1"
MANY_ROWS = 20_000
"""A list of more entries than this leaves `result.json`: some 5 MB of text, which nobody reads."""

RESIDUALS, PLACEMENTS = "residuals.parquet", "artefacts.parquet"
FILES = ("result.json", "arm.toml", "residuals.csv", RESIDUALS, PLACEMENTS)
"""All that a result may be written to."""

AS_THEY_STAND = ("parameters", "identifiability", "fit", "extras", "chosen", "residual_map", "placements")
"""Fields that are the same in the file and in memory."""


@dataclass(repr=False)
class Result(OnDemand, Shown, StandsForArm, StandsForStudy):
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
    without_far_off: Figures | None = field(default_factory=lambda: None)  # no class attribute: made on demand
    """As `after`, without the readings that are far off; None where there are none, or no loss let them count less."""
    placements: Sequence[PlacementPose] = field(default_factory=list)
    """Where each standing of an artefact with features was found, in the arm's base frame, with uncertainties."""
    outliers: list[dict[str, Any]] = field(default_factory=list)
    """Readings far off the rest of their artefact's, the farthest first: see `ulna.calibration.outliers`."""
    extras: list[JudgedExtra] = field(default_factory=list)
    """Blocks beyond geometry, each judged by readings left out."""
    chosen: ChosenModel | None = field(default_factory=lambda: None)  # no class attribute: made on demand
    """With `extras = "auto"`: which model was chosen, and all that was tried."""
    residual_map: ResidualMap | None = field(default_factory=lambda: None)  # no class attribute: made on demand
    """With `judge`: whether residuals still follow the turn of a joint."""
    study: Study | None = field(default_factory=lambda: None, compare=False)  # made on demand, so no class has one
    """What it was made of; None of a result that was read from a file, or sent to another process."""

    def __getstate__(self) -> dict[str, Any]:
        return super().__getstate__() | {"study": None}

    @property
    def noise(self) -> ReadingNoise:
        """How its readings scatter: as the study stated it, and as the residuals show it."""
        shown = self.fit.reading_scatter
        stated, freedom = self.provenance.get("noise"), self.fit.degrees_of_freedom
        return noise_of(stated, asdict(shown) if shown else None, self.arm, Path("result"), freedom)

    def its_study(self) -> Study:
        """What it was made of. Raises UlnaInputError of a result that was read from a file."""
        if self.study is None:
            name = self.provenance.get("study") or "the study that it was made of"
            raise UlnaInputError(
                f"a result of '{self.arm.name}' that was read from a file has no readings; expected a study. Name "
                f"{name}."
            )
        return self.study

    @property
    def plot(self) -> Plots:
        """Its drawings, those of the report: `result.plot.residuals()`, `.parameters()`, `.joint(3)`, … Raises
        UlnaInputError where Matplotlib is not installed."""
        need("result.plot", "matplotlib")
        plots: Plots = provided("plots of a result")(self)
        return plots

    def about(self) -> About:
        """Before and after, the parameters, what was not determined."""
        figures = self.before, self.after
        return about_result(self.arm, self.fit, figures, self.parameters, self.identifiability, len(self.outliers))

    @property
    def probes(self) -> list[ProbeView]:
        """Each probe's tip as x, y, z and as theta0, r, h, with standard uncertainties."""
        return probe_views(self.arm, {row.name: row.status for row in self.parameters}, self.covariance)

    def file(self) -> ResultFile:
        """`result.json` as its model, its arm and residuals aside."""
        from ulna.calibration.result_file import (
            CovarianceEntry,
            OutlierEntry,
            OverallEntry,
            ProvenanceEntry,
            ResultFile,
        )

        return ResultFile.model_construct(
            format=FORMAT,
            parameters=self.parameters,
            probes={view.name: view.as_dict() for view in self.probes},
            covariance=CovarianceEntry.model_construct(
                names=self.covariance.names, matrix=_json_matrix(self.covariance.matrix)
            ),
            identifiability=self.identifiability,
            fit=self.fit,
            outliers=[OutlierEntry.model_construct(None, **entry) for entry in self.outliers],
            extras=self.extras,
            chosen=self.chosen,
            residual_map=self.residual_map,
            artefacts=[entry.entry() for entry in self.artefacts],
            placements=list(self.placements),
            overall=OverallEntry.model_construct(
                before=FigureEntry.model_construct(None, **self.before),
                after=FigureEntry.model_construct(None, **self.after),
                without_far_off=_entry(self.without_far_off),
            ),
            provenance=ProvenanceEntry.model_construct(None, **self.provenance),
        )

    def write_json(self, write: Callable[[str], Any]) -> None:
        """Hand `result.json` piece by piece to `write`, every list in it."""
        _write(self, self.file(), write, residuals=True)

    def save(self, folder: str | Path, force: bool = False) -> None:
        """Write `result.json`, `arm.toml` and `residuals.csv` into a folder: all of them or none.

        Of more than `MANY_ROWS` readings the residuals go to `residuals.parquet` instead, of as many placements their
        figures to `artefacts.parquet`; `result.json` names both.

        Raises UlnaInputError where one of them exists and `force` is not given, or the folder cannot be written.
        """
        from ulna.calibration.beside import write_beside

        many = len(self.residuals) > MANY_ROWS
        many_placements = len(self.artefacts) > MANY_ROWS
        written = ["result.json", "arm.toml", RESIDUALS if many else "residuals.csv"]
        written += [PLACEMENTS] if many_placements else []
        with output_folder(folder, written, force, instead_of=[name for name in FILES if name not in written]) as here:
            file = dataclasses.replace(self, artefacts=[], placements=[]).file() if many_placements else self.file()
            if many_placements:
                file.artefacts_file = write_beside(Placements.of(self.artefacts).table, here / PLACEMENTS)
            if many:
                file.residuals_file = write_beside(self.residuals, here / RESIDUALS)
            else:
                for_sheets(self.residuals).write_csv(here / "residuals.csv")
            with (here / "result.json").open("w", encoding="utf-8") as stream:
                _write(self, file, stream.write, residuals=not many)
            (here / "arm.toml").write_text(arm_toml(self.arm), encoding="utf-8")

    @classmethod
    def load(cls, path: str | Path) -> Result:
        """Read a `result.json`, or the one in a folder. Tables beside it are read when they are asked for. Raises
        UlnaInputError."""
        from ulna.calibration.result_file import ResultFile

        path = Path(path)
        path = path / "result.json" if path.is_dir() else path
        document, _ = read_json(path, "a result.json")
        check_format(document, path, "ulna-result")
        arm = Arm.of_result(document, path)
        covariance = covariance_of_result(document, arm, path)
        rows = document.pop("residuals", None)  # very many: checked as columns
        try:
            file = fill_json(ResultFile, document, path)
        except UlnaInputError as error:
            raise UlnaInputError(f"{error} The file was changed or damaged: calibrate again.") from None
        return cls.on_demand(
            {name: partial(lambda value: value, getattr(file, name)) for name in AS_THEY_STAND}
            | {
                "arm": lambda: arm,
                "covariance": lambda: covariance,
                "outliers": lambda: document.get("outliers", []),
                "provenance": lambda: document["provenance"],
                "before": lambda: figures_of(file.overall.before),
                "after": lambda: figures_of(file.overall.after),
                "without_far_off": lambda: _figures(file.overall.without_far_off),
                "artefacts": lambda: _placements(file, path),
                "study": lambda: None,
                "residuals": _residuals(file, rows, path),
            }
        )


def _entry(figures: Figures | None) -> FigureEntry | None:
    return None if figures is None else FigureEntry.model_construct(None, **figures)


def _figures(entry: FigureEntry | None) -> Figures | None:
    return None if entry is None else figures_of(entry)


def _placements(file: ResultFile, path: Path) -> Sequence[PlacementFigures]:
    from ulna.calibration.beside import read_beside

    if file.artefacts_file is not None:
        return Placements(read_beside(file.artefacts_file, path, PLACEMENT_SCHEMA))
    return [PlacementFigures.of_entry(entry) for entry in file.artefacts]


def _residuals(file: ResultFile, rows: Any, path: Path) -> Callable[[], pl.DataFrame]:
    """The table; what stands in the file itself is looked at now. Raises UlnaInputError."""
    from ulna.calibration.beside import read_beside

    beside = file.residuals_file
    if beside is not None:
        return lambda: read_beside(beside, path, SCHEMA)
    if not isinstance(rows, list):
        raise UlnaInputError(f"{path}: key 'residuals': expected a list of readings' residuals. Calibrate again.")
    try:
        table = from_json_rows(rows)
    except (TypeError, ValueError, OverflowError, pl.exceptions.PolarsError) as error:
        raise UlnaInputError(
            f"{path}: key 'residuals': not as {FORMAT} says ({type(error).__name__}: {error}). Calibrate again."
        ) from None
    return lambda: table


def _write(result: Result, file: ResultFile, write: Callable[[str], Any], residuals: bool) -> None:
    """The document in pieces: memory stays bounded for any number of residuals."""
    document: dict[str, Any] = {"format": FORMAT, "arm": arm_document(result.arm)}
    document |= file.model_dump(mode="json", exclude_unset=True)
    # what is not known is left out, as the format always had it
    document["parameters"] = [
        {key: value for key, value in row.items() if (key, value) != ("prior", None)} for row in document["parameters"]
    ]
    if document["fit"]["chi2_per_dof"] is None:
        del document["fit"]["chi2_per_dof"]
    text = json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False)
    if not residuals:
        write(text + "\n")
        return
    write(text.removesuffix("\n}") + ',\n "residuals": [\n')
    for piece in json_rows(result.residuals):
        write(piece)
    write("\n ]\n}\n")


def _json_matrix(matrix: Any) -> list[list[float | None]]:
    """JSON knows no NaN: null stands for what is not known."""
    return [[value if math.isfinite(value) else None for value in row] for row in np.asarray(matrix).tolist()]
