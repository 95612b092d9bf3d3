"""Which rows are used: filters, and the split into rows to fit and rows to check."""

from __future__ import annotations

import json
import re
import warnings
from pathlib import Path

import numpy as np
import polars as pl
import pytest
import scipy.io
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.cli_runs import assert_bad_input, run, write_lengths
from tests.foreign_tables import WRITERS, dialect, sheet
from tests.small_study import BARS, STUDY, SmallStudy, says

import ulna
from ulna import InputWarning, Study, UlnaInputError

TABLE = (
    pl.read_csv(BARS.encode())
    .drop("feature")
    .with_columns(
        series=pl.Series(list("AABBAABB")),
        status=pl.Series(["ok", "ok", "good", "good", "ok", "bad", "good", "good"]),
        air=pl.Series([17.5, 18.5, 20.0, 21.0, 22.0, 23.0, 24.0, 25.5]),
        set=pl.Series(["train"] * 4 + ["test"] * 3 + ["neither"]),
    )
)
SEAT = STUDY.replace('kind = "bar"\nlength = 443.172\nu = 0.001', 'kind = "seat"')
SPLIT = 'split = { column = "set", fit = "train", check = "test" }'


def study(folder: Path, keys: str, file: str = "t.csv", table: pl.DataFrame | None = TABLE) -> SmallStudy:
    small = SmallStudy(folder)
    if table is not None:
        table.write_csv(folder / "t.csv")
    small.write("study.toml", SEAT.replace('file = "bars.csv"\n', f'file = "{file}"\n{keys}\n'))
    return small


def rows_of(loaded: Study) -> list[int]:
    return loaded.readings[0].row.tolist()


