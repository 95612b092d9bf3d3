"""What a file says of its own units holds: another one than is stated is an error, one that Ulna cannot read too."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
import scipy.io
from tests.cli_runs import write_lengths
from tests.small_study import says

from ulna import InputWarning, Study, UlnaInputError
from ulna.formats.own_units import ANGLES, LENGTHS


@pytest.fixture
def study(tmp_path: Path) -> Path:
    """Of length rows, in mm and rad."""
    return write_lengths(tmp_path)


def headed(study: Path, names: dict[str, str]) -> None:
    table = study.parent / "rows.csv"
    pl.read_csv(table).rename(names).write_csv(table)


def error(study: Path) -> str:
    with pytest.raises(UlnaInputError) as told:
        Study.load(study)
    return str(told.value)


@pytest.mark.parametrize("unit", sorted({*ANGLES.known, *ANGLES.others} - {"rad", "radian", "radians", "弧度"}))
def test_an_angle_in_another_unit_is_refused(study: Path, unit: str) -> None:
    headed(study, {"q3": f"q3 [{unit}]"})
    says(error(study), "rows.csv", f"column 'q3 [{unit}]' (q3)", f"the file says '{unit}'", "expected")


@pytest.mark.parametrize("unit", sorted({*LENGTHS.known, *LENGTHS.others}))
def test_a_length_in_another_unit_is_refused_and_in_the_stated_one_taken(study: Path, unit: str) -> None:
    expected = Study.load(study).readings[0].length_mm
    headed(study, {"length": f"Length ({unit})"})
    if LENGTHS.unit(unit) == "mm":
        with pytest.warns(InputWarning, match="as length"):
            assert np.array_equal(Study.load(study).readings[0].length_mm, expected)
    else:
        says(error(study), "rows.csv", f"column 'Length ({unit})' (length)", f"the file says '{unit}'", "expected")


def test_a_mapped_column_says_its_unit_too(study: Path) -> None:
    headed(study, {"length": "distance [m]"})
    text = study.read_text()
    study.write_text(text.replace('artefact = "rows"', 'artefact = "rows"\ncolumns = { length = "distance [m]" }', 1))
    says(error(study), "column 'distance [m]' (length)", "the file says 'm'", "said to be in mm")


def test_brackets_with_no_unit_say_nothing(study: Path) -> None:
    headed(study, {f"q{k}": f"q{k} (joint)" for k in range(1, 8)})
    with pytest.warns(InputWarning, match="columns taken by their names"):
        assert len(Study.load(study).readings[0]) == 101


def as_mat(study: Path, **more: object) -> dict[str, np.ndarray]:
    frame = pl.read_csv(study.parent / "rows.csv")
    held = {letter: frame.select([f"{letter}{k}" for k in range(1, 8)]).to_numpy() for letter in "qp"}
    study.write_text(study.read_text().replace("rows.csv", "rows.mat"))
    return {**held, "length": frame["length"].to_numpy(), **more}  # type: ignore[dict-item]


def test_two_poses_in_capitals_are_both_taken(study: Path) -> None:
    expected = Study.load(study).readings[0]
    held = as_mat(study)
    scipy.io.savemat(study.parent / "rows.mat", {"Q": held["q"], "P": held["p"], "length": held["length"]})
    with pytest.warns(InputWarning, match="'Q1' as q1.*'P7' as p7"):
        found = Study.load(study).readings[0]
    assert found.p_rad is not None
    assert np.array_equal(found.p_rad, expected.p_rad)


def test_a_struct_beside_the_arrays_is_named(study: Path) -> None:
    held = as_mat(study)
    scipy.io.savemat(study.parent / "rows.mat", {**held, "setup": {"operator": "A. B."}})
    with pytest.warns(InputWarning, match="not read: what is in setup"):
        Study.load(study)


def test_where_the_columns_are_is_said_when_they_are_in_a_struct(study: Path) -> None:
    held = as_mat(study)
    scipy.io.savemat(study.parent / "rows.mat", {"info": 1.0, "data": held})
    says(error(study), "'q1' is missing", 'There is more in data: dataset = "data" in [[readings]] reads that.')
    study.write_text(study.read_text().replace('artefact = "rows"', 'artefact = "rows"\ndataset = "data"', 1))
    assert len(Study.load(study).readings[0]) == 101


def test_one_column_beyond_two_turns_is_asked_for_its_unit(study: Path) -> None:
    table = study.parent / "rows.csv"
    pl.read_csv(table).with_columns(pl.col("q4") * 1000.0).write_csv(table)
    says(error(study), "column 'q4'", "more than two turns", "Only q4 is beyond: in another unit than the rest?")
