"""How sure a measured value is, for the terminal."""

from __future__ import annotations

from rich.console import RenderableType
from rich.text import Text

from ulna.report.digits import uncertainty
from ulna.report.tables import heading, listed, table
from ulna.uncertainty.assess import Assessment, Value, not_determined
from ulna.uncertainty.monte_carlo import MonteCarlo

_SOURCES = {
    "parameters": "the calibration's parameters",
    "encoders": "the encoders, while measuring",
    "touch": "the touch",
    "temperature": "the temperature",
}


def uncertainty_report(found: Assessment) -> list[RenderableType]:
    """Values with their uncertainties, what Monte Carlo says, who contributes, what is left out."""
    percent = f"{100 * found.p:g} %"
    known = [value for value in found.values if value.u_mm is not None]
    rows = [(value.name, *_number(value)) for value in found.values]
    heads = ("", "value / mm", "u / mm", "k", f"U / mm (p = {percent})")
    what = f"{found.kind.capitalize()}, probe {found.probe}, {found.readings} readings."
    parts: list[RenderableType] = [Text(what), "", table("First order", heads, rows)]
    simulated = [(value, value.monte_carlo) for value in known if value.monte_carlo is not None]
    if simulated:
        parts += ["", _simulated(simulated, found)]
    if known:
        sources = list(known[0].budget)
        budget = [
            (_SOURCES.get(source, source), *(uncertainty(value.budget[source]) for value in known))
            for source in sources
        ]
        parts += ["", table("Who contributes: u / mm", ("", *(value.name for value in known)), budget)]
    if found.region is not None:
        axes = " × ".join(uncertainty(half) for half in found.region.half_lengths)
        parts += ["", Text(f"With p = {percent} the point lies in an ellipsoid of half axes {axes} mm (JCGM 102).")]
    lost = [value for value in found.values if value.not_determined]
    if lost:
        parts += ["", heading("Not determined"), listed((not_determined(value),) for value in lost)]
    parts += ["", heading("Left out"), listed((text,) for text in found.left_out)]
    return parts


def _number(value: Value) -> tuple[str, str, str, str]:
    if value.u_mm is None or value.k is None:
        return f"{value.value_mm:.4f}", "not determined", "–", "–"
    rounded = f"{value.value_mm:.{_decimals(value.u_mm)}f}"
    return rounded, uncertainty(value.u_mm), f"{value.k:.2f}", uncertainty(value.expanded_mm)


def _decimals(u_mm: float) -> int:
    """As many as two digits of u have."""
    text = uncertainty(u_mm)
    return 4 if "e" in text or "." not in text else len(text.split(".")[1])


def _simulated(simulated: list[tuple[Value, MonteCarlo]], found: Assessment) -> RenderableType:
    rows = []
    for value, trial in simulated:
        decimals = _decimals(trial.u)
        ends = [f"{low:.{decimals}f} … {high:.{decimals}f}" for low, high in (trial.symmetric, trial.shortest)]
        good = {True: "yes", False: "NO", None: "–"}[value.first_order_is_good]
        rows.append((value.name, uncertainty(trial.u), *ends, f"{trial.trials:.0e}".replace("e+0", "e"), good))
    source = "drawn from the covariance" if found.parameters_from == "covariance" else "of whole calibrations redrawn"
    unsettled = "" if all(trial.settled for _, trial in simulated) else " Not settled within the trials allowed."
    made = table(
        f"Monte Carlo, parameters {source}",
        ("", "u / mm", "symmetric / mm", "shortest / mm", "trials", "first order good"),
        rows,
    )
    made.caption = Text(unsettled.strip()) if unsettled else None
    return made
