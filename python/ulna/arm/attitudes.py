"""How the last link is turned: from three of its points, which the core carries to the base frame."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

import ulna._core as _core
from ulna.ground.arrays import F64, I64

_APART_MM = 1000.0


def attitudes(core: _core.Arm, q_rad: F64, probe: int | I64, conditions: Mapping[str, Any]) -> F64:
    """(N, n) encoder angles → (N, 3, 3): from the probe's frame, which turns with the last link, to the base frame.
    conditions: as `Arm.conditions` gives them."""
    names, parameters = core.parameter_names, np.asarray(core.parameters)
    tips = [core.tip(q_rad, probe, **conditions)]
    for axis in "xy":
        moved = parameters.copy()
        moved[[names.index(f"probe.{name}.{axis}") for name in core.probe_names]] += _APART_MM
        tips.append(core.with_parameters(moved).tip(q_rad, probe, **conditions))
    x, y = (each - tips[0] for each in tips[1:])
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    y /= np.linalg.norm(y, axis=1, keepdims=True)
    return np.stack([x, y, np.cross(x, y)], axis=2)
