"""Sentences that a verification.json holds in English, in the document's language where they are Ulna's own.

A profile of one's own, or a file of a later version, may say something else: that stands as it is, marked as English.
"""

from __future__ import annotations

from ulna.documents.languages.text import Text, named, plain, styled
from ulna.documents.languages.words import Words
from ulna.verification.result_file import FigureTable, UsedProfile

#: what a budget says that it leaves out → the end of its key
LEFT_OUT = {
    "the temperature of the artefact: not stated": "temperature",
    "the expansion of the artefact: not stated": "expansion",
    "the uncertainty of the artefact's expansion: not stated": "u-expansion",
    "the form of the ball: not stated": "form",
    "how still the artefact stands (fixture): not stated": "fixture",
}
#: the profiles that come with Ulna
PROFILES = ("iso-10360-12", "vdi-2617-9", "asme-b89-4-22")


#: figures that there are one of for each axis
AXES = {"FARO_SPAT_x": "x", "FARO_SPAT_y": "y", "FARO_SPAT_z": "z"}


def formula(figure: FigureTable, words: Words) -> Text:
    """How a figure is computed."""
    if figure.key in AXES:
        return _spoken("formula-of.faro-spat", figure.formula, words, axis=(AXES[figure.key],))
    return _spoken(f"formula-of.{figure.key}", figure.formula, words)


def manner(profile: UsedProfile, words: Words) -> Text:
    """In whose manner was tested."""
    return _spoken(f"manner.{profile.name}", profile.statement, words)


def left_out(said: str, words: Words) -> Text:
    """What an uncertainty does not hold."""
    return _spoken(f"left-out.{LEFT_OUT.get(said, said)}", said, words)


def _spoken(key: str, said: str, words: Words, **values: Text) -> Text:
    if words.has(key) and plain(Words("en")(key, **values)) == said:
        return words(key, **values)
    return english(said)


def english(said: str) -> Text:
    """As a file has it."""
    return styled(named(said), "english")
