"""`ulna verify` on touches whose figures are known to the last digit, and the laws that hold for all of it."""

from __future__ import annotations

import json
import math
import warnings
from pathlib import Path

import numpy as np
import polars as pl
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from tests.acceptance import iso_rows, write_plan
from tests.cli_runs import run
from tests.formats.test_schema import FOLDER, _known

import ulna
from ulna.ground.errors import InputWarning
from ulna.verification.decision import DecisionRule, Limit, worst_verdict
from ulna.verification.outcome import FigureResult
from ulna.verification.result_file import load_verification
from ulna.verification.verify import Verification


def figures(found: Verification, state: int = 0) -> dict[str, FigureResult]:
    return {figure.definition.key: figure for figure in found.states[state].figures.values()}


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Verification:
    return ulna.verify(write_plan(tmp_path_factory.mktemp("plan")))


def test_figures_by_hand(found: Verification) -> None:
    """D - 6 - 25: 31.01 → +10 µm, 30.98 → -20 µm, the worse one is reported; L - 600 = +20 and -30 µm."""
    values = {key: figure.worst.single.value_mm for key, figure in figures(found).items()}
    assert values == pytest.approx({"P_Size": -0.020, "P_Form": 0.0, "L_Dia": 0.050, "E_Uni": -0.030}, abs=1e-9)
    size = figures(found)["P_Size"]
    assert [each.single.value_mm for each in size.values] == pytest.approx([0.010, -0.020], abs=1e-9)
    assert size.worst.single.labels.position == "2"
    assert size.worst.single.measured_mm == pytest.approx(24.98)


def test_uncertainty_and_verdicts_by_hand(found: Verification) -> None:
    """Ball: u_cal 0.3 µm, temperature 25·5.5e-6·0.1 K = 0.01375 µm: u = 0.30032 µm; g = 1.65 u = 0.4955 µm; limit 18:
    20 > 18.4955: fails. Bar: 1 µm, 600·11.5e-6·0.1 = 0.69 µm, fixture 0.5 µm: u = 1.3141 µm, g = 2.168 µm; limit
    20 + 600/60 = 30 µm: 30 is between 27.83 and 32.17: undecided. L_Dia: u = 0.5 µm, 50 ≤ 60 - 0.825: passes."""
    by_key = figures(found)
    size, bar, dia = (by_key[key].worst for key in ("P_Size", "E_Uni", "L_Dia"))
    u_size = math.hypot(0.0003, 25 * 5.5e-6 * 0.1)
    assert size.single.budget.u_mm == pytest.approx(u_size, rel=1e-12)
    assert size.decided.guard_mm == pytest.approx(1.65 * u_size, rel=1e-12)
    assert bar.single.budget.u_mm == pytest.approx(math.sqrt(0.001**2 + 0.00069**2 + 0.0005**2), rel=1e-9)
    assert bar.limit_mm == pytest.approx(0.030, rel=1e-12)
    assert dia.single.budget.u_mm == pytest.approx(0.0005)
    verdicts = {key: figure.verdict for key, figure in by_key.items()}
    assert verdicts == {"P_Size": "fail", "P_Form": "pass", "L_Dia": "pass", "E_Uni": "undecided"}
    assert found.verdict == "fail"


def test_what_differs_from_the_profile_is_told(found: Verification) -> None:
    told = [text for test in found.states[0].tests for text in test.departures] + found.states[0].departures
    assert told == [
        "lengths: 1; the profile counts 5.",
        "positions of a length: 2 of bar; the profile counts 7 of each.",
        "repeats in a position: 1 of artefact bar, position 1, 1 of artefact bar, position 2; the profile counts 3 of "
        "each.",
        "test 'bi' (E_Bi) was not measured.",
    ]


def test_a_verdict_says_what_it_is_not_about(tmp_path: Path) -> None:
    done = run("verify", write_plan(tmp_path / "part"))
    assert "as-left FAIL (1 of the profile's tests not measured)." in " ".join(done.stdout.split())


def test_a_short_bar_and_an_unstated_range_are_told(tmp_path: Path) -> None:
    short = ulna.verify(write_plan(tmp_path / "short", keys="ball = 6.0\nrange = 2000.0\n"))
    assert "longest length: 600.0 mm, 30 % of the range; the profile asks for at least 66 %." in (
        short.states[0].tests[2].departures
    )
    unsaid = ulna.verify(write_plan(tmp_path / "unsaid", keys="ball = 6.0\n"))
    assert any("measuring range is not stated" in text for text in unsaid.states[0].tests[2].departures)


