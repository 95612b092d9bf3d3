"""The whole page: head with its policy, sections in their order, figures with their data."""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence
from importlib import resources

from ulna.documents.content import Content
from ulna.documents.html import laboratory, summary, tables, verification
from ulna.documents.html.markup import json_in_script, paragraph, section, text, words_for_figures, words_for_page
from ulna.documents.html.parameter_plots import correlation_plot, length_plot, singular_plot
from ulna.documents.html.plots import Plot
from ulna.documents.html.residual_plots import cloud_plot, distribution_plots, pose_plot, space_plot
from ulna.documents.languages.words import Words
from ulna.ground.digits import small

#: nothing is fetched, sent or framed, and only the two scripts of this file run, known by their SHA-256
POLICY = (
    "default-src 'none'; script-src {scripts}; style-src 'unsafe-inline'; img-src data: blob:; font-src data:; "
    "connect-src 'none'; base-uri 'none'; form-action 'none'"
)


def render(content: Content, language: str = "en") -> str:
    """The page as text, to be written as UTF-8. The same content gives the same text."""
    words, labels = words_for_page(language), words_for_figures(language)
    plots: list[Plot] = []
    sections = _sections(content, words, labels, plots)
    scripts = [_plotly(), _asset("figures.js")]
    policy = POLICY.format(scripts=" ".join(f"'sha256-{_digest(script)}'" for script in scripts))
    title = words("title.of", arm=content.arm)
    data = json_in_script([{"name": p.name, "data": p.data, "layout": p.layout, "solid": p.solid} for p in plots])
    made = content.provenance
    draft = words("draft-note", program=made.program, version=made.version, result=made.result)
    entries = "".join(f'<li><a href="#{key}">{words(f"section.{key}")}</a></li>\n' for key in sections)
    return (
        f'<!DOCTYPE html>\n<html lang="{words("language")}">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<meta name="generator" content="{text(made.program)} {text(made.version)}">\n'
        '<meta name="color-scheme" content="light dark">\n'
        f"<title>{text(content.arm)} – {words('title')}</title>\n"
        f"<style>\n{_asset('style.css')}</style>\n</head>\n<body>\n"
        f'<header><div class="tools"><button id="theme" type="button">{words("theme")}</button>'
        f'<button id="print" type="button">{words("print")}</button></div>\n'
        f"<h1>{title}</h1>\n{paragraph(words('made-on', time=made.time))}{paragraph(draft, 'note')}"
        f"{paragraph(words('decimal-note'), 'note')}"
        f"<noscript>{paragraph(words('script-note'), 'missing')}</noscript></header>\n"
        f'<nav aria-label="{words("contents")}"><ol>\n{entries}</ol></nav>\n'
        f"<main>\n{''.join(sections.values())}</main>\n"
        f'<script type="application/json" id="figure-data">{data}</script>\n'
        + "".join(f"<script>{script}</script>\n" for script in scripts)
        + "</body>\n</html>\n"
    )


