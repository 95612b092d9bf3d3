"""What was true at poses beside the angles of their encoders, as far as an arm's effects ask for it: one row each.

People say how warm it was in °C and from which side joints came by their signs; the core takes what stands in
`Conditions`. Which of them an arm asks for, its effects say (`ulna.arm.effects`).
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, ClassVar, TypedDict

import numpy as np
from numpy.typing import ArrayLike

from ulna.arm.payload import NOTHING_CARRIED, Payload, named_loads
from ulna.ground.arrays import F64, I64, Bool

REFERENCE_C = 20.0
"""Lengths are those at this temperature (ISO 1), °C."""


class Conditions(TypedDict, total=False):
    """Of N poses, as the core takes them: `core.tip(q_rad, probe, **conditions)`. What is left out is not known to
    differ from the usual: 20 °C, joints that came from anywhere, and no load."""

    warmth_k: F64
    """(N,) or (N, n): above 20 °C."""
    approach: F64
    """(N, n): +1 where the encoder's angle had been rising, -1 where it had been falling, 0 where nobody knows."""
    payload: F64
    """(N, 4): mass of what was carried, kg, and where its centre is in the probe's frame, mm."""


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
    of_joints: ClassVar[bool] = True
    """Whether each joint may have its own."""
    text: ClassVar[bool] = False
    """Whether its column holds names, no numbers."""
    allowed: ClassVar[tuple[float, ...] | None] = None
    """Its values; None: any."""
    within: ClassVar[tuple[float, float]] = (-math.inf, math.inf)
    """Least and most that it can be, in its unit."""
    usual: ClassVar[tuple[float, float]] = (-math.inf, math.inf)
    """Where all of many are beyond these, another unit is asked about, and they are taken as they stand."""
    doubt: ClassVar[str] = ""
    """What is asked then."""
    remedy: ClassVar[str] = "Correct it."
    """What is said where it cannot be so."""
    option: ClassVar[str | None] = None
    """By which a command is told one number for all readings."""
    vain: ClassVar[str] = ""
    """What is said where it is given for all, of an arm whose tip does not depend on it."""
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
    def drawn(self, places: int, touches: int, joints: int, stated: Any, rng: np.random.Generator) -> F64:
        """As said, of a simulation: a row for each place. stated: what the file says of it, such as mean and standard
        deviation; None: nothing."""

    @abstractmethod
    def of_touches(self, drawn: F64, touches: int) -> F64:
        """(places × touches, …) of what was drawn."""

    def must_be_said(self, payloads: Mapping[str, Payload]) -> bool:
        """Whether nothing is usual of it, of an arm that carries such loads and whose tip depends on it."""
        return True

    def written(self, said: F64, name: str, payloads: Mapping[str, Payload]) -> dict[str, Any]:
        """Columns of a file of readings; name: of the condition's columns."""
        numbers = said if self.allowed is None else said.astype(np.int64)
        return {name: numbers} if said.ndim == 1 else {f"{name}{k + 1}": own for k, own in enumerate(numbers.T)}

    def of_places(self, drawn: F64, payloads: Mapping[str, Payload]) -> list[Any] | None:
        """What an account of a simulation says of each place; None where it was another at each touch."""
        return list(drawn.tolist()) if drawn.ndim == 1 else None

    def strange(self, values: F64) -> Bool:
        """Which values cannot be in the unit that they should be in."""
        low, high = self.within
        found: Bool = (values < low) | (values > high)
        return found if self.allowed is None else found | ~np.isin(values, self.allowed)

    def doubtful(self, values: F64) -> bool:
        """Whether all of them are such as readings in another unit would be."""
        low, high = self.usual
        return bool(values.size) and bool((values > high).all() or (values < low).all())

    def known(self, given: Any) -> bool:
        """Whether it is given of every pose."""
        return given is not None and bool(np.isfinite(given).all())


