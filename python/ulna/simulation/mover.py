"""Postures of a true arm, with all that it does beyond geometry. Angles rad, lengths mm."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.conditions import Conditions, some_of
from ulna.ground.arrays import F64, I64, Bool
from ulna.ground.errors import UlnaInputError

#: random elbows and wrists to try for a point
TRIES = 20
#: a tip this close to its point is on it, as in the core
REACHED_MM = 1e-9
#: a warm arm is a little longer: from the cold posture few steps lead to the warm one
STEPS = 12
#: poses that say where the tip can be at all
SURVEYED = 500_000
#: cells along the reach to each side
CELLS = 20


def travel_or_limits(arm: Arm, travel_rad: F64 | None, label: str) -> F64:
    """(n, 2) how far the joints turn: as stated, else the arm's limits, of an endless joint one turn. Raises
    UlnaInputError without either."""
    if travel_rad is not None:
        return np.array(travel_rad, dtype=np.float64)
    for k, joint in enumerate(arm.joints, start=1):
        if joint.travel_rad is None:
            raise UlnaInputError(
                f"{label}: joint {k} of arm '{arm.name}' has no limits; expected how far each joint turns, for a "
                f"posture that the arm cannot take is of no use. Add limits (or endless = true) to the arm "
                f"file, or [travel] to {label}."
            )
    return np.array([joint.travel_rad for joint in arm.joints], dtype=np.float64)


@dataclass(frozen=True)
class Mover:
    """Moves an arm within its travel."""

    arm: Arm
    travel_rad: F64
    """(n, 2) lowest and highest encoder angle."""

    def anywhere(self, count: int, rng: np.random.Generator) -> F64:
        """(count, n) encoder angles, uniform over the travel."""
        return rng.uniform(self.travel_rad[:, 0], self.travel_rad[:, 1], (count, self.arm.n))

    def on_points(
        self, points_mm: F64, probe: I64, conditions: Conditions, seed: int, tries: int = TRIES
    ) -> tuple[F64, Bool]:
        """(N, n) postures with the tip on (N, 3) points, elbow and wrist at random, and which points were reached.

        probe (N,); conditions of the poses, as `Arm.conditions` gives them.
        tries: random elbows and wrists for a point.
        """
        q_rad, reached = np.zeros((len(points_mm), self.arm.n)), np.zeros(len(points_mm), dtype=bool)
        for index in np.unique(probe).tolist():
            own = np.flatnonzero(probe == index)
            points = np.ascontiguousarray(points_mm[own])
            q_rad[own], reached[own] = self.arm.core.pose_for_points(points, self.travel_rad, seed, index, tries)
            if conditions:
                there = own[reached[own]]
                at = some_of(conditions, there)
                q_rad[there], reached[there] = self._under(q_rad[there], points_mm[there], index, at)
        return q_rad, reached

    def nearby(self, q_rad: F64, points_mm: F64, probe: I64, conditions: Conditions, seed: int) -> tuple[F64, Bool]:
        """(N, n) postures with the tip on (N, 3) points, each near a given one; where there is none near, any other.

        And which points were reached. probe (N,).
        """
        low, high = self.travel_rad.T
        found, reached = np.clip(q_rad, low, high), np.zeros(len(points_mm), dtype=bool)
        for index in np.unique(probe).tolist():
            own = np.flatnonzero(probe == index)
            found[own], reached[own] = self._under(found[own], points_mm[own], index, some_of(conditions, own))
        rest = np.flatnonzero(~reached)
        if len(rest):
            found[rest], reached[rest] = self.on_points(points_mm[rest], probe[rest], some_of(conditions, rest), seed)
        return found, reached

    def _under(self, q_rad: F64, points_mm: F64, probe: int, conditions: Conditions) -> tuple[F64, Bool]:
        """The same postures under conditions: Newton's steps of least motion, joints at their ends staying there."""
        low, high = self.travel_rad.T
        core, q_rad = self.arm.core, q_rad.copy()
        miss_mm = points_mm - core.tip(q_rad, probe, **conditions)
        for _ in range(STEPS):
            rest = np.flatnonzero(np.linalg.norm(miss_mm, axis=1) > REACHED_MM / 4)
            if not len(rest):
                break
            at = some_of(conditions, rest)
            jacobian = core.encoder_jacobian(np.ascontiguousarray(q_rad[rest]), probe, **at)
            free = (q_rad[rest] > low) & (q_rad[rest] < high)
            jacobian = jacobian * free[:, None, :]
            back = jacobian.transpose(0, 2, 1)
            square = jacobian @ back
            # a hair of damping: three joints at their ends may leave no way to go
            square += 1e-12 * np.trace(square, axis1=1, axis2=2)[:, None, None] * np.eye(3) + 1e-12 * np.eye(3)
            step = (back @ np.linalg.solve(square, miss_mm[rest][..., None]))[..., 0]
            q_rad[rest] = np.clip(q_rad[rest] + np.clip(step, -0.1, 0.1), low, high)
            miss_mm[rest] = points_mm[rest] - core.tip(np.ascontiguousarray(q_rad[rest]), probe, **at)
        return q_rad, np.linalg.norm(miss_mm, axis=1) <= REACHED_MM

    @cached_property
    def survey(self) -> dict[int, Survey]:
        """Where each probe's tip can be, roughly."""
        return {}

    def near_reach(self, points_mm: F64, probe: int) -> Bool:
        """(N,) whether the tip was near (N, 3) points in a survey of the travel; quick, and exact but at the edge."""
        if probe not in self.survey:
            self.survey[probe] = Survey.of(self, probe)
        return self.survey[probe].holds(points_mm)


@dataclass(frozen=True)
class Survey:
    """Cells of the space around the base in which the tip was seen."""

    cell_mm: float
    seen: Bool

    @classmethod
    def of(cls, mover: Mover, probe: int) -> Survey:
        """From random poses at 20 °C, always the same."""
        q_rad = mover.anywhere(SURVEYED, np.random.default_rng(0))
        cell_mm = mover.arm.core.reach_mm(probe) / CELLS
        survey = cls(cell_mm, np.zeros((2 * CELLS + 2,) * 3, dtype=bool))
        survey.seen[survey._cells(mover.arm.core.tip(q_rad, probe))] = True
        return survey

    def holds(self, points_mm: F64) -> Bool:
        """(N,) whether the tip was seen in the cells of (N, 3) points."""
        inside: Bool = np.all(np.abs(points_mm) < CELLS * self.cell_mm, axis=1)
        return inside & self.seen[self._cells(points_mm)]

    def _cells(self, points_mm: F64) -> tuple[I64, ...]:
        cells = np.clip(np.floor(points_mm / self.cell_mm).astype(np.int64) + CELLS, 0, 2 * CELLS + 1)
        return tuple(cells.T)
