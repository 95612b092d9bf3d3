"""What a result draws: stated here, drawn where reports are drawn (`ulna.documents`), so that there is one drawing."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import TYPE_CHECKING, Literal

from ulna.study.given import StudyLike

if TYPE_CHECKING:
    from matplotlib.axes import Axes

View = Literal["xy", "xz", "yz"]


class Plots(ABC):
    """The drawings of a result, each on axes of Matplotlib, which is loaded when the first is drawn.

    `ax`: axes to draw on; None: new ones. Where a drawing needs encoder angles, the result must know its study: it does
    where it was just made; of one from a file say which with `result.plot.of(study)`.
    """

    @abstractmethod
    def of(self, study: StudyLike) -> Plots:
        """The same with the study that the result was made of. Raises UlnaInputError for another one."""

    @abstractmethod
    def residuals(self, artefact: str | None = None, ax: Axes | None = None) -> Axes:
        """How the errors of an artefact are distributed: a histogram with the normal curve. artefact: by its name;
        None: the first. Raises UlnaInputError for one that there is not."""

    @abstractmethod
    def quantiles(self, artefact: str | None = None, ax: Axes | None = None) -> Axes:
        """The same errors against those of a normal distribution: a straight line where they are normal."""

    @abstractmethod
    def parameters(self, ax: Axes | None = None) -> Axes:
        """How far each fitted parameter moved, in units of its standard uncertainty. Raises UlnaInputError where none
        has one."""

    @abstractmethod
    def before_after(self, ax: Axes | None = None) -> Axes:
        """Root mean square of each figure before and after. Raises UlnaInputError where there is none."""

    @abstractmethod
    def lengths(self, ax: Axes | None = None) -> Axes:
        """Length errors over lengths. Raises UlnaInputError where no length was measured, or the study is not known."""

    @abstractmethod
    def joint(self, joint: int, ax: Axes | None = None) -> Axes:
        """Residuals along the motion of a joint (from 1) over its angle: what an eccentric encoder shows itself by.
        Raises UlnaInputError where the study is not known, or there is no such joint."""

    @abstractmethod
    def reach(self, ax: Axes | None = None) -> Axes:
        """Sizes of the residuals over the tip's distance from the base. Raises UlnaInputError where the study is not
        known."""

    @abstractmethod
    def arm(self, ax: Axes | None = None) -> Axes:
        """The calibrated arm, its axes and frames: in the pose of a reading in the middle of all, or, where the study
        is not known, in its start pose."""

    @abstractmethod
    def map(self, view: View = "xy", ax: Axes | None = None) -> Axes:
        """Residuals in space: arrows at the tips, seen from above (view "xy") or from a side ("xz", "yz"). Raises
        UlnaInputError where the study is not known, or no residual has a direction."""
