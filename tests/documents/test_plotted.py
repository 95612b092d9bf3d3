"""`Result.plot`: the report's drawings on axes, with the numbers that they should show."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.container import BarContainer, ErrorbarContainer
from matplotlib.quiver import Quiver

import ulna
from ulna.calibration.plots import Plots
from ulna.documents.plotted import ResultPlots

PLATINUM = Path(__file__).resolve().parents[2] / "examples" / "platinum"


@pytest.fixture(scope="module")
def result() -> ulna.Result:
    return ulna.calibrate(PLATINUM / "study.toml")


@pytest.fixture(autouse=True)
def _closed() -> Iterator[None]:
    yield
    plt.close("all")


ALL: dict[str, dict[str, Any]] = {
    "residuals": {},
    "quantiles": {},
    "parameters": {},
    "before_after": {},
    "lengths": {},
    "joint": {"joint": 3},
    "reach": {},
    "arm": {},
    "map": {"view": "xz"},
}


def test_every_drawing_that_is_promised_is_tried() -> None:
    promised = set(Plots.__abstractmethods__) - {"of"}
    assert promised == set(ALL)
    assert not ResultPlots.__abstractmethods__


@pytest.mark.parametrize(("name", "more"), ALL.items(), ids=ALL)
def test_axes_come_back_named_and_on_those_that_were_given(
    result: ulna.Result, name: str, more: dict[str, Any]
) -> None:
    axes = getattr(result.plot, name)(**more)
    assert isinstance(axes, Axes)
    assert axes.get_xlabel() or name == "arm"
    own = plt.figure().subplots()
    assert getattr(result.plot, name)(**more, ax=own) is own
    assert own.has_data()


def test_the_histogram_is_of_the_length_errors(result: ulna.Result) -> None:
    axes = result.plot.residuals("bar")
    (bars,) = (each for each in axes.containers if isinstance(each, BarContainer))
    errors = np.array([entry.figures["length_error_mean_mm"] for entry in result.artefacts])
    edges = np.array([bar.get_x() for bar in bars] + [bars[-1].get_x() + bars[-1].get_width()])
    counts, _ = np.histogram(errors, edges)
    assert [bar.get_height() for bar in bars] == counts.tolist()
    assert sum(counts) >= len(errors) - 1  # an edge may have been rounded


def test_the_ratios_are_moves_in_units_of_u(result: ulna.Result) -> None:
    axes = result.plot.parameters()
    dots = next(line for line in axes.lines if line.get_marker() == "o")
    expected = [(row.value - row.start) / row.u for row in result.parameters if row.u]
    np.testing.assert_allclose(dots.get_xdata(), expected)
    assert [label.get_text().split()[0] for label in axes.get_yticklabels()] == [
        row.name for row in result.parameters if row.u
    ]


def test_arrows_stand_at_the_tips_and_point_along_the_residuals(result: ulna.Result) -> None:
    axes = result.plot.map("yz")
    (arrows,) = (each for each in axes.collections if isinstance(each, Quiver))
    assert result.study is not None
    tips = result.arm.tip(result.study.readings[0].q_rad)
    np.testing.assert_allclose(arrows.XY, tips[:, 1:], rtol=0, atol=1e-9)
    residuals = result.residuals.select("y_mm", "z_mm").to_numpy()
    factor = float(axes.get_title().split("× ")[1])
    np.testing.assert_allclose(np.stack([arrows.U, arrows.V], axis=1), factor * residuals, rtol=1e-12)


def test_over_a_joint_stand_all_readings_at_its_angle(result: ulna.Result) -> None:
    axes = result.plot.joint(2)
    assert result.study is not None
    x = np.degrees(result.study.readings[0].q_rad[:, 1])
    shown = np.concatenate(
        [np.asarray(line.get_xdata()) for line in axes.lines if line.get_marker() in (".", "x", "^", "v")]
    )
    np.testing.assert_allclose(np.sort(shown), np.sort(x))
    assert any(isinstance(each, ErrorbarContainer) for each in axes.containers)
    assert axes.get_legend() is not None


def test_of_a_result_from_a_file_the_study_is_asked_for(result: ulna.Result, tmp_path: Path) -> None:
    result.save(tmp_path)
    again = ulna.Result.load(tmp_path)
    for name in ("residuals", "quantiles", "parameters", "before_after", "arm"):
        getattr(again.plot, name)()
    for name in ("lengths", "joint", "reach", "map"):
        with pytest.raises(ulna.UlnaInputError, match=r"result\.plot\.of\('.*study\.toml'\)"):
            getattr(again.plot, name)(**({"joint": 1} if name == "joint" else {}))
    told = again.plot.of(PLATINUM / "study.toml").map().get_title()
    assert told == result.plot.map().get_title()
    with pytest.raises(ulna.UlnaInputError, match="was not made from it"):
        again.plot.of(PLATINUM / "check.toml")


def test_what_cannot_be_drawn_is_told(result: ulna.Result) -> None:
    with pytest.raises(ulna.UlnaInputError, match="Did you mean 'bar'"):
        result.plot.residuals("bars")
    with pytest.raises(ulna.UlnaInputError, match="expected 1 to 7"):
        result.plot.joint(8)
    with pytest.raises(ulna.UlnaInputError, match="expected xy, xz or yz"):
        result.plot.map("top")  # type: ignore[arg-type]


def test_nothing_of_matplotlib_is_loaded_before_the_first_drawing() -> None:
    code = (
        "import sys, ulna\n"
        f"result = ulna.calibrate({str(PLATINUM / 'study.toml')!r})\n"
        "repr(result), result._repr_html_()\n"
        "assert 'matplotlib' not in sys.modules\n"
        "result.plot.residuals()\n"
        "assert 'matplotlib' in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, timeout=120)
