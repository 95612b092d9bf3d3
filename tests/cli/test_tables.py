"""The tables: sensible digits, and nothing wrapped or cut at 80 and 120 columns."""

from __future__ import annotations

import dataclasses
import io
import itertools
from typing import Any

import numpy as np
import polars as pl
import pytest
from rich.console import Console

from ulna.arm.arm import Arm
from ulna.arm.covariance import ParameterCovariance
from ulna.arm.directions import combination
from ulna.arm.joint import Joint
from ulna.arm.probe import Probe
from ulna.arm.probes import probe_views
from ulna.artefacts.quantities import NAMES
from ulna.calibration.cross_validate import CrossValidation, GroupFigures
from ulna.calibration.extras import JudgedExtra
from ulna.calibration.identify import Identification
from ulna.calibration.placements import PlacementFigures
from ulna.calibration.result import Result
from ulna.calibration.summary import FitSummary, Parameter
from ulna.cli import output
from ulna.cli.printed.calibration import calibration_report, equations
from ulna.cli.printed.cross_validation import cross_validation_report
from ulna.cli.printed.figures import per_placement
from ulna.cli.printed.identification import determined_in_words
from ulna.cli.printed.tables import table
from ulna.ground.digits import decimals, figure_mm, fixed, quantity, uncertainty


def parameter(name: str, unit: str, value: float, u: float | None, status: str = "fitted") -> Parameter:
    return Parameter(name, unit, value + 0.1, value, u, status)


LOST: dict[str, Any] = {
    "combination": {"joint.6.d": 1.0, "probe.straight-long.z": -1.0, "joint.6.theta0": -0.002},
    "cause": "probe-on-axis",
    "because": "The tip lies on the last axis.",
    "remedy": "Measure with a probe at least 10 mm off the last axis.",
    "frame": False,
}


def result() -> Result:
    probes = {"bent": Probe(35.8, -16.5, 223.8773), "straight-long": Probe(0.0, 0.0, 238.5596)}
    joints = tuple(Joint(0.1, -1.57, 40.0, 250.0) for _ in range(6))
    arm = Arm("virtual Platinum", (*joints, Joint()), probes)
    rows = []
    for k in range(1, 7):
        rows += [
            parameter(f"joint.{k}.theta0", "rad", -2.2689123, 3.1e-6),
            parameter(f"joint.{k}.alpha", "rad", -1.5707963, 2.4e-5),
            parameter(f"joint.{k}.a", "mm", -1042.47543, 0.0031),
            parameter(f"joint.{k}.d", "mm", 1450.123456, None, "not-determined"),
        ]
    for name, axis in itertools.product(probes, "xyz"):
        rows.append(parameter(f"probe.{name}.{axis}", "mm", 123.456789, None, "held"))
    names = [row.name for row in rows if row.u is not None]
    covariance = ParameterCovariance(names, np.eye(len(names)), [LOST])
    found = Identification(24, 18, names, [1.0], 0.01, ["joint.1.d"], [LOST], [])
    fit = FitSummary("converged-cost", True, 5, 7, 1e6, 101.2, 12.3, 0.0125, 101, 303, 101, 76, 1.02, 0, "", [])
    figures = dict.fromkeys(NAMES, 0.0123)
    before = dict.fromkeys(NAMES, 123.4567)
    return Result(arm, rows, covariance, found, fit, pl.DataFrame(), [], before, figures, {})


def shown(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, width: int, parts: list[Any]) -> str:
    monkeypatch.setenv("COLUMNS", str(width))
    output.print_renderable(*parts)
    return capsys.readouterr().out


@pytest.mark.parametrize("width", [80, 120])
def test_a_calibration_fits_the_terminal_with_every_row_whole(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, width: int
) -> None:
    text = shown(capsys, monkeypatch, width, calibration_report(result()))
    lines = text.splitlines()
    assert max(len(line) for line in lines) <= width
    assert "…" not in text
    for row in result().parameters:
        (line,) = [line for line in lines if line.startswith(row.name + " ") and row.status in line]
        assert len(line.split()) == 6
    assert any(
        line.split() == ["joint.1.theta0", "-2.1689123", "-2.2689123", "0.0000031", "rad", "fitted"] for line in lines
    )
    assert any(line.split() == ["joint.1.a", "-1042.3754", "-1042.4754", "0.0031", "mm", "fitted"] for line in lines)


