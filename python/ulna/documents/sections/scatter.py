"""How readings scatter about the fit, and what of that is in the uncertainties."""

from __future__ import annotations

from ulna.documents.content.content import Content
from ulna.documents.languages.text import Text
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import own
from ulna.ground.digits import degrees_of_freedom, uncertainty


def scatter(content: Content, words: Words) -> list[Text]:
    """A sentence each; none where readings scatter as was stated, and alike in all places."""
    found = content.fit.reading_scatter
    if found is None:
        return []
    said = []
    if found.touch_mm is not None:
        freedom = content.fit.degrees_of_freedom if found.degrees_of_freedom is None else found.degrees_of_freedom
        touch = own(uncertainty(found.touch_mm))
        said.append(words("scatter.estimated", touch=touch, freedom=own(degrees_of_freedom(freedom))))
    if found.factor is not None and found.factor != 1.0:
        said.append(words("scatter.scaled", factor=own(f"{found.factor:.3g}")))
    if found.unexplained_mm:
        said.append(words("scatter.unexplained", unexplained=own(uncertainty(found.unexplained_mm))))
    if found.places is not None and (found.place_factor or 1.0) > 1.0:
        said.append(words("scatter.places", factor=own(f"{found.place_factor:.2g}"), places=found.places))
    if found.few_places and found.places is not None:
        said.append(words("scatter.few-places", places=found.places))
    return said


def no_uncertainty(content: Content, words: Words) -> Text | None:
    """Why there is none; None where there is."""
    why = content.parameters.unknown
    if why is None:
        return None
    return words(f"parameters.no-u-{why.kind}", loss=why.loss, each=own(f"{why.each:.1f}"))
