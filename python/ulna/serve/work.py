"""What each kind of job does: a row a kind."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from ulna.arm.given import as_arm
from ulna.calibration.calibrate import calibrate
from ulna.documents.certificate import certificate
from ulna.documents.gather import gather
from ulna.documents.write import NEEDS, write_report
from ulna.formats.output import write_file
from ulna.ground.errors import UlnaInputError
from ulna.ground.extras import need
from ulna.ground.worded import worded
from ulna.live.judging import judgement
from ulna.planning.file import load_plan_spec
from ulna.planning.folder import NEEDS_PICTURES, STUDY, TABLE, WORK_SHEET
from ulna.planning.plan import plan
from ulna.planning.planned import ARM, PLAN
from ulna.serve.beside import together, usable
from ulna.serve.contract.jobs import (
    BeginCalibrate,
    BeginCertificate,
    BeginCheck,
    BeginJob,
    BeginPlan,
    BeginReport,
    BeginVerify,
)
from ulna.serve.issuing import ENDINGS
from ulna.serve.jobs import Made, Planned, Progress
from ulna.serve.remarks import remarks
from ulna.serve.sayings import not_converged
from ulna.serve.tested import check_work, verify_work
from ulna.serve.workshop import Workshop
from ulna.study.study import Study


def _calibrate(asked: BeginCalibrate, workshop: Workshop, folder: Path) -> Planned:
    study = together(workshop.desk, folder, asked.study, asked.beside)

    def work(progress: Progress) -> Made:
        with remarks() as said:
            loaded = Study.load(study)
        found = calibrate(loaded, progress)
        found.save(folder / "result")
        if not found.fit.converged:
            said = [not_converged(found.fit.termination), *said]
        return Made([("result", folder / "result" / "result.json")], said)

    return worded("calibrate {file}", file=study.name), work


def _report(asked: BeginReport, workshop: Workshop, folder: Path) -> Planned:
    result = workshop.desk.path(asked.result)

    def work(progress: Progress) -> Made:
        content = gather(result, evaluation=judgement(result), progress=progress)
        folder.mkdir(parents=True, exist_ok=True)
        path = folder / "report.html"
        write_report(content, {"html": path}, asked.language, [result], False)
        return Made([("report", path)])

    return worded("report of {file}", file=result.name), work


def _plan(asked: BeginPlan, workshop: Workshop, folder: Path) -> Planned:
    need(NEEDS_PICTURES, "matplotlib", "typst", "fontTools")
    arm, path = as_arm(workshop.desk.path(asked.arm)), usable(workshop.desk, asked.plan)
    spec = load_plan_spec(path, arm)
    if asked.anywhere:
        spec = replace(spec, within=None)

    def work(progress: Progress) -> Made:
        from ulna.documents.work_sheet.sheet import check_paper, work_sheet

        check_paper(arm, spec, asked.language, None)
        found = plan(arm, spec, progress)
        found.save(folder, False, {WORK_SHEET: work_sheet(found, asked.language)})
        names = {"planned": PLAN, "study": STUDY, "arm": ARM, "table": TABLE, "work-sheet": WORK_SHEET}
        return Made([(role, folder / name) for role, name in names.items()])

    return worded("plan {file}", file=path.name), work


def _certificate(asked: BeginCertificate, workshop: Workshop, folder: Path) -> Planned:
    if asked.form == "pdf":
        need("option --pdf", *NEEDS["pdf"])
    elif asked.annex:
        raise UlnaInputError("annex: is of a PDF; expected form pdf. Leave it out.")
    laboratory = together(workshop.desk, folder, asked.laboratory, asked.beside)
    result = workshop.desk.path(asked.result)
    tests = [workshop.desk.path(each) for each in asked.verification]

    def work(progress: Progress) -> Made:
        progress("certificate", 0, 1)
        more = {"language": asked.language, "annex": asked.annex} if asked.form == "pdf" else {}
        made = certificate(result, laboratory, tests, form=asked.form, **more)  # type: ignore[arg-type]
        path = folder / f"draft.{ENDINGS[asked.form]}"
        write_file(path, made)
        return Made([("certificate", path)])

    return worded("draft of a certificate of {file}", file=result.name), work


WORKS: dict[type, Callable[[Any, Workshop, Path], Planned]] = {
    BeginCalibrate: _calibrate,
    BeginReport: _report,
    BeginPlan: _plan,
    BeginCheck: check_work,
    BeginVerify: verify_work,
    BeginCertificate: _certificate,
}
"""What was asked → how it is done."""


def planned(asked: BeginJob, workshop: Workshop, folder: Path) -> Planned:
    """Raises UlnaInputError for what is not on the desk."""
    return WORKS[type(asked)](asked, workshop, folder)
