"""The figures of the printed report, as vectors. Names of files stand in their captions, which Typst sets."""

from __future__ import annotations

import io
import math
import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib import font_manager, rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullLocator

from ulna.documents.acceptance import limit_lines
from ulna.documents.content import Cloud, Lengths, Parameters, QualityRow, ReadingRows, Sample, TestedLengths
from ulna.documents.languages.words import Words
from ulna.documents.thinning import shown, shown_ranks
from ulna.ground.errors import UlnaInputError
from ulna.ground.style import BLUE, GREEN, GREY, STYLE, VERMILION

INCH_MM = 25.4
WIDTH_MM = 170.0
HALF_MM = 82.0
"""Of a figure with another beside it."""
MOST_POINTS = 600
"""Of one cloud; besides them all outliers."""
MOST_RANKS = 600
TAILS = 50
LONGEST_LABEL = 30
#: verdict → shape and colour of its marks
VERDICTS = {"pass": ("o", BLUE), "undecided": ("D", GREEN), "fail": ("X", VERMILION), None: ("o", GREY)}


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


def _axes(width_mm: float, height_mm: float) -> tuple[Figure, Axes]:
    figure = Figure(figsize=(width_mm / INCH_MM, height_mm / INCH_MM), layout="constrained")
    axes: Axes = figure.subplots()
    axes.grid(color="0.9", linewidth=0.5)
    axes.set_axisbelow(True)
    return figure, axes


def _svg(figure: Figure) -> str:
    """Raises UlnaInputError where a label has a sign that Matplotlib finds in no font: it reads the first of several
    fonts in a file only."""
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


def histogram(sample: Sample, words: Words) -> str:
    """Bars and the normal curve of the sample's mean and standard deviation."""
    figure, axes = _axes(HALF_MM, 50.0)
    edges, width = sample.edges_mm, np.diff(sample.edges_mm)
    axes.bar(edges[:-1], sample.counts, width, align="edge", color=BLUE, edgecolor="white", linewidth=0.4)
    if sample.sigma_mm > 0.0:
        x = np.linspace(edges[0], edges[-1], 201)
        z = (x - sample.mean_mm) / sample.sigma_mm
        normal = np.exp(-0.5 * z**2) / (sample.sigma_mm * math.sqrt(2.0 * math.pi)) * width[0] * len(sample.value_mm)
        axes.plot(x, normal, color="black", linestyle="--", label=words("legend.normal"))
        axes.legend(loc="upper right", fontsize=6.5)
        axes.set_ylim(0, 1.25 * max(float(normal.max()), float(sample.counts.max())))
    axes.set_xlabel(words("axis.error-mm"))
    axes.set_ylabel(words("axis.count"))
    return _svg(figure)


def quantiles(sample: Sample, words: Words) -> str:
    """Normal Q–Q plot."""
    figure, axes = _axes(HALF_MM, 50.0)
    kept = shown_ranks(len(sample.ordered_mm), MOST_RANKS, TAILS)
    ends = sample.quantile[[0, -1]]
    axes.plot(
        sample.quantile[kept], sample.ordered_mm[kept], ".", color=BLUE, markersize=3, label=words("legend.readings")
    )
    axes.plot(
        ends, sample.mean_mm + sample.sigma_mm * ends, color="black", linestyle="--", label=words("legend.normal")
    )
    axes.legend(loc="upper left", fontsize=6.5)
    axes.set_xlabel(words("axis.normal-quantile"))
    axes.set_ylabel(words("axis.error-mm"))
    return _svg(figure)


