"""Figures of the spread of several bars' deviations: each bar's own error is in all deviations of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.acceptance import rows, write_plan

import ulna

KEYS = ("Volumetric_2S", "Volumetric_half_range")
U_MM = {"short": 0.0015, "long": 0.0040}
LENGTH_MM = {"short": 500.0, "long": 1200.0}
EXPANSION, U_EXPANSION, WARM_K, U_K, FIXTURE_MM = 11.5e-6, 1.2e-6, 3.0, 0.3, 0.0005


def bars(names: list[str], e_mm: dict[str, np.ndarray], folder: Path) -> dict[str, tuple[float, float | None]]:
    """Of each figure its value and u, by `ulna verify`; e_mm: deviations from the lengths at the test's temperature."""
    table, text = [], ""
    for name in names:
        text += (
            f'[artefact.{name}]\nkind = "length"\nlength = {LENGTH_MM[name]}\nu = {U_MM[name]}\nends = "seats"\n'
            f"expansion = {EXPANSION}\nu_expansion = {U_EXPANSION}\n"
        )
        warm = LENGTH_MM[name] * (1.0 + EXPANSION * WARM_K)
        for k, e in enumerate(e_mm[name]):
            for feature, x in (("A", 0.0), ("B", warm + e)):
                point = np.array([[x, LENGTH_MM[name], 20.0 * k]])
                labels = {"artefact": name, "position": f"{name}-{k}", "feature": feature}
                table.append(rows(point, test="volumetric", **labels))
    plan = write_plan(
        folder,
        pl.concat(table, how="diagonal").fill_null(""),
        head='format = "ulna-verify/1"\nprofile = "asme-b89-4-22"\nunits = { length = "mm", angle = "rad" }\n',
        keys='arm = "a foreign arm"\nball = 6.0\n',
        mpe="[mpe]\nVolumetric_2S = 0.08\n",
        ball="",
        bar=text,
        air=f"[temperature]\nvalue = {20.0 + WARM_K}\nu = {U_K}\n[fixture]\nu = {FIXTURE_MM}\n",
    )
    found = ulna.verify(plan)
    worst = {figure.definition.key: figure.worst.single for figure in found.states[0].figures.values()}
    return {key: (worst[key].value_mm, worst[key].budget.u_mm) for key in KEYS}


def figure(e_mm: np.ndarray, key: str) -> np.ndarray:
    """(..., n) → (...,), by their formulas."""
    return 2.0 * e_mm.std(axis=-1, ddof=1) if key == KEYS[0] else 0.5 * np.ptp(e_mm, axis=-1)


def test_it_is_how_far_the_figures_scatter_with_the_bars_errors(tmp_path: Path) -> None:
    """By 40 000 tests of the same arm with other bars, temperatures and expansions."""
    rng = np.random.default_rng(3)
    e_mm = {"short": rng.normal(0.04, 0.01, 8), "long": rng.normal(-0.03, 0.02, 12)}
    found = bars(["short", "long"], e_mm, tmp_path)
    draws = 40_000
    t_k = rng.normal(0.0, U_K, draws)
    drawn = []
    for name, own in e_mm.items():
        error = rng.normal(0.0, U_MM[name], draws) + LENGTH_MM[name] * (
            EXPANSION * t_k + WARM_K * rng.normal(0.0, U_EXPANSION, draws)
        )
        drawn.append(own - error[:, None])
    everything, given = np.concatenate(drawn, axis=1), np.concatenate(list(e_mm.values()))
    for key, factor in zip(KEYS, (2.0, 1.0), strict=True):
        value, u = found[key]
        assert value == pytest.approx(float(figure(given, key)), abs=1e-9)
        expected = np.hypot(figure(everything, key).std(), factor * FIXTURE_MM)
        assert u == pytest.approx(float(expected), rel=0.03)
        assert u > 1.3 * factor * FIXTURE_MM


def test_one_bars_own_error_moves_the_mean_alone(tmp_path: Path) -> None:
    e_mm = {"long": np.random.default_rng(4).normal(-0.02, 0.03, 12)}
    found = bars(["long"], e_mm, tmp_path)
    assert [found[key][1] for key in KEYS] == pytest.approx([2.0 * FIXTURE_MM, FIXTURE_MM], rel=1e-12)
