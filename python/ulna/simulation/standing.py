"""An artefact stands somewhere in the arm's volume and is touched there: true places, true postures. mm and rad."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ulna.arm.conditions import CONDITIONS, PAYLOAD, TEMPERATURE, Condition
from ulna.artefacts.touching import Touches
from ulna.geometry.rigid import motions
from ulna.ground.arrays import F64, I64, Bool, Progress
from ulna.ground.errors import UlnaInputError
from ulna.simulation.mover import Mover
from ulna.simulation.reading_errors import turns
from ulna.simulation.spec import Followed, Simulation, Touching
from ulna.simulation.touches import touches_of

#: rounds of drawing places, one after the other, that find none before it is said that there are too few
BARREN = 20
#: touches worked on at a time, so that memory stays bounded and the bar moves
MOST_TOUCHES = 20_000


@dataclass(frozen=True)
class Standings:
    """P placements of T touches each."""

    origin_mm: F64
    """(P, 3) where the artefact's origin is, base frame."""
    axes: F64
    """(P, 3, 3) its x, y and z axis as rows, base frame."""
    drawn: dict[Condition, F64]
    """(P, …) what the arm's tip depends on beside its angles, as people say it."""
    q_rad: F64
    """(P, T, n) true encoder angles."""
    missed: Bool
    """(P, T)"""
    off_mm: F64
    """(P, T, 3) how far missed touches were off; 0 for the others."""


