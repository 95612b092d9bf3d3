"""How well the readings see the parameters: correlations, singular values, indices."""

from __future__ import annotations

import numpy as np

from ulna.documents.content.content import Content
from ulna.documents.languages.text import named, number
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Drawing, Drawings, Heading, own, table
from ulna.documents.sections.lacking import lacking

MOST_PAIRS = 10
"""Of strongest correlations."""


def correlation(content: Content, words: Words) -> list[Block]:
    """The matrix as a plot, and the pairs of parameters that are correlated the most."""
    known = content.parameters
    if not known.correlation_names:
        return lacking(content, words, "correlation")
    drawing = Drawing("correlation", "correlation", known, words("correlation.note"))
    return [Drawings([drawing]), *_strongest(content, words)]


def _strongest(content: Content, words: Words) -> list[Block]:
    r, names = content.parameters.correlation, content.parameters.correlation_names
    first, second = np.triu_indices(len(names), 1)
    size = np.abs(np.nan_to_num(r[first, second]))
    order = np.argsort(-size, kind="stable")[:MOST_PAIRS]
    rows = [[named(names[first[k]]), named(names[second[k]]), own(f"{r[first[k], second[k]]:.3f}")] for k in order]
    title = words("correlation.strongest")
    pairs = table("strongest", title, words, ("first", "second", "correlation"), rows, left=2)
    return [Heading(title), pairs] if rows else []


def observability(content: Content, words: Words) -> list[Block]:
    """Singular values as a plot, O1 to O5 with their formulas."""
    found = content.observability
    if found is None:
        return lacking(content, words, "observability")
    drawing = Drawing("singular", "singular", found, words("observability.note", equations=found.equations))
    rows = [[own(key), words(f"formula.{key}"), own(number(value))] for key, value in found.indices.items()]
    columns = ("index", "formula", "value")
    return [Drawings([drawing]), table("indices", words("section.observability"), words, columns, rows, left=2)]
