"""`coupling`: joints that turn with other joints' encoders too.

q_i + Σ_k coupling_ik · q_k   in place of each encoder angle q_i

Many robots' controllers show how far a motor has turned, not a joint: the elbow of a parallelogram against the ground,
wrist axes whose shafts run through one another. With coupling = { 2 = 1.0 } of joint 3 its turn is what is shown of it
plus what is shown of joint 2.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from ulna.arm.effects.effect import Effect, Row
from ulna.formats.models import Strict
from ulna.formats.units import Units
from ulna.ground.errors import UlnaInputError


class CouplingKeys(Strict):
    """Of a joint's table."""

    coupling: dict[str, float] | None = None
    """Other joints whose encoders turn this one too, by number, and by how much: { 2 = 1.0 }."""
    coupled_to: list[int] | None = None
    """Other joints whose encoders may turn this one too, where nobody knows by how much."""


class Coupling(Effect):
    """Coupling of joints to other joints' encoders."""

    name = "coupling"
    table = CouplingKeys
    suffixes, examples = ("coupling[0-9]*",), ("coupling2", "coupling5")
    unit, drawn = "1", 0.01
    does = "turn with other joints' encoders too"
    words = "the coupling of its joints to other joints' encoders"
    left_out = "joints that turn with other joints' encoders"

    def has(self, own: CouplingOfJoint) -> bool:
        """Any ratio, zero too."""
        return own.coupling is not None

    def zero(self, own: CouplingOfJoint, orders: Sequence[int]) -> dict[str, Any]:
        """To what the joint may be coupled, by nothing."""
        if own.coupling is not None or not own.coupled_to:
            return {}
        return {"coupling": (0.0,) * len(own.coupled_to)}

    def none(self) -> dict[str, Any]:
        """To what the joint may be coupled stays."""
        return {"coupling": None}

    def read(self, table: CouplingKeys, key: str, units: Units, path: Path) -> dict[str, Any]:
        """Numbers, in the order of the joints."""
        if table.coupling is None:
            return {"coupled_to": tuple(sorted(set(table.coupled_to or ())))}
        ratios = {}
        for joint, ratio in table.coupling.items():
            if not (joint.isascii() and joint.isdigit()):
                raise UlnaInputError(
                    f"{path}: key '{key}.coupling': {joint!r} is no number of a joint; expected numbers of other "
                    "joints and how much they count, such as { 2 = 1.0 }. Correct it."
                )
            ratios[int(joint)] = ratio
        unsaid = {joint: 0.0 for joint in table.coupled_to or () if joint not in ratios}
        ratios = dict(sorted((ratios | unsaid).items()))
        return {"coupled_to": tuple(ratios), "coupling": tuple(ratios.values())}

    def written(self, own: CouplingOfJoint) -> dict[str, Any]:
        """The ratios, or where there are none, to what the joint may be coupled."""
        if own.coupling is not None:
            return {"coupling": dict(zip(map(str, own.coupled_to), own.coupling, strict=True))}
        return {"coupled_to": list(own.coupled_to)} if own.coupled_to else {}

    def for_core(
        self, joints: Sequence[CouplingOfJoint], gravity: Sequence[float], payload_kg: float = 0.0
    ) -> dict[str, Any]:
        """Pairs of joints, counted from 0, and the ratio of each."""
        pairs = self.ratios(joints)
        return {
            "joints": np.array([pair[:2] for pair in pairs], dtype=np.float64).reshape(-1, 2),
            "ratios": np.array([ratio for *_, ratio in pairs], dtype=np.float64),
        }

    def ratios(self, joints: Sequence[CouplingOfJoint]) -> list[tuple[int, int, float]]:
        """All of it."""
        return [
            (joint, other - 1, ratio)
            for joint, own in enumerate(joints)
            if own.coupling is not None
            for other, ratio in zip(own.coupled_to, own.coupling, strict=True)
        ]

    def taken(self, own: CouplingOfJoint, values: Mapping[str, float]) -> dict[str, Any]:
        """One number for each joint that it is coupled to."""
        return {"coupling": tuple(values[f"coupling{other}"] for other in own.coupled_to)}

    def check_joints(self, joints: Sequence[Any], path: Path, payload_kg: float = 0.0) -> None:
        """Coupled to other joints that there are, of an arm that does not give way besides: moments are those of
        joints that turn alone."""
        for k, own in enumerate(joints, 1):
            wrong = next((other for other in own.coupled_to if not 1 <= other <= len(joints) or other == k), None)
            if wrong is not None:
                raise UlnaInputError(
                    f"{path}: key 'joint.{k}.coupling': got joint {wrong}; expected the number of another joint, 1 to "
                    f"{len(joints)}. Correct it."
                )
        coupled = next((k for k, own in enumerate(joints, 1) if own.coupled_to), None)
        gives = next((k for k, own in enumerate(joints, 1) if own.compliance_rad_per_nm is not None), None)
        if coupled is not None and gives is not None:
            raise UlnaInputError(
                f"{path}: key 'joint.{coupled}.coupling': joint {gives} gives way to weight (compliance) as well; "
                "expected one of the two, since the moments of an arm with coupled joints are not computed. Remove one."
            )

    def check_asked(self, joints: Sequence[CouplingOfJoint], arm: str, label: str, payload_kg: float = 0.0) -> None:
        """Some joint says to which others it may be coupled."""
        if not any(own.coupled_to for own in joints):
            raise UlnaInputError(
                f"{label}: key 'fit.extras': 'coupling' is how joints turn with other joints' encoders, but no "
                f"joint of arm '{arm}' says with which; expected coupled_to = [2], or coupling = {{ 2 = 1.0 }}, in a "
                "joint's table of the arm file. Add it."
            )


@dataclass(frozen=True)
class CouplingOfJoint(Row):
    """What a joint has of it."""

    effect: ClassVar[Effect] = Coupling()
    coupled_to: tuple[int, ...] = ()
    """Numbers of the joints whose encoders may turn this one too, ascending."""
    coupling: tuple[float, ...] | None = None
    """By how much each of them does."""
