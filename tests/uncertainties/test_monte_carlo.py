"""Monte Carlo propagation, against the examples of JCGM 101:2008 9.2 to 9.4, closed forms and other packages."""

import itertools
import math

import GTC
import numpy as np
import pytest
from scipy import optimize, stats

import uncertainties
from ulna.ground.errors import UlnaInputError
from ulna.uncertainties.gum import coverage_factor, numerical_jacobian, propagate
from ulna.uncertainties.monte_carlo import MonteCarlo, adaptive, agrees, summarize, tolerance

MILLION = 1_000_000

# --- JCGM 101 9.2: the sum of four ------------------------------------------------------------------------------------


def end_of_sum_of_rectangles(half_widths, p=0.95):
    """The symmetric interval's upper end, from the convolution of rectangles about 0 in closed form."""
    a = np.array(half_widths)
    signs = np.array(list(itertools.product([-1.0, 1.0], repeat=len(a))))

    def below(t):
        powers = np.maximum(t + signs @ a, 0.0) ** len(a)
        return (signs.prod(axis=1) * powers).sum() / (math.factorial(len(a)) * np.prod(2 * a))

    return optimize.brentq(lambda t: below(t) - 0.5 * (1 + p), 0.0, a.sum())


def test_four_normals():
    # 9.2.2: u 2.0 and ±3.92 by both
    draws = np.random.default_rng(922).normal(size=(4, MILLION)).sum(axis=0)
    found = summarize(draws)
    assert found.y == pytest.approx(0.0, abs=0.01)
    assert round(found.u, 1) == 2.0
    assert found.symmetric == pytest.approx((-3.92, 3.92), abs=0.02)
    assert agrees(0.0, coverage_factor(0.95) * 2.0, found)[0]


@pytest.mark.parametrize(("u_last", "u", "end", "printed"), [(1.0, 2.0, 3.92, 3.88), (10.0, 10.1, 19.9, 17.0)])
def test_four_rectangles(u_last, u, end, printed):
    # 9.2.3 (equal widths) and 9.2.4 (the last ten times as wide): end of the GUM's interval, and of Monte Carlo's
    u_inputs = np.array([1.0, 1.0, 1.0, u_last])
    half_widths = math.sqrt(3.0) * u_inputs
    rng = np.random.default_rng(923)
    found = summarize((rng.uniform(-1, 1, size=(MILLION, 4)) * half_widths).sum(axis=1))
    first_order = math.sqrt(propagate(np.ones((1, 4)), np.diag(u_inputs**2))[0, 0])
    decimals = 2 if u_last == 1.0 else 1
    expanded = coverage_factor(0.95) * first_order

    assert round(first_order, 1) == u
    assert round(expanded, decimals) == end
    exact = end_of_sum_of_rectangles(half_widths)
    assert round(exact, decimals) == printed
    assert found.u == pytest.approx(first_order, rel=2e-3)
    assert found.symmetric == pytest.approx((-exact, exact), rel=3e-3)
    assert found.shortest == pytest.approx((-exact, exact), rel=3e-2)
    good, d_low, d_high = agrees(0.0, expanded, found)
    assert (d_low, d_high) == pytest.approx((expanded - exact,) * 2, abs=0.003 * exact)
    # 0.04 is within δ = 0.05 of u = 2.0; 2.9 is not within 0.5 of u = 10
    assert good == (u_last == 1.0)


# --- JCGM 101 9.3: calibration of a mass ------------------------------------------------------------------------------

#: mg, mg, mg, kg/m³, kg/m³, kg/m³ (9.3): m_R,c, δm_R,c, air, weight W, weight R
MASS = np.array([100_000.0, 1.234, 1.20, 8000.0, 8000.0])
MASS_U = np.array([0.050, 0.020, 0.10 / math.sqrt(3), 1000 / math.sqrt(3), 50 / math.sqrt(3)])


def mass_error(x):
    """δm in mg (9.3)."""
    m, dm, air, w, r = x
    return (m + dm) * (1 + (air - 1.2) * (1 / w - 1 / r)) - 100_000.0


