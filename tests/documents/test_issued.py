"""That a certificate was issued: its number, day and people take the place of the draft, on paper and in XML."""

from __future__ import annotations

import dataclasses
import datetime
import json
from pathlib import Path

import pytest
from tests import dcc_reading as reading
from tests.certificates import EVERY_KEY, EXAMPLE, RESULT
from tests.cli_runs import write_lengths
from tests.pdf_reading import Pdf, holds, squeezed
from tests.reports import calibrated

import ulna
from ulna.documents.gather import gather
from ulna.documents.pdf.render import render

HEAD = "0123456789abcdef" * 4
ISSUED = ulna.Issued(
    number="K-2026-7",
    issued_at=datetime.datetime(2026, 4, 3, 17, 30, tzinfo=datetime.UTC),
    issued_by="Jan Beispiel",
    approved_by="Erika Muster",
    supersedes="K-2026-5",
    audit_head=HEAD,
)


@pytest.fixture(scope="module")
def lengths(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return calibrated(write_lengths(tmp_path_factory.mktemp("issued")))


@pytest.mark.parametrize("language", ["en", "de"])
def test_on_paper_it_is_no_draft_and_has_its_number(lengths: Path, language: str) -> None:
    pdf = Pdf(ulna.certificate(lengths, EXAMPLE, issued=ISSUED, language=language))
    text = pdf.all_text
    assert not any(squeezed(word) in text for word in ("DRAFT", "ENTWURF", "Date, signature", "Datum, Unterschrift"))
    assert "EX20260042" not in text
    holds(pdf, "2026-04-03", "Erika Muster", "Jan Beispiel", HEAD)
    assert squeezed("2026-04-01") not in text, "the laboratory file's day of issue"
    assert all(squeezed("K-2026-7") in squeezed(page) for page in pdf.texts)
    said = {"en": "Replaces the certificate K-2026-5", "de": "Ersetzt den Kalibrierschein K-2026-5"}
    assert squeezed(said[language]) in squeezed(pdf.texts[0])


def test_not_issued_it_is_a_draft(lengths: Path) -> None:
    pdf = Pdf(ulna.certificate(lengths, EXAMPLE))
    assert all(squeezed("DRAFT, NOT SIGNED") in squeezed(page) for page in pdf.texts)
    holds(pdf, "EX-2026-0042", "Date, signature")
    assert HEAD not in pdf.all_text


def test_in_xml_it_has_the_same(lengths: Path) -> None:
    draft = ulna.certificate(lengths, EXAMPLE, form="dcc").decode()
    made = ulna.certificate(lengths, EXAMPLE, form="dcc", issued=ISSUED).decode()
    assert "unsigned draft" in draft
    assert "unsigned draft" not in made
    for part in (
        "<dcc:uniqueIdentifier>K-2026-7<",
        "<dcc:issueDate>2026-04-03<",
        "<dcc:replacedUniqueIdentifier>K-2026-5<",
        f">{HEAD}<",
        "issued by Jan Beispiel on 2026-04-03 and authorised by Erika Muster",
    ):
        assert part in made, part
        assert part not in draft, part


@pytest.mark.shared_data
def test_issued_xml_is_valid(shared_data: Path) -> None:
    from lxml import etree

    folder = shared_data / "dcc-xsd"
    if not folder.is_dir():
        pytest.skip(f"PTB's schema is not at hand: {folder} is not there")
    issued = dataclasses.replace(ISSUED, supersedes=None)
    schema = reading.schema(folder)
    content = ulna.certificate(RESULT, EVERY_KEY, form="dcc", issued=issued)
    assert schema.validate(etree.fromstring(content)), schema.error_log


def test_who_issues_authorises_where_nobody_else_does(lengths: Path) -> None:
    alone = dataclasses.replace(ISSUED, approved_by=None, audit_head=None, supersedes=None)
    assert alone.authorised_by == "Jan Beispiel"
    holds(Pdf(ulna.certificate(lengths, EXAMPLE, issued=alone)), "Authorised by Jan Beispiel")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"number": " "}, "number is ' '; expected a text of one line"),
        ({"issued_by": "a\nb"}, "issued_by is .*; expected a text of one line"),
        ({"approved_by": "a\x07"}, "approved_by is .*; expected a text of one line"),
        ({"issued_at": "2026-04-03"}, "issued_at is '2026-04-03'; expected a datetime.date"),
        ({"audit_head": HEAD.upper()}, "audit_head is .*; expected 64 hexadecimal digits"),
        ({"audit_head": HEAD[:-1]}, "audit_head is .*; expected 64 hexadecimal digits"),
        ({"supersedes": "K-2026-7"}, "would supersede itself"),
    ],
)
def test_what_cannot_stand_on_a_certificate_is_refused(change: dict[str, object], message: str) -> None:
    with pytest.raises(ulna.UlnaInputError, match=message):
        dataclasses.replace(ISSUED, **change)  # type: ignore[arg-type]


def test_contradictions_are_refused(lengths: Path, tmp_path: Path) -> None:
    early = dataclasses.replace(ISSUED, issued_at=datetime.date(2026, 3, 30))
    with pytest.raises(ulna.UlnaInputError, match=r"certificate\.end.*2026-03-31.*issued on 2026-03-30"):
        ulna.certificate(lengths, EXAMPLE, issued=early)
    text = EXAMPLE.read_text(encoding="utf-8")
    text = text.replace(
        "[laboratory]", '[certificate.replaces]\nidentifier = "K-1"\nchange = "amended"\n[laboratory]', 1
    )
    (tmp_path / "lab.toml").write_text(text, encoding="utf-8")
    with pytest.raises(ulna.UlnaInputError, match=r"certificate\.replaces.*names K-1.*supersedes K-2026-5"):
        ulna.certificate(lengths, tmp_path / "lab.toml", issued=ISSUED)
    kept = dataclasses.replace(ISSUED, supersedes=None)
    holds(Pdf(ulna.certificate(lengths, tmp_path / "lab.toml", issued=kept)), "Amends the certificate K-1")


def test_what_did_not_converge_or_has_no_laboratory_is_never_issued(lengths: Path, tmp_path: Path) -> None:
    with pytest.raises(ulna.UlnaInputError, match=r"K-2026-7: no laboratory file was given"):
        gather(lengths, issued=ISSUED)
    document = json.loads(lengths.read_text(encoding="utf-8"))
    document["fit"] |= {"converged": False, "termination": "max-iterations"}
    (tmp_path / "result.json").write_text(json.dumps(document), encoding="utf-8")
    for form in ("pdf", "dcc"):
        with pytest.raises(ulna.UlnaInputError, match="did not converge"):
            ulna.certificate(tmp_path, EXAMPLE, form=form, issued=ISSUED)
    with pytest.raises(ulna.UlnaInputError, match="form 'doc': expected one of pdf, dcc"):
        ulna.certificate(lengths, EXAMPLE, form="doc")


def test_the_end_is_marked_on_the_last_page_alone(lengths: Path) -> None:
    for language, end in (("en", "End of the calibration certificate"), ("de", "Ende des Kalibrierscheins")):
        pages = [squeezed(page) for page in Pdf(ulna.certificate(lengths, EXAMPLE, language=language)).texts]
        assert [squeezed(end) in page for page in pages] == [False] * (len(pages) - 1) + [True]
    holds(Pdf(render(gather(lengths))), "End of the report")
