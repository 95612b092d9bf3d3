"""How the parameters were found: the model of the arm, the least squares, the program."""

from __future__ import annotations

from ulna.documents.content.content import Content
from ulna.documents.languages.text import Text, joined
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Paragraph, own


def method(content: Content, words: Words) -> list[Block]:
    """A sentence each, in one paragraph."""
    return [Paragraph(joined([_model(content, words), _fit(content, words), _software(content, words)], " "))]


def _model(content: Content, words: Words) -> Text:
    made = content.model
    links = words("method.dh")
    if made.hayati:
        links = words("method.hayati", joints=own(", ".join(map(str, made.hayati))))
    effects = [words(f"extra.{effect}") for effect in made.effects]
    beyond = words("method.effects", effects=joined(effects, ", ")) if effects else words("method.no-effects")
    return words("method.model", joints=content.joints, links=links, beyond=beyond)


def _fit(content: Content, words: Words) -> Text:
    fit = content.fit
    weights = words("method.weights-alike" if fit.chi2_per_dof is None else "method.weights-stated")
    loss = words("method.no-loss") if fit.loss == "none" else words("method.loss", loss=fit.loss)
    return words("method.fit", readings=fit.readings, weights=weights, loss=loss)


def _software(content: Content, words: Words) -> Text:
    made = content.provenance
    return words("method.software", program=made.program, version=made.version)
