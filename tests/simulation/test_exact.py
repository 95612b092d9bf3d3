"""Simulated touches are where they should be, and err by what was asked for and nothing else."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from scipy import stats
from tests.simulations import BALL, BAR, NOISE, PLATE, saved, standing, with_effects, write

import ulna
from ulna import Arm
from ulna.simulation.file import load_simulation


def test_the_geometry_is_exact(tmp_path: Path) -> None:
    hollow = '[artefact.hollow]\nkind = "sphere"\ndiameter = 40.0\ninside = true\nu = 0.01\n'
    table = '[artefact.table]\nkind = "plane"\nsize = [120.0, 50.0]\n'
    rows = '[artefact.rows]\nkind = "length"\nlength = 150.0\nu = 0.01\n'
    simulated, study = saved(write(tmp_path, BAR + PLATE + BALL + hollow + table + rows, 'drawing = "exact"'))
    account = json.loads((tmp_path / "out" / "truth.json").read_text())
    true = {entry["artefact"]: entry for entry in account["artefacts"]}
    tip_mm = {group.artefact.name: simulated.truth.arm.tip(group.q_rad) for group in study.readings}
    group_of = {group.artefact.name: group for group in study.readings}

    ends_mm = tip_mm["bar"].reshape(-1, 2, 3)
    assert np.linalg.norm(ends_mm[:, 1] - ends_mm[:, 0], axis=1) == pytest.approx(true["bar"]["length_mm"], abs=1e-8)
    assert 0 < abs(true["bar"]["length_mm"] - 443.172) < 0.005

    origin_mm, axes = standing(account, "plate")
    assert axes @ axes.transpose(0, 2, 1) == pytest.approx(np.tile(np.eye(3), (5, 1, 1)), abs=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    features_mm = np.array(list(true["plate"]["features_mm"].values()))
    assert tip_mm["plate"].reshape(5, 4, 3) == pytest.approx(origin_mm[:, None] + features_mm @ axes, abs=1e-8)

    for name, apart_mm in (("ball", 3.0), ("hollow", -3.0)):
        origin_mm, axes = standing(account, name)
        from_centre_mm = tip_mm[name].reshape(5, 20, 3) - origin_mm[:, None]
        radius_mm = true[name]["diameter_mm"] / 2 + apart_mm
        assert np.linalg.norm(from_centre_mm, axis=2) == pytest.approx(radius_mm, abs=1e-8)
        # one half of it, from its rim to its pole
        height = np.einsum("ptk,pk->pt", from_centre_mm, axes[:, 2]) / radius_mm
        assert (height.min(), height.max()) == pytest.approx((0.025, 0.975))

    origin_mm, axes = standing(account, "table")
    local_mm = (tip_mm["table"].reshape(5, 20, 3) - origin_mm[:, None]) @ axes.transpose(0, 2, 1)
    assert local_mm[..., 2] == pytest.approx(3.0, abs=1e-8)
    assert (np.abs(local_mm[..., :2]).max(axis=(0, 1)) <= [60.0, 25.0]).all()
    assert (np.ptp(local_mm, axis=(0, 1))[:2] > [90.0, 40.0]).all()

    rows_group = group_of["rows"]
    assert rows_group.p_rad is not None
    apart = np.linalg.norm(simulated.truth.arm.tip(rows_group.p_rad) - tip_mm["rows"], axis=1)
    assert apart == pytest.approx(true["rows"]["length_mm"], abs=1e-8)
    assert rows_group.length_mm == pytest.approx(150.0)
    # nothing is off: the true arm, unchanged, explains every reading but for what its artefacts' u hides
    assert simulated.study.arm.parameters == pytest.approx(simulated.truth.arm.parameters)


def test_joints_stay_within_their_limits_and_all_of_them_move(tmp_path: Path) -> None:
    simulated, study = saved(write(tmp_path, BAR))
    q_rad = study.readings[0].q_rad
    limits_rad = np.array([joint.limits_rad for joint in simulated.truth.arm.joints])
    assert (q_rad >= limits_rad[:, 0]).all()
    assert (q_rad <= limits_rad[:, 1]).all()
    assert (np.ptp(q_rad, axis=0) > 0.7 * np.diff(limits_rad)[:, 0]).all()
    assert study.warnings == []


def test_quantisation_is_a_uniform_error_of_one_count(tmp_path: Path) -> None:
    spec = write(tmp_path, BAR + "placements = 500\n", "noise = { counts_per_turn = 65536 }")
    simulated, study = saved(spec)
    counts = pl.read_csv(tmp_path / "out" / "bar.csv").select(f"q{k}" for k in range(1, 8))
    assert all(dtype == pl.Int64 for dtype in counts.dtypes)
    step = 2 * math.pi / 65536
    off = (study.readings[0].q_rad - simulated.truth.touchings[0].standings.q_rad.reshape(-1, 7)) / step
    assert np.abs(off).max() <= 0.5 + 1e-6
    for joint in range(7):
        assert stats.kstest(off[:, joint], stats.uniform(-0.5, 1.0).cdf).pvalue > 1e-3
    assert study.noise is not None
    assert study.noise.encoder_rad == pytest.approx(np.full(7, step / math.sqrt(12)))
    assert study.noise.seat_mm is None


def test_touches_of_a_warm_arm_with_effects_are_exact(tmp_path: Path) -> None:
    spec = write(tmp_path, BAR, 'drawing = "exact"\ntemperature = { mean = 24.0, spread = 3.0 }', with_effects())
    simulated, study = saved(spec)
    group = study.readings[0]
    assert group.temperature_c is not None
    ends_mm = simulated.truth.arm.tip(group.q_rad, temperature_c=group.temperature_c).reshape(-1, 2, 3)
    true_mm = simulated.truth.touchings[0].artefact.length_mm
    assert np.linalg.norm(ends_mm[:, 1] - ends_mm[:, 0], axis=1) == pytest.approx(true_mm, abs=4e-9)
    # one temperature for each placement, as asked
    each = group.temperature_c.reshape(-1, 2)
    assert (each[:, 0] == each[:, 1]).all()
    assert each[:, 0].mean() == pytest.approx(24.0, abs=1.0)
    assert each[:, 0].std() == pytest.approx(3.0, abs=0.8)
    cold = simulated.truth.arm.tip(group.q_rad, temperature_c=20.0).reshape(-1, 2, 3)
    assert np.abs(np.linalg.norm(cold[:, 1] - cold[:, 0], axis=1) - true_mm).max() > 0.01
    assert study.arm.extras == simulated.truth.arm.extras


def test_the_drawing_is_off_by_no_more_than_asked(tmp_path: Path) -> None:
    def drawn(more: str, arm: Arm | None = None) -> tuple[ulna.Simulated, np.ndarray]:
        simulated = ulna.simulate(write(tmp_path, BAR, f"{NOISE}\n{more}", arm))
        return simulated, simulated.study.arm.parameters - simulated.truth.arm.parameters

    simulated, off = drawn("drawing = { offset = 0.01, length = 0.5, twist = 0.002 }")
    names = simulated.truth.arm.parameter_names
    kind = np.array([name.split(".")[-1] for name in names])
    most = {"theta0": 0.01, "alpha": 0.002}
    for name in ("theta0", "alpha", "a", "d", "x"):
        assert 0 < np.abs(off[kind == name]).max() <= most.get(name, 0.5)
    assert off[names.index("joint.1.theta0")] == off[names.index("joint.1.d")] == 0
    simulated, off = drawn("")
    assert np.abs(simulated.study.arm.parameters[kind == "alpha"]) == pytest.approx(math.pi / 2, abs=0)
    assert 0.02 < np.abs(off[kind == "theta0"]).max() <= 0.05
    kept, _ = drawn("drawing = { effects = true }", with_effects())
    assert [joint.effects for joint in kept.study.arm.joints] == [joint.effects for joint in with_effects().joints]


def test_artefacts_stand_in_the_volume_and_joints_in_the_travel(tmp_path: Path) -> None:
    more = "volume = { low = [200.0, -300.0, 0.0], high = [800.0, 300.0, 500.0] }\n"
    limits = [[-1.5, 1.5], [0.6, 3.3], [-2.0, 2.0], [0.6, 3.3], [-2.0, 2.0], [0.6, 3.3], [-1.0, 1.0]]
    more += f'drawing = "exact"\ntravel = {{ limits = {limits} }}'
    simulated, study = saved(write(tmp_path, BAR + "placements = 40\n", more))
    tip_mm = simulated.truth.arm.tip(study.readings[0].q_rad)
    assert (tip_mm >= [200, -300, 0]).all()
    assert (tip_mm <= [800, 300, 500]).all()
    assert np.abs(study.readings[0].q_rad[:, 6]).max() <= 1.0
    origin_mm, _ = standing(simulated.as_dict(), "bar")
    assert tip_mm[::2] == pytest.approx(origin_mm, abs=1e-8)


def test_a_file_of_every_key_loads_forever() -> None:
    simulation = load_simulation(Path(__file__).parents[1] / "data" / "fossils" / "simulation-1.toml")
    degree, inch = math.radians(1.0), 25.4
    assert simulation.seed == 77
    assert simulation.drawing is not None
    assert simulation.drawing.effects
    off = (simulation.drawing.offset_rad, simulation.drawing.length_mm, simulation.drawing.twist_rad)
    assert off == pytest.approx((2 * degree, 0.05 * inch, 0.1 * degree))
    assert simulation.encoder_rad == pytest.approx(np.full(3, 0.0005 * degree))
    assert simulation.seat_mm == pytest.approx(0.0004 * inch)
    assert [joint.counts_per_turn for joint in simulation.arm.joints] == [4096.0] * 3
    assert simulation.step_rad is None
    assert simulation.travel_rad == pytest.approx(np.tile([-90 * degree, 80 * degree], (3, 1)))
    assert simulation.temperature is not None
    assert (simulation.temperature.mean_c, simulation.temperature.spread_c) == (21.5, 1.5)
    assert simulation.missed is not None
    assert (simulation.missed.share, simulation.missed.size_mm) == pytest.approx((0.01, 0.04 * inch))
    assert simulation.volume_mm is not None
    assert simulation.volume_mm[0] == pytest.approx((-254.0, -508.0, -762.0))
    bar, table, plate = simulation.touching
    assert (bar.placements, bar.touches, bar.probes, bar.artefact.fitted) == (7, 2, ("bent",), True)
    assert (bar.artefact.length_mm, bar.artefact.u_mm) == pytest.approx((12 * inch, 0.0001 * inch))
    assert (table.placements, table.touches) == (5, 9)
    assert table.size_mm == pytest.approx((4 * inch, 2 * inch))
    assert (plate.placements, plate.touches, plate.artefact.frame) == (1, 1, "arm")
    assert plate.artefact.feature_u_mm == pytest.approx((0.00004 * inch,) * 3)
    fit = simulation.fit
    assert (fit.hold, fit.free, fit.loss) == (["joint.1.theta0"], ["joint.*", "probe.*"], "huber")
    assert (fit.extras, fit.harmonics, fit.judge_extras) == (["encoder-harmonics"], [1], False)
