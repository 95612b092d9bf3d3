"""What has moved between calibrations, as `ulna compare` finds it."""

from __future__ import annotations

import dataclasses
from itertools import pairwise

from fastapi import APIRouter, Request

from ulna.calibration.result import Result
from ulna.comparison import compare as rooms
from ulna.documents.languages.words import Words
from ulna.documents.sections.moved import step_blocks
from ulna.ground.errors import UlnaInputError
from ulna.serve.contract import compare as wire
from ulna.serve.routes.common import records, workshop
from ulna.serve.sections import blocks_said
from ulna.serve.texts import length, valued
from ulna.serve.workshop import Workshop

router = APIRouter(tags=["results"])


@router.post("/compare")
def compare(request: Request, asked: wire.CompareAsked) -> wire.Compared:
    """Each with the next: what it does to lengths, whether uncertainties explain it, which parameters it is."""
    here = workshop(request)
    if (asked.results is None) == (asked.arm is None):
        raise UlnaInputError("compare: expected results of the desk, or an arm of the record. Name one of them.")
    if asked.arm is not None:
        found = records(request).compare(asked.arm, asked.last, asked.probe, asked.shared_u)
    else:
        found = _of_desk(here, asked.results or [], asked)
    words = Words(asked.language)
    return wire.Compared(steps=[_step(each, words) for each in found.steps])


def _of_desk(here: Workshop, digests: list[str], asked: wire.CompareAsked) -> rooms.Comparison:
    results = [Result.load(here.desk.path(each)) for each in digests]
    found = rooms.compare(*results, probe=asked.probe, shared_u=asked.shared_u)
    names = [
        ", ".join(part for part in (_day(result), digest[:8]) if part)
        for result, digest in zip(results, digests, strict=True)
    ]
    steps = zip(found.steps, pairwise(names), strict=True)
    return dataclasses.replace(
        found, steps=[dataclasses.replace(step, before=one, after=other) for step, (one, other) in steps]
    )


def _day(result: Result) -> str:
    return str(result.provenance.get("time", ""))[:10]


def _step(found: rooms.Compared, words: Words) -> wire.Step:
    return wire.Step(
        before=found.before,
        after=found.after,
        moved=found.moved,
        p_value=found.p_value,
        p_of_largest=found.p_of_largest,
        chi2=found.chi2,
        rank=found.rank,
        not_determined=found.not_determined,
        bands=[_band(each) for each in found.bands],
        parameters=[
            wire.MovedParameter(
                name=each.name, change=valued(each.delta, each.unit, each.u), ratio=abs(each.delta) / each.u
            )
            for each in found.parameters
        ],
        between=found.between,
        blocks=blocks_said(step_blocks(found, words)),
    )


def _band(found: rooms.Band) -> wire.Band:
    x, y, z = found.at_mm
    return wire.Band(
        least_mm=found.least_mm,
        most_mm=found.most_mm,
        count=found.count,
        rms=length(found.rms_mm),
        largest=valued(found.largest_mm, "mm", found.u_mm, found.expanded_mm),
        length_mm=found.length_mm,
        at_mm=(x, y, z),
        en=found.en,
    )
