"""Blocks beyond geometry from a study to its result: fitted, judged by readings left out, written, applied."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from tests.cli_runs import platinum, run

import ulna
from ulna.arm.arm import Arm
from ulna.arm.effects.effects import Effects
from ulna.artefacts.artefact import Artefact
from ulna.artefacts.readings import Readings
from ulna.calibration.extras import compared
from ulna.study.data import FitOptions, Prior
from ulna.study.study import Study

PLATE = {f"s{k}": (100.0 * (k % 3), 100.0 * (k // 3), 3.0 * k) for k in range(9)}


def eccentric(rad: float) -> Arm:
    """The virtual Platinum with an error of its encoders, once a turn."""
    rng = np.random.default_rng(3)
    arm = platinum()
    joints = [
        replace(joint, effects=Effects(harmonics_rad={1: tuple((rad * rng.standard_normal(2)).tolist())}))
        for joint in arm.joints
    ]
    return replace(arm, joints=tuple(joints))


def study_of(truth: Arm, start: Arm, noise_mm: float = 0.01, temperature_c: Any = None, **fit: Any) -> Study:
    """Coordinates in six frames of a tracker, each of 40 touches."""
    rng = np.random.default_rng(5)
    count = 240
    q = rng.uniform(-2.5, 2.5, (count, 7))
    tips = truth.tip(q, temperature_c=temperature_c) + noise_mm * rng.standard_normal((count, 3))
    placement = np.repeat(np.arange(6), 40)
    turned = np.empty_like(tips)
    for k in range(6):
        turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
        turned[placement == k] = tips[placement == k] @ (turn * np.sign(np.linalg.det(turn)))
    artefact = Artefact("tracker", "points", {f"m{k}": tuple(p) for k, p in enumerate(turned.tolist())})
    zeros = np.zeros(count, np.int64)
    labels = np.array([str(k) for k in placement], dtype=object)
    readings = Readings(
        artefact, q, None, None, zeros, np.arange(count), labels, np.arange(1, count + 1), zeros, None, temperature_c
    )
    return Study(None, start, [readings], fit=FitOptions(**fit))


def test_a_block_that_explains_readings_earns_its_place() -> None:
    study = study_of(eccentric(3e-4), platinum(wrong=0.3), extras=["encoder-harmonics"], harmonics=[1])
    result = ulna.calibrate(study)
    (judged,) = result.extras
    assert judged.verdict == "earned"
    assert judged.figure == "coordinate_error_mean_mm"
    assert judged.groups == 6
    assert judged.with_mm < 0.2 * judged.without_mm
    assert judged.better_by_mm == pytest.approx(judged.without_mm - judged.with_mm)
    assert result.fit.rms_mm < 0.02
    truth = {f"joint.{k}.{part}1": value for k, joint in enumerate(eccentric(3e-4).joints, 1)
             for part, value in zip("cs", joint.effects.harmonics_rad[1], strict=True)}  # fmt: skip
    rows = [row for row in result.parameters if row.name in truth]
    assert len(rows) == 14
    assert all(row.prior == {"value": 0.0, "u": 5e-4} for row in rows)
    assert np.mean([abs(row.value - truth[row.name]) < 2 * (row.u or 0.0) for row in rows]) > 0.7


def test_a_block_that_explains_nothing_does_not() -> None:
    study = study_of(platinum(), platinum(wrong=0.3), extras=["encoder-harmonics"], harmonics=[1, 2, 3])
    judged = ulna.calibrate(study).extras
    assert [entry.order for entry in judged] == [None, 1, 2, 3]
    for entry in judged:
        assert entry.verdict in ("undecided", "not-earned")
        assert entry.with_mm > 0.95 * entry.without_mm


def test_the_order_that_is_there_is_told_from_the_one_that_is_not() -> None:
    study = study_of(eccentric(3e-4), platinum(wrong=0.3), extras=["encoder-harmonics"], harmonics=[1, 2])
    block, first, second = ulna.calibrate(study).extras
    assert [(entry.extra, entry.order) for entry in (block, first, second)] == [
        ("encoder-harmonics", None),
        ("encoder-harmonics", 1),
        ("encoder-harmonics", 2),
    ]
    assert (block.verdict, first.verdict) == ("earned", "earned")
    assert second.verdict in ("undecided", "not-earned")


@pytest.mark.long
def test_a_verdict_by_few_groups_needs_more() -> None:
    """Student's factor: two standard deviations of chance would be called earned far too often with three groups."""
    rng = np.random.default_rng(1)
    for groups in (2, 3, 5, 10):
        verdicts = []
        for _ in range(4000):
            gains = rng.standard_normal(groups)
            whole = [{"form_mm": 10.0 - float(gain)} for gain in gains]
            found = compared("compliance", None, [{"form_mm": 10.0}] * groups, whole, "placement")
            assert found is not None
            verdicts.append(found.verdict)
        for verdict in ("earned", "not-earned"):
            assert verdicts.count(verdict) / 4000 == pytest.approx(0.159, abs=0.025)


def test_each_block_is_judged_by_itself() -> None:
    """Harmonics are there, growth is not."""
    rng = np.random.default_rng(6)
    temperature = np.where(np.arange(240) % 2 == 0, 18.0, 27.0) + rng.uniform(-0.5, 0.5, 240)
    study = study_of(
        eccentric(3e-4),
        platinum(wrong=0.3),
        temperature_c=temperature,
        extras=["encoder-harmonics", "link-expansion"],
        harmonics=[1],
        prior={"joint.*.expansion": Prior(1e-5)},
    )
    harmonics, expansion = ulna.calibrate(study).extras
    assert (harmonics.extra, harmonics.verdict) == ("encoder-harmonics", "earned")
    assert (expansion.extra, expansion.verdict) != ("link-expansion", "earned")


