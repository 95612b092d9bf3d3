"""A plan tried before anyone measures: readings simulated as it says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ulna.artefacts.kinds import kind_of
from ulna.ground.errors import UlnaInputError
from ulna.planning.planned import Planned
from ulna.simulation.spec import Drawing, Followed, Simulation, Touching
from ulna.study.data import FitOptions


def simulation_of(planned: Planned, seed: int = 0) -> Simulation:
    """Of the plan alone: its arm is the true one, and what is written down is off as drawings are (`Drawing`), with
    the same effects; noise and what is held as the plan says. Encoders are not rounded to counts: the plan's noise has
    all."""
    spec = planned.spec
    return Simulation(
        arm=planned.arm,
        touching=[_touching(planned, Touching(spec.artefact, 1, size_mm=kind_of(spec.artefact).size_mm))],
        seed=seed,
        drawing=Drawing(effects=True),
        encoder_rad=spec.encoder_rad,
        seat_mm=spec.seat_mm,
        quantised=False,
        travel_rad=spec.travel_rad,
        fit=FitOptions(hold=list(spec.hold)),
        path=planned.path,
        files=planned.files,
    )


def following(simulation: Simulation, planned: Planned) -> Simulation:
    """The simulation of a file (its true arm, its noise, its artefact), where the plan has the artefact and in its
    postures. Raises UlnaInputError where they do not belong together."""
    name = planned.spec.artefact.name
    own = [touching for touching in simulation.touching if touching.artefact.name == name]
    if not own:
        known = ", ".join(f"'{touching.artefact.name}'" for touching in simulation.touching)
        raise UlnaInputError(
            f"{simulation.label}: the plan {planned.path} is of artefact '{name}', the simulation has {known}; "
            "expected the same name. Rename one."
        )
    stated, planned_for = own[0].artefact, planned.spec.artefact
    if stated.kind != planned_for.kind or list(stated.features) != list(planned_for.features):
        raise UlnaInputError(
            f"{simulation.label}: artefact '{name}' is a {stated.kind} with features {_listed(stated.features)}, the "
            f"plan {planned.path} is of a {planned_for.kind} with {_listed(planned_for.features)}; expected the same. "
            "Correct one."
        )
    if simulation.arm.n != planned.arm.n:
        raise UlnaInputError(
            f"{simulation.label}: the true arm has {simulation.arm.n} joints, that of the plan {planned.path} has "
            f"{planned.arm.n}; expected as many. Name another."
        )
    touching = _touching(planned, own[0])
    return replace(simulation, touching=[touching], files=(*simulation.files, *planned.files))


def _touching(planned: Planned, stated: Touching) -> Touching:
    spec = planned.spec
    count, places, touches, n = planned.q_rad.shape
    points_mm = np.repeat(planned.points_mm, touches, axis=1)
    followed = Followed(points_mm, planned.q_rad.reshape(count, places * touches, n))
    probe = spec.probe or next(iter(planned.arm.probes))
    return replace(stated, placements=count, touches=spec.touches, probes=(probe,), followed=followed)


def _listed(features: dict[str, tuple[float, float, float]]) -> str:
    return ", ".join(features) or "none"
