"""A reader of DCC files of our own: plain ElementTree, and nothing of the code that writes them."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import unquote
from xml.etree import ElementTree

NS = {"dcc": "https://ptb.de/dcc", "si": "https://ptb.de/si"}


@dataclass
class Quantity:
    """One dcc:quantity: a list, or a single number as a list of one."""

    names: dict[str | None, str]
    labels: list[str]
    values: list[float]
    units: list[str]
    expanded: list[float] = field(default_factory=list)
    k: float | None = None
    p: float | None = None
    places: list[int] = field(default_factory=list)
    covariance: list[list[float]] = field(default_factory=list)
    covariance_units: list[list[str]] = field(default_factory=list)
    region_k: float | None = None
    conformity: str | None = None
    declared: str = ""


def tree(content: bytes) -> Any:
    return ElementTree.fromstring(content)


def said(element: Any, path: str) -> dict[str | None, str]:
    """language → text of the content elements below."""
    return {content.get("lang"): content.text or "" for content in element.findall(f"{path}/dcc:content", NS)}


def words(element: Any, path: str) -> list[str]:
    found = element.find(path, NS)
    return [] if found is None or found.text is None else found.text.split(" ")


def one(element: Any, path: str) -> float | None:
    found = words(element, path)
    return float(found[0]) if found else None


def spread(found: list[str], count: int) -> list[str]:
    """One entry stands for all."""
    return found * count if len(found) == 1 else found


def quantity(element: Any) -> Quantity:
    names = said(element, "dcc:name")
    single = element.find("si:real", NS)
    if single is not None:
        read = Quantity(names, [], [one(single, "si:value") or 0.0], words(single, "si:unit"))
        expanded = single.find("si:measurementUncertaintyUnivariate/si:expandedMU", NS)
        if expanded is not None:
            read.expanded = [float(each) for each in words(expanded, "si:valueExpandedMU")]
            read.k, read.p = one(expanded, "si:coverageFactor"), one(expanded, "si:coverageProbability")
        read.places = [int(each) for each in words(single, "si:significantDigit")]
    else:
        many = element.find("si:realListXMLList", NS)
        values = [float(each) for each in words(many, "si:valueXMLList")]
        labels = [unquote(each) for each in words(many, "si:labelXMLList")]
        read = Quantity(names, labels, values, spread(words(many, "si:unitXMLList"), len(values)))
        univariate = many.find("si:measurementUncertaintyUnivariateXMLList/si:expandedMUXMLList", NS)
        if univariate is not None:
            read.expanded = [float(each) for each in words(univariate, "si:valueExpandedMUXMLList")]
            read.k = one(univariate, "si:coverageFactorXMLList")
            read.p = one(univariate, "si:coverageProbabilityXMLList")
        read.places = [int(each) for each in words(many, "si:significantDigitXMLList")]
        region = many.find("si:measurementUncertaintyMultivariateXMLList/si:ellipsoidalRegionMUXMLList", NS)
        if region is not None:
            columns = region.findall("si:covarianceMatrixXMLList/si:columnXMLList/si:covarianceXMLList", NS)
            read.covariance = [[float(each) for each in words(column, "si:valueXMLList")] for column in columns]
            read.covariance_units = [spread(words(column, "si:unitXMLList"), len(columns)) for column in columns]
            read.region_k = one(region, "si:coverageFactorXMLList")
    conformity = element.find("dcc:measurementMetaData/dcc:metaData/dcc:conformity", NS)
    if conformity is not None:
        read.conformity = conformity.text
        read.declared = "\n".join(said(element, "dcc:measurementMetaData/dcc:metaData/dcc:declaration").values())
    return read


def quantities(content: bytes) -> list[Quantity]:
    """All quantities among the results, in their order."""
    found = tree(content).findall("dcc:measurementResults/dcc:measurementResult/dcc:results//dcc:quantity", NS)
    return [quantity(each) for each in found]


def named(content: bytes, name: str) -> Quantity:
    """The one quantity of that name in any language."""
    (found,) = [each for each in quantities(content) if name in each.names.values()]
    return found


def statements(content: bytes) -> dict[str, list[str]]:
    """English (or only) name → declarations of the statements."""
    found: dict[str, list[str]] = {}
    for element in tree(content).findall("dcc:administrativeData/dcc:statements/dcc:statement", NS):
        name, text = said(element, "dcc:name"), said(element, "dcc:declaration")
        found.setdefault(name.get("en", next(iter(name.values()))), []).append(
            text.get("en", next(iter(text.values())))
        )
    return found


def exponents(unit: str) -> dict[str, int]:
    r"""`\milli\metre\tothe{2}` → {"mm": 2}: units of D-SI taken apart, for the units that arms have."""
    found: dict[str, int] = {}
    text = unit.replace(r"\milli\metre", r"\mm")
    for name, exponent in re.findall(
        r"\\(mm|metre|radian|kelvin|newton|degreecelsius|one)(?:\\tothe\{(-?\d+)\})?", text
    ):
        if name != "one":
            found[name] = found.get(name, 0) + int(exponent or 1)
    assert re.sub(r"\\(mm|metre|radian|kelvin|newton|degreecelsius|one)(\\tothe\{-?\d+\})?", "", text) == ""
    return {name: exponent for name, exponent in found.items() if exponent}


def schema(folder: Path) -> Any:
    """The XSD as lxml reads it, from the folder alone: a look at the network is an error."""
    from lxml import etree

    class Offline(etree.Resolver):  # type: ignore[misc, name-defined]
        def resolve(self, url: str, public_id: str, context: Any) -> Any:
            if "://" in url and not url.startswith("file:"):
                raise AssertionError(f"asked for {url}")
            return None

    parser = etree.XMLParser(no_network=True)
    parser.resolvers.add(Offline())
    return etree.XMLSchema(etree.parse(str(folder / "v3.3.0" / "dcc.xsd"), parser))
