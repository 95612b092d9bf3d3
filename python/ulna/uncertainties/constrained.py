"""Constrained Monte Carlo: arms that would have passed the same performance test with the same figures.

After Phillips et al. ("The calculation of CMM measurement uncertainty via the method of simulation by constraints",
ASPE 1997), who did it for coordinate measuring machines: errors are drawn, the performance test is simulated, and what
disagrees with the known figures is thrown away. What is left is what may be wrong with an arm of which nothing else is
known. In statistics: approximate Bayesian computation by rejection; the spread before is the prior.
"""

from __future__ import annotations

from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import partial

import numpy as np

from ulna.arm.arm import Arm
from ulna.ground.arrays import F64, Progress
from ulna.ground.errors import UlnaInputError, nearest
from ulna.simulation.mover import Mover
from ulna.uncertainties.performance import Figure, Performance
from ulna.uncertainties.simulated_tests import SetUp, set_up
from ulna.work.pieces import Threads, Workers

BLOCK = 1000
"""Arms drawn together: block k draws from (seed, 61, k) and is tested in set-up k modulo SET_UPS."""
SET_UPS = 16
"""A certificate does not say where the artefact stood."""
ROUND = 20
"""Blocks before it is asked again whether they are enough."""
BARREN = 300
"""Blocks before it is said that hardly an arm agrees."""
FEWEST = 3
"""Arms that agree among those: with fewer it would take hours."""
FRAME = ("joint.1.theta0", "joint.1.d")
"""What only moves the base frame shows in no test."""


@dataclass(frozen=True)
class Shares:
    """What became of the arms that were drawn."""

    drawn: int
    kept: int


class Constrained:
    """Arms that agree, as many as are asked for."""

    def __init__(
        self,
        arm: Arm,
        performance: Performance,
        travel_rad: F64,
        seed: int = 0,
        workers: Workers | None = None,
        progress: Progress | None = None,
    ) -> None:
        """Raises UlnaInputError for patterns that hold nothing or all, and for tests or arms that cannot be."""
        arm.check_covered(performance.label, "performance files")
        arm.check_turns(performance.label, "performance files")
        self.performance = performance
        self._workers = workers or Threads()
        self._told = progress if progress is not None else lambda *_: None
        self._spread = _spread(arm, performance)
        mover, rng = Mover(arm, travel_rad), np.random.default_rng([seed, 60])
        self._set_ups = [set_up(arm, performance, mover, rng) for _ in range(SET_UPS)]
        self._mean, self._seed = arm.parameters, seed
        self._kept: list[F64] = []
        self._count = self._blocks = 0

    @property
    def shares(self) -> Shares:
        """So far."""
        return Shares(self._blocks * BLOCK, self._count)

    @property
    def assumed(self) -> list[str]:
        """What no figure of the certificate says, in words."""
        return [
            "how such arms differ from their drawing before the certificate is looked at, in proportion: assumed, in "
            f"{self.performance.label}",
            "where the certificate's artefacts stood, and in which postures they were touched: drawn",
        ]

    def sets(self, first: int, count: int) -> F64:
        """(count, P) parameters of the arms first … first + count - 1 that agree, in the order of their drawing.

        Raises UlnaInputError where none does; KeyboardInterrupt.
        """
        while self._count < first + count:
            self._told("arms that agree", self._count, first + count)
            wanted = range(self._blocks, self._blocks + ROUND)
            pieces = [(number, self._set_ups[number % SET_UPS]) for number in wanted]
            found: dict[int, F64] = dict(
                self._workers.each(partial(_block, self.performance, self._spread, self._seed), pieces)
            )
            for place in range(len(pieces)):
                self._kept.append(found[place])
                self._count += len(found[place])
            self._blocks += ROUND
            if self._count < FEWEST and self._blocks >= BARREN:
                raise self._hardly_any()
        self._told("arms that agree", first + count, first + count)
        self._kept = [np.concatenate(self._kept)]
        return self._mean + self._kept[0][first : first + count]

    def _hardly_any(self) -> UlnaInputError:
        figures, _ = _tested(
            self.performance, self._spread, np.random.default_rng([self._seed, 61, 0]), self._set_ups[0]
        )
        ranges = [
            f"{name} of test {number} (certificate: {test.figures_mm[name]:.3g} mm) came out as "
            f"{values.min():.3g} to {values.max():.3g} mm"
            for number, (test, found) in enumerate(zip(self.performance.tests, figures, strict=True), 1)
            for name, values in found.items()
            if name in test.figures_mm
        ]
        few = "none agrees" if self._count == 0 else f"only {self._count} agree{'s' * (self._count == 1)}"
        return UlnaInputError(
            f"{self.performance.label}: of {self._blocks * BLOCK} arms drawn {few} with all figures: "
            f"{'; '.join(ranges)}. Look whether the noise alone is more than the certificate allows, whether figures "
            "and units are right, or widen 'within' or spread.factor."
        )


def _spread(arm: Arm, performance: Performance) -> F64:
    """(P,) standard deviations before, at factor 1."""
    names = arm.parameter_names
    for pattern in performance.hold:
        if not any(fnmatchcase(name, pattern) for name in names):
            raise UlnaInputError(
                f"{performance.label}: key 'spread.hold': '{pattern}' is no parameter of arm '{arm.name}'."
                f"{nearest(pattern, names)}"
            )
    held = [name in FRAME or any(fnmatchcase(name, pattern) for pattern in performance.hold) for name in names]
    of_unit = {"rad": performance.spread_rad, "mm": performance.spread_mm}
    other = [f"probe.{name}." for name in arm.probes if name != performance.probe]
    held = [own or any(name.startswith(start) for start in other) for own, name in zip(held, names, strict=True)]
    spread = np.array(
        [0.0 if own else of_unit.get(unit, 0.0) for own, unit in zip(held, arm.parameter_units, strict=True)]
    )
    if not spread.any():
        raise UlnaInputError(f"{performance.label}: every parameter is held; expected some to draw. Hold fewer.")
    return spread


def _tested(
    performance: Performance, spread: F64, rng: np.random.Generator, tests: list[SetUp]
) -> tuple[list[dict[Figure, F64]], F64]:
    """Figures of BLOCK arms, test by test, and (BLOCK, P) how far each is off."""
    low, high = np.log(performance.factor)
    off = spread * rng.standard_normal((BLOCK, len(spread))) * np.exp(rng.uniform(low, high, BLOCK))[:, None]
    return [test.figures(off, rng) for test in tests], off


def _block(performance: Performance, spread: F64, seed: int, piece: tuple[int, list[SetUp]]) -> F64:
    """Of one block, those that agree."""
    number, tests = piece
    figures, off = _tested(performance, spread, np.random.default_rng([seed, 61, number]), tests)
    agree = np.ones(BLOCK, dtype=bool)
    for test, found in zip(performance.tests, figures, strict=True):
        for name, certified in test.figures_mm.items():
            if performance.at_most:
                agree &= found[name] <= certified
            else:
                agree &= np.abs(found[name] - certified) <= performance.within * certified
    return off[agree]
