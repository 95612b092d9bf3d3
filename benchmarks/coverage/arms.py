"""True arms: the independent chain of tests/oracle, what joints do beyond it, and the same arm as Ulna is told of it.

Readings of a true arm are (N, n) angles in rad, or (N, 3 n): angles, kelvins above 20 °C of each link, and from which
side each joint was approached, -1 or +1.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from tests.oracle.arms import parallel_axes
from tests.oracle.chain import COMPLEX_STEP, Chain
from tests.oracle.effects import Affected, affected
from tests.oracle.published import six_axes, table_4

import ulna

Array = NDArray[np.float64]
Numbers = NDArray[Any]
"""Real or complex."""

BALL_MM = 6.0
"""Of the probe."""
PROBE = "bent"
ABOUT_RAD = 1e-6
"""Step of a derivative that need not be exact."""


class Tip(Protocol):
    """What is asked of a true arm; angles may be complex."""

    def tip(self, readings: Numbers, probe: int = 0) -> Numbers:
        """(N, n) or (N, 3 n) → (N, 3) mm in the base frame."""


@dataclass(frozen=True)
class Coupled:
    """An arm whose joint i turns with encoder k too, by ratios[i, k]."""

    arm: Tip
    ratios: Array

    def tip(self, readings: Numbers, probe: int = 0) -> Numbers:
        """As of `Tip`."""
        n = len(self.ratios)
        turned = readings[:, :n] + readings[:, :n] @ self.ratios.T
        return self.arm.tip(np.hstack([turned, readings[:, n:]]), probe)


@dataclass(frozen=True)
class Standing:
    """An arm whose first axis leans, rad about x and then y, and stands beside the origin, mm."""

    arm: Tip
    tilt_rad: tuple[float, float]
    beside_mm: tuple[float, float]

    def tip(self, readings: Numbers, probe: int = 0) -> Numbers:
        """As of `Tip`."""
        (cx, cy), (sx, sy) = np.cos(self.tilt_rad), np.sin(self.tilt_rad)
        about_x = np.array([[1.0, 0.0, 0.0], [0.0, cx, -sx], [0.0, sx, cx]])
        about_y = np.array([[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]])
        moved: Numbers = self.arm.tip(readings, probe) @ (about_x @ about_y).T + np.array([*self.beside_mm, 0.0])
        return moved


@dataclass(frozen=True)
class TrueArm:
    """An arm of which the truth is known."""

    tips: Tip
    chain: Chain
    """Its geometry."""
    effects: tuple[ulna.Effects, ...]
    """Of each joint, as Ulna is told the truth; empty: none."""
    gravity: tuple[float, float, float] = (0.0, 0.0, -1.0)
    warm: bool = False
    """Whether its tip depends on temperature."""
    approached: bool = False
    """Whether it depends on the side from which joints came."""
    travel_rad: Array = field(default_factory=lambda: np.array([-np.pi, np.pi]))
    """(2,) or (n, 2)."""

    @property
    def n(self) -> int:
        """Joints."""
        return self.chain.joints

    def in_ulna(self) -> ulna.Arm:
        """The same numbers, as Ulna has them; whether its tips are the same is looked at."""
        chain = self.chain
        own = self.effects or (ulna.Effects(),) * self.n
        joints = [
            ulna.Joint(
                theta0_rad=float(chain.theta0_rad[i]),
                alpha_rad=float(chain.alpha_rad[i]),
                a_mm=float(chain.a_mm[i]),
                sign=chain.sign[i],
                effects=own[i],
                **(
                    {"model": "hayati", "beta_rad": float(chain.last[i])}
                    if chain.hayati[i]
                    else {"d_mm": float(chain.last[i])}
                ),
            )
            for i in range(self.n - 1)
        ]
        joints.append(ulna.Joint(sign=chain.sign[-1], effects=own[-1]))
        x_mm, y_mm, z_mm = chain.tips_mm[0].tolist()
        probe = ulna.Probe(x_mm, y_mm, z_mm, ball_mm=BALL_MM)
        arm = ulna.Arm("true", tuple(joints), {PROBE: probe}, gravity=self.gravity)
        readings = self.random(20, np.random.default_rng(0))
        apart = np.abs(arm.tip(readings[:, : self.n], **self.said(readings)) - self.tips.tip(readings)).max()
        if apart > 1e-8:
            raise AssertionError(f"the true arm and the same arm in Ulna are {apart:g} mm apart")
        return arm

    def random(self, count: int, rng: np.random.Generator) -> Array:
        """(count, n or 3 n) readings, uniform over the travel; links within 5 K of 20 °C, the same for all."""
        low, high = np.broadcast_to(self.travel_rad, (self.n, 2)).T
        q_rad = rng.uniform(low, high, (count, self.n))
        if not (self.warm or self.approached):
            return q_rad
        warmth = np.repeat(rng.uniform(-5.0, 5.0, (count, 1)), self.n, axis=1)
        return np.hstack([q_rad, warmth, rng.choice([-1.0, 1.0], (count, self.n))])

    def said(self, readings: Array) -> dict[str, Any]:
        """What Ulna is told of poses beside their angles."""
        n = self.n
        found: dict[str, Any] = {"temperature_c": 20.0 + readings[:, n]} if self.warm else {}
        return found | ({"approach": readings[:, 2 * n :]} if self.approached else {})

    def by_encoder(self, readings: Array) -> Array:
        """(N, 3, n) mm/rad, by complex steps, all at once."""
        moved = np.repeat(readings[None].astype(complex), self.n, axis=0)
        moved[np.arange(self.n), :, np.arange(self.n)] += 1j * COMPLEX_STEP
        tips = self.tips.tip(moved.reshape(-1, readings.shape[1])).imag / COMPLEX_STEP
        found: Array = tips.reshape(self.n, len(readings), 3).transpose(1, 2, 0)
        return found

    def about_by_encoder(self, readings: Array) -> Array:
        """(N, 3, n) mm/rad, roughly and quickly: for a search that ends on exact tips."""
        moved = np.repeat(readings[None], self.n + 1, axis=0)
        moved[np.arange(self.n), :, np.arange(self.n)] += ABOUT_RAD
        tips = self.tips.tip(moved.reshape(-1, readings.shape[1])).reshape(self.n + 1, len(readings), 3)
        found: Array = ((tips[:-1] - tips[-1]) / ABOUT_RAD).transpose(1, 2, 0)
        return found


def _rigid(chain: Chain) -> TrueArm:
    return TrueArm(chain, chain, ())


def _with_tip(x_mm: float, y_mm: float, z_mm: float) -> Chain:
    """The arm of Cheng's Table 4 with another tip."""
    return replace(table_4(), tips_mm=np.array([[x_mm, y_mm, z_mm]]))


