"""Models of the literature with more parameters than needed: what is redundant is named, and no point depends on it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import ulna
from ulna.arm.arm import Arm
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.readings import Readings
from ulna.study.assembly import assemble
from ulna.study.data import FitOptions
from ulna.study.study import Study


def six_axes() -> Arm:
    links = [(0.1, -1.57, 35.0, 250.0), (0.2, 1.57, 20.0, 10.0), (-0.3, -1.57, 15.0, 600.0)]
    links += [(0.4, 1.57, -20.0, 5.0), (0.15, -1.57, 12.0, 550.0)]
    joints = (*(Joint(*link) for link in links), Joint())
    return Arm("six axes", joints, {"bent": Probe(60.0, 10.0, 150.0)})


def with_full_last_link(tip_mm: tuple[float, float, float]) -> Arm:
    """The same arm, its tip partly in a link of the last joint: any such link will do."""
    arm = six_axes()
    last = Joint(theta0_rad=0.3, alpha_rad=0.7, a_mm=25.0, d_mm=80.0)
    return replace(arm, joints=(*arm.joints[:-1], last), probes={"bent": Probe(*tip_mm)}, full_last_link=True)


def study_of(arm: Arm, kind: str, rng: np.random.Generator, **fit: object) -> Study:
    q = rng.uniform(-2.5, 2.5, (200, 6))
    if kind == "coordinates":
        points = {f"p{k}": tuple(p) for k, p in enumerate(arm.tip(q).tolist())}
        artefact = Artefact("cmm", "points", points, frame="arm")
        p_rad = length = None
        feature = np.arange(200)
    else:
        artefact = Artefact("rows", "length", {})
        p_rad = rng.uniform(-2.5, 2.5, (200, 6))
        length = np.linalg.norm(arm.tip(q) - arm.tip(p_rad), axis=1)
        feature = np.zeros(200, np.int64)
    zeros = np.zeros(200, np.int64)
    readings = Readings(
        artefact, q, p_rad, length, zeros, feature, np.array(["1"] * 200, dtype=object), np.arange(200), zeros
    )
    return Study(None, arm, [readings], fit=FitOptions(**fit))  # type: ignore[arg-type]


@pytest.mark.parametrize(("kind", "determined"), [("coordinates", 23), ("lengths", 21)])
@pytest.mark.parametrize("model", [23, 25, 27])
def test_the_counts_of_the_literature(model: int, kind: str, determined: int) -> None:
    """23 without redundance; 27 with a full last link and a tip; 25 with a link and one length."""
    rng = np.random.default_rng(1)
    if model == 23:
        study = study_of(six_axes(), kind, rng)
    elif model == 27:
        study = study_of(with_full_last_link((40.0, 10.0, 60.0)), kind, rng)
    else:
        study = study_of(with_full_last_link((0.0, 0.0, 120.0)), kind, rng, hold=["probe.bent.x", "probe.bent.y"])
    found = ulna.identify(study)
    assert (found.determined, found.parameters) == (determined, model)
    redundant = [direction for direction in found.lost if direction["cause"] == "redundant-link"]
    assert len(redundant) == model - 23
    for direction in redundant:
        assert all(name.startswith(("joint.6.", "probe.")) for name in direction["combination"])
        assert "one rigid body" in direction["because"]


@pytest.mark.parametrize("kind", ["coordinates", "lengths"])
def test_every_model_finds_the_same_arm(kind: str) -> None:
    """From a wrong start, fitted to the same readings: points in one place, with one uncertainty."""
    rng = np.random.default_rng(2)
    truth = six_axes()
    study = study_of(truth, kind, rng)
    group = study.readings[0]
    if group.length_mm is not None:
        group = replace(group, length_mm=group.length_mm + 0.01 * rng.standard_normal(200))
    else:
        group = replace(group, q_rad=group.q_rad + 1e-5 * rng.standard_normal((200, 6)))
    plain = replace(study, readings=[group])
    # a link that is the same arm as the truth, to start from the same place
    roll = Joint(theta0_rad=0.3, alpha_rad=0.0, a_mm=20.0, d_mm=80.0)
    c, s = np.cos(0.3), np.sin(0.3)
    x, y, z = 60.0, 10.0, 150.0
    tip = Probe(c * x - s * y - 20.0, s * x + c * y, z - 80.0)
    full = replace(truth, joints=(*truth.joints[:-1], roll), probes={"bent": tip}, full_last_link=True)
    np.testing.assert_allclose(full.tip(group.q_rad), truth.tip(group.q_rad), rtol=0, atol=1e-9)
    models = (plain, replace(plain, arm=full))
    results = [ulna.calibrate(study) for study in models]
    q = rng.uniform(-2.5, 2.5, (40, 6))
    tips = [result.arm.tip(q) for result in results]
    np.testing.assert_allclose(tips[0], tips[1], rtol=0, atol=1e-6)
    from ulna.measuring.tip_uncertainty import TipUncertainty

    u = [TipUncertainty(result.arm).of(q, 0) for result in results]
    np.testing.assert_allclose(u[0], u[1], rtol=1e-3)
    assert np.isfinite(u[1]).all()


def test_a_full_last_link_in_files(tmp_path: Path) -> None:
    """Written, read, the same; and one without the key says what to do."""
    arm = with_full_last_link((40.0, 10.0, 60.0))
    arm.save(tmp_path / "arm.toml")
    again = Arm.load(tmp_path / "arm.toml")
    assert again == arm
    assert len(assemble(study_of(again, "lengths", np.random.default_rng(3))).names) == 27
    text = (tmp_path / "arm.toml").read_text().replace("full_last_link = true\n", "")
    (tmp_path / "bare.toml").write_text(text)
    with pytest.raises(ulna.UlnaInputError, match="full_last_link = true"):
        Arm.load(tmp_path / "bare.toml")
