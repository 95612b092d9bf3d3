"""What a metrologist reads from touches of a surface: form, and a ball's diameter, from the tips alone.

Least-squares sphere and plane of each placement's ball centres, unconstrained: the sphere's diameter is fitted, not
taken from the artefact. The sphere is found from its algebraic fit by Gauss–Newton on distances; the plane's normal is
the direction in which the centres scatter least.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.artefacts.readings import Readings
from ulna.ground.arrays import F64, I64

#: touches that leave something to judge: one more than a sphere or a plane can meet
FEWEST = {"sphere": 5, "plane": 4}


@dataclass(frozen=True)
class Errors:
    """The single errors of one quantity, each with the placement that it belongs to."""

    value_mm: F64
    code: I64


def surface_errors(readings: Readings, code: I64, tip_mm: F64, ball_mm: F64) -> dict[str, Errors]:
    """Form and diameter errors, mm, of every placement touched often enough. tip_mm (N, 3), ball_mm (N,) diameters."""
    artefact = readings.artefact
    form: list[float] = []
    diameter: list[float] = []
    codes: list[int] = []
    for number in range(int(code.max()) + 1 if len(code) else 0):
        own = code == number
        if own.sum() < FEWEST[artefact.kind]:
            continue
        codes.append(number)
        if artefact.kind == "plane":
            form.append(plane_form_mm(tip_mm[own], ball_mm[own]))
            continue
        sign = -1.0 if artefact.inside else 1.0
        fitted_mm, spread_mm = sphere(tip_mm[own], sign * ball_mm[own])
        form.append(spread_mm)
        assert artefact.diameter_mm is not None
        diameter.append(fitted_mm - artefact.diameter_mm)
    found = {"form": Errors(np.array(form), np.array(codes, dtype=np.int64))} if form else {}
    if diameter:
        found["diameter_error"] = Errors(np.array(diameter), np.array(codes, dtype=np.int64))
    return found


def sphere(centre_mm: F64, ball_mm: F64) -> tuple[float, float]:
    """(diameter, largest minus smallest distance) of the least-squares sphere of ball centres (N, 3), in mm.

    ball_mm (N,): what the diameter seems too large by, for each touch.
    """
    middle = centre_mm.mean(axis=0)
    p = centre_mm - middle
    columns = np.column_stack([2.0 * p, np.ones(len(p))])
    solution = np.linalg.lstsq(columns, (p**2).sum(axis=1), rcond=None)[0]
    c = solution[:3]
    radius = float(np.sqrt(max(solution[3] + c @ c, 0.0)) - 0.5 * ball_mm.mean())
    for _ in range(100):
        arm = p - c
        distance = np.linalg.norm(arm, axis=1)
        off = distance - 0.5 * ball_mm - radius
        jacobian = np.column_stack([-arm / distance[:, np.newaxis], -np.ones(len(p))])
        step = np.linalg.lstsq(jacobian, -off, rcond=None)[0]
        c, radius = c + step[:3], radius + float(step[3])
        if np.abs(step).max() <= 1e-13 * max(abs(radius), 1.0):
            break
    off = np.linalg.norm(p - c, axis=1) - 0.5 * ball_mm
    return 2.0 * radius, float(np.ptp(off))


def plane_form_mm(centre_mm: F64, ball_mm: F64) -> float:
    """Largest minus smallest distance from the least-squares plane of ball centres (N, 3), mm."""
    p = centre_mm - centre_mm.mean(axis=0)
    normal = np.linalg.svd(p, full_matrices=False)[2][2]
    if np.ptp(ball_mm) == 0.0:
        return float(np.ptp(p @ normal))
    # balls of several sizes: their radii are taken off on the side that the plane is touched from
    return min(_form_on_one_side(p, side, 0.5 * ball_mm) for side in (normal, -normal))


def _form_on_one_side(p: F64, normal: F64, radius_mm: F64) -> float:
    """The same for one side, by Gauss–Newton on the normal's tilt and the distance."""
    off = p @ normal - radius_mm
    for _ in range(20):
        along = np.linalg.svd(normal[np.newaxis])[2][1:]
        columns = np.column_stack([p @ along.T, -np.ones(len(p))])
        step = np.linalg.lstsq(columns, -off, rcond=None)[0]
        normal = normal + step[:2] @ along
        normal /= np.linalg.norm(normal)
        off = p @ normal - radius_mm
        off -= off.mean()
        if np.abs(step[:2]).max() <= 1e-14:
            break
    return float(np.ptp(off))
