"""What stands in a certificate, in a few lines."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from rich.console import RenderableType
from rich.text import Text

_MISSING = {
    "traceability": "no statement on traceability ([traceability])",
    "humidity": "no humidity ([environment])",
    "equipment": "no standards by name ([[equipment]])",
    "issued": "no day of issue ([certificate] issued)",
}


def certificate_report(held: Mapping[str, Any]) -> list[RenderableType]:
    """All of `ulna certificate`; held: as `Certificate.as_dict` says."""
    of = held["parameters"]
    lines = [f"{held['identifier']}: {held['format']}, not signed"]
    lines.append(f" {of['fitted']} parameters with U = k u, k = {of['k']:.2f}, and their covariance")
    lines.append(f" {of['held']} held, {of['not_determined']} not determined: said so, without U")
    if of["without_uncertainty"]:
        lines.append(f" {of['without_uncertainty']} fitted of which no uncertainty can be given: said so, without U")
    for tests in held["tests"]:
        lines.append(f" {len(tests['values'])} test values, {tests['title']}: {tests['conformity'] or 'no limits'}")
        if tests["lifted"]:
            lines.append(f"  U lifted to the laboratory's CMC, and decided anew: {', '.join(tests['lifted'])}")
        if tests["without_cmc"]:
            lines.append(f"  the laboratory file states no CMC of {', '.join(tests['without_cmc'])}")
    if held["missing"]:
        lines.append("The laboratory file says nothing of:")
        lines += [f" {_MISSING[key]}" for key in held["missing"]]
    return [Text(line) for line in lines]
