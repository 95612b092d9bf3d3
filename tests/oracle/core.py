"""Hands an oracle's arm and readings to the compiled core, unchanged."""

from collections.abc import Sequence

import numpy as np

import ulna._core as _core

from .chain import Chain
from .effects import Affected
from .fits import Groups, Noise
from .observed import Lengths, Points
from .surfaces import Cylinder, Distances, Plane, Sphere

COMPLIANCE = ("compliance_rad_per_nm", "masses_kg", "centres_mm", "gravity")


def core_arm(arm: Chain | Affected, names: Sequence[str] | None = None) -> _core.Arm:
    """The same arm in the core; probes are called bent, p1, p2, … unless named."""
    if isinstance(arm, Affected):
        effects = [
            ("encoder-harmonics", {"orders": arm.orders, "amplitudes_rad": arm.harmonics_rad}),
            ("backlash", {"backlash_rad": arm.backlash_rad}),
            ("link-expansion", {"expansion_per_k": arm.expansion_per_k}),
            ("compliance", {name: getattr(arm, name) for name in COMPLIANCE} | {"payload_kg": np.zeros(1)}),
        ]
        given = [(kind, arrays) for kind, arrays in effects if all(array is not None for array in arrays.values())]
        return core_arm(arm.chain, names).with_effects(given)
    names = names or ["bent", *(f"p{k}" for k in range(1, arm.probes))]
    hayati = np.array([*arm.hayati, False])
    links = np.zeros((4, arm.joints))
    links[:, :-1] = arm.theta0_rad, arm.alpha_rad, arm.a_mm, arm.last
    theta0, alpha, a, last = links
    d, beta = np.where(hayati, 0.0, last), np.where(hayati, last, 0.0)
    return _core.Arm(theta0, alpha, a, d, beta, np.array(arm.sign, float), hayati, list(names), np.array(arm.tips_mm))


def core_problem(arm: Chain | Affected, groups: Groups, noise: Noise | None = None) -> _core.Problem:
    problem = _core.Problem(core_arm(arm), *((noise.encoder_rad, noise.seat_mm) if noise else (None, None)))
    for number, group in enumerate(groups):
        probe = np.broadcast_to(np.asarray(group.probe, np.int64), (len(group.q_rad),)).copy()
        q_rad, *told = split(arm, group.q_rad)
        conditions = dict(zip(("warmth_k", "approach"), told, strict=True))
        if isinstance(group, Lengths):
            p_rad, _, p_approach = split(arm, group.p_rad)
            of = {"p_rad": p_rad, "p_approach": p_approach, "measured_mm": group.length_mm}
            index = problem.add("length", f"lengths {number}", q_rad=q_rad, probe=probe, **conditions, **of)
        elif isinstance(group, Points):
            of = {"features_mm": group.features_mm, "frame": "free" if group.placed else "arm"}
            of |= {"feature": group.feature.astype(np.int64), "placement": group.placement.astype(np.int64)}
            index = problem.add("points", f"points {number}", q_rad=q_rad, probe=probe, **conditions, **of)
        elif isinstance(group, Sphere | Cylinder):
            kind = "sphere" if isinstance(group, Sphere) else "cylinder"
            of = {"dimensions": [("diameter", group.diameter_mm, 0.0, False)], "inside": group.inside}
            of |= {"balls_mm": group.balls_mm, "placement": group.placement.astype(np.int64)}
            index = problem.add(kind, f"{kind} {number}", q_rad=q_rad, probe=probe, **conditions, **of)
        elif isinstance(group, Distances):
            of = {"measured_mm": group.measured_mm, "placement": group.placement.astype(np.int64)}
            index = problem.add("distance", f"distances {number}", q_rad=q_rad, probe=probe, **conditions, **of)
        elif isinstance(group, Plane):
            of = {"balls_mm": group.balls_mm, "placement": group.placement.astype(np.int64)}
            index = problem.add("plane", f"flat {number}", q_rad=q_rad, probe=probe, **conditions, **of)
        assert index == number
    return problem


def split(arm: Chain | Affected, readings: np.ndarray) -> tuple[np.ndarray, np.ndarray | None, np.ndarray | None]:
    """An oracle's readings: angles, and temperatures and approaches where there are any."""
    n = arm.joints
    q_rad, *told = (np.ascontiguousarray(readings[:, k * n : (k + 1) * n]) for k in range(3))
    warmth_k, approach = (values if values.size else None for values in told)
    return q_rad, warmth_k, approach


def nothing_held(arm: Chain | Affected) -> np.ndarray:
    return np.zeros(len(arm.parameters), bool)
