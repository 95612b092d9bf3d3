"""The printed report: read back by a reader of its own, hostile names, fonts, rounding, what is not stated."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen
from hypothesis import given
from hypothesis import strategies as st
from tests.acceptance import write_plan
from tests.cli_runs import assert_bad_input, run, write_lengths
from tests.pdf_reading import Pdf, squeezed
from tests.reports import calibrated, seats_study

from ulna.document.content import Content
from ulna.document.gather import gather
from ulna.document.languages import dictionary
from ulna.document.pdf import fonts
from ulna.document.pdf.blocks import table
from ulna.document.pdf.fonts import choose
from ulna.document.pdf.render import certificate, render
from ulna.document.pdf.text import clean, name
from ulna.document.pdf.typeset import pictures, typeset
from ulna.errors import UlnaInputError
from ulna.extras import JudgedExtra
from ulna.report.digits import rounded

#: the languages of Typst, HTML and TeX, and words that are too long for any line
HOSTILE = (
    "#set page(fill: red) $x^2$ [*b*] _i_ @ref <l> \\ \"q\" 'a' & `raw` // c /* d */ = h",
    '#eval("panic()") #sys.inputs.data',
    "</text><script>alert(1)</script>",
    "W" * 90,
    "line\nbreak",
    "$\\frac{a}{b}$ {{x}} %s \\u0041",
)
ARABIC = "ذراع القياس"


@pytest.fixture(scope="module")
def lengths(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return calibrated(write_lengths(tmp_path_factory.mktemp("pdf")))


@pytest.fixture(scope="module")
def seats(tmp_path_factory: pytest.TempPathFactory) -> Content:
    """Touches with one outlier, in a placement with a hostile name."""
    study = seats_study(tmp_path_factory.mktemp("seats"), (HOSTILE[0], "there"), more='loss = "huber"\n')
    return gather(calibrated(study))


@pytest.fixture(scope="module")
def lab(root: Path) -> Path:
    return root / "examples" / "platinum" / "laboratory.toml"


@pytest.fixture(scope="module")
def signed(lengths: Path, lab: Path) -> Pdf:
    return Pdf(render(gather(lengths, laboratory=lab)))


def all_text(pdf: Pdf) -> str:
    return squeezed("".join(pdf.texts))


def holds(pdf: Pdf, *parts: str) -> None:
    text = all_text(pdf)
    for part in parts:
        assert squeezed(part) in text, part


# rounding


@pytest.mark.parametrize(
    ("value", "expanded", "unit", "shown"),
    [
        (12.34567, 0.0996, "mm", ("12.35", "0.10")),  # to two digits first, then the place
        (123.456, 9.96, "mm", ("123", "10")),
        (123.456, 9.94, "mm", ("123.5", "9.9")),
        (-1.23456, 0.0123, "mm", ("-1.235", "0.012")),
        (-0.0004, 0.012, "mm", ("0.000", "0.012")),  # no minus before a zero
        (1234.5678, 123.4, "mm", ("1230", "120")),
        (-56789.0, 1234.0, "mm", ("-56800", "1200")),
        (1.5707963, 0.0000031, "rad", ("1.5707963", "0.0000031")),
        (443.172, 0.00000025, "mm", ("443.17200000", "0.00000025")),
        (0.5, 0.0, "mm", ("0.5", "0")),
        (443.172, None, "mm", ("443.1720", "–")),
        (2.5, 10.0, "mm", ("2", "10")),  # halves to even
        (3.5, 10.0, "mm", ("4", "10")),
        (0.0, 0.012, "mm", ("0.000", "0.012")),
        (1.1456e-5, 2.34e-7, "1/K", ("1.146e-5", "2.3e-7")),
        (-1.1456e-5, 9.96e-7, "1/K", ("-1.15e-5", "1.0e-6")),
        (1e-9, 2.3e-7, "1/K", ("0", "2.3e-7")),
    ],
)
def test_rounding_by_hand(value, expanded, unit, shown):
    assert rounded(value, expanded, unit) == shown


@given(st.floats(-1e4, 1e4), st.floats(1e-9, 1e3))
def test_rounding_loses_no_more_than_half_of_the_last_place(value, expanded):
    shown, u = rounded(value, expanded, "mm")
    digits = u.replace(".", "").lstrip("0")
    assert len(digits) == 2 or (float(u) >= 100.0 and set(digits[2:]) == {"0"})
    assert len(shown.partition(".")[2]) == len(u.partition(".")[2])
    assert abs(float(u) - expanded) <= 0.0501 * expanded
    place = 10.0 ** -len(u.partition(".")[2]) if "." in u else 10.0 ** (len(u) - 2)
    assert abs(float(shown) - value) <= 0.5 * place * (1 + 1e-9) + 1e-12
    assert not (shown.startswith("-") and float(shown) == 0.0)


def test_every_parameter_is_there_with_two_digits(lengths, signed):
    known = gather(lengths).parameters
    text = all_text(signed)
    assert known.rows
    for row in known.rows:
        if row.expanded:
            shown, u = rounded(row.estimate, row.expanded, row.unit)
            assert re.search(rf"{re.escape(row.name)}{row.unit}fitted[-\d.]+{re.escape(shown)}{re.escape(u)}", text), (
                row.name
            )
        else:
            assert row.name in text
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
    count = len(signed.pages)
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
    holds(pdf, "Beispiellabor für Längen", "Kalibrierschein", f"Seite 1 von {len(pdf.pages)}")
    assert squeezed("Ausgestellt") not in squeezed(pdf.texts[0])


def test_a_fit_that_did_not_converge_says_so_first(lengths, lab):
    content = gather(lengths, laboratory=lab)
    fit = dataclasses.replace(content.fit, converged=False, termination="max-iterations")
    first = squeezed(Pdf(render(dataclasses.replace(content, fit=fit))).texts[0])
    assert first.index(squeezed("The fit did NOT converge")) < first.index("SampleWorks")


def test_without_degrees_of_freedom_there_is_no_uncertainty_and_blocks_are_judged(lengths):
    content = gather(lengths)
    rows = [dataclasses.replace(row, expanded=None, u=None, ratio=None) for row in content.parameters.rows]
    known = dataclasses.replace(content.parameters, rows=rows, k=float("nan"), degrees_of_freedom=0.0)
    block = JudgedExtra("encoder-harmonics", "length_error_mean_mm", 0.05, 0.03, 0.02, None, 1, "5", "earned", 2)
    pdf = Pdf(render(dataclasses.replace(content, parameters=known, extras=[block])))
    holds(pdf, "no uncertainty can be estimated", "encoder harmonics, order 2", "earned its place")
    assert squeezed("coverage factor") not in all_text(pdf)


def test_outliers_are_listed_and_held_parameters_have_no_uncertainty(seats):
    pdf = Pdf(render(seats))
    assert len(seats.outliers) >= 1
    holds(pdf, HOSTILE[0], "touches.csv", "Each counted as little as the table says")
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
        text = re.escape(squeezed(figure.name)) + r"\w*" + verdict + re.escape(value + expanded)
        assert re.search(text, all_text(pdf)), figure.name
        holds(pdf, figure.formula)
    holds(pdf, "in the manner of", "On the whole:", "Dashed: ± maximum permissible error", found.sha256)
    assert squeezed("No statement of conformity") not in all_text(pdf)


# text from files


@pytest.fixture(scope="module")
def hostile(lengths: Path) -> Content:
    content = gather(lengths)
    row = content.artefacts[0]
    probes = [dataclasses.replace(content.parameters.probes[0], name=each) for each in HOSTILE]
    rows = [dataclasses.replace(content.parameters.rows[-1], name=f"probe.{each}.x") for each in HOSTILE]
    return dataclasses.replace(
        content,
        arm=HOSTILE[1],
        artefacts=[dataclasses.replace(row, name=each) for each in (*HOSTILE, ARABIC)],
        samples=[dataclasses.replace(content.samples[0], artefact=HOSTILE[0])],
        parameters=dataclasses.replace(content.parameters, probes=probes, rows=rows),
    )


def test_text_from_files_is_text_and_nothing_else(hostile):
    pdf = Pdf(render(hostile))
    holds(pdf, *HOSTILE, *(f"probe.{each}.x" for each in HOSTILE))
    # of right-to-left words the glyphs are written as they stand on the page, from the left
    holds(pdf, *(word[::-1] for word in ARABIC.split()))
    assert b"1 0 0 scn" not in pdf.stream(int(re.search(rb"/Contents (\d+)", pdf.objects[pdf.pages[0]])[1]))


def test_long_words_stay_within_the_page(hostile):
    from io import BytesIO

    import numpy as np
    from PIL import Image

    ppi = 72
    data, chosen = certificate(hostile, "en")
    for page in pictures(data, chosen, ppi):
        grey = np.asarray(Image.open(BytesIO(page)).convert("L"))
        margin = int(15 / 25.4 * ppi)  # the page's own is 18 mm and wider
        assert grey[:, -margin:].min() > 250
        assert grey[:, :margin].min() > 250


def test_controls_and_overrides_are_seen_not_obeyed():
    assert clean("a\x07b\u202ec\u2069") == "a\ufffdb\ufffdc\ufffd"
    assert clean("a\tb\r\nc") == "a b\nc"
    assert name("x") == "\u2068x\u2069"
    assert clean("x" * 22) == "x" * 22
    assert clean("x" * 23) == "\u200b".join(["x" * 10, "x" * 10, "xxx"])
    assert clean("examples/platinum/study.toml") == "examples/\u200bplatinum/\u200bstudy.\u200btoml"
    assert clean("漢" * 40) == "漢" * 40


@given(st.text(max_size=60))
def test_cleaning_loses_nothing_but_controls(text):
    shown = clean(text).replace("\u200b", "")
    assert len(shown) == len(text.replace("\r\n", "\n").replace("\u200b", ""))
    kept = [
        (a, b) for a, b in zip(shown, text.replace("\r\n", "\n").replace("\u200b", ""), strict=True) if a != "\ufffd"
    ]
    assert all(a == b or (a, b) == (" ", "\t") for a, b in kept)
    assert not re.search("[\x00-\x08\x0b-\x1f\u202a-\u202e\u2066-\u2069]", shown)


# fonts


@pytest.fixture(scope="module")
def han(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with a font that has every sign of the Chinese words, each of them a square."""
    signs = sorted({sign for text in dictionary("zh").values() for sign in text if ord(sign) > 0x2000})
    pen = TTGlyphPen(None)
    for k, (x, y) in enumerate([(50, 0), (950, 0), (950, 800), (50, 800)]):
        (pen.lineTo if k else pen.moveTo)((x, y))
    pen.closePath()
    square = pen.glyph()
    names = [".notdef", *(f"u{ord(sign):04X}" for sign in signs)]
    builder = FontBuilder(1000, isTTF=True)
    builder.setupGlyphOrder(names)
    builder.setupCharacterMap({ord(sign): f"u{ord(sign):04X}" for sign in signs})
    builder.setupGlyf(dict.fromkeys(names, square))
    builder.setupHorizontalMetrics(dict.fromkeys(names, (1000, 50)))
    builder.setupHorizontalHeader(ascent=880, descent=-120)
    builder.setupNameTable({"familyName": "Squares", "styleName": "Regular", "psName": "Squares-Regular"})
    builder.setupOS2(sTypoAscender=880, sTypoDescender=-120, usWinAscent=880, usWinDescent=120)
    builder.setupPost()
    folder = tmp_path_factory.mktemp("fonts")
    builder.save(folder / "squares.ttf")
    return folder


