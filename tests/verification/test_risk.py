"""What decisions risk, as an acceptance test states it: of each value, of the rule, of all that are made."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest
from scipy import stats
from tests.acceptance import write_plan
from tests.cli_runs import assert_bad_input, run

import ulna
from ulna.ground.digits import percent
from ulna.ground.errors import UlnaInputError
from ulna.verification.conformity import Made, global_risk
from ulna.verification.decision import DecisionRule
from ulna.verification.figures import asme_b89_4_22, faro, iso_10360_12
from ulna.verification.figures.figure import Definition

PROCESS = "[process.E_Uni]\nmean = 0.002\ndeviation = 0.012\n[process.L_Dia]\nmean = 0.03\ndeviation = 0.015\n"
U_BAR = math.sqrt(0.001**2 + (600.0 * 11.5e-6 * 0.1) ** 2 + 0.0005**2)


def test_each_value_has_its_probability(tmp_path: Path) -> None:
    """E_Uni +20 and -30 µm of limits ±30 µm (0.020 + 600 / 60000), u by hand; L_Dia cannot be negative."""
    figures = ulna.verify(write_plan(tmp_path)).states[0].figures
    uni = [judged.conformity for judged in figures["E_Uni:Tact.AArm"].values]
    expected = [
        stats.norm.cdf((0.030 - y) / U_BAR) - stats.norm.cdf((-0.030 - y) / U_BAR)
        for y in (600.020 - 600, 599.970 - 600)
    ]
    assert uni == pytest.approx(expected, rel=1e-9)
    assert uni[1] == pytest.approx(0.5, abs=1e-9), "on its limit"
    dia = figures["L_Dia.5x5:Art:Tact.AArm"]
    y, u = dia.worst.single.value_mm, dia.worst.single.budget.u_mm
    assert dia.worst.conformity == pytest.approx(stats.norm.cdf((0.06 - y) / u), rel=1e-9)


def test_without_limit_or_uncertainty_there_is_none(tmp_path: Path) -> None:
    plan = write_plan(tmp_path, keys='arm = "x"\nball = 6.0\nrule = "simple"\n', air="", mpe="[mpe]\nL_Dia = 0.06\n")
    figures = ulna.verify(plan).states[0].figures
    dia = figures["L_Dia.5x5:Art:Tact.AArm"]
    assert dia.verdict == "pass"
    assert (dia.worst.conformity, dia.risk) == (None, None), "no fixture is stated, so u is not known"
    uni = figures["E_Uni:Tact.AArm"]
    assert (uni.worst.conformity, uni.risk) == (None, None), "it has no limit"


@pytest.mark.parametrize(
    ("keys", "g_over_u", "r"),
    [
        ('rule = "1.65u"', 1.65, 0.825),
        ('rule = "U"', 2.0, 1.0),
        ('rule = "rU"\nr = 0.6', 1.2, 0.6),
        ('rule = "simple"', 0.0, 0.0),
    ],
)
def test_the_rule_has_its_own_largest_risks(tmp_path: Path, keys: str, g_over_u: float, r: float) -> None:
    """w = r U: a value that only just passes is wrongly passed with Φ(-g / u), for limits far wider than u."""
    found = ulna.verify(write_plan(tmp_path, keys=f"ball = 6.0\nrange = 900.0\n{keys}\n"))
    assert found.rule.part_of_expanded == pytest.approx(r)
    assert f"r = {r:.3g}" in found.rule.text or r in (0.0, 1.0)
    for figure in found.states[0].figures.values():
        risk = figure.risk
        assert risk is not None
        assert risk.consumer_at_most == pytest.approx(stats.norm.cdf(-g_over_u), rel=1e-6)
        assert risk.producer_at_most == pytest.approx(stats.norm.cdf(-g_over_u), rel=1e-6)


def test_wrong_verdicts(tmp_path: Path) -> None:
    """Of a pass the consumer risks, of a fail the producer; of what is undecided nobody."""
    figures = ulna.verify(write_plan(tmp_path)).states[0].figures
    by_verdict = {figure.verdict: figure.risk for figure in figures.values()}
    assert set(by_verdict) == {"pass", "undecided", "fail"}
    assert by_verdict["pass"].specific == pytest.approx(1.0 - by_verdict["pass"].conformity, abs=1e-15)
    assert by_verdict["fail"].specific == by_verdict["fail"].conformity < 0.05
    assert by_verdict["undecided"].specific is None


def test_no_value_can_pass_with_a_band_wider_than_its_limit(tmp_path: Path) -> None:
    plan = write_plan(tmp_path, mpe="[mpe]\nL_Dia = 0.0005\n")
    risk = ulna.verify(plan).states[0].figures["L_Dia.5x5:Art:Tact.AArm"].risk
    assert risk.consumer_at_most is None


def test_global_risks_need_what_is_made(tmp_path: Path) -> None:
    plain = ulna.verify(write_plan(tmp_path / "plain"))
    assert all(figure.risk.of_all is None for figure in plain.states[0].figures.values())
    found = ulna.verify(write_plan(tmp_path, more=PROCESS))
    figures = found.states[0].figures
    dia, uni = figures["L_Dia.5x5:Art:Tact.AArm"], figures["E_Uni:Tact.AArm"]
    g = 1.65 * U_BAR
    assert uni.risk.of_all == global_risk(
        Made(0.002, 0.012, "normal"), uni.worst.single.budget.u_mm, 0.030, uni.worst.decided.guard_mm
    )
    assert uni.worst.decided.guard_mm == pytest.approx(g)
    assert dia.risk.process == Made(0.03, 0.015, "gamma")
    assert figures["P_Form.Sph.1x25:Tact.AArm"].risk.of_all is None
    stated = json.loads(json.dumps(found.as_dict()))["states"][0]["tests"][2]["figures"][0]["risk"]
    assert stated["sides"] == "two-sided"
    assert stated["of_all"]["process"] == {"mean": 0.002, "deviation": 0.012, "distribution": "normal"}
    assert stated["of_all"]["consumer"] == uni.risk.of_all.consumer


def test_units_are_those_of_the_file(tmp_path: Path) -> None:
    """The same test in metres has the same risks."""
    mm = ulna.verify(write_plan(tmp_path / "mm", more=PROCESS))
    text = (tmp_path / "mm" / "plan.toml").read_text(encoding="utf-8")
    inch = 25.4
    lines = []
    for line in text.replace('length = "mm"', 'length = "in"').splitlines():
        key, _, value = line.partition(" = ")
        scaled = {"mean", "deviation", "P_Size", "P_Form", "L_Dia", "ball", "range", "diameter", "form", "length"}
        if key in scaled or (key == "u" and value not in ("0.1",)):
            line = f"{key} = {float(value) / inch!r}"
        lines.append(line.replace("a = 0.020", f"a = {0.020 / inch!r}"))
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "plan.toml").write_text("\n".join(lines), encoding="utf-8")
    import polars as pl

    table = pl.read_csv(tmp_path / "mm" / "touches.csv", infer_schema_length=None)
    table.with_columns(pl.col("x", "y", "z") / inch).write_csv(tmp_path / "in" / "touches.csv")
    other = ulna.verify(tmp_path / "in" / "plan.toml")
    for name, figure in mm.states[0].figures.items():
        theirs = other.states[0].figures[name].risk
        assert theirs.conformity == pytest.approx(figure.risk.conformity, abs=1e-6)
        if figure.risk.of_all is not None:
            assert theirs.of_all.consumer == pytest.approx(figure.risk.of_all.consumer, rel=1e-6)


def test_what_may_be_negative_says_so() -> None:
    """A figure whose formula says `signed` is; no other."""
    rooms = (iso_10360_12, asme_b89_4_22, faro)
    known = [each for room in rooms for each in vars(room).values() if isinstance(each, Definition)] + [*faro.SPAT_AXES]
    assert len(known) == 17
    assert [each.key for each in known if each.signed != ("signed" in each.formula)] == []


BAD = {
    "a figure that is none": (
        "[process.E_Unu]\nmean = 0\ndeviation = 1\n",
        "key 'process.E_Unu': no test of profile",
        "E_Uni",
    ),
    "a spread of nothing": ("[process.E_Uni]\nmean = 0\ndeviation = 0\n", "'process.E_Uni.deviation'", "got 0"),
    "a negative form": (
        "[process.P_Form]\nmean = -0.01\ndeviation = 0.001\n",
        "this figure cannot be negative",
        "-0.01",
    ),
    "a form too wide": ("[process.P_Form]\nmean = 0.01\ndeviation = 0.02\n", "a deviation not above the mean", "0.02"),
    "a key that is none": (
        "[process.P_Form]\nmean = 0.01\ndeviation = 0.002\nsd = 1\n",
        "process.P_Form.sd",
        "mean, deviation",
    ),
}


@pytest.mark.parametrize("case", BAD)
def test_what_cannot_be_made_is_refused(tmp_path: Path, case: str) -> None:
    more, expected, also = BAD[case]
    with pytest.raises(UlnaInputError) as caught:
        ulna.verify(write_plan(tmp_path, more=more))
    assert expected in str(caught.value)
    assert also in str(caught.value)


def test_r_belongs_to_its_rule(tmp_path: Path) -> None:
    alone = write_plan(tmp_path / "a", keys='ball = 6.0\nrule = "rU"\n')
    with pytest.raises(UlnaInputError, match=r"plan\.toml: key 'r' is missing: the rule is \"rU\""):
        ulna.verify(alone)
    without = write_plan(tmp_path / "b", keys="ball = 6.0\nr = 0.5\n")
    with pytest.raises(UlnaInputError, match=r"key 'r': got 0\.5, but the rule is \"1\.65u\""):
        ulna.verify(without)
    profile = 'format = "ulna-profile/1"\nname = "own"\nbased_on = "iso-10360-12"\ndecision = { rule = "rU" }\n'
    own = write_plan(
        tmp_path / "c",
        head='format = "ulna-verify/1"\nprofile = "own.toml"\nunits = { length = "mm", angle = "rad" }\n',
    )
    (tmp_path / "c" / "own.toml").write_text(profile, encoding="utf-8")
    with pytest.raises(UlnaInputError, match=r"own\.toml: key 'decision\.r' is missing"):
        ulna.verify(own)
    (tmp_path / "c" / "own.toml").write_text(profile.replace('"rU"', '"rU", r = 0.5'), encoding="utf-8")
    assert ulna.verify(own).rule == DecisionRule("rU", 2.0, 0.95, 0.5)


def test_the_terminal(tmp_path: Path) -> None:
    done = run("verify", write_plan(tmp_path, more=PROCESS, keys='arm = "x"\nball = 6.0\nscanner = "LS-1"\n'))
    assert done.returncode == 1, done.stderr
    for text in (
        "Risk of the decisions (JCGM 106), %",
        "Of all that are made so, %",
        "Not covered: the scanner (LS-1)",
    ):
        assert text in done.stdout
    done = run("verify", write_plan(tmp_path / "plain"))
    assert "Global risks, of all arms of a kind, need what is made" in done.stdout
    assert "Tactile probing alone was tested" in done.stdout
    assert_bad_input(
        run("verify", write_plan(tmp_path / "bad", keys='ball = 6.0\nrule = "rU"\n')), "key 'r' is missing"
    )


@pytest.mark.parametrize(
    ("share", "shown"),
    [
        (0.5, "50"),
        (0.0494, "4.9"),
        (0.977, "97.7"),
        (0.00123, "0.12"),
        (0.999988, "99.9988"),
        (1.0, "> 99.9999"),
        (0.0, "< 0.0001"),
        (0.1, "10"),
    ],
)
def test_percent_by_hand(share: float, shown: str) -> None:
    assert percent(share) == shown
