"""What has moved since an earlier calibration: what it does to lengths, whether it is more than both uncertainties
explain, and which parameters it is."""

from __future__ import annotations

from ulna.comparison.compare import Compared
from ulna.documents.content.content import Content
from ulna.documents.languages.text import Text, joined, named
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Paragraph, own, table
from ulna.ground.digits import figure_mm, plain_uncertainty, quantity

MOST = 30
"""Parameters, the surest change first."""
_LENGTHS = ("lengths", "how-many", "change-rms", "change-largest", "change-expanded", "change-share")
_PARAMETERS = ("parameter", "unit", "change", "u", "change-ratio")
_LEAST_P = 1e-3


def moved(content: Content, words: Words) -> list[Block]:
    """Nothing where no earlier calibration was named."""
    return [] if content.moved is None else step_blocks(content.moved, words)


def step_blocks(found: Compared, words: Words) -> list[Block]:
    """Of one calibration and the one before it."""
    lengths = [
        [
            own(f"{band.least_mm:.0f} … {band.most_mm:.0f}"),
            own(band.count),
            *(own(figure_mm(each)) for each in (band.rms_mm, band.largest_mm, band.expanded_mm)),
            own(f"{band.en:.2f}"),
        ]
        for band in found.bands
    ]
    parameters = [
        [
            named(row.name),
            named(row.unit),
            own(quantity(row.delta, row.u, row.unit)),
            own(plain_uncertainty(row.u, row.unit)),
            own(f"{abs(row.delta) / row.u:.1f}"),
        ]
        for row in found.parameters[:MOST]
    ]
    return [
        Paragraph(words("moved.since", before=own(found.before))),
        Paragraph(words("moved.yes" if found.moved else "moved.no"), "bad" if found.moved else "good"),
        Paragraph(joined(_why(found, words), " ")),
        table("moved-lengths", words("section.moved"), words, _LENGTHS, lengths, left=1),
        table("moved-parameters", words("section.moved"), words, _PARAMETERS, parameters, left=2),
        Paragraph(words("moved.note"), "note"),
    ]


def _why(found: Compared, words: Words) -> list[Text]:
    chance = words("moved.chance", chi2=own(f"{found.chi2:.1f}"), rank=found.rank, p=own(_p(found.p_value)))
    said = [chance, words("moved.any", p=own(_p(found.p_of_largest)))]
    largest = found.largest
    if largest is not None:
        said.append(
            words(
                "moved.largest",
                length=own(f"{largest.length_mm:.0f}"),
                change=own(figure_mm(largest.largest_mm)),
                expanded=own(figure_mm(largest.expanded_mm)),
            )
        )
    if found.not_determined:
        said.append(words("moved.left-out", count=found.not_determined))
    return said


def _p(p: float) -> str:
    return f"p < {_LEAST_P:g}" if p < _LEAST_P else f"p = {p:.2g}"