def test_mass_calibration():
    # 9.3, the table of results: shortest intervals
    rng = np.random.default_rng(93)
    normal = MASS[:2, None] + MASS_U[:2, None] * rng.normal(size=(2, 4 * MILLION))
    rectangular = MASS[2:, None] + math.sqrt(3) * MASS_U[2:, None] * rng.uniform(-1, 1, size=(3, 4 * MILLION))
    found = summarize(mass_error(np.concatenate([normal, rectangular])), digits=1)
    assert found.y == pytest.approx(1.2341, abs=2e-4)
    assert found.u == pytest.approx(0.0754, abs=1e-4)
    assert found.shortest == pytest.approx((1.0834, 1.3825), abs=2e-3)
    assert found.tolerance == pytest.approx(0.005)

    jacobian = numerical_jacobian(lambda x: np.array([mass_error(x)]), MASS, MASS_U)
    u = math.sqrt(propagate(jacobian, np.diag(MASS_U**2))[0, 0])
    k = coverage_factor(0.95)
    assert round(u, 4) == 0.0539
    assert (1.234 - k * u, 1.234 + k * u) == pytest.approx((1.1285, 1.3395), abs=1e-4)
    good, d_low, d_high = agrees(1.234, k * u, found, digits=1, shortest=True)
    assert (good, d_low, d_high) == (False, pytest.approx(0.0451, abs=2e-3), pytest.approx(0.0430, abs=2e-3))
    # with terms of higher order, the same table: u = 0.0750, [1.0870, 1.3810], valid
    good, d_low, d_high = agrees(1.234, k * 0.0750, found, digits=1, shortest=True)
    assert (good, d_low, d_high) == (True, pytest.approx(0.0036, abs=2e-3), pytest.approx(0.0015, abs=2e-3))


def test_mass_calibration_agrees_with_other_packages():
    ours = numerical_jacobian(lambda x: np.array([mass_error(x)]), MASS, MASS_U)
    u = math.sqrt(propagate(ours, np.diag(MASS_U**2))[0, 0])
    theirs = mass_error([uncertainties.ufloat(x, s) for x, s in zip(MASS, MASS_U, strict=True)])
    assert u == pytest.approx(theirs.std_dev, rel=1e-7)
    theirs = mass_error([GTC.ureal(x, s) for x, s in zip(MASS, MASS_U, strict=True)])
    assert u == pytest.approx(GTC.uncertainty(theirs), rel=1e-7)


# --- JCGM 101 9.4: comparison loss in microwave power meter calibration -----------------------------------------------


@pytest.mark.parametrize("r", [0.0, 0.9])
@pytest.mark.parametrize("x1", [0.0, 0.010, 0.050])
def test_comparison_loss(x1, r):
    """Y = X1² + X2², both of u = 0.005, correlated by r.

    Means and standard deviations are derived, not copied: y = x1² + 2u² and u² = 4x1²u² + 4u⁴(1 + r²). For r = 0 they
    round to the printed 50, 150 and 50, 112, 502 (·10⁻⁶); at x1 = 0.050 the standard prints 2551 for 2550, its own
    noise. First order gives x1² and 2x1 u: at x1 = 0 no uncertainty at all.
    """
    s = 0.005
    covariance = s**2 * np.array([[1.0, r], [r, 1.0]])
    a, b = np.random.default_rng(94).normal(size=(2, MILLION))
    found = summarize((x1 + s * a) ** 2 + (s * (r * a + math.sqrt(1 - r**2) * b)) ** 2)
    y = x1**2 + 2 * s**2
    u = math.sqrt(4 * x1**2 * s**2 + 4 * s**4 * (1 + r**2))
    assert found.y == pytest.approx(y, abs=4 * u / math.sqrt(MILLION))
    assert found.u == pytest.approx(u, rel=0.01)
    if r == 0.0:
        printed = {0.0: (50, 50), 0.010: (150, 112), 0.050: (2550, 502)}[x1]
        assert (round(y * 1e6), round(u * 1e6)) == printed
        assert round(found.u * 1e6) == pytest.approx(printed[1], abs=1)
        low, high = shortest_of(stats.ncx2(2, (x1 / s) ** 2, scale=s**2) if x1 else stats.chi2(2, scale=s**2))
        assert found.shortest == pytest.approx((low, high), abs=0.05 * u)

    def loss(x):
        return np.array([x[0] ** 2 + x[1] ** 2])

    jacobian = numerical_jacobian(loss, np.array([x1, 0.0]), np.array([s, s]))
    first_order = math.sqrt(propagate(jacobian, covariance)[0, 0])
    assert first_order == pytest.approx({0.0: 0.0, 0.010: 100e-6, 0.050: 500e-6}[x1], abs=1e-15)
    assert not agrees(x1**2, coverage_factor(0.95) * first_order, found)[0]


