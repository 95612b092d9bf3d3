"""What plots on paper share: sizes, letters, SVG. Names of files stand in captions, which Typst sets."""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from matplotlib import font_manager, rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import Formatter

from ulna.documents.languages.languages import language_of
from ulna.documents.languages.words import Words
from ulna.documents.pdf.text import decimals, line
from ulna.ground.errors import UlnaInputError
from ulna.ground.style import STYLE

INCH_MM = 25.4
WIDTH_MM = 170.0
HALF_MM = 82.0
"""Of a plot with another beside it."""


@contextmanager
def looks(fonts: Sequence[Path]) -> Iterator[None]:
    """Letters small enough for paper, and the page's other fonts where the first has not the sign. Raises
    UlnaInputError for a font that Matplotlib cannot read."""
    names = ["DejaVu Sans"]
    for file in fonts:
        try:
            font_manager.fontManager.addfont(file)
        except (RuntimeError, OSError):
            raise UlnaInputError(
                f"PDF: the font {file} cannot be used in figures. Name a folder with another font by --fonts, such as "
                "Noto Sans CJK (OpenType)."
            ) from None
        names.append(font_manager.FontProperties(fname=file).get_name())
    size: Any = {
        "font.size": 7.5,
        "axes.labelsize": 6.5,
        "axes.linewidth": 0.6,
        "lines.linewidth": 1.2,
        "font.family": names,
    }
    with rc_context({**STYLE, **size}):
        yield


def axes_of(width_mm: float, height_mm: float) -> tuple[Figure, Axes]:
    """An empty plot with a faint grid."""
    figure = Figure(figsize=(width_mm / INCH_MM, height_mm / INCH_MM), layout="constrained")
    axes: Axes = figure.subplots()
    axes.grid(color="0.9", linewidth=0.5)
    axes.set_axisbelow(True)
    return figure, axes


def _with_commas(figure: Figure) -> None:
    """Ticks whose decimals stand behind a comma."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter(_Comma(axis.get_major_formatter()))


class _Comma(Formatter):
    """What another formatter says, with a comma."""

    def __init__(self, other: Formatter) -> None:
        self._other = other

    def set_axis(self, axis: Any) -> None:
        super().set_axis(axis)
        self._other.set_axis(axis)

    def set_locs(self, locs: Any) -> None:
        self._other.set_locs(locs)

    def __call__(self, x: float, pos: int | None = None) -> str:
        return decimals(self._other(x, pos), "de")

    def get_offset(self) -> str:
        return decimals(self._other.get_offset(), "de")


def svg_of(figure: Figure, words: Words | None = None) -> str:
    """As vectors, ticks in the language where it has any. Raises UlnaInputError where a label has a sign that
    Matplotlib finds in no font: it reads the first of several fonts in a file only."""
    if words is not None and language_of(words.language).comma:
        _with_commas(figure)
    file = io.StringIO()
    with warnings.catch_warnings():
        warnings.filterwarnings("error", message="Glyph .* missing from font")
        try:
            figure.savefig(file, format="svg", metadata={"Date": None, "Creator": None})
        except UserWarning as warning:
            raise UlnaInputError(
                f"PDF: a figure cannot be drawn: {warning}. An empty box is never printed. Name a folder with a font "
                "of one face that has this sign by --fonts, such as Noto Sans SC (OpenType)."
            ) from None
    return file.getvalue()


def labels(words: Words) -> Callable[..., str]:
    """Words for axes and legends."""
    return lambda key, **values: line(words(key, **values), words.language)
