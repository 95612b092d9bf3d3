"""`ulna simulate`: readings of a virtual arm whose truth is known."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import Annotated

import typer

from ulna.cli.options import Force, Json, OutFolder
from ulna.cli.running import guard


@guard
def simulate(
    spec: Annotated[Path, typer.Argument(metavar="SPEC", help="The simulation file (TOML).", show_default=False)],
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

    Example: [bold]ulna simulate spec.toml -o virtual && ulna calibrate virtual/study.toml[/bold]
    """
    from ulna.cli import output
    from ulna.cli.printed.simulation import simulation_report
    from ulna.formats.output import check_output, refuse_inputs
    from ulna.simulation.file import load_simulation
    from ulna.simulation.simulate import simulate as run_simulate
    from ulna.simulation.study_files import names_for

    simulation = load_simulation(spec)
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