def shortest_of(distribution, p=0.95):
    """The shortest interval of a distribution, by minimising over the probability below it."""
    found = optimize.minimize_scalar(
        lambda below: distribution.ppf(below + p) - distribution.ppf(below),
        bounds=(0.0, 1.0 - p),
        method="bounded",
        options={"xatol": 1e-9},
    )
    return distribution.ppf(found.x), distribution.ppf(found.x + p)


# --- intervals, clause 7.7 --------------------------------------------------------------------------------------------


def test_intervals_of_a_skew_distribution():
    beta = stats.beta(2, 6)
    # evenly spread over the probability: no noise, so that a shift by one rank is seen
    values = beta.ppf((np.arange(100_000) + 0.5) / 100_000)
    found = summarize(np.random.default_rng(3).permutation(values), p=0.9)
    assert found.symmetric == pytest.approx(beta.ppf([0.05, 0.95]), abs=2e-5)
    assert found.shortest == pytest.approx(shortest_of(beta, 0.9), abs=5e-4)
    assert found.shortest[1] - found.shortest[0] < found.symmetric[1] - found.symmetric[0]


def test_intervals_of_few_values_by_hand():
    # 7.7.2: M = 20, p = 0.9: q = 18, r = 1: from the first to the nineteenth
    values = np.arange(1.0, 21.0) ** 2
    found = summarize(values[::-1], p=0.9)
    assert found.symmetric == (1.0, 19.0**2)
    assert found.shortest == (1.0, 19.0**2)
    assert summarize(-values, p=0.9).shortest == (-(19.0**2), -1.0)
    # M = 21: pM = 18.9, q = 19, M - q even, r = 1. M = 30: q = 27, M - q odd, r = 2
    assert summarize(np.arange(1.0, 22.0), p=0.9).symmetric == (1.0, 20.0)
    assert summarize(np.arange(1.0, 31.0), p=0.9).symmetric == (2.0, 29.0)


def test_trials_that_say_nothing_are_refused():
    with pytest.raises(UlnaInputError, match=r"9 Monte Carlo trials are too few for an interval of p = 0.95"):
        summarize(np.arange(9.0))
    with pytest.raises(UlnaInputError, match=r"trial 10003 gave nan, one of 2 in 10000 trials that are not finite"):
        adaptive(lambda first, count: np.where(np.isin(np.arange(first, first + count), [10003, 10009]), np.nan, 0.0))


# --- adaptive procedure, clause 7.9 -----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("u", "digits", "delta"),
    [
        (0.35, 2, 0.005),
        (35.2, 2, 0.5),
        (0.0996, 2, 0.005),
        (0.0754, 1, 0.005),
        (2.0, 2, 0.05),
        (50e-6, 2, 0.5e-6),
        (0.0, 2, 0.0),
    ],
)
def test_tolerances(u, digits, delta):
    # 7.9.2; 9.2.2 and 9.3 use 2.0 and 0.0754
    assert tolerance(u, digits) == pytest.approx(delta)


