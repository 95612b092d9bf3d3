"""Numbers in D-SI: single ones and lists, with what is known of their uncertainty.

Numbers stand in full, as the shortest decimal that reads back as the same double. `significantDigit` says to which
power of ten a value and its U are to be rounded for people: the second digit of U. In the certificate of an accredited
laboratory they are rounded so already (ILAC-P14:09/2020: at most two digits of U, the value to the same place).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ulna.documents.certified.parameters import last_place
from ulna.documents.dcc.sheet import Element, Sheet, Texts
from ulna.documents.dcc.units import dsi_product, dsi_unit
from ulna.ground.arrays import F64
from ulna.ground.digits import rounded


@dataclass(frozen=True)
class Expanded:
    """Expanded uncertainties of a list of values, all with the same k and p."""

    values: Sequence[float]
    """Each in the unit of its value."""
    k: float
    p: float
    distribution: str | None = None
    """"normal" or "t", where it is known."""
    rounded: bool = False
    """Whether U has two digits here, and each value its place."""


@dataclass(frozen=True)
class Region:
    """The ellipsoid that holds all values of a list together (JCGM 102)."""

    covariance: F64
    """(n, n), in products of the values' units."""
    k: float
    p: float


def number(value: float) -> str:
    """A double as the shortest decimal that reads back the same; no minus before a zero."""
    return repr(float(value) + 0.0)


def plain(value: float) -> str:
    """A coverage factor or probability: D-SI allows them no exponent."""
    return str(np.format_float_positional(value, trim="0"))


def pair(value: float, expanded: float, unit: str, to_two_digits: bool) -> tuple[str, str]:
    """A value and its U, both in full or both as a certificate rounds them."""
    if not to_two_digits or expanded == 0.0:
        return number(value), number(expanded)
    return rounded(value, expanded, unit)


def two_digits(value: float, to_two_digits: bool) -> float:
    """A contributor or a guard band, in full or as U is rounded."""
    return float(f"{value:.1e}") if to_two_digits else value


def label(name: str) -> str:
    """A name as an entry of a list: D-SI separates entries by blanks, so a blank is written %20 and a % %25."""
    return name.replace("%", "%25").replace(" ", "%20").replace("\t", "%09").replace("\n", "%0A").replace("\r", "%0D")


def real(
    sheet: Sheet,
    parent: Element,
    value: float,
    unit: str,
    expanded: tuple[float, float, float] | None = None,
    to_two_digits: bool = False,
) -> None:
    """One number; expanded: U in the same unit, k, p; to_two_digits: of U, and the value to the same place."""
    element = sheet.si(parent, "real")
    if expanded is None:
        sheet.si(element, "value", number(value))
        sheet.si(element, "unit", dsi_unit(unit))
        return
    u_expanded, k, p = expanded
    shown, u_shown = pair(value, u_expanded, unit, to_two_digits)
    sheet.si(element, "value", shown)
    sheet.si(element, "unit", dsi_unit(unit))
    place = last_place(u_expanded)
    if place is not None:
        sheet.si(element, "significantDigit", str(place))
    univariate = sheet.si(sheet.si(element, "measurementUncertaintyUnivariate"), "expandedMU")
    sheet.si(univariate, "valueExpandedMU", u_shown)
    sheet.si(univariate, "coverageFactor", plain(k))
    sheet.si(univariate, "coverageProbability", plain(p))


def standard_real(sheet: Sheet, parent: Element, value: float, unit: str, u: float) -> None:
    """One number with its standard uncertainty in the same unit."""
    element = sheet.si(parent, "real")
    sheet.si(element, "value", number(value))
    sheet.si(element, "unit", dsi_unit(unit))
    univariate = sheet.si(sheet.si(element, "measurementUncertaintyUnivariate"), "standardMU")
    sheet.si(univariate, "valueStandardMU", number(u))


def real_list(
    sheet: Sheet,
    parent: Element,
    names: Sequence[str],
    values: Sequence[float],
    units: Sequence[str],
    expanded: Expanded | None = None,
    region: Region | None = None,
) -> None:
    """A list of numbers, each with a label and a unit; one unit stands for all where they are the same."""
    element = sheet.si(parent, "realListXMLList")
    sheet.si(element, "labelXMLList", " ".join(label(name) for name in names))
    shown, u_shown = [number(value) for value in values], []
    if expanded is not None:
        pairs = zip(values, expanded.values, units, strict=True)
        both = [pair(value, of_value, unit, expanded.rounded) for value, of_value, unit in pairs]
        shown, u_shown = [value for value, _ in both], [of_value for _, of_value in both]
    sheet.si(element, "valueXMLList", " ".join(shown))
    sheet.si(element, "unitXMLList", _units([dsi_unit(unit) for unit in units]))
    if expanded is not None:
        places = [last_place(value) for value in expanded.values]
        if None not in places:
            sheet.si(element, "significantDigitXMLList", " ".join(str(place) for place in places))
        univariate = sheet.si(sheet.si(element, "measurementUncertaintyUnivariateXMLList"), "expandedMUXMLList")
        sheet.si(univariate, "valueExpandedMUXMLList", " ".join(u_shown))
        sheet.si(univariate, "coverageFactorXMLList", plain(expanded.k))
        sheet.si(univariate, "coverageProbabilityXMLList", plain(expanded.p))
        if expanded.distribution is not None:
            sheet.si(univariate, "distributionXMLList", expanded.distribution)
    if region is not None:
        _region(sheet, element, region, units)


def _region(sheet: Sheet, parent: Element, region: Region, units: Sequence[str]) -> None:
    """Column by column; the unit of the entry in row i and column j is the product of the units of values i and j, so
    that mm and rad stand in one matrix and nothing is scaled."""
    multivariate = sheet.si(parent, "measurementUncertaintyMultivariateXMLList")
    ellipsoidal = sheet.si(multivariate, "ellipsoidalRegionMUXMLList")
    matrix = sheet.si(ellipsoidal, "covarianceMatrixXMLList")
    for column, own in enumerate(units):
        entries = sheet.si(sheet.si(matrix, "columnXMLList"), "covarianceXMLList")
        values = region.covariance[:, column].tolist()
        sheet.si(entries, "valueXMLList", " ".join(number(value) for value in values))
        sheet.si(entries, "unitXMLList", _units([dsi_product(row, own) for row in units]))
    sheet.si(ellipsoidal, "coverageFactorXMLList", plain(region.k))
    sheet.si(ellipsoidal, "coverageProbabilityXMLList", plain(region.p))


def _units(units: list[str]) -> str:
    return units[0] if len(set(units)) == 1 else " ".join(units)


def quantity(
    sheet: Sheet, parent: Element, name: Texts, ref: str | None = None, description: Texts | None = None
) -> Element:
    """An empty dcc:quantity with its name."""
    element = sheet.dcc(parent, "quantity", ref=ref)
    sheet.text(element, "name", name)
    if description is not None:
        sheet.text(element, "description", description)
    return element
