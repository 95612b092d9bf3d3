"""The work sheet of a plan as PDF: the same data give the same bytes. The date is left to the hand that measures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ulna.arm.arm import Arm
from ulna.documents.languages.languages import language_of
from ulna.documents.languages.text import END, ISOLATE
from ulna.documents.languages.words import Words, dictionary
from ulna.documents.pdf import blocks
from ulna.documents.pdf.canvas import looks
from ulna.documents.pdf.fonts import Chosen, choose
from ulna.documents.pdf.render import page_label, texts_in
from ulna.documents.pdf.text import clean, line, name
from ulna.documents.pdf.typeset import pictures, typeset
from ulna.documents.work_sheet import head, plots, tables
from ulna.ground.version import VERSION
from ulna.planning.outcome import Plan
from ulna.planning.spec import PlanSpec


def work_sheet(plan: Plan, language: str = "en", fonts: Path | None = None) -> bytes:
    """The PDF, A4 across. Raises UlnaInputError where no font has a character that it needs."""
    return typeset(*_data(plan, language, fonts))


def pages(plan: Plan, language: str = "en", ppi: float = 100.0) -> list[bytes]:
    """Each page as a PNG: to look at."""
    data, chosen = _data(plan, language, None)
    return pictures(data, chosen, ppi)


def check_paper(arm: Arm, spec: PlanSpec, language: str, fonts: Path | None) -> None:
    """Whether there are fonts for all that the sheet will say. Raises UlnaInputError."""
    given = [arm.name, spec.label, spec.artefact.name, *spec.artefact.features, *arm.probes]
    choose([*(clean(each) for each in given), *_own(language)], fonts)


def _data(plan: Plan, language: str, fonts: Path | None) -> tuple[dict[str, Any], Chosen]:
    words = Words(language)
    first = [
        blocks.facts(head.facts(plan, words)),
        *(blocks.paragraph(each, "note") for each in head.notes(plan, words)),
    ]
    rows = [tables.stands(plan, words), *tables.touches(plan, words)]
    data = _about(plan, words)
    chosen = choose([*texts_in(data), *texts_in(first), *texts_in(rows), *_own(language)], fonts)
    data["fonts"] = chosen.order(language)
    with looks([family.regular for family in chosen.more]):
        shown = plots.plots(plan, words)
    where, *each_touch = rows
    data["blocks"] = [
        *first,
        blocks.heading(line(words("sheet.stands"), language)),
        where,
        blocks.heading(line(words("sheet.pictures"), language)),
        *shown,
        blocks.heading(line(words("sheet.touches"), language)),
        *each_touch,
    ]
    return data, chosen


def _own(language: str) -> list[str]:
    """Words of the sheet and of its pictures."""
    return [text for key, text in dictionary(language).items() if key.startswith(("sheet.", "paper.page", "kind."))]


def _about(plan: Plan, words: Words) -> dict[str, Any]:
    """What stands about the text of each page."""
    program = name(f"ulna {VERSION}")
    title = line(words("sheet.title"), words.language)
    return {
        "lang": words.language,
        "region": language_of(words.language).region,
        "title": title,
        "author": program.strip(ISOLATE + END),
        "issuer": f"{title} · {name(plan.arm.name)}",
        "number": name(Path(plan.spec.label).name),
        "date": None,
        "archived": False,
        "flipped": True,
        "program": program,
        "letterhead": [],
        "logo": None,
        "people": [],
        "labels": {
            "number": line(words("sheet.plan"), words.language),
            "draft": "",
            "sign": "",
            "page": page_label(words),
        },
    }
