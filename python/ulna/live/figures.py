"""What poses of a calibrated arm come to: places, lengths, balls, circles, planes, each value ± U (k = 2), or why not.

As `ulna measure` and `ulna uncertainty` have it: GUM's law of propagation, by `ulna.uncertainties`. Lengths mm.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ulna.arm.arm import Arm
from ulna.arm.conditions import PAYLOAD, TEMPERATURE, Condition
from ulna.arm.file import result_file
from ulna.arm.given import ArmLike, StandsForArm, arm_and_noise
from ulna.arm.reading_noise import ReadingNoise
from ulna.ground.arrays import F64, I64
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import kept, worded
from ulna.uncertainties.assess import Value, assess, not_determined
from ulna.uncertainties.first_order import gradient_of
from ulna.uncertainties.knowledge import known_of_result
from ulna.uncertainties.measurands import MEASURANDS, Touched
from ulna.uncertainties.task import Task

P = math.erf(math.sqrt(2.0))
"""Coverage probability of ± 2 u of a normal distribution: k = 2, and Student's t where the calibration estimated the
noise from its own residuals."""
POINT, LENGTH = "point", "length"
WITHOUT = worded("no uncertainty is known of this arm: give the result of its calibration")


VAIN: dict[Condition, str] = {
    TEMPERATURE: worded("The temperature is not used: of this arm its links do not grow with temperature."),
    PAYLOAD: worded("The payload is not used: of this arm its joints do not give way to what they carry."),
}
"""What is said where a condition is given on which the tip does not depend."""


@dataclass(frozen=True)
class Figure:
    """One value."""

    name: str
    unit: str
    """"mm" or "1"."""
    value: float | None
    """None where it is not determined."""
    u: float | None
    """Standard uncertainty; None where none is known."""
    k: float | None
    """U = k u."""
    why: str | None = None
    """Why it is not determined, and what would help."""

    @property
    def expanded(self) -> float | None:
        """U."""
        return None if self.u is None or self.k is None else self.k * self.u

    def as_dict(self) -> dict[str, Any]:
        """As JSON has it."""
        said = {"value": self.value, "unit": self.unit, "u": self.u, "expanded": self.expanded, "k": self.k}
        return said | ({} if self.why is None else {"not_determined": self.why})


class Calibrated:
    """An arm with one of its probes, here and now."""

    def __init__(
        self,
        given: ArmLike,
        probe: str | None = None,
        *,
        encoder_u_rad: float | None = None,
        temperature_c: float | None = None,
        payload: str | None = None,
        inside: bool = False,
    ) -> None:
        """encoder_u_rad: of each encoder, where it is known better than by the calibration. inside: balls are hollows,
        circles holes.
        Raises UlnaInputError for a probe that there is not, or a condition that nobody states."""
        self.arm, noise, self._stated_rad = _known(given)
        self.probe = list(self.arm.probes)[self.arm.probe_index(probe)]
        each = None if encoder_u_rad is None else np.full(self.arm.n, encoder_u_rad)
        self.noise: ReadingNoise = noise.stated(each)
        load = self.arm.loads_of(payload)
        _check_said(self.arm, {"temperature_c": temperature_c, "payload": payload})
        self._said: dict[str, Any] = {"temperature_c": temperature_c, "payload": load}
        self.conditions = self.arm.conditions(1, **self._said)
        self._inside = inside
        known = self.arm.uncertainty
        unknown = None if known is None else known.why_none
        self.without: str | None = WITHOUT if known is None else None
        """Why nothing has an uncertainty; None where it has."""
        if unknown is not None:
            why, remedy = unknown.because, unknown.remedy
            self.without = worded("no uncertainty is known of this arm: {why}. {remedy}", why=why, remedy=remedy)
        self.remarks = _remarks(self.arm, temperature_c, payload, self.without is None)
        """What is to be known of conditions that were said, in sentences."""

    @property
    def sample_rad(self) -> F64 | None:
        """(n,) noise of the encoders in one sample; None where nobody knows.

        A calibration whose readings scattered less than its study stated has means of many samples: of one sample what
        was stated counts.
        """
        known = self.noise.encoder_rad
        if known is None or self._stated_rad is None:
            return known
        found: F64 = np.maximum(known, self._stated_rad)
        return found

    @property
    def ball_mm(self) -> float | None:
        """Diameter of the probe's ball, where it is known."""
        return self.arm.probes[self.probe].ball_mm

    def tips_mm(self, q_rad: F64) -> F64:
        """(N, n) → (N, 3)"""
        return self.arm.tip(q_rad, self.probe, **self._said)

    def by_angle(self, q_rad: F64) -> F64:
        """(3, n) mm per rad: how the tip moves as encoders turn."""
        found: F64 = self.arm.core.encoder_jacobian(q_rad[None], self.arm.probe_index(self.probe), **self.conditions)[0]
        return found

    def point(self, q_rad: F64, name: str = POINT) -> list[Figure]:
        """x, y, z of one pose (n,); none of them where one depends on what was not determined, as `ulna measure` has
        it."""
        found = self.figures(POINT, [q_rad], name)
        lost = next((each for each in found if each.why is not None), None)
        if lost is None:
            return found
        return [Figure(each.name, each.unit, None, None, None, lost.why) for each in found]

    def figures(self, kind: str, q_rad: Sequence[F64], name: str) -> list[Figure]:
        """Of a measurand (`MEASURANDS`) touched in these poses, (n,) each, the first features' first; name: of it, for
        messages. Poses enough there must be."""
        measurand = MEASURANDS[kind]
        task = Task(
            touched=Touched(kind, _features(kind, len(q_rad))),
            q_rad=np.ascontiguousarray(q_rad, dtype=np.float64),
            probe=self.probe,
            label=name,
            noise=self.noise,
            inside=self._inside and measurand.diameter is not None,
            p=P,
            **self._said,
        )
        try:
            task.touched.check(name)
            # where they do not say it the message is of them, not of steps beside them
            task.touched.values(task.tips_mm(self.arm, task.q_rad)[None])
            if self.without is None:
                return [_figure(each) for each in assess(self.arm, task, most_trials=0).values]
            tips_mm = task.tips_mm(self.arm, task.q_rad)
            gradient_of(task, tips_mm)  # refuses touches that hardly say it
            values = task.values(self.arm, tips_mm[None])[0].tolist()
        except UlnaInputError as error:
            return [Figure(each, unit, None, None, None, kept(error)) for each, unit in measurand.units.items()]
        return [
            Figure(each, unit, value, None, None)
            for (each, unit), value in zip(measurand.units.items(), values, strict=True)
        ]


