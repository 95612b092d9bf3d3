"""Prismatic joints at every door: what they may have, in which unit their encoders read, where they are refused."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.contract.test_joints import BAR, arm, noise, points, poses
from tests.simulations import saved, write

import ulna
from ulna import Arm, Study, UlnaInputError
from ulna.documents.content.clouds import clouds
from ulna.exchange.export.dh import dh_table, without_beta

OF = arm(3, "prismatic")
TEXT = """format = "ulna-arm/1"
units = { length = "m", angle = "deg" }

[[joint]]
theta0 = 10.0
alpha = -88.0
a = 0.04
d = 0.25
limits = [-170.0, 170.0]

[[joint]]
theta0 = 20.0
alpha = 89.0
a = -0.03
d = 0.2
type = "prismatic"
limits = [-0.1, 0.5]

[[joint]]
limits = [-170.0, 170.0]

[probe.ball]
tip = { x = 0.03, y = 0.0, z = 0.2 }
ball = 0.006
"""


def loaded(folder: Path, text: str = TEXT) -> Arm:
    (folder / "arm.toml").write_text(text)
    return Arm.load(folder / "arm.toml")


def test_limits_are_lengths(tmp_path: Path) -> None:
    of = loaded(tmp_path)
    assert of.joints[1].limits_rad == pytest.approx((-100.0, 500.0))
    assert of.joints[0].limits_rad == pytest.approx((-np.radians(170), np.radians(170)))
    assert "slides" in repr(of)
    # a millimetre of its encoder is a millimetre of its axis
    tips = of.tip([[0.3, 0.0, 0.2], [0.3, 1.0, 0.2], [0.3, 101.0, 0.2]])
    assert np.linalg.norm(tips[1] - tips[0]) == pytest.approx(1.0, abs=1e-12)
    assert tips[2] - tips[0] == pytest.approx(101.0 * (tips[1] - tips[0]), abs=1e-10)
    # whatever slides may go farther than the links are long
    assert of.core.reach_mm(0) > 500.0


PRISMATIC = 'type = "prismatic"\n'
REFUSED = {
    "no limits": ("limits = [-0.1, 0.5]\n", "", ["joint.2.limits' is missing", "how far it slides"]),
    "hayati": (
        PRISMATIC + "limits",
        PRISMATIC + 'model = "hayati"\nbeta = 0.0\nlimits',
        ["joint.2.model", "prismatic"],
    ),
    "endless": ("limits = [-0.1, 0.5]", "limits = [-0.1, 0.5]\ncounts_per_turn = 4096", ["joint.2.counts_per_turn"]),
    "no sign": (PRISMATIC, PRISMATIC + "sign = 0\n", ["joint.2.sign", "1 or -1"]),
    "harmonics": (PRISMATIC, PRISMATIC + "harmonics = { c1 = 0.01 }\n", ["joint.2'", "encoder-harmonics", "turn"]),
    "backlash": (PRISMATIC, PRISMATIC + "backlash = 0.01\n", ["joint.2'", "'backlash'", "turn"]),
    "compliance": (PRISMATIC, PRISMATIC + "compliance = 0.01\nmass = 1.0\n", ["joint.2'", "'compliance'", "turn"]),
    "coupling": (PRISMATIC, PRISMATIC + "coupling = { 1 = 0.5 }\n", ["joint.2'", "'coupling'", "turn"]),
    "another word": (PRISMATIC, 'type = "linear"\n', ["joint.2.type", "'linear'", "'prismatic'"]),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_only_joints_have_that_turn_is_refused(tmp_path: Path, case: str) -> None:
    old, new, said = REFUSED[case]
    text = TEXT.replace(old, new, 1)
    assert text != TEXT
    with pytest.raises(UlnaInputError) as error:
        loaded(tmp_path, text.replace("d = 0.2\ntype", "type") if case == "hayati" else text)
    for each in said:
        assert each in str(error.value)


def test_other_joints_may_not_turn_with_it(tmp_path: Path) -> None:
    of = loaded(tmp_path, TEXT.replace("[probe", "coupling = { 2 = 0.5 }\n\n[probe", 1))
    with pytest.raises(UlnaInputError, match="none of a coupled joint"):
        of.tip([0.0, 0.0, 0.0])


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("slides")
    saved(write(folder, points(OF) + BAR.replace("150", "20"), noise(OF), OF))
    return folder / "out"


def test_readings_are_in_the_files_units(made: Path, tmp_path: Path) -> None:
    """q3 in m where the study's lengths are; angle = "deg" is of the others."""
    expected = Study.load(made / "study.toml")
    for name in ("arm.toml", "tracker-features.csv"):
        (tmp_path / name).write_text((made / name).read_text())
    for name in ("bar", "tracker"):
        table = pl.read_csv(made / f"{name}.csv")
        angles = [pl.col(f"q{k}").degrees() for k in (1, 2, 4, 5)]
        table.with_columns(*angles, pl.col("q3") / 1000.0).write_csv(tmp_path / f"{name}.csv")
    features = pl.read_csv(tmp_path / "tracker-features.csv")
    features.with_columns(pl.col("x", "y", "z") / 1000.0).write_csv(tmp_path / "tracker-features.csv")
    text = (made / "study.toml").read_text().replace('length = "mm"', 'length = "m"')
    text = text.replace("length = 300.0", "length = 0.3").replace("u = 0.001", "u = 1e-6")
    text = text.replace("encoder = [1e-05, 1e-05, 0.01, 1e-05, 1e-05]", "encoder = [1e-05, 1e-05, 1e-05, 1e-05, 1e-05]")
    text = text.replace("seat = 0.01", "seat = 1e-5").replace('.csv"\nartefact', '.csv"\nangle = "deg"\nartefact')
    (tmp_path / "study.toml").write_text(text)
    study = Study.load(tmp_path / "study.toml")
    for one, other in zip(study.readings, expected.readings, strict=True):
        np.testing.assert_allclose(one.q_rad, other.q_rad, rtol=0, atol=1e-9)
    assert study.noise is not None
    np.testing.assert_allclose(study.noise.encoder_rad, [1e-5, 1e-5, 0.01, 1e-5, 1e-5])
    # a heading that says another unit is asked about
    table = pl.read_csv(tmp_path / "bar.csv")
    table.rename({"q3": "q3 [mm]"}).write_csv(tmp_path / "bar.csv")
    with pytest.raises(UlnaInputError, match=r"q3.*the file says 'mm', but its lengths are said to be in m"):
        Study.load(tmp_path / "study.toml")


