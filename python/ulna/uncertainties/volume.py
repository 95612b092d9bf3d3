"""How sure points and lengths are all over an arm's volume: first order, in places drawn at random. Lengths mm."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.conditions import PAYLOAD, TEMPERATURE
from ulna.arm.directions import drawn
from ulna.arm.lost import lost_steps
from ulna.arm.reading_noise import ReadingNoise
from ulna.arm.stated import Box
from ulna.ground.arrays import F64, Progress
from ulna.ground.errors import UlnaInputError
from ulna.ground.quantiles import normal, student
from ulna.ground.shown import About, Shown, Table
from ulna.simulation.mover import Mover
from ulna.simulation.places import Standing, places
from ulna.uncertainties.assess import check_known
from ulna.uncertainties.first_order import STEP_K
from ulna.uncertainties.left_out import left_out

PARTS = (0.1, 0.33, 0.66, 1.0, 1.3)
"""Lengths that are asked for where none are, in parts of the reach."""
BLOCK = 2000
"""Places worked on at a time, so that memory stays bounded."""


@dataclass(frozen=True)
class VolumeTask:
    """What is asked."""

    travel_rad: F64
    """(n, 2) how far the joints turn."""
    probe: str
    label: str
    """How messages call it."""
    noise: ReadingNoise
    """How readings scatter while measuring."""
    lengths_mm: tuple[float, ...] | None = None
    """None: `PARTS` of the reach."""
    points: int = 20_000
    bars: int = 2000
    """Of each length, touched once at each end."""
    box_mm: Box | None = None
    """Where; None: wherever the arm reaches."""
    temperature_c: float | None = None
    payload: str | None = None
    """What is carried, where that matters."""
    u_temperature_k: float = 0.0
    p: float = 0.95


@dataclass(frozen=True)
class Somewhere:
    """Standard uncertainties in many places; NaN where the calibration left something open that matters there."""

    at_mm: F64
    """(N, 3) base frame; of a bar its middle."""
    u_mm: F64
    """(N,) of a length; of a point of its position, the root of the sum of its coordinates' variances."""
    expanded_mm: F64
    """(N,) u times its own coverage factor; of a point NaN, for a position has no single k."""


@dataclass(frozen=True, repr=False)
class VolumeMap(Shown):
    """What was found."""

    arm: str
    probe: str
    reach_mm: float
    p: float
    seed: int
    points: Somewhere
    lengths: dict[float, Somewhere]
    """Length → bars of it."""
    not_determined: list[dict[str, Any]]
    """Directions that the calibration left open, and on which some of it depends."""
    left_out: list[str]

    def about(self) -> About:
        """Middle and largest of points and of each length."""
        named = {"points, u": self.points.u_mm}
        named |= {f"lengths of {length:g} mm, U": found.expanded_mm for length, found in self.lengths.items()}
        rows = []
        for name, values in named.items():
            known = values[np.isfinite(values)]
            shown = [1000.0 * float(np.median(known)), 1000.0 * float(known.max())] if len(known) else []
            rows.append([name, *([f"{value:.3g}" for value in shown] or ["–", "–"]), str(len(values) - len(known))])
        title = f"Uncertainty all over the volume of '{self.arm}', probe '{self.probe}', reach {self.reach_mm:.0f} mm"
        return About(title, {}, [Table(["", "median / µm", "largest / µm", "not determined"], rows)], self.left_out)

    @property
    def whole(self) -> bool:
        """Whether everything is determined everywhere."""
        return not any(np.isnan(found.u_mm).any() for found in (self.points, *self.lengths.values()))


