"""`Study.from_frame`: a frame is what the file would be, to the last digit, whatever library it is of."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import polars as pl
import pytest
from tests.small_study import SmallStudy

import ulna
from ulna import InputWarning, Study, UlnaInputError

ROOT = Path(__file__).resolve().parents[2]
PLATINUM = ROOT / "examples" / "platinum"
BAR = {"bar": {"kind": "bar", "length_mm": 443.172}}
HOLD = ["joint.1.theta0", "joint.1.d"]
SAID: dict[str, Any] = {"angle": "rad", "encoder_u_rad": 5e-6, "seat_u_mm": 0.008, "hold": HOLD}


def bars() -> pl.DataFrame:
    return pl.read_csv(PLATINUM / "bars.csv")


FRAMES = {
    "polars": lambda table: table,
    "lazy": lambda table: table.lazy(),
    "pandas": lambda table: pd.DataFrame(table.to_dict(as_series=False)),
    "pandas with gaps in its index": lambda table: pd.DataFrame(table.to_dict(as_series=False)).set_index(
        pd.Index(range(7, 7 + 3 * len(table), 3))
    ),
    "arrow": lambda table: table.to_arrow(),
    "dict of arrays": lambda table: {name: table[name].to_numpy() for name in table.columns},
    "dict with an array of angles": lambda table: {
        "q": table.select(r"^q\d$").to_numpy(),
        "feature": table["feature"].to_list(),
        "placement": table["placement"].to_list(),
    },
    "records": lambda table: table.to_dicts(),
    "structured array": lambda table: table.to_numpy(structured=True),
}


def same_readings(one: Study, other: Study) -> None:
    for ours, theirs in zip(one.readings, other.readings, strict=True):
        assert ours.artefact == theirs.artefact
        np.testing.assert_array_equal(ours.q_rad, theirs.q_rad)
        for name in ("feature", "probe", "row", "placement_code"):
            np.testing.assert_array_equal(getattr(ours, name), getattr(theirs, name))
        assert list(ours.placement) == list(theirs.placement)


@pytest.mark.parametrize("make", FRAMES.values(), ids=FRAMES)
def test_every_frame_is_the_file(make: Any) -> None:
    of_file = Study.load(PLATINUM / "study.toml")
    of_frame = Study.from_frame(PLATINUM / "platinum.toml", make(bars()), BAR, **SAID)
    same_readings(of_frame, of_file)
    assert of_frame.fit == of_file.fit
    assert of_frame.noise is not None
    np.testing.assert_array_equal(of_frame.noise.encoder_rad, of_file.noise.encoder_rad)  # type: ignore[arg-type, union-attr]


def test_the_results_are_the_same_to_the_last_digit(tmp_path: Path) -> None:
    of_file = ulna.calibrate(PLATINUM / "study.toml")
    of_frame = ulna.calibrate(Study.from_frame(ulna.Arm.load(PLATINUM / "platinum.toml"), bars(), BAR, **SAID))
    assert of_frame.parameters == of_file.parameters
    np.testing.assert_array_equal(of_frame.covariance.matrix, of_file.covariance.matrix)
    assert of_frame.after == of_file.after
    assert of_frame.residuals.drop("file").equals(of_file.residuals.drop("file"))
    of_frame.save(tmp_path)
    kept = ulna.Result.load(tmp_path).provenance
    (file,) = kept["files"]
    assert (kept["study"], file["path"], file["rows"]) == (None, "frame", 202)


def test_the_digest_is_of_the_numbers_whatever_holds_them() -> None:
    digests = {
        Study.from_frame(PLATINUM / "platinum.toml", make(bars()), BAR, **SAID).files[-1].sha256
        for name, make in FRAMES.items()
        if "array of angles" not in name
    }
    assert len(digests) == 1
    other = bars().with_columns(pl.when(pl.int_range(202) == 7).then(pl.col("q3") + 1e-12).otherwise("q3").alias("q3"))
    assert Study.from_frame(PLATINUM / "platinum.toml", other, BAR, **SAID).files[-1].sha256 not in digests


@pytest.mark.parametrize("name", ["q{}_deg", "q{} [deg]", "Q{} (°)"])
def test_units_in_the_names(name: str) -> None:
    table = bars()
    named = table.select(
        "feature", "placement", *((pl.col(f"q{k}") * 180 / np.pi).alias(name.format(k)) for k in range(1, 8))
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        found = Study.from_frame(PLATINUM / "platinum.toml", named, BAR)
    of_file = Study.load(PLATINUM / "study.toml")
    np.testing.assert_allclose(found.readings[0].q_rad, of_file.readings[0].q_rad, rtol=0, atol=1e-15)
    with pytest.raises(UlnaInputError, match=r"the file says|said to be in rad"):
        Study.from_frame(PLATINUM / "platinum.toml", named, BAR, angle="rad")


def test_lengths_have_their_units() -> None:
    """The bar in metres, by its key and by what is stated, and points of a tracker in metres by their names."""
    common = (PLATINUM / "platinum.toml", bars())
    for artefacts, unit in (({"bar": {"kind": "bar", "length": 0.443172}}, "m"), (BAR, None), (BAR, "m")):
        study = Study.from_frame(*common, artefacts, angle="rad", length_unit=unit)
        assert study.readings[0].artefact.length_mm == pytest.approx(443.172, rel=1e-15)
    arm = ulna.Arm.load(PLATINUM / "platinum.toml")
    table = bars().select(r"^q\d$")
    tips = arm.tip(table.to_numpy()) / 1000.0
    named = table.with_columns(pl.Series(f"{axis}_m", tips[:, k]) for k, axis in enumerate("xyz"))
    points = {"tracker": {"kind": "points", "frame": "arm"}}
    study = Study.from_frame(arm, named, points, angle="rad")
    features = np.array(list(study.readings[0].artefact.features.values()))
    np.testing.assert_allclose(features, arm.tip(table.to_numpy()), rtol=0, atol=1e-9)
    plain = named.rename({f"{axis}_m": axis for axis in "xyz"})
    with pytest.raises(UlnaInputError, match=r"column 'x': its unit is not stated.*length_unit"):
        Study.from_frame(arm, plain, points, angle="rad")


GERMAN = {"placement": "Aufstellung", "feature": "Kugel"} | {f"q{k}": f"Achse {k} [rad]" for k in range(1, 8)}


def kept() -> pl.DataFrame:
    """The bars as somebody keeps them: other headings, other labels, cells that mean the one above."""
    table = bars().rename(GERMAN).with_columns(pl.col("Kugel").replace({"A": "links", "B": "rechts"}))
    first = pl.int_range(len(table)) % 2 == 0
    return table.with_columns(pl.when(first).then("Aufstellung").alias("Aufstellung"), pl.lit("").alias("Bemerkung"))


def test_columns_are_recognised_where_that_is_asked_for_and_shown() -> None:
    arm = PLATINUM / "platinum.toml"
    for table in (kept(), pd.DataFrame(kept().to_dict(as_series=False))):
        found = Study.from_frame(arm, table, BAR, guess=True)
        same_readings(found, Study.load(PLATINUM / "study.toml"))
        assert {each.ours: each.column for each in found.taken if each.ours} == GERMAN
        for text in (repr(found), found._repr_html_()):
            for column in GERMAN.values():
                assert column in text, "what was guessed is shown"
    with pytest.raises(UlnaInputError, match="guess = True"):
        Study.from_frame(arm, kept(), BAR)


def test_what_is_stated_goes_before_what_is_guessed() -> None:
    swapped = {"feature": {"A": "rechts", "B": "links"}}
    found = Study.from_frame(PLATINUM / "platinum.toml", kept(), BAR, guess=True, names=swapped)
    of_file = Study.load(PLATINUM / "study.toml")
    np.testing.assert_array_equal(found.readings[0].feature, 1 - of_file.readings[0].feature)


def test_what_leaves_a_doubt_is_asked() -> None:
    with pytest.raises(
        UlnaInputError, match=r"which column says what was touched.*where the artefact stood.*arguments"
    ):
        Study.from_frame(PLATINUM / "platinum.toml", kept().drop("Kugel", "Aufstellung"), BAR, guess=True)
    with pytest.raises(UlnaInputError, match=r"arm 'virtual Platinum.*' has 7 joints"):
        Study.from_frame(PLATINUM / "platinum.toml", kept().drop("Achse 7 [rad]"), BAR, guess=True)


def test_filters_and_splits_as_in_a_study(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    table = pl.read_csv(tmp_path / "bars.csv").with_columns(pl.Series("set", ["train"] * 4 + ["test"] * 4))
    table.write_csv(tmp_path / "bars.csv")
    small.swap(
        "study.toml", 'probe = "bent"', 'probe = "bent"\nsplit = { column = "set", fit = "train", check = "test" }'
    )
    artefacts = {"bar": {"kind": "bar", "length_mm": 443.172, "u_mm": 0.001}}
    split = {"column": "set", "fit": "train", "check": "test"}
    for rows in ("fit", "check", "all"):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", InputWarning)
            of_file = Study.load(small.path, rows)  # type: ignore[arg-type]
            found = Study.from_frame(
                tmp_path / "arm.toml", table, artefacts, angle="rad", probe="bent", split=split, rows=rows
            )
        same_readings(found, of_file)
        assert found.rows == of_file.rows == rows


@pytest.mark.parametrize(
    ("change", "said", "expected"),
    [
        ({"q3": None}, {}, "there are no columns q1 … q7|the column 'q3' is missing"),
        ({"q3": "0,5"}, {}, r"frame: row 1 \(counted from 1\), column 'q3': got '0,5'"),
        ({"q3": float("nan")}, {}, r"frame: row 1 \(counted from 1\), column 'q3': the cell is empty"),
        ({"feature": "C"}, {}, r"row 1 \(counted from 1\), column 'feature': got 'C'"),
        ({"q1": 99.0}, {}, r"row 1 .*column 'q1': got 99 rad, more than two turns"),
        ({}, {"angle": None}, "the unit of the angles is not stated, and never guessed"),
        ({}, {"angle": "degrees"}, "key 'angle': got 'degrees'"),
        ({}, {"columns": {"q9": "q1"}}, "'q9' is no column that Ulna knows"),
        ({}, {"hold": ["jiont.*"]}, "matches no parameter"),
        ({}, {"nothing": 1}, "there is no fit option 'nothing'"),
        ({}, {"seat_u_mm": -1.0}, "expected standard deviations above 0"),
        ({}, {"where": {"Status": "ok"}}, "there is no column 'Status' in frame"),
    ],
)
def test_what_cannot_be_used_is_told(change: dict[str, Any], said: dict[str, Any], expected: str) -> None:
    table = bars().to_dict(as_series=False)
    for name, value in change.items():
        if value is None:
            del table[name]
        else:
            table[name] = [value] * len(table[name])
    with pytest.raises(UlnaInputError, match=expected) as caught:
        Study.from_frame(PLATINUM / "platinum.toml", table, BAR, **{**SAID, **said})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("artefacts", "expected"),
    [
        ({"bar": {"kind": "bar", "length": 443.172}}, "key 'artefact.bar.length': its unit is not stated"),
        ({"bar": {"kind": "bor", "length_mm": 1}}, "Did you mean 'bar'"),
        ({"bar": {"kind": "bar"}}, "key 'artefact.bar.length' is missing"),
        ({"bar": {"kind": "bar", "lenght_mm": 1}}, "Did you mean 'length'"),
        ({"bar": {"kind": "bar", "length_mm": -1.0}}, "expected a number greater than 0"),
    ],
)
def test_artefacts_that_cannot_be(artefacts: Any, expected: str) -> None:
    with pytest.raises(UlnaInputError, match=expected):
        Study.from_frame(PLATINUM / "platinum.toml", bars(), artefacts, **SAID)


@pytest.mark.parametrize(
    ("frame", "artefacts", "expected"),
    [
        (3, BAR, "got an int, expected a table"),
        (np.zeros((3, 7)), BAR, "got an ndarray, expected a table"),
        ("bars.csv", BAR, "got a str, expected a table"),
        (bars(), 443.172, "got a float, expected artefacts"),
        (bars(), {"bar": 443.172}, "got a float, expected artefacts"),
        (bars(), None, "got None, expected artefacts"),
    ],
)
def test_a_wrong_type_is_one_sentence(frame: Any, artefacts: Any, expected: str) -> None:
    with pytest.raises(TypeError, match=expected) as caught:
        Study.from_frame(PLATINUM / "platinum.toml", frame, artefacts, **SAID)
    assert "\n" not in str(caught.value)


def test_artefacts_as_objects_and_alone() -> None:
    arm, table = PLATINUM / "platinum.toml", bars()
    artefact = Study.load(PLATINUM / "study.toml").readings[0].artefact
    given = [artefact, [artefact], {"bar": artefact}, BAR, BAR["bar"]]
    found = [Study.from_frame(arm, table, each, **SAID).readings[0].artefact for each in given]
    assert all(each == artefact for each in found)


def test_columns_of_several_lengths() -> None:
    with pytest.raises(UlnaInputError, match="different lengths"):
        Study.from_frame(PLATINUM / "platinum.toml", {"q1": [1.0], "q2": [1.0, 2.0]}, BAR, **SAID)
    twice = pd.DataFrame([[1.0, 2.0]], columns=["q1", "q1"])
    with pytest.raises(UlnaInputError, match="the column 'q1' appears twice"):
        Study.from_frame(PLATINUM / "platinum.toml", twice, BAR, **SAID)
