"""What every format of tables owes, held against each row of the registry.

A new format is held to all of this by its row and a writer of another program in `tests/foreign_tables.py`.
"""

from __future__ import annotations

import contextlib
import dataclasses
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from tests.foreign_tables import WRITERS

from ulna.formats.header import Header
from ulna.formats.layout import Layout, TableKeys
from ulna.formats.table import read_header, read_table, stream
from ulna.formats.tables.format import TableFormat
from ulna.formats.tables.registry import FORMATS, LISTED, WHAT, distinct
from ulna.ground.errors import UlnaInputError

#: numbers whose last digit is easily lost, labels that are no ASCII, and whole numbers that stay labels
TABLE = pl.DataFrame(
    {
        "q1": [0.1, -1.0 / 3.0, 2.0**-30, 12.5, 0.0],
        "q2": [1e-300, 123456.789, -0.25, 3.0, 7.0],
        "placement": [1, 1, 2, 2, 1000000007],
        "feature": ["A", "Größe 2", "µ", "x y", "左"],
    }
)
NUMBERS = ("q1", "q2")
LABELS = {"placement": ["1", "1", "2", "2", "1000000007"], "feature": TABLE["feature"].to_list()}

every_format = pytest.mark.parametrize("each", FORMATS, ids=[each.name for each in FORMATS])
every_writer = pytest.mark.parametrize("name", WRITERS)


def numeric(column: str) -> bool:
    return column in NUMBERS


def opened(folder: Path, name: str, table: pl.DataFrame = TABLE) -> Header:
    keys = WRITERS[name](table, folder / name)
    stated = TableKeys.model_validate(tomllib.loads(keys))
    return read_header(folder / name, WHAT, Layout.of(stated, ("key '", "'"), "[[readings]]"), table.columns)


def start_of(path: Path) -> bytes:
    with path.open("rb") as stream:
        return stream.read(1 << 16)


def recognising(start: bytes) -> list[TableFormat]:
    return [each for each in FORMATS if each.recognised(start)]


def written_as(each: TableFormat, folder: Path) -> list[str]:
    """The writers whose files a format recognises."""
    found = []
    for name, write in WRITERS.items():
        write(TABLE, folder / name)
        if recognising(start_of(folder / name)) == [each]:
            found.append(name)
    return found


@every_format
def test_another_program_writes_it(each: TableFormat, tmp_path: Path) -> None:
    names = written_as(each, tmp_path)
    assert names, f"no file of tests/foreign_tables.py is {each.kind}: add a writer, of another program than the reader"
    assert {Path(name).suffix for name in names} <= set(each.endings)


@every_writer
def test_one_format_recognises_it_and_its_name_fits(name: str, tmp_path: Path) -> None:
    WRITERS[name](TABLE, tmp_path / name)
    (found,) = recognising(start_of(tmp_path / name))
    assert Path(name).suffix in found.endings


@every_writer
def test_the_same_table_reads_the_same(name: str, tmp_path: Path) -> None:
    """To the last digit of a number, in whole and in pieces, in any order of columns."""
    header = opened(tmp_path, name)
    assert set(TABLE.columns) <= set(header.columns)
    for columns in (TABLE.columns, TABLE.columns[::-1], ["q2"]):
        frame = read_table(header, numeric, columns)
        assert frame.columns == list(columns)
        for column in columns:
            if column in NUMBERS:
                assert frame[column].to_list() == [pytest.approx(x, rel=1e-15, abs=0.0) for x in TABLE[column]], column
                assert frame[column].dtype == pl.Float64
            else:
                assert frame[column].to_list() == LABELS[column]
    whole = read_table(header, numeric, TABLE.columns)
    texts = [column for column in TABLE.columns if column not in NUMBERS]
    pieces = list(stream(header, NUMBERS, texts, rows=2))
    assert np.concatenate([piece.numbers for piece in pieces]).tolist() == whole.select(NUMBERS).to_numpy().tolist()
    for column in texts:
        assert pl.concat([piece.texts[column] for piece in pieces]).to_list() == whole[column].to_list()
    assert [piece.before for piece in pieces] == np.cumsum([0, *map(len, pieces)])[:-1].tolist()
    assert header.rows in (None, len(TABLE))


@every_writer
def test_a_number_that_is_none_is_named(name: str, tmp_path: Path) -> None:
    values = TABLE["q2"].to_list()
    spoiled = TABLE.with_columns(q2=pl.Series([*values[:3], float("nan"), values[4]]))
    try:
        header = opened(tmp_path, name, spoiled)
    except ValueError:
        pytest.skip("this writer has no word for it")
    with pytest.raises(UlnaInputError, match=r"row 4.*(q2|c2).*expected a (finite )?number"):
        read_table(header, numeric, TABLE.columns)


def _spoiled(content: bytes, seed: int) -> bytes:
    rng = np.random.default_rng(seed)
    cut = bytearray(content[: int(rng.integers(4, len(content)))] if seed % 2 else content)
    for at in rng.integers(0, len(cut), 3):
        cut[at] = int(rng.integers(256))
    return bytes(cut)


