"""What `Result.plot` draws: the report's drawings, on axes for a notebook or a figure of one's own."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib import rc_context
from matplotlib.axes import Axes

from ulna.calibration.evaluate import study_of_arm
from ulna.calibration.plots import Plots, View
from ulna.calibration.result import Result
from ulna.documents.content.clouds import Cloud, Quiver, clouds
from ulna.documents.content.distribution import Sample, samples
from ulna.documents.content.parameters import parameters
from ulna.documents.content.quality import quality_rows, residual_row
from ulna.documents.content.readings import length_errors, reading_rows
from ulna.documents.content.standing import standing_arm
from ulna.documents.drawn import arm as of_arm
from ulna.documents.drawn import parameters as of_parameters
from ulna.documents.drawn import residuals as of_residuals
from ulna.documents.languages.text import plain
from ulna.documents.languages.words import Words
from ulna.documents.sources.study import check_rows
from ulna.ground.errors import UlnaInputError, nearest
from ulna.ground.style import STYLE
from ulna.study.given import StudyLike, as_study
from ulna.study.study import Study
from ulna.uncertainties.uncertainty import check_same

WORDS = Words("en")
SMALL = 8.0
"""Of a legend's letters."""
SCREEN_PX = (640.0, 520.0)
PX_PER_IN = 100.0
"""Of the arm's drawing, whose sizes are in px."""
MARK = 5.0
"""Of a reading."""


def say(key: str, **values: object) -> str:
    """Words of the report."""
    return plain(WORDS(key, **values))


