"""U below a laboratory's capability (CMC) is lifted, and what is decided follows."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats
from tests.acceptance import write_plan

import ulna
from ulna.ground.digits import rounded, two_digits_up
from ulna.verification.conformity import Made, global_risk
from ulna.verification.decision import Limit
from ulna.verification.lifted import LIFTED, lifted
from ulna.verification.result_file import FigureTable, VerificationFile

PROCESS = "[process.L_Dia]\nmean = 0.03\ndeviation = 0.015\n"


def figures(file: VerificationFile) -> dict[str, FigureTable]:
    return {figure.key: figure for test in file.states[0].tests for figure in test.figures}


@pytest.fixture
def file(tmp_path: Path) -> VerificationFile:
    """u of L_Dia is 0.5 µm (fixture), of E_Uni 1.3 µm; P_Size is decided with 0.3 µm."""
    return ulna.verify(write_plan(tmp_path, more=PROCESS)).file()


def test_what_is_large_enough_stays_as_it_is(file: VerificationFile) -> None:
    same, told = lifted(file, {"L_Dia": Limit(0.001), "E_Uni": Limit(0.0001)})
    assert same is file
    assert told == []


def test_u_guard_verdict_and_risks_follow(file: VerificationFile) -> None:
    """L_Dia 50 µm of 60 µm: with U = 1 µm a pass, with the CMC of 14.05 → 15 µm (to two digits up: 15) it is not."""
    before = figures(file)["L_Dia"]
    made, told = lifted(file, {"L_Dia": Limit(0.01405)})
    after = figures(made)["L_Dia"]
    assert (before.verdict, before.expanded) == ("pass", 0.001)
    assert (after.verdict, after.expanded) == ("undecided", 0.015)
    assert after.guard == pytest.approx(1.65 * 0.0075)
    assert after.individual[0].u == after.u == 0.0075
    assert after.risk is not None
    assert before.risk is not None
    assert (
        after.risk.conformity
        == after.individual[0].conformity
        == pytest.approx(stats.norm.cdf(0.010 / 0.0075), rel=1e-6)
    )
    assert after.risk.of_all is not None
    expected = global_risk(Made(0.03, 0.015, "gamma"), 0.0075, 0.06, 1.65 * 0.0075)
    assert after.risk.of_all.consumer == pytest.approx(expected.consumer, rel=1e-12)
    assert [(each.key, each.values, each.computed_mm, each.stated_mm) for each in told] == [("L_Dia", 1, 0.001, 0.015)]
    squares = sum(part.u**2 for part in after.budget)
    assert after.budget[-1].name == LIFTED
    assert squares == pytest.approx(after.u**2, rel=1e-9)
    assert made.states[0].tests[1].verdict == "undecided"
    assert figures(file)["L_Dia"] == before, "what was read is not changed"


def test_a_limit_that_grows_is_that_of_each_length(tmp_path: Path) -> None:
    """CMC = 1 µm + L / 200000 = 4 µm at 600 mm."""
    file = ulna.verify(write_plan(tmp_path)).file()
    made, told = lifted(file, {"E_Uni": Limit(0.001, 200000.0)})
    assert [value.u for value in figures(made)["E_Uni"].individual] == [0.002, 0.002]
    assert told[0].values == 2


def test_a_pass_without_doubt_may_leave_the_whole_undecided(file: VerificationFile) -> None:
    assert file.verdict == "fail"
    made, _ = lifted(file, {key: Limit(1.0) for key in ("P_Size", "P_Form", "L_Dia", "E_Uni")})
    assert (made.verdict, made.states[0].verdict) == ("undecided", "undecided")
    assert {figure.verdict for figure in figures(made).values()} == {"undecided"}


def test_what_has_no_uncertainty_gets_none(tmp_path: Path) -> None:
    file = ulna.verify(write_plan(tmp_path, air="")).file()
    assert figures(file)["L_Dia"].u is None
    made, told = lifted(file, {"L_Dia": Limit(0.5)})
    assert figures(made)["L_Dia"].u is None
    assert told == []


@given(st.floats(1e-7, 1e3), st.floats(1e-7, 1e3))
def test_no_stated_u_is_below_the_capability(computed: float, capability: float) -> None:
    """Rounded to two digits as certificates do, U is never below the CMC."""
    bound = two_digits_up(capability)
    stated = max(computed, bound)
    assert float(rounded(0.0, stated, "mm")[1]) >= capability * (1.0 - 1e-11)
    assert bound <= 1.1000001 * capability


@pytest.mark.parametrize(
    ("value", "up"), [(0.00231, 0.0024), (0.0024, 0.0024), (0.0996, 0.10), (0.1 + 0.2, 0.30), (0.0, 0.0), (12.01, 13.0)]
)
def test_two_digits_up_by_hand(value: float, up: float) -> None:
    assert two_digits_up(value) == pytest.approx(up, rel=1e-12, abs=0.0)
