"""The whole page: head with its policy, sections in their order, plots with their data."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from markupsafe import Markup

from ulna.documents.content.content import Content
from ulna.documents.html.arm_plot import rules
from ulna.documents.html.blocks import Legend, asset, cloud_legend, environment, macro_of
from ulna.documents.html.drawings import draw
from ulna.documents.html.markup import digest, json_in_script
from ulna.documents.html.plots import Plot, Still
from ulna.documents.languages.words import Words
from ulna.documents.sections import artefacts as touched
from ulna.documents.sections import (
    blocks,
    conditions,
    decision,
    determined,
    extras,
    laboratory,
    lacking,
    method,
    moved,
    observability,
    parameters,
    placements,
    plots,
    provenance,
    quality,
    risk,
    summary,
    traceability,
)
from ulna.documents.sections import outliers as far_off
from ulna.documents.sections import verification as acceptance

#: nothing is fetched, sent or framed, and only the two scripts of this file run, known by their SHA-256
POLICY = (
    "default-src 'none'; script-src {scripts}; style-src 'unsafe-inline'; img-src data: blob:; font-src data:; "
    "connect-src 'none'; base-uri 'none'; form-action 'none'"
)
MOST_OUTLIERS = 2000
MOST_PLACEMENTS = 500
MOST_SINGLES = 1000

Blocks = Sequence[blocks.Block | Legend]


def render(content: Content, language: str = "en") -> str:
    """The page as text, to be written as UTF-8. The same content gives the same text."""
    words = Words(language)
    drawn: list[Plot] = []
    env = environment()
    macros: Any = env.get_template("blocks.html.jinja").make_module(
        {"draw": lambda drawing: _drawn(draw(drawing, content, words), drawn)}
    )
    scripts = [_plotly(), asset("plots.js")]
    page = env.from_string(asset("page.html.jinja"))
    return page.render(
        words=words,
        arm=content.arm,
        made=content.provenance,
        policy=POLICY.format(scripts=" ".join(f"'sha256-{digest(script)}'" for script in scripts)),
        style=Markup(asset("style.css") + rules()),
        sections={key: found for key, found in sections_of(content, words).items() if found},
        set=lambda block: getattr(macros, macro_of(block))(block),
        plots_data=lambda: Markup(json_in_script([_data(plot) for plot in drawn])),
        scripts=[Markup(script) for script in scripts],
    )


def sections_of(content: Content, words: Words) -> Mapping[str, Blocks]:
    """Section by section, in their order; those without a block are left out."""
    found = content.verification
    over = {cause: plots.clouds(content, words, *causes) for cause, causes in _CAUSES.items()}
    lacks = _lacks(content, words)
    return {
        "summary": [
            summary.ending(content, words),
            summary.tiles(content, words),
            *summary.counts(content, words),
        ],
        "laboratory": [] if content.laboratory is None else [laboratory.facts(content, words)],
        "method": method.method(content, words),
        "quality": quality.quality(content, words),
        "distribution": plots.distributions(content, words),
        "joints": [
            *([blocks.Paragraph(words("joints.note"), "note")] if over["joints"] else []),
            *_clouds(over["joints"], words),
            *lacks("study", "joint"),
        ],
        "reach": [*_clouds(over["reach"], words), *lacks("study", "temperature")],
        "poses": plots.poses(content),
        "space": [*plots.space(content), *lacks("study", "quiver")],
        "arm": plots.arm(content, words),
        "parameters": [*parameters.parameters(content, words), *_cylindrical(content, words)],
        "determined": determined.determined(content, words),
        "moved": moved.moved(content, words),
        "correlation": observability.correlation(content, words),
        "observability": observability.observability(content, words),
        "lengths": [*plots.lengths(content, words), *lacks("study", "lengths", "verification")],
        "verification": []
        if found is None
        else [
            *acceptance.verification(found, words),
            *plots.tested_lengths(found, words),
            *acceptance.formulas(found, words),
            *acceptance.singles(found, words, MOST_SINGLES),
        ],
        "artefacts": touched.artefacts(content, words),
        "environment": conditions.conditions(content, words),
        "decision": [*decision.decision(content, words), *([] if found is None else risk.risks(found.file, words))],
        "traceability": [*traceability.traceability(content, words), *lacks("laboratory")],
        "outliers": far_off.outliers(content, words, MOST_OUTLIERS),
        "placements": placements.placements(content, words, MOST_PLACEMENTS),
        "extras": extras.extras(content, words),
        "provenance": [provenance.facts(content, words), provenance.files(content, words)],
    }


_CAUSES = {"joints": ("joint",), "reach": ("reach", "temperature")}


def _lacks(content: Content, words: Words) -> Callable[..., list[blocks.Block]]:
    return lambda *keys: lacking.lacking(content, words, *keys)


def _clouds(drawings: Sequence[blocks.Drawing], words: Words) -> Blocks:
    """Plots side by side, their legend once for all of them."""
    return [cloud_legend(words), blocks.Drawings(drawings, narrow=True)] if drawings else []


def _cylindrical(content: Content, words: Words) -> list[blocks.Block]:
    found = parameters.cylindrical(content, words)
    return [blocks.Heading(words("parameters.cylindrical")), *found] if found else []


def _drawn(plot: Plot | Still, drawn: list[Plot]) -> Plot | Still:
    """What the script has to draw is kept."""
    if isinstance(plot, Plot):
        drawn.append(plot)
    return plot


def _data(plot: Plot) -> dict[str, Any]:
    return {"name": plot.name, "data": plot.data, "layout": plot.layout, "solid": plot.solid}


def _plotly() -> str:
    """Plotly's own script, as it came with the package: the page needs no server for it."""
    from plotly.offline import get_plotlyjs

    source: str = get_plotlyjs()
    return source.replace("\r\n", "\n").replace("\r", "\n")
