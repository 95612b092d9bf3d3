"""What stands on paper, in which order, and under which headings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ulna.documents.content.content import Content
from ulna.documents.languages.text import Text
from ulna.documents.languages.words import Words
from ulna.documents.sections import artefacts as touched
from ulna.documents.sections import (
    blocks,
    conditions,
    decision,
    determined,
    extras,
    laboratory,
    lacking,
    method,
    moved,
    parameters,
    plots,
    provenance,
    quality,
    risk,
    signature,
    summary,
    traceability,
    uncertainty,
)
from ulna.documents.sections import outliers as far_off
from ulna.documents.sections import verification as acceptance

MOST_OUTLIERS = 40
"""In print; the result has all of them."""
#: facts that the letterhead, the head of the first page, the signatures or a part of its own has
ABOUT = ("identifier", "laboratory", "accreditation", "person")
#: of the provenance: the path is the author's own, and the result has the options
LEFT_OUT = ("study", "fit", "seed")


@dataclass(frozen=True)
class Part:
    """Blocks under a heading; without one they go on with what is before."""

    heading: Text
    blocks: Sequence[blocks.Block]


def parts(content: Content, words: Words, annex: bool) -> list[Part]:
    """What a certificate must say; annex: whether one follows. A part without a block is left out."""
    found = [*_first_page(content, words, annex), *_results(content, words), *_end(content, words)]
    return [part for part in found if part.blocks]


def annexed(content: Content, words: Words) -> list[Part]:
    """How the fit went and what the readings show: for who wants to judge the calibration, not for who uses it."""
    return [part for part in (*_fitted(content, words), *_plots(content, words)) if part.blocks]


def _first_page(content: Content, words: Words, annex: bool) -> list[Part]:
    """Of what, for whom, and whether it conforms."""
    found = content.laboratory
    warnings: list[blocks.Block] = [] if content.fit.converged else [summary.ending(content, words)]
    if found is None:
        warnings.append(blocks.Paragraph(words("paper.no-laboratory"), "bad"))
    facts = laboratory.facts(content, words)
    shown = facts if found is None else facts.without(ABOUT)
    return [
        Part((), [*warnings, shown]),
        _part("decision", words, decision.decision(content, words)),
        _part("statements", words, [] if found is None else statements(words, annex)),
        Part(words("section.traceability"), traceability.traceability(content, words)),
        Part(words("paper.conditions"), [] if found is None else conditions.room(found, words)),
    ]


def statements(words: Words, annex: bool) -> list[blocks.Block]:
    """What every certificate says of itself (ISO/IEC 17025:2017, 7.8.2.1 l and note 2)."""
    said = [words("statement.item-alone"), words("statement.in-full")]
    return [blocks.Listed([*said, words("statement.annex")] if annex else said)]


def _results(content: Content, words: Words) -> list[Part]:
    found = content.verification
    known = not content.identification.lost and not content.identification.weak
    said = determined.determined(content, words, brief=True)
    tested = lacking.lacking(content, words, "verification") if found is None else acceptance.verification(found, words)
    return [
        _part("verification", words, tested),
        _part("parameters", words, [*parameters.parameters(content, words), *(said if known else [])]),
        _part("determined", words, [] if known else said),
        _part("method", words, method.method(content, words)),
        _part("uncertainty", words, uncertainty.uncertainty_statement(content, words)),
    ]


def _fitted(content: Content, words: Words) -> list[Part]:
    found = content.verification
    found_out = content.identification.lost or content.identification.weak
    single: list[blocks.Block] = []
    if found is not None:
        single = [*acceptance.formulas(found, words), *plots.tested_lengths(found, words)]
        single += risk.risks(found.file, words)
    return [
        _part("summary", words, [summary.ending(content, words), *summary.counts(content, words)]),
        _part("quality", words, [*quality.quality(content, words), *plots.before_after(content, words)]),
        _part("verification", words, single),
        _part("determined", words, determined.determined(content, words) if found_out else []),
        _part("moved", words, moved.moved(content, words)),
        _part("extras", words, extras.extras(content, words)),
        Part(words("parameters.cylindrical"), parameters.cylindrical(content, words)),
    ]


def _plots(content: Content, words: Words) -> list[Part]:
    over_joints = plots.clouds(content, words, "joint")
    said = (*words("joints.note"), " ", *words("paper.cloud-legend"))
    joints: list[blocks.Block] = []
    if over_joints:
        joints = [blocks.Paragraph(said, "note"), blocks.Drawings(over_joints, narrow=True)]
    return [
        _part("arm", words, plots.arm(content, words)),
        _part("distribution", words, plots.distributions(content, words) if content.samples else []),
        _part("joints", words, [*joints, *lacking.lacking(content, words, "study", "joint")]),
        Part(words("paper.moved"), plots.ratios(content, words)),
        _part("lengths", words, plots.lengths(content, words)),
        _part("artefacts", words, touched.artefacts(content, words)),
        _part("outliers", words, far_off.outliers(content, words, MOST_OUTLIERS)),
    ]


def _end(content: Content, words: Words) -> list[Part]:
    sources: list[blocks.Block] = [provenance.facts(content, words).without(LEFT_OUT), provenance.files(content, words)]
    return [
        _part("provenance", words, sources),
        _part("signature", words, signature.signature(content, words)),
    ]


def _part(key: str, words: Words, found: Sequence[blocks.Block]) -> Part:
    return Part(words(f"section.{key}"), found)