def quietly(path: Path, rows: str) -> Study:
    """A study whatever is remarked upon."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        return Study.load(path, rows)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("where", "rows"),
    [
        ('{ series = "B" }', [3, 4, 7, 8]),
        ('{ status = ["ok", "good"] }', [1, 2, 3, 4, 5, 7, 8]),
        ("{ air = { above = 18.5 } }", [3, 4, 5, 6, 7, 8]),
        ("{ air = { below = 20 } }", [1, 2]),
        ("{ air = { above = 18, below = 25 } }", [2, 3, 4, 5, 6, 7]),
        ("{ placement = 2 }", [5, 6, 7, 8]),
        ('{ placement = "2" }', [5, 6, 7, 8]),
        ("{ air = [17.5, 24] }", [1, 7]),
        ('{ status = ["bad", 3] }', [6]),
        ('{ series = "B", status = "good", air = { above = 20 } }', [4, 7, 8]),
    ],
)
def test_a_filter(tmp_path: Path, where: str, rows: list[int]) -> None:
    loaded, warned = study(tmp_path, f"where = {where}").load()
    assert rows_of(loaded) == rows
    assert np.array_equal(loaded.readings[0].q_rad, TABLE.select("q1", "q2", "q3").to_numpy()[np.array(rows) - 1])
    says(warned[-1], f"t.csv: {8 - len(rows)} of 8 rows left out by", "'readings.1.where'", f"; {len(rows)} used")
    assert loaded.files[-1].rows == 8


def test_a_filter_by_the_files_name_or_by_ulnas(tmp_path: Path) -> None:
    mapped = 'columns = { temperature = "air" }\n'
    for name in ("air", "temperature"):
        loaded, _ = study(tmp_path, f"{mapped}where = {{ {name} = {{ above = 22 }} }}").load()
        assert rows_of(loaded) == [6, 7, 8]
    swapped = 'columns = { q1 = "q2", q2 = "q1" }\nwhere = { q1 = { above = 0 } }'  # the file's own names go first
    q1 = TABLE["q1"].to_numpy()
    assert rows_of(study(tmp_path, swapped).load()[0]) == (np.flatnonzero(q1 > 0) + 1).tolist()


@pytest.mark.parametrize("name", ["semicolons.csv", "table.parquet", "book.xlsx", "compressed.mat", "group.h5"])
def test_filters_are_the_same_in_every_format(tmp_path: Path, name: str) -> None:
    conditions = 'where = { series = "A", air = { above = 18 }, placement = [1, 2] }\n'
    small = study(tmp_path, conditions + WRITERS[name](TABLE, tmp_path / name), name)
    assert rows_of(small.load()[0]) == [2, 5, 6]


@given(st.lists(st.tuples(st.sampled_from("abc"), st.integers(0, 3)), min_size=1, max_size=20), st.sampled_from("abc"))
@settings(max_examples=25)
def test_a_filter_is_what_polars_filters(tmp_path_factory: pytest.TempPathFactory, rows: list, letter: str) -> None:
    table = pl.DataFrame({"q1": [k / 32 for k in range(len(rows))], "q2": 0.0, "q3": 0.0}).with_columns(
        word=pl.Series([word for word, _ in rows]), number=pl.Series([number for _, number in rows])
    )
    wanted = table.with_row_index("row", 1).filter((pl.col("word") == letter) & (pl.col("number") < 2))["row"]
    small = study(
        tmp_path_factory.mktemp("w"), f'where = {{ word = "{letter}", number = {{ below = 2 }} }}', table=table
    )
    if len(wanted):
        assert rows_of(small.load()[0]) == wanted.to_list()
    else:
        says(small.error(), "expected at least one")


def test_a_row_that_is_left_out_may_be_anything_but_another_number_of_cells(tmp_path: Path) -> None:
    lines = TABLE.write_csv().split("\n")
    bad = lines[6]
    small = study(tmp_path, 'where = { status = ["ok", "good"] }')
    for spoilt in (f"n/a,,{bad.split(',', 2)[2]}", f"nan,inf,{bad.split(',', 2)[2]}", f"99,99,{bad.split(',', 2)[2]}"):
        small.write("t.csv", "\n".join([*lines[:6], spoilt, *lines[7:]]))
        assert rows_of(small.load()[0]) == [1, 2, 3, 4, 5, 7, 8]
    small.swap("study.toml", '["ok", "good"]', '["ok", "bad"]')
    says(small.error(), "row 6 (line 7 of the file), column 'q1': got 99 rad")
    small.write("t.csv", "\n".join([*lines[:6], f"n/a,,{bad.split(',', 2)[2]}", *lines[7:]]))
    says(small.error(), "row 6 (line 7 of the file), column 'q1': got 'n/a'")
    small.swap("study.toml", '["ok", "bad"]', '["ok", "good"]')
    small.write("t.csv", "\n".join([*lines[:6], bad + ",1", *lines[7:]]))
    says(small.error(), "row 6 (line 7 of the file) has 9 cells, expected 8")
    small.write("t.csv", "\n".join([*lines[:6], "", *lines[6:]]))
    found, warned = small.load()
    assert rows_of(found) == [1, 2, 3, 4, 5, 7, 8]
    assert "blank rows are passed over: line 7." in " ".join(map(str, warned))


def test_bad_cells_beside_a_filter_in_other_formats(tmp_path: Path) -> None:
    gone = pl.when(pl.col("status") == "bad").then(None).otherwise(pl.col("q1"))
    table = TABLE.with_columns(q1=gone)
    for name, place in {"table.parquet": "row 6, ", "book.xlsx": "row 6 (Sheet1!A7), "}.items():
        WRITERS[name](table, tmp_path / name)
        small = study(tmp_path, 'where = { status = ["ok", "good"] }', name)
        assert rows_of(small.load()[0]) == [1, 2, 3, 4, 5, 7, 8]
        small = study(tmp_path, 'where = { series = "A" }', name)
        says(small.error(), f"{place}column 'q1': the cell is empty")


def test_an_empty_cell_meets_no_condition(tmp_path: Path) -> None:
    table = TABLE.with_columns(
        status=pl.Series(["ok", "", "ok", None, "ok", "ok", "ok", "ok"]), air=pl.Series([1.0, 1, 1, 1, None, 1, 1, 1])
    )
    small = study(tmp_path, 'where = { status = "ok", air = { below = 2 } }', table=table)
    assert rows_of(small.load()[0]) == [1, 3, 6, 7, 8]
    sheet(table, tmp_path / "b.xlsx")
    assert rows_of(study(tmp_path, 'where = { status = "ok", air = { below = 2 } }', "b.xlsx").load()[0]) == [
        1,
        3,
        6,
        7,
        8,
    ]


def test_decimal_commas_are_numbers_to_a_filter_too(tmp_path: Path) -> None:
    keys = dialect(";", ",")(TABLE, tmp_path / "s.csv")
    small = study(tmp_path, keys + "where = { air = { above = 21.5 } }", "s.csv")
    assert rows_of(small.load()[0]) == [5, 6, 7, 8]


WRONG: dict[str, tuple[str, tuple[str, ...]]] = {
    "no such column": (
        'where = { serie = "B" }',
        ("'readings.1.where'", "no column 'serie'", "Did you mean 'series'?"),
    ),
    "no such value": (
        'where = { series = "C" }',
        ("'readings.1.where.series'", "no row", "matches 'C'", "Column 'series' has 'A', 'B'."),
    ),
    "nothing in a range": (
        "where = { air = { above = 100 } }",
        ("'readings.1.where.air'", "above 100", "has numbers from 17.5 to 25.5"),
    ),
    "nothing meets all": ('where = { series = "B", status = "bad" }', ("'readings.1.where'", "no row meets all")),
    "texts for numbers": (
        "where = { series = 2 }",
        ("row 1 (line 2", "column 'series': got 'A', expected a number", "texts in quotes"),
    ),
    "texts for a range": ("where = { status = { above = 2 } }", ("row 1 (line 2", "column 'status': got 'ok'")),
    "limits the wrong way round": (
        "where = { air = { above = 3, below = 2 } }",
        ("'readings.1.where.air'", "the smaller"),
    ),
    "no limits": ("where = { air = {} }", ("'readings.1.where.air'", "above, below, or both")),
    "another limit": ("where = { air = { abov = 2 } }", ("'readings.1.where.air.abov'", "Did you mean 'above'?")),
    "truth": ("where = { air = true }", ("'readings.1.where.air'", "got True", "a text in quotes, a number, a list")),
    "a date": ("where = { air = 2020-01-01 }", ("'readings.1.where.air'", "got 2020-01-01", "a text in quotes")),
    "no condition": ("where = {}", ("'readings.1.where'", "at least 1 entries")),
    "split by nothing": (SPLIT.replace('"set"', '"sets"'), ("'readings.1.split.column'", "Did you mean 'set'?")),
    "nothing to fit": (
        SPLIT.replace("train", "trian"),
        ("'readings.1.split.fit'", "matches 'trian'", "Column 'set' has 'train', 'test', 'neither'."),
    ),
    "both": (SPLIT.replace('"test"', '["test", "train"]'), ("'readings.1.split'", "a value in common")),
    "half a split": (SPLIT.replace(', check = "test"', ""), ("key 'readings.1.split.check' is missing",)),
}


@pytest.mark.parametrize("case", WRONG)
def test_what_a_filter_or_a_split_is_told(tmp_path: Path, case: str) -> None:
    keys, fragments = WRONG[case]
    says(study(tmp_path, keys).error(), str(tmp_path), *fragments)


def test_a_split(tmp_path: Path) -> None:
    path = study(tmp_path, SPLIT).path
    expected = {"fit": [1, 2, 3, 4], "check": [5, 6, 7], "all": [1, 2, 3, 4, 5, 6, 7]}
    loaded, warned = study(tmp_path, SPLIT).load()
    assert rows_of(loaded) == expected["fit"]
    says(warned[-1], "t.csv: 1 row neither fitted nor checked", "'readings.1.split'", "'set' they have 'neither'")
    for rows, numbers in expected.items():
        loaded = quietly(path, rows)
        assert (rows_of(loaded), loaded.rows) == (numbers, rows)
    several = study(tmp_path, 'split = { column = "placement", fit = [1, 7], check = 2 }\nwhere = { series = "B" }')
    assert rows_of(several.load()[0]) == [3, 4]
    with pytest.raises(UlnaInputError, match=r"rows 'chek'; expected fit, check or all.*Did you mean 'check'\?"):
        Study.load(path, "chek")  # type: ignore[arg-type]


def test_rows_to_check_where_there_are_none(tmp_path: Path) -> None:
    small = study(tmp_path, "")
    with pytest.raises(UlnaInputError, match=r"no \[\[readings\]\] has the key 'split'.*or ask for all rows"):
        Study.load(small.path, "check")
    small = study(tmp_path, SPLIT.replace('"test"', '"tset"'))
    with pytest.raises(UlnaInputError, match=r"'readings\.1\.split\.check': no row of .* matches 'tset'"):
        Study.load(small.path, "check")


def test_a_file_without_a_split_is_there_to_fit(tmp_path: Path) -> None:
    small = study(tmp_path, SPLIT)
    TABLE.select("q1", "q2", "q3", "placement").write_csv(tmp_path / "more.csv")
    more = '[[readings]]\nfile = "more.csv"\nprobe = "straight"\n\n[artefact.cone]\nkind = "seat"\n\n[artefact.bar]'
    small.swap("study.toml", "[artefact.bar]", more.replace('probe = "', 'artefact = "cone"\nprobe = "'))
    loaded = {rows: quietly(small.path, rows) for rows in ("fit", "check", "all")}
    sizes = {rows: [len(group) for group in each.readings] for rows, each in loaded.items()}
    assert sizes == {"fit": [8, 4], "check": [3], "all": [8, 7]}
    assert not any("no reading touches" in warning for each in loaded.values() for warning in each.warnings)


@pytest.fixture(scope="module")
def halves(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of lengths, every second row kept to check the fit; and an arm fitted to the others."""
    folder = tmp_path_factory.mktemp("halves")
    path = write_lengths(folder)
    path.write_text(
        path.read_text().replace(
            "[artefact", 'split = { column = "placement", fit = "left", check = "right" }\n[artefact'
        )
    )
    done = run("calibrate", path, "-o", folder / "out")
    assert done.returncode == 0, done.stderr
    return folder


