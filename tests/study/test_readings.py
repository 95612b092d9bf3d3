"""Readings as arrays: units, columns or keys, several artefacts and files, CSV and Parquet alike."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.small_study import BARS, PLATE, SmallStudy

from ulna.artefacts.readings import Readings
from ulna.formats.table import read_header, read_table, stream
from ulna.study.assembly import assemble

TABLE = pl.read_csv(BARS.encode())
Q = TABLE.select("q1", "q2", "q3").to_numpy()


@pytest.fixture
def small(tmp_path: Path) -> SmallStudy:
    (tmp_path / "study").mkdir()
    return SmallStudy(tmp_path / "study")


def _only(small: SmallStudy) -> Readings:
    study, warned = small.load()
    assert warned == []
    assert len(study.readings) == 1
    return study.readings[0]


def test_what_a_readings_file_says_arrives(small: SmallStudy) -> None:
    study, _ = small.load()
    group = study.readings[0]
    assert np.array_equal(group.q_rad, Q)
    assert group.q_rad.flags.c_contiguous
    assert group.feature.tolist() == [0, 0, 1, 1] * 2
    assert group.placement.tolist() == ["1"] * 4 + ["2"] * 4
    assert group.probe.tolist() == [0] * 8
    assert group.row.tolist() == list(range(1, 9))
    used = study.files[group.file[0]]
    assert (used.path, used.rows) == (small.folder / "bars.csv", 8)
    assert used.sha256 == hashlib.sha256(BARS.encode()).hexdigest()
    assert {file.path.name for file in study.files} == {"study.toml", "arm.toml", "bars.csv"}
    assert study.noise is not None
    assert study.noise.seat_mm == 0.005
    assert study.noise.encoder_rad is not None
    assert study.noise.encoder_rad.tolist() == [5e-6] * 3
    assert assemble(study).hold.nonzero()[0].tolist() == [0]


@pytest.mark.parametrize(
    "text",
    [
        "\ufeff" + BARS,
        BARS.replace("\n", "\r\n"),
        BARS.replace(",", " , "),
        BARS + "\n\n",
        BARS.rstrip("\n"),
        BARS.replace(",A", ',"A"'),
    ],
    ids=["byte-order mark", "Windows", "spaces", "blank lines at the end", "no line end", "quotes"],
)
def test_harmless_differences_are_no_differences(small: SmallStudy, text: str) -> None:
    small.write("bars.csv", text)
    group = _only(small)
    assert np.array_equal(group.q_rad, Q)
    assert group.feature.tolist() == [0, 0, 1, 1] * 2
    assert group.placement.tolist() == ["1"] * 4 + ["2"] * 4


def test_angles_in_degrees_and_counts(small: SmallStudy) -> None:
    small.swap("study.toml", 'angle = "rad"\nart', 'angle = "deg"\nart')
    small.swap("study.toml", "encoder = 5e-6", "encoder = [1e-6, 2e-6, 3e-6]")
    assert _only(small).q_rad == pytest.approx(np.deg2rad(Q), abs=1e-15)
    small.swap("study.toml", 'angle = "deg"', 'angle = "counts"')
    assert _only(small).q_rad == pytest.approx(Q * 2 * np.pi / 4096, abs=1e-15)


def test_the_study_gives_the_angle_unit_where_the_readings_do_not(small: SmallStudy) -> None:
    small.swap("study.toml", 'angle = "rad" }', 'angle = "deg" }')
    small.swap("study.toml", 'angle = "rad"\nart', "art")
    study, _ = small.load()
    assert study.readings[0].q_rad == pytest.approx(np.deg2rad(Q), abs=1e-15)
    assert study.noise is not None
    assert study.noise.encoder_rad == pytest.approx(np.deg2rad(5e-6))


def test_lengths_in_inches(small: SmallStudy) -> None:
    small.swap("study.toml", 'length = "mm"', 'length = "in"')
    group = _only(small)
    assert group.artefact.length_mm == pytest.approx(443.172 * 25.4)
    assert group.artefact.features["B"] == pytest.approx((443.172 * 25.4, 0, 0))
    assert group.artefact.u_mm == pytest.approx(0.0254)


def test_parquet_is_the_same(small: SmallStudy) -> None:
    csv = _only(small)
    frame = TABLE.with_columns(pl.col("feature").cast(pl.Categorical), pl.col("q1").cast(pl.Float64))
    frame.write_parquet(small.folder / "bars.parquet")
    small.swap("study.toml", "bars.csv", "bars.parquet")
    parquet = _only(small)
    for name in ("q_rad", "feature", "placement", "probe", "row"):
        assert np.array_equal(getattr(parquet, name), getattr(csv, name)), name


def test_columns_for_everything(small: SmallStudy) -> None:
    frame = TABLE.with_columns(
        artefact=pl.Series(["bar"] * 4 + ["cone"] * 4),
        feature=pl.Series(["A", "B", "A", "B"] + ["seat"] * 4),
        probe=pl.Series(["bent", "straight"] * 4),
        id=pl.Series(list("abcdefgh")),
        temperature=20.0 + pl.int_range(8),
    )
    frame.write_csv(small.folder / "bars.csv")
    small.swap("study.toml", 'artefact = "bar"\nprobe = "bent"\n', "")
    small.swap("study.toml", "[noise]", '[artefact.cone]\nkind = "seat"\n\n[noise]')
    study, warned = small.load()
    assert warned == []
    bar, cone = study.readings
    assert (bar.artefact.name, len(bar), cone.artefact.name, len(cone)) == ("bar", 4, "cone", 4)
    assert cone.row.tolist() == [5, 6, 7, 8]
    assert cone.probe.tolist() == [0, 1, 0, 1]
    assert cone.feature.tolist() == [0, 0, 0, 0]
    assert np.array_equal(cone.q_rad, Q[4:])
    assert cone.id is not None
    assert cone.id.tolist() == list("efgh")
    assert cone.temperature_c is not None
    assert cone.temperature_c.tolist() == [24, 25, 26, 27]


def test_length_rows(small: SmallStudy) -> None:
    small.swap("study.toml", 'kind = "bar"\nlength = 443.172', 'kind = "length"')
    small.swap("study.toml", 'length = "mm"', 'length = "m"')
    p = Q[::-1]
    frame = pl.DataFrame(np.hstack([Q, p]), schema=["q1", "q2", "q3", "p1", "p2", "p3"]).with_columns(length=0.4431)
    frame.write_csv(small.folder / "bars.csv")
    group = _only(small)
    assert group.p_rad is not None
    assert group.length_mm is not None
    assert np.array_equal(group.p_rad, p)
    assert group.length_mm == pytest.approx(np.full(8, 443.1))
    frame.drop("length").write_csv(small.folder / "bars.csv")
    small.swap("study.toml", 'kind = "length"', 'kind = "length"\nlength = 0.5')
    assert _only(small).length_mm == pytest.approx(np.full(8, 500.0))


def test_several_files_of_one_artefact(small: SmallStudy) -> None:
    small.write("more.csv", BARS.replace(",2,", ",3,").replace("0.", "0.0"))
    entry = '[[readings]]\nfile = "more.csv"\nprobe = "straight"\n\n[artefact.bar]'
    small.swap("study.toml", "[artefact.bar]", entry)
    group = _only(small)
    assert len(group) == 16
    assert group.row.tolist() == [*range(1, 9), *range(1, 9)]
    assert group.probe.tolist() == [0] * 8 + [1] * 8
    assert group.placement.tolist() == ["1"] * 4 + ["2"] * 4 + ["1"] * 4 + ["3"] * 4
    assert group.placement_code.tolist() == [0] * 4 + [1] * 4 + [0] * 4 + [2] * 4
    study, _ = small.load()
    assert [study.files[k].path.name for k in np.unique(group.file)] == ["bars.csv", "more.csv"]


def test_features_from_a_file(small: SmallStudy) -> None:
    small.swap(
        "study.toml", 'kind = "bar"\nlength = 443.172', 'kind = "points"\nframe = "arm"\nfeatures = "../plate.csv"'
    )
    small.write("bars.csv", BARS.replace(",A", ",s3").replace(",B", ",s1"))
    small.write("../plate.csv", PLATE)  # a path that climbs out of the study's folder is allowed
    group = _only(small)
    assert group.artefact.features == {"s1": (0, 0, 0), "s2": (100, 0, 0), "s3": (0, 100, 0)}
    assert group.artefact.frame == "arm"
    assert group.feature.tolist() == [2, 2, 0, 0] * 2


def test_every_feature_has_its_own_uncertainty(small: SmallStudy) -> None:
    small.swap("study.toml", 'kind = "bar"\nlength = 443.172\nu = 0.001', 'kind = "points"\nfeatures = "plate.csv"')
    small.write("plate.csv", "feature,x,y,z,u\nA,0,0,0,0.003\nB,443,0,0,0.004\n")
    study, warned = small.load()
    assert study.readings[0].artefact.feature_u_mm == (0.003, 0.004)
    assert warned == []


def test_what_is_not_used_is_said(small: SmallStudy) -> None:
    small.write("bars.csv", BARS.replace("q1,", "time,q1,").replace("\n", "\n7,").removesuffix("7,"))
    small.swap("study.toml", 'probe = "bent"', 'probe = "bent"\nplacement = "9"')
    small.swap("study.toml", "[noise]", '[artefact.cone]\nkind = "seat"\n\n[noise]')
    study, warned = small.load()
    assert study.warnings == warned
    assert any("not used: the column time" in text for text in warned)
    assert any("'readings.1.placement' = '9' is not used" in text for text in warned)
    assert any("'artefact.cone': no reading touches this artefact" in text for text in warned)
    assert len(warned) == 3


def test_fit_options(small: SmallStudy) -> None:
    small.swap("study.toml", "[fit]\n", '[fit]\nfree = ["joint.*"]\nstart = "search"\nseed = 5\nknown_length = 2\n')
    study, _ = small.load()
    assert (study.fit.start, study.fit.seed, study.fit.known_length_mm) == ("search", 5, 2.0)
    assert assemble(study).hold.tolist() == [True] + [False] * 7 + [True] * 6


def test_masks_and_subsets(small: SmallStudy) -> None:
    study, _ = small.load()
    first = study.readings[0].placement == "1"
    part = study.subset([first])
    assert part.readings[0].row.tolist() == [1, 2, 3, 4]
    assert part.fit is study.fit
    assert study.subset([np.zeros(8, dtype=bool)]).readings == []
    assert len(study.readings[0]) == 8


def test_pieces_are_the_whole(tmp_path: Path) -> None:
    frame = pl.DataFrame(np.random.default_rng(1).uniform(-3, 3, (1000, 2)), schema=["q1", "q2"])
    frame = frame.with_columns(id=pl.int_range(1000).cast(pl.String))
    frame.write_parquet(tmp_path / "a.parquet")
    frame.write_csv(tmp_path / "a.csv")
    (tmp_path / "spaces.csv").write_text((tmp_path / "a.csv").read_text().replace(",", " , "))
    for name in ("a.parquet", "a.csv", "spaces.csv"):
        header = read_header(tmp_path / name)
        pieces = list(stream(header, ["q1", "q2"], ["id"], rows=64))
        assert [piece.before for piece in pieces] == np.cumsum([0, *map(len, pieces[:-1])]).tolist(), name
        assert np.array_equal(np.concatenate([piece.numbers for piece in pieces]), frame.select("q1", "q2")), name
        assert pl.concat([piece.texts["id"] for piece in pieces]).to_list() == frame["id"].to_list(), name
        assert read_table(header, lambda column: column != "id").equals(frame), name


def test_temperatures_of_some_files_and_not_of_others(small: SmallStudy) -> None:
    each = "".join(f"temperature{k}," for k in (1, 2, 3))
    small.write("bars.csv", BARS.replace("q1", each + "q1", 1).replace("\n", "\n21,22,23,").removesuffix("21,22,23,"))
    lines = BARS.replace(",2,", ",3,").splitlines()[4:]
    small.write("one.csv", "q1,q2,q3,placement,feature,temperature\n" + "".join(f"{line},25\n" for line in lines[1:]))
    small.write("none.csv", "q1,q2,q3,placement,feature\n" + "\n".join(lines[1:]).replace(",3,", ",4,"))
    entries = "".join(f'[[readings]]\nfile = "{name}.csv"\nprobe = "bent"\n\n' for name in ("one", "none"))
    small.swap("study.toml", "[artefact.bar]", entries + "[artefact.bar]")
    group = _only(small)
    expected = [[21, 22, 23]] * 8 + [[25] * 3] * 4 + [[np.nan] * 3] * 4
    assert group.temperature_c is not None
    assert np.array_equal(group.temperature_c, expected, equal_nan=True)


def test_nothing_but_encoder_columns(small: SmallStudy) -> None:
    small.swap("study.toml", 'kind = "bar"\nlength = 443.172\nu = 0.001', 'kind = "seat"')
    TABLE.select("q1", "q2", "q3").write_csv(small.folder / "bars.csv")
    group = _only(small)
    assert np.array_equal(group.q_rad, Q)
    assert (group.feature.tolist(), group.placement.tolist()) == ([0] * 8, ["1"] * 8)
    small.swap("study.toml", 'kind = "seat"', 'kind = "length"\nlength = 3')
    both = pl.DataFrame(np.hstack([Q, Q + 0.1]), schema=["q1", "q2", "q3", "p1", "p2", "p3"])
    both.write_csv(small.folder / "bars.csv")
    assert _only(small).length_mm == pytest.approx(np.full(8, 3.0))
