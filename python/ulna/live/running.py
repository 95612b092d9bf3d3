"""The running fit: an arm that is known a little better after each touch, without starting over.

Touches are looked at from the arm of the last fit. One more, or one withdrawn, changes one leaf of the core's tree of
triangles (`_core.Running`), so what is known follows in milliseconds however many there are; where the arm has moved
it is fitted anew, from where it was, and is then what `ulna calibrate` makes of the same readings.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ulna.arm.arm import Arm
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.kinds import kind_of
from ulna.artefacts.readings import Readings
from ulna.calibration.identify import Identification, identify
from ulna.calibration.running import run_assembled
from ulna.ground.arrays import F64, I64, Bool
from ulna.ground.errors import UlnaInputError
from ulna.ground.worded import worded
from ulna.live.touches import Touch, counting, held_out, leaf_of, readings_of
from ulna.study.assembly import Assembled, assemble
from ulna.study.data import FitOptions, Noise, Prior
from ulna.study.study import Study

if TYPE_CHECKING:
    import ulna._core as _core

LABEL = "touches so far"
FEW = 200
"""Touches that are looked at whole, each time: a few milliseconds."""


@dataclass(frozen=True)
class SoFar:
    """What the touches so far determine."""

    touches: int
    """That count."""
    free: int
    """Parameters that are fitted."""
    determined: int
    """Of their combinations: the rank."""
    not_determined: list[str]
    """Parameters that take part in a direction that is not."""
    covariance: F64
    """(F, F) over the free parameters, rad and mm, of the touches and of what a drawing says: of every direction."""
    triangle: F64
    """(F, F) upper R of what is known, whitened, drawing and priors included: what `gains` are asked of."""


class RunningFit:
    """Touches of some artefacts by one arm, and what they tell of it.

    arm: where to begin, a drawing or an earlier calibration; noise: of the readings, which must be stated; fit: what is
    fitted, as in a study.
    """

    def __init__(self, arm: Arm, artefacts: Sequence[Artefact], noise: Noise, fit: FitOptions | None = None) -> None:
        self._arm = arm
        self._artefacts = {artefact.name: artefact for artefact in artefacts}
        self._noise = noise
        self._fit = fit or FitOptions()
        self.touches: list[Touch] = []
        """All of them, the withdrawn ones and those held out too."""
        self.fitted: _core.Fitted | None = None
        """The last fit; None before the first."""
        self.current = False
        """Whether it is of the newest try: none failed since."""
        self._parameters: F64 | None = None
        self._names: list[str] = []
        self._sigma: float | None = None
        self._leaves: dict[tuple[str, str], int] = {}
        self._groups: list[str] = []
        self._said: set[tuple[str, int, int, int]] = set()
        """Of each touch: artefact, feature, probe, and how many features had been touched in its place by then."""
        self._look()

    @property
    def arm(self) -> Arm:
        """As it is known now: of the last fit; before that of the touches and the drawing; or where it began."""
        start = self._assembled.arm
        if self._parameters is None:
            return start
        return start.with_parameters(self._parameters[: len(start.parameter_names)])

    def artefact(self, name: str) -> Artefact:
        """As it is stated."""
        return self._artefacts[name]

    def free(self) -> I64:
        """(F,) indices of the parameters that are fitted."""
        return np.flatnonzero(~self._hold)

    @property
    def names(self) -> list[str]:
        """(F,) of them."""
        return [name for name, held in zip(self._assembled.names, self._hold, strict=True) if not held]

    @property
    def _hold(self) -> Bool:
        return self._assembled.hold

    def study(self) -> Study:
        """The touches that count as a study. Raises UlnaInputError where there are none."""
        count = counting(self.touches)
        if not count:
            raise UlnaInputError(worded("touches so far: there are none; expected one at least. Touch something."))
        return self._study(count)

    def _study(self, touches: Sequence[Touch]) -> Study:
        of = {name: [touch for touch in touches if touch.artefact == name] for name in self._artefacts}
        groups = [readings_of(some, self._artefacts[name]) for name, some in of.items() if some]
        return Study(Path(LABEL), self._arm, groups, self._noise, self._fit, [], [], None, [])

    def add(self, touch: Touch) -> None:
        """One more touch. Raises UlnaInputError for an artefact that is not at hand."""
        if touch.artefact not in self._artefacts:
            known = ", ".join(f"'{name}'" for name in self._artefacts)
            raise UlnaInputError(f"artefact '{touch.artefact}' is not at hand; expected one of {known}. Name it.")
        self.touches.append(touch)
        if not touch.held_out:
            self._follow(touch)

    def withdraw(self, number: int, reason: str) -> None:
        """A touch that shall not count; it stays in `touches`. Raises UlnaInputError where there is none such."""
        for k, touch in enumerate(self.touches):
            if touch.number == number and touch.withdrawn is None:
                self.touches[k] = replace(touch, withdrawn=reason)
                if not touch.held_out:
                    self._follow(touch)
                return
        raise UlnaInputError(f"touch {number}: there is none, or it was withdrawn before; expected one that counts.")

    def _follow(self, touch: Touch) -> None:
        """The leaf that a touch belongs to, made anew of the touches that count."""
        count = counting(self.touches)
        artefact = self._artefacts[touch.artefact]
        key = leaf_of(touch, artefact)
        own = [each for each in count if each.artefact == touch.artefact and leaf_of(each, artefact) == key]
        said = touch.artefact, touch.feature, touch.probe, len({each.feature for each in own})
        if len(count) <= FEW or touch.artefact not in self._groups or said not in self._said:
            # what is lost whatever is touched, such as the scale where no length is known, changes with it
            self._look()
            self._said.add(said)
            return
        leaf = self._leaves.setdefault(key, len(self._leaves))
        if not own:
            self._core.empty(leaf)
        elif not self._core.put(leaf, self._groups.index(touch.artefact), assemble(self._study(own)).problem):
            self._look()

    def _look(self) -> None:
        """All touches that count, from the arm as it is known."""
        study = self._study(counting(self.touches))
        self._look_at(study, assemble(study))

    def _look_at(self, study: Study, assembled: Assembled) -> None:
        import ulna._core as _core

        self._assembled: Assembled = assembled
        self._groups = [group.artefact.name for group in study.readings]
        # numbered as the core counts standings: group after group, as they first come
        self._leaves = {}
        for group in study.readings:
            for touch in counting(self.touches):
                if touch.artefact == group.artefact.name:
                    self._leaves.setdefault(leaf_of(touch, group.artefact), len(self._leaves))
        self._core: _core.Running = _core.Running(assembled.problem, assembled.hold, self._from(assembled), self._sigma)

    def _from(self, assembled: Assembled) -> F64 | None:
        """The parameters as they are known: of another artefact fitted dimensions are parameters too, which begin as
        they are stated."""
        if self._parameters is None:
            return None
        known = dict(zip(self._names, self._parameters.tolist(), strict=True))
        stated = zip(assembled.names, assembled.problem.parameters.tolist(), strict=True)
        return np.array([known.get(name, value) for name, value in stated])

    def so_far(self) -> SoFar:
        """What the touches that count determine."""
        count = counting(self.touches)
        determined, lost, _, _ = self._core.so_far()
        known = self._fit.known_length_mm, self._fit.known_angle_rad
        covariance, triangle = self._core.with_drawing(*known)
        names = [name for name, gone in zip(self.names, lost.tolist(), strict=True) if gone]
        return SoFar(len(count), len(lost), determined, names, covariance, triangle)

    def without(self, artefact: str, standing: str) -> SoFar:
        """The same as `so_far` without the touches in one place."""
        leaf = self._leaves.get((artefact, standing))
        known = self._fit.known_length_mm, self._fit.known_angle_rad
        covariance, triangle = self._core.with_drawing(*known, leaf)
        rest = [each for each in self.counting() if (each.artefact, each.standing) != (artefact, standing)]
        return SoFar(len(rest), len(covariance), 0, [], covariance, triangle)

    def tell(self) -> Identification:
        """What the touches that count determine, with why and what to do where they do not: of the last fit, or at the
        arm where it began. Raises UlnaInputError where there are none."""
        if self.fitted is not None and self.current:
            return Identification.from_core(self.fitted.identifiability)
        return identify(self.study())

    def could_tell(self, readings: Readings) -> Identification:
        """The same of any readings of an artefact, at the arm as it is known."""
        return identify(self._study_of(readings))

    def rows_of(self, readings: Readings) -> F64:
        """(R, F) whitened rows of any readings of an artefact as it is certified, standing by standing, at the arm as
        it is known."""
        import ulna._core as _core

        assembled = assemble(self._study_of(readings))
        rows, _ = _core.whitened_rows(assembled.problem, assembled.hold)
        more = len(self.free()) - rows.shape[1]
        return np.concatenate([rows, np.zeros((len(rows), more))], axis=1) if more else rows

    def _study_of(self, readings: Readings) -> Study:
        certain = replace(readings, artefact=kind_of(readings.artefact).certain(readings.artefact))
        return Study(Path(LABEL), self.arm, [certain], self._noise, self._fit)

    def counting(self) -> list[Touch]:
        """The touches that are fitted."""
        return counting(self.touches)

    def whole_study(self) -> Study:
        """The same as `study` with the touches that are held out behind those of the same artefact. Raises
        UlnaInputError where there are none."""
        self.study()
        return self._study([*counting(self.touches), *held_out(self.touches)])

    def refit(self, search: bool = False) -> _core.Fitted:
        """The fit of the touches that count, from where the last one ended. search: whether a poor minimum is left for
        others. Raises UlnaInputError; where that is as they are too few, the arm is what they and the drawing say."""
        study = self.study()
        assembled = assemble(study)
        self.current = False
        try:
            self.fitted = run_assembled(study, assembled, from_parameters=self._from(assembled), search=search)
        except UlnaInputError:
            if self.fitted is None:
                self._with_drawing(study)
            raise
        self.current = True
        self._parameters, self._names = self.fitted.parameters, assembled.names
        variance = self.fitted.variance
        self._sigma = float(np.sqrt(variance)) if np.isfinite(variance) else None
        self._look_at(study, assembled)
        return self.fitted

    def _with_drawing(self, study: Study) -> None:
        """The arm by the touches and by what the drawing is known by, as `so_far` weighs them: there is none by the
        touches alone yet, and where an artefact stands is told by the arm."""
        options = study.fit
        drawn = Prior(1.0, length_mm=options.known_length_mm, angle_rad=options.known_angle_rad)
        leaning = replace(study, fit=replace(options, prior={"*": drawn}))
        assembled = assemble(leaning)
        try:
            found = run_assembled(leaning, assembled, from_parameters=self._from(assembled), search=False)
        except UlnaInputError:
            return
        self._parameters, self._names = found.parameters, assembled.names
        self._look_at(study, assemble(study))
