"""What is said to dialects of CSV that are not announced, announced wrongly, or broken; and to keys out of place."""

from __future__ import annotations

from pathlib import Path

import polars as pl
import pytest
from tests.foreign_tables import WRITERS, dialect
from tests.small_study import BARS, STUDY, SmallStudy, says

from ulna import UlnaInputError
from ulna.formats.layout import Layout
from ulna.formats.table import read_header, read_table, stream

TABLE = pl.read_csv(BARS.encode())
SEMICOLONS = BARS.replace(",", ";").replace(".", ",")
GERMAN = 'separator = ";"\ndecimal = ","'
RENAMED = BARS.replace("q1,q2,q3", "shoulder,elbow,wrist")
MAPPED = 'columns = { q1 = "shoulder", q2 = "elbow", q3 = "wrist" }'


def told(folder: Path, content: str, keys: str) -> str:
    small = SmallStudy(folder)
    small.write("bars.csv", content)
    small.write("study.toml", STUDY.replace('file = "bars.csv"\n', f'file = "bars.csv"\n{keys}\n'))
    return small.error()


def cell(content: str, row: int, value: str) -> str:
    """The first cell of a data row anew."""
    lines = content.split("\n")
    separator = ";" if ";" in lines[0] else ","
    lines[row] = separator.join([value, *lines[row].split(separator)[1:]])
    return "\n".join(lines)


def line(content: str, row: int, text: str) -> str:
    lines = content.split("\n")
    lines[row] = text
    return "\n".join(lines)


