"""The arm in memory: joints, probes and what is known of their uncertainty. Units are mm and rad, always.

Conventions (Denavit–Hartenberg, upper-joint form): ``turn_i = sign_i * q_i - theta0_i`` and
``T_i = Rz(turn_i) · Tz(d_i) · Tx(a_i) · Rx(alpha_i)``; a Hayati joint has ``Rz · Tx · Rx · Ry(beta_i)`` and no ``d``.
The last joint carries the probe and has no geometry of its own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ulna.errors import UlnaInputError, nearest

if TYPE_CHECKING:
    from ulna import _core

JointModel = Literal["dh", "hayati"]


@dataclass(frozen=True)
class Joint:
    """One rotary joint and the link after it. Of the last joint only sign, name, limits and counts matter."""

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
    """+1 where the encoder counts up with the turn (right-handed about the axis), else -1."""
    model: JointModel = "dh"
    """"hayati" for an axis (nearly) parallel to the next, where ``d`` has no meaning."""
    name: str | None = None
    """What people call it; only for messages."""
    limits_rad: tuple[float, float] | None = None
    """Lowest and highest encoder angle; readings outside are warned about."""
    counts_per_turn: float | None = None
    """Encoder counts in one full turn; needed for readings in counts."""


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


@dataclass(frozen=True)
class Arm:
    """An articulated arm: joints from the base to the probe, and the probes it can carry. Immutable."""

    name: str
    joints: tuple[Joint, ...]
    probes: dict[str, Probe]
    """In the order of the file; the order gives the probe's index."""
    uncertainty: ParameterCovariance | None = field(default=None, compare=False)
    """Known where the arm was loaded from a result."""

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

    @cached_property
    def core(self) -> _core.Arm:
        """The same arm in the compiled core."""
        from ulna import _core

        def of(name: str) -> NDArray[np.float64]:
            return np.array([getattr(joint, name) for joint in self.joints], dtype=np.float64)

        try:
            return _core.Arm(
                of("theta0_rad"),
                of("alpha_rad"),
                of("a_mm"),
                of("d_mm"),
                of("beta_rad"),
                of("sign"),
                np.array([joint.model == "hayati" for joint in self.joints]),
                list(self.probes),
                np.array([probe.tip_mm for probe in self.probes.values()]).reshape(-1, 3),
            )
        except _core.UlnaError as error:
            raise UlnaInputError(f"arm '{self.name}': {error}") from None

    @property
    def parameter_names(self) -> list[str]:
        """``joint.1.theta0, joint.1.alpha, joint.1.a, joint.1.d`` (or ``.beta``) … ``probe.bent.x, .y, .z``."""
        return self.core.parameter_names

    @property
    def parameter_units(self) -> list[str]:
        """Of each of `parameter_names`: "rad" or "mm"."""
        return self.core.parameter_units

    @property
    def parameters(self) -> NDArray[np.float64]:
        """(4(n-1) + 3P,) values in the order of `parameter_names`, rad and mm."""
        return self.core.parameters

    def with_parameters(self, parameters: ArrayLike) -> Arm:
        """The same arm with other numbers, (4(n-1) + 3P,) rad and mm. Its uncertainty is not carried over."""
        x = np.asarray(parameters, dtype=np.float64)
        expected = 4 * (self.n - 1) + 3 * len(self.probes)
        if x.shape != (expected,):
            raise ValueError(f"parameters: expected shape ({expected},), got {x.shape}")
        links = x[: 4 * (self.n - 1)].reshape(-1, 4).tolist()
        tips = x[4 * (self.n - 1) :].reshape(-1, 3).tolist()
        joints = [
            replace(
                joint,
                theta0_rad=theta0,
                alpha_rad=alpha,
                a_mm=a,
                d_mm=0.0 if joint.model == "hayati" else fourth,
                beta_rad=fourth if joint.model == "hayati" else 0.0,
            )
            for joint, (theta0, alpha, a, fourth) in zip(self.joints[:-1], links, strict=True)
        ]
        probes = {
            name: replace(probe, x_mm=tip_x, y_mm=tip_y, z_mm=tip_z)
            for (name, probe), (tip_x, tip_y, tip_z) in zip(self.probes.items(), tips, strict=True)
        }
        return Arm(self.name, (*joints, self.joints[-1]), probes)

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

    def tip(self, q_rad: ArrayLike, probe: str | None = None) -> NDArray[np.float64]:
        """Encoder angles (N, n) rad → tip positions (N, 3) mm in the base frame; (n,) → (3,)."""
        q, single = self._angles(q_rad)
        p_mm = self.core.tip(q, self.probe_index(probe))
        return p_mm[0] if single else p_mm

    def jacobian(self, q_rad: ArrayLike, probe: str | None = None) -> NDArray[np.float64]:
        """(N, n) rad → (N, 3, parameters): ∂p/∂parameter in mm/rad and mm/mm; (n,) → (3, parameters)."""
        q, single = self._angles(q_rad)
        jacobian = self.core.jacobian(q, self.probe_index(probe))
        return jacobian[0] if single else jacobian

    def _angles(self, q_rad: ArrayLike) -> tuple[NDArray[np.float64], bool]:
        q = np.ascontiguousarray(q_rad, dtype=np.float64)
        single = q.ndim == 1
        q = q[np.newaxis] if single else q
        if q.ndim != 2 or q.shape[1] != self.n:
            raise ValueError(f"q_rad: expected (N, {self.n}) encoder angles in rad, got {np.shape(q_rad)}")
        return q, single
