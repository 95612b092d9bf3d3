"""The sentences of the server: each that is `worded` stands in the page's catalogues, whole, and nothing else does."""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

from ulna.documents.languages.words import dictionary

LANGUAGES = ("de", "zh")
JOINING = {"{first}, {rest}", "{first}; {rest}", "{first} {rest}", "{line}", "{device}: {why}"}
"""Templates without a word."""


def said_in(root: Path, language: str) -> dict[str, str]:
    text = (root / "page" / "src" / "words" / f"said.{language}.json").read_text(encoding="utf-8")
    found: dict[str, str] = json.loads(text, object_pairs_hook=_each_once)
    return found


def _each_once(pairs: list[tuple[str, str]]) -> dict[str, str]:
    names = [name for name, _ in pairs]
    twice = {name for name in names if names.count(name) > 1}
    assert not twice, f"twice: {twice}"
    return dict(pairs)


def names_in(template: str) -> set[str]:
    return set(re.findall(r"\{(\w+)\}", template))


@cache
def constants(path: Path) -> dict[str, str]:
    """Strings of a module by their names; those that it imports from Ulna too."""
    found: dict[str, str] = {}
    for node in ast.parse(path.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("ulna."):
            own = path
            while own.name != "ulna":
                own = own.parent
            module = own.parent / f"{node.module.replace('.', '/')}.py"
            theirs = constants(module) if module.exists() and module != path else {}
            found |= {each.asname or each.name: theirs[each.name] for each in node.names if each.name in theirs}
        if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            found |= {each.id: node.value.value for each in node.targets if isinstance(each, ast.Name)}
    return found


def calls(root: Path) -> Iterator[tuple[str, ast.Call, list[str]]]:
    """Each call of `worded` and `templates`: where, and the templates in it."""
    for path in sorted((root / "python" / "ulna").rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        if "worded" not in text or path.name == "worded.py":
            continue
        known = constants(path)
        for node in ast.walk(ast.parse(text)):
            named = isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
            if not (named and node.func.id in ("worded", "templates")):  # type: ignore[union-attr, attr-defined]
                continue
            assert isinstance(node, ast.Call)
            where = f"{path.relative_to(root)}:{node.lineno}"
            given = [each for each in node.args if not isinstance(each, ast.Starred)]
            found = []
            for each in given:
                literal = isinstance(each, ast.Constant) and isinstance(each.value, str)
                assert literal or (isinstance(each, ast.Name) and each.id in known), f"{where}: no literal"
                found.append(each.value if isinstance(each, ast.Constant) else known[each.id])  # type: ignore[attr-defined]
            yield where, node, [str(each) for each in found]


@pytest.fixture(scope="module")
def every(root: Path) -> dict[str, str]:
    """Template → where it is."""
    own = (root / "python" / "ulna" / "ground" / "worded.py").read_text(encoding="utf-8")
    joining = dict.fromkeys(re.findall(r'lambda first, rest: worded\("([^"]+)"', own), "ground/worded.py")
    return joining | {template: where for where, _, found in calls(root) for template in found}


def test_what_is_worded_is_given_its_values(root: Path) -> None:
    for where, node, found in calls(root):
        assert isinstance(node.func, ast.Name)
        if node.func.id == "templates" or any(each.arg is None for each in node.keywords):
            continue
        (template,) = found
        assert {each.arg for each in node.keywords} == names_in(template), where


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_sentence_is_said_in_every_language(root: Path, every: dict[str, str], language: str) -> None:
    said = said_in(root, language)
    lacking = {template: where for template, where in every.items() if template not in said}
    assert not lacking, f"said.{language}.json lacks: {json.dumps(lacking, indent=1, ensure_ascii=False)}"
    more = sorted(set(said) - set(every))
    assert not more, f"said.{language}.json has what nobody says: {json.dumps(more, indent=1, ensure_ascii=False)}"


@pytest.mark.parametrize("language", LANGUAGES)
def test_no_translation_forgets_a_value(root: Path, every: dict[str, str], language: str) -> None:
    wrong = {
        template: text
        for template, text in said_in(root, language).items()
        if names_in(template) != names_in(text) or not text
    }
    assert not wrong
    assert every


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_reports_say_too_is_said_in_the_same_words(root: Path, language: str) -> None:
    """Where a report in English has the same sentence."""
    words = dictionary(language)
    reports = {text: words[key] for key, text in dictionary("en").items() if not key.startswith("sheet.")}
    differ = {
        template: (text, reports[template])
        for template, text in said_in(root, language).items()
        if " " in template and template in reports and reports[template] != text
    }
    assert not differ
