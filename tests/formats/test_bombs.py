"""Small files that would unpack to any size are refused in words before they do."""

from __future__ import annotations

import base64
import io
import struct
import zipfile
import zlib
from pathlib import Path

import numpy as np
import openpyxl
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io
from tests.foreign_tables import cells

from ulna.documents.pdf.picture_size import MOST_PIXELS, pixels
from ulna.documents.pdf.svg_size import too_large
from ulna.formats import toml
from ulna.formats.layout import Layout
from ulna.formats.table import read_header, read_table, stream
from ulna.formats.tables import mat5
from ulna.formats.toml import read_json, read_toml
from ulna.ground.errors import UlnaInputError
from ulna.verification.profile import load_profile, shipped


def refused(path: Path, dataset: str | None = None) -> str:
    with pytest.raises(UlnaInputError) as error:  # noqa: PT012  # whichever of the two sees it first
        header = read_header(path, "readings", Layout(dataset=dataset))
        read_table(header, lambda _: True)
    return str(error.value)


def mat_variable(name: str, shape: tuple[int, int], kind: int, data: bytes, number: int = 9) -> bytes:
    """A compressed variable of class 6 (double) whose numbers are stored otherwise, as MATLAB does where they are
    whole."""

    def element(code: int, content: bytes) -> bytes:
        return struct.pack("<II", code, len(content)) + content + b"\0" * (-len(content) % 8)

    inside = element(6, struct.pack("<II", kind, 0)) + element(5, struct.pack("<ii", *shape))
    packed = zlib.compress(element(14, inside + element(1, name.encode()) + element(number, data)), 9)
    return struct.pack("<II", 15, len(packed)) + packed


MAT_HEAD = b"MATLAB 5.0 MAT-file".ljust(124) + b"\x00\x01IM"


def test_a_mat_variable_is_not_larger_than_its_file_can_be(tmp_path: Path) -> None:
    path = tmp_path / "m.mat"
    count = 140 << 20
    path.write_bytes(MAT_HEAD + mat_variable("q1", (count, 1), 6, bytes(count), 2))
    assert path.stat().st_size < 200_000
    assert "the values of q1 would take 1.17 GB, and the file has 1" in refused(path)
    with pytest.raises(UlnaInputError, match="'q1' would take 147 MB"):
        mat5.value(path, mat5.entries(path)[0])


def test_what_follows_a_mat_variable_within_its_compression_is_not_unpacked(tmp_path: Path) -> None:
    path = tmp_path / "m.mat"
    scipy.io.savemat(path, {"q1": np.arange(3.0)}, do_compression=True)
    content = path.read_bytes()
    plain = zlib.decompress(content[136:])
    packed = zlib.compress(plain + bytes(1 << 20))
    path.write_bytes(content[:128] + struct.pack("<II", 15, len(packed)) + packed)
    assert mat5._inflated(packed, len(plain)) == plain
    assert read_table(read_header(path), lambda _: True)["q1"].to_list() == [0.0, 1.0, 2.0]


def test_cells_are_not_more_than_there_are_bytes_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mat5, "_MANY_CELLS", 1000)
    names = cells([np.zeros((0, 0))] * 2000)
    scipy.io.savemat(tmp_path / "m.mat", {"run": {"feature": names, "q1": np.zeros((2000, 1))}})
    assert (
        len(read_table(read_header(tmp_path / "m.mat", layout=Layout(dataset="run")), lambda _: True, ["q1"])) == 2000
    )
    path = tmp_path / "n.mat"
    path.write_bytes(MAT_HEAD + mat_variable("run", (2000, 1), 1, b""))
    with pytest.raises(mat5.DamagedError, match="fewer cells"):
        mat5.value(path, mat5.entries(path)[0])


def test_a_thousand_million_equal_rows_of_parquet(tmp_path: Path) -> None:
    path = tmp_path / "q.parquet"
    column = pa.chunked_array([pa.array(np.zeros(1 << 20))] * 20)
    pq.write_table(pa.table({"q1": column}), path)
    assert path.stat().st_size < 2_000_000
    assert "its 20971520 rows would take 168 MB, and the file has" in refused(path)
    with pytest.raises(UlnaInputError, match="its 20971520 rows"):
        next(iter(stream(read_header(path), ["q1"], [])))