def test_the_json_fits_its_schema_and_loads(found: Verification, tmp_path: Path) -> None:
    found.save(tmp_path / "out")
    text = (tmp_path / "out" / "verification.json").read_text(encoding="utf-8")
    schema = json.loads((FOLDER / "ulna-verification-1.json").read_text(encoding="utf-8"))
    assert _known(schema, schema, json.loads(text), "") == []
    loaded, digest = load_verification(tmp_path / "out" / "verification.json")
    assert len(digest) == 64
    assert loaded.states[0].tests[0].figures[0].value == pytest.approx(-0.020, abs=1e-9)
    assert "in the manner of" in loaded.profile.statement
    table = pl.read_csv(tmp_path / "out" / "values.csv")
    assert len(table) == 2 + 2 + 1 + 2
    assert {path.name for path in (tmp_path / "out").iterdir()} == set(found.files)


def test_as_found_and_as_left_side_by_side(tmp_path: Path) -> None:
    better = iso_rows().with_columns(
        pl.when(pl.col("test") == "uni").then((pl.col("x") / 300).round() * 300).otherwise(pl.col("x")).alias("x")
    )
    better = better.filter(~((pl.col("test") == "probing") & (pl.col("position") == "2")))
    path = write_plan(
        tmp_path, readings='[[readings]]\nfile = "touches.csv"\nstate = "as-found"\n[[readings]]\nfile = "left.csv"\n'
    )
    better.write_csv(tmp_path / "left.csv")
    both = ulna.verify(path)
    assert [(state.state, state.verdict) for state in both.states] == [("as-found", "fail"), ("as-left", "pass")]
    assert figures(both, 1)["E_Uni"].worst.single.value_mm == pytest.approx(0.0, abs=1e-9)
    assert "positions of the ball: 1; the profile counts 2." in both.states[1].tests[0].departures


def test_no_limit_no_verdict(tmp_path: Path) -> None:
    silent = ulna.verify(write_plan(tmp_path, mpe=""))
    assert silent.verdict is None
    assert {figure.worst.decided.why for figure in figures(silent).values()} == {"no limit stated"}


def test_no_uncertainty_no_verdict_unless_acceptance_is_simple(tmp_path: Path) -> None:
    bare = ulna.verify(write_plan(tmp_path / "a", air=""))
    assert figures(bare)["L_Dia"].verdict is None
    assert figures(bare)["L_Dia"].worst.decided.why == "no uncertainty of the test value stated"
    assert "how still the artefact stands (fixture): not stated" in figures(bare)["L_Dia"].worst.single.budget.left_out
    simple = ulna.verify(write_plan(tmp_path / "b", air="", keys='ball = 6.0\nrule = "simple"\n'))
    assert figures(simple)["L_Dia"].verdict == "pass"
    assert figures(simple)["E_Uni"].verdict == "pass", "30 µm against 30 µm, no guard band"


def test_a_warm_bar_is_compared_with_its_warm_length(tmp_path: Path) -> None:
    """At 30 °C the bar is 600·11.5e-6·10 = 0.069 mm longer; u(α) adds 600·10·1e-6 = 6 µm."""
    warm = ulna.verify(write_plan(tmp_path, air="[temperature]\nvalue = 30.0\nu = 0.1\n[fixture]\nu = 0.0005\n"))
    single = figures(warm)["E_Uni"].values[0].single
    assert single.calibrated_mm == pytest.approx(600.069, abs=1e-9)
    assert single.value_mm == pytest.approx(0.020 - 0.069, abs=1e-9)
    assert {each.name: each.u_mm for each in single.budget.contributors}["expansion"] == pytest.approx(0.006)


LENGTHS = [
    ("ball", "6.0"),
    ("range", "900.0"),
    ("P_Size", "0.018"),
    ("P_Form", "0.03"),
    ("L_Dia", "0.06"),
    ("a", "0.020"),
    ("diameter", "25.0"),
    ("u", "0.0003"),
    ("form", "0.0004"),
    ("length", "600.0"),
    ("u", "0.001\n"),
    ("u", "0.0005"),
]


