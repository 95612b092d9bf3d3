"""Sentences that keep what they are made of, so that a page can say them in another language.

A sentence is English, and a plain string to whoever prints, writes or compares it. What it was made from, a template
and the values in it, stays with it as long as nobody cuts or joins it as a string: `worded` sentences are joined by
`worded`. The templates of all of them stand in the page's catalogues (page/src/words/said.*.json), which
tests/house/test_words.py keeps.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache

_NAMED = re.compile(r"\{(\w+)\}")


class Worded(str):
    """A sentence in English, its template, and what stands in its place of each name: strings, or sentences."""

    template: str
    values: Mapping[str, str]

    def __new__(cls, template: str, values: Mapping[str, str], text: str | None = None) -> Worded:
        """text: where it is another than template and values make. Raises KeyError where a value lacks."""
        made = super().__new__(cls, _NAMED.sub(lambda name: values[name[1]], template) if text is None else text)
        made.template, made.values = template, values
        return made

    def __reduce__(self) -> tuple[type[Worded], tuple[str, Mapping[str, str], str]]:
        return Worded, (self.template, self.values, str(self))


def worded(template: str, **values: str | int) -> str:
    """ "moved {moved} mm while touching" with moved = "0.06": numbers come as people read them. The template is a
    literal where this is called."""
    return Worded(template, {name: value if isinstance(value, str) else str(value) for name, value in values.items()})


def listed(parts: Sequence[str]) -> str:
    """ "a, b, c" of words or sentences, which keep what they are made of. "" of none."""
    return _joined(parts, lambda first, rest: worded("{first}, {rest}", first=first, rest=rest))


def capital(sentence: str) -> str:
    """With a capital at its beginning, which stands in no template that begins with a value."""
    text = f"{sentence[:1].upper()}{sentence[1:]}"
    return Worded(sentence.template, sentence.values, text) if isinstance(sentence, Worded) else text


def one_by_one(parts: Sequence[str]) -> str:
    """ "a; b; c" of clauses. "" of none."""
    return _joined(parts, lambda first, rest: worded("{first}; {rest}", first=first, rest=rest))


def in_a_row(parts: Sequence[str]) -> str:
    """Whole sentences behind each other. "" of none."""
    return _joined(parts, lambda first, rest: worded("{first} {rest}", first=first, rest=rest))


def templates(*known: str) -> tuple[str, ...]:
    """Templates of sentences that are made where nothing can be kept with them: in the core, or in a file. Literals."""
    return known


def recalled(text: str, known: Iterable[str]) -> str:
    """A sentence that came as a plain string, with its template again: the first of `known` that makes exactly this of
    some values, none of them empty, which are looked for in the same way. Where none does, as it came."""
    if isinstance(text, Worded):
        return text
    some = tuple(known)
    for template in some:
        found = _pattern(template).fullmatch(text)
        if found is not None:
            return Worded(template, {name: recalled(value, some) for name, value in found.groupdict().items()})
    return text


def kept(error: Exception) -> str:
    """What an error says, with its template where it has one: `str` of it has lost that."""
    said = error.args[0] if error.args else ""
    return said if isinstance(said, Worded) else str(error)


def _joined(parts: Sequence[str], join: Callable[[str, str], str]) -> str:
    if not parts:
        return ""
    *before, whole = parts
    for part in reversed(before):
        whole = join(part, whole)
    return whole


@cache
def _pattern(template: str) -> re.Pattern[str]:
    seen: set[str] = set()

    def group(name: str) -> str:
        if name in seen:
            return f"(?P={name})"
        seen.add(name)
        return f"(?P<{name}>.+?)"

    pieces = _NAMED.split(template)
    return re.compile("".join(group(piece) if k % 2 else re.escape(piece) for k, piece in enumerate(pieces)), re.S)
