"""Headings: every language has words for every role, and what they mean."""

from __future__ import annotations

import pytest

from ulna.proposals.words import ROLES, languages, meaning


@pytest.mark.parametrize("code", languages())
def test_every_language_has_words_for_every_role(code: str) -> None:
    words = languages()[code]
    assert [role for role in ROLES if not words.get(role)] == []
    assert sorted(set(words) - set(ROLES)) == []
    assert [word for each in words.values() for word in each if word != word.casefold() or word != word.strip()] == []


@pytest.mark.parametrize("code", languages())
def test_every_word_is_known_with_a_number_and_a_unit(code: str) -> None:
    for word in languages()[code]["angle"]:
        for heading in (f"{word} 3 [deg]", f"{word.capitalize()}3 (deg)", f"{word}_3_deg"):
            found = meaning(heading)
            assert (found.role, found.number, found.unit) == ("angle", 3, "deg"), heading


@pytest.mark.parametrize(
    ("heading", "role", "number"),
    [
        ("1. Achse", "angle", 1),
        ("第2轴", "angle", 2),
        ("θ4", "angle", 4),
        ("Messung", "measurement", None),
        ("Lfd. Nr.", "measurement", None),
        ("Bemerkungen", "aside", None),
        ("备注", "aside", None),
        ("Ende", "feature", None),
        ("Temperatur [°C]", "temperature", None),
        ("Kraft", None, None),
        ("x [mm]", None, None),
    ],
)
def test_what_headings_mean(heading: str, role: str | None, number: int | None) -> None:
    found = meaning(heading)
    assert (found.role, found.number) == (role, number)


def test_what_was_wanted_is_no_reading() -> None:
    assert meaning("Soll Achse 1").goal
    assert not meaning("Ist Achse 1").goal
