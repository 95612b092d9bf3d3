"""The artefacts that results rest on, of the calibration and of the acceptance test, with u and certificate."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from ulna.documents.content.content import Content
from ulna.documents.languages.text import Text, named
from ulna.documents.languages.words import Words
from ulna.documents.sections.blocks import Block, Heading, Paragraph, own, table
from ulna.ground.digits import uncertainty

COLUMNS = ("artefact", "kind", "used-in", "calibrated", "u", "certificate")


@dataclass(frozen=True)
class _Used:
    """Artefacts that are alike but for their size, in the order they came."""

    names: list[str]
    kind: str
    """Of the calibration as a study calls it; of the test "ball", or what the ends of a length are."""
    where: str
    """"calibration" or "test"."""
    dimension: str | None
    """"length", "diameter", "features" or "lengths"."""
    values_mm: list[float]
    features: int
    u_mm: float | None
    certificate: str | None

    def like(self, other: _Used) -> bool:
        """Whether the two can share a row."""
        return [self.kind, self.where, self.dimension, self.u_mm, self.certificate] == [
            other.kind,
            other.where,
            other.dimension,
            other.u_mm,
            other.certificate,
        ] and self.dimension in ("length", "diameter")


def standards(content: Content, words: Words) -> list[Block]:
    """One row for those that are alike; nothing where none is known."""
    rows: list[_Used] = []
    for each in (*_calibration(content), *_test(content)):
        if rows and rows[-1].like(each):
            rows[-1].names.extend(each.names)
            rows[-1].values_mm.extend(each.values_mm)
        else:
            rows.append(each)
    if not rows:
        return []
    title = words("standards.used")
    cells = [_row(each, words) for each in rows]
    shown = table("standards", title, words, COLUMNS, cells, left=len(COLUMNS))
    return [Heading(title), shown, Paragraph(words("standards.note"), "note")]


def _calibration(content: Content) -> Iterator[_Used]:
    for row in content.artefacts:
        values = [] if row.value_mm is None else [row.value_mm]
        certificate = _certificate(content, row.name)
        yield _Used([row.name], row.kind, "calibration", row.dimension, values, row.features, row.u_mm, certificate)


def _test(content: Content) -> Iterator[_Used]:
    """As the verify file names them."""
    for each in [] if content.verification is None else content.verification.file.artefacts:
        name, kind = str(each["name"]), str(each["kind"])
        ends = str(each.get("ends", ""))
        dimension = "diameter" if kind == "ball" else "length"
        value, u = _number(each, dimension), _number(each, "u")
        certificate = _certificate(content, name)
        yield _Used([name], ends or kind, "test", dimension, [] if value is None else [value], 0, u, certificate)


def _number(each: Mapping[str, Any], key: str) -> float | None:
    value = each.get(key)
    return float(value) if isinstance(value, int | float) else None


def _certificate(content: Content, artefact: str) -> str | None:
    """Of the standard that the laboratory file says it is."""
    known = [] if content.laboratory is None else content.laboratory.file.equipment
    return next((each.certificate for each in known if artefact in each.artefacts), None)


def _row(each: _Used, words: Words) -> list[Text]:
    u: Text = own("–")
    if each.u_mm is not None and each.dimension is not None:
        u = own(f"{uncertainty(each.u_mm)} mm") if each.u_mm else words("artefact.u-none")
    certificate = words("laboratory.not-stated") if each.certificate is None else named(each.certificate)
    return [
        named(", ".join(each.names)),
        words(f"kind.{each.kind}" if words.has(f"kind.{each.kind}") else "kind.length"),
        words(f"standards.in-{each.where}"),
        _calibrated(each, words),
        u,
        certificate,
    ]


def _calibrated(each: _Used, words: Words) -> Text:
    if each.dimension is None:
        return words("dimension.unknown" if each.u_mm is None else "dimension.none")
    values = own("; ".join(f"{value:.10g}" for value in each.values_mm))
    return words(f"dimension.{each.dimension}", value=values, features=each.features)
