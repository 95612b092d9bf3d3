"""How results show themselves: before and after, the parameters, what was not determined. Each in one screen."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ulna.arm.data import ArmData
from ulna.artefacts.quantities import NAMES, QUANTITIES
from ulna.calibration.coverage import Coverage, P
from ulna.calibration.identify import Identification, not_determined
from ulna.calibration.placements import PlacementFigures
from ulna.calibration.summary import FitSummary, GroupFigures, Parameter
from ulna.ground.digits import degrees_of_freedom, figure_mm, quantity, uncertainty
from ulna.ground.shown import About, Table

WORDS = {name: words for each in QUANTITIES for name, words in each.words().items()}
MAIN = [name for name in NAMES if "_rms_" in name or name.endswith("largest_mm")]
"""Figures that a screen has room for."""


def about_result(
    arm: ArmData,
    fit: FitSummary,
    figures: tuple[Mapping[str, float], Mapping[str, float]],
    parameters: Sequence[Parameter],
    identification: Identification,
    outliers: int,
) -> About:
    """figures: before, after."""
    before, after = figures
    ended = "converged" if fit.converged else "NOT converged"
    counts = {each: sum(row.status == each for row in parameters) for each in ("fitted", "held", "not-determined")}
    facts = {
        "fit": f"{ended} ({fit.termination}, {fit.iterations} iterations)",
        "readings": f"{fit.readings}, {degrees_of_freedom(fit.degrees_of_freedom)} degrees of freedom"
        + (f", chi² per degree {fit.chi2_per_dof:.3g}" if fit.chi2_per_dof is not None else ""),
        "parameters": ", ".join(f"{count} {each}" for each, count in counts.items() if count),
    }
    scatter = fit.reading_scatter
    if scatter is not None and scatter.touch_mm is not None:
        facts["scatter"] = f"{uncertainty(scatter.touch_mm)} mm per coordinate of a touch, as the residuals say"
    if scatter is not None and scatter.unexplained_mm:
        facts["not explained"] = f"{uncertainty(scatter.unexplained_mm)} mm per coordinate, beside the stated noise"
    if outliers:
        facts["far off"] = f"{outliers} readings, in .outliers"
    rms = ["reading to fit, rms", figure_mm(fit.rms_start_mm), figure_mm(fit.rms_mm)]
    rows = [
        [WORDS[name], *(figure_mm(each[name]) if name in each else "–" for each in figures)]
        for name in MAIN
        if name in before or name in after
    ]
    numbers = [
        [row.name, row.unit, quantity(row.start, row.u, row.unit), quantity(row.value, row.u, row.unit), _u(row)]
        for row in parameters
    ]
    return About(
        f"Result of calibrating '{arm.name}', {arm.n} joints: {ended}, rms {figure_mm(fit.rms_mm)} mm",
        facts,
        [
            Table(["", "before / mm", "after / mm"], [*rows, rms]),
            Table(["parameter", "unit", "start", "value", "u"], numbers, texts=2),
        ],
        [not_determined(direction) for direction in identification.lost],
    )


def _u(row: Parameter) -> str:
    if row.status != "fitted":
        return row.status
    return uncertainty(row.u)


def about_evaluation(
    arm: ArmData,
    readings: int,
    rms_mm: float,
    overall: Mapping[str, float],
    artefacts: Sequence[PlacementFigures],
    coverage: Coverage | None,
) -> About:
    """Over all, how many placements there are, and what held."""
    rows = [[WORDS[name], figure_mm(overall[name])] for name in NAMES if name in overall]
    rows.append(["reading to fit, rms", figure_mm(rms_mm)])
    return About(
        f"Evaluation of '{arm.name}' on {readings} readings: rms {figure_mm(rms_mm)} mm",
        {"placements": f"{len(artefacts)}, in .artefacts"} | _held(coverage),
        [Table(["over all", "mm"], rows)],
    )


def about_cross_validation(
    by: str,
    groups: Sequence[GroupFigures],
    before: Mapping[str, float],
    after: Mapping[str, float],
    coverage: Coverage | None,
) -> About:
    """What arms make of what they were not fitted to."""
    rows = [
        [WORDS[name], *(figure_mm(each[name]) if name in each else "–" for each in (before, after))]
        for name in NAMES
        if name in before or name in after
    ]
    failed = [group.group for group in groups if not group.converged]
    return About(
        f"Cross-validation by {by}: {len(groups)} groups left out",
        ({} if not failed else {"NOT converged": f"{len(failed)}: {', '.join(failed[:5])}"}) | _held(coverage),
        [Table(["readings left out", "before / mm", "after / mm"], rows)],
    )


def _held(coverage: Coverage | None) -> dict[str, str]:
    """How many of the stated intervals held, and by what they are too small."""
    if coverage is None or not coverage.shares:
        return {}
    small = coverage.too_small
    said = [
        f"{share.inside} of {share.count} {name}" + (f" (u too small by {small[name]:.2g})" if name in small else "")
        for name, share in coverage.shares
    ]
    return {f"in their {100 * P:g} % intervals": ", ".join(said)}