def test_the_commands_fit_and_judge_different_rows(halves: Path) -> None:
    result = json.loads((halves / "out" / "result.json").read_text())
    assert result["fit"]["readings"] == 50
    assert result["provenance"]["rows"] == "fit"
    found = {}
    for rows in (None, "check", "fit", "all"):
        more = [] if rows is None else ["--rows", rows]
        done = run("evaluate", halves / "out" / "result.json", halves / "study.toml", "--json", *more)
        assert done.returncode == 0, done.stderr
        found[rows] = json.loads(done.stdout)
    assert [found[rows]["fit"]["readings"] for rows in (None, "check", "fit", "all")] == [51, 51, 50, 101]
    assert found[None]["overall"] == found["check"]["overall"]
    assert found[None]["provenance"]["rows"] == "check"
    assert found["fit"]["overall"]["length_error_rms_mm"] < found["check"]["overall"]["length_error_rms_mm"]
    shown = run("evaluate", halves / "out" / "result.json", halves / "study.toml")
    assert "51 readings kept to check the fit, the arm unchanged." in re.sub(r"\s+", " ", shown.stdout)
    assert_bad_input(
        run("evaluate", halves / "out" / "result.json", halves / "study.toml", "--rows", "chek"), "'check'?"
    )
    again = json.loads(run("cross-validate", halves / "study.toml", "--by", "2", "--json").stdout)
    assert sum(group["readings"] for group in again["groups"]) == 50


def test_evaluate_without_a_split_judges_all(tmp_path: Path) -> None:
    path = write_lengths(tmp_path)
    done = run("evaluate", tmp_path / "start.toml", path, "--json")
    assert json.loads(done.stdout)["fit"]["readings"] == 101
    assert "rows" not in json.loads(done.stdout)["provenance"]
    assert_bad_input(run("evaluate", tmp_path / "start.toml", path, "--rows", "check"), "the key 'split'")
    study_in_memory = ulna.Study.load(path, "all")
    assert study_in_memory.rows is None


def test_a_filter_by_an_array_of_another_length(tmp_path: Path) -> None:
    keys = WRITERS["plain.mat"](TABLE, tmp_path / "t.mat")
    contents = scipy.io.loadmat(tmp_path / "t.mat")
    kept = {name: values for name, values in contents.items() if not name.startswith("_")}
    scipy.io.savemat(tmp_path / "t.mat", kept | {"air": kept["air"][:5]})
    small = study(tmp_path, f"{keys}where = {{ air = {{ above = 18 }} }}", "t.mat")
    says(small.error(), "t.mat: air has 5 rows, the readings 8", "'readings.1'", "Correct the arrays")