@every_writer
def test_a_damaged_file_is_a_message_or_a_table(name: str, tmp_path: Path) -> None:
    """Never another exception."""
    keys = WRITERS[name](TABLE, tmp_path / name)
    layout = Layout.of(TableKeys.model_validate(tomllib.loads(keys)), ("key '", "'"), "[[readings]]")
    content = (tmp_path / name).read_bytes()
    for seed in range(24):
        path = tmp_path / f"{seed}-{name}"
        path.write_bytes(_spoiled(content, seed))
        with contextlib.suppress(UlnaInputError):
            header = read_header(path, WHAT, layout, TABLE.columns)
            read_table(header, numeric, [column for column in TABLE.columns if column in header.columns])


@every_format
@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"", "the file is empty; expected a table"),
        (b" \n \n", "the file is empty; expected a table"),
        (b"\x00\x01\x02\x03" * 64, "the file is binary; expected a table"),
        (bytes(range(128, 256)) * 4, "line 1 is not UTF-8 text; expected a table"),
        (b"0.5,1.5,2.5\n1.0,2.0,3.0\n", "line 1 holds numbers"),
    ],
    ids=["nothing", "blanks", "noise", "bytes", "no header"],
)
def test_wrong_content_under_its_ending_is_a_message(
    each: TableFormat, content: bytes, told: str, tmp_path: Path
) -> None:
    for ending in each.endings:
        path = tmp_path / f"readings{ending}"
        path.write_bytes(content)
        with pytest.raises(UlnaInputError, match=told) as caught:
            read_header(path)
        assert str(path) in str(caught.value)


OPTIONS: dict[str, Any] = {
    "separator": ";",
    "decimal": ",",
    "thousands": "'",
    "encoding": "utf-8",
    "comment": "#",
    "header": False,
    "units_row": False,
    "fill_down": ("feature",),
    "sheet": "one",
    "dataset": "run",
}


@every_format
def test_what_files_of_it_do_not_have_is_told(each: TableFormat, tmp_path: Path) -> None:
    """With whose files such a key is for; and a key that is its own is never refused so."""
    assert list(OPTIONS) == list(Layout.KEYS)
    name = written_as(each, tmp_path)[0]
    for key, value in OPTIONS.items():
        given = {key: value} | ({"columns": {"q1": "c1"}} if key == "header" else {})
        given |= {"separator": ";"} if key == "decimal" else {}
        layout = Layout(**given)
        try:
            read_header(tmp_path / name, WHAT, layout, TABLE.columns)
            told = ""
        except UlnaInputError as error:
            told = str(error)
        others = " and ".join(other.name for other in LISTED if key in other.keys)
        if key in each.keys:
            assert f"is {each.kind}; expected with" not in told
        else:
            first = next(given_key for given_key in layout.given if given_key not in each.keys)
            assert told.startswith(f"key '{first}': ")
            assert first != key or f"is {each.kind}; expected with {others} files only" in told


def test_every_key_is_some_format_s() -> None:
    assert {key for each in FORMATS for key in each.keys} == set(Layout.KEYS)


def test_what_messages_call_a_table() -> None:
    """All formats, CSV first, which most people have."""
    assert WHAT.startswith("a table (CSV with a header, ")
    assert all(each.listed in WHAT for each in FORMATS)
    assert set(LISTED) == set(FORMATS)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"kind": ""}, "'CSV': 'kind' is empty: say how messages call it"),
        ({"listed": " "}, "'CSV': 'listed' is empty: say how messages call it"),
        ({"endings": ()}, "'CSV': it has no endings: say how its files are usually called"),
        ({"endings": ("CSV",)}, "ending 'CSV': begin it with a point, in small letters"),
        ({"keys": ("seperator",)}, "key 'seperator': no key of TableKeys; known are separator, decimal, thousands, "),
    ],
)
def test_a_format_that_lacks_something_says_what(change: dict[str, Any], told: str) -> None:
    text = next(each for each in FORMATS if each.name == "CSV")
    with pytest.raises(TypeError, match=told):
        dataclasses.replace(text, **change)


@pytest.mark.parametrize("part", [field.name for field in dataclasses.fields(TableFormat)])
def test_no_part_of_a_format_has_a_default(part: str) -> None:
    given = {field.name: getattr(FORMATS[0], field.name) for field in dataclasses.fields(TableFormat)}
    del given[part]
    with pytest.raises(TypeError, match=f"missing 1 required keyword-only argument: '{part}'"):
        TableFormat(**given)


def test_two_formats_of_one_name_are_told() -> None:
    with pytest.raises(TypeError, match="two table formats have 'name' 'Parquet'; give one another"):
        distinct([FORMATS[0], FORMATS[0]])


def test_a_table_loads_what_reads_its_own_format_and_no_other(tmp_path: Path) -> None:
    WRITERS["commas.csv"](TABLE, tmp_path / "a.csv")
    code = (
        "import sys; from pathlib import Path; from ulna.formats.table import read_header\n"
        f"read_header(Path({str(tmp_path / 'a.csv')!r}))\n"
        "others = ('text', 'parquet', 'workbook', 'matfile', 'hdf5')\n"
        "print([name for name in others if f'ulna.formats.tables.{name}' in sys.modules])\n"
        "print([name for name in ('h5py', 'pyarrow', 'python_calamine') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split("\n") == ["['text']", "[]", ""]
