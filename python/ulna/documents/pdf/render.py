"""The printed report, whole: first page, results, figures, signatures."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from ulna.documents.content import Content
from ulna.documents.html.markup import END, ISOLATE
from ulna.documents.languages.words import Words, dictionary
from ulna.documents.pdf import acceptance as tested
from ulna.documents.pdf import blocks, head, results
from ulna.documents.pdf import plots as figures
from ulna.documents.pdf.blocks import Block
from ulna.documents.pdf.fonts import Chosen, choose
from ulna.documents.pdf.text import clean, name, words_for_paper
from ulna.documents.pdf.typeset import typeset
from ulna.ground.digits import decimals, fixed

#: language → region, which decides how Typst sets Chinese
REGIONS = {"zh": "cn"}
_BEGIN, _END = "\ue000", "\ue001"
"""Stand for the numbers of a page until the template puts them in; no text of a file reaches that sentence."""


def render(content: Content, language: str = "en", fonts: Path | None = None) -> bytes:
    """The PDF (PDF/A-2a, PDF/UA-1). The same content gives the same bytes.

    fonts: a folder with fonts to look at before those of the machine. Raises UlnaInputError where no font has a
    character that the page needs, or the laboratory file has no text in this language.
    """
    data, chosen = certificate(content, language, fonts)
    return typeset(data, chosen)


def certificate(content: Content, language: str, fonts: Path | None = None) -> tuple[dict[str, Any], Chosen]:
    """What the template is given, and the fonts that have all of it."""
    words = words_for_paper(language)
    made = content.provenance
    signed = content.laboratory is not None
    data: dict[str, Any] = {
        "lang": language,
        "region": REGIONS.get(language),
        "title": words("paper.title") if signed else words("title"),
        "author": (head.issuer(content, words) or name(f"{made.program} {made.version}")).strip(ISOLATE + END),
        "issuer": head.running_issuer(content, words) or words("title"),
        "number": head.identifier(content),
        "date": head.date(content),
        "program": f"{name(made.program)} {name(made.version)}",
        "letterhead": head.letterhead(content, words),
        "labels": {
            "number": words("laboratory.identifier") if signed else words("provenance.result"),
            "draft": words("paper.draft"),
            "sign": words("paper.sign"),
            "page": _page_label(words),
        },
        "blocks": [
            *head.first_page(content, words),
            *results.ending(content, words),
            *results.parameters(content, words),
            *results.determined(content, words),
            *results.extras(content, words),
            *results.quality(content, words),
        ],
    }
    uncertainty = [*tested.decision(content, words), *results.uncertainty_statement(content, words)]
    after: list[Block] = [
        *results.artefacts(content, words),
        *results.outliers(content, words),
        *results.provenance(content, words),
        blocks.heading(words("section.signature")),
        blocks.paragraph(words("paper.draft-note", program=made.program, version=made.version)),
        blocks.paragraph(words("decimal-note"), "note"),
        {"kind": "signatures", "people": head.people(content)},
    ]
    # labels of figures are words of the dictionary: all of them, so that fonts are known before they are drawn
    said = [*_texts(data), *_texts(uncertainty), *_texts(after), *dictionary(language).values(), *_captions_of(content)]
    chosen = choose(said, fonts)
    data["fonts"] = chosen.order(language)
    data["logo"] = head.logo(content, words)
    with figures.looks([family.regular for family in chosen.more]):
        data["blocks"] += [*_before_after(content, words), *tested.verification(content, words), *uncertainty]
        data["blocks"] += [*_figures(content, words), *after]
    return data, chosen


def _page_label(words: Words) -> list[str]:
    """The text before, between and after the two numbers."""
    before, rest = words("paper.page", page=_BEGIN, pages=_END).split(f"\u2068{_BEGIN}\u2069")
    between, after = rest.split(f"\u2068{_END}\u2069")
    return [before, between, after]


def _captions_of(content: Content) -> list[str]:
    """What files say beside figures, which are drawn when the fonts are known."""
    said = [sample.artefact for sample in content.samples]
    if content.verification is not None:
        said += _texts(content.verification.file.model_dump(mode="json"))
    return [clean(each) for each in said]


def _before_after(content: Content, words: Words) -> list[Block]:
    pair = figures.before_after(content.quality, words)
    return [] if pair is None else [blocks.figures([blocks.figure(pair, words("paper.before-after"))], 1)]


def _figures(content: Content, words: Words) -> list[Block]:
    page = [*_distributions(content, words), *_clouds(content, words)]
    ratio = figures.ratios(content.parameters, words)
    if ratio is not None:
        page.append(blocks.heading(words("paper.moved")))
        page.append(blocks.figures([blocks.figure(ratio, words("paper.ratio"))], 1))
    if content.lengths is not None and len(content.lengths.error_mm):
        svg, said = figures.lengths(content.lengths, words)
        caption = " ".join([words("lengths.note", count=len(content.lengths.error_mm)), *said])
        page.append(blocks.heading(words("section.lengths")))
        page.append(blocks.figures([blocks.figure(svg, caption)], 1))
    return page


def _distributions(content: Content, words: Words) -> list[Block]:
    found = []
    for sample in content.samples:
        said = {"artefact": sample.artefact, "kind": words(f"sample.{sample.kind}")}
        # the mean to the last place of the standard deviation: what is rounding is shown as zero
        mean = fixed(sample.mean_mm, decimals(sample.sigma_mm, "mm") + 2) if sample.sigma_mm else sample.mean_mm
        numbers = {"count": len(sample.value_mm), "mean": mean, "sigma": sample.sigma_mm}
        found.append(
            blocks.figure(figures.histogram(sample, words), words("distribution.histogram", **said, **numbers))
        )
        found.append(blocks.figure(figures.quantiles(sample, words), words("distribution.qq", **said)))
    if not found:
        return []
    return [
        blocks.heading(words("section.distribution")),
        blocks.paragraph(words("distribution.note"), "lead"),
        blocks.figures(found, 2),
    ]


def _clouds(content: Content, words: Words) -> list[Block]:
    over_joints = []
    for each in content.clouds:
        if each.over == "joint":
            svg, said = figures.cloud(each, content.readings, words)
            over_joints.append(blocks.figure(svg, " ".join([f"{words('joint.number', joint=each.joint)}:", *said])))
    page = [blocks.heading(words("section.joints"))]
    if over_joints:
        legend = words("paper.cloud-legend")
        page += [blocks.paragraph(f"{words('joints.note')} {legend}", "lead"), blocks.figures(over_joints, 2)]
    lacking = [content.missing[key] for key in ("study", "joint") if key in content.missing]
    return [*page, *(blocks.paragraph(words.say(each), "missing") for each in lacking)]


def _texts(value: Any) -> Iterator[str]:
    """All strings within."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, dict):
        for each in value.values():
            yield from _texts(each)
    elif isinstance(value, Iterable):
        for each in value:
            yield from _texts(each)