#: what the file holds, the keys beside it, and what the message says
CASES: dict[str, tuple[str, str, tuple[str, ...]]] = {
    "not announced": (
        SEMICOLONS,
        "",
        ("bars.csv: line 1", "semicolons", 'Say separator = ";" in [[readings]]', 'and decimal = "," where'),
    ),
    "tabs": (BARS.replace(",", "\t"), "", ("bars.csv: line 1", "tabs", 'Say separator = "tab" in [[readings]]')),
    "half announced": (
        SEMICOLONS,
        'separator = ";"',
        ("row 1 (line 2", "column 'q1'", "got '0,500382', a decimal comma", 'Say decimal = "," in [[readings]]'),
    ),
    "no separator": (SEMICOLONS, 'decimal = ","', ("'readings.1.decimal'", "no key 'separator'", 'separator = ";"')),
    "one sign for both": (BARS, 'separator = ","\ndecimal = ","', ("'readings.1.decimal'", "a comma as well")),
    "two characters": (BARS, 'separator = ";;"', ("'readings.1.separator'", "got ';;'", "one character", "'tab'")),
    "a digit": (BARS, 'separator = "5"', ("'readings.1.separator'", "got '5'", "no letter, digit")),
    "another decimal sign": (BARS, 'decimal = "\'"', ("'readings.1.decimal'", "expected '.' or ','")),
    "not this separator": (BARS, 'separator = ";"', ("'readings.1.separator'", "got ';'", "bars.csv", "has commas")),
    "no separator at all": (BARS, 'separator = "|"', ("'readings.1.separator'", "got '|'", "has none")),
    "thousands": (cell(SEMICOLONS, 1, "1.234,5"), GERMAN, ("row 1 (line 2", "'1.234,5', with a point", "thousands")),
    "a point": (cell(SEMICOLONS, 2, "1.234"), GERMAN, ("row 2 (line 3", "'1.234', with a point", "decimal comma")),
    "no number": (cell(SEMICOLONS, 3, "n/a"), GERMAN, ("row 3 (line 4", "'q1'", "got 'n/a', expected a number")),
    "infinity": (cell(SEMICOLONS, 3, "-inf"), GERMAN, ("row 3 (line 4", "got '-inf', expected a finite number")),
    "a gap": (cell(SEMICOLONS, 3, ""), GERMAN, ("row 3 (line 4", "'q1'", "is empty", "a number")),
    "a cell too many": (line(SEMICOLONS, 2, "1;2;3;4;5;6"), GERMAN, ("row 2 (line 3", "6 cells, expected 5")),
    "digits of elsewhere": (cell(BARS, 3, "١"), "", ("row 3 (line 4", "'q1'", "got '١'", "expected a")),
    "only numbers": ("1,2,3\n4,5,6\n", "", ("line 1 holds numbers", "header = false in [[readings]]")),
    "no header and no columns": (
        BARS,
        "header = false",
        ("'readings.1.header'", 'columns = { q1 = "c1", … } in [[readings]]', "c1 is the first column"),
    ),
    "no such number": (BARS, 'header = false\ncolumns = { q1 = "c9" }', ("'readings.1.columns'", "'c9'", "c1, c2")),
    "there is a header": (
        BARS,
        'header = false\ncolumns = { q1 = "c1", q2 = "c2", q3 = "c3" }',
        ("row 1 (line 1 of", "column 'c1' (q1)", "got 'q1'", "said to have no header ("),
    ),
    "unknown to Ulna": (BARS, 'columns = { qq1 = "q1" }', ("'readings.1.columns'", "'qq1'", "Did you mean 'q1'?")),
    "coordinates of nothing": (BARS, 'columns = { x = "q1" }', ("'readings.1.columns'", "'x' is no column")),
    "not in the file": (RENAMED, 'columns = { q1 = "sholder" }', ("'sholder'", "Did you mean 'shoulder'?")),
    "one column twice": (RENAMED, 'columns = { q1 = "wrist", q2 = "wrist" }', ("q1 and q2 are both", "'wrist'")),
    "there already": (BARS, 'columns = { q1 = "q2" }', ("q1 is to be the column 'q2'", "has a column 'q1' as well")),
    "no mapping": (RENAMED, "", ("column 'q1' is missing", "none such (shoulder, elbow", "Map the file's columns")),
    "half a mapping": (RENAMED, 'columns = { q1 = "shoulder" }', ("'q2' is missing", "has 1 column q…")),
    "an empty mapping": (RENAMED, "columns = {}", ("'readings.1.columns'", "at least 1 entries")),
    "a mapped cell": (cell(RENAMED, 3, "x"), MAPPED, ("row 3 (line 4", "column 'shoulder' (q1): got 'x'")),
    "mapped degrees": (cell(RENAMED, 3, "95"), MAPPED, ("row 3 (line 4", "column 'shoulder' (q1): got 95 rad")),
    "sheet": (BARS, 'sheet = "a"', ("'readings.1.sheet'", "bars.csv is a CSV file", "with Excel files only")),
    "dataset": (BARS, 'dataset = "a"', ("'readings.1.dataset'", "is a CSV file", "MAT and HDF5 files only")),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_what_a_dialect_is_told(tmp_path: Path, case: str) -> None:
    content, keys, fragments = CASES[case]
    says(told(tmp_path, content, keys), str(tmp_path), *fragments)


FORMATS = ["table.parquet", "book.xlsx", "plain.mat", "group.h5"]
NO_USE = [(name, key) for name in FORMATS for key in ('separator = ";"', 'decimal = "."')]
NO_USE += [(name, "header = false\ncolumns = { q1 = 'c1' }") for name in FORMATS if name != "book.xlsx"]


@pytest.mark.parametrize(("name", "key"), NO_USE)
def test_a_key_that_a_format_has_no_use_for(tmp_path: Path, name: str, key: str) -> None:
    small = SmallStudy(tmp_path)
    keys = WRITERS[name](TABLE, tmp_path / name)
    small.write("study.toml", STUDY.replace("bars.csv", name).replace('angle = "rad"\nart', f"{keys}{key}\nart"))
    says(small.error(), f"'readings.1.{key.split(' ')[0]}'", name, "expected with CSV", "Remove it")


def test_a_file_of_one_separator_read_with_another_keeps_its_rows(tmp_path: Path) -> None:
    """Both readers of text, whole and piece by piece, see the same numbers and the same bad cell."""
    path = tmp_path / "t.csv"
    table = pl.DataFrame({"q1": [k / 7 for k in range(5000)], "id": [f"n{k}" for k in range(5000)]})
    dialect(";", ",")(table, path)
    layout = Layout.of_options({}, separator=";", decimal=",")
    header = read_header(path, layout=layout)
    assert read_table(header, lambda name: name == "q1").equals(table)
    assert [x for piece in stream(header, ["q1"], ["id"]) for x in piece.numbers[:, 0]] == table["q1"].to_list()
    text = path.read_text().split("\n")
    for bad, expected in {
        "1.5;n": "with a point",
        "x;n": "expected a number",
        "1,5": "has 1 cell,",
        "": "is blank",
    }.items():
        path.write_text("\n".join([*text[:4000], bad, *text[4001:]]))
        messages = []
        for read in (
            lambda: read_table(header, lambda name: name == "q1"),
            lambda: list(stream(header, ["q1"], ["id"])),
        ):
            with pytest.raises(UlnaInputError) as caught:
                read()
            messages.append(str(caught.value))
        says(messages[0], "row 4000 (line 4001 of the file)", expected)
        assert messages[0] == messages[1]


def test_harmless_spellings_of_a_dialect_piece_by_piece(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    rows = [f" {k},5 ; n{k} " for k in range(3000)]
    path.write_bytes(b"\xef\xbb\xbf" + "\r\n".join(["q1;id", *rows, "", ""]).encode())
    header = read_header(path, layout=Layout.of_options({}, separator=";", decimal=","))
    pieces = list(stream(header, ["q1"], ["id"], 1000))
    assert [x for piece in pieces for x in piece.numbers[:, 0]] == [k + 0.5 for k in range(3000)]
    assert [x for piece in pieces for x in piece.texts["id"]] == [f"n{k}" for k in range(3000)]
    assert read_table(header, lambda name: name == "q1")["q1"].to_list() == [k + 0.5 for k in range(3000)]


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ({"decimal": ";"}, "--decimal: got ';'; expected '.' or ','"),
        ({"separator": "ab"}, "--separator: got 'ab'"),
        ({"header": False}, "--no-header: says that the file does not name its columns.*Say --column q1=c1"),
        ({"columns": ["q1"]}, "--column: got 'q1'; expected Ulna's name = the file's name"),
        ({"columns": ["q1=a", "q1=b"]}, "--column: got 'q1=b'.*each once"),
        ({"decimal": ","}, '--decimal: numbers have a decimal comma.*Say which, such as --separator ";"'),
    ],
)
def test_options_that_cannot_be_meant(given: dict[str, object], expected: str) -> None:
    with pytest.raises(UlnaInputError, match=expected):
        Layout.of_options(**given)  # type: ignore[arg-type]