def study_with(made: Path, tmp_path: Path, old: str, new: str) -> Path:
    for file in made.iterdir():
        (tmp_path / file.name).write_text(file.read_text())
    text = (made / "study.toml").read_text()
    assert old in text
    (tmp_path / "study.toml").write_text(text.replace(old, new, 1))
    return tmp_path / "study.toml"


def test_one_number_is_not_said_of_angles_and_lengths(made: Path, tmp_path: Path) -> None:
    path = study_with(made, tmp_path, "encoder = [1e-05, 1e-05, 0.01, 1e-05, 1e-05]", "encoder = 1e-5")
    with pytest.raises(UlnaInputError, match=r"key 'noise.encoder': got one for all joints, but joint 3 .* prismatic"):
        Study.load(path)
    with pytest.raises(UlnaInputError, match=r"key 'noise.encoder': got one for all joints"):
        ulna.simulate(write(tmp_path / "one", BAR, "noise = { encoder = 1e-5 }", OF))
    with pytest.raises(UlnaInputError, match=r"key 'travel.limits': got one for all joints"):
        ulna.simulate(write(tmp_path / "two", BAR, f"{noise(OF)}\ntravel = {{ limits = [[-1.0, 1.0]] }}", OF))
    counts = noise(OF).replace(" }", ", counts_per_turn = 4096 }")
    with pytest.raises(UlnaInputError, match=r"noise.counts_per_turn.*joint 3 .* prismatic"):
        ulna.simulate(write(tmp_path / "three", BAR, counts, OF))


def test_counts_are_of_joints_that_turn(made: Path, tmp_path: Path) -> None:
    path = study_with(made, tmp_path, 'file = "bar.csv"', 'file = "bar.csv"\nangle = "counts"')
    with pytest.raises(UlnaInputError, match=r"readings.*angle'.*joint 3 .* prismatic, which readings in counts"):
        Study.load(path)


def test_a_reading_beyond_its_limits_is_told_in_mm(made: Path, tmp_path: Path) -> None:
    path = study_with(made, tmp_path, "[noise]", "[noise]")
    text = (tmp_path / "arm.toml").read_text()
    assert "limits = [0.0, 350.0]" in text
    (tmp_path / "arm.toml").write_text(text.replace("limits = [0.0, 350.0]", "limits = [50.0, 350.0]"))
    with pytest.warns(ulna.InputWarning, match=r"column 'q3'.*limits of joint 3 \(50 to 350 mm\).*farthest is .* mm"):
        Study.load(path)


def test_measuring_takes_millimetres_or_what_the_heading_says(tmp_path: Path) -> None:
    q_rad = poses(OF, 5)
    expected = OF.tip(q_rad)
    np.testing.assert_allclose(ulna.measure(OF, q_rad).points_mm, expected, rtol=0, atol=1e-12)
    degrees = {f"q{k + 1}": np.degrees(q_rad[:, k]) for k in range(5)}
    for heading, column in (("q3", q_rad[:, 2]), ("q3 [m]", q_rad[:, 2] / 1000.0), ("q3 (mm)", q_rad[:, 2])):
        columns = {heading if name == "q3" else name: column if name == "q3" else own for name, own in degrees.items()}
        pl.DataFrame(columns).write_csv(tmp_path / "q.csv")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ulna.InputWarning)  # columns are taken by their names
            found = ulna.measure(OF, tmp_path / "q.csv", angle="deg").table
        np.testing.assert_allclose(found.to_numpy(), expected, rtol=0, atol=1e-9)
    with pytest.raises(UlnaInputError, match=r"joint 3 .* prismatic, which readings in counts"):
        ulna.measure(OF, q_rad, angle="counts")