def stand(
    simulation: Simulation, mover: Mover, touching: Touching, touches: Touches, key: int, progress: Progress | None
) -> Standings:
    """Stand the artefact in random places and directions where every touch is within reach, and touch it.

    key: the artefact's number; with the seed it gives the draws. Raises UlnaInputError where too few places are found.
    """
    rng = np.random.default_rng([simulation.seed, key])
    if touching.followed is not None:
        return _as_planned(simulation, mover, touching, touches, touching.followed, rng)
    artefact, count, per = touching.artefact, touching.placements, len(touches.probe)
    parts: list[Standings] = []
    missing, barren = count, 0
    while missing and barren < BARREN:
        most = max(1, min(missing, MOST_TOUCHES // per))
        origin_mm, axes = _candidates(simulation, mover, touching, touches, most, rng)
        whole = np.zeros(0, np.int64)
        if len(origin_mm):
            part, reached = _touch(simulation, mover, touches, origin_mm, axes, rng)
            if artefact.frame == "arm" and not reached.all():
                raise _beyond_reach(simulation, touching, touches, reached[0])
            whole = np.flatnonzero(reached.all(axis=1))
        if len(whole):
            parts.append(_select(part, whole))
            missing -= len(whole)
        barren = 0 if len(whole) else barren + 1
        if progress is not None:
            progress(f"touching {artefact.name}", count - missing, count)
    if missing:
        where = "in the arm's reach" if simulation.volume_mm is None else "in the arm's reach and in the volume"
        raise UlnaInputError(
            f"{simulation.label}: artefact '{artefact.name}': only {count - missing} of {count} placements were found "
            f"with all {per} touches {where}; expected an artefact that fits there. Take a smaller one, fewer "
            "placements, a larger volume or a wider travel."
        )
    return _joined(parts)


def _as_planned(
    simulation: Simulation,
    mover: Mover,
    touching: Touching,
    touches: Touches,
    followed: Followed,
    rng: np.random.Generator,
) -> Standings:
    """Where the plan has it, in postures as near to the plan's as there are. Raises UlnaInputError."""
    if touching.artefact.frame == "arm":
        origin_mm, axes = np.zeros((touching.placements, 3)), np.tile(np.eye(3), (touching.placements, 1, 1))
    else:
        stated = touches_of(touching, touching.artefact, mover.arm, touches.probe[:1].tolist())
        origin_mm, axes = motions(stated.centre_mm, followed.points_mm)
    found, reached = _touch(simulation, mover, touches, origin_mm, axes, rng, followed.q_rad)
    if not reached.all():
        worst = int(np.flatnonzero(~reached.all(axis=1))[0])
        raise UlnaInputError(
            f"{simulation.label}: artefact '{touching.artefact.name}': placement {worst + 1} of the plan is out of the "
            f"true arm's reach ({int((~reached).sum())} touches of {reached.size} are); expected an arm that is near "
            "to the plan's. Name another plan or another arm."
        )
    return found


def _candidates(
    simulation: Simulation, mover: Mover, touching: Touching, touches: Touches, most: int, rng: np.random.Generator
) -> tuple[F64, F64]:
    """At most so many places, (P, 3) origins and (P, 3, 3) axes, at which all corners seem to be within reach."""
    if touching.artefact.frame == "arm":
        return np.zeros((1, 3)), np.eye(3)[None]
    at_mm = touches.centre_mm
    # the farthest touches along each axis stand for all of them; the probe's ball is where the tip is
    corners = np.unique(np.concatenate([at_mm.argmin(axis=0), at_mm.argmax(axis=0)]))
    drawn = 8 * most + 200
    probe = int(touches.probe[0])
    if simulation.volume_mm is None:
        q_rad = mover.anywhere(drawn, rng)
        first_mm = mover.arm.core.tip(q_rad, probe)
    else:
        first_mm = rng.uniform(*simulation.volume_mm, (drawn, 3))
    axes = turns(np.eye(3), drawn, rng)
    origin_mm = first_mm - at_mm[0] @ axes
    good = np.ones(drawn, dtype=bool)
    for corner in corners.tolist():
        point_mm = origin_mm + at_mm[corner] @ axes
        good &= mover.near_reach(point_mm, int(touches.probe[corner]))
        if simulation.volume_mm is not None:
            low, high = np.array(simulation.volume_mm)
            good &= ((point_mm >= low) & (point_mm <= high)).all(axis=1)
    chosen = np.flatnonzero(good)[:most]
    return origin_mm[chosen], axes[chosen]


def _touch(
    simulation: Simulation,
    mover: Mover,
    touches: Touches,
    origin_mm: F64,
    axes: F64,
    rng: np.random.Generator,
    start_rad: F64 | None = None,
) -> tuple[Standings, Bool]:
    """Touch the artefact in (P, 3) places, and whether each touch (P, T) was reached. start_rad: (P, T, n) postures to
    begin from; None: anyhow."""
    places, per = len(origin_mm), len(touches.probe)
    noise_mm = simulation.seat_mm * rng.standard_normal((places, per, 3))
    missed, off_mm = _missed(simulation, touches, axes, rng)
    arm, warm = mover.arm, simulation.temperature
    stated: dict[Condition, Any] = {}
    if warm is not None:
        stated[TEMPERATURE] = (warm.mean_c, warm.spread_c)
    if simulation.carried:
        stated[PAYLOAD] = np.array([arm.load_named(name) for name in simulation.carried])
    drawn = {each: each.drawn(places, per, arm.n, stated.get(each), rng) for each in CONDITIONS if each in arm.needs}
    said = {each.said: each.of_touches(values, per) for each, values in drawn.items()}
    conditions = arm.conditions(places * per, **said)
    at_mm = origin_mm[:, None] + touches.centre_mm @ axes + noise_mm + off_mm
    seed = int(rng.integers(2**63))
    points_mm, probe = at_mm.reshape(-1, 3), np.tile(touches.probe, places)
    if start_rad is None:
        q_rad, reached = mover.on_points(points_mm, probe, conditions, seed)
    else:
        q_rad, reached = mover.nearby(start_rad.reshape(-1, arm.n), points_mm, probe, conditions, seed)
    touched = Standings(origin_mm, axes, drawn, q_rad.reshape(places, per, -1), missed, off_mm)
    return touched, reached.reshape(places, per)


def _missed(simulation: Simulation, touches: Touches, axes: F64, rng: np.random.Generator) -> tuple[Bool, F64]:
    """Which touches were none, (P, T), and how far off the ball was, (P, T, 3): off the surface, or anyhow."""
    shape = (len(axes), len(touches.probe))
    if simulation.missed is None:
        return np.zeros(shape, dtype=bool), np.zeros((*shape, 3))
    missed: Bool = np.less(rng.random(shape), simulation.missed.share)
    anyhow = rng.standard_normal((*shape, 3))
    anyhow /= np.linalg.norm(anyhow, axis=-1, keepdims=True)
    away = np.where(touches.off.any(axis=1, keepdims=True), touches.off @ axes, anyhow)
    off_mm: F64 = simulation.missed.size_mm * away * missed[..., None]
    return missed, off_mm


def _beyond_reach(simulation: Simulation, touching: Touching, touches: Touches, reached: Bool) -> UlnaInputError:
    names = list(touching.artefact.features)
    beyond = sorted(set(touches.feature[~reached].tolist()))
    shown = ", ".join(f"'{names[k]}'" for k in beyond[:5]) + (", …" if len(beyond) > 5 else "")
    return UlnaInputError(
        f"{simulation.label}: artefact '{touching.artefact.name}' is in the arm's frame, but {len(beyond)} of its "
        f"{len(names)} features are out of the arm's reach: {shown}; expected points that the tip can touch. Move or "
        "remove them, or widen the travel."
    )


def _select(standings: Standings, places: I64) -> Standings:
    return Standings(
        standings.origin_mm[places],
        standings.axes[places],
        {each: values[places] for each, values in standings.drawn.items()},
        standings.q_rad[places],
        standings.missed[places],
        standings.off_mm[places],
    )


def _joined(parts: list[Standings]) -> Standings:
    def of(name: str) -> F64:
        return np.concatenate([getattr(part, name) for part in parts])

    return Standings(
        of("origin_mm"),
        of("axes"),
        {each: np.concatenate([part.drawn[each] for part in parts]) for each in parts[0].drawn},
        of("q_rad"),
        np.concatenate([part.missed for part in parts]),
        of("off_mm"),
    )
