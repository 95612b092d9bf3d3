"""Readings far off the rest, in words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import RenderableType
from rich.text import Text

from ulna.calibration.summary import FitSummary
from ulna.cli.printed.tables import heading, listed
from ulna.ground.digits import figure_mm

_MOST = 10


def far_off(outliers: Sequence[Mapping[str, Any]], fit: FitSummary) -> list[RenderableType]:
    """Where they are, how far off, and how they counted; nothing where there are none."""
    if not outliers:
        return []
    parts: list[RenderableType] = ["", heading(f"Far off the rest: {len(outliers)} of {fit.readings} readings")]
    parts.append(listed([_one(entry)] for entry in outliers[:_MOST]))
    more = f" The other {len(outliers) - _MOST} are in result.json and residuals.csv." if len(outliers) > _MOST else ""
    if fit.loss == "none":
        counted = 'They counted in full. Look at them; loss = "huber" in [fit] lets such readings count less.'
    else:
        counted = "The loss let them count as little as is said. Look at them: what is wrong is best left out."
    return [*parts, Text(counted + more)]


def _one(entry: Mapping[str, Any]) -> str:
    names = [entry["artefact"], f"placement {entry['placement']}"]
    names += [entry["feature"]] if "feature" in entry else []
    counted = "" if "counted" not in entry else f", counted {entry['counted']:.2g}"
    place = f" ({entry['place']})" if "place" in entry else ""
    return (
        f"row {entry['row']}{place} of {entry['file']} ({', '.join(names)}): {figure_mm(entry['norm_mm'])} mm, "
        f"{entry['times_scatter']:.3g} times the scatter{counted}"
    )
