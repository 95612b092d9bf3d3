"""Every parameter, and the tips in cylindrical form.

U has two significant digits and each value is rounded to match (GUM 7.2.6), on the screen as on paper.
"""

from __future__ import annotations

import math

from ulna.arm.probes import ProbeView
from ulna.documents.content.content import Content
from ulna.documents.content.parameters import ParameterRow
from ulna.documents.languages.text import NONE, Text, joined, named, number, styled
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Paragraph, own, table
from ulna.documents.sections.scatter import no_uncertainty
from ulna.ground.digits import degrees_of_freedom, rounded, uncertainty

COLUMNS = ("number", "parameter", "unit", "status", "nominal", "estimate", "u", "expanded", "ratio")


def parameters(content: Content, words: Words) -> list[Block]:
    """All of them, none left out."""
    known = content.parameters
    rows = [_parameter(k, row, words) for k, row in enumerate(known.rows, start=1)]
    page: list[Block] = [table("parameters", words("section.parameters"), words, COLUMNS, rows, left=4)]
    without = no_uncertainty(content, words)
    if without is not None:
        page.append(Paragraph(without, "missing"))
    else:
        about = words("parameters.note", k=own(f"{known.k:.2f}"), p=own(f"{100 * known.p:g}"))
        said = [about, words("parameters.rounding"), u_comes_from(content, words), words("parameters.only")]
        page.append(Paragraph(joined(said, " "), "note"))
    return page


def u_comes_from(content: Content, words: Words) -> Text:
    """Of the noise that was stated, of the residuals, or of both."""
    freedom, found = content.parameters.degrees_of_freedom, content.fit.reading_scatter
    if math.isinf(freedom):
        elsewhere = found is not None and (found.place_factor or 1.0) > 1.0
        return words("parameters.places" if elsewhere else "parameters.stated")
    shown = own(degrees_of_freedom(freedom))
    if found is None or found.factor is None:
        return words("parameters.estimated", freedom=shown)
    return words("parameters.scaled", factor=own(f"{found.factor:.3g}"), freedom=shown)


def _parameter(k: int, row: ParameterRow, words: Words) -> list[Text]:
    estimate, expanded = rounded(row.estimate, row.expanded, row.unit)
    # the nominal is a number that was given: to the same digits where they are known
    nominal = rounded(row.nominal, row.expanded, row.unit)[0]
    ratio = NONE if row.ratio is None else own(number(row.ratio))
    numbers = [own(each) for each in (nominal, estimate, uncertainty(row.u), expanded)]
    return [own(k), named(row.name), named(row.unit), _status(row, words), *numbers, ratio]


def _status(row: ParameterRow, words: Words) -> Text:
    """With its cause, where there is a word for it."""
    status = words(f"status.{row.status}")
    if row.cause is None or not words.has(f"cause.{row.cause}"):
        return status
    return joined([status, styled(("(", *words(f"cause.{row.cause}"), ")"), "aside")], " ")


def cylindrical(content: Content, words: Words) -> list[Block]:
    """The tips once more, by angle, radius and height."""
    rows = [row for view in content.parameters.probes for row in _probe(view, content.parameters.k, words)]
    if not rows:
        return []
    columns = ("probe", "parameter", "unit", "status", "value", "u", "expanded")
    return [table("cylindrical", words("parameters.cylindrical"), words, columns, rows, left=4)]


def _probe(view: ProbeView, k: float, words: Words) -> list[list[Text]]:
    """θ₀, r and h of one tip; on the axis θ₀ is undefined, and the uncertainty of r too."""
    probe, status, undefined = (
        named(f"probe.{view.name}"),
        words(f"status.{view.status}"),
        words("parameters.undefined"),
    )

    def of(symbol: str, unit: str, value: float, u: float | None) -> list[Text]:
        expanded = None if u is None or math.isnan(k) else k * u
        shown, expanded_shown = rounded(value, expanded, unit)
        return [probe, own(symbol), own(unit), status, own(shown), own(uncertainty(u)), own(expanded_shown)]

    if view.theta0_rad is None:
        theta0 = [probe, own("θ₀"), own("rad"), status, undefined, undefined, undefined]
    else:
        theta0 = of("θ₀", "rad", view.theta0_rad, view.u_theta0_rad)
    r = of("r", "mm", view.r_mm, view.u_r_mm)
    if view.on_axis:
        r[-2:] = [undefined, undefined]
    return [theta0, r, of("h", "mm", view.h_mm, view.u_h_mm)]
