"""Readings that bring the coordinates of what they touched, and features from tables of every format."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.foreign_tables import WRITERS, cells, dialect, sheet
from tests.small_study import ARM, BARS, STUDY, SmallStudy, says

import ulna
from ulna import InputWarning, Study
from ulna.exchange.importers.ipa import import_ipa_ur10
from ulna.exchange.importers.robots import ur10

DATA = Path(__file__).parents[3] / "shared" / "data"
XYZ = np.random.default_rng(3).uniform(-900, 900, (8, 3)).round(4)
TABLE = pl.read_csv(BARS.encode()).drop("feature").with_columns(x=XYZ[:, 0], y=XYZ[:, 1], z=XYZ[:, 2])
TRACKER = STUDY.replace('kind = "bar"\nlength = 443.172\nu = 0.001', 'kind = "points"')


def tracker(folder: Path, table: pl.DataFrame = TABLE, text: str = TRACKER) -> SmallStudy:
    small = SmallStudy(folder)
    table.write_csv(folder / "bars.csv")
    small.write("study.toml", text)
    return small


def test_every_reading_has_a_point_of_its_own(tmp_path: Path) -> None:
    study, warned = tracker(tmp_path).load()
    assert warned == []
    (group,) = study.readings
    assert list(group.artefact.features) == [f"m{row}" for row in range(1, 9)]
    assert np.array_equal(np.array(list(group.artefact.features.values())), XYZ)
    assert group.feature.tolist() == list(range(8))
    assert group.placement.tolist() == ["1"] * 4 + ["2"] * 4
    assert (group.artefact.kind, group.artefact.frame, group.artefact.u_mm) == ("points", "free", 0.0)


def test_it_is_the_same_as_with_a_table_of_features(tmp_path: Path) -> None:
    text = TRACKER.replace('"points"', '"points"\nu = 0.01\nframe = "arm"')
    own, _ = tracker(tmp_path, text=text).load()
    named = TABLE.with_columns(feature=pl.format("m{}", pl.int_range(1, 9)))
    small = tracker(tmp_path, named.drop("x", "y", "z"), text.replace('"arm"\n', '"arm"\nfeatures = "plate.csv"\n'))
    small.write("plate.csv", named.select("feature", "x", "y", "z").write_csv())
    given, _ = small.load()
    assert own.readings[0].artefact == given.readings[0].artefact
    residuals = [ulna.evaluate(study.arm, study).residuals for study in (own, given)]
    assert residuals[0].equals(residuals[1])


def test_units_ids_and_the_file_s_rows(tmp_path: Path) -> None:
    table = TABLE.with_columns(id=pl.Series(list("abcdefgh")), good=pl.Series([1, 0, 1, 1, 1, 1, 1, 1]))
    text = TRACKER.replace('length = "mm"', 'length = "m"').replace('angle = "rad"\nart', "where = { good = 1 }\nart")
    study, _ = tracker(tmp_path, table, text).load()
    features = study.readings[0].artefact.features
    assert list(features) == list("acdefgh")
    assert features["c"] == pytest.approx(XYZ[2] * 1000)
    study, _ = tracker(tmp_path, table.drop("id"), text).load()
    assert list(study.readings[0].artefact.features) == ["m1", *(f"m{row}" for row in range(3, 9))]


def test_each_point_has_its_own_uncertainty(tmp_path: Path) -> None:
    u = pl.Series("u", [0.01] * 7 + [0.02])
    study, warned = tracker(tmp_path, TABLE.with_columns(u)).load()
    assert (study.readings[0].artefact.feature_u_mm, warned) == ((*[0.01] * 7, 0.02), [])
    small = tracker(tmp_path, TABLE.with_columns(-u))
    says(small.error(), "row 1 (line 2 of the file), column 'u': got -0.01", "0 or more")
    small = tracker(tmp_path, TABLE.with_columns(u), TRACKER.replace('"points"', '"points"\nu = 0.1'))
    says(small.error(), "study.toml: key 'artefact.bar.u': got 0.1", "bars.csv has a column 'u'", "Remove one of them")


def test_what_is_missing_or_not_used(tmp_path: Path) -> None:
    says(
        tracker(tmp_path, TABLE.drop("y")).error(),
        "bars.csv: the column 'y' is missing: artefact 'bar' has no features",
        "columns x, y, z, in mm",
        "artefact.bar.features in",
    )
    _, warned = tracker(tmp_path, TABLE.with_columns(feature=pl.lit("A"))).load()
    says(warned[0], "bars.csv: the names of features are not used", "'bar' has none of its own")
    says(tracker(tmp_path, TABLE.rename({"y": "Y"})).error(), "unknown column 'Y'. Did you mean 'y'?")
    gap = TABLE.with_columns(z=pl.Series([1.0, None, *[2.0] * 6]))
    says(tracker(tmp_path, gap).error(), "row 2 (line 3 of the file), column 'z': the cell is empty")
    _, warned = tracker(tmp_path, TABLE, TRACKER.replace('"points"', '"seat"')).load()
    says(warned[0], "not used: the columns x, y, z")


def test_the_same_angles_seen_elsewhere_are_scatter_and_copies_are_remarked_upon(tmp_path: Path) -> None:
    again = pl.concat([TABLE, TABLE.head(1).with_columns(x=pl.col("x") + 0.01)])
    study, warned = tracker(tmp_path, again).load()
    assert (len(study.readings[0].artefact.features), warned) == (9, [])
    _, warned = tracker(tmp_path, pl.concat([TABLE, TABLE.head(2)])).load()
    says(warned[0], "2 rows of artefact 'bar' repeat another exactly: rows 9 (as row 1), 10 (as row 2)")
    same_id = pl.concat([TABLE, TABLE.head(1)]).with_columns(id=pl.Series([*"abcdefgh", "a"]))
    study, warned = tracker(tmp_path, same_id).load()
    assert study.readings[0].feature.tolist() == [*range(8), 0]
    other = same_id.with_columns(x=pl.int_range(9).cast(pl.Float64))
    says(tracker(tmp_path, other).error(), "row 9 (line 10 of the file), column 'id': 'a' stands in row 1 already")


def test_points_of_several_files(tmp_path: Path) -> None:
    text = TRACKER.replace(
        "[artefact.bar]", '[[readings]]\nfile = "more.csv"\nprobe = "bent"\nartefact = "bar"\n\n[artefact.bar]'
    )
    small = tracker(tmp_path, TABLE.with_columns(u=pl.lit(0.03)), text)
    more = TABLE.with_columns(pl.col("q1", "x") / 2, u=pl.lit(0.04)).head(2)
    pl.concat([more, TABLE.with_columns(u=pl.lit(0.04)).slice(2, 1)]).write_csv(tmp_path / "more.csv")
    study, warned = small.load()
    (group,) = study.readings
    names = [f"m{row}" for row in range(1, 9)] + ["more.csv:m1", "more.csv:m2"]
    assert list(group.artefact.features) == names
    assert group.feature.tolist() == [*range(8), 8, 9, 2]  # its third row sees the very point that row 3 saw
    assert group.artefact.features["more.csv:m2"] == (XYZ[1, 0] / 2, XYZ[1, 1], XYZ[1, 2])
    assert group.artefact.feature_u_mm == (*[0.03] * 8, 0.04, 0.04)
    says(warned[0], "more.csv: 1 row", "row 3 (as row 3 of")


def test_a_fit_to_points_of_its_own_recovers_the_arm(tmp_path: Path) -> None:
    (tmp_path / "arm.toml").write_text(ARM)
    truth = ulna.Arm.load(tmp_path / "arm.toml")
    q = np.random.default_rng(8).uniform(-2, 2, (60, 3))
    tip = truth.tip(q, "bent")
    table = pl.DataFrame({f"q{k + 1}": q[:, k] for k in range(3)} | {axis: tip[:, k] for k, axis in enumerate("xyz")})
    small = tracker(tmp_path, table, TRACKER.replace('"points"', '"points"\nframe = "arm"'))
    small.swap("arm.toml", "a = 40.0", "a = 41.0")
    small.swap("arm.toml", "theta0 = 0.2", "theta0 = 0.21")
    small.swap("study.toml", 'hold = ["joint.1.theta0"]', "")
    result = ulna.calibrate(small.load()[0])
    assert result.fit.rms_mm < 1e-9
    np.testing.assert_allclose(result.arm.tip(q, "bent"), tip, rtol=0, atol=1e-8)


PLATE = pl.DataFrame({"feature": ["A", "B"], "x": [0.5, 443.25], "y": [0.0, 1.0], "z": [0.0, -2.0], "u": [0.01, 0.01]})
POINTS = STUDY.replace('kind = "bar"\nlength = 443.172\nu = 0.001', 'kind = "points"\nfeatures = "FILE"\nKEYS')


def plate(small: SmallStudy, file: str, keys: str) -> Study:
    """The study with a features file; keys as lines become a table."""
    inner = f"features_format = {{ {', '.join(keys.strip().splitlines())} }}" if keys else ""
    small.write("study.toml", POINTS.replace("FILE", file).replace("KEYS", inner))
    return small.load()[0]


def test_features_from_every_format(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)
    expected = {"A": (0.5, 0.0, 0.0), "B": (443.25, 1.0, -2.0)}
    for name in (
        "commas.csv",
        "semicolons.csv",
        "bars.dat",
        "table.parquet",
        "book.xlsx",
        "sheets.xlsx",
        "columns.hdf5",
    ):
        keys = WRITERS[name](PLATE, tmp_path / name)
        artefact = plate(small, name, keys).readings[0].artefact
        assert (artefact.features, artefact.feature_u_mm) == (expected, (0.01, 0.01)), name
    import scipy.io

    xyz = PLATE.select("x", "y", "z").to_numpy()
    scipy.io.savemat(tmp_path / "p.mat", {"plate": {"feature": cells(["A", "B"]), "p": xyz}})
    study = plate(small, "p.mat", 'dataset = "plate"\ncolumns = { x = "p1", y = "p2", z = "p3" }')
    assert study.readings[0].artefact.features == expected
    named = PLATE.rename({"feature": "Name", "x": "X / mm", "y": "Y / mm", "z": "Z / mm"}).with_columns(note=pl.lit(""))
    keys = dialect(";", ",")(named, tmp_path / "n.csv")
    columns = 'columns = { feature = "Name", x = "X / mm", y = "Y / mm", z = "Z / mm" }'
    study = plate(small, "n.csv", keys + columns)
    assert study.readings[0].artefact.features == expected
    says(study.warnings[0], "n.csv: not used: the column note.")


def test_what_a_features_file_is_told(tmp_path: Path) -> None:
    small = SmallStudy(tmp_path)

    def told(file: str, keys: str = "") -> str:
        inner = f"features_format = {{ {keys} }}" if keys else ""
        small.write("study.toml", POINTS.replace("FILE", file).replace("KEYS", inner))
        return small.error()

    dialect(";", ",")(PLATE, tmp_path / "s.csv")
    says(told("s.csv"), "s.csv: line 1", 'Say separator = ";" in artefact.bar.features_format')
    key = "key 'artefact.bar.features_format"
    says(told("s.csv", 'seperator = ";"'), f"{key}.seperator'", "Did you mean 'separator'?")
    says(told("s.csv", 'sheet = "a"'), f"{key}.sheet'", "is a CSV file")
    says(told("s.csv", 'separator = ";", decimal = ",", columns = { w = "x" }'), f"{key}.columns'", "'w' is no column")
    small.write("p.csv", "Name,x,y,z\nA,0,0,0\n")
    says(told("p.csv"), "p.csv: unknown column 'Name'", "column 'feature' is missing", "features_format.columns")
    says(told("p.csv", 'columns = { feature = "Nam" }'), f"{key}.columns'", "'Nam'", "Did you mean 'Name'?")
    sheet(PLATE.with_columns(feature=pl.lit("A")), tmp_path / "p.xlsx")
    says(told("p.xlsx"), "row 2 (Sheet1!A3), column 'feature': 'A' stands in row 1 already")
    small.write("study.toml", TRACKER.replace('"points"', '"points"\nfeatures_format = { sheet = "a" }'))
    says(small.error(), f"{key}': says how a file is written", "'features' names none", "Remove it")


IPA = """\
format = "ulna-study/1"
arm = "arm.toml"
units = { length = "mm", angle = "rad" }

