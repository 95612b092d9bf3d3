"""Plots with their captions; how they are drawn, and what of very many points is shown, is each medium's."""

from __future__ import annotations

from ulna.documents.content.acceptance import Verification
from ulna.documents.content.clouds import Cloud
from ulna.documents.content.content import Content
from ulna.documents.content.distribution import Sample
from ulna.documents.languages.text import Text, joined
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Drawing, Drawings, Paragraph, own
from ulna.ground.digits import decimals, fixed


def distributions(content: Content, words: Words) -> list[Block]:
    """Histogram and Q–Q plot of each sample."""
    drawings = [each for k, sample in enumerate(content.samples) for each in _sample(k, sample, words)]
    note = Paragraph(words("distribution.note"), "note")
    return [note, Drawings(drawings, narrow=True)] if drawings else [note]


def _sample(k: int, sample: Sample, words: Words) -> list[Drawing]:
    said = {"artefact": sample.artefact, "kind": words(f"sample.{sample.kind}")}
    # the mean to the last place of the standard deviation: what is rounding is shown as zero
    mean = own(fixed(sample.mean_mm, decimals(sample.sigma_mm, "mm") + 2)) if sample.sigma_mm else sample.mean_mm
    numbers = {"count": len(sample.value_mm), "mean": mean, "sigma": sample.sigma_mm}
    return [
        Drawing("histogram", f"histogram-{k}", sample, words("distribution.histogram", **said, **numbers)),
        Drawing("quantiles", f"quantiles-{k}", sample, words("distribution.qq", **said)),
    ]


def clouds(content: Content, words: Words, *over: str) -> list[Drawing]:
    """Over "joint", "reach" or "temperature"; their captions are what is shown of them."""
    return [_cloud(each, words) for key in over for each in content.clouds if each.over == key]


def _cloud(cloud: Cloud, words: Words) -> Drawing:
    heading: Text = words("joint.number", joint=cloud.joint) if cloud.over == "joint" else ()
    return Drawing("cloud", f"{cloud.over}-{cloud.joint}", cloud, heading=heading)


def before_after(content: Content, words: Words) -> list[Block]:
    """RMS of each quantity, where both are known."""
    pairs = [row for row in content.quality if row.before is not None and row.after is not None]
    known = [row for row in pairs if row.before and row.before.rms_mm > 0.0 and row.after and row.after.rms_mm > 0.0]
    if not known:
        return []
    return [Drawings([Drawing("before-after", "before-after", known, words("plot.before-after"))])]


def ratios(content: Content, words: Words) -> list[Block]:
    """How far the fitted parameters moved, where uncertainties are known."""
    if all(row.ratio is None for row in content.parameters.rows):
        return []
    return [Drawings([Drawing("ratios", "ratios", content.parameters, words("plot.ratio"))])]


def lengths(content: Content, words: Words) -> list[Block]:
    """Length errors of the fitted readings."""
    found = content.lengths
    if found is None or not len(found.error_mm):
        return []
    return [Drawings([Drawing("lengths", "lengths", found, words("lengths.note", count=len(found.error_mm)))])]


def tested_lengths(found: Verification, words: Words) -> list[Block]:
    """Length errors of each test of lengths, with limits and guard bands."""
    drawings = []
    for k, each in enumerate(found.lengths):
        if len(each.error_mm):
            said = {"figure": each.figure, "test": each.test, "state": words(f"state.{each.state}")}
            caption = words("verification.lengths", **said, count=len(each.error_mm))
            limits: Text = words("verification.no-mpe") if each.a_mm is None else ()
            drawings.append(Drawing("tested-lengths", f"tested-{k}", each, joined([caption, limits], " ")))
    return [Drawings(drawings)] if drawings else []


def poses(content: Content) -> list[Block]:
    """The size of each residual, in the order of the study."""
    if not len(content.readings.size_mm):
        return []
    return [Drawings([Drawing("poses", "poses", content.readings)])]


def arm(content: Content, words: Words) -> list[Block]:
    """The arm itself, in a pose of the readings."""
    return [Drawings([Drawing("arm", "arm", content.standing, words.say(content.standing.said))])]


def space(content: Content) -> list[Block]:
    """Residual vectors at the tips."""
    return [] if content.quiver is None else [Drawings([Drawing("space", "space", content.quiver)])]
