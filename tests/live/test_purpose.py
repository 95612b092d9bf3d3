"""What is touched, and what for: a study says the same as the plan file made of it, and what it lacks is said."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.live.guided_hand import platinum_plan
from tests.live.test_session import hand_of

import ulna
from ulna.live.purpose import purpose_of
from ulna.live.session import Session
from ulna.live.stream import Stream
from ulna.planning.file import load_plan_spec
from ulna.planning.making import plan_toml

EXAMPLE = Path("examples/platinum").resolve()
PLATE = """
[[readings]]
file = "plate.csv"
artefact = "plate"
probe = "bent"
[artefact.plate]
kind = "points"
features = { a = [0, 0, 0], b = [200, 0, 0], c = [0, 150, 0] }
"""


def study_in(folder: Path, change: tuple[str, str] = ("", ""), more: str = "") -> Path:
    """That of the example, changed, with its readings where they are."""
    text = (EXAMPLE / "study.toml").read_text(encoding="utf-8")
    text = text.replace('"platinum.toml"', f'"{EXAMPLE / "platinum.toml"}"')
    text = text.replace('"bars.csv"', f'"{EXAMPLE / "bars.csv"}"')
    assert change[0] in text
    path = folder / "study.toml"
    path.write_text(text.replace(*change) + more, encoding="utf-8")
    columns = ",".join(f"q{k}" for k in range(1, 8))
    rows = [f"1,{feature},{','.join([str(0.5 + 0.1 * k)] * 7)}" for k, feature in enumerate("abc")]
    (folder / "plate.csv").write_text("\n".join([f"placement,feature,{columns}", *rows]) + "\n", encoding="utf-8")
    return path


def test_a_study_says_what_the_plan_file_says_that_is_made_of_it(tmp_path: Path) -> None:
    arm, _ = platinum_plan()
    study = ulna.Study.load(EXAMPLE / "study.toml")
    made = tmp_path / "plan.toml"
    made.write_text(plan_toml(arm, study, tmp_path), encoding="utf-8")
    by_plan = load_plan_spec(made, arm)
    found = purpose_of(EXAMPLE / "study.toml", arm)
    for key in ("artefact", "seat_mm", "hold", "touches", "within", "volume_mm", "room_mm", "test_mm"):
        assert getattr(found.spec, key) == getattr(by_plan, key), key
    assert np.array_equal(found.spec.encoder_rad, by_plan.encoder_rad)
    assert found.spec.travel_rad is not None
    assert by_plan.travel_rad is not None
    assert np.allclose(found.spec.travel_rad, by_plan.travel_rad, atol=0.0)
    assert found.fit.hold == study.fit.hold
    assert found.remarks == (
        f"{EXAMPLE / 'study.toml'}: its 202 readings are not taken into the session; what is known begins from ARM.",
    )
    assert purpose_of(EXAMPLE / "study.toml", arm, length_mm=321.0).spec.test_mm == 321.0


def test_what_a_study_says_of_the_fit_is_what_the_session_fits(tmp_path: Path) -> None:
    arm, hand = hand_of(3)
    change = ("hold = [", 'known_length = 0.25\nknown_angle = 0.002\nfree = ["joint.*"]\nloss = "huber"\nhold = [')
    found = purpose_of(study_in(tmp_path, change), arm)
    assert "of [fit] loss is not taken" in found.remarks[1]
    session = Session(arm, found.spec, Stream(hand, hand.stated()), fit=found.fit)
    assert all(name.startswith("joint.") for name in session.fit.names)
    assert len(session.fit.names) == 24 - 2
    # nothing is touched yet: what is known is what a drawing is known by, and that is what the study says
    u = dict(zip(session.fit.names, np.sqrt(np.diag(session.fit.so_far().covariance)), strict=True))
    assert u["joint.3.a"] == pytest.approx(0.25)
    assert u["joint.3.alpha"] == pytest.approx(0.002)
    assert session.determinable <= 22


def test_of_several_artefacts_one_is_named(tmp_path: Path) -> None:
    arm, _ = platinum_plan()
    path = study_in(tmp_path, more=PLATE)
    with pytest.raises(ulna.UlnaInputError, match=r"2 artefacts, bar, plate; .* --artefact bar, or .*--make-plan"):
        purpose_of(path, arm)
    plate = purpose_of(path, arm, "plate").spec
    assert list(plate.artefact.features) == ["a", "b", "c"]
    with pytest.raises(ulna.UlnaInputError, match="--artefact: got 'plat'; expected one of bar, plate"):
        purpose_of(path, arm, "plat")
    with pytest.raises(ulna.UlnaInputError, match="plans for 'bar'"):
        purpose_of(EXAMPLE / "plan.toml", arm, "plate")


def test_a_study_that_waits_for_its_readings_says_the_same(tmp_path: Path) -> None:
    arm, spec = platinum_plan()
    path = study_in(tmp_path, (f'"{EXAMPLE / "bars.csv"}"', '"bar.csv"'))
    with pytest.raises(ulna.UlnaInputError, match=r"has no readings yet, and joint 1 of arm .* has no limits"):
        purpose_of(path, arm)
    assert spec.travel_rad is not None
    travel = [tuple(each) for each in spec.travel_rad.tolist()]
    joints = [replace(joint, limits_rad=each) for joint, each in zip(arm.joints, travel, strict=True)]
    limited = replace(arm, joints=joints)
    found, read = purpose_of(path, limited), purpose_of(EXAMPLE / "study.toml", limited)
    assert found.remarks == ()
    assert found.spec.artefact == read.spec.artefact
    assert (found.spec.probe, found.spec.seat_mm, found.fit) == ("bent", read.spec.seat_mm, read.fit)
    assert found.spec.travel_rad is not None
    assert np.array_equal(found.spec.travel_rad, spec.travel_rad)
    # a table that is there is read, and what is wrong with it is said
    (tmp_path / "bar.csv").write_text("placement,feature,q1\n", encoding="utf-8")
    with pytest.raises(ulna.UlnaInputError, match=r"bar\.csv"):
        purpose_of(path, limited)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("seat = ", "# seat = "), "key 'noise.seat' is missing"),
        (("encoder = ", "# encoder = "), "key 'noise.encoder' is missing"),
        (('format = "ulna-study/1"', 'format = "ulna-arm/1"'), "'ulna-arm/1'; expected \"ulna-plan/1\" or"),
        (('format = "ulna-study/1"', ""), "key 'format' is missing; expected \"ulna-plan/1\" or"),
        (("joint.1.d", "joint.9.d"), "joint.9.d"),
    ],
)
def test_what_a_session_cannot_begin_with_is_said(tmp_path: Path, change: tuple[str, str], said: str) -> None:
    arm, _ = platinum_plan()
    with pytest.raises(ulna.UlnaInputError, match=re.escape(said)):
        purpose_of(study_in(tmp_path, change), arm)
