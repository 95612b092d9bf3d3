"""How an arm shows itself: its joints and probes as two tables."""

from __future__ import annotations

from ulna.arm.covariance import ParameterCovariance
from ulna.arm.data import ArmData
from ulna.arm.joint import Joint
from ulna.ground.digits import fixed
from ulna.ground.errors import UlnaInputError
from ulna.ground.shown import About, Table


def about_arm(arm: ArmData) -> About:
    """One screen, of up to some ten joints."""
    try:
        reach = f", reach {max(arm.core.reach_mm(k) for k in range(len(arm.probes))):.0f} mm"
    except (UlnaInputError, ValueError):  # whoever looks at an arm that cannot be used wants to see it
        reach = ""
    facts = {}
    if arm.extras:
        facts["beyond geometry"] = ", ".join(arm.extras)
    if arm.uncertainty is not None:
        facts["uncertainty"] = _known(arm.uncertainty)
    if arm.full_last_link:
        facts["last link"] = "full: the last joint has a link too"
    tilted = any(joint.model == "hayati" for joint in arm.joints)
    bare = None if arm.full_last_link else arm.n
    joints = [_joint(number, joint, tilted, number == bare) for number, joint in enumerate(arm.joints, start=1)]
    heads = ["joint", "theta0 / rad", "d / mm", "a / mm", "alpha / rad", *["beta / rad"] * tilted, "sign"]
    probes = [
        [
            name,
            *(fixed(float(value), 4) for value in probe.tip_mm),
            "–" if probe.ball_mm is None else f"{probe.ball_mm:g}",
        ]
        for name, probe in arm.probes.items()
    ]
    return About(
        f"Arm '{arm.name}': {arm.n} joints{reach}",
        facts,
        [
            Table(heads, joints),
            Table(["probe", "x / mm", "y / mm", "z / mm", "ball / mm"], probes),
        ],
    )


def _joint(number: int, joint: Joint, tilted: bool, bare: bool) -> list[str]:
    """A row; tilted: whether there is a column for beta; bare: whether no link follows."""
    name = f"{number}" + (f" {joint.name}" if joint.name else "")
    hayati = joint.model == "hayati"
    numbers = [
        fixed(joint.theta0_rad, 6),
        "–" if hayati else fixed(joint.d_mm, 4),
        fixed(joint.a_mm, 4),
        fixed(joint.alpha_rad, 6),
        *[fixed(joint.beta_rad, 6) if hayati else "–"] * tilted,
    ]
    name += ", slides" if joint.slides else ""
    return [name, *(["–"] * len(numbers) if bare else numbers), {1: "+1", -1: "-1"}.get(joint.sign, "not known")]


def _known(covariance: ParameterCovariance) -> str:
    lost = f"; {len(covariance.lost)} directions not determined" if covariance.lost else ""
    if covariance.why_none is not None:
        return f"none: {covariance.why_none.because}{lost}"
    return f"of {len(covariance.names)} parameters{lost}"
