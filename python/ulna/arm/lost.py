"""What a calibration left open, as steps of an arm's parameters."""

from __future__ import annotations

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.directions import steps
from ulna.ground.arrays import F64


def lost_steps(arm: Arm) -> F64:
    """(L, parameters): each direction that was not determined, as far as a drawing leaves it open; those of the base
    frame, which move no shape, are left out. `arm.uncertainty` must be set."""
    assert arm.uncertainty is not None
    names = arm.parameter_names
    lost = [direction for direction in arm.uncertainty.lost if not direction.get("frame", False)]
    found = np.zeros((len(lost), len(names)))
    for row, direction in enumerate(lost):
        weights = direction["combination"]
        for name, weight in weights.items():
            found[row, names.index(name)] = weight
        found[row] /= max(steps(weights).values())
    return found
