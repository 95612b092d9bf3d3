"""Where two arms are compared: lengths between places all over the volume, the same poses for both."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ulna.arm.arm import Arm
from ulna.comparison.pair import Pair
from ulna.ground.arrays import F64
from ulna.simulation.mover import Mover


@dataclass(frozen=True)
class Lengths:
    """Between two poses each. A length knows no base frame: nothing has to be laid over something first."""

    before_mm: F64
    """(K,) by the earlier calibration."""
    after_mm: F64
    middle_mm: F64
    """(K, 3) of the two tips, earlier base frame."""
    by_parameter: F64
    """(K, P) derivatives, at the earlier one."""

    @property
    def change_mm(self) -> F64:
        """(K,) later less earlier."""
        return self.after_mm - self.before_mm


def lengths(pair: Pair, count: int, seed: int = 0) -> Lengths:
    """`count` lengths, the poses of both ends uniform over `travel`."""
    arm = pair.before.arm
    q = Mover(arm, travel(arm)).anywhere(2 * count, np.random.default_rng(seed))
    ends, later = (_tips(each.arm, pair.probe, q).reshape(-1, 2, 3) for each in (pair.before, pair.after))
    apart = ends[:, 1] - ends[:, 0]
    length_mm = np.linalg.norm(apart, axis=1)
    moved = arm.jacobian(q, pair.probe, 20.0, np.zeros(q.shape), "none").reshape(count, 2, 3, -1)
    by_parameter = np.einsum("kc,kcp->kp", apart / length_mm[:, None], moved[:, 1] - moved[:, 0])
    return Lengths(
        length_mm, np.linalg.norm(later[:, 1] - later[:, 0], axis=1), ends.mean(axis=1), pair.of(arm, by_parameter)
    )


def _tips(arm: Arm, probe: str, q_rad: F64) -> F64:
    """At 20 °C, with no load, each joint turned to where it is from a side that nobody knows."""
    return arm.tip(q_rad, probe, 20.0, np.zeros(q_rad.shape), "none")


def travel(arm: Arm) -> F64:
    """(n, 2) how far the joints turn: as the arm file says, else one turn."""
    turn = (-np.pi, np.pi)
    return np.array([turn if joint.travel_rad is None else joint.travel_rad for joint in arm.joints], dtype=np.float64)