def normal_draws(seed, scale=1.0):
    """Trials of the standard normal in blocks of 1000, each block by (seed, number of the block)."""

    def draw(first, count):
        blocks = range(first // 1000, (first + count - 1) // 1000 + 1)
        values = np.concatenate([np.random.default_rng([seed, block]).normal(size=1000) for block in blocks])
        return scale * values[first - blocks[0] * 1000 :][:count]

    return draw


@pytest.mark.parametrize(("u", "each", "all_four"), [(1.0, 95, 95), (4.0, 90, 85)])
def test_the_adaptive_procedure_holds_its_tolerance(u, each, all_four):
    # the rule is twice a standard error, so 95 % for each figure where batches are many or δ is tight (u = 4.0, δ =
    # 0.05), less what early endings by luck cost; at u = 1.0 two batches are already more than δ asks for
    k = coverage_factor(0.95)
    held = np.zeros((100, 4), dtype=bool)
    for seed in range(100):
        found = adaptive(normal_draws(seed, u))
        assert found.settled
        ends = np.array(found.symmetric) - [-k * u, k * u]
        held[seed] = np.abs([found.y, found.u - u, *ends]) <= found.tolerance
    assert held.sum(axis=0).min() >= each
    assert held.all(axis=1).sum() >= all_four


def test_the_adaptive_procedure_follows_its_rule():
    # over the batches it took: twice the standard errors are within δ at the end, and were not one batch before
    draw = normal_draws(5, scale=4.0)  # u = 4.0, δ = 0.05
    found = adaptive(draw)
    h = found.trials // 10_000
    assert found.trials == h * 10_000
    assert h > 2

    def twice_the_errors(batches):
        each = [summarize(draw(10_000 * j, 10_000)) for j in range(batches)]
        figures = np.array([[one.y, one.u, *one.symmetric] for one in each])
        return 2 * (figures.std(axis=0, ddof=1) / math.sqrt(batches)).max()

    assert twice_the_errors(h) <= found.tolerance == pytest.approx(0.05)
    assert all(twice_the_errors(batches) > 0.05 for batches in range(2, h))
    whole = summarize(draw(0, found.trials))
    assert (found.y, found.u, found.symmetric, found.shortest) == (whole.y, whole.u, whole.symmetric, whole.shortest)


def test_more_digits_take_more_trials_and_a_limit_ends_them():
    assert adaptive(normal_draws(1), digits=1).trials == 20_000
    assert adaptive(normal_draws(1), digits=2).trials < adaptive(normal_draws(1, scale=9.0), digits=2).trials
    told = []
    found = adaptive(normal_draws(1), digits=3, most=55_000, progress=lambda *what: told.append(what))
    assert (found.trials, found.settled) == (50_000, False)
    assert [done for _, done, _ in told] == [0, 10_000, 20_000, 30_000, 40_000, 50_000]
    assert all(stage == "trials" and done <= total <= 55_000 for stage, done, total in told)
    few = adaptive(normal_draws(1), most=500)
    assert (few.trials, few.settled) == (500, False)


def test_batches_grow_with_p():
    # 7.9.4: 100/(1 - p) where that is above 10⁴
    sizes = set()

    def draw(first, count):
        sizes.add(count)
        return normal_draws(2)(first, count)

    adaptive(draw, p=0.9973, digits=1)
    assert sizes == {math.ceil(100 / (1 - 0.9973))}


def test_trials_depend_on_their_number_alone():
    draw = normal_draws(8)
    cut = np.concatenate([draw(0, 1), draw(1, 2999), draw(3000, 17_000)])
    assert (cut == draw(0, 20_000)).all()
    assert adaptive(lambda first, count: np.concatenate([draw(first, 7), draw(first + 7, count - 7)])) == adaptive(draw)


def test_a_value_without_uncertainty_settles():
    found = adaptive(lambda first, count: np.full(count, 3.25))
    assert (found.y, found.u, found.symmetric, found.trials, found.settled) == (3.25, 0.0, (3.25, 3.25), 20_000, True)
    assert agrees(3.25, 0.0, found) == (True, 0.0, 0.0)


def test_batches_that_differ_count_in_u():
    # every second batch is 1, the others 0: u = 0.5 comes from between the batches alone, δ = 0.05 in one digit, and
    # the standard error of the mean is 0.5 / √h
    found = adaptive(lambda first, count: np.full(count, float(first // 10_000 % 2)), digits=1)
    assert (found.settled, found.tolerance) == (True, pytest.approx(0.05))
    assert found.u == pytest.approx(0.5, abs=1e-3)
    assert found.trials == pytest.approx(400 * 10_000, rel=0.02)


def test_agreement_asks_both_ends_of_the_interval_named():
    # δ = 0.05; the interval of first order is -1.0 to 1.0
    def trials(symmetric, shortest):
        return MonteCarlo(0.0, 1.0, 0.95, symmetric, shortest, 10_000, True, 0.05)

    found = trials((-1.04, 1.03), (-0.9, 1.01))
    assert agrees(0.0, 1.0, found) == (True, pytest.approx(0.04), pytest.approx(0.03))
    assert agrees(0.0, 1.0, found, shortest=True) == (False, pytest.approx(0.1), pytest.approx(0.01))
    assert not agrees(0.0, 1.0, trials((-1.0, 1.06), (-1.0, 1.0)))[0]
    assert agrees(0.0, 1.0, trials((-1.0, 1.06), (-1.0, 1.0)), digits=1)[0]