def _check_said(arm: Arm, said: dict[str, Any]) -> None:
    """Raises UlnaInputError where the tip depends on a condition that neither a stream nor anybody says."""
    for condition, effect in arm.needs.items():
        if said.get(condition.said) is None:
            remedy = f"Give it with {condition.option}." if condition.option else "Measure with `ulna measure`."
            raise UlnaInputError(
                f"arm '{arm.name}': its {effect.whose} {effect.does}, but {condition.missing}; a stream does not say "
                f"it. {remedy}"
            )


def _remarks(arm: Arm, temperature_c: float | None, payload: str | None, with_u: bool) -> list[str]:
    given = {TEMPERATURE: temperature_c, PAYLOAD: payload}
    found = [VAIN[condition] for condition, said in given.items() if said is not None and condition not in arm.needs]
    if TEMPERATURE in arm.needs and temperature_c is not None:
        if TEMPERATURE.doubtful(np.array([temperature_c])):
            found.append(
                worded(
                    "The temperature is {celsius}. Are they in °F? They are taken as °C; write them in °C.",
                    celsius=f"{temperature_c:g}",
                )
            )
        if with_u:
            found.append(
                worded(
                    "The arm counts as {celsius} °C warm; what that may be off is not in U.",
                    celsius=f"{temperature_c:g}",
                )
            )
    elif with_u:
        found.append(
            worded("How warm the arm is changes nothing: its model has no temperature, and U has nothing of it.")
        )
    return found


def _known(given: ArmLike) -> tuple[Arm, ReadingNoise, F64 | None]:
    """An arm, how its readings scatter, and what its study stated of its encoders."""
    of_file = isinstance(given, str | os.PathLike) and result_file(Path(given)).suffix.lower() == ".json"
    if of_file or isinstance(given, StandsForArm):
        found = known_of_result(given)  # type: ignore[arg-type]  # a result, by what it is
        stated = (found.made.get("noise") or {}).get("encoder_rad")
        each = None if stated is None else np.broadcast_to(np.asarray(stated, dtype=np.float64), (found.arm.n,))
        return found.arm, found.noise, each
    return *arm_and_noise(given), None


def _features(kind: str, count: int) -> I64:
    """(count,) which of the measurand's features each pose is at: all at the only one; of two the last alone is at the
    second (a length's end, a point beside its plane)."""
    found = np.zeros(count, dtype=np.int64)
    found[count - len(MEASURANDS[kind].features) + 1 :] = len(MEASURANDS[kind].features) - 1
    return found


def _figure(value: Value) -> Figure:
    if value.not_determined:
        return Figure(value.name, value.unit, None, None, None, not_determined(value))
    return Figure(value.name, value.unit, value.value, value.u, value.k)
