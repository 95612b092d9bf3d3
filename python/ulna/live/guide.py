"""Where to touch next: the touch, of very many, that takes most off the uncertainty of what will be measured.

An artefact that was put somewhere is touched there more than once: its place costs five or six unknowns, and every
touch gives three equations. So two things are weighed against each other: one more touch where it stands, and a new
place with the touches that it would be given. Both are asked of the core beside all that is known (`_core.gains`), so a
suggestion that is not followed costs nothing: the next one knows what was done instead. Places, postures and test
lengths are those of a plan (`ulna.planning`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.labels import Labels
from ulna.artefacts.readings import Readings
from ulna.ground.arrays import F64, I64, Bool
from ulna.ground.errors import UlnaInputError
from ulna.live.at_hand import AtHand
from ulna.live.running import RunningFit, SoFar
from ulna.live.touches import Touch, readings_of
from ulna.live.worth import Worth, mean_variance, variances
from ulna.planning.candidates import Candidates, draw
from ulna.planning.information import Coordinates, candidate_rows
from ulna.planning.spec import PlanSpec
from ulna.planning.stands import Stand, elbow_sides, probe_from, stands_of
from ulna.planning.targets import Tests, length_rows, test_mm
from ulna.planning.touchable import touchable
from ulna.simulation.mover import Mover, travel_or_limits

TOUCHES = 20_000
"""Of all candidates in new places, together."""
IN_A_PLACE = 6
"""Touches that a new place is judged by."""
MOST_HERE = 16
"""Touches in one place, then the artefact is moved: it may have moved by itself. The 25 unknowns of an arm and 5 of a
place take ten touches before one can contradict the others; six more can tell that it moved, as many as judge a place.
To leave earlier pays for the next place, two touches and a minute, while a touch more here still tells much."""
WORTH_MOVING = 1.2
"""A new place must be worth so many times more, a touch: moving takes a minute."""
LOOKED_AHEAD = 300
"""Candidates by which the touches to a goal are counted, and the most places that are looked ahead."""
MOST_AHEAD = 25
OTHER_RAD = np.radians(10.0)
"""A posture is another where one joint at least is so far from where it was."""
MOVED_MM = 1.0
"""The arm has moved so far that what touches are worth is looked at anew."""
LOOKED_AT = 200
"""Poses by which that is judged."""


@dataclass(frozen=True)
class Suggestion:
    """One touch to take next."""

    feature: int
    """Index into the artefact's features."""
    name: str
    """Of the feature; empty where it has none."""
    q_rad: F64
    """(n,) a posture."""
    point_mm: F64
    """(3,) where it is, base frame."""
    here: bool
    """Whether the artefact stays where it is."""
    stand: Stand
    """Where it stands, or is to be put."""
    gain: float
    """By which part the touch lowers the mean variance of the test lengths; of a new place, a touch of those in it."""
    elbow: str | None
    """To which side of the line from shoulder to tip the elbow is."""
    comes_from: str
    """From where the probe comes."""


