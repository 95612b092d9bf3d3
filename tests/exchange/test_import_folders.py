"""Others' layouts become study folders that load: synthetic ones, and the real ones where they are there."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import ulna
from ulna import InputWarning, Study, UlnaInputError
from ulna.exchange.importers.ipa import JOINTS, import_ipa_ur10
from ulna.exchange.importers.mukca import import_mukca
from ulna.exchange.importers.robots import ur5
from ulna.exchange.importers.serial_robots import import_serial_robots

DATA = Path(__file__).parents[3] / "shared" / "data"
needs_data = pytest.mark.skipif(not DATA.is_dir(), reason="the measurements of ../shared/data are not there")


def _load(path: Path) -> Study:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        return Study.load(path)


@pytest.fixture
def robot(tmp_path: Path) -> Path:
    """A made-up panda with two places of the tool."""
    rng = np.random.default_rng(5)
    for place in ("front", "back"):
        for hole in (0, 1):
            path = tmp_path / "panda_9" / place / f"hole_{hole}.csv"
            path.parent.mkdir(parents=True, exist_ok=True)
            np.savetxt(path, rng.normal([0, 0, 0, -1, 0, 1, hole], 0.01, (3, 7)), delimiter=",")
    return tmp_path / "panda_9"


def test_mukca(robot: Path, tmp_path: Path) -> None:
    counts = import_mukca(robot, tmp_path / "out")
    assert counts == {"back": 6, "front": 6}
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["arm.toml", "readings.csv", "study.toml"]
    study = Study.load(tmp_path / "out" / "study.toml")
    group = study.readings[0]
    assert (group.artefact.kind, group.artefact.length_mm) == ("bar", 50.0)
    assert group.placement.tolist() == ["back"] * 6 + ["front"] * 6
    assert group.feature.tolist() == [0, 0, 0, 1, 1, 1] * 2
    assert np.array_equal(group.q_rad[3:6], np.loadtxt(robot / "back" / "hole_1.csv", delimiter=","))


def test_mukca_as_parquet_without_copies(robot: Path, tmp_path: Path) -> None:
    path = robot / "front" / "hole_0.csv"
    path.write_text(path.read_text() * 2)
    assert import_mukca(robot, tmp_path / "all")["front"] == 9
    assert import_mukca(robot, tmp_path / "out", parquet=True, drop_copies=True)["front"] == 6
    whole, single = _load(tmp_path / "all" / "study.toml"), Study.load(tmp_path / "out" / "study.toml")
    assert "3 rows" in whole.warnings[0]
    assert single.files[-1].path.name == "readings.parquet"
    assert len(single.readings[0]) == 12


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("front/hole_0.csv", None, "front/hole_0.csv: no such file"),
        ("front/hole_0.csv", "1,2,3\n", "row 1 has 3 columns, the arm has 7 joints"),
        ("front/hole_0.csv", "1,2,3,4,5,6,7\n1,2,3,4,x,6,7\n", r"row 2 \(line 2 of the file\), column 'q5': got 'x'"),
        ("front/hole_0.csv", "", "row 1 has 0 columns"),
    ],
)
def test_what_a_bad_mukca_folder_is_told(robot: Path, tmp_path: Path, old: str, new: str | None, message: str) -> None:
    if new is None:
        (robot / old).unlink()
    else:
        (robot / old).write_text(new)
    with pytest.raises(UlnaInputError, match=message):
        import_mukca(robot, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_a_folder_that_is_no_robot(robot: Path, tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError, match="no such folder"):
        import_mukca(tmp_path / "nothing", tmp_path / "out")
    with pytest.raises(UlnaInputError, match=r"no folder in it holds hole_0.csv"):
        import_mukca(robot.rename(tmp_path / "panda_8") / "front", tmp_path / "out", urdf=None)
    renamed = (tmp_path / "panda_8").rename(tmp_path / "rover")
    with pytest.raises(UlnaInputError, match=r"no arm is known by this name.*--urdf"):
        import_mukca(renamed, tmp_path / "out")
    with pytest.raises(UlnaInputError, match=r"iiwa14.urdf: no such file.*--urdf"):
        import_mukca(renamed.rename(tmp_path / "kuka_1"), tmp_path / "out")


def _tracker_table(rows: int) -> str:
    columns = ["Timestamp", *JOINTS, "measurement_temperature", "measurement_x", "measurement_y", "measurement_z"]
    lines = [";".join(columns)]
    for k in range(rows):
        numbers = [k / 8, -k / 16, 0.25, 0.5, 0.75, 1.0, 21.5, 1000.5 + k, -k * 2, 3e-5]
        lines.append("2,02011E+13;" + ";".join(f"{number:g}".replace(".", ",") for number in numbers))
    return "\r\n".join(lines) + "\r\n"


def test_ipa_ur10(tmp_path: Path) -> None:
    path = tmp_path / "measurements.csv"
    path.write_bytes(_tracker_table(10).encode())
    assert import_ipa_ur10(path, tmp_path / "out", fit=3, every=2) == (3, 7)
    study, rest = Study.load(tmp_path / "out" / "study.toml"), Study.load(tmp_path / "out" / "held-out.toml")
    group = study.readings[0]
    assert (group.artefact.kind, group.artefact.frame) == ("points", "free")
    assert list(group.artefact.features) == ["m1", "m3", "m5"]
    assert group.artefact.features["m3"] == (1002.5, -4.0, 3e-5)
    assert group.q_rad[1].tolist() == [0.25, -0.125, 0.25, 0.5, 0.75, 1.0]
    assert group.temperature_c is not None
    assert group.temperature_c.tolist() == [21.5] * 3
    assert set(group.placement) == {"s1"}
    assert list(rest.readings[0].artefact.features) == ["m2", "m4", "m6", "m7", "m8", "m9", "m10"]
    assert [joint.model for joint in study.arm.joints] == ["dh", "hayati", "hayati", "dh", "dh", "dh"]
    assert import_ipa_ur10(path, tmp_path / "whole") == (10, 0)
    assert not (tmp_path / "whole" / "held-out.toml").exists()


def test_ipa_ur10_spread_and_in_several_standings(tmp_path: Path) -> None:
    path = tmp_path / "measurements.csv"
    path.write_text(_tracker_table(10))
    assert import_ipa_ur10(path, tmp_path / "out", fit=3, spread=True, standings=2) == (3, 7)
    study, rest = Study.load(tmp_path / "out" / "study.toml"), Study.load(tmp_path / "out" / "held-out.toml")
    assert list(study.readings[0].artefact.features) == ["m2", "m6", "m9"]  # the middles of thirds
    assert study.readings[0].placement.tolist() == ["s1", "s2", "s2"]
    assert rest.readings[0].placement.tolist() == ["s1"] * 4 + ["s2"] * 3
    with pytest.raises(UlnaInputError, match=r"--spread goes with --fit and not with --every"):
        import_ipa_ur10(path, tmp_path / "out", spread=True, force=True)


def test_what_a_bad_tracker_table_is_told(tmp_path: Path) -> None:
    path = tmp_path / "measurements.csv"
    path.write_text(_tracker_table(4).replace("0,125", "0,1x5"))
    with pytest.raises(
        UlnaInputError, match=r"row 2 \(line 3 of the file\), column 'shoulder_pan_joint' \(q1\): got '0,1x5'"
    ):
        import_ipa_ur10(path, tmp_path / "out")
    path.write_text(_tracker_table(4).replace("measurement_y", "y"))
    with pytest.raises(UlnaInputError, match="column 'measurement_y' is missing"):
        import_ipa_ur10(path, tmp_path / "out")
    path.write_text(_tracker_table(4))
    with pytest.raises(UlnaInputError, match=r"4 of them to choose from.*at least the 5 of --fit"):
        import_ipa_ur10(path, tmp_path / "out", fit=5)
    assert not (tmp_path / "out").exists()


def test_the_commands(robot: Path, tmp_path: Path) -> None:
    from ulna.cli.importing import app

    def run(*arguments: object) -> tuple[int, str]:
        ended = CliRunner().invoke(app, [str(each) for each in arguments])
        return ended.exit_code, ended.stderr

    out = tmp_path / "out"
    code, said = run("mukca", robot, "-o", out)
    assert code == 0
    assert "12 readings in 2 placements (back 6, front 6)" in said
    code, said = run("mukca", robot, "-o", out)
    assert code == 2
    assert "error: " in said
    assert "exists already" in said
    assert run("mukca", robot, "-o", out, "--force", "--length", "50.1")[0] == 0
    assert Study.load(out / "study.toml").readings[0].artefact.length_mm == 50.1
    table = tmp_path / "measurements.csv"
    table.write_text(_tracker_table(4))
    code, said = run("ipa-ur10", table, "-o", tmp_path / "ur", "--fit", 2)
    assert code == 0
    assert "2 readings to fit (study.toml), 2 held out (held-out.toml)" in said
    drawing = tmp_path / "none.urdf"
    assert run("urdf", drawing, "-o", tmp_path / "arm.toml") == (2, f"error: {drawing}: no such file; expected a robot "
        "description (URDF). Check the path.\n")  # fmt: skip


@needs_data
@pytest.mark.shared_data
@pytest.mark.parametrize(
    ("robot", "rows", "places"),
    [("panda_1", 182, 3), ("panda_2_clean", 497, 8), ("kuka_14", 180, 3), ("dinova_1", 137, 4)],
)
def test_the_real_robots(tmp_path: Path, robot: str, rows: int, places: int) -> None:
    counts = import_mukca(DATA / "mukca" / robot, tmp_path / "out")
    assert (sum(counts.values()), len(counts)) == (rows, places)
    study = _load(tmp_path / "out" / "study.toml")
    assert len(study.readings[0]) == rows
    # The nominal arm brings all touches of a seat within a few millimetres of each other: signs and offsets are right.
    group = study.readings[0]
    seat = group.placement_code * 2 + group.feature
    tip_mm = study.arm.tip(group.q_rad)
    centre_mm = np.array([tip_mm[seat == k].mean(axis=0) for k in range(seat.max() + 1)])
    assert np.linalg.norm(tip_mm - centre_mm[seat], axis=1).mean() < 10


@needs_data
@pytest.mark.shared_data
def test_the_real_ur10(tmp_path: Path) -> None:
    path = DATA / "ipa_ur10" / "Series_B" / "measurements_joint_configurations.csv"
    assert import_ipa_ur10(path, tmp_path / "out", fit=300) == (300, 1195)
    study, rest = Study.load(tmp_path / "out" / "study.toml"), Study.load(tmp_path / "out" / "held-out.toml")
    for group in (*study.readings, *rest.readings):
        tip_mm = study.arm.tip(group.q_rad)
        seen_mm = np.array(list(group.artefact.features.values()))[group.feature]
        a, b = tip_mm - tip_mm.mean(axis=0), seen_mm - seen_mm.mean(axis=0)
        u, _, vt = np.linalg.svd(a.T @ b)
        turned = a @ u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt
        assert np.linalg.norm(turned - b, axis=1).mean() < 4


def _targets(rows: np.ndarray, wrong: np.ndarray) -> str:
    """Poses (N, n) in degrees of a UR5 whose links are a little longer than its maker says."""
    true = ur5().with_parameters(ur5().parameters * 1.001)
    measured = true.core.tip(np.radians(rows), 0)
    target = ur5().core.tip(np.radians(rows), 0)
    places = [f"{axis}_{what}" for what in ("t", "dif") for axis in "xyz"]
    head = ["step_order", *places, *(f"joint_{k}" for k in range(1, 7))]
    numbers = np.column_stack([np.arange(len(rows)), target, target - measured + wrong, rows])
    return ",".join(head) + "\n" + "".join(",".join(map(repr, row)) + "\n" for row in numbers.tolist())


def test_serial_robots(tmp_path: Path) -> None:
    """Where the target was is what was meant less the difference: the arm that made the table comes out."""
    rng = np.random.default_rng(4)
    for name, count in (("grid", 120), ("random", 20)):
        rows = rng.uniform(-120.0, 120.0, (count, 6))
        (tmp_path / f"{name}.csv").write_text(_targets(rows, np.zeros((count, 3))))
    counts = import_serial_robots(tmp_path / "grid.csv", tmp_path / "out", "ur5", tmp_path / "random.csv")
    assert counts == (120, 20)
    result = ulna.calibrate(tmp_path / "out" / "study.toml")
    assert result.after["coordinate_error_rms_mm"] < 1e-6 < result.before["coordinate_error_rms_mm"]
    held_out = ulna.evaluate(result, tmp_path / "out" / "held-out.toml")
    assert held_out.overall["coordinate_error_rms_mm"] < 1e-6
    with pytest.raises(UlnaInputError, match=r"column 'joint_7' is missing.*or the right robot"):
        import_serial_robots(tmp_path / "grid.csv", tmp_path / "out2", "wam")
    with pytest.raises(UlnaInputError, match="got 'ur6'"):
        import_serial_robots(tmp_path / "grid.csv", tmp_path / "out2", "ur6")
    assert not (tmp_path / "out2").exists()
