"""Hands an oracle's arm and readings to the compiled core, unchanged."""

from collections.abc import Sequence

import numpy as np

from ulna import _core

from .chain import Chain
from .fits import Noise
from .observed import Lengths, Points


def core_arm(arm: Chain, names: Sequence[str] | None = None) -> _core.Arm:
    """The same arm in the core; probes are called bent, p1, p2, … unless named."""
    names = names or ["bent", *(f"p{k}" for k in range(1, arm.probes))]
    hayati = np.array([*arm.hayati, False])
    links = np.zeros((4, arm.joints))
    links[:, :-1] = arm.theta0_rad, arm.alpha_rad, arm.a_mm, arm.last
    theta0, alpha, a, last = links
    d, beta = np.where(hayati, 0.0, last), np.where(hayati, last, 0.0)
    return _core.Arm(theta0, alpha, a, d, beta, np.array(arm.sign, float), hayati, list(names), np.array(arm.tips_mm))


def core_problem(arm: Chain, groups: Sequence[Lengths | Points], noise: Noise | None = None) -> _core.Problem:
    problem = _core.Problem(core_arm(arm), *((noise.encoder_rad, noise.seat_mm) if noise else (None, None)))
    for number, group in enumerate(groups):
        probe = np.broadcast_to(np.asarray(group.probe, np.int64), (len(group.q_rad),)).copy()
        if isinstance(group, Lengths):
            index = problem.add_lengths(f"lengths {number}", group.q_rad, group.p_rad, probe, group.length_mm)
        else:
            frame = "free" if group.placed else "arm"
            feature, placement = group.feature.astype(np.int64), group.placement.astype(np.int64)
            index = problem.add_points(
                f"points {number}", group.features_mm, frame, group.q_rad, probe, feature, placement
            )
        assert index == number
    return problem


def nothing_held(arm: Chain) -> np.ndarray:
    return np.zeros(len(arm.parameters), bool)
