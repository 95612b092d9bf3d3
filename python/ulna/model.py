"""The arm in memory: joints, probes and what is known of their uncertainty. Units are mm and rad, always.

Conventions (Denavit–Hartenberg, upper-joint form): ``turn_i = sign_i * q_i - theta0_i`` and
``T_i = Rz(turn_i) · Tz(d_i) · Tx(a_i) · Rx(alpha_i)``; a Hayati joint has ``Rz · Tx · Rx · Ry(beta_i)`` and no ``d``.
The last joint carries the probe and has no geometry of its own, unless the arm is stated with a full last link.
What an arm does beyond its geometry is in `ulna.effects`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ulna import effects
from ulna.effects import NONE, REFERENCE_C, Effects
from ulna.errors import UlnaInputError, nearest

if TYPE_CHECKING:
    from ulna import _core

JointModel = Literal["dh", "hayati"]


@dataclass(frozen=True)
class Joint:
    """One rotary joint and the link after it. The last joint has no link, unless the arm has a full last link."""

    theta0_rad: float = 0.0
    """Zero offset: ``turn = sign * encoder - theta0``."""
    alpha_rad: float = 0.0
    """Twist from this axis to the next, about the link."""
    a_mm: float = 0.0
    """Link length, along the common normal of this axis and the next."""
    d_mm: float = 0.0
    """Link offset along this axis; 0 for a Hayati joint."""
    beta_rad: float = 0.0
    """Hayati joints only: tilt of the next axis about y; 0 for a DH joint."""
    sign: int = 1
    """+1 where the encoder counts up with the turn (right-handed about the axis), else -1; 0: not known, find it."""
    model: JointModel = "dh"
    """"hayati" for an axis (nearly) parallel to the next, where ``d`` has no meaning."""
    name: str | None = None
    """What people call it; only for messages."""
    limits_rad: tuple[float, float] | None = None
    """Lowest and highest encoder angle; readings outside are warned about."""
    counts_per_turn: float | None = None
    """Encoder counts in one full turn; needed for readings in counts."""
    effects: Effects = NONE
    """What the joint does beyond its geometry."""


@dataclass(frozen=True)
class Probe:
    """The centre of a probe's ball, in the frame that turns with the last joint."""

    x_mm: float
    y_mm: float
    z_mm: float
    ball_mm: float | None = None
    """Diameter of the ball."""

    @property
    def tip_mm(self) -> NDArray[np.float64]:
        """(3,) mm."""
        return np.array([self.x_mm, self.y_mm, self.z_mm])

    @property
    def cylindrical(self) -> tuple[float, float, float]:
        """``(theta0_rad, r_mm, h_mm)``: x = r cos theta0, y = -r sin theta0, z = h (Cheng 2011). r = 0: theta0 = 0."""
        return (
            math.atan2(-self.y_mm, self.x_mm) if self.x_mm or self.y_mm else 0.0,
            math.hypot(self.x_mm, self.y_mm),
            self.z_mm,
        )

    @classmethod
    def from_cylindrical(cls, theta0_rad: float, r_mm: float, h_mm: float, ball_mm: float | None = None) -> Probe:
        """From the literature's three numbers (Cheng 2011)."""
        return cls(r_mm * math.cos(theta0_rad), -r_mm * math.sin(theta0_rad), h_mm, ball_mm)


@dataclass(frozen=True)
class ParameterCovariance:
    """What a calibration says about its parameters."""

    names: list[str]
    """Parameters the matrix is of."""
    matrix: NDArray[np.float64]
    """(k, k), rad and mm."""
    lost: list[dict[str, Any]]
    """Directions that the data did not determine: ``{"combination": {name: weight}, "because", "remedy", …}``."""

    def over(self, names: Sequence[str]) -> NDArray[np.float64]:
        """(k, k) over these names, which contain its own; zero where it knows nothing: those parameters were held."""
        whole = np.zeros((len(names), len(names)))
        columns = [list(names).index(name) for name in self.names]
        whole[np.ix_(columns, columns)] = self.matrix
        return whole

    def of(self, names: Sequence[str]) -> ParameterCovariance:
        """That of some of the parameters alone."""
        kept = [k for k, name in enumerate(self.names) if name in names]
        lost = []
        for direction in self.lost:
            combination = {name: weight for name, weight in direction["combination"].items() if name in names}
            if combination:
                lost.append(direction | {"combination": combination})
        return ParameterCovariance([self.names[k] for k in kept], self.matrix[np.ix_(kept, kept)], lost)