def test_judging_can_be_left_out_and_one_placement_is_dealt() -> None:
    study = study_of(eccentric(3e-4), platinum(wrong=0.3), extras=["encoder-harmonics"], harmonics=[1])
    assert ulna.calibrate(study, judge_extras=False).extras == []
    group = study.readings[0]
    tips = eccentric(3e-4).tip(group.q_rad)
    artefact = replace(group.artefact, features={f"m{k}": tuple(p) for k, p in enumerate(tips.tolist())})
    one = replace(group, artefact=artefact, placement=np.array(["1"] * len(group), dtype=object))
    (judged,) = ulna.calibrate(replace(study, readings=[one])).extras
    assert (judged.by, judged.groups, judged.verdict) == ("5 folds of readings", 5, "earned")


def test_expansion_from_study_to_points(tmp_path: Path) -> None:
    """Temperatures go into the fit, the result, and measured points; without them points are refused."""
    rng = np.random.default_rng(7)
    joints = [
        replace(joint, effects=Effects(expansion_per_k=float(rng.uniform(1e-5, 2.4e-5)))) for joint in platinum().joints
    ]
    truth = replace(platinum(), joints=tuple(joints))
    temperature = np.where(np.arange(240) % 2 == 0, 16.0, 28.0) + rng.uniform(-0.5, 0.5, 240)
    study = study_of(truth, platinum(wrong=0.3), noise_mm=0.002, temperature_c=temperature, extras=["link-expansion"])
    result = ulna.calibrate(study)
    assert result.extras[0].verdict == "earned"
    result.save(tmp_path / "out")
    arm = ulna.Arm.load(tmp_path / "out" / "arm.toml")
    q = rng.uniform(-2, 2, (20, 7))
    fixed = [truth, arm]
    distances = [
        np.linalg.norm(each.tip(q[:10], temperature_c=27.0) - each.tip(q[10:], temperature_c=17.0), axis=1)
        for each in fixed
    ]
    assert abs(distances[0] - distances[1]).max() < 0.02
    table = pl.DataFrame({f"q{k + 1}": q[:, k] for k in range(7)})
    table.write_csv(tmp_path / "q.csv")
    with pytest.raises(ulna.UlnaInputError, match="no column 'temperature'"):
        ulna.measure(tmp_path / "out" / "result.json", tmp_path / "q.csv")
    cold = ulna.measure(tmp_path / "out" / "result.json", tmp_path / "q.csv", temperature_c=20.0).table
    table.with_columns(temperature=pl.Series([30.0] * 20)).write_csv(tmp_path / "warm.csv")
    warm = ulna.measure(tmp_path / "out" / "result.json", tmp_path / "warm.csv").table
    assert cold is not None
    assert warm is not None
    moved = np.linalg.norm(warm.select("x", "y", "z").to_numpy() - cold.select("x", "y", "z").to_numpy(), axis=1)
    assert (moved > 0.01).all()
    assert (moved < 0.5).all()
    assert warm["u_x"].null_count() == 0
    np.testing.assert_allclose(
        warm.select("x", "y", "z").to_numpy(), result.arm.tip(q, temperature_c=30.0), rtol=0, atol=1e-9
    )
    done = run("measure", tmp_path / "out" / "result.json", tmp_path / "q.csv")
    assert done.returncode == 2
    assert "give --temperature" in done.stderr
    done = run("measure", tmp_path / "out" / "result.json", tmp_path / "q.csv", "--temperature", "20")
    assert done.returncode == 0
    assert done.stdout.splitlines()[1].split(",")[0] == repr(cold["x"][0])


def test_what_a_result_says_of_extras_can_be_read_again(tmp_path: Path) -> None:
    study = study_of(eccentric(3e-4), platinum(wrong=0.3), extras=["encoder-harmonics"], harmonics=[1], loss="huber")
    group = study.readings[0]
    spoilt = group.q_rad.copy()
    spoilt[17, 3] += 0.005
    result = ulna.calibrate(replace(study, readings=[replace(group, q_rad=spoilt)]))
    assert [entry["row"] for entry in result.outliers][:1] == [18]
    assert result.outliers[0]["counted"] < 0.1
    result.save(tmp_path)
    again = ulna.Result.load(tmp_path)
    assert again.extras == result.extras
    assert again.outliers == result.outliers
    assert again.parameters == result.parameters
    assert again.residuals.equals(result.residuals)
    assert again.fit == result.fit
    assert again.arm == result.arm
    document = json.loads((tmp_path / "result.json").read_text())
    assert document["extras"][0]["verdict"] == "earned"
    assert document["arm"]["joint"][2]["harmonics"].keys() == {"c1", "s1"}


def test_a_calibrated_block_is_held_when_it_is_not_asked_for(tmp_path: Path) -> None:
    """A new probe on a calibrated arm: its harmonics stay, and their uncertainty goes on into the probe's."""
    study = study_of(eccentric(3e-4), platinum(wrong=0.3), extras=["encoder-harmonics"], harmonics=[1])
    first = ulna.calibrate(study)
    again = ulna.calibrate(replace(study, arm=first.arm, fit=FitOptions(free=["probe.*"])))
    status = {row.name: row.status for row in again.parameters}
    assert status["joint.3.c1"] == status["joint.3.theta0"] == "held"
    assert status["probe.bent.x"] == "fitted"
    assert "joint.3.c1" in again.covariance.names
    u = {row.name: row.u for row in again.parameters}
    alone = ulna.calibrate(replace(study, arm=replace(first.arm, uncertainty=None), fit=FitOptions(free=["probe.*"])))
    assert (u["probe.bent.x"] or 0) > ({row.name: row.u for row in alone.parameters}["probe.bent.x"] or 0)