def _short(true: TrueArm) -> TrueArm:
    """Joints that turn by little more than 60° in all."""
    return replace(true, travel_rad=np.array([-0.3, 0.8]))


def _affected(blocks: str, orders: tuple[int, ...] = (1, 2)) -> TrueArm:
    """Table 4 with effects as large as those of real arms, and each joint's as Ulna has them."""
    true = affected(table_4(), np.random.default_rng(4), blocks, orders)
    return TrueArm(
        true,
        true.chain,
        tuple(_effects(true, joint) for joint in range(true.joints)),
        gravity=true.gravity,
        warm=true.expansion_per_k is not None,
        approached=true.backlash_rad is not None,
    )


def _effects(true: Affected, joint: int) -> ulna.Effects:
    def own(array: Array | None) -> float | None:
        return None if array is None else float(array[joint])

    cs = () if true.harmonics_rad is None else true.harmonics_rad[joint].tolist()
    x_mm, y_mm, z_mm = (0.0, 0.0, 0.0) if true.centres_mm is None else true.centres_mm[joint].tolist()
    return ulna.Effects(
        harmonics_rad={order: (c, s) for order, (c, s) in zip(true.orders, cs, strict=True)},
        backlash_rad=own(true.backlash_rad),
        expansion_per_k=own(true.expansion_per_k),
        compliance_rad_per_nm=own(true.compliance_rad_per_nm),
        mass_kg=own(true.masses_kg) or 0.0,
        centre_mm=(x_mm, y_mm, z_mm),
    )


def _coupled() -> TrueArm:
    ratios = np.zeros((7, 7))
    ratios[2, 1], ratios[4, 3] = 0.012, -0.007
    effects = [ulna.Effects() for _ in range(7)]
    effects[2] = ulna.Effects(coupled_to=(2,), coupling=(0.012,))
    effects[4] = ulna.Effects(coupled_to=(4,), coupling=(-0.007,))
    return TrueArm(Coupled(table_4(), ratios), table_4(), tuple(effects))


def _standing() -> TrueArm:
    first = ulna.Effects(base_tilt_rad=(0.004, -0.003), base_offset_mm=(1.3, -0.8))
    true = Standing(table_4(), (0.004, -0.003), (1.3, -0.8))
    return TrueArm(true, table_4(), (first, *(ulna.Effects(),) * 6))


ARMS: dict[str, Callable[[], TrueArm]] = {
    "seven": lambda: _rigid(table_4()),
    "straight": lambda: _rigid(_with_tip(0.0, 0.0, 238.5596)),
    "0.7 mm off": lambda: _rigid(_with_tip(0.5, -0.5, 238.5596)),
    "0.3 mm off": lambda: _rigid(_with_tip(0.2, -0.224, 238.5596)),
    "0.1 mm off": lambda: _rigid(table_4(straight=True)),
    "six": lambda: _rigid(six_axes()),
    "parallel": lambda: _rigid(parallel_axes()),
    "short travel": lambda: _short(_rigid(table_4())),
    "harmonics 1": lambda: _affected("harmonics", (1,)),
    "harmonics 1-2": lambda: _affected("harmonics"),
    "harmonics 1-4": lambda: _affected("harmonics", tuple(range(1, 5))),
    "harmonics 1-10": lambda: _affected("harmonics", tuple(range(1, 11))),
    "short travel harmonics 1-4": lambda: _short(_affected("harmonics", tuple(range(1, 5)))),
    "backlash": lambda: _affected("backlash"),
    "expansion": lambda: _affected("expansion"),
    "compliance": lambda: _affected("compliance"),
    "coupling": _coupled,
    "base": _standing,
}
"""By the names that cases use."""
