"""How sure a measured value is, for the terminal."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import RenderableType
from rich.text import Text

from ulna.cli.printed.tables import heading, listed, table
from ulna.ground.digits import uncertainty
from ulna.uncertainties.assess import Assessment, Value, not_determined
from ulna.uncertainties.monte_carlo import MonteCarlo

_SOURCES = {
    "parameters": "the arm's parameters",
    "encoders": "the encoders, while measuring",
    "touch": "the touch",
    "unexplained": "what the model does not explain",
    "temperature": "the temperature",
}

_BESIDE = 4
"""Values side by side in 80 columns."""
_FROM = {
    "covariance": "drawn from the covariance",
    "recalibrations": "of whole calibrations redrawn",
    "performance": "of arms that agree with the certificate",
}


def uncertainty_report(found: Assessment) -> list[RenderableType]:
    """Values with their uncertainties, what Monte Carlo says, who contributes, what is left out."""
    percent = f"{100 * found.p:g} %"
    known = [value for value in found.values if value.u is not None]
    unit = " / mm" if all(value.unit == "mm" for value in found.values) else ""
    rows = [(_name(value, unit), *_number(value)) for value in found.values]
    heads = ("", f"value{unit}", f"u{unit}", "k", f"U{unit} (p = {percent})")
    what = f"{found.kind.capitalize()}, probe {found.probe}, {found.readings} readings."
    parts: list[RenderableType] = [Text(what), "", table("First order", heads, rows)]
    simulated = [(value, value.monte_carlo) for value in known if value.monte_carlo is not None]
    if simulated:
        parts += ["", _simulated(simulated, found, unit)]
    for first in range(0, len(known), _BESIDE):
        parts += ["", _budget(known[first : first + _BESIDE], unit)]
    if found.region is not None:
        axes = " × ".join(uncertainty(half) for half in found.region.half_lengths)
        parts += ["", Text(f"With p = {percent} the point lies in an ellipsoid of half axes {axes} mm (JCGM 102).")]
    if found.arms is not None:
        share = 100.0 * found.arms.kept / found.arms.drawn
        text = f"Of {found.arms.drawn} arms drawn {found.arms.kept} ({share:.2g} %) agree with the certificate."
        parts += ["", Text(text)]
    lost = [value for value in found.values if value.not_determined]
    if lost:
        parts += ["", heading("Not determined"), listed((not_determined(value),) for value in lost)]
    parts += ["", heading("Left out"), listed((text,) for text in found.left_out)]
    return parts


def _budget(values: Sequence[Value], unit: str) -> RenderableType:
    rows = [
        (_SOURCES.get(source, source), *(uncertainty(value.budget[source]) for value in values))
        for source in values[0].budget
    ]
    return table(f"Who contributes: u{unit}", ("", *(_name(value, unit) for value in values)), rows)


def _name(value: Value, unit: str) -> str:
    """With its unit, where the table's head does not say it for all."""
    return value.name if unit or value.unit == "1" else f"{value.name} / {value.unit}"


def _number(value: Value) -> tuple[str, str, str, str]:
    if value.u is None or value.k is None:
        return f"{value.value:.4f}", "not determined", "–", "–"
    rounded = f"{value.value:.{_decimals(value.u)}f}"
    return rounded, uncertainty(value.u), f"{value.k:.2f}", uncertainty(value.expanded)


def _decimals(u: float) -> int:
    """As many as two digits of u have."""
    text = uncertainty(u)
    return 4 if "e" in text or "." not in text else len(text.split(".")[1])


def _simulated(simulated: list[tuple[Value, MonteCarlo]], found: Assessment, unit: str) -> RenderableType:
    rows = []
    for value, trial in simulated:
        decimals = _decimals(trial.u)
        ends = [f"{low:.{decimals}f} … {high:.{decimals}f}" for low, high in (trial.symmetric, trial.shortest)]
        good = {True: "yes", False: "NO", None: "–"}[value.first_order_is_good]
        rows.append((_name(value, unit), uncertainty(trial.u), *ends, f"{trial.trials:.0e}".replace("e+0", "e"), good))
    source = _FROM[found.parameters_from]
    unsettled = "" if all(trial.settled for _, trial in simulated) else " Not settled within the trials allowed."
    made = table(
        f"Monte Carlo, parameters {source}",
        ("", f"u{unit}", f"symmetric{unit}", f"shortest{unit}", "trials", "first order good"),
        rows,
    )
    made.caption = Text(unsettled.strip()) if unsettled else None
    return made
