"""What a joint does beyond its geometry: an eccentric encoder, a link that grows, a bearing that gives way.

    turn_i = sign_i (q_i + Σ_k c_ik cos k q_i + s_ik sin k q_i) - theta0_i + compliance_i m_i
    a_i, d_i (of the last joint: the tip) grow by the factor 1 + expansion_i (T - 20 °C)

with m_i the moment, about axis i, of gravity on all that the joint carries, N m. All of it is off until an arm has it.
Names of the parameters: `joint.3.c1`, `joint.3.s1`, …, `joint.3.expansion`, `joint.3.compliance`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from typing import Literal

import numpy as np
from numpy.typing import NDArray

F64 = NDArray[np.float64]

Extra = Literal["encoder-harmonics", "link-expansion", "compliance"]

EXTRAS: tuple[Extra, ...] = ("encoder-harmonics", "link-expansion", "compliance")
"""The blocks that a fit may be asked for, in the order of their parameters."""

PATTERNS: dict[str, tuple[str, ...]] = {
    "encoder-harmonics": ("joint.*.c[0-9]*", "joint.*.s[0-9]*"),
    "link-expansion": ("joint.*.expansion",),
    "compliance": ("joint.*.compliance",),
}
"""Shell-style patterns of their parameters' names."""

REFERENCE_C = 20.0
"""Lengths are those at this temperature (ISO 1), °C."""


@dataclass(frozen=True)
class Effects:
    """Of one joint. What is None or empty the joint does not have."""

    harmonics_rad: Mapping[int, tuple[float, float]] = field(default_factory=dict)
    """Order k → amplitudes (c_k, s_k) of the encoder's error."""
    expansion_per_k: float | None = None
    """Of the link after the joint; of the last joint, of the probe."""
    compliance_rad_per_nm: float | None = None
    """How far the joint gives way to a moment about its axis."""
    mass_kg: float = 0.0
    """Of what moves with the joint up to the next: its link."""
    centre_mm: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """The centre of that mass, in the frame after the link."""


NONE = Effects()


def extras_of(joints: Sequence[Effects]) -> list[Extra]:
    """The blocks that an arm of such joints has."""
    has = {
        "encoder-harmonics": any(own.harmonics_rad for own in joints),
        "link-expansion": any(own.expansion_per_k is not None for own in joints),
        "compliance": any(own.compliance_rad_per_nm is not None for own in joints),
    }
    return [extra for extra in EXTRAS if has[extra]]


def orders_of(joints: Sequence[Effects]) -> list[int]:
    """The orders of harmonics that any of the joints has, ascending."""
    return sorted({order for own in joints for order in own.harmonics_rad})


def with_extras(own: Effects, extras: Sequence[str], orders: Sequence[int]) -> Effects:
    """The effects with zero of what `extras` asks for, where there is none of it yet; orders: of harmonics."""
    if "encoder-harmonics" in extras:
        own = replace(own, harmonics_rad=dict.fromkeys(sorted(orders), (0.0, 0.0)) | dict(own.harmonics_rad))
    if "link-expansion" in extras and own.expansion_per_k is None:
        own = replace(own, expansion_per_k=0.0)
    if "compliance" in extras and own.compliance_rad_per_nm is None:
        own = replace(own, compliance_rad_per_nm=0.0)
    return own


def extra_of(parameter: str) -> Extra | None:
    """The block that a parameter belongs to, by its name."""
    own = (extra for extra in EXTRAS if any(fnmatchcase(parameter, pattern) for pattern in PATTERNS[extra]))
    return next(own, None)


def for_core(joints: Sequence[Effects], gravity: Sequence[float]) -> list[tuple[str, dict[str, F64]]]:
    """What `_core.Arm.with_effects` takes: a joint without what others have counts as having zero of it."""
    extras, orders = extras_of(joints), orders_of(joints)
    given: list[tuple[str, dict[str, F64]]] = []
    if orders:
        amplitudes_rad = np.array([[own.harmonics_rad.get(order, (0.0, 0.0)) for order in orders] for own in joints])
        given.append(("encoder-harmonics", {"orders": np.array(orders, float), "amplitudes_rad": amplitudes_rad}))
    if "link-expansion" in extras:
        given.append(("link-expansion", {"expansion_per_k": np.array([own.expansion_per_k or 0.0 for own in joints])}))
    if "compliance" in extras:
        compliance = {
            "compliance_rad_per_nm": np.array([own.compliance_rad_per_nm or 0.0 for own in joints]),
            "masses_kg": np.array([own.mass_kg for own in joints]),
            "centres_mm": np.array([own.centre_mm for own in joints], dtype=np.float64),
            "gravity": np.array(gravity, dtype=np.float64),
        }
        given.append(("compliance", compliance))
    return given


def from_core(joints: Sequence[Effects], values: F64) -> list[Effects]:
    """The joints' effects with other values, in the order of the core's parameters behind the geometry."""
    n, orders, extras = len(joints), orders_of(joints), extras_of(joints)
    harmonics, rest = values[: 2 * len(orders) * n].reshape(n, len(orders), 2).tolist(), values[2 * len(orders) * n :]
    blocks: dict[str, list[float]] = {}
    for extra in extras:
        if extra != "encoder-harmonics":
            blocks[extra], rest = rest[:n].tolist(), rest[n:]
    return [
        replace(
            own,
            harmonics_rad={order: (c, s) for order, (c, s) in zip(orders, harmonics[k], strict=True)},
            expansion_per_k=blocks["link-expansion"][k] if "link-expansion" in blocks else None,
            compliance_rad_per_nm=blocks["compliance"][k] if "compliance" in blocks else None,
        )
        for k, own in enumerate(joints)
    ]
