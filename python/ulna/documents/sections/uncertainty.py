"""How U came about: coverage, the sources that it has and those that it has not."""

from __future__ import annotations

from ulna.documents.content.content import Content
from ulna.documents.languages.text import Text, joined, named
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Paragraph, own
from ulna.documents.sections.conditions import noise
from ulna.documents.sections.parameters import u_comes_from
from ulna.documents.sections.scatter import no_uncertainty, scatter
from ulna.ground.digits import uncertainty

#: what no fit can see
NEVER = ("thermal", "model", "time", "use")


def uncertainty_statement(content: Content, words: Words) -> list[Block]:
    """In the manner of the GUM."""
    known = content.parameters
    without = no_uncertainty(content, words)
    if without is not None:
        return [Paragraph(without, "missing")]
    manner = words("uncertainty.manner", k=own(f"{known.k:.2f}"), p=own(f"{100 * known.p:g}"))
    return [
        Paragraph(joined([manner, u_comes_from(content, words)], " ")),
        Paragraph(_all_of("included", _within(content, words), words)),
        Paragraph(_all_of("excluded", _outside(content, words), words)),
    ]


def _all_of(key: str, said: list[Text], words: Words) -> Text:
    """Sentences behind what they are of."""
    return joined([(*words(f"uncertainty.{key}"), ":"), *said], " ")


def _within(content: Content, words: Words) -> list[Text]:
    stated = content.fit.chi2_per_dof is not None
    found = [words("included.readings" if stated else "included.scatter"), *scatter(content, words)]
    found.append(words("included.placements"))
    found += noise(content.environment, words)
    with_u = [(*named(row.name), *own(f" (u = {uncertainty(row.u_mm)} mm)")) for row in content.artefacts if row.u_mm]
    if with_u:
        found.append(joined([words("included.artefacts"), joined(with_u, ", ")], " "))
    return found


def _outside(content: Content, words: Words) -> list[Text]:
    without = [row.name for row in content.artefacts if row.dimension is not None and not row.u_mm]
    found = [words("excluded.artefacts", names=", ".join(without))] if without else []
    return found + [words(f"excluded.{key}") for key in NEVER]
