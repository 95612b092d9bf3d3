"""How the fit ended, what it rests on, and the key figures."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ulna.documents.content.acceptance import wholes
from ulna.documents.content.content import Content
from ulna.documents.languages.text import Text, named, plain, styled
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Listed, Paragraph, Tile, Tiles, own
from ulna.documents.sections.decision import STYLES, verdict
from ulna.documents.sections.scatter import scatter
from ulna.ground.digits import degrees_of_freedom, figure_mm

#: sets of joints whose signs are not told, of which each is named
_FEW_SETS = 3


def ending(content: Content, words: Words) -> Paragraph:
    """How the fit ended."""
    key = f"ending.{content.fit.termination}"
    said = words(key) if words.has(key) else named(content.fit.termination)
    return Paragraph(said, "good" if content.fit.converged else "bad")


def counts(content: Content, words: Words) -> list[Block]:
    """What the fit rests on, point by point."""
    fit, found = content.fit, content.identification
    said = [
        words(
            "summary.counts",
            readings=fit.readings,
            observations=fit.observations,
            placements=fit.placement_unknowns,
            freedom=own(degrees_of_freedom(fit.degrees_of_freedom)),
        ),
        words("summary.no-noise") if fit.chi2_per_dof is None else words("summary.chi2", chi2=fit.chi2_per_dof),
        *scatter(content, words),
        words("summary.determined", determined=found.determined, parameters=found.parameters),
        words(
            "summary.outliers" if fit.loss == "none" else "summary.outliers-loss",
            outliers=len(content.outliers),
            readings=fit.readings,
        ),
    ]
    if fit.loss != "none":
        said.append(words("summary.loss", loss=fit.loss))
    if fit.searched_starts or fit.method != "lm":
        said.append(words("summary.search", starts=fit.searched_starts, method=fit.method))
    if fit.folded:
        said.append(words("summary.folded", folded=", ".join(fit.folded)))
    if fit.signs_found:
        found_signs = ", ".join(f"{name} = {sign}" for name, sign in fit.signs_found.items())
        said.append(words("summary.signs-found", signs=own(found_signs)))
    same = [joints for joints in fit.undecided_signs if joints not in fit.mirrored_signs]
    for key, sets in (("summary.mirror", fit.mirrored_signs), ("summary.signs", same)):
        if sets:
            said.append(words(key, joints=_sets(sets, words)))
    if content.verification is not None:
        name = content.verification.file.profile.name
        for whole in wholes(content.verification.file):
            outcome = styled(verdict(whole.verdict, words), STYLES[whole.verdict])
            state = words(f"state.{whole.state}")
            said.append(words("summary.verification", profile=name, state=state, verdict=outcome))
    if fit.common_factor is not None:
        said.append(words("summary.common-factor", factor=own(f"{fit.common_factor:.4g}")))
    return [Listed(said)]


def _sets(sets: Sequence[Sequence[int]], words: Words) -> Text:
    """Sets of joints that may count the other way, the first of many."""
    either = plain(words("summary.either"))
    text = own(f" {either} ".join(", ".join(map(str, joints)) for joints in sets[:_FEW_SETS]))
    more = len(sets) - _FEW_SETS
    return (*text, " ", *words("summary.more-sets", more=more)) if more > 0 else text


def tiles(content: Content, words: Words) -> Tiles:
    """The figures that are looked at first."""
    found = []
    for row in content.quality:
        if row.quantity == "residual" or row.after is None or math.isnan(row.after.rms_mm):
            continue
        key = "tile.error" if row.readings == "fitted" else "tile.held-out"
        before: Text = () if row.before is None else words("tile.before", value=_mm(row.before.rms_mm))
        label = words(key, quantity=words(f"quantity.{row.quantity}"))
        found.append(Tile((*_mm(row.after.rms_mm), " mm"), label, before))
    known = content.identification
    found.append(Tile(own(f"{known.determined} / {known.parameters}"), words("tile.determined")))
    found.append(Tile(own(len(content.outliers)), words("tile.outliers")))
    if content.fit.chi2_per_dof is not None:
        found.append(Tile(own(f"{content.fit.chi2_per_dof:.2f}"), words("tile.chi2")))
    return Tiles(found)


def _mm(value: float) -> Text:
    return own("–" if math.isnan(value) else figure_mm(value))