def cloud(found: Cloud, readings: ReadingRows, words: Words) -> tuple[str, list[str]]:
    """Readings, outliers and means over one cause; the picture and what its caption must say of what is shown."""
    figure, axes = _axes(HALF_MM, 47.0)
    outlier = readings.outlier[found.reading]
    part = shown(outlier, MOST_POINTS)
    plain = part.index[~outlier[part.index]]
    most = 1.15 * float(np.abs(found.residual_mm[~outlier]).max(initial=0.0))
    axes.plot(found.x[plain], found.residual_mm[plain], ".", color=BLUE, markersize=2.5, alpha=0.6, markeredgewidth=0)
    beyond = outlier & (np.abs(found.residual_mm) > most) if most > 0.0 else np.zeros(len(outlier), dtype=bool)
    near = outlier & ~beyond
    axes.plot(found.x[near], found.residual_mm[near], "x", color=VERMILION, markersize=4)
    for sign, marker in ((1.0, "^"), (-1.0, "v")):
        own = beyond & (sign * found.residual_mm > 0.0)
        axes.plot(found.x[own], np.full(int(own.sum()), sign * most), marker, color=VERMILION, markersize=4)
    if len(found.trend.x):
        axes.errorbar(
            found.trend.x,
            found.trend.mean_mm,
            2.0 * found.trend.u_mm,
            fmt="D",
            color="black",
            markersize=2.5,
            linewidth=0.8,
        )
    signed = found.over == "joint"
    if most > 0.0:
        axes.set_ylim(-1.08 * most if signed else 0.0, 1.08 * most)
    axes.set_xlabel(_cause(found, words))
    axes.set_ylabel(words("axis.along-joint-mm" if signed else "axis.size-mm"))
    said: list[str] = [words.say(part.said)]
    if beyond.any():
        said.append(words("shown.beyond", beyond=int(beyond.sum())))
    return _svg(figure), said


def _cause(found: Cloud, words: Words) -> str:
    if found.over == "joint":
        return words("axis.joint-deg", joint=found.joint)
    if found.over == "reach":
        return words("axis.reach-mm")
    return words("axis.temperature-joint", joint=found.joint) if found.joint else words("axis.temperature")


def before_after(rows: Sequence[QualityRow], words: Words) -> str | None:
    """RMS of each quantity before and after, on a logarithmic axis; None where there is no such pair."""
    pairs = [
        (row, row.before.rms_mm, row.after.rms_mm)
        for row in rows
        if row.before is not None and row.after is not None and row.before.rms_mm > 0.0 and row.after.rms_mm > 0.0
    ]
    if not pairs:
        return None
    figure, axes = _axes(WIDTH_MM, 16.0 + 9.0 * len(pairs))
    y = np.arange(len(pairs))[::-1]
    before, after = (np.array([pair[k] for pair in pairs], dtype=np.float64) for k in (1, 2))
    axes.hlines(y, after, before, color="0.7", linewidth=1.5)
    axes.plot(before, y, "s", color=GREY, markersize=5, label=words("legend.before"))
    axes.plot(after, y, "o", color=BLUE, markersize=5.5, label=words("legend.after"))
    axes.set_xscale("log")
    low, high = math.log10(min(before.min(), after.min())), math.log10(max(before.max(), after.max()))
    axes.set_xlim(10.0 ** (math.floor(low * 2 - 0.2) / 2), 10.0 ** (math.ceil(high * 2 + 0.2) / 2))
    axes.set_yticks(
        y, [f"{words(f'quantity.{row.quantity}')}\n{words(f'readings.{row.readings}')}" for row, *_ in pairs]
    )
    axes.set_ylim(-0.6, len(pairs) - 0.4)
    axes.set_xlabel(words("axis.rms-mm"))
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, fontsize=7)
    return _svg(figure)