def test_chinese_with_the_fonts_of_a_folder(lengths, han):
    content = gather(lengths)
    pdf = Pdf(render(content, "zh", han))
    holds(pdf, "校准报告", "未声明计量溯源性", f"第 1 页，共 {len(pdf.pages)} 页", "测量不确定度", "草稿，未签字")
    assert b"/Lang(zh-CN)" in pdf.content


def test_no_empty_boxes_where_no_font_has_a_sign(lengths, monkeypatch, tmp_path):
    monkeypatch.setattr(fonts, "_package", list)
    families = fonts._families
    monkeypatch.setattr(fonts, "_families", lambda places, system: [] if system else families(places, system))
    with pytest.raises(
        UlnaInputError, match=r"no font on this machine has .*U\+.*fonts-noto-cjk.*ulna\[chinese\].*--fonts"
    ):
        render(gather(lengths), "zh")
    with pytest.raises(UlnaInputError, match=r"has 𓀀 \(U\+13000\).*Debian, Ubuntu: fonts-noto\)"):
        choose(["𓀀"], tmp_path)
    assert choose(["Änderung ½ θ₀ σ × − … ذراع שלום Ω Ж"]).more == []
    with pytest.raises(UlnaInputError, match=r"option --fonts: .*none is no folder"):
        choose(["a"], tmp_path / "none")


