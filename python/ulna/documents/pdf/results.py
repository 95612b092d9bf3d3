"""The results on paper: parameters, what is not determined, before and after, uncertainty, artefacts, files."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from ulna.arm.directions import combination, sentence
from ulna.documents.content import Content, ParameterRow, QualityRow
from ulna.documents.html.markup import number
from ulna.documents.languages.words import Words
from ulna.documents.pdf import blocks
from ulna.documents.pdf.blocks import Block, Cell
from ulna.documents.pdf.text import clean, name
from ulna.documents.quality import CAUTIONS
from ulna.ground.digits import figure_mm, rounded, small, uncertainty

MOST_OUTLIERS = 40
"""In print; the result has all of them."""


def parameters(content: Content, words: Words) -> list[Block]:
    """Every parameter, U with two significant digits, the estimate rounded to match."""
    known = content.parameters
    keys = ("number", "parameter", "unit", "status", "nominal", "estimate", "expanded", "ratio")
    rows = [_parameter(k, row, words) for k, row in enumerate(known.rows, start=1)]
    page = [
        blocks.heading(words("section.parameters")),
        blocks.table([words(f"column.{key}") for key in keys], rows, [0, 3, 0, 0, 0, 0, 0, 1.5], left=4),
    ]
    if math.isnan(known.k):
        page.append(blocks.paragraph(words("parameters.no-u"), "missing"))
    else:
        about = words("parameters.note", k=f"{known.k:.2f}", p=f"{100 * known.p:g}")
        page.append(blocks.paragraph(f"{about} {words('paper.rounding')}", "note"))
    return page + _cylindrical(content, words)


def _parameter(k: int, row: ParameterRow, words: Words) -> list[Cell]:
    estimate, expanded = rounded(row.estimate, row.expanded, row.unit)
    # the nominal is a number that was given: to the same digits where they are known
    nominal = rounded(row.nominal, row.expanded, row.unit)[0]
    ratio = "–" if row.ratio is None else number(row.ratio)
    status = words(f"status.{row.status}")
    return [str(k), name(row.name), clean(row.unit), status, nominal, estimate, expanded, ratio]


def _cylindrical(content: Content, words: Words) -> list[Block]:
    k = content.parameters.k
    rows: list[list[Cell]] = []
    for view in content.parameters.probes:
        probe, status = name(f"probe.{view.name}"), words(f"status.{view.status}")

        def expanded(u: float | None) -> float | None:
            return None if u is None or math.isnan(k) else k * u

        if view.theta0_rad is None:
            rows.append([probe, "θ₀", "rad", status, words("parameters.undefined"), words("parameters.undefined")])
        else:
            shown = rounded(view.theta0_rad, expanded(view.u_theta0_rad), "rad")
            rows.append([probe, "θ₀", "rad", status, *shown])
        value, u_shown = rounded(view.r_mm, expanded(view.u_r_mm), "mm")
        rows.append([probe, "r", "mm", status, value, words("parameters.undefined") if view.on_axis else u_shown])
        rows.append([probe, "h", "mm", status, *rounded(view.h_mm, expanded(view.u_h_mm), "mm")])
    if not rows:
        return []
    heads = [words(f"column.{key}") for key in ("probe", "parameter", "unit", "status", "value", "expanded")]
    return [
        blocks.heading(words("parameters.cylindrical"), 2),
        blocks.table(heads, rows, [2, 0, 0, 1, 1, 1], left=4),
    ]


def determined(content: Content, words: Words) -> list[Block]:
    """Directions that are lost or weak, with cause and remedy."""
    found = content.identification
    page = [blocks.heading(words("section.determined"))]
    if not found.lost:
        page.append(blocks.paragraph(words("determined.all")))
    for title, directions in (("determined.lost", found.lost), ("determined.weak", found.weak)):
        if directions:
            page += [blocks.heading(words(title), 2), _directions(directions, words)]
    if (found.lost or found.weak) and words.language != "en":
        page.append(blocks.paragraph(words("note.english"), "note"))
    if found.from_prior:
        page.append(blocks.paragraph(words("determined.from-prior", names=", ".join(found.from_prior))))
    return page


def _directions(directions: Sequence[Mapping[str, Any]], words: Words) -> Block:
    rows: list[list[Cell]] = []
    for each in directions:
        cause = str(each.get("cause", ""))
        key = f"cause.{cause}"
        u = f"u = {uncertainty(each['u'])} {clean(each['unit'])}" if "u" in each else ""
        shown = (words(key) if words.has(key) else name(cause)) if cause else u
        if each.get("frame"):
            shown = f"{shown}\n{words('determined.frame')}"
        said = [blocks.english(name(sentence(each[key]))) for key in ("because", "remedy")]
        rows.append([name(combination(each["combination"])), shown, *said])
    heads = [words(f"column.{key}") for key in ("combination", "cause", "because", "remedy")]
    return blocks.table(heads, rows, [1.3, 1, 1.6, 1.6], left=4)


def quality(content: Content, words: Words) -> list[Block]:
    """The before/after table, what was held out and what is missing."""
    keys = [f"{what}-{when}" for what in ("mean", "rms", "sigma", "max") for when in ("before", "after")]
    heads = [words("column.quantity"), words("column.readings"), *(words(f"column.{key}") for key in keys)]
    rows = [
        [words(f"quantity.{row.quantity}"), words(f"readings.{row.readings}"), *_quality(row)]
        for row in content.quality
    ]
    said = [
        blocks.paragraph(words.say(each), "missing" if each.key in CAUTIONS else "plain") for each in content.held_out
    ]
    return [
        blocks.heading(words("section.quality")),
        blocks.table(heads, rows, [2.1, 1.9, *[1] * 8], left=2, size_pt=7.5),
        blocks.paragraph(words("quality.note"), "note"),
        *said,
    ]


def _quality(row: QualityRow) -> list[Cell]:
    cells: list[Cell] = []
    for what in ("mean_mm", "rms_mm", "two_sigma_mm", "max_mm"):
        for each in (row.before, row.after):
            value = math.nan if each is None else float(getattr(each, what))
            cells.append("–" if math.isnan(value) else figure_mm(value))
    return cells


def uncertainty_statement(content: Content, words: Words) -> list[Block]:
    """How U came about: coverage, the sources that it has and those that it has not."""
    known = content.parameters
    page = [blocks.heading(words("section.uncertainty"))]
    if math.isnan(known.k):
        return [*page, blocks.paragraph(words("parameters.no-u"), "missing")]
    freedom = known.degrees_of_freedom
    stated = not math.isfinite(freedom)
    how = words("parameters.stated") if stated else words("parameters.estimated", freedom=int(freedom))
    page.append(blocks.paragraph(f"{words('paper.manner', k=f'{known.k:.2f}', p=f'{100 * known.p:g}')} {how}"))
    environment = content.environment
    within: list[str] = [words("included.readings" if stated else "included.scatter"), words("included.placements")]
    if environment.encoder_rad:
        shown = ", ".join(small(value, 2) for value in dict.fromkeys(environment.encoder_rad))
        within.append(words("environment.encoder", encoder=shown))
    if environment.seat_mm is not None:
        within.append(words("environment.seat", seat=f"{environment.seat_mm:g}"))
    with_u = [f"{name(row.name)} (u = {uncertainty(row.u_mm)} mm)" for row in content.artefacts if row.u_mm]
    if with_u:
        within.append(f"{words('included.artefacts')} {', '.join(with_u)}")
    without = [row.name for row in content.artefacts if row.dimension is not None and not row.u_mm]
    outside: list[str] = [words("excluded.artefacts", names=", ".join(without))] if without else []
    outside += [words(f"excluded.{key}") for key in ("thermal", "model", "time", "use")]
    return [
        *page,
        blocks.heading(words("paper.included"), 2),
        blocks.listed(within),
        blocks.heading(words("paper.excluded"), 2),
        blocks.listed(outside),
    ]


def artefacts(content: Content, words: Words) -> list[Block]:
    """What was touched, and what is calibrated of it."""
    rows: list[list[Cell]] = []
    for row in content.artefacts:
        unknown = row.u_mm is None
        u: str = words("dimension.unknown") if unknown else words("artefact.u-none")
        if row.u_mm:
            u = f"{uncertainty(row.u_mm)} mm"
        if row.dimension is None:
            what: str = words("dimension.unknown" if unknown else "dimension.none")
            u = "–"
        else:
            value = f"{row.value_mm:.10g}" if row.value_mm is not None else ""
            what = words(f"dimension.{row.dimension}", value=value, features=row.features)
        frame = f", {words('artefact.frame-arm')}" if row.frame == "arm" else ""
        rows.append(
            [name(row.name), words(f"kind.{row.kind}"), what + frame, u, str(row.placements), str(row.readings)]
        )
    heads = [words(f"column.{key}") for key in ("artefact", "kind", "calibrated", "u", "placements", "count")]
    return [
        blocks.heading(words("section.artefacts")),
        blocks.table(heads, rows, [1.5, 1, 2, 1.5, 0, 0], left=4),
        blocks.paragraph(words("artefacts.note"), "note"),
        *_lacks(content, words, "study"),
    ]


def _lacks(content: Content, words: Words, *keys: str) -> list[Block]:
    return [blocks.paragraph(words.say(content.missing[key]), "missing") for key in keys if key in content.missing]


def extras(content: Content, words: Words) -> list[Block]:
    """Blocks beyond geometry and their verdicts; nothing where none was asked for."""
    if not content.extras:
        return []
    rows: list[list[Cell]] = []
    for each in content.extras:
        order = "" if each.order is None else f", {words('extra.order', order=each.order)}"
        errors = [figure_mm(value) for value in (each.without_mm, each.with_mm, each.better_by_mm)]
        said = [words(f"extra.{each.extra}") + order, words(f"figure.{each.figure}"), words(f"verdict.{each.verdict}")]
        rows.append([*said, *errors, uncertainty(each.u_better_by_mm)])
    keys = ("extra", "quantity", "verdict", "without", "with", "better", "u-better")
    return [
        blocks.heading(words("section.extras")),
        blocks.table([words(f"column.{key}") for key in keys], rows, [1.6, 1.8, 1.2, 1, 1, 1, 1], left=3),
        blocks.paragraph(words("extras.note"), "note"),
    ]


def outliers(content: Content, words: Words) -> list[Block]:
    """The farthest, and how many more there are."""
    page = [blocks.heading(words("section.outliers"))]
    if not content.outliers:
        return [*page, blocks.paragraph(words("outliers.none"))]
    counted = any("counted" in entry for entry in content.outliers)
    keys = ("row", "file", "artefact", "placement", "probe")
    rows: list[list[Cell]] = []
    for entry in content.outliers[:MOST_OUTLIERS]:
        cells: list[Cell] = [name(entry.get(key, "–")) for key in keys]
        cells += [figure_mm(entry["norm_mm"]), number(float(entry["times_scatter"]))]
        rows.append(cells + ([number(float(entry.get("counted", 1.0)))] if counted else []))
    heads = [words(f"column.{key}") for key in (*keys, "size", "times", *(["counted"] if counted else []))]
    widths = [0, 1.5, 1, 1, 1, 0, 1, *([0.9] if counted else [])]
    page += [
        blocks.table(heads, rows, widths, left=5, size_pt=7.5),
        blocks.paragraph(words("outliers.note"), "note"),
    ]
    more = len(content.outliers) - MOST_OUTLIERS
    if more > 0:
        page.append(blocks.paragraph(words("outliers.more", more=more, shown=MOST_OUTLIERS), "missing"))
    return page


def provenance(content: Content, words: Words) -> list[Block]:
    """From what, with what and when, and the SHA-256 of all that was read."""
    made = content.provenance
    facts: list[tuple[str, list[Cell]]] = [
        (words("provenance.program"), [f"{name(made.program)} {name(made.version)}"]),
        (words("provenance.time"), [name(made.time)]),
        (words("provenance.seed"), [str(made.seed)]),
    ]
    if made.warnings:
        facts.append((words("provenance.warnings"), [name(each) for each in made.warnings]))
    rows: list[list[Cell]] = [[name(made.result), blocks.code(made.result_sha256), "–"]]
    rows += [[name(file.name), blocks.code(file.sha256), "–"] for file in made.beside]
    rows += [[name(file.path), blocks.code(file.sha256), words(f"state.{file.state}")] for file in made.files]
    heads = [words(f"column.{key}") for key in ("file", "sha256", "state")]
    return [
        blocks.heading(words("section.provenance")),
        blocks.facts(facts),
        blocks.table(heads, rows, [1, 0, 0], left=3, size_pt=7.5),
    ]


def ending_sentence(content: Content, words: Words) -> str:
    """How the fit ended."""
    key = f"ending.{content.fit.termination}"
    return words(key) if words.has(key) else name(content.fit.termination)


def ending(content: Content, words: Words) -> list[Block]:
    """How the fit ended and what it rests on."""
    fit = content.fit
    counts = words(
        "summary.counts",
        readings=fit.readings,
        observations=fit.observations,
        placements=fit.placement_unknowns,
        freedom=fit.degrees_of_freedom,
    )
    chi2 = words("summary.no-noise") if fit.chi2_per_dof is None else words("summary.chi2", chi2=fit.chi2_per_dof)
    more = [counts, chi2, _outlier_count(content, words)]
    if fit.loss != "none":
        more.append(words("summary.loss", loss=fit.loss))
    if fit.folded:
        more.append(words("summary.folded", folded=", ".join(fit.folded)))
    more += [words("summary.signs", joints=", ".join(map(str, joints))) for joints in fit.undecided_signs]
    return [
        blocks.heading(words("section.summary")),
        blocks.paragraph(ending_sentence(content, words), "plain" if fit.converged else "bad"),
        blocks.listed(more),
    ]


def _outlier_count(content: Content, words: Words) -> str:
    key = "summary.outliers" if content.fit.loss == "none" else "summary.outliers-loss"
    said: str = words(key, outliers=len(content.outliers), readings=content.fit.readings)
    return said
