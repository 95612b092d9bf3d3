"""Section 7 of the model, as written: an arm with eccentric encoders, with play, and links and joints that give way."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .chain import COMPLEX_STEP, Array, Chain, _identity, _shift_along, _turn_about

G = 9.80665  # m/s², standard gravity

#: in the order of the parameters
BLOCKS = ("harmonics_rad", "backlash_rad", "expansion_per_k", "compliance_rad_per_nm")


@dataclass(frozen=True)
class Affected:
    """A chain and its effects; readings are (N, n) angles, or (N, 2 n): angles, then kelvins above 20 °C per link, or
    (N, 3 n): behind them from which side each joint was approached, -1, 0 or +1."""

    chain: Chain
    orders: tuple[int, ...] = ()
    harmonics_rad: Array | None = None  # (n, orders, 2): c, s
    backlash_rad: Array | None = None  # (n,)
    expansion_per_k: Array | None = None  # (n,)
    compliance_rad_per_nm: Array | None = None  # (n,)
    masses_kg: Array | None = None  # (n,)
    centres_mm: Array | None = None  # (n, 3)
    gravity: tuple[float, float, float] = (0.0, 0.0, -1.0)

    @property
    def joints(self) -> int:
        return self.chain.joints

    @property
    def probes(self) -> int:
        return self.chain.probes

    @property
    def sign(self) -> tuple[int, ...]:
        return self.chain.sign

    @property
    def blocks(self) -> list[Array]:
        given = [getattr(self, name) for name in BLOCKS]
        return [np.asarray(block) for block in given if block is not None]

    @property
    def parameters(self) -> Array:
        return np.concatenate([self.chain.parameters, *(block.ravel() for block in self.blocks)])

    @property
    def angular(self) -> NDArray[np.bool_]:
        return np.concatenate([self.chain.angular, np.ones(sum(block.size for block in self.blocks), bool)])

    def with_parameters(self, parameters: NDArray) -> "Affected":
        at = len(self.chain.parameters)
        changed = {}
        for name in BLOCKS:
            block = getattr(self, name)
            if block is not None:
                changed[name] = parameters[at : at + block.size].reshape(block.shape)
                at += block.size
        return replace(self, chain=self.chain.with_parameters(parameters[: len(self.chain.parameters)]), **changed)

    def tip(self, readings: NDArray, probe: int | NDArray = 0) -> NDArray:
        readings = np.atleast_2d(readings)
        n, count = self.joints, len(readings)
        told = np.hstack([readings, np.zeros((count, 3 * n - readings.shape[1]))])
        q, warmth, approach = np.split(told, 3, axis=1)
        turns = self.rigid_turns(q)
        if self.compliance_rad_per_nm is not None:
            turns = turns + self.compliance_rad_per_nm * self.moments_nm(turns)
        if self.harmonics_rad is not None:
            for k, order in enumerate(self.orders):
                c, s = self.harmonics_rad[:, k, 0], self.harmonics_rad[:, k, 1]
                turns = turns + np.array(self.sign) * (c * np.cos(order * q) + s * np.sin(order * q))
        if self.backlash_rad is not None:
            turns = turns + np.array(self.sign) * self.backlash_rad / 2 * approach
        grown = 1.0 + (0.0 if self.expansion_per_k is None else self.expansion_per_k * warmth) + np.zeros((count, n))
        frame = self._frames(turns, grown)[-1]
        tips = np.asarray(self.chain.tips_mm)[np.broadcast_to(probe, (count,))] * grown[:, -1:]
        return np.einsum("nij,nj->ni", frame[:, :3, :3], tips) + frame[:, :3, 3]

    def rigid_turns(self, q_rad: NDArray) -> NDArray:
        """(N, n), rad: of an arm without effects."""
        return np.array(self.sign) * q_rad - np.append(self.chain.theta0_rad, 0.0)

    def centres_in_base_mm(self, turns: NDArray) -> NDArray:
        """(N, n, 3): where the links have their masses."""
        frames = self._frames(turns, np.ones(turns.shape))[1:]
        return np.stack([f[:, :3, :3] @ c + f[:, :3, 3] for f, c in zip(frames, self.centres_mm, strict=True)], axis=1)

    def energy_nm(self, turns: NDArray) -> NDArray:
        """(N,) potential energy, N m."""
        down = np.array(self.gravity) / np.linalg.norm(self.gravity)
        return -1e-3 * G * np.einsum("k,nkj,j->n", self.masses_kg, self.centres_in_base_mm(turns), down)

    def moments_nm(self, turns: NDArray) -> NDArray:
        """(N, n): gravity's moment about each axis: what is outboard times its arm."""
        frames, centres = self._frames(turns, np.ones(turns.shape)), self.centres_in_base_mm(turns)
        pull = G * np.array(self.gravity) / np.linalg.norm(self.gravity)
        moments = []
        for i in range(self.joints):
            arms = centres[:, i:] - frames[i][:, None, :3, 3]
            total = 1e-3 * np.einsum("k,nkj->nj", self.masses_kg[i:], np.cross(arms, pull))
            moments.append(np.einsum("nj,nj->n", frames[i][:, :3, 2], total))
        return np.stack(moments, axis=1)

    def _frames(self, turns: NDArray, grown: NDArray) -> list[NDArray]:
        """(N, 4, 4) before each joint, and last the frame that turns with the last joint."""
        arm = self.chain
        frames = [_identity(len(turns), np.result_type(turns, grown, arm.theta0_rad, arm.a_mm))]
        for i in range(arm.joints - 1):
            frame = frames[-1] @ _turn_about(2, turns[:, i])
            if not arm.hayati[i]:
                frame = frame @ _shift_along(2, arm.last[i] * grown[:, i])
            frame = frame @ _shift_along(0, arm.a_mm[i] * grown[:, i]) @ _turn_about(0, arm.alpha_rad[i])
            if arm.hayati[i]:
                frame = frame @ _turn_about(1, arm.last[i])
            frames.append(frame)
        return [*frames, frames[-1] @ _turn_about(2, turns[:, -1])]

    def jacobian(self, readings: Array, probe: int | NDArray = 0) -> Array:
        """(N, 3, parameters), by complex steps."""
        columns = []
        for k in range(len(self.parameters)):
            moved = self.parameters.astype(complex)
            moved[k] += 1j * COMPLEX_STEP
            columns.append(self.with_parameters(moved).tip(readings.astype(complex), probe).imag / COMPLEX_STEP)
        return np.stack(columns, axis=2)

    def encoder_jacobian(self, readings: Array, probe: int | NDArray = 0) -> Array:
        """(N, 3, n), by complex steps, mm/rad."""
        columns = []
        for i in range(self.joints):
            moved = np.atleast_2d(readings).astype(complex)
            moved[:, i] += 1j * COMPLEX_STEP
            columns.append(self.tip(moved, probe).imag / COMPLEX_STEP)
        return np.stack(columns, axis=2)


def affected(
    arm: Chain,
    rng: np.random.Generator,
    blocks: str = "harmonics backlash expansion compliance",
    orders: tuple[int, ...] = (1, 2),
) -> Affected:
    """The arm with some of the effects, as large as those of real arms and robots; heavier towards the base."""
    n = arm.joints
    extra: dict = {}
    if "harmonics" in blocks:
        extra |= {"orders": orders, "harmonics_rad": 1e-4 * rng.standard_normal((n, len(orders), 2))}
    if "backlash" in blocks:
        extra |= {"backlash_rad": rng.uniform(2e-5, 2e-4, n)}
    if "expansion" in blocks:
        extra |= {"expansion_per_k": rng.uniform(1e-6, 25e-6, n)}
    if "compliance" in blocks:
        extra |= {
            "compliance_rad_per_nm": rng.uniform(1e-6, 2e-5, n),
            "masses_kg": np.linspace(4.0, 0.5, n),
            "centres_mm": rng.uniform(-120, 120, (n, 3)),
            "gravity": (0.1, -0.2, -2.0),
        }
    return Affected(arm, **extra)
