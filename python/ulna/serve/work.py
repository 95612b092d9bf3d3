"""What each kind of job does: a row a kind."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ulna.calibration.calibrate import calibrate
from ulna.documents.gather import gather
from ulna.documents.write import write_report
from ulna.live.judging import FOLDER
from ulna.serve.contract.jobs import BeginCalibrate, BeginJob, BeginReport
from ulna.serve.jobs import Made, Progress
from ulna.serve.workshop import Workshop
from ulna.study.study import Study

Planned = tuple[str, Callable[[Progress], Made]]
"""A title, and the work."""


def _calibrate(asked: BeginCalibrate, workshop: Workshop, folder: Path) -> Planned:
    study = workshop.desk.path(asked.study)

    def work(progress: Progress) -> Made:
        calibrate(Study.load(study), progress).save(folder / "result")
        return [("result", folder / "result" / "result.json")]

    return f"calibrate {study.name}", work


def _report(asked: BeginReport, workshop: Workshop, folder: Path) -> Planned:
    result = workshop.desk.path(asked.result)
    evaluation = result.parent.parent / FOLDER / "evaluation.json"

    def work(progress: Progress) -> Made:
        content = gather(result, evaluation=evaluation if evaluation.is_file() else None, progress=progress)
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / "report.html"
        write_report(content, {"html": path}, asked.language, [result], False)
        return [("report", path)]

    return f"report of {result.name}", work


WORKS: dict[type, Callable[[Any, Workshop, Path], Planned]] = {BeginCalibrate: _calibrate, BeginReport: _report}
"""What was asked → how it is done."""


def planned(asked: BeginJob, workshop: Workshop, folder: Path) -> Planned:
    """Raises UlnaInputError for what is not on the desk."""
    return WORKS[type(asked)](asked, workshop, folder)
