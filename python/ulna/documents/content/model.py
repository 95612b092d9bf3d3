"""What the arm was taken to be: links and effects beyond geometry."""

from __future__ import annotations

from dataclasses import dataclass

from ulna.arm.arm import Arm


@dataclass(frozen=True)
class Model:
    """The model whose parameters were fitted."""

    hayati: list[int]
    """Joints after Hayati, from 1; all others are after Denavit and Hartenberg."""
    effects: list[str]
    """Beyond geometry, as `[fit] extras` calls them."""


def model(arm: Arm) -> Model:
    """Of the calibrated arm."""
    return Model([k for k, joint in enumerate(arm.joints, start=1) if joint.model == "hayati"], list(arm.extras))
