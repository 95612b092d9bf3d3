"""What every language owes: a file with every key, the same values in each text, and no word that nobody says.

A new language is held to all of this by its row alone.
"""

from __future__ import annotations

import ast
import re
import string
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

import ulna
from ulna.artefacts.quantities import NAMES
from ulna.documents.laboratory.iso_codes import COUNTRIES
from ulna.documents.laboratory.iso_codes import LANGUAGES as CODES
from ulna.documents.languages.languages import LANGUAGES, language_of
from ulna.documents.languages.text import Command, plain
from ulna.documents.languages.words import Words, dictionary
from ulna.ground.errors import UlnaInputError

PACKAGE = Path(ulna.__file__).parent
CATALOGUE = PACKAGE / "documents" / "languages"
#: functions whose first argument is a key
ASKING = {"words", "say", "Said", "own"}

every_language = pytest.mark.parametrize("code", LANGUAGES)


def fields(text: str) -> list[str]:
    return sorted(name for _, name, _, _ in string.Formatter().parse(text) if name)


@every_language
def test_it_is_a_file_and_a_row(code: str) -> None:
    row = language_of(code)
    assert row.code == code
    assert code in CODES
    assert row.region is None or row.region.upper() in COUNTRIES
    raw = tomllib.loads((CATALOGUE / f"{code}.toml").read_text(encoding="utf-8"))
    assert raw == dictionary(code)
    assert all(isinstance(text, str) for text in raw.values())
    assert all(row.quotes)


def test_no_file_is_without_a_row() -> None:
    assert sorted(path.stem for path in CATALOGUE.glob("*.toml")) == sorted(LANGUAGES)


@every_language
def test_it_has_every_key_in_the_order_of_english(code: str) -> None:
    assert list(dictionary(code)) == list(dictionary("en"))


@every_language
def test_its_texts_have_the_values_of_english(code: str) -> None:
    own, english = dictionary(code), dictionary("en")
    assert [key for key in english if fields(own[key]) != fields(english[key])] == []


@every_language
def test_no_text_is_empty_and_none_claims_conformity(code: str) -> None:
    for key, text in dictionary(code).items():
        assert text.strip() == text, key
        assert text, key
        assert not re.search(r"conforms to|erfüllt die Norm|konform mit", text, re.IGNORECASE), key


@every_language
def test_what_to_type_is_the_same_in_every_language(code: str) -> None:
    for key, english in dictionary("en").items():
        own = dictionary(code)[key]
        assert own.count("`") % 2 == 0, key
        assert re.findall("`([^`]+)`", own) == re.findall("`([^`]+)`", english), key
        assert not re.search(r"`[^`]*\{[^`]*`", own), f"{key}: a value within what to type"


@every_language
def test_every_text_is_said_with_its_values(code: str) -> None:
    """All of each text comes out, in its order: own words, commands, values."""
    words = Words(code)
    for key, text in dictionary(code).items():
        values = {name: (f"<{name}>",) for name in fields(text)}
        said = words(key, **values)
        assert plain(said) == text.replace("`", "").format_map({name: f"<{name}>" for name in values}), key
        assert [piece.text for piece in said if isinstance(piece, Command)] == re.findall("`([^`]+)`", text)


def test_a_language_that_ulna_does_not_speak_is_refused_in_words() -> None:
    with pytest.raises(UlnaInputError, match=r"language 'fr': Ulna has no words of it; expected one of en, de, zh"):
        language_of("fr")
    with pytest.raises(UlnaInputError, match="language 'fr'"):
        Words("fr")("title")


# words and code


def trees() -> Iterator[ast.Module]:
    for room in ("documents", "cli", "verification", "calibration", "planning"):
        for path in sorted((PACKAGE / room).rglob("*.py")):
            yield ast.parse(path.read_text(encoding="utf-8"))


def texts_in(node: ast.AST) -> Iterator[str]:
    """Strings that an expression may be: itself, or either branch."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    elif isinstance(node, ast.IfExp):
        yield from texts_in(node.body)
        yield from texts_in(node.orelse)


def in_templates() -> set[str]:
    """Keys that templates ask for."""
    templates = [path.read_text(encoding="utf-8") for path in PACKAGE.rglob("*.jinja")]
    return {key for text in templates for key in re.findall(r"(?:say|words)\('([a-z.-]+)'[,)]", text)}


def asked() -> set[str]:
    """Keys that are written out where a word is asked for."""
    found = in_templates()
    assert found
    for tree in trees():
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and node.args:
                name = node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")
                if name in ASKING:
                    found |= {text for text in texts_in(node.args[0]) if re.fullmatch(r"[a-z-]+(\.\S+)?", text)}
    return found


def begun() -> set[str]:
    """Beginnings of keys whose end is a value: f"kind.{kind}"."""
    found = set()
    for tree in trees():
        for node in ast.walk(tree):
            if isinstance(node, ast.JoinedStr) and isinstance(node.values[0], ast.Constant):
                start = str(node.values[0].value)
                if re.fullmatch(r"[a-z][a-z-]*\.[a-z-]*", start):
                    found.add(start)
    return found


def written() -> set[str]:
    """All strings in the sources of Python and of the core: what the end of a key may be."""
    found = {node.value for tree in trees() for node in ast.walk(tree) if isinstance(node, ast.Constant)}
    rooms = [PACKAGE / room for room in ("artefacts", "arm", "study")]
    for path in (path for room in rooms for path in room.rglob("*.py")):
        tree = ast.parse(path.read_text(encoding="utf-8"))
        found |= {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)}
    core = PACKAGE.parents[1] / "crates"
    for path in core.rglob("*.rs"):
        found |= set(re.findall(r'"([a-z0-9_-]+)"', path.read_text(encoding="utf-8")))
    return {each for each in found if isinstance(each, str)}


def test_no_word_is_asked_for_that_is_not_there() -> None:
    english = dictionary("en")
    found = asked()
    assert len(found) > 150, "the calls were not found"
    keys = in_templates() | {key for key in found if "." in key}
    assert sorted(keys - set(english)) == []
    assert [start for start in sorted(begun()) if start.split(".")[0] in sections() and not has(start)] == []


def sections() -> set[str]:
    return {key.split(".")[0] for key in dictionary("en")}


def has(start: str) -> bool:
    return any(key.startswith(start) for key in dictionary("en"))


def test_no_word_is_there_that_nobody_asks_for() -> None:
    """Written out somewhere; or begun somewhere, and its end is a string of the sources, or several with hyphens."""
    literals, starts = written() | in_templates() | set(NAMES), begun()
    unused = []
    for key in dictionary("en"):
        ends = [key.removeprefix(start) for start in starts if key.startswith(start)]
        known = [end in literals or all(part in literals for part in end.rsplit("-", 1)) for end in ends]
        if key not in literals and not any(known):
            unused.append(key)
    assert unused == []
