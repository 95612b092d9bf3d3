"""Blocks as HTML: one macro of `blocks.html.jinja` for each kind."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any

from jinja2 import Environment, FunctionLoader, StrictUndefined

from ulna.documents.html.markup import inline
from ulna.documents.languages.text import Text, plain
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Drawings, Facts, Heading, Listed, Paragraph, Table, Tiles, Tone


@dataclass(frozen=True)
class Mark:
    """A mark of a plot and what it stands for."""

    sign: str
    colour: str
    label: Text


@dataclass(frozen=True)
class Legend:
    """Of several plots, in the colours of the page's theme."""

    marks: list[Mark]


#: kind of block → its macro
MACROS: dict[type, str] = {
    Heading: "heading",
    Paragraph: "paragraph",
    Listed: "listed",
    Facts: "facts",
    Table: "table",
    Tiles: "tiles",
    Drawings: "drawings",
    Legend: "legend",
}
#: tone of a paragraph → its class
TONES: dict[Tone, str] = {
    "plain": "",
    "note": "note",
    "missing": "missing",
    "good": "ending good",
    "bad": "ending bad",
}
#: table → further classes: tall ones scroll, those of sentences break their lines
LOOKS = {
    "quality": "",
    "coverage": "",
    "parameters": "",
    "cylindrical": "",
    "directions": " prose",
    "strongest": "",
    "indices": "",
    "verification": "",
    "singles": " tall",
    "risk": "",
    "global-risk": "",
    "artefacts": "",
    "standards": "",
    "equipment": "",
    "outliers": " tall",
    "placements": " tall",
    "extras": "",
    "tried": " tall",
    "mapped": "",
    "files": "",
    "moved-lengths": "",
    "moved-parameters": " tall",
}


@cache
def environment() -> Environment:
    """Of the templates: everything is escaped, and what is not defined is a mistake of ours."""
    made = Environment(loader=FunctionLoader(asset), autoescape=True, undefined=StrictUndefined)
    made.filters |= {"inline": inline, "plain": plain}
    made.globals |= {"tones": TONES, "looks": LOOKS}
    return made


def macro_of(block: Any) -> str:
    """The name of its macro. Errors: KeyError for a block that HTML does not know."""
    return MACROS[type(block)]


def cloud_legend(words: Words) -> Legend:
    """Of residuals over a cause."""
    marks = (("●", "main", "readings"), ("✕", "outlier", "outliers"), ("◆", "ink", "mean"))
    return Legend([Mark(sign, colour, words(f"legend.{key}")) for sign, colour, key in marks])


def asset(file: str) -> str:
    """A file of this room."""
    return (resources.files("ulna.documents.html") / file).read_text(encoding="utf-8").replace("\r\n", "\n")
