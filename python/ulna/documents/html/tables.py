"""The tables of a report: parameters, what is not determined, observability, artefacts, outliers, placements, files."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ulna.arm.directions import combination, sentence
from ulna.artefacts.quantities import NAMES
from ulna.calibration.placements import PlacementFigures, without_repeats
from ulna.documents.content import Content, ParameterRow
from ulna.documents.html.markup import name, number, paragraph, table, text
from ulna.documents.languages.words import Words
from ulna.ground.digits import decimals, figure_mm, fixed, quantity, uncertainty

MOST_OUTLIERS = 2000
MOST_PLACEMENTS = 500
MOST_PAIRS = 10
"""Of strongest correlations."""


def parameter_tables(content: Content, words: Words) -> str:
    """Every parameter, and the tips in cylindrical form."""
    known = content.parameters
    heads = [
        words("column.parameter"),
        words("column.unit"),
        words("column.status"),
        words("column.nominal"),
        words("column.estimate"),
        words("column.u"),
        words("column.expanded"),
        words("column.ratio"),
    ]
    page = table(heads, (_parameter(row, words) for row in known.rows), words("section.parameters"), left=3)
    if np.isnan(known.k):
        page += paragraph(words("parameters.no-u"), "missing")
    else:
        how = words("parameters.stated")
        if np.isfinite(known.degrees_of_freedom):
            how = words("parameters.estimated", freedom=int(known.degrees_of_freedom))
        about = words("parameters.note", k=f"{known.k:.2f}", p=f"{100 * known.p:g}")
        page += paragraph(f"{about} {how} {words('parameters.only')}", "note")
    return page + _cylindrical(content, words)


def _parameter(row: ParameterRow, words: Words) -> list[str]:
    ratio = "–" if row.ratio is None else text(number(row.ratio))
    status: str = words(f"status.{row.status}")
    if row.cause is not None and words.has(f"cause.{row.cause}"):
        status += f" <small>({words(f'cause.{row.cause}')})</small>"
    return [
        name(row.name),
        text(row.unit),
        status,
        text(quantity(row.nominal, row.u, row.unit)),
        text(quantity(row.estimate, row.u, row.unit)),
        text(uncertainty(row.u)),
        text(uncertainty(row.expanded)),
        ratio,
    ]


def _cylindrical(content: Content, words: Words) -> str:
    rows = []
    for view in content.parameters.probes:
        status = words(f"status.{view.status}")
        if view.theta0_rad is None:
            shown: list[str] = [words("parameters.undefined"), words("parameters.undefined")]
        else:
            shown = [fixed(view.theta0_rad, decimals(view.u_theta0_rad, "rad")), uncertainty(view.u_theta0_rad)]
        rows.append([name(f"probe.{view.name}"), "θ₀", "rad", status, *shown])
        for symbol, value, u in (("r", view.r_mm, view.u_r_mm), ("h", view.h_mm, view.u_h_mm)):
            u_shown = words("parameters.undefined") if symbol == "r" and view.on_axis else uncertainty(u)
            rows.append([name(f"probe.{view.name}"), symbol, "mm", status, fixed(value, decimals(u, "mm")), u_shown])
    title = words("parameters.cylindrical")
    heads = [words(f"column.{key}") for key in ("probe", "parameter", "unit", "status", "value", "u")]
    return f"<h3>{title}</h3>\n{table(heads, rows, title, left=4)}"


def determined(content: Content, words: Words) -> str:
    """Directions that are lost or weak, with cause and remedy."""
    found = content.identification
    page = ""
    if not found.lost:
        page = paragraph(words("determined.with-priors" if found.from_prior else "determined.all"))
    for title, directions in (("determined.lost", found.lost), ("determined.weak", found.weak)):
        if directions:
            page += f"<h3>{words(title)}</h3>\n" + _directions(directions, words(title), words)
    if found.lost or found.weak:
        page += paragraph(words("note.english"), "note") if words.language != "en" else ""
    if found.from_prior:
        page += paragraph(words("determined.from-prior", names=", ".join(found.from_prior)))
    return page


def _directions(directions: Sequence[Mapping[str, Any]], label: str, words: Words) -> str:
    rows = []
    for each in directions:
        cause = str(each.get("cause", ""))
        key = f"cause.{cause}"
        frame = f" {words('determined.frame')}" if each.get("frame") else ""
        u = f"u = {text(uncertainty(each['u']))} {text(each['unit'])}" if "u" in each else ""
        rows.append(
            [
                name(combination(each["combination"])),
                (words(key) if words.has(key) else name(cause)) if cause else u,
                f'<span lang="en">{name(sentence(each["because"]))}</span>{frame}',
                f'<span lang="en">{name(sentence(each["remedy"]))}</span>',
            ]
        )
    heads = [words("column.combination"), words("column.cause"), words("column.because"), words("column.remedy")]
    return f'<div class="prose">{table(heads, rows, label, left=4)}</div>'


def strongest(content: Content, words: Words) -> str:
    """The pairs of parameters that are correlated the most."""
    r, names = content.parameters.correlation, content.parameters.correlation_names
    first, second = np.triu_indices(len(names), 1)
    size = np.abs(np.nan_to_num(r[first, second]))
    order = np.argsort(-size, kind="stable")[:MOST_PAIRS]
    rows = [[name(names[first[k]]), name(names[second[k]]), f"{r[first[k], second[k]]:.3f}"] for k in order]
    heads = [words("column.first"), words("column.second"), words("column.correlation")]
    title = words("correlation.strongest")
    return f"<h3>{title}</h3>\n{table(heads, rows, title, left=2)}" if rows else ""


def observability_table(content: Content, words: Words) -> str:
    """O1 to O5 with their formulas."""
    if content.observability is None:
        return ""
    rows = [[key, words(key), text(number(value))] for key, value in content.observability.indices.items()]
    heads = [words("column.index"), words("column.formula"), words("column.value")]
    return table(heads, rows, words("section.observability"), left=2)


def artefact_table(content: Content, words: Words) -> str:
    """What was touched, and what is calibrated of it."""
    rows = []
    for row in content.artefacts:
        unknown = row.u_mm is None
        u: str = words("dimension.unknown") if unknown else words("artefact.u-none")
        if row.u_mm:
            u = f"{text(uncertainty(row.u_mm))} mm"
        if row.dimension is None:
            what: str = words("dimension.unknown" if unknown else "dimension.none")
            u = "–" if not unknown else u
        else:
            value = text(f"{row.value_mm:.10g}") if row.value_mm is not None else ""
            what = words(f"dimension.{row.dimension}", value=value, features=row.features)
        frame = f", {words('artefact.frame-arm')}" if row.frame == "arm" else ""
        rows.append(
            [name(row.name), words(f"kind.{row.kind}"), what + frame, u, str(row.placements), str(row.readings)]
        )
    heads = [words(f"column.{key}") for key in ("artefact", "kind", "calibrated", "u", "placements", "count")]
    page = table(heads, rows, words("section.artefacts"), left=4) + paragraph(words("artefacts.note"), "note")
    without = [row.name for row in content.artefacts if row.dimension is not None and row.u_mm == 0.0]
    return page + (paragraph(words("artefacts.no-u", names=", ".join(without)), "missing") if without else "")


def outlier_table(content: Content, words: Words) -> str:
    """All of them; of thousands the farthest, and how many more there are."""
    if not content.outliers:
        return paragraph(words("outliers.none"))
    counted = any("counted" in entry for entry in content.outliers)
    keys = ["row", "file", "artefact", "placement", "feature", "probe"]
    heads = [words(f"column.{key}") for key in (*keys, "size", "times", *(["counted"] if counted else []))]
    rows = []
    for entry in content.outliers[:MOST_OUTLIERS]:
        cells = [name(entry.get(key, "–")) for key in keys]
        cells += [text(figure_mm(entry["norm_mm"])), text(number(float(entry["times_scatter"])))]
        rows.append(cells + ([text(number(float(entry.get("counted", 1.0))))] if counted else []))
    page = table(heads, rows, words("section.outliers"), left=6, tall=True) + paragraph(words("outliers.note"), "note")
    more = len(content.outliers) - MOST_OUTLIERS
    return page + (paragraph(words("outliers.more", more=more, shown=MOST_OUTLIERS), "missing") if more > 0 else "")


def placement_table(content: Content, words: Words) -> str:
    """The figures of each placement; of very many those with the largest errors."""
    entries = content.placements
    columns = [key for key in NAMES if any(key in entry.figures for entry in entries)]
    columns = without_repeats(entries, [key for key in columns if "_rms_" not in key])
    kept: Sequence[PlacementFigures] = entries
    if len(entries) > MOST_PLACEMENTS:
        size = [max((abs(value) for value in entry.figures.values()), default=0.0) for entry in entries]
        order = np.argsort(-np.array(size), kind="stable")[:MOST_PLACEMENTS]
        kept = [entries[k] for k in sorted(order.tolist())]
    rows = [
        [
            name(entry.artefact),
            name(entry.placement),
            str(entry.readings),
            *(text(figure_mm(entry.figures[key])) if key in entry.figures else "–" for key in columns),
        ]
        for entry in kept
    ]
    heads = [words("column.artefact"), words("column.placement"), words("column.count")]
    heads += [words(f"figure.{key}") for key in columns]
    page = table(heads, rows, words("section.placements"), left=2, tall=True) + paragraph(
        words("placements.note"), "note"
    )
    if len(kept) < len(entries):
        page += paragraph(words("placements.more", shown=len(kept), count=len(entries)), "missing")
    return page


def extra_table(content: Content, words: Words) -> str:
    """Blocks beyond geometry and their verdicts; nothing where none was asked for."""
    if not content.extras:
        return ""
    rows = []
    for each in content.extras:
        order = "" if each.order is None else f", {words('extra.order', order=each.order)}"
        u = "–" if each.u_better_by_mm is None else uncertainty(each.u_better_by_mm)
        rows.append(
            [
                words(f"extra.{each.extra}") + order,
                words(f"figure.{each.figure}"),
                words(f"verdict.{each.verdict}"),
                text(figure_mm(each.without_mm)),
                text(figure_mm(each.with_mm)),
                text(figure_mm(each.better_by_mm)),
                text(u),
            ]
        )
    keys = ("extra", "quantity", "verdict", "without", "with", "better", "u-better")
    heads = [words(f"column.{key}") for key in keys]
    return table(heads, rows, words("section.extras"), left=3) + paragraph(words("extras.note"), "note")


def provenance_tables(content: Content, words: Words) -> str:
    """From what, with what and when."""
    made = content.provenance
    facts = [
        (words("provenance.program"), f"{name(made.program)} {name(made.version)}"),
        (words("provenance.time"), name(made.time)),
        (words("provenance.seed"), str(made.seed)),
        (words("provenance.study"), name(made.study if made.study is not None else "–")),
        (words("provenance.result"), f"{name(made.result)} <code>{text(made.result_sha256)}</code>"),
        (words("provenance.fit"), f"<code>{text(json.dumps(made.options, ensure_ascii=False))}</code>"),
    ]
    if made.warnings:
        facts.append((words("provenance.warnings"), "<br>".join(name(each) for each in made.warnings)))
    page = "<dl>" + "".join(f"<dt>{what}</dt><dd>{value}</dd>\n" for what, value in facts) + "</dl>\n"
    heads = [words(f"column.{key}") for key in ("file", "sha256", "state", "rows")]
    rows = [
        [name(file.path), f"<code>{text(file.sha256)}</code>", words(f"state.{file.state}"), str(file.rows)]
        for file in made.files
    ]
    rows += [[name(file.name), f"<code>{text(file.sha256)}</code>", "–", "–"] for file in made.beside]
    return page + table(heads, rows, words("section.provenance"), left=3)
