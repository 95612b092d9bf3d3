"""Probabilities of conformity and risks, against JCGM 106:2012, against SciPy and mpmath, and against simulation.

What JCGM 106 prints: the text of the standard was not at hand. Its ball bearings of 9.5 were confirmed by another
program that works the same example (Suncal: 4.2 %, 0.8 %, an acceptance limit of 1.67 µm for 0.1 %); its Zener diode of
clause 7 and its factors z of Table 1 stand here as they are widely quoted. Everything else has numerical integration as
its oracle: SciPy's adaptive quadrature of the double integral's outer variable, and mpmath for tails.
"""

from __future__ import annotations

import math
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import integrate, stats

from ulna.verification.conformity import GlobalRisk, Made, global_risk, phi, probability, risk
from ulna.verification.decision import DecisionRule

INF = math.inf
#: gamma of shape 4 and rate 4 µm⁻¹: radial error motion of ball bearings, at most 2 µm, measured with u = 0.25 µm
BEARINGS = Made(1.0, 0.5, "gamma")


def test_the_zener_diode_of_clause_7() -> None:
    """V ≤ -5.40 V, measured -5.47 V with u = 0.05 V: 0.92."""
    assert f"{probability(-5.47, 0.05, -INF, -5.40):.2f}" == "0.92"
    assert probability(-5.47, 0.05, -INF, -5.40) == pytest.approx(stats.norm.cdf(1.4), rel=1e-14)


@pytest.mark.parametrize(("conformity", "z"), [("0.80", 0.84), ("0.90", 1.28), ("0.95", 1.64), ("0.99", 2.33)])
def test_the_factors_of_table_1(conformity: str, z: float) -> None:
    """One limit: y a distance z u from it conforms with this probability; Table 1 of clause 7 has two decimals of z."""
    low, high = (probability(-(z + half) * 0.3, 0.3, -INF, 0.0) for half in (-0.005, 0.005))
    assert low <= float(conformity) <= high


def test_the_ball_bearings_of_clause_9() -> None:
    eta = np.linspace(0.0, 2.0, 200_001)
    assert f"{1.0 - integrate.trapezoid(BEARINGS.density(eta), eta):.3f}" == "0.042", "made too large without a check"
    assert f"{100.0 * global_risk(BEARINGS, 0.25, 2.0, 0.0).consumer:.1f}" == "0.8"
    assert f"{100.0 * global_risk(BEARINGS, 0.25, 2.0, 2.0 - 1.67).consumer:.1f}" == "0.1"


def by_quadrature(made: stats.rv_continuous, u: float, limit: float, guard: float) -> GlobalRisk:
    """SciPy's adaptive rule, piece by piece."""
    accept, reject = limit - guard, limit + guard

    def within(eta: float, bound: float) -> float:
        return float(stats.norm.cdf((bound - eta) / u) - stats.norm.cdf((-bound - eta) / u)) if bound > 0.0 else 0.0

    def over(low: float, high: float, chance) -> float:  # type: ignore[no-untyped-def]
        low, high = max(low, float(made.ppf(1e-14))), min(high, float(made.isf(1e-14)))
        edges = sorted({low, high, *(e for e in (-reject, -limit, -accept, accept, limit, reject) if low < e < high)})
        edges = sorted({*edges, *(e for k in edges for e in (k - 6 * u, k + 6 * u) if low < e < high)})
        found = 0.0
        for a, b in pairwise(edges):
            found += integrate.quad(lambda x: made.pdf(x) * chance(x), a, b, epsabs=1e-15, epsrel=1e-12, limit=200)[0]
        return found

    return GlobalRisk(
        over(limit, INF, lambda x: within(x, accept)) + over(-INF, -limit, lambda x: within(x, accept)),
        over(-limit, limit, lambda x: 1.0 - within(x, reject)),
        over(-limit, limit, lambda x: 1.0 - within(x, accept)),
        over(-INF, INF, lambda x: within(x, reject) - within(x, accept)),
    )


CASES = [
    (Made(0.0, 0.12, "normal"), 0.04, 0.2, 0.0),
    (Made(0.0, 0.12, "normal"), 0.04, 0.2, 0.066),
    (Made(0.07, 0.05, "normal"), 0.04, 0.2, 0.08),
    (Made(-0.3, 0.02, "normal"), 0.04, 0.2, 0.08),
    (Made(0.002, 0.01, "normal"), 0.0003, 0.02, 0.0006),
    (Made(0.002, 0.01, "normal"), 0.03, 0.02, 0.0495),
    (BEARINGS, 0.25, 2.0, 0.0),
    (BEARINGS, 0.25, 2.0, 0.5),
    (Made(1.0, 1.0, "gamma"), 0.1, 2.0, 0.2),
    (Made(1.0, 0.1, "gamma"), 0.2, 1.1, 0.3),
]


@pytest.mark.parametrize(("made", "u", "limit", "guard"), CASES)
def test_global_risks_are_those_of_another_quadrature(made: Made, u: float, limit: float, guard: float) -> None:
    if made.distribution == "normal":
        other = stats.norm(made.mean, made.deviation)
    else:
        other = stats.gamma(a=(made.mean / made.deviation) ** 2, scale=made.deviation**2 / made.mean)
    found, expected = global_risk(made, u, limit, guard), by_quadrature(other, u, limit, guard)
    for name in ("consumer", "producer", "withheld", "undecided"):
        assert getattr(found, name) == pytest.approx(getattr(expected, name), rel=1e-8, abs=1e-11), name


