"""Whether stated uncertainties hold on readings that a fit has not seen, as they are printed."""

from __future__ import annotations

from rich.console import RenderableType
from rich.text import Text

from ulna.calibration.coverage import Coverage, P
from ulna.calibration.likely import Cause
from ulna.cli.printed.tables import table

_CAUSES: dict[Cause, str] = {
    "elsewhere": "poses or places elsewhere than the calibration's",
    "blocks": "the arm does something that the model has not (no extras are in it)",
    "held": "parameters were held, which count as exact",
    "artefact-u": "the artefact's own u is not stated",
    "few-places": "the calibration rests on few places or few degrees of freedom",
}


def coverage_report(found: Coverage | None) -> list[RenderableType]:
    """Nothing where nothing could be judged."""
    if found is None or not found.shares:
        return []
    rows = [
        [
            name,
            str(share.count),
            str(share.inside),
            _percent(share.share),
            f"{_percent(share.low)} … {_percent(share.high)}",
        ]
        for name, share in found.shares
    ]
    heads = ("", "judged", "inside", "share\n%", "its 95 %\ninterval, %")
    parts: list[RenderableType] = ["", table(f"Inside their stated {100 * P:g} % intervals", heads, rows)]
    said = coverage_sentence(found)
    return [*parts, Text(said, style="bold yellow")] if said else parts


def coverage_sentence(found: Coverage) -> str:
    """Whether they hold, where chance does not explain how many do; else nothing."""
    return _too_small(found) or _too_large(found)


def _too_small(found: Coverage) -> str:
    if not found.too_small:
        return ""
    factors = ", ".join(f"{factor:.2g} ({name})" for name, factor in found.too_small.items() if factor > 1.0)
    by = f" by a factor of {factors}" if factors else ""
    why = f" Likely: {'; '.join(_CAUSES[cause] for cause in found.likely)}." if found.likely else ""
    return f"The stated uncertainties are too small{by} here.{why}"


def _too_large(found: Coverage) -> str:
    part = found.too_large
    if part is None:
        return ""
    return (
        f"The stated uncertainties are larger than they need be here: {part:.2g} of them would do. Likely: the noise "
        "or an artefact's u is stated too large, or these readings are better than the calibration's."
    )


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f}"
