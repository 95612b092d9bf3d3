"""The same table in every format gives the same study, whoever wrote it."""

from __future__ import annotations

import tempfile
from pathlib import Path

import h5py
import numpy as np
import polars as pl
import pytest
import scipy.io
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.foreign_tables import WRITERS, cells, dialect, hdf5, mat, sheet
from tests.small_study import BARS, STUDY, SmallStudy

from ulna.study.study import Study

TABLE = pl.read_csv(BARS.encode())
Q = TABLE.select("q1", "q2", "q3").to_numpy()

#: three seats on a plate, so that any table of touches makes sense
PLATE = STUDY.replace(
    'kind = "bar"\nlength = 443.172\nu = 0.001',
    'kind = "points"\nfeatures = { A = [0, 0, 0], B = [1, 0, 0], "inner corner" = [0, 1, 0] }',
).replace('probe = "bent"\n', "")


def study_of(small: SmallStudy, file: str, keys: str, text: str = STUDY) -> Study:
    """The small study with another readings file; whatever is remarked upon is allowed."""
    small.write("study.toml", text.replace('file = "bars.csv"\n', f'file = "{file}"\n{keys}'))
    return small.load()[0]


def contents(study: Study) -> list[tuple[object, ...]]:
    """All that readings say, to be compared exactly."""
    return [
        (
            group.artefact,
            group.q_rad.tolist(),
            group.probe.tolist(),
            group.feature.tolist(),
            group.placement.tolist(),
            group.row.tolist(),
            None if group.id is None else group.id.tolist(),
            None if group.temperature_c is None else group.temperature_c.tolist(),
        )
        for group in study.readings
    ]


@st.composite
def tables(draw: st.DrawFn) -> pl.DataFrame:
    """Touches of the plate: any finite angles that an arm can have, labels that are numbers or words."""
    rows = draw(st.integers(2, 9))
    # openpyxl writes sixteen digits of a number, where seventeen tell all numbers apart
    angle = st.floats(-12.5, 12.5).map(lambda number: round(number, 12))
    q1 = draw(st.lists(angle, min_size=rows, max_size=rows, unique=True))
    columns: dict[str, object] = {"q1": q1}
    for name in ("q2", "q3", "temperature"):
        columns[name] = draw(st.lists(angle, min_size=rows, max_size=rows))
    labels = draw(
        st.sampled_from([st.integers(-5, 10**9), st.sampled_from(["left", "north-west", "Größe 2", "µ", "x y"])])
    )
    for name, choice in {
        "placement": labels,
        "feature": st.sampled_from(["A", "B", "inner corner"]),
        "probe": st.sampled_from(["bent", "straight"]),
    }.items():
        columns[name] = draw(st.lists(choice, min_size=rows, max_size=rows))
    columns["id"] = list(range(rows))
    return pl.DataFrame(columns)


@given(tables())
@settings(max_examples=25)
def test_the_same_table_in_every_format_is_the_same_study(table: pl.DataFrame) -> None:
    with tempfile.TemporaryDirectory() as folder:
        small = SmallStudy(Path(folder))
        found = {}
        for name, write in WRITERS.items():
            keys = write(table, Path(folder) / name)
            found[name] = contents(study_of(small, name, keys, PLATE))
    for name, each in found.items():
        assert each == found["commas.csv"], name


@pytest.mark.parametrize("name", WRITERS)
def test_a_format_is_recognised_by_what_is_in_the_file(tmp_path: Path, name: str) -> None:
    small = SmallStudy(tmp_path)
    expected = contents(study_of(small, "bars.csv", ""))
    keys = WRITERS[name](TABLE, tmp_path / "readings.bin")
    study = study_of(small, "readings.bin", keys)
    assert contents(study) == expected
    assert study.files[-1].rows == 8


@pytest.mark.parametrize("name", WRITERS)
def test_only_columns_that_are_used_need_be_filled(tmp_path: Path, name: str) -> None:
    small = SmallStudy(tmp_path)
    remarks = ["", "blurred", "", "", "", "", "", ""]
    if name in ("columns.hdf5", "compound.h5", "plain.mat"):
        remarks = ["nan"] * 8
    keys = WRITERS[name](
        TABLE.with_columns(force=pl.Series([float("nan")] * 8), remark=pl.Series(remarks)), tmp_path / name
    )
    keys = keys.replace(', force = "c6", remark = "c7"', "")
    study = study_of(small, name, keys)
    assert len(study.readings[0]) == 8
    (remark,) = [warning for warning in study.warnings if "not used" in warning]
    assert ("c6, c7" if name == "bars.dat" else "force") in remark