def test_typst_itself_refuses_an_empty_box(lengths):
    data, chosen = certificate(gather(lengths), "en")
    with pytest.raises(UlnaInputError, match=r"Typst could not set it: .*could not be displayed"):
        typeset({**data, "number": "漢"}, chosen)


# the file


def test_the_same_content_gives_the_same_bytes(lengths, lab):
    first = render(gather(lengths, laboratory=lab), "de")
    assert first == render(gather(lengths, laboratory=lab), "de")
    assert b"/CreationDate(D:20260401" in first  # the day of issue, not today


def test_it_is_archivable_tagged_and_figures_are_vectors(signed):
    metadata = next(signed.stream(number) for number, body in signed.objects.items() if b"/Type/Metadata" in body)
    assert b"<pdfaid:part>2</pdfaid:part>" in metadata
    assert b"<pdfaid:conformance>A</pdfaid:conformance>" in metadata
    assert b"<pdfuaid:part>1</pdfuaid:part>" in metadata
    assert b"/MarkInfo" in signed.content
    assert b"/Subtype/Image" not in signed.content
    assert len(re.findall(rb"/Alt", signed.content)) >= 3
    holds(signed, "Figure 1", "Normal Q–Q plot", "logarithmic axis")


def logo_lab(lab: Path, folder: Path, logo: str) -> Path:
    text = lab.read_text(encoding="utf-8").replace("[laboratory]\n", f'[laboratory]\nlogo = "{logo}"\n')
    (folder / "lab.toml").write_text(text, encoding="utf-8")
    return folder / "lab.toml"


