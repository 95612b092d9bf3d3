"""A plan at a glance."""

from __future__ import annotations

import numpy as np
from rich.console import RenderableType
from rich.text import Text

from ulna.cli.printed.tables import table
from ulna.planning.outcome import Plan

_WHAT = {
    "D": "D (volume)",
    "A": "A (mean variance)",
    "E": "E (widest direction)",
    "G": "G (worst prediction)",
    "length": "length, mean",
    "length-worst": "length, worst",
    "point": "point, mean",
}


def plan_report(plan: Plan) -> list[RenderableType]:
    """Expected figures beside random choice, what a simulation makes of them, the observability indices."""
    columns = [("planned", plan.planned), ("random", plan.random)]
    if plan.paper is not None:
        columns.append((f"{plan.paper.measurements} random", plan.paper))

    def row(label: str, name: str, factor: float = 1000.0, digits: int = 2) -> tuple[str, ...]:
        return (label, *(f"{factor * getattr(figures, name):.{digits}f}" for _, figures in columns))

    in_mm = plan.spec.criterion in ("length", "length-worst", "point")
    rows = [
        ("measurements", *(str(figures.measurements) for _, figures in columns)),
        row(f"criterion {_WHAT[plan.spec.criterion]}" + (" / µm" if in_mm else ""), "criterion", *_scale(in_mm)),
        row("u(length) / µm, rms", "u_length_mm"),
        row("u(length) / µm, worst", "u_length_worst_mm"),
        row("u(point) / µm, rms", "u_point_mm"),
    ]
    stands = len(np.unique(plan.chosen.place))
    title = f"{plan.spec.choose} measurements of {plan.candidates} candidates, {stands} stands"
    parts: list[RenderableType] = [table(title, ("expected of the arm", *(name for name, _ in columns)), rows)]
    if plan.trial is not None:
        trial = plan.trial
        found = (f"{1000 * value:.2f}" for value in (trial.planned_mm, trial.random_mm))
        errors = ("length errors of fresh bars / µm, rms", *found)
        parts += ["", table(f"Simulated: {trial.runs} calibrations each", ("", "planned", "random"), [errors])]
    pairs = zip(plan.observability.items(), plan.random_observability.values(), strict=True)
    indices = [(name, f"{own:.4g}", f"{other:.4g}") for (name, own), other in pairs]
    parts += [
        "",
        table("Observability indices", ("scaled by the candidates", "planned", "random"), indices),
        "",
        Text(_words(plan)),
    ]
    return parts


def _scale(in_mm: bool) -> tuple[float, int]:
    return (1000.0, 2) if in_mm else (1.0, 3)


def _words(plan: Plan) -> str:
    gain = f"The expected length uncertainty is {100 * plan.gain:.0f} % less than by random choice"
    if plan.trial is not None:
        gain += f", {100 * plan.trial.gain:.0f} % less by simulation"
    known = f"{plan.determined} of {plan.free} free parameters' directions are determined"
    lost = " (the others only move the base frame, or no candidate sees them)" if plan.determined < plan.free else ""
    own = " What is not known of the artefact itself comes on top." if plan.spec.artefact.u_mm else ""
    return f"{gain}. {known}{lost}.{own}\n{_room(plan)}"


def _room(plan: Plan) -> str:
    """Where the artefact may stand, and how to change it."""
    spec, within = plan.spec, plan.spec.within
    if spec.artefact.frame == "arm":
        return "The artefact stands where its coordinates say."
    box = " in the stated room" if spec.room_mm is not None else ""
    if within is None:
        return f"The artefact stands anywhere within reach{box}: nobody asked for the table or a person's reach."
    low, high = (f"{value:g}" for value in (within.low_mm, within.high_mm))
    return (
        f"The artefact stands{box} {low} mm to {high} mm above the table (z = {within.table_mm:g} mm in the base "
        f"frame), {within.aside_mm:g} mm or more from the base's axis, and the arm's joints are above the table. "
        "[within] in the plan file changes this; --anywhere switches it off."
    )
