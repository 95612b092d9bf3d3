"""The law of propagation of uncertainty for what an arm measures: who contributes how much (GUM 5.1, 5.2)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.directions import drawn, steps
from ulna.ground.arrays import F64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.uncertainties.gum import propagate
from ulna.uncertainties.task import Task

NOTHING_MM = 1e-3
"""A length of no more is none: its ends are nearer than the steps of its derivatives."""
MOVES = 1e-5
"""A lost direction matters that moves a plain number by more; a length, by what its touches are sure of."""
LARGEST = 100.0
"""Derivative of a value by a touch that is beyond all sense, mm per mm."""
STEP_K = 0.01
"""Of temperature, for its derivative."""


@dataclass(frozen=True)
class FirstOrder:
    """Values and their covariance, by source."""

    values: F64
    """(values,) in the measurand's units."""
    by_source: dict[str, F64]
    """Source → (values, values) covariance. The sources are independent of each other."""
    open: list[list[int]]
    """For each value the lost directions, by number, on which it depends: it is not determined."""

    exact: list[str]
    """Parameters that the values depend on and of which no uncertainty is known: they were held, and count as exact."""

    def u_by_source(self, value: int) -> dict[str, float]:
        """Source → standard uncertainty of one of the values."""
        return {name: float(np.sqrt(max(part[value, value], 0.0))) for name, part in self.by_source.items()}

    @property
    def covariance(self) -> F64:
        """(values, values) of all sources."""
        total: F64 = np.sum(list(self.by_source.values()), axis=0)
        return total


def first_order(arm: Arm, task: Task) -> FirstOrder:
    """`arm.uncertainty` must be set. Raises UlnaInputError for a length of nothing."""
    known = arm.uncertainty
    assert known is not None
    tips_mm = task.tips_mm(arm, task.q_rad)
    if task.touched.kind == "length" and task.touched.values(tips_mm[None])[0, 0] < NOTHING_MM:
        raise UlnaInputError(
            worded(
                "{of}: A and B are in the same place; expected two places, a length of nothing has no direction. "
                "Correct the readings.",
                of=task.label,
            )
        )
    gradient = gradient_of(task, tips_mm)
    by_parameter = np.einsum("mnj,njp->mp", gradient, arm.jacobian(task.q_rad, task.probe, **task.said()))
    sources = {"parameters": propagate(by_parameter, known.over(arm.parameter_names))}
    noise = task.noise
    if noise.encoder_rad is not None:
        conditions = arm.conditions(len(tips_mm), **task.said())
        by_angle = arm.core.encoder_jacobian(task.q_rad, arm.probe_index(task.probe), **conditions)
        by_encoder = np.einsum("mnj,nji->mni", gradient, by_angle).reshape(len(gradient), -1)
        sources["encoders"] = propagate(by_encoder, np.diag(np.tile(noise.encoder_rad**2, len(tips_mm))))
    by_touch = gradient.reshape(len(gradient), -1)
    for source, own_mm in (("touch", noise.seat_mm), ("unexplained", noise.unexplained_mm)):
        if own_mm:
            sources[source] = propagate(by_touch, own_mm**2 * np.eye(by_touch.shape[1]))
    if task.u_temperature_k:
        ends = np.stack([task.tips_mm(arm, task.q_rad, warmer) for warmer in (STEP_K, -STEP_K)])
        change = task.touched.values(ends)
        by_kelvin = ((change[0] - change[1]) / (2.0 * STEP_K))[:, None]
        sources["temperature"] = propagate(by_kelvin, np.array([[task.u_temperature_k**2]]))
    values = task.values(arm, tips_mm[None])[0]
    moves = np.array([noise.moves_mm if unit == "mm" else MOVES for unit in task.touched.measurand.units.values()])
    return FirstOrder(values, sources, _open(arm, by_parameter, moves), _exact(arm, by_parameter, moves))


def _open(arm: Arm, by_parameter: F64, moves: F64) -> list[list[int]]:
    """For each value, the lost directions that move it by more than is nothing when they move as far as a drawing
    leaves open. Those of the base frame move no shape; coordinates are meant in the frame that the arm has."""
    known = arm.uncertainty
    assert known is not None
    names = arm.parameter_names
    found: list[list[int]] = [[] for _ in by_parameter]
    for number, direction in enumerate(known.lost):
        if direction.get("frame", False):
            continue
        weights = direction["combination"]
        most = max(steps(weights).values())
        moved = sum(by_parameter[:, names.index(name)] * weight for name, weight in weights.items()) / most
        for value in np.flatnonzero(np.abs(moved) > moves).tolist():
            found[value].append(number)
    return found


def gradient_of(task: Task, tips_mm: F64) -> F64:
    """(values, N, 3): ∂value/∂coordinate of each touch, (N, 3). Raises UlnaInputError where the touches do not say what
    is asked of them: all on a line, say, of a plane."""
    try:
        gradient = task.touched.gradient(tips_mm)
        largest = float(np.abs(gradient).max())
    except np.linalg.LinAlgError:
        largest = np.inf
    if not largest < LARGEST:
        raise UlnaInputError(
            worded(
                "{of}: the touches hardly say what is asked, a {kind}: 1 µm at one of them changes it by more than "
                "{largest} mm. Expected touches that are spread over it; spread them.",
                of=task.label,
                kind=task.touched.kind,
                largest=f"{LARGEST / 1000:g}",
            )
        )
    return gradient


def _exact(arm: Arm, by_parameter: F64, moves: F64) -> list[str]:
    """Parameters of unknown uncertainty that move a value when they are off by as much as a drawing leaves open."""
    known = arm.uncertainty
    assert known is not None
    matters = (np.abs(by_parameter) / moves[:, None]).max(axis=0)
    names = [name for name in arm.parameter_names if name not in known.names]
    size = {name: matters[arm.parameter_names.index(name)] * drawn(name) for name in names}
    return [name for name in names if size[name] > 1.0]
