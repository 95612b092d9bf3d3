"""Plots of residuals on paper: their distribution, and over what may cause them."""

from __future__ import annotations

from ulna.documents.content.clouds import Cloud
from ulna.documents.content.distribution import Sample
from ulna.documents.content.readings import ReadingRows
from ulna.documents.drawn import residuals
from ulna.documents.languages.text import Text
from ulna.documents.languages.words import Words
from ulna.documents.pdf.canvas import HALF_MM, axes_of, labels, svg_of


def histogram(sample: Sample, words: Words) -> str:
    """Bars and the normal curve of the sample's mean and standard deviation."""
    figure, axes = axes_of(HALF_MM, 50.0)
    residuals.histogram(axes, sample, labels(words))
    return svg_of(figure, words)


def quantiles(sample: Sample, words: Words) -> tuple[str, list[Text]]:
    """Normal Q–Q plot; the picture and what its caption must say of what is shown."""
    figure, axes = axes_of(HALF_MM, 50.0)
    kept, count = residuals.quantiles(axes, sample, labels(words)), len(sample.ordered_mm)
    few = words("shown.quantiles", shown=kept, count=count, tails=residuals.TAILS)
    return svg_of(figure, words), [few] if kept < count else []


def cloud(found: Cloud, readings: ReadingRows, words: Words) -> tuple[str, list[Text]]:
    """Readings, outliers and means over one cause; the picture and what its caption must say of what is shown."""
    figure, axes = axes_of(HALF_MM, 47.0)
    part, beyond = residuals.cloud(axes, found, readings, labels(words))
    said = [words.say(part.said)]
    if beyond:
        said.append(words("shown.beyond", beyond=beyond))
    return svg_of(figure, words), said