@pytest.mark.parametrize(("made", "u", "limit", "guard"), CASES)
def test_by_simulation_they_are_right_within_their_binomial_error(
    made: Made, u: float, limit: float, guard: float
) -> None:
    """Two million things are made, measured and decided; 4.5 standard errors, and some for what is too rare."""
    rng, count = np.random.default_rng(106), 2_000_000
    if made.distribution == "normal":
        eta = rng.normal(made.mean, made.deviation, count)
    else:
        eta = rng.gamma((made.mean / made.deviation) ** 2, made.deviation**2 / made.mean, count)
    size, conforms = np.abs(eta + rng.normal(0.0, u, count)), np.abs(eta) <= limit
    passed, failed = size <= limit - guard, size > limit + guard
    found = global_risk(made, u, limit, guard)
    seen = {
        "consumer": passed & ~conforms,
        "producer": failed & conforms,
        "withheld": ~passed & conforms,
        "undecided": ~passed & ~failed,
    }
    for name, those in seen.items():
        stated = getattr(found, name)
        error = math.sqrt(stated * (1.0 - stated) / count)
        assert abs(those.mean() - stated) <= 4.5 * error + 2.0 / count, name


def test_the_simulated_rule_is_the_rule() -> None:
    """What the simulation above calls passed and failed is what decides in an acceptance test."""
    rule = DecisionRule("rU", 2.0, 0.95, 0.8)
    rng = np.random.default_rng(3)
    for value in rng.normal(0.0, 0.02, 200).tolist():
        verdict = rule.decide(value, 0.02, 0.002).verdict
        guard = 0.8 * 2.0 * 0.002
        expected = "pass" if abs(value) <= 0.02 - guard else "fail" if abs(value) > 0.02 + guard else "undecided"
        assert verdict == expected


@given(y=st.floats(-3, 3), u=st.floats(1e-3, 2), low=st.floats(-2, 0), high=st.floats(0, 2))
def test_probabilities_and_risks_are_those_of_mpmath(y: float, u: float, low: float, high: float) -> None:
    """To all digits in the tails, and the two make one."""
    with mpmath.workdps(40):
        above, below = (mpmath.mpf(y) - high) / u, (mpmath.mpf(low) - y) / u
        exact, rest = mpmath.ncdf(-above) - mpmath.ncdf(below), mpmath.ncdf(above) + mpmath.ncdf(below)
        assert probability(y, u, low, high) == pytest.approx(float(exact), rel=1e-9, abs=1e-15)
        assert risk(y, u, low, high) == pytest.approx(float(rest), rel=1e-9, abs=1e-300)
    assert probability(y, u, low, high) + risk(y, u, low, high) == pytest.approx(1.0, abs=1e-15)
    assert probability(-y, u, -high, -low) == pytest.approx(probability(y, u, low, high), abs=1e-15)


@given(y=st.floats(-3, 3), u=st.floats(0, 2), more=st.floats(0, 1))
def test_a_wider_limit_is_never_kept_more_rarely(y: float, u: float, more: float) -> None:
    assert probability(y, u, -1.0, 1.0) <= probability(y, u, -1.0 - more, 1.0 + more) + 1e-15
    assert probability(y, u, -INF, 1.0) >= probability(y, u, -1.0, 1.0) - 1e-15


def test_without_uncertainty_a_value_is_what_it_is() -> None:
    assert (probability(1.0, 0.0, -1.0, 1.0), risk(1.0, 0.0, -1.0, 1.0)) == (1.0, 0.0)
    assert (probability(1.1, 0.0, -1.0, 1.0), risk(1.1, 0.0, -1.0, 1.0)) == (0.0, 1.0)
    found = global_risk(Made(0.0, 1.0, "normal"), 0.0, 1.0, 0.25)
    assert (found.consumer, found.producer) == (0.0, 0.0)
    assert found.undecided == pytest.approx(2.0 * (stats.norm.cdf(1.25) - stats.norm.cdf(0.75)), rel=1e-10)
    assert found.withheld == pytest.approx(2.0 * (stats.norm.cdf(1.0) - stats.norm.cdf(0.75)), rel=1e-10)
    assert phi(-INF) == 0.0
    assert phi(INF) == 1.0


@settings(deadline=None)
@given(
    mean=st.floats(-1, 1),
    deviation=st.floats(1e-3, 1),
    u=st.floats(1e-3, 1),
    guard=st.floats(0, 1.5),
    more=st.floats(0, 1),
)
def test_a_wider_band_shifts_the_risk_to_the_producer(
    mean: float, deviation: float, u: float, guard: float, more: float
) -> None:
    made = Made(mean, deviation, "normal")
    narrow, wide = global_risk(made, u, 1.0, guard), global_risk(made, u, 1.0, guard + more)
    for found in (narrow, wide):
        assert all(0.0 <= each <= 1.0 for each in (found.consumer, found.producer, found.withheld, found.undecided))
        assert found.producer <= found.withheld + 1e-12
    assert wide.consumer <= narrow.consumer + 1e-12
    assert wide.producer <= narrow.producer + 1e-12
    assert wide.withheld >= narrow.withheld - 1e-12
    assert wide.undecided >= narrow.undecided - 1e-12
