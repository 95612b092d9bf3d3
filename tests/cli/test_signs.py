"""What is not told of signs takes a line each: of the mirror image, and of the same arm written differently."""

from __future__ import annotations

import dataclasses
import io

import polars as pl
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rich.console import Console
from tests.cli.test_tables import beyond_geometry

from ulna.calibration.summary import FitSummary
from ulna.cli.printed.brief import brief_report
from ulna.cli.printed.signs import decide, signs_in_full, signs_in_lines

FIT = FitSummary("converged-cost", True, 3, 4, 1.0, 0.1, 1.0, 0.1, 101, 101, 0, 76)

joints = st.sets(st.integers(1, 12), min_size=1).map(sorted)
sets = st.lists(joints, max_size=40, unique_by=tuple)


def fit_of(undecided: list[list[int]], mirrored: int) -> FitSummary:
    return dataclasses.replace(FIT, undecided_signs=undecided, mirrored_signs=undecided[:mirrored])


def printed(parts: list[object], width: int) -> list[str]:
    shown = io.StringIO()
    Console(file=shown, width=width, color_system=None).print(*parts, sep="\n")
    return shown.getvalue().splitlines() if parts else []


@settings(max_examples=200, deadline=None)
@given(sets, st.integers(0, 40), st.integers(60, 120))
def test_any_sets_take_a_line_each(undecided: list[list[int]], mirrored: int, width: int) -> None:
    fit = fit_of(undecided, mirrored)
    lines = printed(signs_in_lines(fit, width), width)
    mirror = [line for line in lines if line.startswith("x, y, z may be mirror-imaged")]
    same = [line for line in lines if line.startswith("The same arm, written")]
    assert len(mirror) == bool(fit.mirrored_signs)
    assert len(same) == (len(undecided) > len(fit.mirrored_signs))
    assert len(lines) == len(mirror) + len(same)
    assert max(map(len, lines), default=0) <= width


@settings(max_examples=200, deadline=None)
@given(sets.filter(bool), st.integers(1, 40))
def test_a_joint_decides_where_its_sign_leaves_one_of_the_two(undecided: list[list[int]], mirrored: int) -> None:
    """Its sign is that of the arm found in every way to write it, and the other in every mirror image."""
    fit = fit_of(undecided, mirrored)
    images = [set(own) for own in fit.mirrored_signs]
    others = [set(own) for own in undecided[mirrored:]]
    telling = [k for k in range(1, 13) if all(k in own for own in images) and not any(k in own for own in others)]
    assert decide(fit) == (telling or sorted(set().union(*images)))


@pytest.mark.parametrize(
    ("width", "expected"), [(60, "(joint 1, 3, 5 or 7: --all)"), (80, "joint 1, 3, 5 or 7 decides")]
)
def test_the_joints_that_decide_are_named_on_any_terminal(width: int, expected: str) -> None:
    (line,) = printed(signs_in_lines(fit_of([[1, 3, 5, 7]], 1), width), width)
    assert expected in line
    assert "--all" in line


def test_all_of_it_names_each_set_and_says_how_to_decide() -> None:
    fit = fit_of([[1, 3, 5, 7], [1, 3, 5], [2], [4], [2, 4]], 2)
    text = " ".join(" ".join(printed(signs_in_full(fit), 80)).split())
    assert "joints 1, 3, 5 and 7, or joints 1, 3 and 5 count the other way" in text
    assert "To decide, turn joint 1, 3 or 5 counter-clockwise" in text
    assert "joint 2, or joint 4, or joints 2 and 4 count the other way" in text


def test_a_fit_that_ended_badly_says_nothing_of_signs() -> None:
    """They are those of an arm that was not found."""
    result = dataclasses.replace(beyond_geometry(), residuals=pl.DataFrame(schema={"norm_mm": pl.Float64}))
    for converged in (True, False):
        fit = dataclasses.replace(result.fit, converged=converged)
        text = "\n".join(printed(brief_report(dataclasses.replace(result, fit=fit), 80), 80))
        assert ("mirror-imaged" in text) is converged