def _sections(content: Content, words: Words, labels: Words, plots: list[Plot]) -> dict[str, str]:
    """Section by section, HTML; fills the list of figures."""

    def figure(plot: Plot, heading: str = "") -> str:
        plots.append(plot)
        head = f"<h3>{heading}</h3>\n" if heading else ""
        return (
            f'<figure>{head}<div class="plot" id="plot-{plot.name}" style="height:{plot.height_px}px"></div>\n'
            f"<figcaption>{plot.caption}</figcaption></figure>\n"
        )

    def grid(figures: Sequence[str]) -> str:
        return f'<div class="grid">\n{"".join(figures)}</div>\n' if figures else ""

    def lacks(*keys: str) -> str:
        return "".join(paragraph(words.say(content.missing[key]), "missing") for key in keys if key in content.missing)

    rows = content.readings
    clouds = {over: [cloud for cloud in content.clouds if cloud.over == over] for over in _OVER}
    known = content.parameters
    found = {
        "summary": summary.summary(content, words),
        "laboratory": laboratory.laboratory(content, words),
        "quality": summary.quality(content, words),
        "distribution": grid([figure(plot) for plot in distribution_plots(content.samples, words, labels)])
        + paragraph(words("distribution.note"), "note"),
        "joints": (paragraph(words("joints.note"), "note") + _legend(words) if clouds["joint"] else "")
        + grid(
            [
                figure(cloud_plot(cloud, rows, words, labels), words("joint.number", joint=cloud.joint))
                for cloud in clouds["joint"]
            ]
        )
        + lacks("study", "joint"),
        "reach": (_legend(words) if clouds["reach"] else "")
        + grid([figure(cloud_plot(cloud, rows, words, labels)) for over in _OVER[1:] for cloud in clouds[over]])
        + lacks("study", "temperature"),
        "poses": figure(pose_plot(rows, words, labels)) if len(rows.size_mm) else "",
        "space": (figure(space_plot(content.quiver, content, words, labels)) if content.quiver is not None else "")
        + lacks("study", "quiver"),
        "parameters": tables.parameter_tables(content, words),
        "determined": tables.determined(content, words),
        "correlation": (
            figure(correlation_plot(known, words, labels)) + tables.strongest(content, words)
            if known.correlation_names
            else ""
        )
        + lacks("correlation"),
        "observability": (
            figure(singular_plot(content.observability, words, labels)) + tables.observability_table(content, words)
            if content.observability is not None
            else ""
        )
        + lacks("observability"),
        "lengths": (figure(length_plot(content.lengths, words, labels)) if content.lengths is not None else "")
        + lacks("study", "lengths", "verification"),
        "verification": verification.verification(content, words)
        + grid(
            [
                figure(verification.tested_lengths_plot(number, each, words, labels))
                for number, each in enumerate(content.verification.lengths if content.verification else [])
            ]
        )
        + verification.details(content, words),
        "artefacts": tables.artefact_table(content, words) + lacks("study"),
        "environment": laboratory.conditions(content, words) + _environment(content, words),
        "decision": verification.decision(content, words),
        "traceability": laboratory.traceability(content, words) + lacks("laboratory"),
        "outliers": tables.outlier_table(content, words),
        "placements": tables.placement_table(content, words),
        "extras": tables.extra_table(content, words),
        "provenance": tables.provenance_tables(content, words),
    }
    return {key: section(key, words, inner) for key, inner in found.items() if inner}


_OVER = ("joint", "reach", "temperature")


def _legend(words: Words) -> str:
    """Of the clouds, once for all of them."""
    marks = (("●", "main", "readings"), ("✕", "outlier", "outliers"), ("◆", "ink", "mean"))
    each = "".join(
        f'<span><span class="{colour}" aria-hidden="true">{sign}</span> {words(f"legend.{key}")}</span>'
        for sign, colour, key in marks
    )
    return f'<p class="legend">{each}</p>\n'


def _environment(content: Content, words: Words) -> str:
    found = content.environment
    if found.temperature_c is None:
        said = [(words("environment.no-temperature"), "missing")]
    else:
        low, mean, high = (f"{value:.1f}" for value in found.temperature_c)
        said = [(words("environment.temperature", low=low, mean=mean, high=high), "")]
    if found.encoder_rad:
        each = found.encoder_rad
        one = len(set(each)) == 1
        encoder = ", ".join(small(value, 2) for value in (each[:1] if one else each))
        said.append((words("environment.encoder", encoder=encoder), ""))
    if found.seat_mm is not None:
        said.append((words("environment.seat", seat=f"{found.seat_mm:g}"), ""))
    if not found.encoder_rad and found.seat_mm is None:
        said.append((words("environment.no-noise"), "missing"))
    if content.laboratory is None or content.laboratory.file.environment.humidity is None:
        said.append((words("environment.else"), "note"))
    return "".join(paragraph(each, kind) for each, kind in said)


def _asset(file: str) -> str:
    return (resources.files("ulna.documents.html") / file).read_text(encoding="utf-8").replace("\r\n", "\n")


def _plotly() -> str:
    """Plotly's own script, as it came with the package: the page needs no server for it."""
    from plotly.offline import get_plotlyjs

    source: str = get_plotlyjs()
    return source.replace("\r\n", "\n").replace("\r", "\n")


def _digest(script: str) -> str:
    """As a Content-Security-Policy knows a script: base64 of its SHA-256."""
    return base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
