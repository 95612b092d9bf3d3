"""The printed report: read back by a reader of its own, hostile names, fonts, rounding, what is not stated."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import pytest
from tests.acceptance import write_plan
from tests.cli_runs import assert_bad_input, run, write_lengths
from tests.pdf_reading import Pdf, holds, squeezed
from tests.reports import calibrated, seats_study

from ulna.arm.unknown import Unknown
from ulna.calibration.extras import JudgedExtra
from ulna.documents.content.content import Content
from ulna.documents.gather import gather
from ulna.documents.languages.words import dictionary
from ulna.documents.pdf.blocks import table
from ulna.documents.pdf.render import certificate, render
from ulna.documents.pdf.typeset import typeset
from ulna.ground.digits import rounded
from ulna.ground.errors import UlnaInputError

MARKUP = "#set page(fill: red) $x^2$ [*b*] _i_ @ref <l> \\ \"q\" 'a' & `raw` // c /* d */ = h"


@pytest.fixture(scope="module")
def lengths(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return calibrated(write_lengths(tmp_path_factory.mktemp("pdf")))


@pytest.fixture(scope="module")
def seats(tmp_path_factory: pytest.TempPathFactory) -> Content:
    """Touches with one outlier, in a placement with a hostile name."""
    study = seats_study(tmp_path_factory.mktemp("seats"), (MARKUP, "there"), more='loss = "huber"\n')
    return gather(calibrated(study))


@pytest.fixture(scope="module")
def lab(root: Path) -> Path:
    return root / "examples" / "platinum" / "laboratory.toml"


@pytest.fixture(scope="module")
def signed(lengths: Path, lab: Path) -> Pdf:
    return Pdf(render(gather(lengths, laboratory=lab)))


def test_every_parameter_is_there_with_two_digits(lengths, signed):
    known = gather(lengths).parameters
    assert any(row.expanded for row in known.rows)
    for row in known.rows:
        assert row.name in signed.all_text
        if row.expanded:
            value, expanded = (re.escape(squeezed(each)) for each in rounded(row.estimate, row.expanded, row.unit))
            line = rf"{re.escape(row.name)}{row.unit}fitted[\d.]+{value}{expanded}"
            assert re.search(line, signed.all_text), row.name
    holds(signed, f"k = {known.k:.2f}", f"{100 * known.p:g} %", "two significant digits")


# what is said


def test_a_certificate_says_who_for_whom_and_traceable_how(signed, lab):
    first = squeezed(signed.texts[0])
    for part in (
        "Example Laboratory for Lengths",
        "Calibration certificate",
        "EX-2026-0042",
        "DRAFT, NOT SIGNED",
        "Sample Works Ltd",
        "P07-0815",
        "2026-03-30",
        "at the laboratory",
        "Laboratory instruction AA-12, issue 3",
        "Lengths are traceable to the metre",
        "EX-2025-0911",
        "20.1 °C, u = 0.2 K",
    ):
        assert squeezed(part) in first, part
    holds(
        signed, "Measurement uncertainty", "Not included", "Erika Muster", "Head of the laboratory", "Date, signature"
    )
    assert "NOT STATED" not in "".join(signed.texts)


def test_each_page_has_its_number_and_that_of_the_certificate(signed):
    count = len(signed.texts)
    assert count > 2
    for number, text in enumerate(signed.texts, start=1):
        assert squeezed(f"Page {number} of {count}") in squeezed(text)
        assert "EX-2026-0042" in text
        assert squeezed("DRAFT, NOT SIGNED") in squeezed(text)


def test_inputs_are_there_with_their_hashes(lengths, lab, signed):
    content = gather(lengths, laboratory=lab)
    assert content.laboratory is not None
    made = content.provenance
    for digest in (made.result_sha256, content.laboratory.sha256, *(file.sha256 for file in made.files)):
        assert len(digest) == 64
        holds(signed, digest)


def test_without_a_laboratory_it_is_no_certificate_and_says_so(lengths):
    pdf = Pdf(render(gather(lengths)))
    first = squeezed(pdf.texts[0])
    assert squeezed("This is no calibration certificate") in first
    assert squeezed("METROLOGICAL TRACEABILITY IS NOT STATED") in first
    assert squeezed("Calibration certificate") not in first
    holds(pdf, "There are no held-out readings", "No statement of conformity is made")


def test_what_a_laboratory_file_leaves_out_is_said(lengths, lab, tmp_path):
    text = lab.read_text(encoding="utf-8")
    less = re.sub(r"^\[traceability\]\n(?:statement.*\n)+", "", text, flags=re.M)
    less = re.sub(r"^\[\[(equipment|method)\]\]\n(?:\w.*\n)+", "", less, flags=re.M)
    less = re.sub(r"^(issued|received|order) = .*\n", "", less, flags=re.M)
    assert len(less) < len(text) - 400
    (tmp_path / "lab.toml").write_text(less, encoding="utf-8")
    pdf = Pdf(render(gather(lengths, laboratory=tmp_path / "lab.toml"), "de"))
    holds(pdf, "DIE METROLOGISCHE RÜCKFÜHRUNG IST NICHT ANGEGEBEN", "nennt keine Normale", "Verfahren nicht angegeben")
    holds(pdf, "Beispiellabor für Längen", "Kalibrierschein", f"Seite 1 von {len(pdf.texts)}")
    assert squeezed("Ausgestellt") not in squeezed(pdf.texts[0])


def test_a_fit_that_did_not_converge_says_so_first(lengths, lab):
    content = gather(lengths, laboratory=lab)
    fit = dataclasses.replace(content.fit, converged=False, termination="max-iterations")
    first = squeezed(Pdf(render(dataclasses.replace(content, fit=fit))).texts[0])
    assert first.index(squeezed("The fit did NOT converge")) < first.index("SampleWorks")


def test_without_degrees_of_freedom_there_is_no_uncertainty_and_blocks_are_judged(lengths):
    content = gather(lengths)
    rows = [dataclasses.replace(row, expanded=None, u=None, ratio=None) for row in content.parameters.rows]
    nothing = {"k": float("nan"), "degrees_of_freedom": 0.0, "unknown": Unknown("freedom")}
    known = dataclasses.replace(content.parameters, rows=rows, **nothing)
    block = JudgedExtra("encoder-harmonics", "length_error_mean_mm", 0.05, 0.03, 0.02, None, 1, "5", "earned", 2)
    pdf = Pdf(render(dataclasses.replace(content, parameters=known, extras=[block])))
    holds(pdf, "no uncertainty can be estimated", "encoder harmonics, order 2", "earned its place")
    assert squeezed("coverage factor") not in pdf.all_text


def test_outliers_are_listed_and_held_parameters_have_no_uncertainty(seats):
    pdf = Pdf(render(seats))
    assert len(seats.outliers) >= 1
    holds(pdf, MARKUP, "touches.csv", "Each counted as little as the table says")
    many = dataclasses.replace(seats, outliers=[dict(seats.outliers[0], row=k) for k in range(1000)])
    pdf = Pdf(render(many))
    holds(pdf, "960 more are in the result")
    heads = [page for page in pdf.texts if squeezed("times the scatter") in squeezed(page) and "touches.csv" in page]
    assert len(heads) >= 2, "the head of a table stands on each of its pages"


def test_an_acceptance_test_is_there_with_its_decision(lengths, tmp_path):
    write_plan(tmp_path)
    done = run("verify", tmp_path / "plan.toml", "-o", tmp_path / "tested")
    assert done.returncode in (0, 1), done.stderr
    content = gather(lengths, verified=tmp_path / "tested" / "verification.json")
    pdf = Pdf(render(content))
    found = content.verification
    assert found is not None
    figures = [figure for state in found.file.states for test in state.tests for figure in test.figures]
    assert len(figures) >= 4
    for figure in figures:
        value, expanded = rounded(figure.value, figure.expanded, "mm")
        verdict = dictionary("en")[f"conformity.{figure.verdict}"]
        text = re.escape(squeezed(figure.name)) + r"\w*" + verdict + re.escape(squeezed(value + expanded))
        assert re.search(text, pdf.all_text), figure.name
        holds(pdf, figure.formula)
    holds(
        pdf,
        "in the manner of",
        "On the whole:",
        "Dashed: ± maximum permissible error",
        content.provenance.beside[0].sha256,
    )
    assert squeezed("No statement of conformity") not in pdf.all_text


# the file


def test_the_same_content_gives_the_same_bytes(lengths, lab):
    first = render(gather(lengths, laboratory=lab), "de")
    assert first == render(gather(lengths, laboratory=lab), "de")
    assert b"/CreationDate(D:20260401" in first  # the day of issue, not today


def test_it_is_archivable_tagged_and_figures_are_vectors(signed):
    assert b"<pdfaid:part>2</pdfaid:part>" in signed.metadata
    assert b"<pdfaid:conformance>A</pdfaid:conformance>" in signed.metadata
    assert b"<pdfuaid:part>1</pdfuaid:part>" in signed.metadata
    assert signed.root["/MarkInfo"]["/Marked"]
    assert signed.root["/Lang"] == "en"
    assert signed.reader.metadata.title == "Calibration certificate"
    assert signed.reader.metadata.author == "Example Laboratory for Lengths"
    assert signed.images == 0
    assert any(each.startswith("Normal Q–Q plot") for each in signed.alternatives())
    holds(signed, "Figure 1", "Normal Q–Q plot", "logarithmic axis")


def logo_lab(lab: Path, folder: Path, logo: str) -> Path:
    text = lab.read_text(encoding="utf-8").replace("[laboratory]\n", f'[laboratory]\nlogo = "{logo}"\n')
    (folder / "lab.toml").write_text(text, encoding="utf-8")
    return folder / "lab.toml"


def test_a_logo_and_what_is_none(lengths, lab, tmp_path):
    from PIL import Image

    Image.new("RGB", (40, 20), "green").save(tmp_path / "logo.png")
    pdf = render(gather(lengths, laboratory=logo_lab(lab, tmp_path, "logo.png")))
    assert Pdf(pdf).images == 1
    (tmp_path / "text.png").write_text("no picture", encoding="utf-8")
    with pytest.raises(UlnaInputError, match=r"text\.png: is no picture.*laboratory\.logo"):
        render(gather(lengths, laboratory=logo_lab(lab, tmp_path, "text.png")))
    (tmp_path / "broken.png").write_bytes(b"\x89PNG\r\n\x1a\n broken")
    with pytest.raises(UlnaInputError, match="Typst could not set it"):
        render(gather(lengths, laboratory=logo_lab(lab, tmp_path, "broken.png")))
    vast = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + (30_000).to_bytes(4, "big") * 2
    (tmp_path / "vast.png").write_bytes(vast)
    with pytest.raises(
        UlnaInputError, match=r"vast\.png: a picture of 900 million points; expected a logo of 25 million"
    ):
        render(gather(lengths, laboratory=logo_lab(lab, tmp_path, "vast.png")))


def test_a_table_of_no_rows_is_set(lengths):
    data, chosen = certificate(gather(lengths), "en")
    assert Pdf(typeset({**data, "blocks": [table(["a", "b"], [], [1, 0])]}, chosen)).texts


# the command


def test_the_command_writes_and_refuses(lengths, lab, tmp_path):
    out = tmp_path / "c.pdf"
    done = run("report", lengths, "--pdf", "--lab", lab, "-o", out)
    assert done.returncode == 0, done.stderr
    assert Pdf(out.read_bytes()).texts
    assert_bad_input(run("report", lengths, "--pdf", "-o", out), f"{out}: exists already", "--force")
    assert run("report", lengths, "--pdf", "-o", out, "--force").returncode == 0
    done = run("report", lengths, "--pdf", "--html", "-o", tmp_path / "both")
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in (tmp_path / "both").iterdir()) == ["report.html", "report.pdf"]
    assert_bad_input(run("report", lengths, "--pdf", "-o", tmp_path / "x.html"), "names one HTML file, but pdf")
    assert_bad_input(
        run("report", lengths, "--pdf", "--lab", lab, "--language", "zh", "-o", tmp_path / "z.pdf"), "'zh'"
    )
    missing = run("report", lengths, "--pdf", "--fonts", tmp_path / "none", "-o", tmp_path / "f.pdf")
    assert_bad_input(missing, "--fonts", "is no folder")
    assert not (tmp_path / "z.pdf").exists()
    assert not (tmp_path / "f.pdf").exists()
