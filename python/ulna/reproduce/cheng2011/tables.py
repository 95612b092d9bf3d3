"""The findings as tables for a terminal of 80 columns."""

from __future__ import annotations

from math import pi

from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from ulna.reproduce.cheng2011.convergence import WRONG_BY_MM
from ulna.reproduce.cheng2011.experiment import BARS, START_MM, START_RAD, Calibrated
from ulna.reproduce.cheng2011.findings import Findings
from ulna.reproduce.claims import agrees, claims_table, plain_table


def tables(found: Findings) -> RenderableType:
    """The claims, the wrong starts, every parameter of the virtual experiment, the errors of the fresh bars."""
    blank = Text("")
    return Group(
        Text("Cheng, Yu, Fei 2011: model and calibration of a seven-axis arm", style="bold"),
        blank,
        claims_table("Simulation: Table 2 from Table 3, 101 exact lengths", found.of_simulation()),
        blank,
        _convergence(found),
        blank,
        claims_table("Experiment, on a virtual arm with the parameters of Table 4", found.of_experiment()),
        blank,
        _parameters(found),
        blank,
        _bars(found),
    )


def _convergence(found: Findings) -> Table:
    table = plain_table(
        f"Zero offsets wrong, lengths wrong by up to {WRONG_BY_MM:g} mm: starts that find the arm",
        f"{found.convergence[0].starts} random starts each. one start: Levenberg–Marquardt once, as in the paper; "
        "default: a poor minimum is noticed and searched on from; search: from the beginning. –: a limit of the paper "
        "that this program does not have.",
    )
    for head in ("wrong by up to, rad", "the paper"):
        table.add_column(head, no_wrap=True)
    for head in ("one start", "default", "search"):
        table.add_column(head, justify="right", no_wrap=True)
    table.add_column("agrees", no_wrap=True)
    for at, claim in zip(found.convergence, found.of_convergence(), strict=True):
        size = "π" if at.wrong_by_rad == pi else f"{at.wrong_by_rad:g}"
        counts = (str(count) for count in (at.one_start, at.given, at.search))
        table.add_row(size, claim.paper, *counts, agrees(claim))
    return table


def _parameters(found: Findings) -> Table:
    experiment = found.experiment
    chi2 = "" if experiment.chi2_per_dof is None else f", chi²/dof {experiment.chi2_per_dof:.2f}"
    table = plain_table(
        "Parameters, rad and mm",
        f"{BARS} lengths, start off by up to {START_RAD:g} rad and {START_MM:g} mm: {experiment.iterations} "
        f"iterations, rms {experiment.rms_mm:.4f} mm{chi2}. The straight probe from one seat, joints held.",
    )
    table.add_column("parameter", no_wrap=True)
    for column in ("start", "Table 4", "found", "u", "off/u"):
        table.add_column(column, justify="right", no_wrap=True)
    for row in (*experiment.parameters, *experiment.straight):
        table.add_row(row.name, *_numbers(row))
    return table


def _numbers(row: Calibrated) -> tuple[str, str, str, str, str]:
    digits = 6 if row.unit == "rad" else 4
    start, truth, found = (f"{value:.{digits}f}" for value in (row.start, row.truth, row.found))
    if row.u is None:
        return start, truth, found, "open", ""
    return start, truth, found, f"{row.u:.{digits}f}", f"{(row.found - row.truth) / row.u:+.1f}"


def _bars(found: Findings) -> Table:
    experiment = found.experiment
    table = plain_table(
        "Ten fresh bars: error of the length, µm",
        f"The true arm's errors are those of noise alone. Over {found.repeated.repeats} repeats the rms is "
        f"{1000 * found.repeated.bent_rms_mm:.1f} µm bent, {1000 * found.repeated.straight_rms_mm:.1f} µm straight, "
        f"{1000 * found.repeated.true_arm_rms_mm:.1f} µm by the true arm.",
    )
    table.add_column("probe, arm", no_wrap=True)
    for number in range(1, len(experiment.bent_errors_mm) + 1):
        table.add_column(str(number), justify="right", no_wrap=True)
    for name, errors in (
        ("bent, calibrated arm", experiment.bent_errors_mm),
        ("bent, true arm", experiment.bent_errors_true_arm_mm),
        ("straight, calibrated arm", experiment.straight_errors_mm),
        ("straight, true arm", experiment.straight_errors_true_arm_mm),
    ):
        table.add_row(name, *(f"{1000 * error:+.0f}" for error in errors))
    return table