def test_frames_say_the_unit_in_a_columns_name(made: Path) -> None:
    frame = pl.read_csv(made / "bar.csv")
    named = frame.rename({f"q{k}": f"q{k}_mm" if k == 3 else f"q{k}_rad" for k in range(1, 6)})
    bar = {"kind": "bar", "length_mm": 300.0}
    study = Study.from_frame(OF, named, bar)
    np.testing.assert_array_equal(study.readings[0].q_rad[:, 2], frame["q3"].to_numpy())
    with pytest.raises(UlnaInputError, match=r"q3.*its unit is not stated, and never guessed"):
        Study.from_frame(OF, named.rename({"q3_mm": "q3"}), bar)


@pytest.mark.parametrize("extra", ["encoder-harmonics", "link-expansion", "compliance"])
def test_what_joints_do_that_turn_is_fitted_of_them_alone(made: Path, extra: str) -> None:
    study = Study.load(made / "study.toml")
    weighed = [replace(j, effects=replace(j.effects, mass_kg=1.0, centre_mm=(0, 0, -50.0))) for j in study.arm.joints]
    study = replace(study, arm=replace(study.arm, joints=tuple(weighed)))
    for group in study.readings:
        group.temperature_c = np.linspace(18.0, 26.0, len(group))
    result = ulna.calibrate(study, extras=[extra], judge_extras=False)
    status = {row.name: row.status for row in result.parameters}
    own = {
        name for name in status if name.startswith("joint.3.") and name.rsplit(".", 1)[1] in ("c1", "s2", "compliance")
    }
    assert all(status[name] == "held" for name in own)
    assert bool(own) == (extra != "link-expansion")
    assert ("joint.3.expansion" in status) == (extra == "link-expansion")
    result.save(made.parent / f"result-{extra}")
    again = Arm.load(made.parent / f"result-{extra}" / "arm.toml")
    np.testing.assert_array_equal(again.parameters, result.arm.parameters)


@pytest.mark.parametrize("convention", ["dh", "modified-dh"])
@pytest.mark.parametrize("number", [1, 3, 5])
def test_a_table_of_a_controller_carries_it(tmp_path: Path, convention: str, number: int) -> None:
    of = arm(number, "prismatic")
    written, _ = without_beta(of)
    (tmp_path / "dh.csv").write_text(dh_table(written, convention, tmp_path / "arm.toml", "m", "deg"))
    assert "type,lower_m,upper_m" in (tmp_path / "dh.csv").read_text()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ulna.InputWarning)
        again = Arm.from_dh(tmp_path / "dh.csv", convention=convention)
    assert [joint.type for joint in again.joints] == [joint.type for joint in of.joints]
    assert again.joints[number - 1].limits_rad == pytest.approx((0.0, 350.0))
    np.testing.assert_allclose(again.tip(poses(of)), of.tip(poses(of)), rtol=0, atol=1e-9)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [("0.35", "0.0", "how far the joint slides"), ("prismatic", "slider", "column 'type': got 'slider'")],
)
def test_a_table_that_does_not_say_it_well_is_refused(tmp_path: Path, old: str, new: str, said: str) -> None:
    text = dh_table(OF, "dh", tmp_path / "arm.toml", "m", "deg")
    line = next(line for line in text.splitlines() if "prismatic" in line)
    (tmp_path / "dh.csv").write_text(text.replace(line, line[::-1].replace(old[::-1], new[::-1], 1)[::-1]))
    with pytest.raises(UlnaInputError, match=said):
        Arm.from_dh(tmp_path / "dh.csv", convention="dh")


def test_maps_of_its_uncertainty(made: Path, tmp_path: Path) -> None:
    result = ulna.calibrate(Study.load(made / "study.toml"))
    result.save(tmp_path / "result")
    (tmp_path / "volume.toml").write_text(
        'format = "ulna-volume/1"\nunits = { length = "mm", angle = "rad" }\npoints = 500\nbars = 200\n'
        "lengths = [200.0]\n"
    )
    found = ulna.volume_uncertainty(tmp_path / "result", tmp_path / "volume.toml", seed=1)
    assert 0.001 < np.median(found.lengths[200.0].u_mm) < 0.2


def test_what_does_not_cover_it_says_so(tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError, match=r"joint 3 .* prismatic, which test plans do not cover"):
        OF.check_turns("profile.toml", "test plans")
    arm(1).check_turns("profile.toml", "test plans")


def test_a_report_draws_its_residuals_over_millimetres(made: Path) -> None:
    """Over the joint that slides the abscissa is how far it slid, over the others degrees."""
    study = Study.load(made / "study.toml")
    result = ulna.calibrate(study)
    found, _ = clouds(study, result.arm, result.residuals)
    joints = [each for each in found if each.over == "joint"]
    assert [each.slides for each in joints] == OF.slides.tolist()
    assert 100.0 < np.ptp(joints[2].x) < 350.1
    assert joints[2].x == pytest.approx(np.concatenate([group.q_rad[:, 2] for group in study.readings]))
