"""Loads that an arm carries beside its own masses: stated by name, said by readings, used by what gives way."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.simulations import BAR, NOISE, off_over_u, saved, true_arm, write

import ulna
from ulna import Arm, Effects, Payload, Study, UlnaInputError

LOADS = {"empty": Payload(0.4, (0.0, 0.0, 20.0)), "light": Payload(3.0, (0.0, 5.0, 40.0))}
LOADS["heavy"] = Payload(10.0, (-20.0, 0.0, 90.0))
TABLES = """
[payload.light]
mass = 3.0
centre = [0.0, 5.0, 40.0]

[payload.heavy]
mass = 10.0
centre = [-20.0, 0.0, 90.0]
"""
THREE = 'carried = ["empty", "light", "heavy"]\n'
COMPLIANCE = 'fit = { extras = ["compliance"], judge_extras = false }\n'


def bending(loads: dict[str, Payload] | None = None, mass_kg: float = 0.8) -> Arm:
    """The Platinum, giving way to links of 0.8 kg and to what it carries."""
    arm = true_arm()
    own = [Effects(compliance_rad_per_nm=2e-6 * (k + 1), mass_kg=mass_kg, centre_mm=(0, 10, -60)) for k in range(7)]
    joints = [replace(joint, effects=each) for joint, each in zip(arm.joints, own, strict=True)]
    return replace(arm, joints=tuple(joints), payloads=LOADS if loads is None else loads)


def poses(count: int = 40) -> np.ndarray:
    low, high = np.array([joint.limits_rad for joint in true_arm().joints]).T
    return np.random.default_rng(4).uniform(low, high, (count, 7))


def test_a_load_is_mass_at_the_last_joint() -> None:
    """What the arm does with a load is what one does whose last link has the mass of both, at the centre of both."""
    arm, q_rad, load = bending(), poses(), LOADS["heavy"]
    own = arm.joints[-1].effects
    mass_kg = own.mass_kg + load.mass_kg
    centre_mm = (own.mass_kg * np.array(own.centre_mm) + load.mass_kg * np.array(load.centre_mm)) / mass_kg
    heavier = replace(arm.joints[-1], effects=replace(own, mass_kg=mass_kg, centre_mm=tuple(centre_mm.tolist())))
    with_both = replace(arm, joints=(*arm.joints[:-1], heavier), payloads={})
    np.testing.assert_allclose(arm.tip(q_rad, payload="heavy"), with_both.tip(q_rad), rtol=0, atol=1e-11)
    # of compliance, mm for each rad/(N m)
    np.testing.assert_allclose(arm.jacobian(q_rad, payload="heavy"), with_both.jacobian(q_rad), rtol=1e-12, atol=1e-7)
    assert np.abs(arm.tip(q_rad, payload="heavy") - arm.tip(q_rad, payload="none")).max() > 0.05
    bare = replace(arm, payloads={})
    np.testing.assert_array_equal(arm.tip(q_rad, payload="none"), bare.tip(q_rad))


def test_each_pose_has_its_own() -> None:
    arm, q_rad = bending(), poses(3)
    names = ["none", "heavy", "light"]
    each = [arm.tip(q, payload=name) for q, name in zip(q_rad, names, strict=True)]
    np.testing.assert_array_equal(arm.tip(q_rad, payload=names), each)
    numbers = np.array([np.zeros(4), LOADS["heavy"].numbers, LOADS["light"].numbers])
    np.testing.assert_array_equal(arm.tip(q_rad, payload=numbers), each)
    measured = ulna.measure(arm, q_rad, payload=names)
    np.testing.assert_array_equal(measured.points_mm, each)
    with pytest.raises(UlnaInputError, match=r"give way to what they carry, but .* which load was carried"):
        arm.tip(q_rad)
    with pytest.raises(UlnaInputError, match=r"no payload 'hevy'. Did you mean 'heavy'"):
        arm.tip(q_rad, payload="hevy")
    with pytest.raises(UlnaInputError, match=r"payload: got -1"):
        arm.tip(q_rad, payload=(-1.0, 0, 0, 0))


def test_three_loads_in_one_study_are_found_with_compliance_and_not_without(tmp_path: Path) -> None:
    spec = write(tmp_path, BAR + "placements = 500\n", f"{NOISE}\n{THREE}{COMPLIANCE}", bending())
    simulated, study = saved(spec)
    assert set(study.arm.payloads) == set(LOADS)
    carried = [each["payload"] for each in simulated.as_dict()["placements"]]
    assert {"empty", "light", "heavy"} == set(carried)
    result = ulna.calibrate(study)
    assert result.fit.chi2_per_dof == pytest.approx(1.0, abs=0.15)
    assert np.abs(off_over_u(simulated, result)).max() < 4.5
    bent = [row for row in result.parameters if row.name.endswith(".compliance") and row.status == "fitted"]
    assert len(bent) >= 5
    assert ulna.calibrate(study, extras=[]).fit.chi2_per_dof > 1.5
    # and where compliance is asked for, but nobody says what was carried
    alike = replace(study, readings=[replace(each, payload=np.zeros((len(each), 4))) for each in study.readings])
    assert ulna.calibrate(alike).fit.chi2_per_dof > 1.5
    # the result knows the loads: it measures with them by name
    result.save(tmp_path / "result")
    again = Arm.load(tmp_path / "result")
    assert again.payloads == study.arm.payloads
    points = ulna.measure(tmp_path / "result", tmp_path / "out" / "bar.csv").table
    said = study.readings[0].said[0]
    np.testing.assert_allclose(
        points.select("x", "y", "z").to_numpy(), result.arm.tip(study.readings[0].q_rad, **said), rtol=0, atol=1e-9
    )
    # judged by rows of each load, with the arm of a file
    evaluated = ulna.evaluate(tmp_path / "result", study).as_dict()["overall"]
    assert evaluated["length_error_rms_mm"] < 0.03


@pytest.mark.long
def test_uncertainties_of_compliance_hold_the_truth_under_load(tmp_path: Path) -> None:
    """Of 20 simulated studies: compliances are off by as much as they say."""
    ratios = []
    for seed in range(20):
        spec = write(
            tmp_path / str(seed), BAR + "placements = 80\n", f"seed = {seed}\n{NOISE}\n{THREE}{COMPLIANCE}", bending()
        )
        simulated, study = saved(spec)
        result = ulna.calibrate(study)
        names = [row.name for row in result.parameters if row.status == "fitted" and row.name.endswith(".compliance")]
        truth = dict(zip(simulated.truth.arm.parameter_names, simulated.truth.arm.parameters, strict=True))
        rows = {row.name: row for row in result.parameters}
        ratios += [(rows[name].value - truth[name]) / rows[name].u for name in names]
    off = np.array(ratios)
    assert np.mean(np.abs(off) < 1.96) == pytest.approx(0.95, abs=0.05)


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A study of an arm with masses, whose loads are stated in the study; nothing says yet which was carried."""
    folder = tmp_path_factory.mktemp("loads")
    spec = write(folder, BAR + "placements = 40\n", f"{NOISE}\n{COMPLIANCE}", bending({}))
    saved(spec)
    return folder / "out"


