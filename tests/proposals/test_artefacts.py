"""Every kind of artefact that there is can be proposed from a simulation's own table; a plate with its coordinates in a
table as people keep it."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.home_built import true_arm
from tests.proposals.test_questions import asked, refused

from ulna import Study
from ulna.artefacts.kinds import KINDS
from ulna.calibration.calibrate import calibrate
from ulna.proposals.answers import Answers
from ulna.proposals.propose import propose
from ulna.proposals.write import write_proposal
from ulna.simulation.simulate import simulate

#: what must be stated of each kind, in mm; as a table of a simulation, and as answers
STATED = {
    "bar": {"length": 443.172},
    "seat": {},
    "points": {},
    "length": {"length": 300.0},
    "sphere": {"diameter": 25.4},
    "plane": {},
    "cylinder": {"diameter": 80.0},
    "distance": {},
}
CORNERS = {f"s{k + 1}": (100.0 * (k % 3), 100.0 * (k // 3), 7.0 * k) for k in range(9)}


def simulated(folder: Path, kind: str) -> Study:
    """What is measured of an artefact called as its kind, and the study that a simulation writes."""
    arm = true_arm(3)
    replace(arm, probes={"tip": replace(arm.probes["tip"], ball_mm=6.0)}).save(folder / "true.toml")
    keys = "".join(f"{key} = {value}\n" for key, value in STATED[kind].items())
    if kind == "points":
        keys = "features = { " + ", ".join(f"{name} = {list(xyz)}" for name, xyz in CORNERS.items()) + " }\n"
    (folder / "spec.toml").write_text(
        'format = "ulna-simulation/1"\narm = "true.toml"\nunits = { length = "mm", angle = "rad" }\n'
        "noise = { encoder = 2e-5, seat = 0.01 }\ntravel = { limits = [[-2.5, 2.5]] }\n"
        f'[artefact.{kind}]\nkind = "{kind}"\nplacements = 12\n{keys}'
    )
    made = simulate(folder / "spec.toml")
    made.save(folder / "made")
    return Study.load(folder / "made" / "study.toml")


TOUCHED = [name for name, kind in KINDS.items() if not kind.turned]


@pytest.mark.parametrize("kind", TOUCHED)
def test_every_kind_is_read_as_it_was_written(tmp_path: Path, kind: str) -> None:
    """The same readings of the same artefact, whoever wrote the study."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        theirs = simulated(tmp_path, kind)
        table = tmp_path / "made" / f"{kind}.csv"
        features = tmp_path / "made" / f"{kind}-features.csv"
        answers = Answers(
            readings=table,
            artefact=kind,
            arm=tmp_path / "true.toml",
            zeros="known",
            signs="known",
            length_unit="mm",
            features=features if features.exists() else None,
            **STATED[kind],  # type: ignore[arg-type]
        )
        write_proposal(propose(answers), tmp_path / "study")
        ours = Study.load(tmp_path / "study" / "study.toml")
    assert len(ours.readings) == len(theirs.readings) == 1
    group, other = ours.readings[0], theirs.readings[0]
    assert group.artefact.kind == kind
    np.testing.assert_array_equal(group.q_rad, other.q_rad)
    np.testing.assert_array_equal(group.feature, other.feature)
    assert group.placement.tolist() == other.placement.tolist()
    assert group.artefact.features == other.artefact.features
    for name in ("length_mm", "p_rad"):
        assert (getattr(group, name) is None) == (getattr(other, name) is None)


