"""Where a test is not what its profile counts, in the document's language.

A verification.json has these sentences in English. The catalogue's English is what they are recognised by; one that it
does not have stands as it is, marked as English.
"""

from __future__ import annotations

import re
from functools import cache

from ulna.documents.languages.text import Text, named
from ulna.documents.languages.words import Words, dictionary
from ulna.documents.sections.blocks import own
from ulna.documents.sections.verbatim import english

KEYS = (
    "not-measured",
    "counted-each",
    "counted",
    "longest",
    "reach",
    "no-range-longest",
    "no-range-seats",
    "any-frame",
)
"""The ends of their keys; what holds another's words is before it."""
COUNTED = (
    "lengths",
    "positions-of-length",
    "repeats",
    "seats",
    "touches",
    "positions-of-ball",
    "points-on-ball",
    "orientations",
    "points-in-orientation",
    "measurements",
    "points-of-measurement",
    "lengths-measured",
    "bars",
)
"""Of what is counted."""


def departure(said: str, words: Words) -> Text:
    """One sentence."""
    for key in KEYS:
        found = _pattern(key).fullmatch(said)
        if found is not None:
            return words(
                f"departure.{key}", **{name: _value(name, text, words) for name, text in found.groupdict().items()}
            )
    return english(said)


def _value(name: str, text: str, words: Words) -> Text:
    """What is counted is a word; how many of which is told without one; all else are numbers and names."""
    if name == "what":
        known = {dictionary("en")[f"counted.{key}"]: key for key in COUNTED}
        return words(f"counted.{known[text]}") if text in known else named(text)
    if name == "found" and words.language != "en":
        return named(re.sub(r"\b(\d+) of ", "\\1 × ", text))
    return own(text) if re.fullmatch(r"[\d.]+", text) else named(text)


@cache
def _pattern(key: str) -> re.Pattern[str]:
    """English words with something for each value."""
    own_words = re.escape(dictionary("en")[f"departure.{key}"])
    return re.compile(re.sub(r"\\\{(\w+)\\\}", r"(?P<\1>.+?)", own_words))
