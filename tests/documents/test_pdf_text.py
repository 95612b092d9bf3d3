"""The printed report: names that are markup elsewhere, long words, fonts."""

from __future__ import annotations

import dataclasses
import json
import re
from pathlib import Path

import pytest
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen
from fontTools.ttLib import TTCollection, TTFont
from hypothesis import given
from hypothesis import strategies as st
from tests.cli_runs import write_lengths
from tests.pdf_reading import Pdf, holds, squeezed
from tests.reports import calibrated

from ulna.documents.content.content import Content
from ulna.documents.gather import gather
from ulna.documents.languages.words import dictionary
from ulna.documents.pdf import fonts
from ulna.documents.pdf.fonts import choose
from ulna.documents.pdf.render import certificate, render
from ulna.documents.pdf.text import clean, name
from ulna.documents.pdf.typeset import pictures, typeset
from ulna.ground.errors import UlnaInputError

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
    holds(pdf, *ARABIC.split())
    fills = set.union(*(pdf.fills(page) for page in range(len(pdf.texts))))
    assert fills
    assert not [colour for colour in fills if colour[0] > 0.95 and max(colour[1:]) < 0.5], "a page was set red"


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


def test_names_get_no_hyphens(lengths):
    word = "internationalisation"
    pdf = Pdf(render(dataclasses.replace(gather(lengths), arm=" ".join([word] * 12))))
    assert "".join(pdf.texts).count(word) == 12


def test_what_is_copied_has_no_places_to_break(hostile):
    texts = "".join(Pdf(render(hostile)).texts)
    assert "\u200b" in json.dumps(certificate(hostile, "en")[0], ensure_ascii=False)
    assert "result.json" in texts
    assert "\u200b" not in texts


def test_a_long_name_of_the_laboratory_stays_on_the_page(lengths, root, tmp_path):
    from io import BytesIO

    import numpy as np
    from PIL import Image

    text = (root / "examples" / "platinum" / "laboratory.toml").read_text(encoding="utf-8")
    given = f"Laboratory {'W' * 150}"
    (tmp_path / "lab.toml").write_text(text.replace("Example Laboratory for Lengths", given), encoding="utf-8")
    content = gather(lengths, laboratory=tmp_path / "lab.toml")
    pdf = Pdf(render(content))
    assert squeezed(given) in squeezed(pdf.texts[0])
    assert squeezed(f"{given[:59]}…") in squeezed(pdf.texts[1])
    data, chosen = certificate(content, "en")
    for page in pictures(data, chosen, 72)[1:]:
        assert np.asarray(Image.open(BytesIO(page)).convert("L"))[:14].min() > 250


def test_rounding_is_no_mean(hostile):
    assert not re.search(r"mean-?[\d.]+e-", Pdf(render(hostile)).all_text)


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
    holds(pdf, "校准报告", "未声明计量溯源性", f"第 1 页，共 {len(pdf.texts)} 页", "测量不确定度", "草稿，未签字")
    assert pdf.root["/Lang"] == "zh-CN"


def test_no_empty_boxes_in_figures_where_the_face_is_not_the_first(lengths, han, tmp_path, monkeypatch):
    monkeypatch.setattr(fonts, "_package", list)
    squares = TTFont(han / "squares.ttf")
    latin = TTFont(fonts._our_files()[0])
    faces = TTCollection()
    faces.fonts = [latin, squares]
    faces.save(tmp_path / "two.ttc")
    with pytest.raises(UlnaInputError, match=r"a figure cannot be drawn: Glyph .*one face.*--fonts"):
        render(gather(lengths), "zh", tmp_path)


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