class Guide:
    """Suggestions for one arm, artefact and purpose.

    spec: as of a plan. Raises UlnaInputError where the artefact cannot be put anywhere, or joints have no limits.
    """

    def __init__(self, fit: RunningFit, spec: PlanSpec, seed: int = 0, candidates: Candidates | None = None) -> None:
        """candidates: those of a guide for the same drawing and specification, which need not be drawn again."""
        self.fit = fit
        """What is known of the arm."""
        self._rng = np.random.default_rng([seed, 97])
        arm = fit.arm
        self._probe = arm.probe_index(spec.probe)
        features = max(len(spec.artefact.features), 1)
        scattered = kind_of(spec.artefact).scattered
        touches = spec.touches if scattered else max(1, -(-IN_A_PLACE // features))
        self.per_place = touches if scattered else touches * features
        """Touches by which a new place is judged."""
        self.spec = replace(spec, candidates=max(1, TOUCHES // self.per_place), touches=touches, seed=seed)
        self.mover = Mover(arm, travel_or_limits(arm, spec.travel_rad, spec.label))
        """Finds postures."""
        self.candidates = candidates or draw(self.spec, self.mover, self._probe, self._rng)
        """Measurements in new places."""
        bars, free = np.random.default_rng([self.spec.seed, 43]), self._arm_free()
        whole = Coordinates(np.eye(len(free)), np.eye(len(free)))
        self.test_rad = Tests.of(arm, self.spec, self.mover, self._probe, free, whole, bars).q_rad
        """(N, 2, n) postures at the ends of the test bars."""
        self._look_rad = self.mover.anywhere(LOOKED_AT, self._rng)
        self._rows: F64 | None = None
        self._tests: F64 | None = None
        self._at_mm: F64 | None = None
        self.at_hand = AtHand(fit, self.spec, self.mover, self._rng)
        """Finds them on the features where the artefact stands."""
        self._refused_rad: list[F64] = []
        self._planned: int | None = None
        """Number of the candidate for which the artefact was put where it stands."""

    def worth(self, so_far: SoFar) -> Worth:
        """What lengths are worth with what is known so far."""
        return Worth.of(self._look()[1], so_far.covariance, test_mm(self.fit.arm, self.spec, self._probe))

    def next(self, so_far: SoFar, standing: str | None = None) -> Suggestion:
        """The best touch now. standing: where the artefact stands; None: nowhere yet. Raises UlnaInputError."""
        import ulna._core as _core

        rows, tests = self._look()
        total = max(float(variances(tests, so_far.covariance).mean()), 1e-300)
        if not kind_of(self.spec.artefact).placed(self.spec.artefact):
            return self._fixed(so_far, total)
        own = [] if standing is None else self._own(standing)
        unfinished = self._unfinished(own)
        if unfinished is not None:
            return unfinished
        gains = _core.gains(rows, so_far.triangle, tests) / self.per_place
        best = int(gains.argmax())
        if own and len(own) < MOST_HERE:
            here = self._here(own, total)
            if here is not None and here.gain * WORTH_MOVING >= gains[best] / total:
                return here
        self._planned = best
        return self.in_new_place(best, 0, float(gains[best]) / total)

    def refused(self, suggestion: Suggestion) -> None:
        """Whoever followed it came to a posture that was touched before: it is not suggested again."""
        self._refused_rad.append(suggestion.q_rad)

    def touches_more(self, so_far: SoFar, goal_u_mm: float) -> int | None:
        """About how many touches to an uncertainty of a length, each place the best of some: None where it is
        reached, or is not in sight."""
        import ulna._core as _core

        rows, tests = self._look()
        some = np.ascontiguousarray(rows[:: max(1, len(rows) // LOOKED_AHEAD)])
        triangle, goal = so_far.triangle, goal_u_mm**2
        if float(variances(tests, so_far.covariance).mean()) <= goal:
            return None
        # what is not known of artefacts no touch can lower
        beside = max(0.0, float(variances(tests, so_far.covariance).mean()) - mean_variance(tests, triangle))
        for place in range(1, MOST_AHEAD + 1):
            best = int(_core.gains(some, triangle, tests).argmax())
            triangle = np.asarray(np.linalg.qr(np.concatenate([triangle, some[best]]), mode="r"))
            now = mean_variance(tests, triangle)
            if now + beside <= goal:
                return place * self.per_place
        return None

    @property
    def determinable(self) -> int:
        """Combinations of the free parameters that touches of this artefact can determine at all."""
        rows = self._look()[0]
        free = self._arm_free()
        units = np.array(self.fit.arm.parameter_units)[free]
        natural = np.where(units == "mm", 1.0, self.fit.arm.core.reach_mm(self._probe))
        return Coordinates.of(rows[:, :, : len(free)].reshape(-1, len(free)), natural).rank

    def any_touch(self, rng: np.random.Generator, standing: str | None, most: int) -> Suggestion:
        """A touch at random, so many in a place: what suggestions are compared with."""
        own = [] if standing is None else self._own(standing)
        unfinished = self._unfinished(own)
        if unfinished is not None:
            return unfinished
        if own and len(own) < most:
            points_mm, q_rad, feature = self.at_hand.postures(own)
            if len(q_rad):
                k = int(rng.integers(len(q_rad)))
                return self.suggestion(int(feature[k]), q_rad[k], points_mm, True, 0.0)
        best = int(rng.integers(len(self.candidates)))
        self._planned = best
        return self.in_new_place(best, 0, 0.0)

    def _own(self, standing: str) -> list[Touch]:
        name = self.spec.artefact.name
        return [each for each in self.fit.counting() if (each.artefact, each.standing) == (name, standing)]

    def _unfinished(self, own: Sequence[Touch]) -> Suggestion | None:
        """What a place was chosen for and is not touched yet: a feature, or the next place on a surface; None where
        all is."""
        if not own or self._planned is None:
            return None
        if kind_of(self.spec.artefact).scattered:
            return self.in_new_place(self._planned, len(own), 0.0, True) if len(own) < self.per_place else None
        untouched = self.at_hand.untouched(own)
        return self.in_new_place(self._planned, untouched[0], 0.0, True) if untouched else None

    def _fixed(self, so_far: SoFar, total: float) -> Suggestion:
        """The best touch of features whose places are known in the arm's frame."""
        import ulna._core as _core

        artefact = self.spec.artefact
        points_mm, q_rad, feature = self.at_hand.fixed()
        count = len(q_rad)
        if not count:
            raise UlnaInputError(
                f"{self.spec.label}: artefact '{artefact.name}': the arm reaches none of its features; expected some "
                "within reach. Move it, or widen the travel."
            )
        touches = [Touch(k + 1, artefact.name, str(k), int(feature[k]), self._probe, q_rad[k]) for k in range(count)]
        rows = self._padded(self.fit.rows_of(readings_of(touches, artefact)).reshape(count, -1, len(self.fit.free())))
        gains = _core.gains(rows, so_far.triangle, self._look()[1])
        best = int(gains.argmax())
        return self.suggestion(int(feature[best]), q_rad[best], points_mm, True, float(gains[best]) / total)

    def in_new_place(self, number: int, feature: int, gain: float, here: bool = False) -> Suggestion:
        """One touch of a candidate, by its number."""
        candidates = self.candidates
        poses = candidates.poses(np.array([number]))[0]
        points_mm = candidates.features_mm[candidates.place[number]]
        return self.suggestion(feature, poses[feature, 0], points_mm, here, gain)

    def _here(self, own: Sequence[Touch], total: float) -> Suggestion | None:
        """The best of many postures on the features where they are; None where none is found.

        The touches in this place and one more are one block beside all others: what is left of its gain when that of
        the touches alone is taken off is the touch's own.
        """
        import ulna._core as _core

        points_mm, q_rad, feature = self.at_hand.postures(own)
        others = _others(q_rad, [*(touch.q_rad for touch in own), *self._refused_rad])
        q_rad, feature = q_rad[others], feature[others]
        if not len(q_rad):
            return None
        known = self.fit.without(self.spec.artefact.name, own[0].standing)
        tests = self._look()[1]
        gains = _core.gains(self._with_one_more(own, q_rad, feature), known.triangle, tests)
        without = self._with_one_more(own, None, None)
        # too few in a place tell nothing: they are all needed to know where it is
        alone = _core.gains(without, known.triangle, tests)[0] if without.shape[1] else 0.0
        best = int(gains.argmax())
        gain = float(gains[best] - alone) / total
        return self.suggestion(int(feature[best]), q_rad[best], points_mm, True, gain)

    def _with_one_more(self, own: Sequence[Touch], q_rad: F64 | None, feature: I64 | None) -> F64:
        """(N, k, F) rows of the touches in one place with one of N more, each as a place of its own; without any: (1,
        k, F) of the touches alone."""
        count = 1 if q_rad is None else len(q_rad)
        together = readings_of(own, self.spec.artefact)
        many = together.select(np.tile(np.arange(len(own)), count))
        many.placement = Labels(np.repeat(np.arange(count), len(own)), [str(k) for k in range(count)])
        rows = self.fit.rows_of(many if q_rad is None or feature is None else _with(many, count, q_rad, feature))
        return np.ascontiguousarray(rows.reshape(count, -1, rows.shape[1]))

    def suggestion(self, feature: int, q_rad: F64, points_mm: F64, here: bool, gain: float) -> Suggestion:
        """A posture (n,) rad on one of the features (K, 3) mm, as it is told."""
        arm = self.fit.arm
        pose, point_mm = np.ascontiguousarray(q_rad[None]), points_mm[feature]
        return Suggestion(
            feature=feature,
            name=self._names()[feature],
            q_rad=q_rad,
            point_mm=point_mm,
            here=here,
            stand=stands_of(np.zeros(1, np.int64), points_mm[None])[0],
            gain=gain,
            elbow=elbow_sides(arm, pose, point_mm[None])[0],
            comes_from=probe_from(arm, pose, point_mm[None])[0],
        )

    def _names(self) -> tuple[str, ...]:
        return touchable(self.spec, self.fit.arm, self._probe).names

    def _look(self) -> tuple[F64, F64]:
        """Rows of all candidates, and of the test lengths, at the arm as it is known."""
        arm = self.fit.arm
        at_mm = arm.core.tip(self._look_rad, self._probe)
        if self._rows is None or self._tests is None or self._at_mm is None or self._far(at_mm):
            self._at_mm = at_mm
            rows = candidate_rows(self.spec, arm, self._probe, self._arm_free(), self.candidates)
            self._rows = self._padded(rows)
            self._tests = self._tests_of(arm)
        return self._rows, self._tests

    def _far(self, at_mm: F64) -> bool:
        assert self._at_mm is not None
        return bool(np.linalg.norm(at_mm - self._at_mm, axis=1).max() > MOVED_MM)

    def _arm_free(self) -> I64:
        """Indices of the free parameters that are the arm's: dimensions of artefacts come after them."""
        free = self.fit.free()
        return free[free < len(self.fit.arm.parameter_names)]

    def _tests_of(self, arm: Arm) -> F64:
        flat = self.test_rad.reshape(-1, arm.n)
        moved = arm.core.jacobian(flat, self._probe)[:, :, self._arm_free()]
        return self._padded(length_rows(arm.core.tip(flat, self._probe), moved))

    def _padded(self, rows: F64) -> F64:
        """With zeros for dimensions of artefacts that are fitted: a plan takes them as certified."""
        more = len(self.fit.free()) - rows.shape[-1]
        if not more:
            return np.ascontiguousarray(rows)
        return np.concatenate([rows, np.zeros((*rows.shape[:-1], more))], axis=-1)


def _others(q_rad: F64, taken_rad: Sequence[F64]) -> Bool:
    """(N,) whether a posture is another than each that was taken: the same once more tells hardly anything, whatever
    the rows of an arm that is little known say."""
    off = np.abs(np.remainder(q_rad[:, None] - np.array(taken_rad) + np.pi, 2.0 * np.pi) - np.pi)
    others: Bool = (off.max(axis=2) >= OTHER_RAD).all(axis=1)
    return others


def _with(many: Readings, count: int, q_rad: F64, feature: I64) -> Readings:
    """One reading more in each of so many places."""
    place = np.concatenate([many.labels.codes, np.arange(count)])
    more = many.select(np.concatenate([np.arange(len(many)), np.zeros(count, dtype=np.int64)]))
    more.q_rad[len(many) :], more.feature[len(many) :] = q_rad, feature
    more.placement = Labels(place, many.labels.names)
    return more.select(np.argsort(place, kind="stable"))
