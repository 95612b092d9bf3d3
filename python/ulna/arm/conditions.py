"""What was true at poses beside the angles of their encoders, as far as an arm's effects ask for it: one row each.

People say how warm it was in °C and from which side joints came by their signs; the core takes what stands in
`Conditions`. Which of them an arm asks for, its effects say (`ulna.arm.effects`).
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar, TypedDict

import numpy as np
from numpy.typing import ArrayLike

from ulna.ground.arrays import F64, I64, Bool

REFERENCE_C = 20.0
"""Lengths are those at this temperature (ISO 1), °C."""


class Conditions(TypedDict, total=False):
    """Of N poses, as the core takes them: `core.tip(q_rad, probe, **conditions)`. What is left out is not known to
    differ from the usual: 20 °C, and joints that came from anywhere."""

    warmth_k: F64
    """(N,) or (N, n): above 20 °C."""
    approach: F64
    """(N, n): +1 where the encoder's angle had been rising, -1 where it had been falling, 0 where nobody knows."""


NOTHING = Conditions()
"""Nothing unusual."""


def some_of(conditions: Conditions, rows: Bool | I64 | slice) -> Conditions:
    """Those of some of the poses."""
    found = Conditions()
    for condition in CONDITIONS:
        if condition.core in conditions:
            found[condition.core] = np.ascontiguousarray(conditions[condition.core][rows])  # type: ignore[literal-required]
    return found


class Condition(ABC):
    """One of them."""

    name: ClassVar[str]
    """Of the columns that say it; of several for each joint with the joint's number behind."""
    said: ClassVar[str]
    """Of the argument that gives it, and of the field of `Readings`."""
    fields: ClassVar[dict[str, str]]
    """Of `Readings`, by the names of the columns that fill them: of the first pose of a row, and of the second where it
    has its own."""
    core: ClassVar[str]
    """Its key of `Conditions`."""
    common: ClassVar[bool]
    """Whether one number may stand for all joints: a column `name`."""
    allowed: ClassVar[tuple[float, ...] | None] = None
    """Its values; None: any."""
    option: ClassVar[str | None] = None
    """By which a command is told one number for all readings."""
    missing: ClassVar[str]
    """What is said where it is not given."""
    unsaid: ClassVar[str]
    """What readings do that do not say it."""
    expected: ClassVar[str]
    """Of an argument, in words."""
    give: ClassVar[str]
    """How, in words."""
    columns: ClassVar[str]
    """Of a file, in words."""

    @abstractmethod
    def for_core(self, given: ArrayLike, count: int, joints: int) -> F64:
        """As in `Conditions`, of so many poses. Raises ValueError where it cannot be that of so many."""

    @abstractmethod
    def drawn(
        self, places: int, touches: int, joints: int, stated: tuple[float, float] | None, rng: np.random.Generator
    ) -> F64:
        """As said, of a simulation: a row for each place. stated: its mean and standard deviation, where the file gives
        them."""

    @abstractmethod
    def of_touches(self, drawn: F64, touches: int) -> F64:
        """(places × touches, …) of what was drawn."""

    def known(self, given: Any) -> bool:
        """Whether it is given of every pose."""
        return given is not None and bool(np.isfinite(given).all())


class Temperature(Condition):
    """How warm the links were."""

    name, said, core = "temperature", "temperature_c", "warmth_k"
    fields: ClassVar = {"temperature": "temperature_c"}
    common, option = True, "--temperature"
    missing = "the temperature is not given for every pose"
    unsaid = "do not all say how warm it was"
    expected = "°C"
    give = "the column temperature, or temperature_c"
    columns = "a column temperature, °C, or one for each joint"

    def for_core(self, given: ArrayLike, count: int, joints: int) -> F64:
        """One number, (N,) or (N, n), °C."""
        warmth = np.asarray(given, dtype=np.float64) - REFERENCE_C
        if warmth.ndim == 0:
            return np.full(count, float(warmth))
        return np.ascontiguousarray(warmth.reshape(count, -1) if warmth.ndim == 2 else warmth)

    def drawn(
        self, places: int, touches: int, joints: int, stated: tuple[float, float] | None, rng: np.random.Generator
    ) -> F64:
        """(places,) the same for all touches of a place."""
        if stated is None:
            return np.full(places, REFERENCE_C)
        return stated[0] + stated[1] * rng.standard_normal(places)

    def of_touches(self, drawn: F64, touches: int) -> F64:
        """(places × touches,)"""
        return np.repeat(drawn, touches)


class Approach(Condition):
    """From which side joints came."""

    name, said, core = "approach", "approach", "approach"
    fields: ClassVar = {"approach": "approach", "papproach": "p_approach"}
    allowed = (-1.0, 0.0, 1.0)
    common = False
    missing = "it is not given for every pose from which side each joint was approached"
    unsaid = "do not all say from which side each joint was approached"
    expected = "+1 (the encoder's angle had been rising), -1 (falling) or 0 (not known) for each joint"
    give = "the columns approach1, approach2, …, or approach"
    columns = "columns approach1, approach2, … with +1 (the encoder's angle had been rising), -1 (falling) or 0"

    def for_core(self, given: ArrayLike, count: int, joints: int) -> F64:
        """(n,) or (N, n) of +1, -1 and 0."""
        approach = np.broadcast_to(np.asarray(given, dtype=np.float64), (count, joints))
        return np.ascontiguousarray(approach)

    def drawn(
        self, places: int, touches: int, joints: int, stated: tuple[float, float] | None, rng: np.random.Generator
    ) -> F64:
        """(places, touches, n) either side as often."""
        return rng.choice([-1.0, 1.0], (places, touches, joints))

    def of_touches(self, drawn: F64, touches: int) -> F64:
        """(places × touches, n)"""
        return np.ascontiguousarray(drawn.reshape(-1, drawn.shape[-1]))


TEMPERATURE, APPROACH = Temperature(), Approach()

CONDITIONS: tuple[Condition, ...] = (TEMPERATURE, APPROACH)