def volume_map(arm: Arm, task: VolumeTask, seed: int = 0, progress: Progress | None = None) -> VolumeMap:
    """Draw points and bars, uniform over the volume, each in a posture at random, and say how sure they are.

    `arm.uncertainty` must be set. Raises UlnaInputError where no place is found, or no uncertainty is known.
    """
    check_known(arm)
    arm.check_covered(task.label, "volume files", (TEMPERATURE, PAYLOAD))
    told = progress if progress is not None else lambda *_: None
    mover, probe = Mover(arm, task.travel_rad), arm.probe_index(task.probe)
    reach_mm = arm.core.reach_mm(probe)
    lengths_mm = task.lengths_mm or tuple(float(f"{part * reach_mm:.2g}") for part in PARTS)
    total = 1 + len(lengths_mm)
    told("places", 0, total)
    rng = np.random.default_rng([seed, 51])
    at_mm, q_rad = _points(arm, task, mover, probe, rng)
    account = Account(arm, task)
    points = Somewhere(at_mm, account.of_points(q_rad), np.full(len(at_mm), np.nan))
    told("places", 1, total)
    lengths: dict[float, Somewhere] = {}
    for length_mm in lengths_mm:
        ends_mm = np.array([[0.0, 0.0, 0.0], [length_mm, 0.0, 0.0]])
        bar = Standing(ends_mm, f"{task.label}: length {length_mm:g} mm", box_mm=task.box_mm)
        stands_mm, poses = places(bar, mover, probe, task.bars, 1, rng, task.temperature_c, task.payload)
        u_mm, expanded_mm = account.of_lengths(np.ascontiguousarray(poses[:, :, 0]))
        lengths[length_mm] = Somewhere(stands_mm.mean(axis=1), u_mm, expanded_mm)
        told("places", 1 + len(lengths), total)
    known = arm.uncertainty
    assert known is not None
    return VolumeMap(
        arm=arm.name,
        probe=task.probe,
        reach_mm=reach_mm,
        p=task.p,
        seed=seed,
        points=points,
        lengths=lengths,
        not_determined=[known.lost[number] for number in sorted(account.open)],
        left_out=left_out(arm, task.noise, task.u_temperature_k, account.exact),
    )


def _points(arm: Arm, task: VolumeTask, mover: Mover, probe: int, rng: np.random.Generator) -> tuple[F64, F64]:
    """(N, 3) points uniform over the volume, and (N, n) postures."""
    reach_mm = arm.core.reach_mm(probe)
    low, high = np.array(task.box_mm if task.box_mm is not None else ((-reach_mm,) * 3, (reach_mm,) * 3))
    at: list[F64] = []
    poses: list[F64] = []
    found = rounds = 0
    while found < task.points and rounds < 200:
        points_mm = rng.uniform(low, high, (4 * task.points, 3))
        points_mm = np.ascontiguousarray(points_mm[mover.near_reach(points_mm, probe)][: task.points - found])
        conditions = arm.conditions(len(points_mm), task.temperature_c, payload=task.payload)
        seed = int(rng.integers(2**63))
        q_rad, reached = mover.on_points(points_mm, np.full(len(points_mm), probe), conditions, seed)
        at.append(points_mm[reached])
        poses.append(q_rad[reached])
        found += int(reached.sum())
        rounds += 1
    if found < task.points:
        raise UlnaInputError(
            f"{task.label}: only {found} of {task.points} points were found that the arm reaches; expected a volume "
            "within its reach. Move or widen it, or widen the travel."
        )
    return np.concatenate(at), np.concatenate(poses)