def workbook(path: Path, filler: int) -> None:
    """A good workbook, its sheet followed by blanks."""
    book = openpyxl.Workbook()
    book.active.append(["q1"])
    book.active.append([1.5])
    inside = io.BytesIO()
    book.save(inside)
    with zipfile.ZipFile(inside) as good, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as made:
        for part in good.namelist():
            more = b" " * filler if part == "xl/worksheets/sheet1.xml" else b""
            made.writestr(part, good.read(part) + more)


def test_a_sheet_that_is_far_larger_than_its_workbook(tmp_path: Path) -> None:
    path = tmp_path / "b.xlsx"
    workbook(path, 1 << 20)
    assert read_table(read_header(path), lambda _: True)["q1"].to_list() == [1.5]
    workbook(path, 160 << 20)
    assert "its parts would take 168 MB, and the file has" in refused(path)
    content = path.read_bytes()
    size = struct.pack("<I", zipfile.ZipFile(path).getinfo("xl/worksheets/sheet1.xml").file_size)
    assert content.count(size) == 2
    path.write_bytes(content.replace(size, struct.pack("<I", 400)))
    assert "xl/worksheets/sheet1.xml is larger than is said of it" in refused(path)


ZEROS = {
    "zeros alone": (b"", "holds zeros alone, and no text"),
    "a text that was lost": (b"q1\n1\n", "holds zeros alone from byte 6 on, and no text"),
}


@pytest.mark.parametrize("case", ZEROS)
def test_zeros_are_told_by_the_first_block(case: str, tmp_path: Path) -> None:
    path = tmp_path / "q.csv"
    begin, expected = ZEROS[case]
    with path.open("wb") as stream:
        stream.write(begin)
        stream.truncate(3_000_000_000)  # of holes: nobody reads them, or this takes a minute
    assert expected in refused(path)
    path.write_bytes(b"q1\n1\n" + bytes(5000))
    assert read_table(read_header(path), lambda _: True)["q1"].to_list() == [1.0]


TOML = {
    "a key of points": ("a" + ".a" * 100_000 + " = 1\n", "line 1: the key 'a.a.a.", "has 100001 names with points"),
    "a table of points": ("\n\n[" + "a . " * 100_000 + "a]\n", "line 3: the key", "has 100001 names"),
    "in quotes": ('"a"' + ".'a'" * 50_000 + "=1", "the key '\"a\".'a'", "has 50001 names"),
    "in an inline table": ("x = {b.c" + ".a" * 20 + " = 1}", "the key 'b.c.a", "has 22 names"),
    "brackets": ("a = " + "[" * 200_000, "too many brackets within brackets"),
    "digits": ("a = " + "1" * 1_000_000, "a whole number of thousands of digits"),
    "too large": ("#" * (toml.MOST_BYTES + 1), "more than 8 MB"),
    "tables": ("".join(f"[a{k}]\n" for k in range(20_002)), "more than 20000 tables"),
    "short keys": ("".join(f"a{k}.b=1\n" for k in range(10_001)), "more than 20000 tables"),
}


