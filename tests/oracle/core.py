"""Hands an oracle's arm and readings to the compiled core, unchanged."""

from collections.abc import Sequence

import numpy as np

import ulna._core as _core

from .chain import Chain
from .effects import Affected
from .fits import Groups, Noise
from .observed import Lengths, Points
from .surfaces import Plane, Sphere


def core_arm(arm: Chain | Affected, names: Sequence[str] | None = None) -> _core.Arm:
    """The same arm in the core; probes are called bent, p1, p2, … unless named."""
    if isinstance(arm, Affected):
        return core_arm(arm.chain, names).with_effects(stated(arm))
    names = names or ["bent", *(f"p{k}" for k in range(1, arm.probes))]
    hayati = np.array([*arm.hayati, False])
    links = np.zeros((4, arm.joints))
    links[:, :-1] = arm.theta0_rad, arm.alpha_rad, arm.a_mm, arm.last
    theta0, alpha, a, last = links
    d, beta = np.where(hayati, 0.0, last), np.where(hayati, last, 0.0)
    return _core.Arm(theta0, alpha, a, d, beta, np.array(arm.sign, float), hayati, list(names), np.array(arm.tips_mm))


def stated(arm: Affected) -> list[tuple[str, dict[str, np.ndarray]]]:
    """The effects as the core takes them."""
    found: list[tuple[str, dict]] = []
    if arm.harmonics_rad is not None:
        found.append(("encoder-harmonics", {"orders": arm.orders, "amplitudes_rad": arm.harmonics_rad}))
    if arm.expansion_per_k is not None:
        found.append(("link-expansion", {"expansion_per_k": arm.expansion_per_k}))
    if arm.compliance_rad_per_nm is not None:
        names = ("compliance_rad_per_nm", "masses_kg", "centres_mm", "gravity")
        found.append(("compliance", {name: getattr(arm, name) for name in names}))
    if arm.backlash_rad is not None:
        found.append(("backlash", {"backlash_rad": arm.backlash_rad}))
    return found


def core_problem(arm: Chain | Affected, groups: Groups, noise: Noise | None = None) -> _core.Problem:
    problem = _core.Problem(core_arm(arm), *((noise.encoder_rad, noise.seat_mm) if noise else (None, None)))
    for number, group in enumerate(groups):
        probe = np.broadcast_to(np.asarray(group.probe, np.int64), (len(group.q_rad),)).copy()
        q_rad, at = split(arm, group.q_rad)
        if isinstance(group, Lengths):
            p_rad, second = split(arm, group.p_rad)
            if "approach" in second:
                at = {**at, "p_approach": second["approach"]}
            index = problem.add_lengths(f"lengths {number}", q_rad, p_rad, probe, group.length_mm, **at)
        elif isinstance(group, Points):
            frame = "free" if group.placed else "arm"
            feature, placement = group.feature.astype(np.int64), group.placement.astype(np.int64)
            index = problem.add_points(
                f"points {number}", group.features_mm, frame, q_rad, probe, feature, placement, **at
            )
        elif isinstance(group, Sphere):
            touched = (q_rad, probe, group.placement.astype(np.int64))
            index = problem.add_sphere(
                f"ball {number}", group.diameter_mm, group.balls_mm, *touched, inside=group.inside, **at
            )
        elif isinstance(group, Plane):
            index = problem.add_plane(group.balls_mm, q_rad, probe, group.placement.astype(np.int64), **at)
        assert index == number
    return problem


def split(arm: Chain | Affected, readings: np.ndarray) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """An oracle's readings: angles, and temperatures and sides of approach where there are any, by the core's words."""
    q_rad, *more = (np.ascontiguousarray(part) for part in np.split(readings, readings.shape[1] // arm.joints, axis=1))
    return q_rad, dict(zip(("warmth_k", "approach"), more, strict=False))


def nothing_held(arm: Chain | Affected) -> np.ndarray:
    return np.zeros(len(arm.parameters), bool)
