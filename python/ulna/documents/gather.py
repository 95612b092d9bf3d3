"""Gathering what a report says: from a result, the study it was made from, and what else there is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from ulna.calibration.evaluate import study_of_arm
from ulna.calibration.given import ResultLike
from ulna.comparison.compare import compare
from ulna.documents.content.acceptance import verification
from ulna.documents.content.artefacts import artefact_rows
from ulna.documents.content.clouds import clouds
from ulna.documents.content.content import Content
from ulna.documents.content.coverage import coverages
from ulna.documents.content.distribution import samples
from ulna.documents.content.environment import environment
from ulna.documents.content.held_out import held_out
from ulna.documents.content.missing import missing_parts
from ulna.documents.content.model import model
from ulna.documents.content.parameters import observability, parameters
from ulna.documents.content.provenance import provenance
from ulna.documents.content.quality import quality_rows, residual_row
from ulna.documents.content.readings import length_errors, reading_rows
from ulna.documents.content.standing import standing_arm
from ulna.documents.laboratory.file import Laboratory
from ulna.documents.laboratory.issued import Issued
from ulna.documents.sources.cross_validation import CROSS_VALIDATION
from ulna.documents.sources.evaluation import EVALUATION
from ulna.documents.sources.laboratory import LABORATORY
from ulna.documents.sources.result import read_calibration
from ulna.documents.sources.source import Calibration, Source, Taken, take
from ulna.documents.sources.study import find_study
from ulna.documents.sources.verification import VERIFICATION
from ulna.ground.arrays import Progress
from ulna.ground.errors import UlnaInputError
from ulna.study.given import StudyLike

T = TypeVar("T")

_STEPS = 4
"""The result; the study; what it says; what is made of it."""


def gather(
    result: ResultLike,
    study: StudyLike | None = None,
    cross_validation: Path | None = None,
    evaluation: Path | None = None,
    laboratory: Path | None = None,
    verified: Path | Sequence[Path] | None = None,
    progress: Progress | None = None,
    issued: Issued | None = None,
    look: bool = True,
    earlier: ResultLike | None = None,
) -> Content:
    """All that a report of this calibration says. Raises UlnaInputError for files that cannot be used.

    result: a result, a result.json, or the folder with it. study: of that calibration, where the result does not know
    it and its path to it no longer leads there. cross_validation, evaluation: what those commands wrote, for readings
    held out. laboratory: who calibrated for whom, with what. verified: what `ulna verify` wrote, as found and as left
    in one file or in two. progress is called with (stage, done, total). issued: that the certificate was issued, which
    takes a laboratory file and a calibration that converged. look: for a study that nobody named, by its path in the
    result. earlier: a calibration of the same arm, to say what has moved since.
    """

    def at(done: int) -> None:
        if progress is not None:
            progress("gathering", done, _STEPS)

    at(0)
    calibration = read_calibration(result)
    found = calibration.result
    named = _laboratory(laboratory, calibration, issued)
    at(1)
    tested = [take(VERIFICATION, path, calibration) for path in _paths(verified)]
    source = find_study(calibration, study, look)
    at(2)
    left_out = _taken(CROSS_VALIDATION, cross_validation, calibration)
    judged = _taken(EVALUATION, evaluation, calibration)
    rows, said = held_out(found, source.study, left_out, judged)
    study_read = None if source.study is None else study_of_arm(source.study, found.arm)
    over, quiver = ([], None) if study_read is None else clouds(study_read, found.arm, found.residuals)
    readings = reading_rows(found.residuals)
    at(3)
    content = Content(
        arm=found.arm.name,
        joints=found.arm.n,
        probes=list(found.arm.probes),
        model=model(found.arm),
        standing=standing_arm(found.arm, study_read, readings),
        fit=found.fit,
        quality=[*quality_rows("fitted", found.before, found.after), *filter(None, [residual_row(found)]), *rows],
        held_out=said,
        coverage=coverages(found, source.study, left_out, judged),
        readings=readings,
        samples=samples(found.residuals, found.artefacts),
        clouds=over,
        quiver=quiver,
        parameters=parameters(found),
        identification=found.identifiability,
        observability=observability(found),
        lengths=None if source.study is None else length_errors(source.study, found),
        placements=found.artefacts,
        artefacts=artefact_rows(found, source.study),
        environment=environment(found.provenance, source.study),
        outliers=found.outliers,
        extras=found.extras,
        chosen=found.chosen,
        residual_map=found.residual_map,
        moved=None if earlier is None else compare(earlier, result).steps[0],
        verification=verification(tested, None if named is None else named.value.file),
        laboratory=None if named is None else named.value,
        issued=issued,
        missing={},
        provenance=provenance(
            calibration, source.files, [each.file for each in (named, *tested, left_out, judged) if each is not None]
        ),
    )
    return replace(content, missing=missing_parts(content, source.missing, bool(rows)))


def _paths(given: Path | Sequence[Path] | None) -> Sequence[Path]:
    if given is None:
        return ()
    return [given] if isinstance(given, Path) else given


def _laboratory(path: Path | None, calibration: Calibration, issued: Issued | None) -> Taken[Laboratory] | None:
    """As the file has it, or as it was issued."""
    named = _taken(LABORATORY, path, calibration)
    if issued is None:
        return named
    if named is None:
        raise UlnaInputError(
            f"certificate {issued.number}: no laboratory file was given; expected one, as only it says who calibrated "
            "what for whom. Give one."
        )
    if not calibration.result.fit.converged:
        raise UlnaInputError(
            f"certificate {issued.number}: the calibration did not converge ({calibration.result.fit.termination}); "
            "expected one that did. Calibrate again before you certify it."
        )
    return replace(named, value=issued.on(named.value))


def _taken(source: Source[T], path: Path | None, calibration: Calibration) -> Taken[T] | None:
    return None if path is None else take(source, path, calibration)
