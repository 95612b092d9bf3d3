"""The languages that Ulna speaks: one row each, and a file CODE.toml beside this one with all its words.

A new language is that file and a row here; `tests/contract` then asks for every key.
"""

from __future__ import annotations

from dataclasses import dataclass

from ulna.ground.errors import UlnaInputError


@dataclass(frozen=True)
class Language:
    """What of a language is no word of it."""

    code: str
    """After ISO 639-1; its words are in CODE.toml."""
    quotes: tuple[str, str]
    """Marks about a command where there are no letters of another width."""
    region: str | None = None
    """After ISO 3166-1, where the setting of letters depends on it."""
    comma: bool = False
    """Whether decimals stand behind a comma on paper; on pages that are copied from they stand behind a point."""
    han: bool = False
    """Whether its quotation marks and dashes are those of a Han font."""


#: code → language, English first
LANGUAGES: dict[str, Language] = {
    each.code: each
    for each in (
        Language("en", ("“", "”")),
        Language("de", ("„", "“"), comma=True),
        Language("zh", ("“", "”"), region="cn", han=True),
    )
}


def language_of(code: str) -> Language:
    """The row of a language. Raises UlnaInputError for one that Ulna does not speak."""
    if code not in LANGUAGES:
        raise UlnaInputError(
            f"language '{code}': Ulna has no words of it; expected one of {', '.join(LANGUAGES)}. Choose one of these."
        )
    return LANGUAGES[code]