[[readings]]
file = "FILE"
separator = ";"
decimal = ","
where = { measurement_temperature = { above = 0 } }

[readings.columns]
q1 = "shoulder_pan_joint"
q2 = "shoulder_lift_joint"
q3 = "elbow_joint"
q4 = "wrist_1_joint"
q5 = "wrist_2_joint"
q6 = "wrist_3_joint"
temperature = "measurement_temperature"
x = "measurement_x"
y = "measurement_y"
z = "measurement_z"

[artefact.tracker]
kind = "points"
"""


@pytest.mark.skipif(not DATA.is_dir(), reason="the measurements of ../shared/data are not there")
@pytest.mark.shared_data
def test_a_real_tracker_s_table_as_it_is(tmp_path: Path) -> None:
    table = DATA / "ipa_ur10" / "Series_B" / "measurements_joint_configurations.csv"
    import_ipa_ur10(table, tmp_path / "imported")
    ur10().save(tmp_path / "arm.toml")
    (tmp_path / "study.toml").write_text(IPA.replace("FILE", str(table)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        direct, imported = Study.load(tmp_path / "study.toml"), Study.load(tmp_path / "imported" / "study.toml")
    assert "0 of 1495 rows left out" in direct.warnings[1]
    (ours,), (theirs,) = direct.readings, imported.readings
    assert np.array_equal(ours.q_rad, theirs.q_rad)
    assert ours.artefact.features == theirs.artefact.features
    assert np.array_equal(ours.temperature_c, theirs.temperature_c)  # type: ignore[arg-type]
    result = ulna.calibrate(direct)
    assert result.fit.converged
    assert result.fit.rms_mm == pytest.approx(ulna.calibrate(imported).fit.rms_mm, rel=1e-9)
