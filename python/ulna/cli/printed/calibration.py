"""What `ulna calibrate` prints: how it ended, before and after, the parameters, what was not determined."""

from __future__ import annotations

from collections.abc import Sequence

from rich.console import RenderableType
from rich.text import Text

from ulna.arm.effects.effects import extra_of
from ulna.arm.probes import ProbeView
from ulna.calibration.result import Result
from ulna.calibration.summary import FitSummary, Parameter
from ulna.cli.printed.chosen import chosen_model
from ulna.cli.printed.extras import judged_extras
from ulna.cli.printed.figures import before_after
from ulna.cli.printed.identification import determined_in_words, directions
from ulna.cli.printed.mapped import mapped
from ulna.cli.printed.outliers import far_off
from ulna.cli.printed.scale import common_factor
from ulna.cli.printed.scatter import scatter
from ulna.cli.printed.signs import signs_in_full
from ulna.cli.printed.tables import table
from ulna.ground.digits import decimals, degrees_of_freedom, figure_mm, fixed, plain_uncertainty, quantity, uncertainty

_ENDINGS = {
    "converged-cost": "Converged: the sum of squares no longer falls",
    "converged-step": "Converged: the parameters no longer move",
    "exact": "Converged: the readings are met exactly",
    "nothing-to-fit": "Nothing to fit: every parameter is held",
    "no-progress": "NOT converged: no step made progress",
    "max-iterations": "NOT converged: the allowed iterations were used up",
    "poor-minimum": "NOT converged: the fit ended in a poor minimum, and so did the search",
    "held-poor": "NOT good: every parameter is held, and this arm does not explain the readings",
    "off-scale": "NOT to be believed: the readings are met, but every length is off the arm file by one factor",
}

_METHODS = {"annealing": "simulated annealing", "evolution": "an evolutionary search"}


def calibration_report(result: Result) -> list[RenderableType]:
    """All of `ulna calibrate`, as `--all` prints it."""
    parts: list[RenderableType] = [Text(f"{result.arm.name}, {result.arm.n} joints. {ending(result.fit)}")]
    parts += signs_in_full(result.fit)
    parts.append(Text(f"{equations(result.fit)} {determined_in_words(result.identifiability).capitalize()}"))
    parts += [Text(said) for said in filter(None, [scatter(result), common_factor(result)])]
    rms = ("reading to fit, rms", figure_mm(result.fit.rms_start_mm), figure_mm(result.fit.rms_mm))
    title, without = "Before and after, on the fitted readings", result.without_far_off
    table = before_after(title, result.before, result.after, [rms], without, len(result.outliers))
    parts += ["", table]
    parts += ["", *parameter_tables(result.parameters), *signs_found(result.fit)]
    parts += ["", probe_table(result.probes)]
    parts += directions(result.identifiability)
    parts += judged_extras(result.extras) + chosen_model(result.chosen, all_of_it=True)
    parts += mapped(result.residual_map, all_of_it=True)
    return parts + far_off(result.outliers, result.fit)


def ending(fit: FitSummary) -> str:
    """How the fit ended, and how it got there."""
    text = f"{_ENDINGS.get(fit.termination, fit.termination)} ({fit.iterations} iterations)."
    if fit.method != "lm":
        text += (
            f" Before that {_METHODS[fit.method]} of the box around the arm file ({fit.box_evaluations} evaluations)."
        )
    if fit.searched_starts:
        reason = {
            "asked": "as asked",
            "poor-minimum": "because the given start ended in a poor minimum",
            "unexplained": "because the stated noise did not explain what the given start left",
            "off-scale": "because the given start led to an arm of quite another size",
        }.get(fit.search_reason, fit.search_reason)
        text += f" Searched {fit.searched_starts} starts, {reason}."
    if fit.folded:
        text += f" Folded to the twin nearest the given arm: {', '.join(fit.folded)}."
    return text


def equations(fit: FitSummary) -> str:
    """The counts that tell whether the fit can be trusted, and how the readings counted."""
    placements = f" and {fit.placement_unknowns} unknowns of placements" if fit.placement_unknowns else ""
    chi2 = "" if fit.chi2_per_dof is None else f", chi² per degree {fit.chi2_per_dof:.3f} (1: the stated noise fits)"
    return (
        f"{fit.readings} readings, {fit.observations} equations{placements}, "
        f"{degrees_of_freedom(fit.degrees_of_freedom)} degree{'s' * (fit.degrees_of_freedom != 1)} of freedom{chi2}."
        f"{'' if fit.loss == 'none' else f' Readings far off count less (loss: {fit.loss}).'}"
    )


def parameter_tables(parameters: Sequence[Parameter], with_start: bool = True) -> list[RenderableType]:
    """Every parameter: start, value, standard uncertainty, that of its prior where there are any, unit, status.

    What is beyond the arm's geometry stands in a table of its own, which starts at zero or at a certificate's value.
    """
    beyond = [row for row in parameters if extra_of(row.name) or row.name.startswith("artefact.")]
    geometry = [row for row in parameters if row not in beyond]
    tables: list[RenderableType] = [
        _parameter_table("Parameters (u: standard uncertainty)", geometry, with_start, plain=True)
    ]
    if beyond:
        tables += ["", _parameter_table("Beyond the arm's geometry", beyond, False)]
    return tables


def signs_found(fit: FitSummary) -> list[RenderableType]:
    """Of joints whose sign nobody knew: one line below the parameters."""
    if not fit.signs_found:
        return []
    said = ", ".join(f"{name} = {sign}" for name, sign in fit.signs_found.items())
    return [Text(f"Signs found: {said}.")]


def _parameter_table(
    title: str, parameters: Sequence[Parameter], with_start: bool, plain: bool = False
) -> RenderableType:
    """plain: lengths and angles alone, whose uncertainties are plain decimals; else in powers of ten where small."""
    with_priors = any(row.prior is not None for row in parameters)
    rows = []
    for row in parameters:
        start = [quantity(row.start, row.u, row.unit)] if with_start else []
        value = quantity(row.value, row.u, row.unit)
        prior = [uncertainty(None if row.prior is None else row.prior["u"])] if with_priors else []
        u = plain_uncertainty(row.u, row.unit) if plain else uncertainty(row.u)
        rows.append([row.name, *start, value, u, *prior, row.unit, row.status])
    heads = ["", *(["start"] if with_start else []), "value", "u", *(["prior u"] if with_priors else [])]
    made = table(title, [*heads, "unit", "status"], rows)
    made.columns[-2].justify = made.columns[-1].justify = "left"
    return made


def probe_table(probes: list[ProbeView]) -> RenderableType:
    """The tips in the literature's cylindrical form: x = r cos theta0, y = -r sin theta0, z = h."""
    rows = []
    for view in probes:
        if view.theta0_rad is None:
            rows.append((f"probe.{view.name}.theta0", "undefined", "undefined", "rad", "on the axis, r = 0"))
        else:
            theta0 = fixed(view.theta0_rad, decimals(view.u_theta0_rad, "rad"))
            rows.append((f"probe.{view.name}.theta0", theta0, uncertainty(view.u_theta0_rad), "rad", view.status))
        for key, value, u in (("r", view.r_mm, view.u_r_mm), ("h", view.h_mm, view.u_h_mm)):
            shown = "undefined" if key == "r" and view.on_axis else uncertainty(u)
            rows.append((f"probe.{view.name}.{key}", fixed(value, decimals(u, "mm")), shown, "mm", view.status))
    made = table("The same tips, cylindrical", ("", "value", "u", "unit", "status"), rows)
    made.columns[3].justify = made.columns[4].justify = "left"
    return made