@pytest.mark.parametrize("case", TOML)
def test_toml_that_takes_all_memory(case: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(toml, "MOST_TABLES", 20_000)
    text, *expected = TOML[case]
    (tmp_path / "a.toml").write_text(text)
    with pytest.raises(UlnaInputError) as error:
        read_toml(tmp_path / "a.toml", "a study")
    assert all(each in str(error.value) for each in ["xpected", *expected])
    assert len(str(error.value)) < 1000


def test_points_in_toml_that_are_no_keys(tmp_path: Path) -> None:
    points = "x = [" + "1.5," * 10_000 + "2.5]\n"
    words = 'y = "' + "www.a." * 100 + 'b"\nz = """\n' + "a." * 100 + '\n"""\n'
    quoted = '"a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p.q.r.s" = 1\n'
    (tmp_path / "a.toml").write_text(points + words + quoted + "[a.b.c.d]\ne.f=1\n")
    assert len(read_toml(tmp_path / "a.toml", "a study")[0]["x"]) == 10_001


@pytest.mark.parametrize("text", ["[" * 200_000, '{"a":' * 100_000, '{"a": ' + "1" * 1_000_000 + "}"])
def test_json_of_brackets_and_digits(text: str, tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text(text)
    with pytest.raises(UlnaInputError, match=r"cannot be used: (too many brackets|a whole number of thousands)"):
        read_json(tmp_path / "a.json", "a result")


def test_a_number_of_a_million_digits_in_a_table(tmp_path: Path) -> None:
    (tmp_path / "q.csv").write_text("q1,q2\n1," + "1" * 1_000_000 + "\n2,3\n")
    message = refused(tmp_path / "q.csv")
    assert "expected" in message
    assert len(message) < 1000


def test_nobody_touches_a_million_million_times(tmp_path: Path) -> None:
    text = shipped()["iso-10360-12"].read_text(encoding="utf-8")
    (tmp_path / "p.toml").write_text(text.replace("positions = 7", "positions = 900000"), encoding="utf-8")
    with pytest.raises(UlnaInputError, match=r"p\.toml: key 'test\..*900000 positions.*, more than anybody measures"):
        load_profile("p.toml", tmp_path, "key 'profile'")


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "GIF", "WebP"])
def test_a_picture_says_how_large_it_is(kind: str) -> None:
    Image = pytest.importorskip("PIL.Image")
    made = io.BytesIO()
    Image.new("RGB", (300, 200), "green").save(made, format=kind)
    assert pixels(made.getvalue()) == 60_000
    for length in range(40):
        pixels(made.getvalue()[:length])  # whatever is missing
    if kind == "WebP":
        made = io.BytesIO()
        Image.new("RGB", (300, 200), "green").save(made, format=kind, lossless=True)
        assert pixels(made.getvalue()) == 60_000
    assert MOST_PIXELS > 1_000_000


def svg(inside: str) -> bytes:
    return f'<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9">{inside}</svg>'.encode()


def doubled(times: int, reference: str) -> str:
    """Each group draws the one before twice."""
    groups = (f'<g id="a{k}">{2 * reference.format(k - 1)}</g>' for k in range(1, times))
    return '<rect id="a0" width="1" height="1"/>' + "".join(groups) + reference.format(times - 1)


def vast_png() -> str:
    return base64.b64encode(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + (30_000).to_bytes(4, "big") * 2).decode()


SVG = {
    "uses": (doubled(40, '<use href="#a{}"/>'), "more than 500000 elements"),
    "fills": (doubled(40, '<rect fill="url(#a{})"/>'), "more than 500000 elements"),
    "a long chain": ("".join(f'<g id="a{k}"><use href="#a{k + 1}"/></g>' for k in range(5000)), "more than 500000"),
    "a picture": (f'<image href="data:image/png;base64,{vast_png()}"/>', "pictures in it of more than 25 million"),
}


@pytest.mark.parametrize("case", SVG)
def test_an_svg_that_draws_without_end(case: str) -> None:
    inside, expected = SVG[case]
    assert expected in (too_large(svg(inside)) or "")


def test_an_svg_of_a_logo() -> None:
    circle = (
        '<g id="a"><use href="#a"/></g><use href="#a"/><rect fill="url(#b)"/><image href="data:image/png;base64,x"/>'
    )
    assert too_large(svg(doubled(10, '<use href="#a{}"/>') + circle)) is None
    assert too_large(b"<svg") is None
    assert "entities" in (too_large(b'<!DOCTYPE svg [<!ENTITY a "b">]><svg/>') or "")


def test_cells_that_are_merged_again_and_again(tmp_path: Path) -> None:
    path = tmp_path / "b.xlsx"
    book = openpyxl.Workbook()
    for row in [["q1"], *([1.5] for _ in range(50))]:
        book.active.append(row)
    book.save(path)
    merged = "".join(f'<mergeCell ref="A2:A{50 - k % 9}"/>' for k in range(100))
    rewritten = tmp_path / "c.xlsx"
    with zipfile.ZipFile(path) as good, zipfile.ZipFile(rewritten, "w", zipfile.ZIP_DEFLATED) as made:
        for part in good.namelist():
            more = f"</sheetData><mergeCells>{merged}</mergeCells>".encode()
            made.writestr(part, good.read(part).replace(b"</sheetData>", more))
    assert "merged cells lie upon each other" in refused(rewritten)
