"""Temperatures that cannot be °C and expansions that cannot be 1/K are asked about, wherever they are said."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from tests.small_study import ARM

import ulna
from ulna.arm.arm import Arm
from ulna.ground.errors import UlnaInputError

GROWS = ARM.replace("d = 250.0\n", "d = 250.0\nexpansion = 11.5e-6\n")
Q = np.random.default_rng(1).uniform(-2, 2, (5, 3))


def arm(folder: Path, text: str = GROWS) -> Arm:
    (folder / "arm.toml").write_text(text)
    return Arm.load(folder / "arm.toml")


@pytest.mark.parametrize("wrong", [293.15, 200.01, -100.01, -300.0, 1e9])
def test_a_temperature_in_another_unit_is_asked_about(tmp_path: Path, wrong: float) -> None:
    of = arm(tmp_path)
    with pytest.raises(UlnaInputError, match=r"temperature: got .*expected °C.*kelvin"):
        of.tip(Q, "bent", temperature_c=wrong)
    said = np.full(5, 20.0)
    said[3] = wrong
    columns = {f"q{k + 1}": Q[:, k] for k in range(3)} | {"temperature": said}
    pl.DataFrame(columns).write_csv(tmp_path / "q.csv")
    with pytest.raises(UlnaInputError, match=r"q.csv: row 4 .*column 'temperature': got .*expected °C.*kelvin"):
        ulna.measure(of, tmp_path / "q.csv", probe="bent", out=tmp_path / "points.csv")
    assert not (tmp_path / "points.csv").exists()


@pytest.mark.parametrize(("said", "asked"), [([66.0, 70.5, 77.0], True), ([66.0, 20.0, 77.0], False), ([19.0], False)])
def test_temperatures_that_would_be_in_fahrenheit_are_asked_about(
    tmp_path: Path, said: list[float], asked: bool
) -> None:
    """Once, and they are taken as they stand."""
    many = np.resize(said, 5)
    columns = {f"q{k + 1}": Q[:, k] for k in range(3)} | {"temperature": many}
    pl.DataFrame(columns).write_csv(tmp_path / "q.csv")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        ulna.measure(arm(tmp_path), tmp_path / "q.csv", probe="bent", out=tmp_path / "points.csv")
    told = [str(each.message) for each in caught if "°F" in str(each.message)]
    assert len(told) == asked
    assert not asked or "q.csv: temperature: from 66 to 77. Are they in °F?" in told[0]
    points = pl.read_csv(tmp_path / "points.csv").select("x", "y", "z").to_numpy()
    np.testing.assert_allclose(points, arm(tmp_path).tip(Q, "bent", temperature_c=many), atol=1e-9)


@pytest.mark.parametrize("right", [-100.0, -20.0, 0.0, 68.0, 200.0])
def test_a_temperature_that_can_be_is_taken(tmp_path: Path, right: float) -> None:
    """a and d of the first link grow by the factor 1 + 11.5e-6 (T - 20)."""
    of = arm(tmp_path)
    factor = 1.0 + 11.5e-6 * (right - 20.0)
    grown = arm(
        tmp_path, ARM.replace("a = 40.0", f"a = {40.0 * factor!r}").replace("d = 250.0", f"d = {250.0 * factor!r}")
    )
    np.testing.assert_allclose(of.tip(Q, "bent", temperature_c=right), grown.tip(Q, "bent"), atol=1e-10)


@pytest.mark.parametrize("wrong", ["11.5", "-23", "0.02"])
def test_an_expansion_in_ppm_is_asked_about(tmp_path: Path, wrong: str) -> None:
    with pytest.raises(UlnaInputError, match=r"arm.toml: key 'joint.1.expansion': got .*ppm/K\? Multiply it by 1e-6"):
        arm(tmp_path, GROWS.replace("11.5e-6", wrong))
