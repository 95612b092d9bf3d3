"""What was found: parameters with their uncertainties, how the fit ended, figures from the readings."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ulna.arm.conditions import PAYLOAD
from ulna.artefacts.quantities import NAMES
from ulna.calibration.placements import Figures
from ulna.calibration.result import Result
from ulna.calibration.summary import Parameter
from ulna.documents.certified.parameters import StatedParameters
from ulna.documents.dcc.quantities import Expanded, Region, quantity, real, real_list
from ulna.documents.dcc.sheet import Element, Sheet, Texts


def result_of(sheet: Sheet, parent: Element, name: Texts, description: Texts | None = None) -> Element:
    """A new dcc:result; its dcc:data is handed back."""
    element = sheet.dcc(parent, "result")
    sheet.text(element, "name", name)
    if description is not None:
        sheet.text(element, "description", description)
    return sheet.dcc(element, "data")


def parameters(sheet: Sheet, results: Element, result: Result, stated: StatedParameters, accredited: bool) -> None:
    """Fitted with U and their covariance, then those of which no uncertainty can be told. accredited: whether U has two
    digits, and each value its place."""
    data = result_of(sheet, results, sheet.own("dcc.parameters"), sheet.own("dcc.parameters-text"))
    if stated.fitted:
        rows = stated.fitted
        distribution = "normal" if math.isinf(stated.degrees_of_freedom) else "t"
        real_list(
            sheet,
            quantity(sheet, data, sheet.own("dcc.fitted"), "basic_measuredValue"),
            [row.name for row in rows],
            [row.value for row in rows],
            [row.unit for row in rows],
            Expanded(stated.expanded, stated.k, stated.p, distribution, accredited),
            Region(stated.covariance, stated.k_region, stated.p),
        )
        _values(sheet, data, "start", rows, [row.start for row in rows], "basic_nominalValue")
    for key, rows in (("unsure-values", stated.unsure), ("held-values", stated.held), ("lost-values", stated.lost)):
        if rows:
            _values(sheet, data, key, rows, [row.value for row in rows])
    _given(sheet, data, result)


def _values(
    sheet: Sheet, data: Element, key: str, rows: Sequence[Parameter], values: Sequence[float], ref: str | None = None
) -> None:
    names, units = [row.name for row in rows], [row.unit for row in rows]
    real_list(sheet, quantity(sheet, data, sheet.own(f"dcc.{key}"), ref), names, values, units)


def _given(sheet: Sheet, data: Element, result: Result) -> None:
    """What else is needed to compute a tip: signs of the encoders, balls, and masses where links bend under them."""
    arm = result.arm
    given: list[tuple[str, float, str]] = [
        (f"joint.{k}.sign", joint.sign, "1") for k, joint in enumerate(arm.joints, 1)
    ]
    given += [(f"probe.{name}.ball", probe.ball_mm, "mm") for name, probe in arm.probes.items() if probe.ball_mm]
    for effect in arm.effects:
        given += effect.given([joint.effects for joint in arm.joints], arm.gravity)
    for name, load in arm.payloads.items() if PAYLOAD in arm.uses else ():
        numbers = zip(("mass", *(f"centre.{axis}" for axis in "xyz")), load.numbers.tolist(), strict=True)
        given += [(f"payload.{name}.{key}", value, "kg" if key == "mass" else "mm") for key, value in numbers]
    names, values, units = zip(*given, strict=True)
    real_list(sheet, quantity(sheet, data, sheet.own("dcc.given")), names, values, units)


def fit(sheet: Sheet, results: Element, result: Result) -> None:
    """How the fit ended."""
    data = result_of(sheet, results, sheet.own("dcc.fit"))
    figures: list[tuple[str, float, str]] = [
        ("readings", result.fit.readings, "1"),
        ("freedom", result.fit.degrees_of_freedom, "1"),
        ("rms-before", result.fit.rms_start_mm, "mm"),
        ("rms-after", result.fit.rms_mm, "mm"),
    ]
    if result.fit.chi2_per_dof is not None:
        figures.append(("chi2", result.fit.chi2_per_dof, "1"))
    figures += _scatter(result)
    for key, value, unit in figures:
        real(sheet, quantity(sheet, data, sheet.own(f"dcc.{key}")), value, unit)


def _scatter(result: Result) -> list[tuple[str, float, str]]:
    """What the residuals say of a reading's noise."""
    found = result.fit.reading_scatter
    if found is None:
        return []
    each = [
        ("touch", found.touch_mm, "mm"),
        ("factor", found.factor, "1"),
        ("unexplained", found.unexplained_mm, "mm"),
        ("place-factor", found.place_factor, "1"),
    ]
    return [(key, value, unit) for key, value, unit in each if value is not None]


def figures(sheet: Sheet, results: Element, result: Result) -> None:
    """What the fitted readings give, before and after, and which lie far off."""
    data = result_of(sheet, results, sheet.own("dcc.figures"), sheet.own("dcc.figures-text"))
    _figures(sheet, data, "before", result.before)
    _figures(sheet, data, "after", result.after)
    if not result.outliers:
        sheet.text(data, "text", sheet.own("dcc.no-outliers"))
        return
    element = sheet.dcc(data, "text")
    _named(sheet, element, sheet.own("dcc.outliers"), sheet.own("dcc.outliers-kept"))
    for entry in result.outliers:
        said = sheet.own(
            "dcc.outlier",
            file=entry["file"],
            row=entry["row"],
            artefact=entry["artefact"],
            placement=entry["placement"],
            norm=f"{entry['norm_mm']:.4g}",
            times=f"{entry['times_scatter']:.3g}",
        )
        sheet.text(data, "text", said)


def _named(sheet: Sheet, element: Element, name: Texts, text: Texts) -> None:
    """Name and content of a rich text."""
    sheet.text(element, "name", name)
    for language, each in text:
        content = sheet.dcc(element, "content", each)
        if language is not None:
            content.set("lang", language)


def _figures(sheet: Sheet, data: Element, key: str, values: Figures) -> None:
    names = [name for name in NAMES if name in values]
    if names:
        one = quantity(sheet, data, sheet.own(f"dcc.{key}"))
        labels = [name.removesuffix("_mm") for name in names]
        real_list(sheet, one, labels, [values[name] for name in names], ["mm"] * len(names))