def changed(plain: Path, tmp_path: Path, text: str = "", head: str = "", entry: str = "", cells: str = "") -> Path:
    for name in ("arm.toml", "bar.csv"):
        (tmp_path / name).write_text((plain / name).read_text())
    if cells:
        table = pl.read_csv(tmp_path / "bar.csv")
        table.with_columns(payload=pl.Series(np.resize(cells.split(), len(table)))).write_csv(tmp_path / "bar.csv")
    study = (plain / "study.toml").read_text()
    study = study.replace("\n\n[[readings]]", f"\n{head}\n[[readings]]\n{entry}", 1)
    (tmp_path / "study.toml").write_text(f"{study}{text}")
    return tmp_path / "study.toml"


def carried(study: Study) -> np.ndarray:
    (group,) = study.readings
    assert group.payload is not None
    return group.payload


def test_a_column_a_readings_table_or_the_study_says_it(plain: Path, tmp_path: Path) -> None:
    study = Study.load(changed(plain, tmp_path, TABLES, cells="light none heavy"))
    expected = np.resize([LOADS["light"].numbers, np.zeros(4), LOADS["heavy"].numbers], (len(study.readings[0]), 4))
    np.testing.assert_array_equal(carried(study), expected)
    study = Study.load(changed(plain, tmp_path, TABLES, entry='payload = "light"'))
    assert (carried(study) == LOADS["light"].numbers).all()
    study = Study.load(changed(plain, tmp_path, TABLES, head='carried = "heavy"'))
    assert (carried(study) == LOADS["heavy"].numbers).all()
    # the nearest to the readings goes first
    study = Study.load(changed(plain, tmp_path, TABLES, head='carried = "heavy"', entry='payload = "light"'))
    assert (carried(study) == LOADS["light"].numbers).all()


def test_in_memory_too(plain: Path) -> None:
    frame, arm = pl.read_csv(plain / "bar.csv"), Arm.load(plain / "arm.toml")
    loads = {name: LOADS[name] for name in ("light", "heavy")}
    bar = {"kind": "bar", "length_mm": 443.172}
    study = Study.from_frame(arm, frame, bar, angle="rad", payload="heavy", payloads=loads, extras=["compliance"])
    assert (carried(study) == LOADS["heavy"].numbers).all()


