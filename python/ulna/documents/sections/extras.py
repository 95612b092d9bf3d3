"""Blocks beyond geometry and their verdicts."""

from __future__ import annotations

from collections.abc import Sequence

from ulna.calibration.choosing.models import HARMONICS
from ulna.calibration.choosing.tried import ChosenModel, TriedModel
from ulna.calibration.extras import JudgedExtra
from ulna.calibration.residual_map import ResidualMap
from ulna.documents.content.content import Content
from ulna.documents.languages.text import Text, joined
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Paragraph, own, table
from ulna.ground.digits import figure_mm, fixed, uncertainty

TRIED = ("model", "chosen", "parameters-more", "lengths-u", "prior-u", "left-out", "worse", "u-worse")
MAPPED = ("map-joint", "follows", "map-share", "u-worse", "amplitude")
BY = {
    "placements": "chosen.by.placements",
    "regions of placements": "chosen.by.regions-of-placements",
    "regions of readings": "chosen.by.regions-of-readings",
}
"""What was left out together, in words."""
COLUMNS = ("extra", "quantity", "verdict", "without", "with", "better", "u-better")


def extras(content: Content, words: Words) -> list[Block]:
    """Nothing where none was asked for."""
    return [*_judged(content, words), *_chosen(content.chosen, words), *_mapped(content.residual_map, words)]


def _judged(content: Content, words: Words) -> list[Block]:
    if not content.extras:
        return []
    rows = [_extra(each, words) for each in content.extras]
    return [
        table("extras", words("section.extras"), words, COLUMNS, rows, left=3),
        Paragraph(words("extras.note"), "note"),
    ]


def _chosen(chosen: ChosenModel | None, words: Words) -> list[Block]:
    """What was chosen, and all that was tried."""
    if chosen is None:
        return []
    if not chosen.tried:
        return [Paragraph(words("chosen.too-few"), "note")]
    said = words(
        f"chosen.{chosen.ended}",
        model=_model(chosen.extras, chosen.harmonics[-1] if chosen.harmonics else None, chosen.drawn, words),
        models=len(chosen.tried),
        groups=chosen.groups,
        by=words(BY[chosen.by]),
        left=chosen.untried,
        figure=words(f"figure.{chosen.figure}"),
    )
    rows = [_tried(each, words) for each in chosen.tried]
    return [Paragraph(said), table("tried", words("section.tried"), words, TRIED, rows, left=2)]


def _tried(each: TriedModel, words: Words) -> list[Text]:
    u = each.prior_u.get(HARMONICS)
    return [
        _model(each.extras, each.order, each.drawn, words),
        words("chosen.kept") if each.kept else (),
        own(each.parameters),
        own(uncertainty(each.lengths_u_mm)),
        own("–" if u is None else f"{u:.1e}"),
        own(figure_mm(each.error_mm)),
        own(fixed(100.0 * each.worse_by, 1)),
        own(fixed(100.0 * each.u_worse_by, 1)),
    ]


def _model(extras: Sequence[str], order: int | None, drawn: bool, words: Words) -> Text:
    if not extras:
        return words("chosen.drawn" if drawn else "chosen.geometry")
    orders: Text = () if order is None else words("chosen.order", order=order)
    named = [joined([words(f"extra.{each}"), orders if each == HARMONICS else ()], " ") for each in extras]
    return joined(named, ", ")


def _mapped(found: ResidualMap | None, words: Words) -> list[Block]:
    """Whether residuals still follow the turn of a joint."""
    if found is None:
        return []
    if not found.joints:
        return [Paragraph(words("map.too-few"), "note")]
    joints = ", ".join(map(str, found.missing))
    said = words("map.missing", joints=joints) if joints else words("map.none")
    rows = [
        [
            own(each.joint),
            words("map.follows") if each.follows else (),
            own(fixed(100.0 * each.share, 1)),
            own(fixed(100.0 * each.u_share, 1)),
            own(f"{each.amplitude_rad:.1e}"),
        ]
        for each in found.joints
    ]
    note = words("map.note", groups=found.groups, by=words(BY[found.by]))
    return [
        Paragraph(said),
        table("mapped", words("section.mapped"), words, MAPPED, rows, left=2),
        Paragraph(note, "note"),
    ]


def _extra(each: JudgedExtra, words: Words) -> list[Text]:
    order: Text = () if each.order is None else words("extra.order", order=each.order)
    errors = [own(figure_mm(value)) for value in (each.without_mm, each.with_mm, each.better_by_mm)]
    return [
        joined([words(f"extra.{each.extra}"), order], ", "),
        words(f"figure.{each.figure}"),
        words(f"verdict.{each.verdict}"),
        *errors,
        own(uncertainty(each.u_better_by_mm)),
    ]