def beyond_geometry() -> Result:
    """The same with effects, their priors, a verdict, and readings far off."""
    plain = result()
    rows = list(plain.parameters)
    for k in range(1, 8):
        prior = {"value": 0.0, "u": 0.0005}
        rows += [
            dataclasses.replace(parameter(f"joint.{k}.c1", "rad", -0.000123, 3.1e-6), prior=prior),
            dataclasses.replace(parameter(f"joint.{k}.expansion", "1/K", 1.153e-5, None, "not-determined"), prior=None),
            parameter(f"joint.{k}.compliance", "rad/(N m)", -1.234e-6, 1.2e-8),
        ]
    rows.append(parameter("artefact.ball.diameter", "mm", 50.00123, 0.0004))
    extras = [
        JudgedExtra(
            "encoder-harmonics", "seat_scatter_mean_mm", 0.7828, 0.5287, 0.2541, 0.052, 3, "placement", "earned"
        ),
        JudgedExtra("compliance", "seat_scatter_mean_mm", 0.5, 0.51, -0.01, None, 3, "placement", "undecided"),
    ]
    far = [
        {"row": 17 + k, "file": "readings.csv", "artefact": "tool", "placement": "back-high", "feature": "B"}
        | {"probe": "ball", "norm_mm": 1.43981, "times_scatter": 7.312, "counted": 0.2234}
        for k in range(12)
    ]
    found = dataclasses.replace(plain.identifiability, from_prior=[f"joint.{k}.c1" for k in range(1, 8)])
    fit = dataclasses.replace(
        plain.fit,
        loss="huber",
        method="annealing",
        box_evaluations=100_000,
        undecided_signs=[[2], [1, 3, 5, 7]],
        mirrored_signs=[[1, 3, 5, 7]],
    )
    return dataclasses.replace(plain, parameters=rows, extras=extras, outliers=far, identifiability=found, fit=fit)


@pytest.mark.parametrize("width", [80, 120])
def test_what_goes_beyond_geometry_fits_the_terminal(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, width: int
) -> None:
    text = shown(capsys, monkeypatch, width, calibration_report(beyond_geometry()))
    lines = [line.rstrip() for line in text.splitlines()]
    assert max(len(line) for line in lines) <= width
    assert "…" not in text
    (line,) = [line for line in lines if line.startswith("joint.7.expansion ")]
    assert line.split() == ["joint.7.expansion", "1.15e-5", "–", "–", "1/K", "not-determined"]
    (line,) = [line for line in lines if line.startswith("joint.3.c1 ")]
    assert line.split() == ["joint.3.c1", "-0.0001230", "3.1e-6", "0.00050", "rad", "fitted"]
    words = " ".join(text.split())
    assert "x, y and z may be mirror-imaged" in words
    assert "its mirror image, in which joints 1, 3, 5 and 7 count the other way" in words
    assert "To decide, turn joint 1, 3, 5 or 7 counter-clockwise" in words
    assert "The same arm, written differently: joint 2 counts the other way." in words
    assert "simulated annealing of the box around the arm file (100000 evaluations)" in words
    assert "Far off the rest: 12 of 101 readings" in words
    assert (
        "row 17 of readings.csv (tool, placement back-high, B): 1.4398 mm, 7.31 times the scatter, counted 0.22"
        in words
    )
    assert "The other 2 are in result.json" in words
    assert "encoder-harmonics 0.7828 0.5287 0.2541 0.052 earned its place" in words
    assert "compliance 0.5000 0.5100 -0.0100 – cannot be told" in words
    assert "joint.1.c1, joint.2.c1" in words


def test_a_table_wider_than_the_terminal_runs_over_instead_of_being_cut(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    entry = PlacementFigures(
        "a-very-long-name-of-an-artefact", "left-back-corner-high", "points", 12, dict.fromkeys(NAMES, 1.0)
    )
    text = shown(capsys, monkeypatch, 60, per_placement([entry, entry], "elsewhere"))
    assert text.count("a-very-long-name-of-an-artefact") == 2
    assert text.count("left-back-corner-high") == 2
    assert "…" not in text


@pytest.mark.parametrize("width", [80, 120])
def test_a_cross_validation_fits_the_terminal(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, width: int
) -> None:
    figures = dict.fromkeys(NAMES, 1.2345)
    groups = [GroupFigures(f"front_{k}", 120, figures, figures, k != 2, "converged-cost", [LOST]) for k in range(8)]
    found = CrossValidation("placement", groups, figures, figures, {})
    text = shown(capsys, monkeypatch, width, cross_validation_report(found))
    assert max(len(line) for line in text.splitlines()) <= width
    assert "front_2 (!)" in text
    assert "probe at least 10 mm off the last axis" in " ".join(text.split())


def test_a_line_break_in_a_name_moves_no_other_cell() -> None:
    console = Console(file=io.StringIO(), width=80)
    console.print(table("", ["name", "mm"], [["a\nb", "1.5"], ["", ""], [":art:", "2.5"]]))
    lines = [line.split() for line in console.file.getvalue().splitlines()]  # type: ignore[attr-defined]
    assert lines[-3:] == [["a", "b", "1.5"], [], [":art:", "2.5"]]


def test_names_are_never_markup() -> None:
    console = Console(file=io.StringIO(), width=80)
    console.print(*per_placement([PlacementFigures("[red]x", "[1]", "seat", 1, {})], ""))
    assert "[red]x" in console.file.getvalue()  # type: ignore[attr-defined]
    assert "[1]" in console.file.getvalue()  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("u", "unit", "expected"),
    [
        (0.0031, "mm", 4),
        (0.012, "mm", 3),
        (2.5, "mm", 1),
        (250.0, "mm", 0),
        (3.1e-6, "rad", 7),
        (1e-14, "rad", 9),
        (None, "mm", 4),
    ],
)
def test_two_digits_of_the_uncertainty_are_shown(u: float | None, unit: str, expected: int) -> None:
    assert decimals(u, unit) == expected