REFUSED = {
    "unknown in a cell": ({"cells": "light hevy"}, ["bar.csv", "row 2", "'payload'", "'hevy'", "Did you mean 'heavy'"]),
    "unknown in the table": ({"entry": 'payload = "lihgt"'}, ["readings.1.payload", "'lihgt'", "Did you mean 'light'"]),
    "unknown in the study": ({"head": 'carried = "lihgt"'}, ["key 'carried'", "'lihgt'", "Did you mean 'light'"]),
    "an empty cell": ({"cells": "light,,heavy"}, ["bar.csv", "payload"]),
    "no word for a load": ({"text": "[payload.none]\nmass = 1\ncentre = [0, 0, 0]\n"}, ["payload.none", "no load"]),
    "no centre": ({"text": "[payload.gripper]\nmass = 1\n"}, ["payload.gripper.centre"]),
    "less than nothing": ({"text": "[payload.g]\nmass = -1\ncentre = [0, 0, 0]\n"}, ["payload.g.mass", "-1"]),
    "nobody says which": ({}, ["do not all say which load was carried", "column payload"]),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_meant_is_told(plain: Path, tmp_path: Path, case: str) -> None:
    change, said = REFUSED[case]
    path = changed(plain, tmp_path, **{**change, "text": TABLES + change.get("text", "")})
    with pytest.raises(UlnaInputError) as error:
        ulna.calibrate(Study.load(path))
    for each in said:
        assert each in str(error.value)


def test_a_column_of_loads_that_nobody_stated_is_asked_about(plain: Path, tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError, match=r"column 'payload': got 'light', but no load has been stated.*ignore"):
        Study.load(changed(plain, tmp_path, cells="light heavy"))
    study = Study.load(changed(plain, tmp_path, cells="light heavy", entry='ignore = ["payload"]'))
    assert study.readings[0].payload is None


def test_one_name_for_two_loads_is_refused(plain: Path, tmp_path: Path) -> None:
    path = changed(plain, tmp_path, TABLES, head='carried = "light"')
    arm = (tmp_path / "arm.toml").read_text()
    (tmp_path / "arm.toml").write_text(arm + TABLES)
    Study.load(path)  # the same twice is one
    (tmp_path / "arm.toml").write_text(arm + TABLES.replace("3.0", "3.1"))
    with pytest.raises(UlnaInputError, match=r"payload.light.*got 3 kg at .* but the arm file says 3.1 kg"):
        Study.load(path)


def test_a_load_that_nothing_gives_way_to_is_told_once(plain: Path, tmp_path: Path) -> None:
    path = changed(plain, tmp_path, TABLES, head='carried = "light"')
    text = path.read_text()
    assert 'extras = ["compliance"]' in text
    path.write_text(text.replace('extras = ["compliance"]', "extras = []"))
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        study = Study.load(path)
    told = [str(each.message) for each in found if "gives way" in str(each.message)]
    assert len(told) == 1
    assert "the loads are not used" in told[0]
    assert [each for each in study.warnings if "gives way" in each] == told
    with pytest.warns(ulna.InputWarning, match="do not give way to what they carry; the payload is not used"):
        ulna.measure(Arm.load(tmp_path / "arm.toml"), tmp_path / "bar.csv", payload="light")


def test_measuring_a_file_asks_for_it(tmp_path: Path) -> None:
    arm, q_rad = bending(), poses(6)
    table = pl.DataFrame({f"q{k + 1}": q_rad[:, k] for k in range(7)})
    table.write_csv(tmp_path / "q.csv")
    with pytest.raises(UlnaInputError, match=r"no column 'payload', but .* give way .*--payload"):
        ulna.measure(arm, tmp_path / "q.csv")
    points = ulna.measure(arm, tmp_path / "q.csv", payload="heavy").table
    np.testing.assert_allclose(points.select("x", "y", "z").to_numpy(), arm.tip(q_rad, payload="heavy"), atol=1e-12)
    table.with_columns(payload=pl.Series(["none", "heavy", "hevy"] * 2)).write_csv(tmp_path / "q.csv")
    with pytest.raises(UlnaInputError, match=r"q.csv: row 3 .*'payload'.*no payload 'hevy'. Did you mean 'heavy'"):
        ulna.measure(arm, tmp_path / "q.csv")
    table.with_columns(payload=pl.Series(["none", "heavy", "light"] * 2)).write_csv(tmp_path / "q.csv")
    points = ulna.measure(arm, tmp_path / "q.csv").table
    assert points.columns == ["x", "y", "z"]
    expected = arm.tip(q_rad, payload=["none", "heavy", "light"] * 2)
    np.testing.assert_allclose(points.to_numpy(), expected, atol=1e-12)


WRONG_SPECS = {
    "nobody says which": ("", ["key 'carried' is missing", "empty, light, heavy"]),
    "unknown": ('carried = ["light", "hevy"]\n', ["key 'carried'", "'hevy'", "Did you mean 'heavy'"]),
}


@pytest.mark.parametrize("case", WRONG_SPECS)
def test_simulations_say_what_is_carried(tmp_path: Path, case: str) -> None:
    text, said = WRONG_SPECS[case]
    with pytest.raises(UlnaInputError) as error:
        ulna.simulate(write(tmp_path, BAR, f"{NOISE}\n{text}", bending()))
    for each in said:
        assert each in str(error.value)


def test_a_simulation_of_a_stiff_arm_carries_nothing(tmp_path: Path) -> None:
    with pytest.raises(UlnaInputError, match=r"key 'carried': .*bends under no load"):
        ulna.simulate(write(tmp_path, BAR, f'{NOISE}\ncarried = "none"\n', true_arm()))