def test_a_plate_as_people_keep_it(tmp_path: Path) -> None:
    """Coordinates with semicolons and commas, features called by a word and their number, readings in degrees."""
    simulated(tmp_path, "points")
    frame = pl.read_csv(tmp_path / "made" / "points.csv")
    angles = {f"Axis {k}": np.degrees(frame[f"q{k}"].to_numpy()) for k in range(1, 7)}
    balls = frame["feature"].str.replace("s", "ball ")
    pl.DataFrame({"Setup": frame["placement"], **angles, "Ball": balls}).write_csv(tmp_path / "table.csv")
    rows = [f"Kugel {name[1:]};" + ";".join(str(v).replace(".", ",") for v in xyz) for name, xyz in CORNERS.items()]
    plate = tmp_path / "platte.csv"
    plate.write_bytes("\n".join(["Kugel;X [mm];Y [mm];Z [mm]", *rows, ""]).encode("cp1252"))
    said = Answers(readings=tmp_path / "table.csv", artefact="points", reach=1000.0, parallel=("none",))
    assert asked(said) == ["features"]
    found = propose(
        Answers(readings=tmp_path / "table.csv", artefact="points", reach=1000.0, parallel=("none",), features=plate)
    )
    assert found.entry["names"]["feature"]["Kugel 3"] == "ball 3"
    write_proposal(found, tmp_path / "study")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        result = calibrate(Study.load(tmp_path / "study" / "study.toml"))
    assert result.fit.converged
    truth, q_rad = true_arm(3), np.random.default_rng(0).uniform(-2.5, 2.5, (2, 100, 6))
    lengths = [np.linalg.norm(arm.tip(q_rad[0]) - arm.tip(q_rad[1]), axis=1) for arm in (result.arm, truth)]
    assert abs(lengths[0] - lengths[1]).max() < 0.2


def test_coordinates_without_a_unit_are_asked_about(tmp_path: Path) -> None:
    (tmp_path / "plate.csv").write_text("feature,x,y,z\na,0,0,0\nb,1,0,0\nc,0,1,0\n")
    rows = "".join(f"1,{k}.5,1.5,0.5,2.5,1.25,{k % 3}.75,{'abc'[k % 3]}\n" for k in range(9))
    (tmp_path / "table.csv").write_text(f"setup,q1,q2,q3,q4,q5,q6,point\n{rows}")
    said = Answers(
        readings=tmp_path / "table.csv",
        artefact="points",
        features=tmp_path / "plate.csv",
        reach=900.0,
        parallel=("none",),
        angle="rad",
    )
    assert asked(said) == ["length_unit"]


def test_a_ball_that_matters_is_asked_about(tmp_path: Path) -> None:
    rows = "".join(f"1,{k}.5,1.5,0.5,2.5,1.25,{k % 3}.75\n" for k in range(9))
    (tmp_path / "table.csv").write_text(f"setup,q1,q2,q3,q4,q5,q6\n{rows}")
    said = Answers(
        readings=tmp_path / "table.csv",
        artefact="sphere",
        diameter=25.4,
        reach=900.0,
        parallel=("none",),
        angle="rad",
        one_standing=True,
    )
    assert asked(said) == ["ball"]
    assert propose(replace(said, ball=6.0)).arm.probes["tip"].ball_mm == 6.0


def test_an_artefact_without_a_length_and_an_arm_that_nobody_drew(tmp_path: Path) -> None:
    """The scale of the arm would be a guess; two probes, and columns that are nearly known, do no harm."""
    rows = "".join(f"{k}.5,1.5,0.5,2.5,1.25,{k % 3}.75,cone,,{('long', 'short')[k % 2]}\n" for k in range(40))
    (tmp_path / "table.csv").write_text(f"A1,A2,A3,A4,A5,A6,Feature,Temperature,Probe\n{rows}")
    said = Answers(
        readings=tmp_path / "table.csv",
        artefact="seat",
        reach=900.0,
        parallel=("none",),
        angle="deg",
        one_standing=True,
    )
    refused(said, "--reach", "'seat' has no length", "would be a guess")
    true_arm(3).save(tmp_path / "true.toml")
    found = propose(replace(said, reach=None, arm=tmp_path / "true.toml", zeros="known", signs="known"))
    assert list(found.arm.probes) == ["long", "short"]
    assert found.entry["ignore"] == ["Feature", "Temperature"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        write_proposal(found, tmp_path / "study")
