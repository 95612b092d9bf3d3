"""Numbers in D-SI: single ones and lists, with what is known of their uncertainty.

Numbers stand in full, as the shortest decimal that reads back as the same double. `significantDigit` says to which
power of ten a value and its U are to be rounded for people: the second digit of U.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ulna.documents.certified.parameters import last_place
from ulna.documents.dcc.sheet import Element, Sheet, Texts
from ulna.documents.dcc.units import dsi_product, dsi_unit

F64 = NDArray[np.float64]


@dataclass(frozen=True)
class Expanded:
    """Expanded uncertainties of a list of values, all with the same k and p."""

    values: Sequence[float]
    """Each in the unit of its value."""
    k: float
    p: float
    distribution: str | None = None
    """"normal" or "t", where it is known."""


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


def label(name: str) -> str:
    """A name as an entry of a list: D-SI separates entries by blanks, so a blank is written %20 and a % %25."""
    return name.replace("%", "%25").replace(" ", "%20").replace("\t", "%09").replace("\n", "%0A").replace("\r", "%0D")


def real(
    sheet: Sheet, parent: Element, value: float, unit: str, expanded: tuple[float, float, float] | None = None
) -> None:
    """One number; expanded: U in the same unit, k, p."""
    element = sheet.si(parent, "real")
    sheet.si(element, "value", number(value))
    sheet.si(element, "unit", dsi_unit(unit))
    if expanded is None:
        return
    u_expanded, k, p = expanded
    place = last_place(u_expanded)
    if place is not None:
        sheet.si(element, "significantDigit", str(place))
    univariate = sheet.si(sheet.si(element, "measurementUncertaintyUnivariate"), "expandedMU")
    sheet.si(univariate, "valueExpandedMU", number(u_expanded))
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
    sheet.si(element, "valueXMLList", " ".join(number(value) for value in values))
    sheet.si(element, "unitXMLList", _units([dsi_unit(unit) for unit in units]))
    if expanded is not None:
        places = [last_place(value) for value in expanded.values]
        if None not in places:
            sheet.si(element, "significantDigitXMLList", " ".join(str(place) for place in places))
        univariate = sheet.si(sheet.si(element, "measurementUncertaintyUnivariateXMLList"), "expandedMUXMLList")
        sheet.si(univariate, "valueExpandedMUXMLList", " ".join(number(value) for value in expanded.values))
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