class Temperature(Condition):
    """How warm the links were."""

    name, said, core = "temperature", "temperature_c", "warmth_k"
    fields: ClassVar = {"temperature": "temperature_c"}
    common, option = True, "--temperature"
    within = (-100.0, 200.0)  # encoders stand no more
    remedy = "Is it in kelvin? Write it in °C."
    usual = (-20.0, 50.0)  # of rooms in which people measure
    doubt = "Are they in °F? They are taken as °C; write them in °C."
    vain = "its links do not grow with temperature"
    missing = "the temperature is not given for every pose"
    unsaid = "do not all say how warm it was"
    expected = "°C, from -100 to 200"
    give = "the column temperature, or temperature_c"
    columns = "a column temperature, °C, or one for each joint"

    def for_core(self, given: ArrayLike, count: int, joints: int) -> F64:
        """One number, (N,) or (N, n), °C."""
        warmth = np.asarray(given, dtype=np.float64) - REFERENCE_C
        if warmth.ndim == 0:
            return np.full(count, float(warmth))
        return np.ascontiguousarray(warmth.reshape(count, -1) if warmth.ndim == 2 else warmth)

    def drawn(self, places: int, touches: int, joints: int, stated: Any, rng: np.random.Generator) -> F64:
        """(places,) the same for all touches of a place."""
        if stated is None:
            return np.full(places, REFERENCE_C)
        found: F64 = stated[0] + stated[1] * rng.standard_normal(places)
        return found

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

    def drawn(self, places: int, touches: int, joints: int, stated: Any, rng: np.random.Generator) -> F64:
        """(places, touches, n) either side as often."""
        return rng.choice([-1.0, 1.0], (places, touches, joints))

    def of_touches(self, drawn: F64, touches: int) -> F64:
        """(places × touches, n)"""
        return np.ascontiguousarray(drawn.reshape(-1, drawn.shape[-1]))


class Carried(Condition):
    """What the last joint carried beside the arm's own masses."""

    name, said, core = "payload", "payload", "payload"
    fields: ClassVar = {"payload": "payload"}
    common, of_joints, text, option = True, False, True, "--payload"
    vain = "its joints do not give way to what they carry"
    missing = "it is not given for every pose which load was carried"
    unsaid = "do not all say which load was carried"
    expected = f"the name of a [payload], or '{NOTHING_CARRIED}'"
    give = "the column payload, or payload"
    columns = f"a column payload with the name of a [payload] in each row, or '{NOTHING_CARRIED}'"

    def for_core(self, given: ArrayLike, count: int, joints: int) -> F64:
        """(4,) or (N, 4): kg and mm."""
        return np.array(np.broadcast_to(np.asarray(given, dtype=np.float64), (count, 4)))

    def drawn(self, places: int, touches: int, joints: int, stated: Any, rng: np.random.Generator) -> F64:
        """(places, 4) one of the stated (K, 4) loads, the same for all touches of a place."""
        if stated is None:
            return np.zeros((places, 4))
        found: F64 = np.asarray(stated)[rng.integers(len(stated), size=places)]
        return found

    def of_touches(self, drawn: F64, touches: int) -> F64:
        """(places × touches, 4)"""
        return np.repeat(drawn, touches, axis=0)

    def strange(self, values: F64) -> Bool:
        """A mass below nothing."""
        found = np.zeros(values.shape, dtype=bool)
        found[..., 0] = values[..., 0] < 0.0
        return found

    def must_be_said(self, payloads: Mapping[str, Payload]) -> bool:
        """Of an arm that has loads; one without carries nothing."""
        return bool(payloads)

    def written(self, said: F64, name: str, payloads: Mapping[str, Payload]) -> dict[str, Any]:
        """Its name."""
        return {name: named_loads(said, payloads)}

    def of_places(self, drawn: F64, payloads: Mapping[str, Payload]) -> list[Any] | None:
        """Their names."""
        return named_loads(drawn, payloads)


TEMPERATURE, APPROACH, PAYLOAD = Temperature(), Approach(), Carried()

CONDITIONS: tuple[Condition, ...] = (TEMPERATURE, APPROACH, PAYLOAD)