class Account:
    """Sensitivities and sources, and what was met on the way."""

    def __init__(self, arm: Arm, task: VolumeTask) -> None:
        known = arm.uncertainty
        assert known is not None
        self._arm, self._task = arm, task
        self._covariance = known.over(arm.parameter_names)
        names = arm.parameter_names
        self._lost = [number for number, direction in enumerate(known.lost) if not direction.get("frame", False)]
        self._directions = lost_steps(arm)
        self._held = [k for k, name in enumerate(names) if name not in known.names]
        self._drawn = np.array([drawn(names[k]) for k in self._held])
        self._matters = np.zeros(len(self._held), dtype=bool)
        self.open: set[int] = set()

    @property
    def exact(self) -> list[str]:
        """Parameters that matter somewhere and count as exact."""
        return [self._arm.parameter_names[k] for k, matters in zip(self._held, self._matters, strict=True) if matters]

    def of_points(self, q_rad: F64) -> F64:
        """(N, n) → (N,) standard uncertainty of the position."""
        parts = []
        for start in range(0, len(q_rad), BLOCK):
            q = np.ascontiguousarray(q_rad[start : start + BLOCK])
            # all coordinates of a point in a row: their variances are summed
            sources = self._variances(q, np.broadcast_to(np.eye(3), (len(q), 3, 3))[:, :, None])
            parts.append(np.sqrt(np.sum(sources, axis=0).sum(axis=1)))
        return np.concatenate(parts)

    def of_lengths(self, q_rad: F64) -> tuple[F64, F64]:
        """(N, 2, n) → (N,) standard and expanded uncertainty of the length."""
        us, expanded = [], []
        for start in range(0, len(q_rad), BLOCK):
            q = q_rad[start : start + BLOCK]
            flat = np.ascontiguousarray(q.reshape(-1, q.shape[2]))
            ends = self._arm.tip(flat, self._task.probe, self._task.temperature_c, payload=self._task.payload).reshape(
                -1, 2, 3
            )
            along = ends[:, 1] - ends[:, 0]
            along = along / np.linalg.norm(along, axis=1, keepdims=True)
            shown, others = self._variances(flat, np.stack([-along, along], axis=1)[:, None])
            variance = (shown + others)[:, 0]
            us.append(np.sqrt(variance))
            expanded.append(us[-1] * self._k(shown[:, 0], variance))
        return np.concatenate(us), np.concatenate(expanded)

    def _variances(self, q_rad: F64, by_tip: F64) -> tuple[F64, F64]:
        """(M K, n) poses, K to a value, and (M, values, K, 3) derivatives of the values by the tips: variances
        (M, values) from the parameters (NaN where they are open) with what residuals showed of touches, and from the
        rest."""
        arm, task = self._arm, self._task
        count, values, each, _ = by_tip.shape
        moved = arm.jacobian(q_rad, task.probe, task.temperature_c, payload=task.payload).reshape(count, each, 3, -1)
        rows = np.einsum("mvkj,mkjp->mvp", by_tip, moved)
        if len(self._held):
            self._matters |= np.abs(rows[:, :, self._held]).max(axis=(0, 1)) * self._drawn > task.noise.moves_mm
        parameters: F64 = np.einsum("mvp,mvp->mv", rows @ self._covariance, rows)
        away = np.abs(rows @ self._directions.T) > task.noise.moves_mm
        if away.any():
            self.open |= {self._lost[row] for row in np.flatnonzero(away.any(axis=(0, 1))).tolist()}
            parameters[away.any(axis=2)] = np.nan
        others = np.zeros((count, values))
        if task.noise.encoder_rad is not None:
            at = arm.conditions(len(q_rad), task.temperature_c, payload=task.payload)
            turned = arm.core.encoder_jacobian(q_rad, arm.probe_index(task.probe), **at).reshape(count, each, 3, -1)
            others += ((np.einsum("mvkj,mkji->mvki", by_tip, turned) * task.noise.encoder_rad) ** 2).sum(axis=(2, 3))
        by_touch = (by_tip**2).sum(axis=(2, 3))
        shown = parameters + task.noise.estimated_mm2 * by_touch
        others += task.noise.stated_mm2 * by_touch
        if task.u_temperature_k and task.temperature_c is not None:
            warm, cold = (
                arm.tip(q_rad, task.probe, task.temperature_c + step, payload=task.payload)
                for step in (STEP_K, -STEP_K)
            )
            by_kelvin = ((warm - cold) / (2.0 * STEP_K)).reshape(count, each, 3)
            others += (np.einsum("mvkj,mkj->mv", by_tip, by_kelvin) * task.u_temperature_k) ** 2
        return shown, others

    def _k(self, shown: F64, variance: F64) -> F64:
        """(M,) coverage factors: Student's where the calibration estimated its noise (GUM G.4.1), else normal."""
        upper = 0.5 * (1.0 + self._task.p)
        freedom = self._task.noise.degrees_of_freedom
        if math.isinf(freedom):
            return np.full(len(variance), normal(upper))
        with np.errstate(divide="ignore", invalid="ignore"):
            effective = freedom * (variance / shown) ** 2
        k: F64 = np.full(len(variance), normal(upper))
        some = np.isfinite(effective)
        k[some] = student(effective[some], upper)
        return k