def ratios(parameters: Parameters, words: Words) -> str | None:
    """(estimate - nominal) / u of each fitted parameter; None where no uncertainty is known."""
    rows = [(number, row) for number, row in enumerate(parameters.rows, start=1) if row.ratio is not None]
    if not rows:
        return None
    figure, axes = _axes(WIDTH_MM, 14.0 + 3.9 * len(rows))
    y = np.arange(len(rows))[::-1]
    value = np.array([row.ratio for _, row in rows], dtype=np.float64)
    axes.axvspan(-2.0, 2.0, color=GREEN, alpha=0.15, linewidth=0)
    axes.hlines(y, 0.0, value, color=BLUE, linewidth=1.0)
    axes.plot(value, y, "o", color=BLUE, markersize=3.5)
    axes.axvline(0.0, color="black", linewidth=0.6)
    axes.set_xscale("symlog", linthresh=4.0, linscale=1.0)
    most = 1.6 * max(float(np.abs(value).max()), 4.0)
    axes.set_xlim(-most, most)
    decades = math.floor(math.log10(most))
    powers = range(1, decades + 1, max(math.ceil(decades / 5), 1))
    ticks = [
        (sign * 10.0**power, f"{'−' if sign < 0 else ''}10{_power(power)}") for sign in (-1, 1) for power in powers
    ]
    ticks += [(-2.0, "−2"), (0.0, "0"), (2.0, "2")]
    axes.set_xticks([at for at, _ in ticks], [label for _, label in ticks])
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_yticks(y, [_label(number, row.name) for number, row in rows], parse_math=False, fontsize=6.5)
    axes.set_ylim(-0.7, len(rows) - 0.3)
    axes.set_xlabel(words("column.ratio"))
    return _svg(figure)


def _power(power: int) -> str:
    """As an exponent; of 1 none."""
    return "" if power == 1 else "".join("⁰¹²³⁴⁵⁶⁷⁸⁹"[int(digit)] for digit in str(power))


def _label(number: int, name: str) -> str:
    """Number in the table, and the name where it is plain and short enough to be drawn letter by letter."""
    plain = name.isascii() and name.isprintable() and len(name) <= LONGEST_LABEL
    return f"{name}  {number}" if plain else f"{number}"


def lengths(found: Lengths, words: Words) -> tuple[str, list[str]]:
    """Length errors over lengths; the picture and what its caption must say of what is shown."""
    figure, axes = _axes(WIDTH_MM, 55.0)
    part = shown(np.zeros(len(found.error_mm), dtype=bool), 2 * MOST_POINTS)
    length = found.length_mm[part.index]
    axes.axhline(0.0, color="0.6", linewidth=0.8)
    axes.plot(length, found.error_mm[part.index], ".", color=BLUE, markersize=3.5)
    if float(np.ptp(length)) == 0.0:  # one length: an axis that is not made of rounding
        axes.set_xlim(0.9 * float(length[0]), 1.1 * float(length[0]))
    axes.set_xlabel(words("axis.length-mm"))
    axes.set_ylabel(words("axis.length-error-mm"))
    return _svg(figure), [words.say(part.said)] if part.step > 1 else []


def tested_lengths(found: TestedLengths, words: Words) -> str:
    """Length errors of an acceptance test, with ±MPE and the guard bands about them."""
    figure, axes = _axes(WIDTH_MM, 62.0)
    lines = limit_lines(found)
    axes.axhline(0.0, color="0.6", linewidth=0.8)
    if lines is not None:
        x, limit, guard = lines
        for side in (1.0, -1.0):
            first = side > 0.0
            if guard.any():
                label = words("legend.guard") if first else None
                band = (side * (limit - guard), side * (limit + guard))
                axes.fill_between(x, *band, color=GREY, alpha=0.22, linewidth=0, label=label)
            axes.plot(x, side * limit, "--", color="black", linewidth=1.0, label=words("legend.mpe") if first else None)
        axes.set_xlim(x[0], x[-1])
    for verdict, (marker, colour) in VERDICTS.items():
        own = np.array([each == verdict for each in found.verdict], dtype=bool)
        if own.any():
            label = words(f"conformity.{verdict or 'none'}")
            axes.plot(found.length_mm[own], found.error_mm[own], marker, color=colour, markersize=3.5, label=label)
    axes.set_xlabel(words("axis.length-mm"))
    axes.set_ylabel(words("axis.length-error-mm"))
    figure.legend(loc="outside upper center", ncols=6, fontsize=7)
    return _svg(figure)
