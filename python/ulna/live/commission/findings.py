"""All that was found of an arm, in its own units and in rad."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.commission.counting import Known
from ulna.live.commission.holding import Held, Holding
from ulna.live.commission.turning import Turned
from ulna.live.mapping import TURN
from ulna.live.still import WINDOWS_S

CARRIED = 0.5
"""Of a step: with so much noise the mean of whole steps is that of what they were rounded from, to a hundredth of a
step: the first harmonic of what rounding adds is exp(-2 π² σ²) / π steps, by the noise's characteristic function."""
FULL_TURN = 1.0
"""From so many turns on it is asked whether a joint turns on and on."""


@dataclass(frozen=True)
class FoundJoint:
    """A joint, from the base to the probe."""

    channel: str
    low: float
    high: float
    """Where it stops, as sent, turns counted."""
    sign: int
    """1 or -1; 0: nobody could say."""
    noise: float
    """Standard deviation of a reading held still, as sent; at least step/√12."""
    step: float | None
    """In which it comes, as sent."""
    drift: float
    """While it was held still, as sent."""
    counts_per_turn: float | None
    """Of counts: by its wraps, else as stated; None: nobody says it."""
    counts_why: str
    wraps: bool
    """Whether its travel goes over the place where it begins again."""
    endless: bool
    along: tuple[tuple[str, float], ...]
    """Channels that hang on it, and how much they turn with it."""
    at_posture: float | None = None
    """What it read in a posture taken by eye, as sent; None: there was none."""
    turned_rad: float = 0.0
    """How far the joint is turned in that posture, as drawn."""

    @property
    def zeroed(self) -> bool:
        """Whether its zero is known, by eye: from the posture and from which way it counts."""
        return self.at_posture is not None and self.sign != 0


def found_joint(turned: Turned, held: Mapping[str, Held], known: Known, sign: int, endless: bool) -> FoundJoint:
    """A joint from what was found of it."""
    assert turned.channel is not None
    still = held[turned.name]
    step = turned.step if still.step is None else min(still.step, turned.step or still.step)
    counts, why = known.counts(turned.channel)
    return FoundJoint(
        turned.name,
        turned.low,
        turned.high,
        sign,
        max(still.noise, (step or 0.0) / math.sqrt(12.0)),
        step,
        still.drift,
        counts,
        why,
        bool(turned.wraps),
        endless,
        tuple((each.name, each.ratio) for each in turned.along),
    )


@dataclass(frozen=True)
class Findings:
    """All of it."""

    joints: tuple[FoundJoint, ...]
    unit: str | None
    """deg, rad or counts."""
    unit_why: str
    guessed_counts: float | None
    """What encoders that never began again may count in a turn."""
    holding: Holding
    unused: tuple[str, ...]
    """Of each channel that is no joint a sentence why."""
    as_drawn: bool = False
    """Whether somebody says that the zeros of the encoders are those of the drawing."""

    @property
    def uncounted(self) -> list[int]:
        """Joints (from 0) of which nobody knows the counts per turn."""
        if self.unit in TURN:
            return []
        return [k for k, joint in enumerate(self.joints) if joint.counts_per_turn is None]

    def with_counts(self, counts: float | Sequence[float]) -> Findings:
        """With counts per turn of those joints that lack them: one number, or one for each joint of the arm."""
        each = list(counts) if isinstance(counts, Sequence) else [counts] * len(self.joints)
        joints = list(self.joints)
        for k in self.uncounted:
            joints[k] = replace(joints[k], counts_per_turn=each[k], counts_why=worded("as it was stated"))
        return replace(self, joints=tuple(joints))

    def check(self) -> None:
        """Whether all is known that files need. Raises UlnaInputError."""
        if self.unit is None:
            raise UlnaInputError(
                worded("the unit of the channels is not known ({why}) Say it with --unit.", why=self.unit_why)
            )
        if self.uncounted:
            which = ", ".join(str(k + 1) for k in self.uncounted)
            guessed = self.guessed_counts
            perhaps = worded(" (perhaps {counts})", counts=f"{guessed:.0f}") if guessed else ""
            raise UlnaInputError(
                worded(
                    "joint {joints}: counts per turn are not known{perhaps}: the encoder never began again. Nothing "
                    "was written. Say them with --counts-per-turn.",
                    joints=which,
                    perhaps=perhaps,
                )
            )

    def rad(self, joint: int, value: float) -> float:
        """A number of a joint's channel in rad."""
        turn = TURN.get(self.unit or "", self.joints[joint].counts_per_turn or math.nan)
        return value * 2.0 * math.pi / turn

    def noise_rad(self, joint: int) -> float:
        """Standard deviation of an encoder."""
        return self.rad(joint, self.joints[joint].noise)

    def touch_noise_rad(self, joint: int) -> float:
        """Standard deviation of an encoder's mean over the shortest rest that is a touch. Steps that the noise does not
        carry over to the next do not average out."""
        found = self.joints[joint]
        step = found.step or 0.0
        count = max(1.0, WINDOWS_S[0] * self.holding.readings / self.holding.seconds)
        mean = found.noise / math.sqrt(count) if found.noise >= CARRIED * step else found.noise
        return self.rad(joint, mean)

    def limits_rad(self, joint: int) -> tuple[float, float]:
        """The lowest and highest angle of an encoder."""
        found = self.joints[joint]
        return round(self.rad(joint, found.low), 6), round(self.rad(joint, found.high), 6)

    def theta0_rad(self, joint: int) -> float | None:
        """Its zero offset (`turn = sign * encoder - theta0`), in ±π; None where it is not known."""
        found = self.joints[joint]
        if not found.zeroed:
            return None
        assert found.at_posture is not None
        return math.remainder(found.sign * self.rad(joint, found.at_posture) - found.turned_rad, 2.0 * math.pi)

    @property
    def zeroed(self) -> bool:
        """Whether all zeros are known, by eye."""
        return all(joint.zeroed for joint in self.joints)

    @property
    def zeros(self) -> str:
        """What is known of the zeros, in words."""
        if self.as_drawn:
            return worded("Zero offsets (theta0) are those of the drawing, as was said")
        if self.zeroed:
            return worded("Zero offsets (theta0) are by eye, to some degrees: a calibration finds the rest")
        return worded("Zero offsets (theta0) are not known: a calibration has to search for them")

    @property
    def remarks(self) -> list[str]:
        """What whoever uses the arm must know, a sentence each."""
        lines = list(self.unused)
        for k, joint in enumerate(self.joints, start=1):
            lines += [
                f"{name} turns by {ratio:.3g} of a turn with joint {k}: a coupling, which a calibration can fit "
                "([fit] extras)."
                for name, ratio in joint.along
            ]
        over = [
            str(k)
            for k, joint in enumerate(self.joints, start=1)
            if joint.wraps and not joint.endless and np.ptp(self.limits_rad(k - 1)) >= 2.0 * math.pi
        ]
        if over:
            lines.append(
                f"Joint {', '.join(over)} turns by more than its encoder tells apart: let a stream begin with it near "
                "its middle, or its angles are a turn off (the postures are the same)."
            )
        unsaid = [str(k) for k, joint in enumerate(self.joints, start=1) if not joint.sign]
        if unsaid:
            lines.append(f"sign = 0 of joint {', '.join(unsaid)}: nobody could say which way; a calibration finds it.")
        lines.append(f"{self.zeros}.")
        return lines