@dataclass(frozen=True)
class Arm:
    """An articulated arm: joints from the base to the probe, and the probes it can carry. Immutable."""

    name: str
    joints: tuple[Joint, ...]
    probes: dict[str, Probe]
    """In the order of the file; the order gives the probe's index."""
    uncertainty: ParameterCovariance | None = field(default=None, compare=False)
    """Known where the arm was loaded from a result."""
    full_last_link: bool = False
    """The last joint has a link too, and the probes stand at its end: four parameters more than needed, as in some
    models of the literature (Gao 2009; Santolaria and Aguilar 2010)."""
    gravity: tuple[float, float, float] = (0.0, 0.0, -1.0)
    """Where gravity pulls, in the base frame; its length does not matter. For joints that give way."""

    @classmethod
    def load(cls, path: str | Path) -> Arm:
        """Read an arm file (`ulna-arm/1`, TOML) or the arm of a result (`result.json`). Raises UlnaInputError."""
        from ulna.files.arm import load_arm  # the door to the files stands here for the user; see docs

        return load_arm(Path(path))

    def save(self, path: str | Path, force: bool = False) -> None:
        """Write an arm file in mm and rad. Raises UlnaInputError where the file exists and `force` is not given."""
        from ulna.files.arm import save_arm

        save_arm(self, Path(path), force=force)

    @property
    def n(self) -> int:
        """Number of joints (encoders)."""
        return len(self.joints)

    def __getstate__(self) -> dict[str, Any]:
        """Without the compiled core, which is made again where it is needed: arms go to other processes."""
        return {name: value for name, value in self.__dict__.items() if name != "core"}

    @cached_property
    def core(self) -> _core.Arm:
        """The same arm in the compiled core."""
        from ulna import _core

        def of(name: str) -> NDArray[np.float64]:
            return np.array([getattr(joint, name) for joint in self.joints], dtype=np.float64)

        sign = of("sign")
        try:
            arm = _core.Arm(
                of("theta0_rad"),
                of("alpha_rad"),
                of("a_mm"),
                of("d_mm"),
                of("beta_rad"),
                np.where(sign == 0.0, 1.0, sign),
                np.array([joint.model == "hayati" for joint in self.joints]),
                list(self.probes),
                np.array([probe.tip_mm for probe in self.probes.values()]).reshape(-1, 3),
                self.full_last_link,
            )
            return arm.with_effects(effects.for_core(self._effects, self.gravity))
        except _core.UlnaError as error:
            raise UlnaInputError(f"arm '{self.name}': {error}") from None

    @property
    def parameter_names(self) -> list[str]:
        """``joint.1.theta0, joint.1.alpha, joint.1.a, joint.1.d`` (or ``.beta``) … ``probe.bent.x, .y, .z``, then
        those of the effects (`ulna.effects`)."""
        return self.core.parameter_names

    @property
    def parameter_units(self) -> list[str]:
        """Of each of `parameter_names`: "rad", "mm", "1/K" or "rad/(N m)"."""
        return self.core.parameter_units

    @property
    def parameters(self) -> NDArray[np.float64]:
        """(P,) values in the order of `parameter_names`."""
        return self.core.parameters

    @property
    def signs(self) -> NDArray[np.float64]:
        """(n,) +1 or -1; +1 where not known."""
        return self.core.signs

    @property
    def unknown_signs(self) -> NDArray[np.bool_]:
        """(n,) true for joints of which nobody knows which way the encoder counts (sign 0)."""
        return np.array([joint.sign == 0 for joint in self.joints])

    @property
    def extras(self) -> list[effects.Extra]:
        """The blocks beyond geometry that the arm has."""
        return effects.extras_of(self._effects)

    def with_parameters(self, parameters: ArrayLike) -> Arm:
        """The same arm with other numbers, (P,) in the order of `parameter_names`, and no uncertainty."""
        x = np.asarray(parameters, dtype=np.float64)
        expected = len(self.parameter_names)
        if x.shape != (expected,):
            raise ValueError(f"parameters: expected shape ({expected},), got {x.shape}")
        linked = self.n if self.full_last_link else self.n - 1
        tips_at, effects_at = 4 * linked, 4 * linked + 3 * len(self.probes)
        links = x[:tips_at].reshape(-1, 4).tolist()
        tips = x[tips_at:effects_at].reshape(-1, 3).tolist()
        joints = [
            replace(
                joint,
                theta0_rad=theta0,
                alpha_rad=alpha,
                a_mm=a,
                d_mm=0.0 if joint.model == "hayati" else fourth,
                beta_rad=fourth if joint.model == "hayati" else 0.0,
            )
            for joint, (theta0, alpha, a, fourth) in zip(self.joints, links, strict=False)
        ]
        joints += self.joints[linked:]
        beyond = effects.from_core(self._effects, x[effects_at:])
        probes = {
            name: replace(probe, x_mm=tip_x, y_mm=tip_y, z_mm=tip_z)
            for (name, probe), (tip_x, tip_y, tip_z) in zip(self.probes.items(), tips, strict=True)
        }
        return replace(
            self,
            joints=tuple(replace(joint, effects=own) for joint, own in zip(joints, beyond, strict=True)),
            probes=probes,
            uncertainty=None,
        )

    def with_signs(self, signs: ArrayLike) -> Arm:
        """The same arm with other signs, (n,) each +1 or -1. Its uncertainty is not carried over."""
        joints = [
            replace(joint, sign=int(sign)) for joint, sign in zip(self.joints, np.asarray(signs).tolist(), strict=True)
        ]
        return replace(self, joints=tuple(joints), uncertainty=None)

    def probe_index(self, name: str | None = None) -> int:
        """Index of a probe by name; None where there is just one. Raises UlnaInputError with the nearest known name."""
        names = list(self.probes)
        if name is None:
            if len(names) == 1:
                return 0
            raise UlnaInputError(f"arm '{self.name}' has {len(names)} probes: say which of {', '.join(names)} is on.")
        if name not in self.probes:
            raise UlnaInputError(f"arm '{self.name}' has no probe '{name}'.{nearest(name, names)}")
        return names.index(name)

    def tip(
        self, q_rad: ArrayLike, probe: str | None = None, temperature_c: ArrayLike | None = None
    ) -> NDArray[np.float64]:
        """Encoder angles (N, n) rad → tip positions (N, 3) mm in the base frame; (n,) → (3,).

        temperature_c: one number, (N,) or (N, n) per joint's link, °C. Raises UlnaInputError where the arm's links grow
        with it and it is not given.
        """
        q, single = self._angles(q_rad)
        p_mm = self.core.tip(q, self.probe_index(probe), self.warmth_k(temperature_c, len(q)))
        return p_mm[0] if single else p_mm

    def jacobian(
        self, q_rad: ArrayLike, probe: str | None = None, temperature_c: ArrayLike | None = None
    ) -> NDArray[np.float64]:
        """(N, n) rad → (N, 3, parameters): ∂p/∂parameter in mm for a unit of each; (n,) → (3, parameters).

        temperature_c as for `tip`.
        """
        q, single = self._angles(q_rad)
        jacobian = self.core.jacobian(q, self.probe_index(probe), self.warmth_k(temperature_c, len(q)))
        return jacobian[0] if single else jacobian

    def warmth_k(self, temperature_c: ArrayLike | None, count: int) -> NDArray[np.float64] | None:
        """(count,) or (count, n): how much warmer than 20 °C each of so many poses is; None where it does not matter.

        Raises UlnaInputError where the arm's links grow with the temperature and it is not given.
        """
        if "link-expansion" not in self.extras:
            return None
        if temperature_c is None or not np.isfinite(temperature_c).all():
            raise UlnaInputError(
                f"arm '{self.name}': its links grow with temperature, but the temperature is not given for every pose; "
                "expected °C. Give it (the column temperature, or temperature_c)."
            )
        warmth = np.asarray(temperature_c, dtype=np.float64) - REFERENCE_C
        if warmth.ndim == 0:
            return np.full(count, float(warmth))
        return np.ascontiguousarray(warmth.reshape(count, -1) if warmth.ndim == 2 else warmth)

    @property
    def _effects(self) -> list[Effects]:
        return [joint.effects for joint in self.joints]

    def _angles(self, q_rad: ArrayLike) -> tuple[NDArray[np.float64], bool]:
        q = np.ascontiguousarray(q_rad, dtype=np.float64)
        single = q.ndim == 1
        q = q[np.newaxis] if single else q
        if q.ndim != 2 or q.shape[1] != self.n:
            raise ValueError(f"q_rad: expected (N, {self.n}) encoder angles in rad, got {np.shape(q_rad)}")
        return q, single
