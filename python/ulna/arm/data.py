"""The arm in memory: joints, probes and what is known of their uncertainty. Units are mm and rad, always.

Conventions (Denavit–Hartenberg, upper-joint form): ``turn_i = sign_i * q_i - theta0_i`` and
``T_i = Rz(turn_i) · Tz(d_i) · Tx(a_i) · Rx(alpha_i)``; a Hayati joint has ``Rz · Tx · Rx · Ry(beta_i)`` and no ``d``.
The last joint carries the probe and has no geometry of its own, unless the arm is stated with a full last link.
What an arm does beyond its geometry is in `ulna.arm.effects.effects`.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ulna.arm.conditions import PAYLOAD, Condition, Conditions
from ulna.arm.covariance import ParameterCovariance
from ulna.arm.effects import effects
from ulna.arm.effects.effect import Effect
from ulna.arm.effects.effects import Effects
from ulna.arm.joint import Joint
from ulna.arm.payload import NOTHING_CARRIED, Payload
from ulna.arm.probe import Probe
from ulna.ground.arrays import F64, Bool
from ulna.ground.errors import UlnaInputError, nearest

if TYPE_CHECKING:
    import ulna._core as _core


Said = ArrayLike | None
"""What people say of poses beside their angles; None: nothing."""

Loads = str | Sequence[str] | ArrayLike | None
"""What they say of what was carried: a name or numbers, of all poses or of each."""


@dataclass(frozen=True)
class ArmData:
    """What an arm is, without its files: see `ulna.arm.arm.Arm`. Immutable."""

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
    payloads: dict[str, Payload] = field(default_factory=dict)
    """What it may carry beside its own masses, by name. For joints that give way."""

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
        import ulna._core as _core

        def of(name: str) -> F64:
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
            if self.slides.any():
                arm = arm.with_slides(np.array([_travel_mm(joint) for joint in self.joints]))
            return arm.with_effects(effects.for_core(self._effects, self.gravity, self.heaviest_kg))
        except _core.UlnaError as error:
            raise UlnaInputError(f"arm '{self.name}': {error}") from None

    @property
    def parameter_names(self) -> list[str]:
        """``joint.1.theta0, joint.1.alpha, joint.1.a, joint.1.d`` (or ``.beta``) … ``probe.bent.x, .y, .z``, then
        those of the effects (`ulna.arm.effects.effects`)."""
        return self.core.parameter_names

    @property
    def parameter_units(self) -> list[str]:
        """Of each of `parameter_names`: "rad", "mm", "1/K", "rad/(N m)" or "1"."""
        return self.core.parameter_units

    @property
    def parameters(self) -> F64:
        """(P,) values in the order of `parameter_names`."""
        return self.core.parameters

    @property
    def signs(self) -> F64:
        """(n,) +1 or -1; +1 where not known."""
        return self.core.signs

    @property
    def slides(self) -> Bool:
        """(n,) true for prismatic joints: what stands for their encoder's angle is mm."""
        return np.array([joint.slides for joint in self.joints])

    def each(self, rad: float, mm: float) -> F64:
        """(n,) a number for each encoder: one for those of joints that turn, another for those of joints that slide."""
        return np.where(self.slides, mm, rad)

    def check_turns(self, label: object, what: str) -> None:
        """All its joints turn, as `what` ("plans") need it. label: of the file. Raises UlnaInputError."""
        if self.slides.any():
            raise UlnaInputError(
                f"{label}: joint {int(np.argmax(self.slides)) + 1} of arm '{self.name}' is prismatic, which {what} do "
                "not cover; expected an arm whose joints all turn. Name another arm."
            )

    @property
    def unknown_signs(self) -> Bool:
        """(n,) true for joints of which nobody knows which way the encoder counts (sign 0)."""
        return np.array([joint.sign == 0 for joint in self.joints])

    @property
    def extras(self) -> list[effects.Extra]:
        """The blocks beyond geometry that the arm has."""
        return [effect.name for effect in self.effects]

    @property
    def effects(self) -> list[Effect]:
        """The same, as what knows all about them."""
        return effects.effects_of(self._effects)

    @property
    def uses(self) -> dict[Condition, Effect]:
        """On which conditions of a pose its tip depends, each with the effect that asks for it."""
        return effects.needs_of(self._effects)

    @property
    def needs(self) -> dict[Condition, Effect]:
        """Those of them of which nothing is usual: they must be said of every pose."""
        return {each: effect for each, effect in self.uses.items() if each.must_be_said(self.payloads)}

    @property
    def heaviest_kg(self) -> float:
        """Of what it may carry beside its own masses."""
        return max((payload.mass_kg for payload in self.payloads.values()), default=0.0)

    def load_named(self, name: str) -> F64:
        """(4,) kg and mm: what is carried, by name; "none": nothing. Raises UlnaInputError with the nearest known
        name."""
        if name == NOTHING_CARRIED:
            return np.zeros(4)
        if name not in self.payloads:
            known = [*self.payloads, NOTHING_CARRIED]
            raise UlnaInputError(f"arm '{self.name}' has no payload '{name}'.{nearest(name, known)}")
        return self.payloads[name].numbers

    def loads_of(self, given: Any) -> F64 | None:
        """(4,) or (N, 4) of a name, of a name for each pose, or of such numbers. Raises UlnaInputError for an unknown
        name."""
        if given is None:
            return None
        if isinstance(given, str):
            return self.load_named(given)
        each = np.asarray(given)
        if each.dtype.kind not in "OUT":
            return each.astype(np.float64)
        names, code = np.unique(each.astype(str), return_inverse=True)
        found: F64 = np.array([self.load_named(name) for name in names.tolist()]).reshape(-1, 4)[code]
        return found

    def with_parameters(self, parameters: ArrayLike) -> Self:
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
        values = dict(zip(self.parameter_names[effects_at:], x[effects_at:].tolist(), strict=True))
        beyond = effects.from_core(self._effects, values)
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

    def with_signs(self, signs: ArrayLike) -> Self:
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
        self,
        q_rad: ArrayLike,
        probe: str | None = None,
        temperature_c: Said = None,
        approach: Said = None,
        payload: Loads = None,
    ) -> F64:
        """Encoder angles (N, n) rad → tip positions (N, 3) mm in the base frame; (n,) → (3,).

        temperature_c: one number, (N,) or (N, n) per joint's link, °C. approach: (N, n) or (n,), +1 where the encoder's
        angle had been rising, -1 where it had been falling, 0 where nobody knows. payload: what was carried, the name
        of one of `payloads` or "none", of all poses or of each; or (4,) or (N, 4) numbers: mass, kg, and x, y, z of its
        centre, mm. Raises UlnaInputError where the tip depends on one of them (`needs`) and it is not given.
        """
        q, single = self._angles(q_rad)
        at = self.conditions(len(q), temperature_c, approach, payload)
        p_mm = self.core.tip(q, self.probe_index(probe), **at)
        return p_mm[0] if single else p_mm

    def jacobian(
        self,
        q_rad: ArrayLike,
        probe: str | None = None,
        temperature_c: Said = None,
        approach: Said = None,
        payload: Loads = None,
    ) -> F64:
        """(N, n) rad → (N, 3, parameters): ∂p/∂parameter in mm for a unit of each; (n,) → (3, parameters).

        temperature_c, approach and payload as for `tip`.
        """
        q, single = self._angles(q_rad)
        at = self.conditions(len(q), temperature_c, approach, payload)
        jacobian = self.core.jacobian(q, self.probe_index(probe), **at)
        return jacobian[0] if single else jacobian

    def conditions(
        self, count: int, temperature_c: Said = None, approach: Said = None, payload: Loads = None
    ) -> Conditions:
        """Of so many poses, as the core takes them: those that the arm's tip depends on.

        Raises UlnaInputError where it depends on one that is not given for every pose.
        """
        # names of loads are asked for where something gives way to them
        loads = self.loads_of(payload) if PAYLOAD in self.uses else None
        said = {"temperature_c": temperature_c, "approach": approach, "payload": loads}
        found, needs = Conditions(), self.needs
        for condition, effect in self.uses.items():
            given = said[condition.said]
            if given is None and condition not in needs:
                continue
            if given is None or not condition.known(given):
                raise UlnaInputError(
                    f"arm '{self.name}': its {effect.whose} {effect.does}, but {condition.missing}; expected "
                    f"{condition.expected}. Give it ({condition.give})."
                )
            values = np.asarray(given, dtype=np.float64)
            if condition.strange(values).any():
                worst = values[condition.strange(values)].flat[0]
                raise UlnaInputError(
                    f"arm '{self.name}': {condition.name}: got {worst:g}; expected {condition.expected}. "
                    f"{condition.remedy}"
                )
            found[condition.core] = condition.for_core(given, count, self.n)  # type: ignore[literal-required]
        return found

    def check_covered(self, label: str, what: str, stated: Collection[Condition] = ()) -> None:
        """Whether `what` ("plans") covers all conditions that the tip depends on: it states some of them. label: of
        the file. Raises UlnaInputError."""
        for condition, effect in self.needs.items():
            if condition not in stated:
                raise UlnaInputError(
                    f"{label}: the {effect.whose} of arm '{self.name}' {effect.does}, which {what} do not cover. "
                    f"Remove {' and '.join(effect.table.model_fields)} from the arm file."
                )

    @property
    def _effects(self) -> list[Effects]:
        return [joint.effects for joint in self.joints]

    def _angles(self, q_rad: ArrayLike) -> tuple[F64, bool]:
        q = np.ascontiguousarray(q_rad, dtype=np.float64)
        single = q.ndim == 1
        q = q[np.newaxis] if single else q
        if q.ndim != 2 or q.shape[1] != self.n:
            raise ValueError(f"q_rad: expected (N, {self.n}) encoder angles in rad, got {np.shape(q_rad)}")
        return q, single


def _travel_mm(joint: Joint) -> float:
    """How far a prismatic joint slides from its encoder's zero at the most; NaN of one that turns."""
    low, high = joint.limits_rad or (math.nan, math.nan)
    return max(-low, high) if joint.slides else math.nan