def test_numbers_of_other_types(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    degrees = np.round(np.degrees(Q)).astype(np.int16)
    text = STUDY.replace('angle = "rad"\nart', 'angle = "deg"\nart')
    for kind in ("i2", ">i4", "f4", ">f8", "u8"):
        data = np.abs(degrees).astype(kind)
        with h5py.File(tmp_path / "q.h5", "w") as file:
            file["q"] = data
            file["placement"] = TABLE["placement"].to_numpy().astype(">u2")
            file["feature"] = TABLE["feature"].to_list()
        assert study_of(small, "q.h5", "", text).readings[0].q_rad == pytest.approx(np.radians(np.abs(degrees)))
        row = TABLE["placement"].to_numpy()[np.newaxis]
        letters = np.array(TABLE["feature"].to_list())  # a matrix of characters
        scipy.io.savemat(tmp_path / "q.mat", {"q": data, "placement": row, "feature": letters})
        group = study_of(small, "q.mat", "", text).readings[0]
        assert group.q_rad == pytest.approx(np.radians(np.abs(degrees)))
        assert group.placement.tolist() == ["1"] * 4 + ["2"] * 4
        assert group.feature.tolist() == [0, 0, 1, 1] * 2


def test_labels_that_are_numbers_are_the_same_in_every_format(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    table = TABLE.with_columns(placement=pl.Series([3.0] * 4 + [2.5] * 4))
    found = []
    for name, write in {"a.xlsx": sheet, "a.mat": mat(), "a.h5": hdf5, "a.parquet": WRITERS["table.parquet"]}.items():
        keys = write(table, tmp_path / name)
        found.append(study_of(small, name, keys).readings[0].placement.tolist())
    assert found == [["3"] * 4 + ["2.5"] * 4] * 4


def test_cells_of_a_cell_array_may_be_numbers_or_empty_where_nobody_looks(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    variables = {
        "q": Q,
        "placement": cells([1.0, 1.0, "1", 1.0, 2.5, 2.5, 2.5, 2.5]),
        "feature": cells(list("AABBAABB")),
    }
    scipy.io.savemat(tmp_path / "c.mat", variables | {"note": cells(["", "x"] + [np.zeros((2, 2))] * 6)})
    group = study_of(small, "c.mat", "").readings[0]
    assert group.placement.tolist() == ["1"] * 4 + ["2.5"] * 4


def test_blank_rows_and_columns_around_a_sheet_are_harmless(tmp_path: Path) -> None:
    import openpyxl.styles

    def surround(page: openpyxl.worksheet.worksheet.Worksheet) -> None:
        page.insert_cols(1)
        page.insert_cols(4)
        page["C12"] = "  "
        page["B40"].font = openpyxl.styles.Font(bold=True)

    small = SmallStudy(tmp_path)
    expected = contents(study_of(small, "bars.csv", ""))
    sheet(TABLE, tmp_path / "b.xlsx", edit=surround)
    assert contents(study_of(small, "b.xlsx", "")) == expected


def test_columns_by_other_names(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    expected = contents(study_of(small, "bars.csv", ""))
    names = {"q1": "shoulder", "q2": "q3", "q3": "q2", "placement": "Aufstellung", "feature": "seat"}
    keys = "columns = { " + ", ".join(f'{ours} = "{theirs}"' for ours, theirs in names.items()) + " }\n"
    for name, write in {"a.csv": dialect(";", ","), "a.parquet": WRITERS["table.parquet"], "a.xlsx": sheet}.items():
        more = write(TABLE.rename(names), tmp_path / name)
        assert contents(study_of(small, name, more + keys)) == expected, name
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["shoulder"], file["q2"], file["q3"] = Q[:, 0], Q[:, 2], Q[:, 1]
        file["Aufstellung"], file["seat"] = TABLE["placement"].to_numpy(), TABLE["feature"].to_list()
    assert contents(study_of(small, "a.h5", keys)) == expected
