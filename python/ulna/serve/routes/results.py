"""Results of calibrations: the sections of their reports as data."""

from __future__ import annotations

from typing import Literal

import polars as pl
from fastapi import APIRouter, Request

from ulna.calibration.result import Result
from ulna.documents.gather import gather
from ulna.ground.errors import UlnaInputError
from ulna.live.judging import judgement
from ulna.serve.contract import results as wire
from ulna.serve.contract.model import shortened
from ulna.serve.routes.common import Digest, workshop
from ulna.serve.sayings import ending
from ulna.serve.sections import sections
from ulna.serve.texts import length

router = APIRouter(prefix="/results", tags=["results"])
MOST = 200


@router.get("/{sha256}")
def result(request: Request, sha256: Digest, language: Literal["en", "de", "zh"] = "en") -> wire.ResultWhole:
    """One. What is said of readings that were held out is beside it, where a session held some out."""
    path = workshop(request).desk.path(sha256)
    found = Result.load(path)
    content = gather(path, evaluation=judgement(path))
    return wire.ResultWhole(
        sha256=sha256,
        arm=found.arm.name,
        converged=found.fit.converged,
        ending=ending(shortened(found.fit.termination)),
        sections=sections(content, language),
        residuals=_residuals(found.residuals, path.name),
    )


def _residuals(table: pl.DataFrame, name: str) -> list[wire.Residual]:
    for key in ("row", "artefact", "placement"):
        if key not in table.columns or table[key].null_count():
            raise UlnaInputError(
                f"{name}: a reading among its residuals has no '{key}'; expected one. Calibrate again."
            )
    rows = table.sort("norm_mm", descending=True, nulls_last=True).head(MOST).to_dicts()
    return [
        wire.Residual(
            row=row["row"],
            artefact=row["artefact"],
            place=row["placement"],
            feature=row.get("feature") or "",
            off=length(row["norm_mm"]),
            times_scatter=row.get("times_scatter"),
            outlier=bool(row.get("outlier")),
        )
        for row in rows
    ]
