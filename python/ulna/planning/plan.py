"""Plan: from an arm and a spec to the measurements that tell most, in an order that an operator can follow."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.given import ArmLike, as_arm
from ulna.ground.arrays import F64, I64, Progress
from ulna.ground.errors import UlnaInputError
from ulna.planning.candidates import EACH, ON_SURFACE, POSTURES, Candidates, combine
from ulna.planning.file import load_plan_spec
from ulna.planning.information import Coordinates, candidate_rows, observability, taken_rows
from ulna.planning.order import in_order
from ulna.planning.outcome import Plan
from ulna.planning.pieces import draw_all
from ulna.planning.refusals import check, free_parameters
from ulna.planning.scene import Scene
from ulna.planning.spec import PlanSpec
from ulna.planning.targets import Tests
from ulna.planning.touchable import touchable
from ulna.planning.trial import Trial, carry_out
from ulna.simulation.mover import Mover, travel_or_limits
from ulna.simulation.places import postures_on
from ulna.work.pieces import Threads, Workers

PAPER = 101
"""Bars of Cheng, Yu and Fei (2011), with which a plan is compared."""
CURVE_OF = 3000
"""Candidates that the curve over the number chosen is made with."""
TRIAL_SETS = 5
"""Random sets that a trial's calibrations on random measurements take turns with."""
PLACED = 8
"""Measurements that stand for a place where places are chosen first."""


@dataclass(frozen=True)
class _Asked:
    """What every step of a plan is about."""

    arm: Arm
    spec: PlanSpec
    mover: Mover
    """Of the arm, with the travel that its joints have."""
    probe: int
    """Index of the probe that is on."""
    free: I64
    """(F,) indices of the parameters that the calibration will fit."""


def plan(
    arm: ArmLike,
    spec: PlanSpec | str | Path,
    progress: Progress | None = None,
    *,
    workers: Workers | None = None,
    keep: str | Path | None = None,
) -> Plan:
    """Choose measurements that make the spec's criterion small, and judge them beside random ones. `arm`: an arm, a
    result, or a path of one; `spec`: a specification, or the path of a plan file.

    `progress` is called with (stage, done, total). workers: who draws candidates and does the trial's calibrations
    (None: this process's threads); the choice itself is made here. keep: folder for the trial's finished pieces, from
    which the same plan goes on. Raises UlnaInputError for what cannot be asked; KeyboardInterrupt.
    """
    arm = as_arm(arm)
    spec = spec if isinstance(spec, PlanSpec) else load_plan_spec(Path(spec), arm)
    check(arm, spec)
    team = workers or Threads()
    told = progress if progress is not None else lambda *_: None
    rng = np.random.default_rng([spec.seed, 41])
    probe = arm.probe_index(spec.probe)
    mover = Mover(arm, travel_or_limits(arm, spec.travel_rad, spec.label))
    free = free_parameters(arm, spec)
    asked = _Asked(arm, spec, mover, probe, free)
    began = time.perf_counter()
    candidates, rows = draw_all(spec, arm, mover, probe, free, team, told)
    drawn = time.perf_counter()
    scene = _scene(asked, rows, rng)
    directions = scene.directions(rng)
    if spec.placements is not None and spec.placements < spec.choose and spec.artefact.frame == "free":
        candidates, scene = _few_places(asked, candidates, scene, directions, rng, told)
    if not scene.fixed.any() and spec.choose * scene.rows.shape[1] < scene.coordinates.rank:
        raise _too_few(spec, scene)
    rowed = time.perf_counter()
    chosen = scene.choose(spec.choose, directions, progress)
    finished = time.perf_counter()
    planned = scene.figures(chosen, directions)
    random = scene.random(spec.choose, directions, rng)
    if planned is None or random is None:
        raise _too_few(spec, scene)
    some = rng.choice(len(scene.rows), spec.choose, replace=False)
    to_rows = candidate_rows(spec, arm, probe, free, candidates.select(np.concatenate([chosen, some])))
    own, others = (part.reshape(-1, len(free)) for part in np.split(to_rows, [len(chosen)]))
    return Plan(
        arm=arm,
        spec=spec,
        chosen=in_order(candidates.select(chosen)),
        planned=planned,
        random=random,
        paper=scene.random(PAPER, directions, rng),
        observability=observability(own, scene.coordinates),
        random_observability=observability(others, scene.coordinates),
        curve=[*_curve(scene, directions, rng, told), (spec.choose, planned.u_length_mm, random.u_length_mm)],
        trial=_trial(asked, candidates, chosen, scene, rng, told, team, keep),
        determined=scene.coordinates.rank,
        free=len(free),
        candidates=len(candidates),
        seconds={"candidates": drawn - began, "judging": rowed - drawn, "choice": finished - rowed},
    )