class ResultPlots(Plots):
    """See `ulna.calibration.plots.Plots`."""

    def __init__(self, result: Result, study: Study | None = None) -> None:
        self._result, self._study = result, result.study if study is None else study

    def of(self, study: StudyLike) -> ResultPlots:
        found = as_study(study)
        label = f"the result of '{self._result.arm.name}'"
        check_same(found, self._result.provenance, label)
        check_rows(found, self._result, Path(found.label))
        return ResultPlots(self._result, found)

    def residuals(self, artefact: str | None = None, ax: Axes | None = None) -> Axes:
        sample = self._sample(artefact)
        with _axes(ax, 6.0, 3.6) as axes:
            of_residuals.histogram(axes, sample, say, SMALL)
            axes.set_title(_titled(sample))
        return axes

    def quantiles(self, artefact: str | None = None, ax: Axes | None = None) -> Axes:
        sample = self._sample(artefact)
        with _axes(ax, 6.0, 3.6) as axes:
            of_residuals.quantiles(axes, sample, say, SMALL)
            axes.set_title(_titled(sample))
        return axes

    def parameters(self, ax: Axes | None = None) -> Axes:
        found = parameters(self._result)
        rows = of_parameters.rated(found)
        if not rows:
            raise self._nothing("no fitted parameter has an uncertainty", "Calibrate with more readings")
        with _axes(ax, 6.4, 1.0 + 0.17 * len(rows)) as axes:
            of_parameters.ratios(axes, found, say, SMALL)
        return axes

    def before_after(self, ax: Axes | None = None) -> Axes:
        every = [*quality_rows("fitted", self._result.before, self._result.after), residual_row(self._result)]
        both = [row for row in every if row is not None and row.before is not None and row.after is not None]
        known = [row for row in both if min(each.rms_mm for each in (row.before, row.after) if each is not None) > 0.0]
        if not known:
            raise self._nothing("no figure is known both before and after", "Calibrate with readings that give one")
        with _axes(ax, 6.4, 1.2 + 0.45 * len(known)) as axes:
            of_parameters.before_after(axes, known, say)
        return axes

    def lengths(self, ax: Axes | None = None) -> Axes:
        found = length_errors(self._of_study("length errors over lengths"), self._result)
        if found is None:
            raise self._nothing("no length was measured", "Touch a bar, or give length rows")
        with _axes(ax, 6.0, 3.6) as axes:
            of_parameters.lengths(axes, found, say)
        return axes

    def joint(self, joint: int, ax: Axes | None = None) -> Axes:
        found = [each for each in self._clouds[0] if each.over == "joint"]
        if not 1 <= joint <= self._result.arm.n:
            raise UlnaInputError(
                f"plot.joint: got {joint}; expected 1 to {self._result.arm.n}, the joints of '{self._result.arm.name}'."
            )
        if not found:
            raise self._nothing("the readings' residuals have no direction", "Touch points, bars or seats as well")
        return self._cloud(next(each for each in found if each.joint == joint), ax)

    def reach(self, ax: Axes | None = None) -> Axes:
        return self._cloud(next(each for each in self._clouds[0] if each.over == "reach"), ax)

    def map(self, view: View = "xy", ax: Axes | None = None) -> Axes:
        if view not in ("xy", "xz", "yz"):
            raise UlnaInputError(f"plot.map: view '{view}'; expected xy, xz or yz.{nearest(view, ('xy', 'xz', 'yz'))}")
        quiver = self._clouds[1]
        if quiver is None:
            raise self._nothing("the readings' residuals have no direction", "Touch points, bars or seats as well")
        with _axes(ax, 6.4, 5.6) as axes:
            factor = of_residuals.arrows(axes, quiver, reading_rows(self._result.residuals), say, view, SMALL)
            axes.set_title(f"residuals × {factor:g}", fontsize=10)
        return axes

    def arm(self, ax: Axes | None = None) -> Axes:
        study = None if self._study is None else study_of_arm(self._study, self._result.arm)
        found = standing_arm(self._result.arm, study, reading_rows(self._result.residuals))
        view = of_arm.seen(found, *SCREEN_PX)
        with _axes(ax, view.width_px / PX_PER_IN, view.height_px / PX_PER_IN) as axes:
            of_arm.arm(axes, found, view, 72.0 / PX_PER_IN)
            axes.set_aspect("equal")
        return axes

    def _cloud(self, found: Cloud, ax: Axes | None) -> Axes:
        with _axes(ax, 6.0, 3.6) as axes:
            of_residuals.cloud(axes, found, reading_rows(self._result.residuals), say, MARK)
            axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=3, fontsize=SMALL)
        return axes

    def _sample(self, artefact: str | None) -> Sample:
        found = samples(self._result.residuals, self._result.artefacts)
        names = list(dict.fromkeys(sample.artefact for sample in found))
        if artefact is not None and artefact not in names:
            raise UlnaInputError(
                f"plot: there is no artefact '{artefact}' among the readings of '{self._result.arm.name}'."
                f"{nearest(artefact, names)}"
            )
        if not found:
            raise self._nothing("there are no residuals", "Calibrate with readings")
        return next(sample for sample in found if artefact in (None, sample.artefact))

    @cached_property
    def _clouds(self) -> tuple[list[Cloud], Quiver | None]:
        study = self._of_study("residuals over joints, reach and in space")
        return clouds(study_of_arm(study, self._result.arm), self._result.arm, self._result.residuals)

    def _of_study(self, what: str) -> Study:
        if self._study is None:
            name = self._result.provenance.get("study")
            where = f"'{name}'" if name else "STUDY"
            raise UlnaInputError(
                f"plot: {what} need the readings, and a result that was read from a file has none; expected its study. "
                f"Say result.plot.of({where})."
            )
        return self._study

    def _nothing(self, why: str, remedy: str) -> UlnaInputError:
        return UlnaInputError(f"plot: nothing to draw of '{self._result.arm.name}': {why}. {remedy}.")


def _titled(sample: Sample) -> str:
    number = f"{len(sample.value_mm)} errors, s = {sample.sigma_mm:.2g} mm"
    return f"{sample.artefact}: {say(f'sample.{sample.kind}')}, {number}"


@contextmanager
def _axes(given: Axes | None, wide_in: float, high_in: float) -> Iterator[Axes]:
    """Axes to draw on, in the house's style: those that were given, or new ones."""
    with rc_context(STYLE):
        axes = given if given is not None else plt.subplots(figsize=(wide_in, high_in), layout="constrained")[1]
        axes.grid(color="0.9", linewidth=0.5)
        axes.set_axisbelow(True)
        yield axes
