"""The picture of a comparison: what it marks is what the comparison says."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from matplotlib import pyplot as plt
from tests.cli_runs import assert_bad_input, run, write_lengths
from tests.reports import calibrated

import ulna
from ulna.comparison.compare import Comparison, Moved
from ulna.documents.drawn import comparison as drawn
from ulna.ground.style import BLUE, GREY


def say(key: str, **values: object) -> str:
    return f"{key} {' '.join(str(value[0]) for value in values.values() if isinstance(value, tuple))}"


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("compared")
    noise = "[noise]\nencoder = 5e-6\nseat = 0.01"
    one, other = (
        calibrated(write_lengths(folder / name, rows=rows, noise=noise)) for name, rows in (("a", 60), ("b", 90))
    )
    return one, other


@pytest.fixture(scope="module")
def found(results: tuple[Path, Path]) -> Comparison:
    return ulna.compare(*results)


def test_a_dot_for_each_length_and_the_largest_in_the_circle(found: Comparison) -> None:
    (step,) = found.steps
    assert step.largest is not None
    assert len(step.changes.change_mm) == sum(band.count for band in step.bands)
    at = int(np.abs(step.changes.change_mm).argmax())
    assert step.changes.change_mm[at] == step.largest.largest_mm
    for view, columns in ((("x", "y"), (0, 1)), (("x", "z"), (0, 2))):
        axes = plt.figure().subplots()
        shown = drawn.changes(axes, step, view, say)
        assert len(shown.get_offsets()) == len(step.changes.change_mm)
        (circle,) = axes.lines
        middle = np.array(step.largest.at_mm)[list(columns)]
        np.testing.assert_allclose(np.ravel(circle.get_xydata()), middle)
        np.testing.assert_allclose(np.asarray(shown.get_offsets())[-1], middle)
        assert shown.get_clim() == (-abs(step.largest.largest_mm), abs(step.largest.largest_mm))
    plt.close("all")


def test_bars_have_their_u_and_those_beyond_it_are_blue() -> None:
    axes = plt.figure().subplots()
    rows = [Moved("joint.1.a", "mm", -0.5, 0.1), Moved("$x$", "mm", 0.1, 0.1)]
    drawn.parameters(axes, rows, "mm", 2.0, say)
    assert [patch.get_width() for patch in axes.patches] == [-0.5, 0.1]
    colours = [plt.matplotlib.colors.to_hex(patch.get_facecolor()) for patch in axes.patches]
    assert colours == [BLUE.lower(), GREY]
    (segments,) = (each.get_segments() for each in axes.collections)
    np.testing.assert_allclose([segment[:, 0] for segment in segments], [[-0.7, -0.3], [-0.1, 0.3]])
    assert [label.get_text() for label in axes.get_yticklabels()] == ["joint.1.a", "$x$"]
    plt.close("all")


def test_what_nobody_determined_is_an_empty_picture(found: Comparison) -> None:
    (step,) = found.steps
    none = dataclasses.replace(step.changes, middle_mm=np.zeros((0, 3)), change_mm=np.zeros(0))
    nothing = Comparison([dataclasses.replace(step, changes=none, bands=[], parameters=[])])
    assert drawn.drawn(nothing, "svg").startswith(b"<?xml")


@pytest.mark.parametrize(("ending", "begin"), [("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")])
def test_the_command_writes_it(results: tuple[Path, Path], tmp_path: Path, ending: str, begin: bytes) -> None:
    out = tmp_path / f"moved.{ending}"
    done = run("compare", *results, "--picture", out)
    assert done.returncode in (0, 1), done.stderr
    first = out.read_bytes()
    assert first.startswith(begin)
    assert_bad_input(run("compare", *results, "--picture", out), f"{out}: exists already", "--force")
    run("compare", *results, results[0], "--picture", tmp_path / f"more.{ending}")
    assert run("compare", *results, "--picture", out, "--force", "--json").returncode in (0, 1)
    assert out.read_bytes() == first, "the same numbers make the same file"


def test_an_ending_that_cannot_be_drawn_is_refused(results: tuple[Path, Path], tmp_path: Path) -> None:
    assert_bad_input(
        run("compare", *results, "--picture", tmp_path / "a.gif"), "a.gif ends in .gif", ".png, .svg or .pdf"
    )
