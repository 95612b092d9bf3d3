"""Gathering what a report says: from a result, the study it was made from, and what else there is."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from ulna.artefacts.artefact import Artefact
from ulna.calibration.evaluate import study_of_arm
from ulna.calibration.result import Result
from ulna.documents.acceptance import verification
from ulna.documents.clouds import clouds
from ulna.documents.content import (
    ArtefactRow,
    Cloud,
    Content,
    Environment,
    Lengths,
    Parameters,
    Provenance,
    QualityRow,
    Quiver,
    ReadFile,
    ReadingRows,
    Said,
)
from ulna.documents.distribution import samples
from ulna.documents.laboratory.file import load_laboratory
from ulna.documents.parameters import observability, parameters
from ulna.documents.quality import held_out, quality_rows, residual_row
from ulna.documents.source import find_study
from ulna.formats.toml import read_bytes, sha256
from ulna.study.study import Study

Progress = Callable[[str, int, int], None]

_STEPS = 4
"""The result; the study; what it says; what is made of it."""


def gather(
    result: Path,
    study: Path | None = None,
    cross_validation: Path | None = None,
    evaluation: Path | None = None,
    laboratory: Path | None = None,
    verified: Path | None = None,
    progress: Progress | None = None,
) -> Content:
    """All that a report of this calibration says. Raises UlnaInputError for files that cannot be used.

    result: a result.json, or the folder with it. study: of that calibration, where the result's own path to it no
    longer leads there. cross_validation, evaluation: what those commands wrote, for readings held out. laboratory: who
    calibrated for whom, with what. verified: what `ulna verify` wrote.
    progress is called with (stage, done, total).
    """

    def at(done: int) -> None:
        if progress is not None:
            progress("gathering", done, _STEPS)

    at(0)
    named = None if laboratory is None else load_laboratory(laboratory)
    path = result / "result.json" if result.is_dir() else result
    found = Result.load(path)
    at(1)
    digest = sha256(read_bytes(path, "a result.json"))
    test = None if verified is None else verification(verified, found, path, digest)
    source, files, no_study = find_study(found, path, study)
    at(2)
    rows, said, beside = held_out(found, source, cross_validation, evaluation)
    missing = {} if no_study is None else {"study": no_study}
    over: list[Cloud] = []
    quiver: Quiver | None = None
    lengths: Lengths | None = None
    if source is not None:
        fitted = study_of_arm(source, found.arm)
        over, quiver = clouds(fitted, found.arm, found.residuals)
        lengths = _lengths(source, found)
    if test is None:
        missing["verification"] = Said("missing.verification")
    if named is None:
        missing["laboratory"] = Said("missing.laboratory")
    at(3)
    known = parameters(found)
    missing |= _missing(found, known, source, over, quiver, lengths, rows)
    made = found.provenance
    return Content(
        arm=found.arm.name,
        joints=found.arm.n,
        probes=list(found.arm.probes),
        fit=found.fit,
        quality=[*quality_rows("fitted", found.before, found.after), *filter(None, [residual_row(found)]), *rows],
        held_out=said,
        readings=_reading_rows(found.residuals),
        samples=samples(found.residuals, found.artefacts),
        clouds=over,
        quiver=quiver,
        parameters=known,
        identification=found.identifiability,
        observability=observability(found),
        lengths=lengths,
        placements=found.artefacts,
        artefacts=_artefacts(found, source),
        environment=_environment(made, source),
        outliers=found.outliers,
        extras=found.extras,
        verification=test,
        laboratory=named,
        missing=missing,
        provenance=Provenance(
            program=str(made.get("program", "ulna")),
            version=str(made.get("version", "")),
            time=str(made.get("time", "")),
            seed=int(made.get("seed", 0)),
            study=made.get("study"),
            result=path.name,
            result_sha256=digest,
            files=files,
            beside=[
                *([] if named is None else [ReadFile(named.path.name, named.sha256)]),
                *([] if test is None else [ReadFile(test.name, test.sha256)]),
                *beside,
            ],
            options=dict(made.get("options", {})),
            warnings=[str(text) for text in made.get("warnings", [])],
        ),
    )


def _missing(
    result: Result,
    known: Parameters,
    study: Study | None,
    over: Sequence[Cloud],
    quiver: Quiver | None,
    lengths: Lengths | None,
    held: Sequence[QualityRow],
) -> dict[str, Said]:
    """What a section lacks, and what would be needed."""
    missing: dict[str, Said] = {}
    if not held:
        missing["held-out"] = Said("held-out.none")
    if study is not None:
        kinds = {cloud.over for cloud in over}
        if "joint" not in kinds:
            missing["joint"] = Said("missing.joint")
        if "temperature" not in kinds:
            missing["temperature"] = Said("missing.temperature")
        if lengths is None:
            missing["lengths"] = Said("missing.lengths")
        if quiver is None:
            missing["quiver"] = Said("missing.quiver")
    if not known.correlation_names:
        missing["correlation"] = Said("missing.correlation")
    if observability(result) is None:
        missing["observability"] = Said("missing.observability")
    return missing


def _reading_rows(residuals: pl.DataFrame) -> ReadingRows:
    return ReadingRows(
        row=residuals["row"].to_numpy(),
        file=residuals["file"].to_list(),
        artefact=residuals["artefact"].to_list(),
        placement=residuals["placement"].to_list(),
        size_mm=residuals["norm_mm"].to_numpy(),
        outlier=residuals["outlier"].fill_null(False).to_numpy(),
    )


def _lengths(study: Study, result: Result) -> Lengths | None:
    """Of length rows each, of bars the mean of each placement; None where no length was measured."""
    length_mm, error_mm = [], []
    first = 0
    for group in study.readings:
        rows = result.residuals[first : first + len(group)]
        first += len(group)
        if group.length_mm is not None:
            length_mm.append(group.length_mm)
            error_mm.append(rows["length_mm"].to_numpy())
        elif group.artefact.length_mm is not None:
            own = [entry for entry in result.artefacts if entry.artefact == group.artefact.name]
            errors = [each for each in (entry.figures.get("length_error_mean_mm") for entry in own) if each is not None]
            length_mm.append(np.full(len(errors), group.artefact.length_mm))
            error_mm.append(np.array(errors))
    if not length_mm:
        return None
    return Lengths(np.concatenate(length_mm), np.concatenate(error_mm))


def _artefacts(result: Result, study: Study | None) -> list[ArtefactRow]:
    known = {} if study is None else {group.artefact.name: group.artefact for group in study.readings}
    rows = []
    for name in dict.fromkeys(entry.artefact for entry in result.artefacts):
        own = [entry for entry in result.artefacts if entry.artefact == name]
        artefact = known.get(name)
        dimension, value = _dimension(artefact)
        u = None
        if artefact is not None:
            u = max(artefact.feature_u_mm) if artefact.feature_u_mm else artefact.u_mm
        rows.append(
            ArtefactRow(
                name=name,
                kind=own[0].kind,
                placements=len(own),
                readings=sum(entry.readings for entry in own),
                dimension=dimension,
                value_mm=value,
                features=0 if artefact is None else len(artefact.features),
                u_mm=u,
                frame="free" if artefact is None else artefact.frame,
            )
        )
    return rows


def _dimension(artefact: Artefact | None) -> tuple[str | None, float | None]:
    if artefact is None:
        return None, None
    if artefact.length_mm is not None:
        return "length", artefact.length_mm
    if artefact.diameter_mm is not None:
        return "diameter", artefact.diameter_mm
    return {"points": "features", "length": "lengths"}.get(artefact.kind), None


def _environment(made: dict[str, Any], study: Study | None) -> Environment:
    noise = made.get("noise") or {}
    warm = [] if study is None else [group.temperature_c for group in study.readings if group.temperature_c is not None]
    known = np.concatenate([each[np.isfinite(each)] for each in warm]) if warm else np.zeros(0)
    spread = (float(known.min()), float(known.mean()), float(known.max())) if len(known) else None
    return Environment(spread, noise.get("encoder_rad"), noise.get("seat_mm"))
