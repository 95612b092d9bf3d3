"""From what, with what and when, and the SHA-256 of all that was read."""

from __future__ import annotations

import json

from ulna.documents.content.content import Content
from ulna.documents.languages.text import NONE, Code, Text, named
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Fact, Facts, Table, own, table


def facts(content: Content, words: Words) -> Facts:
    """With what and when."""
    made = content.provenance
    found: dict[str, list[Text]] = {
        "program": [named(made.program, made.version)],
        "time": [named(made.time)],
        "seed": [own(made.seed)],
        "study": [NONE if made.study is None else named(made.study)],
        "fit": [(Code(json.dumps(made.options, ensure_ascii=False)),)],
        "warnings": [named(each) for each in made.warnings],
    }
    if content.issued is not None and content.issued.audit_head is not None:
        found["audit-head"] = [(Code(content.issued.audit_head),)]
    return Facts([Fact(key, words(f"provenance.{key}"), lines) for key, lines in found.items() if lines])


def files(content: Content, words: Words) -> Table:
    """The result, what it was made from, what stands beside it."""
    made = content.provenance
    rows: list[list[Text]] = [[named(made.result), (Code(made.result_sha256),), NONE, NONE]]
    rows += [
        [named(file.path), (Code(file.sha256),), words(f"state.{file.state}"), own(file.rows)] for file in made.files
    ]
    rows += [[named(file.name), (Code(file.sha256),), NONE, NONE] for file in made.beside]
    columns = ("file", "sha256", "state", "rows")
    return table("files", words("section.provenance"), words, columns, rows, left=3)