def test_tiny_units_in_powers_of_ten() -> None:
    assert quantity(-1.2345e-6, 1.2e-8, "rad/(N m)") == "-1.234e-6"
    assert quantity(1.153e-5, 2e-6, "1/K") == "1.15e-5"
    assert quantity(1.153e-5, None, "1/K") == "1.15e-5"
    assert quantity(1e-9, 2e-6, "1/K") == "1e-9"
    assert quantity(0.0, 2e-6, "1/K") == "0"
    assert quantity(12.34567, 0.012, "mm") == "12.346"


def test_numbers_as_text() -> None:
    assert [uncertainty(u) for u in (None, 0.0, 0.0031, 2.5, 250.0, 3.14e-6)] == [
        "–",
        "0",
        "0.0031",
        "2.5",
        "250",
        "3.1e-6",
    ]
    assert [figure_mm(x) for x in (0.0, 0.28849, 1.2e-10, -0.5)] == ["0.0000", "0.2885", "1.2e-10", "-0.5000"]
    assert fixed(-1e-12, 4) == "0.0000"


def test_a_combination_in_words() -> None:
    assert combination({"joint.1.d": 1.0}) == "joint.1.d"
    assert combination(LOST["combination"]) == (
        "together: joint.6.d +1 mm, probe.straight-long.z −1 mm, joint.6.theta0 −0.002 rad"
    )


def test_two_digits_are_those_after_rounding() -> None:
    assert [uncertainty(u) for u in (0.0996, 0.996, 9.96, 0.0994, 0.000999)] == ["0.10", "1.0", "10", "0.099", "0.0010"]
    assert [decimals(u, "mm") for u in (0.0996, 0.0994)] == [2, 3]


def test_the_cylindrical_view_and_its_uncertainty() -> None:
    """x = r cos theta0, y = -r sin theta0: propagated, against a Monte Carlo draw."""
    rng = np.random.default_rng(0)
    arm = Arm("arm", (Joint(), Joint()), {"bent": Probe.from_cylindrical(0.43, 39.4, 223.9)})
    names = [f"probe.bent.{axis}" for axis in "xyz"]
    root = rng.normal(0, 0.01, (3, 3))
    covariance = ParameterCovariance(names, root @ root.T, [])
    (view,) = probe_views(arm, dict.fromkeys(names, "fitted"), covariance)
    tips = arm.probes["bent"].tip_mm + rng.multivariate_normal(np.zeros(3), covariance.matrix, 200_000)
    assert (view.theta0_rad, view.r_mm, view.h_mm) == pytest.approx((0.43, 39.4, 223.9))
    assert view.u_r_mm == pytest.approx(np.hypot(tips[:, 0], tips[:, 1]).std(), rel=0.01)
    assert view.u_theta0_rad == pytest.approx(np.arctan2(-tips[:, 1], tips[:, 0]).std(), rel=0.01)
    assert view.u_h_mm == pytest.approx(tips[:, 2].std(), rel=0.01)


def test_on_the_axis_the_cylindrical_angle_is_undefined() -> None:
    arm = Arm("arm", (Joint(), Joint()), {"straight": Probe(0.0, 0.0, 200.0)})
    names = [f"probe.straight.{axis}" for axis in "xyz"]
    (view,) = probe_views(arm, dict.fromkeys(names, "fitted"), ParameterCovariance(names, np.eye(3), []))
    assert view.on_axis
    assert view.as_dict() | {"theta0_rad": None, "u_theta0_rad": None, "u_r_mm": None} == view.as_dict()
    assert view.u_h_mm == pytest.approx(1.0)


@pytest.mark.parametrize(("lost", "words"), [(1, "1 combination is lost"), (11, "11 combinations are lost")])
def test_one_is_singular_and_eleven_are_not(lost: int, words: str) -> None:
    found = dataclasses.replace(result().identifiability, parameters=24, determined=24 - lost)
    assert words in determined_in_words(found)


@pytest.mark.parametrize(("degrees", "words"), [(1, " 1 degree of freedom"), (11, " 11 degrees of freedom")])
def test_degrees_of_freedom_are_counted(degrees: int, words: str) -> None:
    assert words in equations(dataclasses.replace(result().fit, degrees_of_freedom=degrees))