def test_a_logo_and_what_is_none(lengths, lab, tmp_path):
    from PIL import Image

    Image.new("RGB", (40, 20), "green").save(tmp_path / "logo.png")
    pdf = render(gather(lengths, laboratory=logo_lab(lab, tmp_path, "logo.png")))
    assert b"/Subtype/Image" in pdf
    (tmp_path / "text.png").write_text("no picture", encoding="utf-8")
    with pytest.raises(UlnaInputError, match=r"text\.png: is no picture.*laboratory\.logo"):
        render(gather(lengths, laboratory=logo_lab(lab, tmp_path, "text.png")))
    (tmp_path / "broken.png").write_bytes(b"\x89PNG\r\n\x1a\n broken")
    with pytest.raises(UlnaInputError, match="Typst could not set it"):
        render(gather(lengths, laboratory=logo_lab(lab, tmp_path, "broken.png")))


def test_a_table_of_no_rows_is_set(lengths):
    data, chosen = certificate(gather(lengths), "en")
    assert Pdf(typeset({**data, "blocks": [table(["a", "b"], [], [1, 0])]}, chosen)).pages


# the command


def test_the_command_writes_and_refuses(lengths, lab, tmp_path):
    out = tmp_path / "c.pdf"
    done = run("report", lengths, "--pdf", "--lab", lab, "-o", out)
    assert done.returncode == 0, done.stderr
    assert Pdf(out.read_bytes()).pages
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
