"""The first sections: how the fit ended, key figures, before and after."""

from __future__ import annotations

import math

from ulna.documents.content import Content, QualityRow
from ulna.documents.html.markup import name, paragraph, table, text
from ulna.documents.languages.words import Words
from ulna.documents.quality import CAUTIONS
from ulna.ground.digits import figure_mm


def summary(content: Content, words: Words) -> str:
    """How the fit ended and what it rests on, in sentences and in a few tiles."""
    fit = content.fit
    key = f"ending.{fit.termination}"
    ending = words(key) if words.has(key) else name(fit.termination)
    kind = "good" if fit.converged else "bad"
    said = [
        words(
            "summary.counts",
            readings=fit.readings,
            observations=fit.observations,
            placements=fit.placement_unknowns,
            freedom=fit.degrees_of_freedom,
        ),
        words("summary.no-noise") if fit.chi2_per_dof is None else words("summary.chi2", chi2=fit.chi2_per_dof),
        words(
            "summary.determined",
            determined=content.identification.determined,
            parameters=content.identification.parameters,
        ),
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
    said += [words("summary.signs", joints=", ".join(map(str, joints))) for joints in fit.undecided_signs]
    listed = "".join(f"<li>{each}</li>\n" for each in said)
    return f'<p class="ending {kind}">{ending}</p>\n{_tiles(content, words)}<ul>\n{listed}</ul>\n'


def _tiles(content: Content, words: Words) -> str:
    tiles = []
    for row in content.quality:
        if row.quantity == "residual" or row.after is None or math.isnan(row.after.rms_mm):
            continue
        key = "tile.error" if row.readings == "fitted" else "tile.held-out"
        before = "" if row.before is None else words("tile.before", value=_mm(row.before.rms_mm))
        label = words(key, quantity=_quantity(row.quantity, words))
        tiles.append((f"{_mm(row.after.rms_mm)} mm", label, before))
    found = content.identification
    tiles.append((f"{found.determined} / {found.parameters}", words("tile.determined"), ""))
    tiles.append((str(len(content.outliers)), words("tile.outliers"), ""))
    if content.fit.chi2_per_dof is not None:
        tiles.append((f"{content.fit.chi2_per_dof:.2f}", words("tile.chi2"), ""))
    each = "".join(
        f'<div class="tile"><b>{value}</b><span>{label}</span><small>{more}</small></div>\n'
        for value, label, more in tiles
    )
    return f'<div class="tiles">\n{each}</div>\n'


def _quantity(quantity: str, words: Words) -> str:
    return words(f"quantity.{quantity}")


def quality(content: Content, words: Words) -> str:
    """The before/after table, what was held out and what is missing."""
    heads = [words("column.quantity"), words("column.readings")]
    heads += [
        words(f"column.{what}-{when}") for what in ("mean", "rms", "sigma", "max") for when in ("before", "after")
    ]
    rows = [[text_of(row, words), words(f"readings.{row.readings}"), *_cells(row)] for row in content.quality]
    said = "".join(paragraph(words.say(each), _kind(each.key)) for each in content.held_out)
    return table(heads, rows, words("section.quality"), left=2) + paragraph(words("quality.note"), "note") + said


def text_of(row: QualityRow, words: Words) -> str:
    """What the row is of, as a heading of its row."""
    return _quantity(row.quantity, words)


def _kind(key: str) -> str:
    return "missing" if key in CAUTIONS else ""


def _cells(row: QualityRow) -> list[str]:
    cells = []
    for what in ("mean_mm", "rms_mm", "two_sigma_mm", "max_mm"):
        for each in (row.before, row.after):
            cells.append("–" if each is None else _mm(getattr(each, what)))
    return cells


def _mm(value: float) -> str:
    return "–" if math.isnan(value) else text(figure_mm(value))