def test_inches_are_the_same_test(tmp_path: Path) -> None:
    table = iso_rows().with_columns(pl.col(axis) / 25.4 for axis in "xyz")
    text = write_plan(tmp_path).read_text(encoding="utf-8")
    for old, new in (
        ('length = "mm"', 'length = "in"'),
        *((f"{key} = {mm}", f"{key} = {float(mm) / 25.4!r}" + mm[len(mm.strip()) :]) for key, mm in LENGTHS),
    ):
        assert old in text
        text = text.replace(old, new)
    table.write_csv(tmp_path / "touches.csv")
    (tmp_path / "plan.toml").write_text(text, encoding="utf-8")
    inches, mm = ulna.verify(tmp_path / "plan.toml"), ulna.verify(write_plan(tmp_path / "mm"))
    for key, figure in figures(mm).items():
        own = figures(inches)[key].worst
        assert own.single.value_mm == pytest.approx(figure.worst.single.value_mm, abs=1e-9)
        assert own.limit_mm == pytest.approx(figure.worst.limit_mm)
        assert own.decided.verdict == figure.worst.decided.verdict
        assert own.decided.guard_mm == pytest.approx(figure.worst.decided.guard_mm)


@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    turn=st.tuples(*(st.floats(-3, 3) for _ in range(3))),
    shift=st.tuples(*(st.floats(-900, 900) for _ in range(3))),
    seed=st.integers(0, 2**30),
)
def test_rigid_motion_and_order_of_rows_change_nothing(
    found: Verification, tmp_path: Path, turn: tuple[float, ...], shift: tuple[float, ...], seed: int
) -> None:
    table = iso_rows()
    moved = table.select("x", "y", "z").to_numpy() @ Rotation.from_rotvec(turn).as_matrix().T + shift
    table = table.with_columns(pl.Series(axis, moved[:, k]) for k, axis in enumerate("xyz"))
    other = ulna.verify(write_plan(tmp_path, table.sample(fraction=1.0, shuffle=True, seed=seed)))
    for key, figure in figures(found).items():
        assert figures(other)[key].worst.single.value_mm == pytest.approx(figure.worst.single.value_mm, abs=1e-8)
        assert figures(other)[key].verdict == figure.verdict


def test_scaling_scales_the_lengths(tmp_path: Path, found: Verification) -> None:
    scaled = iso_rows().with_columns(pl.col(axis) * 1.0001 for axis in "xyz")
    error = figures(ulna.verify(write_plan(tmp_path, scaled)))["E_Uni"].values[0].single.value_mm
    assert error == pytest.approx(600.020 * 1.0001 - 600.0, abs=1e-9)


@pytest.mark.parametrize(
    ("rule", "value", "verdict"),
    [
        ("1.65u", 0.0165, "pass"),
        ("1.65u", -0.0168, "undecided"),
        ("1.65u", 0.0232, "undecided"),
        ("1.65u", -0.0234, "fail"),
        ("U", 0.0159, "pass"),
        ("U", 0.0161, "undecided"),
        ("U", 0.0239, "undecided"),
        ("U", 0.0241, "fail"),
        ("simple", 0.0200, "pass"),
        ("simple", 0.0201, "fail"),
    ],
)
def test_decisions_by_hand(rule: str, value: float, verdict: str) -> None:
    """MPE 20 µm, u = 2 µm: g = 3.3 µm, 4 µm (k = 2), 0."""
    decided = DecisionRule(rule, 2.0, 0.95).decide(value, 0.020, 0.002)  # type: ignore[arg-type]
    assert decided.verdict == verdict


@given(value=st.floats(-1, 1), limit=st.floats(0, 0.5), u=st.floats(0, 0.2), more=st.floats(0, 0.2))
def test_more_uncertainty_never_decides_more(value: float, limit: float, u: float, more: float) -> None:
    rule = DecisionRule("1.65u", 2.0, 0.95)
    sure, unsure = rule.decide(value, limit, u).verdict, rule.decide(value, limit, u + more).verdict
    assert unsure in (sure, "undecided")
    assert rule.decide(-value, limit, u).verdict == sure


def test_limits_and_the_worst_of_several() -> None:
    assert Limit(0.02, 40000.0).at_mm(1000.0) == pytest.approx(0.045)
    assert Limit(0.02).at_mm(1000.0) == 0.02
    assert worst_verdict(["pass", None, "undecided"]) == "undecided"
    assert worst_verdict([None, None]) is None


def test_rows_read_twice_are_remarked_upon(tmp_path: Path) -> None:
    table = iso_rows()
    path = write_plan(tmp_path, pl.concat([table, table[:2]]))
    with pytest.warns(InputWarning, match="2 rows repeat another one to the last digit"):
        ulna.verify(path)


def test_nothing_is_remarked_upon_without_need(tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert np.isfinite(figures(ulna.verify(write_plan(tmp_path)))["L_Dia"].worst.single.value_mm)
