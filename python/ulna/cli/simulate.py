"""`ulna simulate`: readings of a virtual arm whose truth is known."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ulna.cli.options import Force, Json, OutFolder
from ulna.cli.running import guard

if TYPE_CHECKING:
    from ulna.simulation.spec import Simulation


@guard
def simulate(
    spec: Annotated[
        Path | None,
        typer.Argument(metavar="SPEC", help="The simulation file (TOML); none with --plan alone.", show_default=False),
    ] = None,
    plan: Annotated[
        Path | None,
        typer.Option("--plan", metavar="PLAN", help="Folder of a plan: the artefact stands and is touched as it says."),
    ] = None,
    out: OutFolder = None,
    seed: Annotated[
        int | None, typer.Option("--seed", min=0, metavar="N", help="In place of the file's.", show_default=False)
    ] = None,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Take readings with a virtual arm whose truth is known: a study, ready to calibrate.

    With -o it writes arm.toml (the arm as drawn), study.toml, the readings of each artefact, truth.toml (the true arm)
    and truth.json (true dimensions and placements, missed touches). The same seed gives the same files. With --json it
    prints truth.json.

    With --plan a plan is tried before anyone measures: its arm is the true one and its noise that of the readings,
    unless SPEC says otherwise.

    Example: [bold]ulna simulate spec.toml -o virtual && ulna calibrate virtual/study.toml[/bold]

    Example: [bold]ulna simulate --plan planned -o tried && ulna calibrate tried/study.toml[/bold]
    """
    from ulna.cli import output
    from ulna.cli.printed.simulation import simulation_report
    from ulna.formats.output import check_output, refuse_inputs
    from ulna.simulation.simulate import simulate as run_simulate
    from ulna.simulation.study_files import names_for

    simulation = _asked(spec, plan)
    if seed is not None:
        simulation = dataclasses.replace(simulation, seed=seed)
    if out is not None:
        names = names_for([touching.artefact for touching in simulation.touching])
        refuse_inputs((out / name for name in names), simulation.files)
        check_output(out, names, force)  # before the long work
    with output.progress_bar() as progress:
        simulated = run_simulate(simulation, progress)
    if out is not None:
        simulated.save(out, force)
    if as_json:
        output.print_json(simulated.as_dict())
    else:
        output.print_renderable(*simulation_report(simulated))
    if out is not None:
        output.say(f"Written to {out}: {', '.join(simulated.files)}")
    elif not as_json:
        output.say("Nothing was written: give -o DIR to keep the readings.")


def _asked(spec: Path | None, plan: Path | None) -> Simulation:
    """Raises UlnaInputError where there is neither, or they do not belong together."""
    from ulna.ground.errors import UlnaInputError
    from ulna.simulation.file import load_simulation

    if plan is None:
        if spec is None:
            raise UlnaInputError(
                "ulna simulate: no file was named; expected SPEC, a simulation file, or --plan PLAN. Name one."
            )
        return load_simulation(spec)
    from ulna.planning.planned import load_planned
    from ulna.planning.trying import following, simulation_of

    planned = load_planned(plan)
    return simulation_of(planned) if spec is None else following(load_simulation(spec), planned)
