"""What was simulated, at a glance."""

from __future__ import annotations

from rich.console import RenderableType

from ulna.artefacts.kinds import kind_of
from ulna.cli.printed.tables import table
from ulna.simulation.simulate import Simulated


def simulation_report(simulated: Simulated) -> list[RenderableType]:
    """One line for each artefact, then how the readings err and what the study does not ask for."""
    rows = []
    for group, true in zip(simulated.study.readings, simulated.truth.touchings, strict=True):
        artefact, really = group.artefact, true.artefact
        kind = kind_of(artefact)
        stated = next((own for own in kind.dimensions(artefact) if own.u), None)
        off = {own.name: own.value for own in kind.dimensions(really)}
        rows.append(
            (
                artefact.name,
                artefact.kind,
                str(len(true.standings.origin_mm)),
                str(len(group)),
                str(int(true.missed.sum())),
                "–" if stated is None else f"{off[stated.name] - stated.value:+.4f}",
            )
        )
    heads = ("artefact", "kind", "placements", "readings", "missed", "true − stated / mm")
    made = table(f"Simulated: {simulated.truth.arm.name}", heads, rows, left=2)
    return [made, "", _errors(simulated), *_unasked(simulated)]


def _errors(simulated: Simulated) -> str:
    simulation = simulated.simulation
    u_rad, step_rad = simulation.reading_u_rad, simulation.step_rad
    words = []
    if u_rad is not None:
        worst = f"{u_rad.min():.3g}" if u_rad.min() == u_rad.max() else f"{u_rad.min():.3g} to {u_rad.max():.3g}"
        counts = ", rounding to counts included" if step_rad is not None else ""
        words.append(f"encoders {worst} rad{counts}")
    if simulation.seat_mm:
        words.append(f"touches {simulation.seat_mm:g} mm per coordinate")
    return f"Standard deviations: {'; '.join(words)}." if words else "Readings are exact: no noise was asked for."


def _unasked(simulated: Simulated) -> list[RenderableType]:
    drawn = [*simulated.study.arm.extras, *simulated.study.fit.extras]
    unasked = [extra for extra in simulated.truth.arm.extras if extra not in drawn]
    if not unasked:
        return []
    listed = ", ".join(f'"{extra}"' for extra in unasked)
    return [f"The true arm has effects that the study does not ask for: fit = {{ extras = [{listed}] }} would."]