def _scene(asked: _Asked, rows: F64, rng: np.random.Generator) -> Scene:
    arm, spec, free = asked.arm, asked.spec, asked.free
    taken = np.zeros((0, len(free))) if spec.taken is None else taken_rows(spec, spec.taken, arm, free)
    units = np.array(arm.parameter_units)[free]
    natural = np.where(units == "mm", 1.0, arm.core.reach_mm(asked.probe))
    coordinates = Coordinates.of(np.concatenate([rows.reshape(-1, len(free)), taken]), natural)
    at_hand = taken @ coordinates.to_free
    tests = Tests.of(arm, spec, asked.mover, asked.probe, free, coordinates, rng)
    return Scene(spec, np.ascontiguousarray(rows @ coordinates.to_free), coordinates, at_hand.T @ at_hand, tests)


def _few_places(
    asked: _Asked,
    candidates: Candidates,
    scene: Scene,
    directions: F64 | None,
    rng: np.random.Generator,
    told: Progress,
) -> tuple[Candidates, Scene]:
    """The best places first, each judged by some of its measurements together; then candidates in these alone."""
    spec, probe = asked.spec, asked.probe
    assert spec.placements is not None
    places = len(candidates.features_mm)
    some = np.stack([rng.choice(np.flatnonzero(candidates.place == k), PLACED, replace=False) for k in range(places)])
    r = scene.rows.shape[2]
    together = replace(scene, rows=np.ascontiguousarray(scene.rows[some].reshape(places, -1, r)))
    best = together.choose(spec.placements, directions, told)
    at_mm = candidates.features_mm[best]
    each = -(-spec.candidates // spec.placements)
    what, features = touchable(spec, asked.arm, probe), at_mm.shape[1]
    postures = int(np.ceil(np.sqrt(each))) if what.pairs else EACH
    if what.outward is not None:
        postures = ON_SURFACE * POSTURES
    points = np.repeat(at_mm.reshape(-1, 3), postures, axis=0)
    standing = what.standing(spec, asked.arm)
    q_rad, reached = postures_on(standing, asked.mover, points, probe, {}, int(rng.integers(2**63)))
    q_rad = q_rad.reshape(len(best), features, postures, -1)
    # a posture that was not found again gives way to one that was: they are all of one feature
    for k, j in zip(*np.nonzero(~reached.reshape(q_rad.shape[:3]).all(axis=2)), strict=True):
        found = np.flatnonzero(reached.reshape(q_rad.shape[:3])[k, j])
        if not len(found):
            q_rad[k, j] = candidates.q_rad[best[k], j, np.arange(postures) % candidates.q_rad.shape[2]]
        else:
            q_rad[k, j] = q_rad[k, j, np.resize(found, postures)]
    inside = combine(at_mm, q_rad, each, what.touches, rng)
    rows = candidate_rows(spec, asked.arm, probe, asked.free, inside) @ scene.coordinates.to_free
    return inside, replace(scene, rows=np.ascontiguousarray(rows))


def _curve(
    scene: Scene, directions: F64 | None, rng: np.random.Generator, told: Progress
) -> list[tuple[int, float, float]]:
    spec = scene.spec
    least = -(-scene.coordinates.rank // scene.rows.shape[1]) if not scene.fixed.any() else 1
    wanted = {round(spec.choose * part) for part in (0.35, 0.5, 0.7)} | {least + 3}
    counts = sorted(count for count in wanted if least < count < spec.choose)
    # what a number is worth is seen on some of the candidates as well
    few = replace(scene, rows=scene.rows[rng.choice(len(scene.rows), min(CURVE_OF, len(scene.rows)), replace=False)])
    curve = []
    for done, count in enumerate(counts):
        told("curve", done, len(counts))
        best, by_chance = few.figures(few.choose(count, directions), directions), few.random(count, directions, rng)
        if best is not None and by_chance is not None:
            curve.append((count, best.u_length_mm, by_chance.u_length_mm))
    return curve


def _trial(
    asked: _Asked,
    candidates: Candidates,
    chosen: I64,
    scene: Scene,
    rng: np.random.Generator,
    told: Progress,
    workers: Workers,
    keep: str | Path | None,
) -> Trial | None:
    """On bars that no criterion has seen."""
    arm, spec, probe, free = asked.arm, asked.spec, asked.probe, asked.free
    if not spec.trials or spec.taken is not None:
        return None
    fresh_rad = Tests.of(arm, spec, asked.mover, probe, free, scene.coordinates, rng).q_rad
    some = [rng.choice(len(candidates), spec.choose, replace=False) for _ in range(TRIAL_SETS)]
    sets = [candidates.poses(which) for which in [chosen, *some]]
    return carry_out(arm, spec, probe, free, sets, fresh_rad, workers, keep, told)


def _too_few(spec: PlanSpec, scene: Scene) -> UlnaInputError:
    equations = spec.choose * scene.rows.shape[1]
    return UlnaInputError(
        f"{spec.label}: key 'plan.choose': {spec.choose} measurements give {equations} equations, too few for the "
        f"{scene.coordinates.rank} directions that are to be determined, by random ones at the least. Choose more, or "
        "hold parameters."
    )
