"""A calibration certificate as bytes, on paper or for software: one call, from the same files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from ulna.documents.laboratory.issued import Issued
from ulna.ground.errors import UlnaInputError


@dataclass(frozen=True)
class _Asked:
    """What a certificate is made from, and how it is to look."""

    result: Path
    laboratory: Path
    verification: list[Path]
    issued: Issued | None
    language: str
    annex: bool
    study: Path | None
    evaluation: Path | None
    cross_validation: Path | None
    fonts: Path | None
    look: bool


def certificate(
    result: str | Path,
    laboratory: str | Path,
    verification: Sequence[str | Path] = (),
    *,
    form: str = "pdf",
    issued: Issued | None = None,
    language: str = "en",
    annex: bool = False,
    study: str | Path | None = None,
    evaluation: str | Path | None = None,
    cross_validation: str | Path | None = None,
    fonts: str | Path | None = None,
    look: bool = True,
) -> bytes:
    """A certificate of a result.json (or its folder) and a laboratory file, the same bytes for the same files.

    form: "pdf", or "dcc" for PTB's XML, which has the languages of the laboratory file. issued: that it was issued,
    by whom; without it the certificate says on every page that it is a draft. verification: files that `ulna verify`
    wrote, of the same arm. Of the PDF alone: language; annex: with how the fit went, plots and outliers behind the
    certificate; study, evaluation, cross_validation, fonts: as `ulna report` takes
    them; look: for a study that nobody named, by its path in the result.

    Raises UlnaInputError for files that cannot be used, and for a calibration that did not converge.
    """

    def path(given: str | Path | None) -> Path | None:
        return None if given is None else Path(given)

    if form not in FORMS:
        raise UlnaInputError(f"form {form!r}: expected one of {', '.join(FORMS)}. Choose one of these.")
    return FORMS[form](
        _Asked(
            Path(result),
            Path(laboratory),
            [Path(each) for each in verification],
            issued,
            language,
            annex,
            path(study),
            path(evaluation),
            path(cross_validation),
            path(fonts),
            look,
        )
    )


def _pdf(asked: _Asked) -> bytes:
    from ulna.documents.certified.source import certified_result
    from ulna.documents.gather import gather
    from ulna.documents.pdf.render import render
    from ulna.documents.sources.result import result_file

    certified_result(result_file(asked.result))
    content = gather(
        asked.result,
        asked.study,
        asked.cross_validation,
        asked.evaluation,
        asked.laboratory,
        asked.verification,
        issued=asked.issued,
        look=asked.look,
    )
    return render(content, asked.language, asked.fonts, asked.annex)


def _dcc(asked: _Asked) -> bytes:
    from ulna.documents.dcc.document import dcc_certificate

    return dcc_certificate(asked.result, asked.laboratory, asked.verification, issued=asked.issued).content


FORMS: dict[str, Callable[[_Asked], bytes]] = {"pdf": _pdf, "dcc": _dcc}
"""Form → how a certificate becomes one."""
