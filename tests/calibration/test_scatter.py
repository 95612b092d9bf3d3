"""How many readings are left to tell the scatter, and what places left out say: against the hat matrix written out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import ulna
import ulna._core as _core
from ulna.calibration.between_places import _factor
from ulna.calibration.running import run_assembled
from ulna.study.assembly import assemble

PLATINUM = Path(__file__).parents[2] / "examples" / "platinum" / "study.toml"
PRIOR = {"joint.*": 0.01, "probe.*": 5.0}


def fitted(stated: bool, scale: float, **fit: object) -> tuple[_core.Fitted, np.ndarray, np.ndarray]:
    """A fit with priors `scale` times PRIOR; rows of its readings and their residuals."""
    study = ulna.Study.load(PLATINUM)
    prior = {name: ulna.Prior(u * scale) for name, u in PRIOR.items()}
    study = replace(study, noise=study.noise if stated else None, fit=replace(study.fit, prior=prior, **fit))  # type: ignore[arg-type]
    assembled = assemble(study)
    core = run_assembled(study, assembled)
    rows, residuals, _ = _core.rows_of_fit(assembled.problem, assembled.hold, core)
    return core, rows, residuals


@pytest.mark.parametrize("stated", [True, False])
@pytest.mark.parametrize("scale", [1e-3, 1e-2, 1.0, 1e3])
def test_degrees_of_freedom_are_equations_less_the_trace_of_the_hat_matrix(stated: bool, scale: float) -> None:
    core, rows, residuals = fitted(stated, scale)
    unit = np.sqrt(core.variance)
    weight = np.where(np.isfinite(core.priors[:, 1]), unit / core.priors[:, 1], 0.0)
    # scaled: lengths in mm beside angles in rad
    size = np.linalg.norm(rows, axis=0) + weight
    size[size == 0.0] = 1.0
    normal = (rows / size).T @ (rows / size) + np.diag((weight / size) ** 2)
    hat = (rows / size) @ np.linalg.pinv(normal, rcond=1e-13, hermitian=True) @ (rows / size).T
    assert core.degrees_of_freedom == pytest.approx(len(rows) - np.trace(hat), abs=2e-3)
    if not stated:
        assert core.variance == pytest.approx(residuals @ residuals / core.degrees_of_freedom, rel=1e-4)
    elif core.estimated:
        assert core.variance == pytest.approx(core.chi2_per_dof, rel=1e-9)
    else:
        assert core.variance == 1.0


def test_a_prior_that_says_all_leaves_all_equations_and_one_that_says_nothing_none_of_its_own() -> None:
    free = ulna.calibrate(PLATINUM).fit
    tight, loose = fitted(True, 1e-9)[0], fitted(True, 1e6)[0]
    equations = free.observations - free.placement_unknowns
    assert tight.degrees_of_freedom == pytest.approx(equations, abs=0.1)
    assert loose.degrees_of_freedom == pytest.approx(free.degrees_of_freedom, abs=0.1)


@pytest.mark.parametrize("g", [1.0, 3.0])
def test_the_factor_between_places_is_found(g: float) -> None:
    rng = np.random.default_rng(4)
    ratio = np.exp(rng.uniform(-4.0, 1.0, 400))
    square = (1.0 + g * g * ratio) * rng.standard_normal(400) ** 2
    assert _factor(ratio, square) == pytest.approx(g, rel=0.15)


def test_chance_is_taken_for_a_factor_once_in_a_hundred() -> None:
    rng = np.random.default_rng(5)
    ratio = np.exp(rng.uniform(-4.0, 1.0, 200))
    found = [_factor(ratio, (1.0 + ratio) * rng.standard_normal(200) ** 2) for _ in range(400)]
    assert np.mean(np.array(found) > 1.0) < 0.02
