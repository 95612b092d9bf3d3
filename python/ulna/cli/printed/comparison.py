"""What `ulna compare` prints."""

from __future__ import annotations

from rich.console import RenderableType
from rich.text import Text

from ulna.cli.printed.tables import table
from ulna.comparison.compare import Compared, Comparison
from ulna.ground.digits import degrees_of_freedom, figure_mm, plain_uncertainty, quantity

_MOST = 8
"""Parameters of a comparison, where not all are asked for."""
_NONE = 1e-3
"""Smaller probabilities are not told."""


def comparison_report(found: Comparison, everything: bool = False) -> list[RenderableType]:
    """One calibration after the other; everything: all parameters."""
    parts: list[RenderableType] = []
    for step in found.steps:
        parts += ["", *_step(step, everything)] if parts else _step(step, everything)
    return parts


def _step(step: Compared, everything: bool) -> list[RenderableType]:
    parts: list[RenderableType] = [Text(f"{step.before} → {step.after}: {verdict(step)}"), Text(_largest(step))]
    parts += [Text(f"Between them: {each}.") for each in step.between]
    bands = [
        (
            f"{band.least_mm:.0f} to {band.most_mm:.0f}",
            str(band.count),
            figure_mm(band.rms_mm),
            figure_mm(band.largest_mm),
            figure_mm(band.expanded_mm),
            f"{band.en:.2f}",
        )
        for band in step.bands
    ]
    if bands:
        heads = ("length / mm", "count", "change\nrms / mm", "largest\n/ mm", "its U\n/ mm", "largest\n|change|/U")
        parts += ["", table("What it does to lengths, all over the volume", heads, bands)]
    shown = step.parameters if everything else step.parameters[:_MOST]
    rows = [
        (
            each.name,
            quantity(each.delta, each.u, each.unit),
            plain_uncertainty(each.u, each.unit),
            f"{abs(each.delta) / each.u:.1f}",
            each.unit,
        )
        for each in shown
    ]
    if rows:
        made = table("Parameters, the surest change first", ("", "change", "u", "change/u", "unit"), rows)
        made.columns[-1].justify = "left"
        parts += ["", made]
    more = len(step.parameters) - len(shown)
    if more:
        parts.append(Text(f"{more} more: --all."))
    return parts


def verdict(step: Compared) -> str:
    """One sentence, and what it rests on."""
    freedom = "" if step.degrees_of_freedom is None else f" and {degrees_of_freedom(step.degrees_of_freedom)}"
    chi2 = f"chi² {step.chi2:.1f} with {step.rank}{freedom} degrees of freedom, {_chance(step.p_value)}"
    said = "moved by more than both uncertainties explain" if step.moved else "no more than both uncertainties explain"
    lost = ""
    if step.not_determined:
        lost = (
            f" Left out: {step.not_determined} combination{'s' * (step.not_determined != 1)} of parameters that one of "
            "them did not determine."
        )
    return f"{said} ({chi2}; the largest change of a length by its u, {_chance(step.p_of_largest)}).{lost}"


def _chance(p: float) -> str:
    return f"p < {_NONE:g}" if p < _NONE else f"p = {p:.2g}"


def _largest(step: Compared) -> str:
    band = step.largest
    if band is None:
        return "No length is determined by both."
    x, y, z = band.at_mm
    change = f"{figure_mm(abs(band.largest_mm))} mm {'longer' if band.largest_mm >= 0.0 else 'shorter'}"
    return (
        f"Largest: a length of {band.length_mm:.0f} mm, its middle at ({x:.0f}, {y:.0f}, {z:.0f}) mm of the base, is "
        f"{change}, U = {figure_mm(band.expanded_mm)} mm (95 %)."
    )
