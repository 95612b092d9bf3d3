"""Every way in which readings can be wrong, and what the user is told: file, row, column, value, expected, remedy."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from tests.small_study import BARS, STUDY, SmallStudy, says

from ulna import UlnaInputError
from ulna.formats.table import read_header, read_table, stream

CELLS: dict[str, tuple[int, str, str, tuple[str, ...]]] = {
    "no number": (3, "q2", "x", ("row 3 (line 4", "column 'q2'", "got 'x'", "expected a number")),
    "NaN": (3, "q2", "nan", ("row 3 (line 4", "column 'q2'", "got 'nan'", "a finite number")),
    "infinity": (8, "q3", "-inf", ("row 8 (line 9", "column 'q3'", "got '-inf'", "a finite number")),
    "empty": (1, "q1", "", ("row 1 (line 2", "column 'q1'", "is empty", "Fill it or remove the row")),
    "hexadecimal": (2, "q1", "0x10", ("row 2 (line 3", "column 'q1'", "got '0x10'")),
    "empty name": (4, "feature", "", ("row 4 (line 5", "column 'feature'", "is empty", "a name")),
    "decimal comma": (5, "q1", '"1,25"', ("row 5 (line 6", "column 'q1'", "'1,25'", "decimal comma", "decimal point")),
    "bare decimal comma": (5, "q1", "1,25", ("row 5 (line 6", "6 cells, expected 5", "q1, q2, q3")),
    "unknown feature": (6, "feature", "C", ("row 6 (line 7", "'feature'", "got 'C'", "artefact 'bar'", "Known: A, B")),
    "degrees": (7, "q2", "95.5", ("row 7 (line 8", "'q2'", "got 95.5 rad", "±4π rad", "degrees or counts?")),
}


@pytest.mark.parametrize("case", CELLS)
def test_one_bad_cell(tmp_path: Path, case: str) -> None:
    row, column, value, fragments = CELLS[case]
    small = SmallStudy(tmp_path)
    small.cell(row, column, value)
    says(small.error(), f"{tmp_path / 'bars.csv'}: ", *fragments)


FILES: dict[str, tuple[str | bytes, tuple[str, ...]]] = {
    "empty": ("", ("the file is empty", "a readings file")),
    "only a header": (BARS.splitlines()[0] + "\n", ("there are no rows", "'readings.1'")),
    "no header": (BARS.split("\n", 1)[1].replace(",A", ",1").replace(",B", ",2"), ("line 1 holds numbers", "q1,q2")),
    "semicolons": (BARS.replace(",", ";").replace(".", ","), ("line 1", "semicolons", "decimal point")),
    "tabs": (BARS.replace(",", "\t"), ("line 1", "tabs", "expected commas")),
    "decimal commas": (BARS.replace(".", ","), ("row 1 (line 2", "8 cells, expected 5", "decimal commas?")),
    "semicolons below": (
        BARS.replace(",", ";").replace("q1;q2;q3;placement;feature", "q1,q2,q3,placement,feature"),
        ("row 1 (line 2", "has 1 cell,", "separated by semicolons?"),
    ),
    "an open quotation mark": (
        BARS.replace("\n", '\n"', 1),
        ("line 2: a quotation mark is opened and not closed before the end of the file",),
    ),
    "open quote": (
        BARS.replace(",A", ',"A', 1) + BARS.split("\n", 1)[1] * 700,
        ("line 2", "quotation mark is not closed"),
    ),
    "nobody's letters": (
        BARS.replace(",A", ",\u0416\u0444").encode("cp1251"),
        ("line 2 is not UTF-8 text", "as cp1251 it reads '\u0416\u0444'", 'Say encoding = "cp1252" in [[readings]]'),
    ),
    "workbook": (b"PK\x03\x04\x14\x00", ("Excel workbook", "Export the sheet as CSV")),
    "binary": (b"\x00\x01\x02\x03", ("binary",)),
    "broken Parquet": (b"PAR1 and then nothing", ("not a readable Parquet file",)),
    "a joint too few": (BARS.replace("q3,", "r3,"), ("'q3' is missing", "2 columns q…", "3 joints", "q1 … q3")),
    "a joint too many": (BARS.replace("placement", "q4"), ("'q4' is one too many", "4 columns q…", "3 joints")),
    "its own unit": (
        BARS.replace("q3,", "q3 [deg],"),
        ("column 'q3 [deg]' (q3): the file says 'deg', but its angles are said to be in rad", "key 'angle'"),
    ),
    "column twice": (BARS.replace("q3,", "q2,"), ("column 'q2' appears twice", "Remove one")),
    "column unnamed": (BARS.replace("q3,", ","), ("line 2, column 3: got '1.102743' in a column without a name",)),
    "near miss": (BARS.replace("placement", "placment"), ("unknown column 'placment'", "Did you mean 'placement'?")),
    "short row": (BARS.replace(",1,A", ",A", 1), ("row 1 (line 2", "4 cells, expected 5")),
    "temperatures": (BARS.replace("placement", "temperature2"), ("temperature2", "temperature1 … temperature3")),
}


@pytest.mark.parametrize("case", FILES)
def test_a_bad_file(tmp_path: Path, case: str) -> None:
    content, fragments = FILES[case]
    small = SmallStudy(tmp_path)
    small.write("bars.csv", content)
    says(small.error(), f"{tmp_path / 'bars.csv'}: ", *fragments)


def test_one_bad_cell_among_a_million_rows(tmp_path: Path) -> None:
    rows = 1_000_000
    q = np.random.default_rng(3).uniform(-2, 2, (rows, 3)).round(3)
    frame = pl.DataFrame(q, schema=["q1", "q2", "q3"]).with_columns(
        placement=pl.int_range(rows) // 2, feature=pl.Series(["A", "B"]).gather(pl.int_range(rows, eager=True) % 2)
    )
    small = SmallStudy(tmp_path)
    frame.write_csv(tmp_path / "bars.csv")
    with (tmp_path / "bars.csv").open("r+b") as stream:
        content = stream.read()
        line = content.index(b"\n", int(len(content) * 0.99)) + 1
        row = content.count(b"\n", 0, line)
        stream.seek(line)
        stream.write(b"?")
    says(small.error(), f"row {row} (line {row + 1} of the file)", "column 'q1'", "got '?", "expected a number")


def test_bad_cells_of_parquet(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    small.swap("study.toml", "bars.csv", "bars.parquet")
    frame = pl.read_csv(BARS.encode())
    path = tmp_path / "bars.parquet"
    for changed, fragments in (
        ({"q2": [0.0, None] + [0.1] * 6}, ("row 2, column 'q2'", "is empty")),
        ({"q3": [0.0, 0.1, float("nan")] + [0.2] * 5}, ("row 3, column 'q3'", "'nan'", "a finite number")),
        ({"q1": ["left"] * 8}, ("row 1, column 'q1'", "'left' (String)", "floating-point numbers")),
        ({"placement": [1] * 7 + [None]}, ("row 8, column 'placement'", "is empty")),
    ):
        frame.with_columns(**{name: pl.Series(values) for name, values in changed.items()}).write_parquet(path)
        says(small.error(), f"{path}: ", *fragments)


def test_counts_and_degrees_out_of_scale(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    small.swap("study.toml", 'angle = "rad"\nart', 'angle = "deg"\nart')
    small.cell(2, "q1", "40000")
    says(small.error(), "row 2", "column 'q1'", "got 40000 deg", "Are these counts?")
    small.swap("study.toml", 'angle = "deg"', 'angle = "counts"')
    says(small.error(), "got 40000 counts", "counts_per_turn")
    small.swap("arm.toml", "counts_per_turn = 4096", "")
    says(small.error(), "arm.toml: key 'joint.1.counts_per_turn' is missing", "'readings.1.angle'", "Add it")


def test_a_joint_outside_its_limits_is_warned_of_with_rows(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    small.cell(2, "q1", "3.5")
    small.cell(5, "q1", "-3.25")
    _, warned = small.load()
    assert len(warned) == 1
    says(warned[0], "bars.csv", "'q1'", "2 readings", "joint 1 (-3 to 3 rad)", "rows 2, 5", "3.5 rad in row 2")


def test_a_bar_touched_at_one_end_only(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    small.cell(7, "feature", "A")
    small.cell(8, "feature", "A")
    says(
        small.error(),
        "study.toml: artefact 'bar', placement '2'",
        "feature 'B'",
        "only 'A' (rows 5, 6, 7, 8 of",
        "bars.csv",
    )


def test_rows_that_repeat_are_warned_of(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    lines = BARS.splitlines()
    small.write("bars.csv", "\n".join([*lines, lines[3], lines[3], lines[5]]) + "\n")
    study, warned = small.load()
    assert len(study.readings[0]) == 11
    assert len(warned) == 1
    says(warned[0], "bars.csv: 3 rows", "rows 9 (as row 3), 10 (as row 3), 11 (as row 5)", "readings of their own")


def test_the_same_angles_in_another_placement_are_no_copy(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    lines = BARS.splitlines()
    small.write("bars.csv", "\n".join([*lines, lines[1].replace(",1,A", ",2,A")]) + "\n")
    _, warned = small.load()
    assert warned == []


def test_readings_that_contradict_each_other(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    lines = BARS.splitlines()
    small.write("bars.csv", "\n".join([*lines, lines[1].replace(",A", ",B")]) + "\n")
    says(small.error(), "bars.csv: row 9, column 'feature': got 'B'", "row 1 has the same encoder angles with 'A'")
    ids = [lines[0] + ",id", *(f"{line},{k % 7}" for k, line in enumerate(lines[1:]))]
    small.write("bars.csv", "\n".join(ids) + "\n")
    says(small.error(), "row 8 (line 9", "column 'id'", "'0' stands in row 1 already", "one reading per id")


def test_lengths_that_contradict_each_other_or_are_negative(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    small.swap("study.toml", 'kind = "bar"\nlength = 443.172', 'kind = "length"')
    header = "q1,q2,q3,p1,p2,p3,length\n"
    small.write("bars.csv", header + "0,0,0,1,1,1,443\n0,0,0,1,1,1,444\n")
    says(small.error(), "row 2, column 'length': got 444 mm", "row 1 has the same two poses with 443 mm")
    small.write("bars.csv", header + "0,0,0,1,1,1,443\n0,0,0,1,1,2,-443\n")
    says(small.error(), "row 2 (line 3", "'length'", "got -443", "0 or more")
    small.write("bars.csv", header.replace(",length", "") + "0,0,0,1,1,1\n")
    says(small.error(), "column 'length' is missing", "artefact.bar.length")
    small.write("bars.csv", header.replace(",p3", "") + "0,0,0,1,1,443\n")
    says(small.error(), "'p3' is missing", "2 columns p…", "3 joints")
    small.write("bars.csv", header + "0,0,0,1,1,99,443\n")
    says(small.error(), "row 1 (line 2", "column 'p3'", "got 99 rad")


def test_the_kind_must_fit_the_columns(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    small.swap("study.toml", 'kind = "bar"\nlength = 443.172', 'kind = "length"')
    says(small.error(), "bars.csv: row 1", "kind 'length'", "one pose a row")
    small.write("study.toml", STUDY)
    small.write("bars.csv", "q1,q2,q3,p1,p2,p3,length\n0,0,0,1,1,1,443\n")
    says(small.error(), "bars.csv: row 1", "kind 'bar'", "two poses a row")


def test_choices_that_are_left_open(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    small.write("bars.csv", BARS.replace("feature", "note"))
    says(small.error(), "no column 'feature'", "'readings.1.feature'", "A, B", "Add the column or the key")
    small.write("bars.csv", BARS)
    small.swap("study.toml", 'artefact = "bar"\n', "")
    small.swap("study.toml", "[noise]", '[artefact.cone]\nkind = "seat"\n[noise]')
    says(small.error(), "no column 'artefact'", "bar, cone")
    small.write("bars.csv", BARS.replace("placement", "artefact").replace(",1,", ",bar,").replace(",2,", ",cane,"))
    says(small.error(), "row 5 (line 6", "'artefact'", "got 'cane'", "Did you mean 'cone'?")
    small.write("bars.csv", BARS.replace("placement", "probe"))
    small.swap("study.toml", 'probe = "bent"', 'probe = "bent"\nartefact = "bar"')
    says(small.error(), "row 1 (line 2", "column 'probe'", "got '1'", "arm 'three axes'")


def test_two_files_of_one_artefact_must_say_which_standing(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    small.write("more.csv", BARS.replace("placement", "comment"))
    small.swap("study.toml", "[artefact.bar]", '[[readings]]\nfile = "more.csv"\nprobe = "bent"\n\n[artefact.bar]')
    says(small.error(), "artefact 'bar' is in 2 readings files", "column 'placement'", "key 'placement'")


def test_pieces_of_a_file_name_the_bad_cell_too(tmp_path: Path) -> None:
    path = tmp_path / "q.csv"
    rows = [f"{k},{k}" for k in range(1000)]
    for at, cell, fragments in (
        (700, "7,x", ("row 701 (line 702", "column 'q2'", "got 'x'")),
        (650, "7", ("row 651 (line 652 of the file) has 1 cell, expected 2",)),
        (999, "1,nan", ("row 1000 (line 1001", "got 'nan'")),
    ):
        path.write_text("\n".join(["q1,q2", *rows[:at], cell, *rows[at + 1 :]]) + "\n")
        with pytest.raises(UlnaInputError) as caught:
            list(stream(read_header(path), ["q1", "q2"], [], rows=100))
        says(str(caught.value), f"{path}: ", *fragments)


def test_a_parquet_file_with_a_broken_page(tmp_path: Path) -> None:
    path = tmp_path / "q.parquet"
    pl.DataFrame({"q1": np.random.default_rng(0).uniform(size=20000)}).write_parquet(path)
    content = path.read_bytes()
    path.write_bytes(content[:4] + b"\xff" * 100 + content[104:])
    header = read_header(path)
    reads = (lambda: read_table(header, lambda _: True), lambda: list(stream(header, ["q1"], [])))
    for read in reads:
        with pytest.raises(UlnaInputError) as caught:
            read()
        says(str(caught.value), f"{path}: ", "expected")


def test_a_file_that_may_not_be_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    small = SmallStudy(tmp_path)
    opened = Path.open

    def locked(path: Path, *arguments: Any, **options: Any) -> Any:
        if path.name == "bars.csv":
            raise PermissionError(13, "Permission denied")
        return opened(path, *arguments, **options)

    monkeypatch.setattr(Path, "open", locked)
    says(small.error(), "bars.csv: cannot be read (Permission denied)", "a readings file", "Check its permissions")
